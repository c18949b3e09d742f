//! Page of a comparison: verdict, synchronized players, tables and superimposed histories.

use std::cmp::Ordering;

use barrelstack_report::{
    Axis, Block, Document, Figure, History, Mark, Pane, Players, Plot, Series, SeriesStyle,
    Verdict, capital, listed, significant,
};

use super::{Difference, OtherPlane, Paired, Side, Traced, differences, letter, tables};
use crate::outcome::Outcome;
use crate::report;
use crate::scenario::{View, title};
use crate::variants::{Spread, words};

/// Builds the comparison as a document that is independent of any output format.
pub fn document(sides: &[Side]) -> Document {
    let differing = differences(sides.iter().map(|side| &side.stated));
    let mut blocks = vec![Block::Players(players(sides))];
    let letters: Vec<String> = (0..sides.len()).map(|at| letter(at).to_string()).collect();
    let mut section = |title: &str, content: Vec<Block>| {
        if !content.is_empty() {
            blocks.push(Block::heading(2, title));
            blocks.extend(content);
        }
    };
    section("Differences", vec![Block::Table(tables::inputs(&letters, &differing))]);
    section("Outcomes", vec![Block::Table(tables::outcomes(sides))]);
    section("Demands", vec![Block::Table(tables::demands(sides))]);
    section("Histories", histories(sides));
    let common = vec![Block::Table(tables::common(sides, &differing))];
    let common = Block::details_on_screen("Inputs that are equal in all runs", common);
    section("Inputs in common", vec![common]);
    Document {
        title: heading(sides),
        verdict: verdict(sides, &differing),
        blocks,
        provenance: provenance(sides),
        words: report::WORDS.to_vec(),
        warnings: sides
            .iter()
            .enumerate()
            .flat_map(|(at, side)| {
                side.summary.warnings().iter().map(move |text| format!("{}: {text}", letter(at)))
            })
            .collect(),
        ..Document::default()
    }
}

fn fate(side: &Side) -> String {
    if let Some(spread) = side.summary.ensemble() {
        return words::fate(spread);
    }
    let one = |outcome: &Outcome| match outcome {
        Outcome::Stable => "stands".to_owned(),
        Outcome::Collapse { time, .. } => format!("gives way after {time:.1} s"),
        Outcome::NotJudged => "ran to its end".into(),
        Outcome::Interrupted => "was stopped before its end and gives no result".into(),
        Outcome::Invalid { .. } => "failed and gives no result".into(),
    };
    match (&side.other, side.view) {
        (Some(OtherPlane { view, outcome, .. }), Some(shown)) => {
            format!("{} {}, {} {}", shown.words(), one(&side.outcome), view.words(), one(outcome))
        }
        _ => one(&side.outcome),
    }
}

/// Returns the outcome of a single run in each plane that was analyzed, the shown plane first.
fn singles(side: &Side) -> impl Iterator<Item = (Option<View>, &Outcome)> {
    let shown = std::iter::once((side.view, &side.outcome));
    shown.chain(side.other.iter().map(|other| (Some(other.view), &other.outcome)))
}

/// Names the planes in which a single run collapses, such as " (along the barrels)"; empty unless both planes were
/// analyzed.
fn falls_where(side: &Side) -> String {
    let falls = singles(side).filter(|(_, outcome)| outcome.is_collapse());
    let views: Vec<&str> = falls.filter_map(|(view, _)| Some(view?.words())).collect();
    if share(side).is_some() || side.other.is_none() || views.is_empty() {
        return String::new();
    }
    format!(" ({})", listed(views))
}

/// Returns the names of the runs, followed by the title if all runs have the same title.
fn heading(sides: &[Side]) -> String {
    let names = format!("Comparison of {}", listed(sides.iter().map(|side| side.name.clone())));
    let first = sides.first().map(|side| &side.stated.title);
    match first.filter(|first| sides.iter().all(|side| side.stated.title == **first)) {
        Some(title) => format!("{names}: {title}"),
        None => names,
    }
}

/// Returns the statistics of the variants in each plane, the shown plane first.
fn spreads(side: &Side) -> impl Iterator<Item = &Spread> {
    let other = side.other.iter().filter_map(|other| other.spread.as_ref());
    side.summary.ensemble().into_iter().chain(other)
}

/// Returns the statistics of the plane with the larger share of collapses; `None` for a single run.
fn share(side: &Side) -> Option<&Spread> {
    spreads(side)
        .filter(|spread| spread.share.is_some())
        .reduce(|worst, one| if one.share > worst.share { one } else { worst })
}

fn stands(side: &Side) -> bool {
    match share(side) {
        Some(spread) => words::stands(spread),
        None => singles(side).all(|(_, outcome)| *outcome == Outcome::Stable),
    }
}

/// Describes how the number of collapses changes from the first run to every other run, counted over
/// paired variants; `None` if a run has no variants.
fn effect(sides: &[Side]) -> Option<String> {
    let (first, others) = sides.split_first()?;
    let pairs: Vec<Vec<Paired>> = others.iter().map(|other| Paired::of(first, other)).collect();
    if pairs.iter().any(Vec::is_empty) {
        return None;
    }
    let [second] = others else {
        let clause = |plane: usize| {
            let of = || pairs.iter().filter_map(move |planes| planes.get(plane));
            let all = of().map(Paired::pairs).min()?;
            if of().any(|pair| pair.pairs() != all || pair.without_verdict > 0) {
                return None;
            }
            let one = of().next()?;
            let base = format!("{} of {all} variants {}", one.collapsed()[0], having(first));
            let rest = of()
                .zip(others)
                .map(|(pair, other)| format!("{} {}", pair.collapsed()[1], having(other)));
            let counts = listed(std::iter::once(base).chain(rest));
            let none = of().all(|pair| pair.collapsed() == [0, 0]);
            // The other plane is named if any variant collapses in it.
            Some((plane == 0 || !none).then(|| format!("{}: {counts}", place(first, one))))
        };
        let clauses: Vec<String> = (0..pairs[0].len())
            .map(clause)
            .collect::<Option<Vec<_>>>()?
            .into_iter()
            .flatten()
            .collect();
        return Some(format!("Collapse{}.", clauses.join(";")));
    };
    let straps = |side: &Side| side.stated.stack().is_some_and(|s| s.devices.strap.levels > 0);
    let levels = |side: &Side| side.stated.stack().map(|stack| stack.levels);
    let cause = match (levels(first) == levels(second), straps(first), straps(second)) {
        (true, false, true) => "With straps".to_owned(),
        (true, true, false) => "Without straps".to_owned(),
        _ => {
            let [own, its] = [second, first].map(|side| side.name.as_str());
            let bare = |name| str::strip_prefix(name, "with ").unwrap_or(name);
            format!("With {} instead of {}", bare(own), bare(its))
        }
    };
    let clause = |(at, pair): (usize, &Paired)| {
        let ([from, to], of) = (pair.collapsed(), pair.pairs());
        let place = place(first, pair);
        let change = match to.cmp(&from) {
            Ordering::Equal => "as many as before".to_owned(),
            Ordering::Less => format!("down from {from}"),
            Ordering::Greater => format!("up from {from}"),
        };
        let unproven = if from == to || pair.is_clear() {
            ""
        } else {
            " (too few variants to prove a difference)"
        };
        let noun = if at == 0 { " variants" } else { "" };
        let collapse = if to == 1 { "collapses" } else { "collapse" };
        format!("{to} of {of}{noun} {collapse}{place}, {change}{unproven}")
    };
    // The other plane is named if any variant collapses in it.
    let named =
        pairs[0].iter().enumerate().filter(|(at, pair)| *at == 0 || pair.collapsed() != [0, 0]);
    let clauses: Vec<String> = named.map(clause).collect();
    Some(format!("{cause}, {}.", clauses.join("; ")))
}

/// Names the plane of a paired comparison, such as " across the barrels"; empty unless both planes were analyzed.
fn place(side: &Side, pair: &Paired) -> String {
    let view = View::ALL.into_iter().find(|view| Some(view.name()) == pair.view);
    let both = view.filter(|_| side.other.is_some());
    both.map_or_else(String::new, |view| format!(" {}", view.words()))
}

/// Describes, for each run after the first, how its share of collapses differs from that of the first
/// run, with the 95 % interval of the difference.
fn differences_in(sides: &[Side]) -> Vec<String> {
    let Some((first, others)) = sides.split_first() else { return Vec::new() };
    let of = |(at, other): (usize, &Side)| {
        let second = letter(at + 1);
        let sentence = move |pair: &Paired| {
            // Rounded to whole percentage points; the addition turns −0 into 0.
            let points = |share: f64| (100.0 * share).round() + 0.0;
            let ([low, high], word) = match pair.reduction {
                more if more < 0.0 => ([-pair.interval[1], -pair.interval[0]], "higher"),
                _ => (pair.interval, "lower"),
            };
            let (change, [low, high]) = (points(pair.reduction.abs()), [low, high].map(points));
            let difference = if change < 1.0 {
                "The shares of variants that collapse differ by less than one percentage point"
                    .to_owned()
            } else {
                format!("The share that collapses is {change} percentage points {word} in {second}")
            };
            let motions = if one_motion([first, other]) {
                "under the same motions"
            } else {
                "under different motions"
            };
            let lost = match pair.without_verdict {
                0 => String::new(),
                1 => " In 1 further variant, one of the two runs has no verdict.".to_owned(),
                some => format!(" In {some} further variants, one of the two runs has no verdict."),
            };
            let clear = if pair.is_clear() {
                ""
            } else {
                ": the difference is not statistically significant"
            };
            let both = match pair.both {
                1 => "1 collapses".to_owned(),
                some => format!("{some} collapse"),
            };
            let signed = |points: f64| points.to_string().replace('-', "−");
            format!(
                "Of {} variants that were run both in A and in {second}, {motions}{}, {both} in both, {} in A \
                 only and {} in {second} only. {difference} (95 % interval {} to {} points){clear}.{lost}",
                pair.pairs(),
                place(first, pair),
                pair.only_first,
                pair.only_second,
                signed(low),
                signed(high),
            )
        };
        Paired::of(first, other).iter().map(sentence).collect::<Vec<_>>()
    };
    others.iter().enumerate().flat_map(of).collect()
}

/// Describes the result of the comparison in one or two sentences.
fn headline(sides: &[Side]) -> String {
    if let Some(effect) = effect(sides) {
        return by_themselves(sides) + &effect;
    }
    let judged = |side: &Side| {
        share(side).is_some()
            || singles(side)
                .all(|(_, outcome)| outcome.is_collapse() || *outcome == Outcome::Stable)
    };
    if !sides.iter().all(judged) {
        let parts = sides.iter().map(|side| format!("{}: {}", capital(&side.name), fate(side)));
        return format!("{}.", listed(parts));
    }
    let (up, down): (Vec<&Side>, Vec<&Side>) = sides.iter().partition(|side| stands(side));
    let straps = |side: &Side| side.stated.stack().is_some_and(|s| s.devices.strap.levels > 0);
    let levels = |side: &Side| side.stated.stack().map(|stack| stack.levels);
    let one_height = sides.iter().all(|side| levels(side) == levels(&sides[0]));
    let all =
        if sides.len() == 2 { "both".to_owned() } else { format!("all {}", number(sides.len())) };
    let names =
        |some: &[&Side]| listed(some.iter().map(|side| side.name.clone() + &falls_where(side)));
    match (up.as_slice(), down.as_slice()) {
        ([up], [down]) if one_height && straps(up) && !straps(down) => {
            let barrels = up.summary.outcome().barrels;
            let fallen = share(up).map_or(0, |spread| spread.collapsed);
            match (up.other.is_some(), fallen) {
                (false, 0) if barrels > 1 => {
                    format!("Straps keep all {} barrels up.", number(barrels))
                }
                _ => "Straps keep the stack up.".to_owned(),
            }
        }
        ([up], [down]) if one_height && !straps(up) && straps(down) => {
            "Straps bring the stack down: it stands without them.".to_owned()
        }
        ([], _) => format!("{} fall: {}.", capital(&all), names(&down)),
        (_, []) => format!("{} stand: {}.", capital(&all), names(&up)),
        (up, down) => format!("Stands: {}. Falls: {}.", names(up), names(down)),
    }
}

/// Returns the warning that runs end before their ground motion does; empty unless a stack still
/// stands at the end of such a run.
fn cut_short(sides: &[Side]) -> String {
    let cut = |side: &Side| match share(side) {
        Some(spread) => spread.standing_until.is_some(),
        None => side.outcome == Outcome::Stable && side.cut.is_some(),
    };
    if !sides.iter().any(cut) {
        return String::new();
    }
    " Runs end before their motion does, so a stack that stands at the end may still fall later."
        .to_owned()
}

/// Returns the name of a run as a phrase that can follow a noun, such as "with five levels"; a name that already begins
/// with "with" or "without" is returned unchanged.
fn having(side: &Side) -> String {
    let is_said = ["with ", "without "].iter().any(|word| side.name.starts_with(word));
    if is_said { side.name.clone() } else { format!("with {}", side.name) }
}

/// Describes the runs whose variants fall under their own weight, before they are shaken.
fn by_themselves(sides: &[Side]) -> String {
    let fallen = |side: &Side| {
        let worst = spreads(side).max_by_key(|spread| spread.cannot_stand)?;
        let (some, all) = (worst.cannot_stand, worst.run());
        (some > 0).then(|| (some, format!("{some} of {all} variants {}", having(side))))
    };
    let all: Vec<(u32, String)> = sides.iter().filter_map(fallen).collect();
    let (fall, they) = match all.as_slice() {
        [] => return String::new(),
        [(1, _)] => ("falls under its", "it is"),
        _ => ("fall under their", "they are"),
    };
    let names = listed(all.into_iter().map(|(_, name)| name));
    capital(&format!("{names} {fall} own weight, before {they} shaken. "))
}

/// Describes the result of a run: the share of collapses with its interval and, if the stack
/// stands, the drift.
fn describe(at: usize, side: &Side) -> String {
    let name = format!("{}, {}", letter(at), side.name);
    let Some(spread) = share(side) else { return format!("{name}: {}.", fate(side)) };
    let shown = side.summary.ensemble() == Some(spread);
    let view = if shown { side.view } else { side.other.as_ref().map(|other| other.view) };
    let shaken = view.filter(|_| side.other.is_some());
    let shaken = shaken.map_or_else(String::new, |view| format!("shaken {}, ", view.words()));
    let [low, high] = spread.interval.map(words::percent);
    let Spread { collapsed, variants, .. } = spread;
    let result = format!(
        "{name}: {shaken}the stack falls in {collapsed} of {variants} variants (95 % interval of the share: {low} to \
         {high})"
    );
    let drift = side.summary.demands().top_drift_ratio.filter(|_| stands(side));
    match drift {
        Some(drift) => format!(
            "{result}; in the run that is shown, the top of the stack sways by up to {} % of its height.",
            significant(100.0 * drift, 2)
        ),
        None => format!("{result}."),
    }
}

fn number(count: usize) -> String {
    title::number(u32::try_from(count).unwrap_or(u32::MAX))
}

fn verdict(sides: &[Side], differing: &[Difference]) -> Verdict {
    let mut sentences: Vec<String> =
        sides.iter().enumerate().map(|(at, side)| describe(at, side)).collect();
    sentences.extend(differences_in(sides));
    let mut fine = Vec::new();
    fine.push(match differing {
        [one] => format!(
            "The runs differ in one input, {}: {}.",
            one.path,
            listed(one.values.iter().map(|value| {
                value
                    .as_ref()
                    .map_or_else(|| "absent".into(), |value| report::shown(&one.path, value))
            }))
        ),
        many => format!("The runs differ in {} inputs, listed below.", many.len()),
    });
    let view = sides[0].view;
    if let Some(view) = view.filter(|_| sides.iter().any(|side| side.other.is_some())) {
        sentences.push(format!(
            "The pictures show the plane {}; the table of outcomes covers both planes.",
            view.words()
        ));
    }
    fine.push(if sides.iter().all(|side| side.summary.ensemble().is_some()) {
        {
            let shown = sides[0].summary.variant();
            let one = sides.iter().all(|side| side.summary.variant() == shown);
            match shown {
                0 if one => "For every run, the page shows the stack as stated.".to_owned(),
                _ if one => format!(
                    "For every run, the page shows variant {shown}, the most typical variant of all runs taken \
                     together{}.",
                    match (one_motion(sides), sides.iter().any(Side::is_spatial)) {
                        (true, true) => ", under the same motion",
                        (true, false) => ", under the same component of the motion",
                        (false, _) => "",
                    }
                ),
                _ => "For every run, the page shows the most typical variant of that run.".to_owned(),
            }
        }
    } else {
        "Each result is that of one run: small changes in friction or in gaps can change which bodies fall and when, so judge a difference by many runs."
            .into()
    });
    Verdict { headline: headline(sides) + &cut_short(sides), sentences, fine, ..Verdict::default() }
}

fn players(sides: &[Side]) -> Players {
    let panes: Vec<Pane> = sides
        .iter()
        .enumerate()
        .map(|(at, side)| Pane {
            mark: letter(at).into(),
            name: side.name.clone(),
            ..side.pane.clone()
        })
        .collect();
    // Drawings of three-dimensional bodies change with their rotation, so they have no single outline.
    let overlay = (!sides.iter().any(Side::is_spatial)).then(|| "outlines of A".to_owned());
    let dashed = overlay.as_ref().map_or_else(String::new, |label| {
        format!(
            " With “{label}” switched on, dashed lines in all other pictures show the bodies of A at the same time."
        )
    });
    Players {
        id: "players".into(),
        caption: format!(
            "The computed motion of the runs, at the same times and to the same scale. A run that has ended keeps showing \
             its last frame.{dashed}{}",
            panes.iter().map(|pane| report::legend(&pane.scene)).max().unwrap_or_default()
        ),
        panes,
        ground: lanes(sides),
        overlay,
    }
}

/// Returns `true` if all runs have the same motion and the same length scale. The length scale matters because it also
/// determines the time scale of the motion.
fn one_motion<'a>(sides: impl IntoIterator<Item = &'a Side>) -> bool {
    let motion = |side: &'a Side| (&side.scenario.motion, side.scenario.run.similitude);
    let mut motions = sides.into_iter().map(motion);
    let first = motions.next();
    motions.all(|motion| Some(motion) == first)
}

/// Returns the ground motions to draw below the players. If all runs have the same motion, the motion of the longest
/// run is drawn; otherwise, the motion of each run is drawn.
fn lanes(sides: &[Side]) -> Vec<History> {
    if one_motion(sides) {
        let longest = sides.iter().max_by(|a, b| a.end_time.total_cmp(&b.end_time));
        return longest.map(|side| side.ground.clone()).unwrap_or_default();
    }
    let own = |(at, side): (usize, &Side)| {
        let first = side.ground.first()?.clone();
        Some(History { label: format!("{}: {}", letter(at), first.label), ..first })
    };
    sides.iter().enumerate().filter_map(own).collect()
}

/// Plots histories of all runs superimposed, with a color and a dash pattern per run.
fn histories(sides: &[Side]) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut add =
        |id: &str, caption: &str, y: Axis, of: &dyn Fn(&Side) -> Option<[Vec<f64>; 2]>| {
            let lines: Vec<(&Side, Series)> = sides
                .iter()
                .enumerate()
                .filter_map(|(at, side)| {
                    let name = format!("{}: {}", letter(at), side.name);
                    let [times, values] = of(side)?;
                    let line = Series::new(name, times, values);
                    let style = SeriesStyle { index: Some(at), ..SeriesStyle::default() };
                    Some((side, Series { style, ..line }))
                })
                .collect();
            if !lines.is_empty() {
                blocks.push(history(sides, id, caption, y, lines));
            }
        };
    let (moved, slip) = (Axis::new("displacement", "cm"), Axis::new("slip", "cm"));
    for (what, id, caption, axis) in [
        (
            Traced::Top,
            "top-displacements",
            "Horizontal displacement of the top left barrel relative to the ground.",
            &moved,
        ),
        (
            Traced::TopAcross,
            "top-displacements-across",
            "Displacement of the top left barrel in the nearest row relative to the ground, across the barrels.",
            &moved,
        ),
        (
            Traced::TopAlong,
            "top-displacements-along",
            "Displacement of the top left barrel in the nearest row relative to the ground, along the barrels.",
            &moved,
        ),
        (Traced::Base, "base-displacements", "Slip of the bottom rack on the ground.", &slip),
        (
            Traced::BaseAcross,
            "base-displacements-across",
            "Slip of the bottom rack on the ground, across the barrels.",
            &slip,
        ),
        (
            Traced::BaseAlong,
            "base-displacements-along",
            "Slip of the bottom rack on the ground, along the barrels.",
            &slip,
        ),
        (
            Traced::BaseForce,
            "base-forces",
            "Vertical force between the bottom rack and the ground.",
            &Axis::new("force", "kN"),
        ),
    ] {
        add(id, caption, axis.clone(), &|side| {
            side.traced.iter().find(|(one, _)| *one == what).map(|(_, history)| history.clone())
        });
    }
    let acceleration = |side: &Side| {
        let first = side.ground.first()?;
        Some([first.times.clone(), first.values.clone()])
    };
    if !one_motion(sides) {
        add(
            "ground-accelerations",
            "Acceleration of the ground.",
            Axis::new("acceleration", "g"),
            &acceleration,
        );
    }
    blocks
}

/// Plots histories over time; `lines` pairs each history with its run.
fn history(
    sides: &[Side],
    id: &str,
    caption: &str,
    mut y: Axis,
    lines: Vec<(&Side, Series)>,
) -> Block {
    let marks = sides.iter().enumerate().filter_map(|(at, side)| {
        let at_time = side.collapse_time?;
        Some(Mark { at: at_time, label: format!("{} gives way", letter(at)) })
    });
    // Falling bodies leave the plot, so that the curves of standing bodies stay legible; forces and accelerations are
    // plotted in full.
    let ranges: Vec<Option<[f64; 2]>> = lines
        .iter()
        .map(|(side, one)| report::standing_until(side.collapse_time?, std::slice::from_ref(one)))
        .collect();
    if y.unit == "cm" && ranges.iter().any(Option::is_some) {
        let own = |one: &Series| {
            one.y.iter().fold([0.0_f64; 2], |range, v| [range[0].min(*v), range[1].max(*v)])
        };
        let all =
            lines.iter().zip(&ranges).map(|((_, one), range)| range.unwrap_or_else(|| own(one)));
        y.range = all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    }
    let series = lines.into_iter().map(|(_, one)| one).collect();
    let plot = Plot::over_time(y, series, marks.collect());
    Block::Figure(Figure::new(id, caption, Plot { timeline: true, ..plot }))
}

/// Returns the provenance of the results; entries that all runs share appear once, all others once
/// per run.
fn provenance(sides: &[Side]) -> Vec<(String, String)> {
    let all: Vec<_> = sides.iter().map(|side| &side.provenance).collect();
    let shared = |pair: &(String, String)| all.iter().all(|pairs| pairs.contains(pair));
    let mut pairs = Vec::new();
    for (at, own) in all.iter().enumerate() {
        for pair in own.iter().filter(|pair| !shared(pair)) {
            pairs.push((format!("{}: {}", letter(at), pair.0), pair.1.clone()));
        }
    }
    let common = all.first().into_iter().flat_map(|own| own.iter());
    pairs.extend(common.filter(|pair| shared(pair)).cloned());
    pairs
}
