//! Sentences about a three-dimensional run. Unlike the sentences about a planar run, they state directions.

use barrelstack::demand::DEMANDS;
use barrelstack::outcome::{CollapseMode, Outcome};
use barrelstack::report::{device_sentence, stopped};
use barrelstack::scenario::View;
use barrelstack::variants::words::{
    all_that_fall, headline_in_space, measure, percent, tone as of_spread,
};
use barrelstack::watch::Loss;
use barrelstack_report::{Tone, capital};

use crate::fate::Heading;
use crate::run::Run;
use crate::summary::Summary;

/// Returns the result of a run as one sentence.
pub fn headline(run: &Run, summary: &Summary) -> String {
    if let Some(spread) = &summary.ensemble {
        return headline_in_space(spread);
    }
    let barrels = summary.outcome.common.barrels;
    match &run.outcome {
        Outcome::Stable => match summary.demands.stave_utilization.filter(|load| *load > 1.0) {
            Some(load) => format!(
                "This stack stands, but staves are crushed: their load reaches up to {:.0} % of their stated capacity.",
                100.0 * load
            ),
            None => "This stack stands.".to_owned(),
        },
        Outcome::Collapse { mode: CollapseMode::Gravity, .. } => {
            "This stack falls under its own weight, before it is shaken.".to_owned()
        }
        Outcome::Collapse { time, .. } => format!(
            "This stack falls: it gives way after {time:.1} s, and {} of {barrels} barrels fall.",
            run.fallen().count()
        ),
        Outcome::Interrupted => stopped(summary.unfinished.as_ref(), run.end_time),
        Outcome::NotJudged => {
            "This is a free scene: its bodies have no seats to lose, so there is no verdict."
                .to_owned()
        }
        Outcome::Invalid { reason } => format!("This run has no verdict: {reason}."),
    }
}

/// Returns the tone of the verdict: stands, falls, neutral or invalid.
pub fn tone(run: &Run, summary: &Summary) -> Tone {
    if let Some(spread) = &summary.ensemble {
        return of_spread(&[(View::Transverse, spread)]);
    }
    match run.outcome {
        Outcome::Stable => Tone::Stands,
        Outcome::Collapse { .. } => Tone::Falls,
        Outcome::NotJudged | Outcome::Interrupted => Tone::Neutral,
        Outcome::Invalid { .. } => Tone::Invalid,
    }
}

/// Describes a direction, such as "across the barrels, to the right".
pub fn toward(heading: Heading) -> &'static str {
    match heading {
        Heading::Right => "across the barrels, to the right",
        Heading::Left => "across the barrels, to the left",
        Heading::Away => "along the barrels, toward the far side",
        Heading::Near => "along the barrels, toward the near side",
    }
}

/// Describes a loss of a seat, such as "B3.1 leaves its cradle".
pub(crate) fn leaves(name: &str, loss: Loss) -> String {
    match loss {
        Loss::Displaced => format!("{name} leaves its cradle"),
        Loss::Slid => format!("{name} leaves the barrels below"),
        Loss::Tilted => format!("{name} tilts off its seat"),
        Loss::Dropped => format!("{name} loses its support"),
    }
}

/// Returns the sentences that follow the headline: the statistics of the variants, the first loss of a seat, and the
/// outcomes of the devices.
pub fn sentences(run: &Run, summary: &Summary) -> Vec<String> {
    let mut sentences: Vec<String> = summary.ensemble.iter().filter_map(measure).collect();
    if let Some((directions, spread)) = summary.directions.as_ref().zip(summary.ensemble.as_ref()) {
        sentences.extend(first_losses(directions.first(), spread.collapsed));
        sentences.extend(debris(directions.debris(), &spread.counted("the first loss of a seat")));
    }
    if let Outcome::Collapse { time, first, .. } = &run.outcome {
        let part = run.stack.parts.iter().position(|part| part.name == *first);
        if let Some((_, loss, heading)) = part.and_then(|body| run.fates[body].left_seat) {
            let shown = if summary.ensemble.is_some() { "In the run that is shown, " } else { "" };
            let kind = run.stack.parts[part.unwrap_or(0)].kind.name();
            let moves = if loss == Loss::Dropped { "and falls" } else { "in the direction" };
            let event =
                format!("{} {moves} {}", leaves(&format!("{kind} {first}"), loss), toward(heading));
            sentences.push(format!("{}, after {time:.1} s.", capital(&format!("{shown}{event}"))));
        }
    }
    sentences.extend(summary.devices.0.iter().filter_map(device_sentence));
    sentences
}

/// Describes the direction in which the first body to lose its seat leaves it, with the numbers of variants in which
/// this direction is across and along the barrels. `collapsed` is the number of variants that fall. `None` if no body
/// leaves its seat.
fn first_losses([across, along]: [u32; 2], collapsed: u32) -> Option<String> {
    let in_which = |count: u32| match count {
        all if all == collapsed => format!("In {}", all_that_fall(all)),
        some => format!("In {some} of the {collapsed} variants that fall"),
    };
    let event = "the first body to lose its seat leaves it";
    Some(match (across, along) {
        (0, 0) => return None,
        (0, along) => format!("{}, {event} along the barrels.", in_which(along)),
        (across, 0) => format!("{}, {event} across the barrels.", in_which(across)),
        (across, along) => {
            format!("{}, {event} across the barrels, and in {along} along them.", in_which(across))
        }
    })
}

/// Describes the directions in which fallen barrels are displaced, with the numbers of barrels that are displaced
/// mainly across and mainly along the barrels. `when` states which barrels are counted, such as " within 2 s of the
/// first loss of a seat". `None` if no barrel falls.
fn debris(counts: [u32; 2], when: &str) -> Option<String> {
    let [across, along] = counts.map(f64::from);
    let all = across + along;
    if all == 0.0 {
        return None;
    }
    let (share, direction) =
        if across > along { (across / all, "across") } else { (along / all, "along") };
    let barrels = format!("barrels that fall{when}");
    Some(if share == 1.0 {
        format!("All {barrels} end up displaced mainly {direction} the barrels.")
    } else if share < CLEAR {
        format!(
            "Of the {barrels}, about equal numbers end up displaced mainly across and mainly along the barrels."
        )
    } else {
        format!(
            "{} of the {barrels} end up displaced mainly {direction} the barrels.",
            percent(share)
        )
    })
}

/// Smallest share of the fallen barrels for which the main direction of displacement is stated. If the share of barrels
/// displaced in this direction is smaller, the numbers across and along the barrels are called about equal.
const CLEAR: f64 = 0.55;

/// Maximum number of bodies of a free scene that the console output lists individually; the output files list all
/// bodies.
const MOST_LISTED: usize = 10;

/// Demands that the console output shows; the report page shows all demands.
const SHOWN: [&str; 5] = [
    "top_drift_ratio",
    "stress_amplification",
    "stave_utilization",
    "base_slip_peak",
    "rack_walk_peak",
];

/// Returns the rows of the summary, each with its name and value.
pub fn rows(run: &Run, summary: &Summary) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
    let outcome = &summary.outcome.common;
    row("outcome", outcome.mode.unwrap_or(outcome.kind).to_owned());
    if let (Some(first), Some(time)) = (&outcome.first, outcome.time) {
        let direction = run.heading.map_or("", toward);
        row("first", format!("{first} at {time:.2} s, {direction}"));
    }
    if let Some(fallen) = outcome.barrels_fallen.filter(|fallen| *fallen > 0) {
        let side = |wanted: Heading| run.debris().filter(|heading| *heading == wanted).count();
        let counts = Heading::ALL.map(|heading| (side(heading), heading.name()));
        let listed: Vec<String> = counts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, name)| format!("{count} {name}"))
            .collect();
        row("barrels fallen", format!("{fallen} of {}: {}", outcome.barrels, listed.join(", ")));
    }
    for body in summary.bodies.iter().filter(|_| run.stack.is_free()).take(MOST_LISTED) {
        let [x, y, z] = body.moved;
        let [u, v, w] = body.velocity;
        let speed = (u * u + v * v + w * w).sqrt();
        row(&body.name, format!("moved by ({x:.3}, {y:.3}, {z:.3}) m, ends at {speed:.3} m/s"));
    }
    for demand in SHOWN {
        let demand = DEMANDS.iter().find(|one| one.name == demand);
        if let Some((one, value)) = demand.and_then(|one| Some((one, one.shown(&summary.demands)?)))
        {
            row(one.label, format!("{value:.*} {}", one.decimals, one.shown_unit));
        }
    }
    if let Some(energy) = &summary.energy {
        row(
            "energy balance",
            format!(
                "residual {:.0e} of the energy that passed through the system",
                energy.residual_ratio
            ),
        );
    }
    let Summary { run: done, .. } = summary;
    row("time", format!("{:.1} s in {} steps", done.end_time, done.steps));
    rows
}

#[cfg(test)]
mod tests {
    use super::{debris, first_losses};

    #[test]
    fn the_first_loss_of_a_seat_is_stated_with_its_number_first_and_without_zeros() {
        let along = "the first body to lose its seat leaves it along the barrels.";
        for (counts, collapsed, words) in [
            ([0, 15], 15, format!("In all 15 variants that fall, {along}")),
            ([0, 2], 2, format!("In both variants that fall, {along}")),
            ([0, 1], 1, format!("In the one variant that falls, {along}")),
            // Three variants fall under their own weight.
            ([0, 12], 15, format!("In 12 of the 15 variants that fall, {along}")),
            (
                [4, 0],
                4,
                "In all 4 variants that fall, the first body to lose its seat leaves it across the barrels.".to_owned(),
            ),
            (
                [3, 12],
                15,
                "In 3 of the 15 variants that fall, the first body to lose its seat leaves it across the barrels, and \
                 in 12 along them."
                    .to_owned(),
            ),
        ] {
            assert_eq!(first_losses(counts, collapsed), Some(words));
        }
        assert_eq!(first_losses([0, 0], 3), None);
    }

    #[test]
    fn the_direction_of_most_debris_is_stated_with_its_share() {
        let when = " within 2 s of the first loss of a seat";
        let barrels = format!("barrels that fall{when}");
        let end = "end up displaced mainly";
        for (counts, words) in [
            ([2, 98], format!("98 % of the {barrels} {end} along the barrels.")),
            ([90, 10], format!("90 % of the {barrels} {end} across the barrels.")),
            // A share below 100 % is not rounded to 100 %.
            ([1, 999], format!("99.9 % of the {barrels} {end} along the barrels.")),
            ([0, 7], format!("All {barrels} {end} along the barrels.")),
            ([7, 0], format!("All {barrels} {end} across the barrels.")),
            (
                [48, 52],
                format!(
                    "Of the {barrels}, about equal numbers {end} across and mainly along the barrels."
                ),
            ),
        ] {
            assert_eq!(debris(counts, when), Some(words));
        }
        assert_eq!(debris([0, 0], when), None);
        assert_eq!(
            debris([1, 3], "").as_deref(),
            Some("75 % of the barrels that fall end up displaced mainly along the barrels.")
        );
    }
}
