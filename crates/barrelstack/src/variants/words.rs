//! Sentences on the results of variants.

use barrelstack_report::{Tone, capital};

use super::{Range, Spread};
use crate::scenario::{Imperfection, Imperfections, View};
use crate::summary::Summary;

/// Share of collapsing variants from which a stack is said to fall.
const FALLS: f64 = 0.9;

/// Share up to which it is said to stand.
const STANDS: f64 = 0.05;

/// Shown when the verdict is neither that it stands nor that it falls.
const UNSAFE: &str = "treat it as not safe";

/// Returns the answer in one sentence: of one plane, or of both, the one across the barrels first.
pub fn headline(planes: &[(View, &Spread)]) -> String {
    match planes {
        [] => String::new(),
        [(_, spread)] => before(None, spread) + &alone(spread) + &overloaded("In", spread),
        [(first_view, first), (second_view, second), ..] => {
            let both = together([(*first_view, first), (*second_view, second)]);
            let staves = [(first_view, first), (second_view, second)].map(|(view, spread)| {
                overloaded(&format!("{}, in", capital(view.words())), spread)
            });
            before(Some(*first_view), first)
                + &before(Some(*second_view), second)
                + &both
                + &staves.concat()
        }
    }
}

/// Describes stave overload, after the verdict; empty if there is none.
fn overloaded(begin: &str, spread: &Spread) -> String {
    match (spread.staves_overloaded, spread.stave_utilization) {
        (0, _) | (_, None) => String::new(),
        (count, Some(load)) => format!(
            " {begin} {count} of {} variants staves are crushed before any seat is lost: they bear up to {:.0} % of \
             what they are stated to bear.",
            spread.variants,
            100.0 * load
        ),
    }
}

/// Returns the kind of the verdict: anything but safe counts as falling.
pub fn tone(planes: &[(View, &Spread)]) -> Tone {
    match planes.iter().filter_map(|(_, spread)| judged_share(spread)).reduce(f64::max) {
        None => Tone::Invalid,
        Some(share) if share <= STANDS => Tone::Stands,
        Some(_) => Tone::Falls,
    }
}

/// Returns words for all of a number of variants.
fn all_of(variants: u32) -> String {
    match variants {
        1 => "the one variant".to_owned(),
        2 => "both variants".to_owned(),
        more => format!("all {more} variants"),
    }
}

/// Returns the share by which a stack is judged, with variants without a verdict as collapsed; `None` if none has one.
fn judged_share(spread: &Spread) -> Option<f64> {
    spread.share.and(spread.largest_share())
}

/// Returns the verdict of one plane.
fn alone(spread: &Spread) -> String {
    let Spread { variants, collapsed, interval, .. } = spread;
    let Some(share) = judged_share(spread) else {
        return "None of the variants of this stack has a verdict.".to_owned();
    };
    // Before the verdict of a stack that falls by itself, or as a sentence after it.
    let (early, course) = if spread.collapsed == spread.cannot_stand {
        (", before it is shaken", String::new())
    } else {
        ("", format!(" {}.", capital(&course(spread))))
    };
    let standing = variants - collapsed;
    // A stack that stands when its motion is cut has not passed it.
    if let Some(until) = spread.standing_until.filter(|_| share <= STANDS) {
        let share = if standing == *variants {
            all_of(*variants)
        } else {
            format!("{standing} of {variants} variants")
        };
        return format!(
            "Until {until:.1} s, where the runs end and the motion does not, this stack stands in {share}."
        );
    }
    match (*collapsed, share) {
        (0, share) if share > STANDS => {
            format!(
                "This stack stands in {}, and others have no verdict: {UNSAFE}.",
                all_of(*variants)
            )
        }
        (0, _) => format!(
            "This stack stands in {}: of stacks like it at most {} fall.",
            all_of(*variants),
            percent(interval[1])
        ),
        (all, _) if all == *variants => {
            format!("This stack falls: in {}{early}.{course}", all_of(*variants))
        }
        (_, share) if share >= FALLS => {
            format!("This stack falls: in {collapsed} of {variants} variants{early}.{course}")
        }
        (_, share) if share <= STANDS => format!(
            "This stack stands: in {standing} of {variants} variants; in {collapsed} it falls{early}.{course}"
        ),
        (_, share) if (0.4..=0.6).contains(&share) => format!(
            "This stack falls in half of the variants, {collapsed} of {variants}{early}: {UNSAFE}.{course}"
        ),
        (_, share) if share > 0.6 => format!(
            "This stack falls in most variants, {collapsed} of {variants}{early}: {UNSAFE}.{course}"
        ),
        _ => format!(
            "This stack falls in {collapsed} of {variants} variants{early}: {UNSAFE}.{course}"
        ),
    }
}

/// Returns the verdict of both planes, which is that of the worse, then their counts, those of the worse first.
fn together(planes: [(View, &Spread); 2]) -> String {
    let severity = |(_, spread): &(View, &Spread)| judged_share(spread).unwrap_or(-1.0);
    let [first, second] = planes;
    let [first, second] =
        if severity(&first) < severity(&second) { [second, first] } else { [first, second] };
    let verdict = match judged_share(first.1) {
        None => {
            return "No variant has a verdict, neither across the barrels nor along them."
                .to_owned();
        }
        Some(share) if share >= FALLS => "Falls",
        Some(share) if share > STANDS => "Not safe",
        Some(_) if [first, second].iter().any(|(_, spread)| spread.standing_until.is_some()) => {
            "Not decided, since the runs end before the motion does"
        }
        Some(_) => "Stands",
    };
    // The first clause names the barrels and the variants.
    let place = second.0.words().replace("the barrels", "them");
    let second = match counts(second.1, "") {
        Some(counts) => format!("{place} {counts}"),
        None => format!("{place} none has a verdict"),
    };
    let first = format!("{} {}", first.0.words(), counts(first.1, " variants").unwrap_or_default());
    format!("{verdict}. Shaken {first}, {second}.")
}

/// Describes how many variants fall, with the 95 % interval of their share: "53 of 64 variants fall (72–90 %)"; `None`
/// without any verdict.
fn counts(spread: &Spread, noun: &str) -> Option<String> {
    let Spread { variants, collapsed, interval, .. } = spread;
    let [low, high] = interval.map(percent);
    spread.share?;
    Some(match *collapsed {
        0 => format!("none of {variants}{noun} falls (at most {high})"),
        all if all == *variants => format!("all {all}{noun} fall (at least {low})"),
        one => {
            let fall = if one == 1 { "falls" } else { "fall" };
            format!("{one} of {variants}{noun} {fall} ({}–{high})", low.trim_end_matches(" %"))
        }
    })
}

/// Returns the sentences that support the headline of a run and its variants.
pub(crate) fn sentences(summary: &Summary) -> Vec<String> {
    let planes = summary.spreads();
    if planes.len() < 2 {
        return Vec::new();
    }
    let falls = planes.iter().filter(|(_, spread)| spread.collapsed > 0);
    let sentence = |(view, spread): &(View, &Spread)| {
        format!("Where it falls {}: {}.", view.words(), course(spread))
    };
    falls.map(sentence).collect()
}

/// Describes the shown run, and the differences of variants, in the governing plane.
pub(crate) fn fine(summary: &Summary, imperfections: Option<&Imperfections>) -> Vec<String> {
    let (Some(spread), Some(imperfections)) = (&summary.ensemble, imperfections) else {
        return Vec::new();
    };
    let mut sentences = Vec::new();
    let planes = summary.spreads();
    let typical = if summary.variant == spread.typical { ", the most typical of all" } else { "" };
    let named = |number: u32| match number {
        0 => "the stack as it is stated".to_owned(),
        number => format!("variant {number}"),
    };
    let decides = planes.iter().find(|(view, _)| Some(view.name()) == summary.view);
    let plane = decides.filter(|_| planes.len() > 1).map(|(view, _)| format!("{} ", view.words()));
    sentences.push(format!(
        "Shown is {}{typical}; {}the gentlest is {}, the worst {}.",
        named(summary.variant),
        plane.unwrap_or_default(),
        named(spread.gentlest),
        named(spread.worst)
    ));
    let stated = match (spread.stated, spread.standing_until) {
        ("collapse", _) => "falls".to_owned(),
        ("stable", None) => "stands".to_owned(),
        ("stable", Some(until)) => format!("stands until {until:.1} s, where the runs end"),
        _ => "has no verdict".to_owned(),
    };
    let places = format!(
        "in places by up to {} mm, in masses by {} %",
        tenths(1e3 * imperfections.placement),
        tenths(100.0 * imperfections.mass)
    );
    let constants = "in friction and contact constants as far as those are not known";
    sentences.push(format!(
        "As it is stated the stack {stated}; the variants differ from that {}.",
        match imperfections.kind {
            Imperfection::Hair => places,
            Imperfection::Ignorance => constants.to_owned(),
            Imperfection::Both => format!("{places}, and {constants}"),
        }
    ));
    sentences
}

/// `true` if a stack is said to stand.
pub(crate) fn stands(spread: &Spread) -> bool {
    judged_share(spread).is_some_and(|share| share <= STANDS)
}

/// Describes the result of a stack: "falls in 97 % of variants".
pub fn fate(spread: &Spread) -> String {
    let variants = spread.variants;
    match (spread.share, spread.collapsed) {
        (None, _) => "has no verdict".to_owned(),
        (Some(_), 0) => format!("stands in {}", all_of(variants)),
        (Some(_), all) if all == variants => format!("falls in {}", all_of(variants)),
        (Some(share), _) if share >= 0.5 => format!("falls in {} of variants", percent(share)),
        (Some(share), _) => format!("stands in {} of variants", percent(1.0 - share)),
    }
}

/// Describes time and extent of the fall: "the first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall".
pub fn course(spread: &Spread) -> String {
    if spread.collapsed == spread.cannot_stand {
        return "before it is shaken".to_owned();
    }
    let when = spread.first_loss.map_or_else(String::new, |first| {
        let [from, to] = [first.p05, first.p95].map(|time| format!("{time:.1}"));
        if from == to {
            format!("the first seat is lost after {from} s; ")
        } else {
            format!("the first seat is lost between {from} and {to} s; ")
        }
    });
    let fallen = match (spread.first_fall, spread.barrels_fallen) {
        (Some(_), Some(fallen)) => {
            let fall = if fallen.p95 < 1.5 && fallen.p05 > 0.5 { "falls" } else { "fall" };
            format!("{} {fall}", barrels(fallen, spread.barrels))
        }
        _ => "no barrel falls".to_owned(),
    };
    format!("{when}{fallen}{}", spread.counted("that"))
}

/// Describes the number of fallen barrels: "4 to 8 of 10 barrels".
fn barrels(fallen: Range, all: usize) -> String {
    // As for times and in the table: 5 to 95 % of the variants.
    let [from, to] = [fallen.p05, fallen.p95].map(|count| format!("{count:.0}"));
    if from != to {
        format!("{from} to {to} of {all} barrels")
    } else if to == all.to_string() {
        format!("all {all} barrels")
    } else {
        format!("{to} of {all} barrels")
    }
}

/// Describes variants that fall under their own weight, and those without a verdict, to precede the verdict; empty
/// if there are none.
fn before(view: Option<View>, spread: &Spread) -> String {
    let place = view.map_or_else(String::new, |view| format!("{}, ", view.words()));
    let mut said = String::new();
    let (fallen, broken, all) = (spread.cannot_stand, spread.broken, spread.run());
    let counted =
        |count: u32| if count == all { all_of(all) } else { format!("{count} of {all} variants") };
    if fallen > 0 {
        let (their, they) = if fallen == 1 {
            ("falls under its", "it is")
        } else {
            ("fall under their", "they are")
        };
        said = capital(&format!(
            "{place}{} {their} own weight, before {they} shaken. ",
            counted(fallen)
        ));
    }
    if broken > 0 {
        let has = if broken == 1 { "has" } else { "have" };
        said += &capital(&format!(
            "{place}{} {has} no verdict: they could not be built or their numbers broke down; the verdict counts them \
             as falling. ",
            counted(broken)
        ));
    }
    said
}

/// Rounds a number to a tenth.
fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// Formats a share in whole percent, except that only exact values give 0 and 100.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 1.0 && percent > 0.0 {
        "1 %".to_owned()
    } else if percent > 99.0 && percent < 100.0 {
        "99 %".to_owned()
    } else {
        format!("{percent:.0} %")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{Range, Spread, View, headline};

    fn range(p05: f64, p95: f64, least: f64, most: f64) -> Range {
        Range { p05, p50: 0.5 * (p05 + p95), p95, least, most }
    }

    fn spread(variants: u32, collapsed: u32) -> Spread {
        let interval = barrelstack_fragility::wilson(collapsed, variants, 0.95);
        let falls = collapsed > 0;
        Spread {
            staves_overloaded: 0,
            stave_utilization: None,
            kind: "both",
            seed: 1,
            variants,
            collapsed,
            share: (variants > 0).then(|| f64::from(collapsed) / f64::from(variants)),
            interval: [interval.low, interval.high],
            first_loss: falls.then(|| range(5.6, 6.4, 5.0, 7.0)),
            first_fall: falls.then(|| range(5.7, 6.6, 5.1, 7.2)),
            barrels_fallen: falls.then(|| range(4.0, 8.0, 4.0, 8.0)),
            counted_for: None,
            barrels: 10,
            standing_until: None,
            modes: BTreeMap::new(),
            cannot_stand: 0,
            broken: 0,
            reason: None,
            stated: "collapse",
            typical: 0,
            gentlest: 0,
            worst: 0,
        }
    }

    fn of(variants: u32, collapsed: u32) -> String {
        headline(&[(View::Transverse, &spread(variants, collapsed))])
    }

    #[test]
    fn one_plane_has_a_sentence_for_every_share() {
        let cases = [
            (
                61,
                "This stack falls: in 61 of 64 variants. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
            (
                64,
                "This stack falls: in all 64 variants. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
            (0, "This stack stands in all 64 variants: of stacks like it at most 6 % fall."),
            (
                2,
                "This stack stands: in 62 of 64 variants; in 2 it falls. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
            (
                10,
                "This stack falls in 10 of 64 variants: treat it as not safe. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
            (
                30,
                "This stack falls in half of the variants, 30 of 64: treat it as not safe. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
            (
                50,
                "This stack falls in most variants, 50 of 64: treat it as not safe. The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.",
            ),
        ];
        for (collapsed, sentence) in cases {
            assert_eq!(of(64, collapsed), sentence);
        }
        assert_eq!(of(0, 0), "None of the variants of this stack has a verdict.");
    }

    #[test]
    fn times_and_numbers_that_are_all_the_same_are_told_once() {
        let mut one = spread(64, 64);
        one.first_loss = Some(range(6.01, 6.04, 6.0, 6.1));
        one.barrels_fallen = Some(range(8.0, 8.0, 8.0, 8.0));
        let of = |one: &Spread| headline(&[(View::Longitudinal, one)]);
        assert_eq!(
            of(&one),
            "This stack falls: in all 64 variants. The first seat is lost after 6.0 s; 8 of 10 barrels fall."
        );
        one.barrels_fallen = Some(range(10.0, 10.0, 10.0, 10.0));
        one.counted_for = Some(2.0);
        assert!(of(&one).ends_with("after 6.0 s; all 10 barrels fall within 2 s of that."));
        one.first_fall = None;
        assert!(of(&one).ends_with("after 6.0 s; no barrel falls within 2 s of that."));
    }

    #[test]
    fn what_falls_by_itself_or_has_no_verdict_comes_first_and_counts() {
        let mut one = spread(61, 2);
        (one.cannot_stand, one.broken) = (2, 4);
        let said = headline(&[(View::Transverse, &one)]);
        assert_eq!(
            said,
            "2 of 65 variants fall under their own weight, before they are shaken. 4 of 65 variants have no verdict: \
             they could not be built or their numbers broke down; the verdict counts them as falling. This stack falls \
             in 2 of 61 variants, before it is shaken: treat it as not safe."
        );
        // The same counts in both planes.
        let both = headline(&[(View::Transverse, &spread(64, 0)), (View::Longitudinal, &one)]);
        assert!(
            both.starts_with("Along the barrels, 2 of 65 variants fall under their own weight"),
            "{both}"
        );
        assert!(
            both.contains("Not safe. Shaken along the barrels 2 of 61 variants fall"),
            "{both}"
        );
        // Variants without a verdict do not count as standing.
        (one.cannot_stand, one.collapsed, one.share) = (0, 0, Some(0.0));
        let said = headline(&[(View::Transverse, &one)]);
        assert!(
            said.ends_with(
                "stands in all 61 variants, and others have no verdict: treat it as not safe."
            ),
            "{said}"
        );
    }

    #[test]
    fn a_motion_that_is_cut_has_not_been_stood() {
        let mut one = spread(64, 0);
        one.standing_until = Some(1.0);
        assert_eq!(
            headline(&[(View::Transverse, &one)]),
            "Until 1.0 s, where the runs end and the motion does not, this stack stands in all 64 variants."
        );
        let both = headline(&[(View::Transverse, &one), (View::Longitudinal, &one)]);
        assert!(
            both.starts_with("Not decided, since the runs end before the motion does. Shaken"),
            "{both}"
        );
    }

    #[test]
    fn both_planes_have_the_verdict_of_the_worse() {
        let both = |across, along| {
            headline(&[
                (View::Transverse, &spread(64, across)),
                (View::Longitudinal, &spread(64, along)),
            ])
        };
        assert_eq!(
            both(25, 62),
            "Falls. Shaken along the barrels 62 of 64 variants fall (89–99 %), across them 25 of 64 fall (28–51 %)."
        );
        assert_eq!(
            both(0, 0),
            "Stands. Shaken across the barrels none of 64 variants falls (at most 6 %), along them none of 64 falls (at \
             most 6 %)."
        );
        assert_eq!(
            both(64, 1),
            "Falls. Shaken across the barrels all 64 variants fall (at least 94 %), along them 1 of 64 falls (1–8 %)."
        );
        assert!(
            both(3, 20)
                .starts_with("Not safe. Shaken along the barrels 20 of 64 variants fall (21–43 %)")
        );
        let none =
            headline(&[(View::Transverse, &spread(0, 0)), (View::Longitudinal, &spread(64, 64))]);
        assert_eq!(
            none,
            "Falls. Shaken along the barrels all 64 variants fall (at least 94 %), across them none has a verdict."
        );
        let none =
            headline(&[(View::Transverse, &spread(0, 0)), (View::Longitudinal, &spread(0, 0))]);
        assert!(none.starts_with("No variant has a verdict"), "{none}");
    }

    #[test]
    fn crushed_staves_follow_the_verdict_of_their_plane() {
        let mut one = spread(64, 0);
        one.stave_utilization = Some(0.97);
        assert!(!headline(&[(View::Transverse, &one)]).contains("staves"));
        (one.staves_overloaded, one.stave_utilization) = (5, Some(1.308));
        let crushed = "5 of 64 variants staves are crushed before any seat is lost: they bear up to 131 % of what they \
                       are stated to bear.";
        let said = headline(&[(View::Transverse, &one)]);
        assert!(said.ends_with(&format!("at most 6 % fall. In {crushed}")), "{said}");
        let both = headline(&[(View::Transverse, &spread(64, 0)), (View::Longitudinal, &one)]);
        assert!(
            both.ends_with(&format!("(at most 6 %). Along the barrels, in {crushed}")),
            "{both}"
        );
    }
}
