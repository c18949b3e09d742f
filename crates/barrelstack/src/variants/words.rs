//! Sentences about the results of variants.

mod range;
mod shown;

use barrelstack_report::{Dots, Tone, capital};

use super::Spread;
use crate::scenario::{Scenario, View};
use crate::summary::Summary;

use range::depends_on;
pub use range::measure;
pub use shown::{ShownOutcome, shown_run};

/// Smallest share of collapsing variants for which the verdict is "Falls".
const FALLS: f64 = 0.9;

/// Largest share of collapsing variants for which the verdict is "Stands".
const STANDS: f64 = 0.05;

/// Number of variants needed for the verdict "Stands". With seven variants of which none falls, up
/// to 35 % of such stacks may still fall.
pub const ENOUGH: u32 = 8;

/// Verdict on a stack in one plane or in three dimensions; verdicts are ordered from best to worst.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Judgment {
    Stands,
    /// No variant falls, but fewer than [`ENOUGH`] variants have a verdict.
    TooFew,
    /// The runs end at this time (s), before the motion ends. At most a share of [`STANDS`] of the variants falls.
    Cut(f64),
    /// No variant could be judged.
    None,
    NotSafe,
    Falls,
}

impl Judgment {
    /// Judges a stack by the share of variants that collapse; variants without a verdict count as
    /// collapsed.
    fn of(spread: &Spread) -> Self {
        match (judged_share(spread), spread.standing_until) {
            (None, _) => Self::None,
            (Some(share), _) if share >= FALLS => Self::Falls,
            (Some(share), _) if share > STANDS => Self::NotSafe,
            (_, Some(until)) => Self::Cut(until),
            _ if spread.variants < ENOUGH => Self::TooFew,
            _ => Self::Stands,
        }
    }

    /// Returns the worst verdict of all planes; `None` if there are no planes.
    fn worst<'a>(spreads: impl IntoIterator<Item = &'a Spread>) -> Option<Self> {
        let worse = |a, b| match (a, b) {
            (Self::Cut(one), Self::Cut(other)) => Self::Cut(one.min(other)),
            (a, b) if a < b => b,
            (a, _) => a,
        };
        spreads.into_iter().map(Self::of).reduce(worse)
    }

    /// Returns the verdict as a sentence, such as "Not safe.".
    fn words(self) -> String {
        match self {
            Self::Stands => "Stands.".to_owned(),
            Self::TooFew => "Too few variants to conclude that the stack stands.".to_owned(),
            Self::Cut(until) => {
                format!(
                    "Not decided, because the runs end at {until:.1} s, before the motion ends."
                )
            }
            Self::None => "No verdict.".to_owned(),
            Self::NotSafe => "Not safe.".to_owned(),
            Self::Falls => "Falls.".to_owned(),
        }
    }
}

/// Plane and statistics of variants; the plane is `None` for a three-dimensional model.
type Placed<'a> = (Option<View>, &'a Spread);

/// Describes the results of the variants in one plane or in both: the verdict and the counts that support it. In
/// `planes`, the plane across the barrels comes before the plane along the barrels.
pub fn headline(planes: &[(View, &Spread)]) -> String {
    let placed: Vec<Placed<'_>> =
        planes.iter().map(|(view, spread)| (Some(*view), *spread)).collect();
    answer(&placed)
}

/// Works like [`headline`], for a three-dimensional model of a stack.
pub fn headline_in_space(spread: &Spread) -> String {
    answer(&[(None, spread)])
}

/// Describes, in this order: the verdict of the worst plane with the counts of all planes, variants that fall before the
/// shaking or have no verdict, the influence of the uncertain constants in the worst plane, the course of the
/// collapse if there is only one plane, and stave overload.
fn answer(planes: &[Placed<'_>]) -> String {
    let mut sentences: Vec<String> = verdict(planes).into_iter().collect();
    sentences.extend(planes.iter().flat_map(|plane| exceptions(*plane)));
    sentences.extend(worst(planes).and_then(depends_on));
    if let [(_, spread)] = planes
        && spread.collapsed > spread.cannot_stand
    {
        sentences.push(format!("{}.", capital(&course(spread))));
    }
    sentences.extend(planes.iter().filter_map(|plane| overloaded(*plane)));
    sentences.join(" ")
}

/// Returns the planes in the order of their shares of collapses, the largest share first; planes
/// with equal shares keep their order.
fn worst_first<'a>(planes: &[Placed<'a>]) -> Vec<Placed<'a>> {
    let mut sorted = planes.to_vec();
    let severity = |spread| judged_share(spread).unwrap_or(-1.0);
    sorted.sort_by(|(_, a), (_, b)| severity(b).total_cmp(&severity(a)));
    sorted
}

fn worst<'a>(planes: &[Placed<'a>]) -> Option<Placed<'a>> {
    worst_first(planes).into_iter().next()
}

/// Returns the sentence that states the verdict and the counts that support it; the counts of the worst plane come
/// first. `None` if there are no planes.
fn verdict(planes: &[Placed<'_>]) -> Option<String> {
    let judgment = Judgment::worst(planes.iter().map(|(_, spread)| *spread))?;
    let worst_first = worst_first(planes);
    // "Shaken" is omitted if some variants fall before they are shaken.
    let shaken = planes.iter().all(|(_, spread)| spread.cannot_stand == 0);
    let clause = |(number, &(view, spread)): (usize, &Placed<'_>)| {
        // The first clause names the barrels and the variants.
        let (noun, barrels) = if number == 0 { (" variants", "the barrels") } else { ("", "them") };
        let counts =
            counts(spread, noun).unwrap_or_else(|| "no variant could be judged".to_owned());
        match view.map(|view| view.words().replace("the barrels", barrels)) {
            Some(place) if number == 0 && shaken => format!("shaken {place}, {counts}"),
            Some(place) => format!("{place}, {counts}"),
            None => counts,
        }
    };
    let clauses: Vec<String> = worst_first.iter().enumerate().map(clause).collect();
    Some(format!("{} {}.", judgment.words(), capital(&clauses.join("; "))))
}

/// Describes stave overload; `None` if there is none.
fn overloaded((view, spread): Placed<'_>) -> Option<String> {
    let load = spread.stave_utilization.filter(|_| spread.staves_overloaded > 0)?;
    let place = view.map_or_else(String::new, |view| format!("{}, ", view.words()));
    Some(capital(&format!(
        "{place}in {} of {} variants, staves are crushed before any seat is lost: their load reaches up to {:.0} % \
         of their stated capacity.",
        spread.staves_overloaded,
        spread.variants,
        100.0 * load
    )))
}

/// Returns the outcomes of the variants in each plane, to be drawn as one dot for each variant; the plane with the
/// largest share of collapses comes first, as in the headline.
pub fn dots(planes: &[(View, &Spread)]) -> Vec<Dots> {
    let placed: Vec<Placed<'_>> =
        planes.iter().map(|(view, spread)| (Some(*view), *spread)).collect();
    worst_first(&placed).into_iter().map(|(view, spread)| dots_of(view, spread)).collect()
}

/// Returns the outcomes of the variants in one plane or, if `view` is `None`, in three dimensions.
pub fn dots_of(view: Option<View>, spread: &Spread) -> Dots {
    Dots {
        direction: view.map(|view| view.words().to_owned()).unwrap_or_default(),
        fell: spread.collapsed,
        stood: spread.variants - spread.collapsed,
        open: spread.broken,
    }
}

/// Returns the tone of the verdict of the worst plane.
pub fn tone(planes: &[(View, &Spread)]) -> Tone {
    match Judgment::worst(planes.iter().map(|(_, spread)| *spread)) {
        None | Some(Judgment::None) => Tone::Invalid,
        Some(Judgment::Stands) => Tone::Stands,
        Some(Judgment::TooFew | Judgment::Cut(_)) => Tone::Neutral,
        Some(Judgment::NotSafe | Judgment::Falls) => Tone::Falls,
    }
}

/// Returns a phrase for all variants, such as "both variants" or "all 64 variants".
fn all_of(variants: u32) -> String {
    match variants {
        1 => "the one variant".to_owned(),
        2 => "both variants".to_owned(),
        more => format!("all {more} variants"),
    }
}

/// Returns a phrase for all variants that fall, such as "both variants that fall" or "all 15 variants that fall".
pub fn all_that_fall(collapsed: u32) -> String {
    format!("{} that fall{}", all_of(collapsed), if collapsed == 1 { "s" } else { "" })
}

/// Returns the share of collapsed variants on which the verdict is based; variants without a verdict count as
/// collapsed. `None` if no variant has a verdict.
fn judged_share(spread: &Spread) -> Option<f64> {
    spread.share.and(spread.largest_share())
}

/// Describes how many variants fall, with the 95 % interval of their share, such as "53 of 64
/// variants fall (72–90 %)"; `None` if no variant has a verdict.
fn counts(spread: &Spread, noun: &str) -> Option<String> {
    let Spread { variants, collapsed, interval, .. } = spread;
    let [low, high] = interval.map(percent);
    spread.share?;
    let bound = |words: &str, share: &str| format!("95 % confidence: at {words} {share}");
    let [least, most] = [bound("least", &low), bound("most", &high)];
    Some(match *collapsed {
        0 if *variants == 1 => format!("the one variant stands ({most} fall)"),
        0 => format!("none of {variants}{noun} falls ({most})"),
        1 if *variants == 1 => format!("the one variant falls ({least} fall)"),
        all if all == *variants => format!("all {all}{noun} fall ({least})"),
        one => {
            let fall = if one == 1 { "falls" } else { "fall" };
            format!("{one} of {variants}{noun} {fall} ({}–{high})", low.trim_end_matches(" %"))
        }
    })
}

/// Returns the sentences that support the headline of a run and its variants.
pub(crate) fn sentences(summary: &Summary) -> Vec<String> {
    let planes = summary.spreads();
    let placed: Vec<Placed<'_>> =
        planes.iter().map(|(view, spread)| (Some(*view), *spread)).collect();
    let mut sentences: Vec<String> =
        worst(&placed).and_then(|(_, spread)| measure(spread)).into_iter().collect();
    let falls = planes.iter().filter(|(_, spread)| spread.collapsed > 0);
    let sentence = |(view, spread): &(View, &Spread)| {
        format!(
            "In the variants in which the stack falls {}, {}.",
            view.words(),
            course_in_plane(spread)
        )
    };
    sentences.extend(falls.filter(|_| planes.len() > 1).map(sentence));
    sentences
}

/// Describes the run that is shown, the outcome of the stack as stated, and how the variants differ from this stack.
/// All sentences are about the plane of `summary`.
pub(crate) fn fine(summary: &Summary, scenario: &Scenario) -> Vec<String> {
    let (Some(spread), Some(imperfections), Some(unknowns)) =
        (&summary.ensemble, scenario.imperfections(), scenario.unknowns())
    else {
        return Vec::new();
    };
    let mut sentences = Vec::new();
    let planes = summary.spreads();
    let typical =
        if summary.variant == spread.typical { ", the most typical of all runs" } else { "" };
    let named = |number: u32| match number {
        0 => "the stack as stated".to_owned(),
        number => format!("variant {number}"),
    };
    let decides = planes.iter().find(|(view, _)| Some(view.name()) == summary.view);
    let plane = decides.filter(|_| planes.len() > 1).map(|(view, _)| format!("{}, ", view.words()));
    sentences.push(format!(
        "The run that is shown is that of {}{typical}; {}{} is the gentlest and {} the worst.",
        named(summary.variant),
        plane.unwrap_or_default(),
        named(spread.gentlest),
        named(spread.worst)
    ));
    let stated = match (spread.stated, spread.standing_until) {
        ("collapse", _) => "falls".to_owned(),
        ("stable", None) => "stands".to_owned(),
        ("stable", Some(until)) => format!("stands until the runs end at {until:.1} s"),
        _ => "has no verdict".to_owned(),
    };
    let places = format!(
        "in the positions of the bodies (by up to {} mm) and in their masses (with a standard deviation of {} %)",
        tenths(1e3 * imperfections.placement),
        tenths(100.0 * imperfections.mass)
    );
    let constants = "in the friction and contact constants (drawn within their uncertainty)";
    let differ = match (imperfections.drawn, unknowns.drawn) {
        (true, false) => format!("differ from it {places}"),
        (false, true) => format!("differ from it {constants}"),
        (true, true) => format!("differ from it {places}, and {constants}"),
        (false, false) if imperfections.sign => {
            "differ from it only in that half of them are mirrored".to_owned()
        }
        (false, false) => "do not differ from it".to_owned(),
    };
    sentences.push(format!("The stack as stated {stated}; the variants {differ}."));
    sentences
}

/// Returns `true` if the share of variants that fall is small enough for the verdict "Stands", however few variants
/// were run.
pub(crate) fn stands(spread: &Spread) -> bool {
    judged_share(spread).is_some_and(|share| share <= STANDS)
}

/// Describes the result of a stack, such as "falls in 97 % of variants".
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

/// Describes the time and the extent of the fall, such as "the first seat is lost between 5.6 and
/// 6.4 s; 4 to 8 of 10 barrels fall".
pub fn course(spread: &Spread) -> String {
    course_of("barrels", spread)
}

/// Describes the fall as [`course`] does, but for one plane of a stack that was simulated in both planes. The barrels
/// are called "barrels in this plane".
pub(crate) fn course_in_plane(spread: &Spread) -> String {
    course_of("barrels in this plane", spread)
}

fn course_of(noun: &str, spread: &Spread) -> String {
    if spread.collapsed == spread.cannot_stand {
        return "the stack falls before it is shaken".to_owned();
    }
    let when = spread.first_loss.map_or_else(String::new, |first| {
        let shaken = spread.collapsed - spread.cannot_stand;
        let [from, to] = first.stated(shaken).map(|time| format!("{time:.1}"));
        if from == to {
            format!("the first seat is lost at {from} s; ")
        } else {
            format!("the first seat is lost between {from} and {to} s; ")
        }
    });
    let fallen = match (spread.first_fall, spread.barrels_fallen) {
        (Some(_), Some(fallen)) => {
            let range = fallen.stated(spread.collapsed);
            let fall = if range[1] < 1.5 && range[0] > 0.5 { "falls" } else { "fall" };
            format!("{} {fall}", barrels(range, spread.barrels, noun))
        }
        _ => "no barrel falls".to_owned(),
    };
    format!("{when}{fallen}{}", spread.counted("that loss"))
}

/// Describes the number of fallen barrels, such as "4 to 8 of 10 barrels"; `noun` is the word for the barrels.
fn barrels(fallen: [f64; 2], all: usize, noun: &str) -> String {
    let [from, to] = fallen.map(|count| format!("{count:.0}"));
    if from != to {
        format!("{from} to {to} of {all} {noun}")
    } else if to == all.to_string() {
        format!("all {all} {noun}")
    } else {
        format!("{to} of {all} {noun}")
    }
}

/// Returns the sentences about variants that fall under their own weight and about variants without a verdict.
fn exceptions((view, spread): Placed<'_>) -> Vec<String> {
    let place = view.map_or_else(String::new, |view| format!("{}, ", view.words()));
    let (fallen, broken, all) = (spread.cannot_stand, spread.broken, spread.run());
    let counted =
        |count: u32| if count == all { all_of(all) } else { format!("{count} of {all} variants") };
    let mut sentences = Vec::new();
    if fallen > 0 {
        let verb = match (fallen == all, fallen) {
            (true, 1) => "falls",
            (true, _) => "fall",
            (false, 1) => "does so",
            (false, _) => "do so",
        };
        let who = if fallen == all {
            all_of(all)
        } else if fallen == spread.collapsed {
            all_that_fall(fallen)
        } else {
            format!("{fallen} of the variants that fall")
        };
        let (their, they) = if fallen == 1 { ("its", "it is") } else { ("their", "they are") };
        sentences
            .push(format!("{place}{who} {verb} under {their} own weight, before {they} shaken."));
    }
    if broken > 0 {
        let has = if broken == 1 { "has" } else { "have" };
        sentences.push(format!(
            "{place}{} {has} no verdict, because a model could not be built or a computation failed; the verdict counts such variants as falling.",
            counted(broken)
        ));
    }
    sentences.iter().map(|sentence| capital(sentence)).collect()
}

/// Rounds a number to a tenth.
fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// Formats a share in whole percent. Near 0 or 100 %, decimals are added until the distance from 0 or 100 % has one
/// significant digit: "0.3 %", "99.7 %".
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rest = percent.min(100.0 - percent);
    let mut decimals = 0;
    if 0.0 < rest && rest < 0.5 {
        let mut digit = rest;
        while digit < 0.95 && decimals < 9 {
            (digit, decimals) = (10.0 * digit, decimals + 1);
        }
    }
    format!("{percent:.decimals$} %")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::ops::ControlFlow;

    use super::{
        Scenario, ShownOutcome, Spread, Tone, View, fine, headline, headline_in_space, measure,
        percent, shown_run, tone,
    };
    use crate::variants::{Range, RunChoice, ShareAt, Unknown, answer};

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
            range: None,
            share_as_stated: None,
            decides: Vec::new(),
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
    fn one_plane_has_its_counts_and_its_course() {
        let course = "The first seat is lost between 5.6 and 6.4 s; 4 to 8 of 10 barrels fall.";
        let cases = [
            (
                64,
                "Falls. Shaken across the barrels, all 64 variants fall (95 % confidence: at least 94 %).",
            ),
            (61, "Falls. Shaken across the barrels, 61 of 64 variants fall (87–98 %)."),
            (50, "Not safe. Shaken across the barrels, 50 of 64 variants fall (67–86 %)."),
            (10, "Not safe. Shaken across the barrels, 10 of 64 variants fall (9–26 %)."),
            (1, "Stands. Shaken across the barrels, 1 of 64 variants falls (0.3–8 %)."),
        ];
        for (collapsed, sentences) in cases {
            // For few falls, the sentence states the first and the last time instead of fractiles.
            let course =
                if collapsed < 20 { &course.replace("5.6 and 6.4", "5.0 and 7.0") } else { course };
            assert_eq!(of(64, collapsed), format!("{sentences} {course}"));
        }
        let none = "Shaken across the barrels, none of";
        assert_eq!(
            of(64, 0),
            format!("Stands. {none} 64 variants falls (95 % confidence: at most 6 %).")
        );
        assert_eq!(
            of(8, 0),
            format!("Stands. {none} 8 variants falls (95 % confidence: at most 32 %).")
        );
        let few = format!(
            "Too few variants to conclude that the stack stands. {none} 7 variants falls (95 % confidence: at most \
             35 %)."
        );
        assert_eq!(of(7, 0), few);
        let one = "Shaken across the barrels, the one variant";
        let [stands, falls] = [of(1, 0), of(1, 1)];
        let most = format!("{one} stands (95 % confidence: at most 79 % fall).");
        assert!(stands.ends_with(&most), "{stands}");
        let least = format!("{one} falls (95 % confidence: at least 21 % fall).");
        assert!(falls.contains(&least), "{falls}");
        let unknown = "No verdict. Shaken across the barrels, no variant could be judged.";
        assert_eq!(of(0, 0), unknown);
        let in_space = headline_in_space(&spread(64, 64));
        let all = "Falls. All 64 variants fall (95 % confidence: at least 94 %).";
        assert_eq!(in_space, format!("{all} {course}"));
    }

    #[test]
    fn times_and_numbers_that_are_all_the_same_are_reported_once() {
        let mut one = spread(64, 64);
        one.first_loss = Some(range(6.01, 6.04, 6.0, 6.1));
        one.barrels_fallen = Some(range(8.0, 8.0, 8.0, 8.0));
        let of = |one: &Spread| headline(&[(View::Longitudinal, one)]);
        let said = of(&one);
        assert!(
            said.ends_with(" The first seat is lost at 6.0 s; 8 of 10 barrels fall."),
            "{said}"
        );
        one.barrels_fallen = Some(range(10.0, 10.0, 10.0, 10.0));
        one.counted_for = Some(2.0);
        assert!(of(&one).ends_with("at 6.0 s; all 10 barrels fall within 2 s of that loss."));
        one.first_fall = None;
        let said = of(&one);
        assert!(said.ends_with("at 6.0 s; no barrel falls within 2 s of that loss."), "{said}");
    }

    #[test]
    fn what_falls_by_itself_or_has_no_verdict_counts_and_follows_the_verdict() {
        let mut one = spread(61, 2);
        (one.cannot_stand, one.broken) = (2, 4);
        let said = headline(&[(View::Transverse, &one)]);
        assert_eq!(
            said,
            "Not safe. Across the barrels, 2 of 61 variants fall (1–11 %). Across the barrels, both variants that \
             fall do so under their own weight, before they are shaken. Across the barrels, 4 of 65 variants have no \
             verdict, because a model could not be built or a computation failed; the verdict counts such variants as falling."
        );
        // The same counts in both planes.
        let both = headline(&[(View::Transverse, &spread(64, 0)), (View::Longitudinal, &one)]);
        assert!(
            both.contains(
                "). Along the barrels, both variants that fall do so under their own weight"
            ),
            "{both}"
        );
        // Of the variants that fall, all, one or some do so under their own weight.
        for (fallen, who) in [
            (1, "the one variant that falls does so under its own weight, before it is shaken."),
            (5, "all 5 variants that fall do so under their own weight, before they are shaken."),
        ] {
            let mut one = spread(61, fallen);
            one.cannot_stand = fallen;
            let said = headline(&[(View::Transverse, &one)]);
            assert!(said.ends_with(&format!(" Across the barrels, {who}")), "{said}");
        }
        let mut some = spread(61, 7);
        some.cannot_stand = 2;
        let said = headline(&[(View::Transverse, &some)]);
        assert!(said.contains(", 2 of the variants that fall do so under their own"), "{said}");
        // Variants that fall before they are shaken are not reported as falling when shaken.
        assert!(both.contains("Not safe. Along the barrels, 2 of 61 variants fall"), "{both}");
        // Variants without a verdict do not count as standing.
        (one.cannot_stand, one.collapsed, one.share) = (0, 0, Some(0.0));
        let said = headline(&[(View::Transverse, &one)]);
        assert!(
            said.contains("Not safe. Shaken across the barrels, none of 61 variants falls"),
            "{said}"
        );
    }

    #[test]
    fn a_motion_that_is_cut_has_not_been_stood() {
        let [mut one, mut later] = [spread(64, 0), spread(64, 0)];
        (one.standing_until, later.standing_until) = (Some(1.0), Some(2.0));
        let cut = "Not decided, because the runs end at 1.0 s, before the motion ends. Shaken ";
        for planes in [
            vec![(View::Transverse, &one)],
            vec![(View::Transverse, &one), (View::Longitudinal, &later)],
            // A plane in which more variants fall, but few enough for the verdict "Stands", does not
            // change the verdict.
            vec![(View::Transverse, &one), (View::Longitudinal, &spread(64, 1))],
        ] {
            assert!(headline(&planes).starts_with(cut), "{}", headline(&planes));
            assert_eq!(tone(&planes), Tone::Neutral);
        }
    }

    #[test]
    fn shares_near_none_and_all_have_a_digit_that_counts() {
        let shares = [0.0, 1e-5, 0.0028, 0.0051, 0.126, 0.994, 0.9972, 0.99996, 1.0];
        let shown = ["0", "0.001", "0.3", "1", "13", "99", "99.7", "99.996", "100"];
        for (share, shown) in shares.into_iter().zip(shown) {
            assert_eq!(percent(share), format!("{shown} %"));
        }
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
            "Falls. Shaken along the barrels, 62 of 64 variants fall (89–99 %); across them, 25 of 64 fall (28–51 %)."
        );
        assert_eq!(
            both(0, 0),
            "Stands. Shaken across the barrels, none of 64 variants falls (95 % confidence: at most 6 %); along them, \
             none of 64 falls (95 % confidence: at most 6 %)."
        );
        assert_eq!(
            both(64, 1),
            "Falls. Shaken across the barrels, all 64 variants fall (95 % confidence: at least 94 %); along them, 1 of \
             64 falls (0.3–8 %)."
        );
        assert!(
            both(3, 20).starts_with(
                "Not safe. Shaken along the barrels, 20 of 64 variants fall (21–43 %)"
            )
        );
        let none =
            headline(&[(View::Transverse, &spread(0, 0)), (View::Longitudinal, &spread(64, 64))]);
        assert_eq!(
            none,
            "Falls. Shaken along the barrels, all 64 variants fall (95 % confidence: at least 94 %); across them, no \
             variant could be judged."
        );
        let none =
            headline(&[(View::Transverse, &spread(0, 0)), (View::Longitudinal, &spread(64, 0))]);
        assert!(none.starts_with("No verdict. Shaken along the barrels, none of 64"), "{none}");
    }

    fn shown<'a>(view: Option<View>, kind: &'a str, spread: &'a Spread) -> ShownOutcome<'a> {
        ShownOutcome { view, kind, spread }
    }

    #[test]
    fn the_shown_run_is_named_with_its_outcome_beside_those_of_all_variants() {
        let (few, many) = (spread(64, 12), Spread { typical: 15, ..spread(64, 53) });
        assert_eq!(
            shown_run(15, &[shown(None, "stable", &many)]),
            "The run that is shown is that of variant 15, the most typical of all runs: the stack stands, while 53 of 64 \
             variants fall."
        );
        let both = [
            shown(Some(View::Transverse), "stable", &few),
            shown(Some(View::Longitudinal), "collapse", &many),
        ];
        assert_eq!(
            shown_run(3, &both),
            "The run that is shown is that of variant 3: across the barrels, the stack stands, while 12 of 64 variants \
             fall; along the barrels, the stack falls, as do 53 of 64 variants."
        );
        let named =
            "The run that is shown is that of the stack as stated, the most typical of all runs:";
        for (kind, collapsed, words) in [
            ("stable", 0, "the stack stands"),
            ("stable", 1, "the stack stands, while 1 of 64 variants falls"),
            ("stable", 64, "the stack stands, while all 64 variants fall"),
            ("collapse", 64, "the stack falls"),
            ("collapse", 1, "the stack falls, as does 1 of 64 variants"),
            ("collapse", 0, "the stack falls, while none of 64 variants falls"),
            ("invalid", 1, "the stack has no verdict"),
        ] {
            let all = spread(64, collapsed);
            let said = shown_run(0, &[shown(None, kind, &all)]);
            assert_eq!(said, format!("{named} {words}."));
        }
        let cut = Spread { standing_until: Some(1.0), ..spread(64, 0) };
        let said = shown_run(0, &[shown(None, "stable", &cut)]);
        assert_eq!(said, format!("{named} the stack stands until the runs end at 1.0 s."));
        assert_eq!(shown_run(0, &[]), "");
    }

    #[test]
    fn crushed_staves_follow_the_verdict_of_their_plane() {
        let mut one = spread(64, 0);
        one.stave_utilization = Some(0.97);
        assert!(!headline(&[(View::Transverse, &one)]).contains("staves"));
        (one.staves_overloaded, one.stave_utilization) = (5, Some(1.308));
        let crushed = "5 of 64 variants, staves are crushed before any seat is lost: their load reaches up to 131 % of \
                       their stated capacity.";
        let said = headline(&[(View::Transverse, &one)]);
        assert!(
            said.ends_with(&format!(
                "(95 % confidence: at most 6 %). Across the barrels, in {crushed}"
            )),
            "{said}"
        );
        let both = headline(&[(View::Transverse, &spread(64, 0)), (View::Longitudinal, &one)]);
        assert!(
            both.ends_with(&format!(
                "(95 % confidence: at most 6 %). Along the barrels, in {crushed}"
            )),
            "{both}"
        );
    }

    #[test]
    fn the_range_over_uncertain_constants_follows_the_verdict_of_the_worst_plane() {
        let at = |value: f64, share: f64| ShareAt { value, share, interval: [share, share] };
        let unknown = |difference| Unknown {
            name: "stiffness of seats",
            field: "interface.barrel-rack.stiffness",
            unit: "N/m",
            dispersion: 0.6,
            shares: [0.96, 0.95, 0.9, 0.88, 0.82, 0.8, 0.7, 0.65, 0.59]
                .into_iter()
                .zip([1.118e6, 1.5e6, 2e6, 2.5e6, 3e6, 3.6e6, 4.3e6, 5.4e6, 8.049e6])
                .map(|(share, value)| at(value, share))
                .collect(),
            difference,
            total: 0.8,
            width_if_measured: 0.55,
        };
        let mut one = spread(64, 53);
        one.range = Some([0.17, 1.0]);
        one.decides = vec![unknown([0.1, 0.6])];
        let said = headline(&[(View::Transverse, &spread(64, 3)), (View::Longitudinal, &one)]);
        let range = "Depending on the true values of the friction, stiffness and damping of the seats, which are \
                     uncertain, 17 to 100 % of such stacks fall in the direction along the barrels (95 % range); the \
                     share of variants that fall is an average over these values. ";
        let decides = "The stiffness of seats changes this share most: 96 % fall at 1.1 MN/m, 59 % fall at 8.0 MN/m.";
        assert!(said.contains(&format!("(2–13 %). {range}{decides}")), "{said}");
        let measured = measure(&one).unwrap();
        let left =
            "On average, this measurement narrows the range from 83 to 55 percentage points.";
        assert!(measured.contains("read how far it sinks. ") && measured.ends_with(left));
        // A constant does not decide if its effect may be zero, or if its effect is certain but small.
        one.decides = vec![unknown([-0.1, 0.6])];
        let said = headline(&[(View::Longitudinal, &one)]);
        assert!(
            said.contains(&format!(
                "{range}In this direction, no single one of these constants has a large and statistically significant effect."
            )),
            "{said}"
        );
        // If the smallest share occurs at the median, the sentence also states the share at the median.
        one.decides = vec![unknown([0.1, 0.6])];
        one.decides[0].shares[4].share = 0.25;
        let said = headline(&[(View::Longitudinal, &one)]);
        assert!(
            said.contains("96 % fall at 1.1 MN/m, 25 % fall at 3.0 MN/m, 59 % fall at 8.0 MN/m."),
            "{said}"
        );
        one.range = Some([0.94, 1.0]);
        let said = headline_in_space(&one);
        let little = "The friction, stiffness and damping of the seats are uncertain, but matter little: depending \
                      on their true values, 94 to 100 % of such stacks fall (95 % range).";
        assert!(said.contains(little), "{said}");
        // A measurement that does not narrow the range is not recommended.
        one.range = Some([0.4, 1.0]);
        assert_eq!(measure(&one), None);
    }

    #[test]
    fn mirrored_variants_are_stated_if_nothing_else_differs() {
        let said = |sign: &str| {
            let changes = [
                "run.duration=0.1 s",
                "imperfections.variants=2",
                "imperfections.drawn=false",
                "unknowns.drawn=false",
                sign,
            ]
            .map(str::to_owned);
            let scenario = Scenario::builtin("candia-8-barrels", &changes).unwrap();
            let mut go = |_| ControlFlow::Continue(());
            let answer = answer(&scenario, RunChoice::Number(0), &mut go).unwrap();
            fine(&answer.decides.summary, &scenario).join(" ")
        };
        assert!(said("imperfections.sign=false").contains("the variants do not differ from it"));
        let mirrored = said("imperfections.sign=true");
        let half = "differ from it only in that half of them are mirrored";
        assert!(mirrored.contains(half), "{mirrored}");
    }
}
