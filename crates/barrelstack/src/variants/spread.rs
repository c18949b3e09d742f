//! Statistics of all variants of a stack.

use std::collections::BTreeMap;

use barrelstack_fragility::{quantile, wilson};
use barrelstack_report::described;

use super::Plane;
use super::decides::{self, Unknown};
use super::typical::Order;
use crate::ensemble::CaseResult;
use crate::outcome::Outcome;
use crate::scenario::field::Named as _;

/// Confidence level of all intervals.
pub const LEVEL: f64 = 0.95;

described! {
    /// Statistics of all variants; the nominal case is not among them.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Spread {
        /// Source of their differences.
        pub kind: &'static str ["hair", "ignorance", "both"],
        /// Seed that they were drawn by.
        pub seed: u32,
        /// Variants that have a verdict.
        pub variants: u32,
        /// Number of variants that collapse: while they are shaken, or under their own weight before.
        pub collapsed: u32,
        /// The share of those; null where no variant has a verdict.
        pub share: Option<f64> as "1",
        /// Wilson's interval of that share, 95 %; it spans what variants without a verdict could make of it.
        pub interval: [f64; 2] as "1",
        /// Range of the share of stacks that collapse over the constants that nobody has measured: 95 % of the shares
        /// under constants drawn from their distributions, sampling included; null with fewer than 16 variants, if
        /// one of them has no verdict, or if they differ in places and masses alone.
        pub range: Option<[f64; 2]> as "1",
        /// Share of stacks that collapse with all these constants as stated; null as `range`.
        pub share_as_stated: Option<f64> as "1",
        /// The constants that nobody has measured, the most influential first; empty where `range` is null.
        pub decides: Vec<Unknown>,
        /// When the first body lost its seat, of the variants that collapse while they are shaken.
        pub first_loss: Option<Range> as "s",
        /// When the first barrel had fallen, of the variants in which one falls while they are shaken, until these
        /// end.
        pub first_fall: Option<Range> as "s",
        /// Barrels that fall in variants that collapse while they are shaken, until these end.
        pub barrels_fallen: Option<Range> as "1",
        /// Time after the first loss of a seat until which falls are counted in every variant; null where all are
        /// followed until nothing moves.
        pub counted_for: Option<f64> as "s",
        /// Barrels in all.
        pub barrels: usize,
        /// The earliest end of a variant that stood while some of the motion was left; null where none was cut
        /// short so.
        pub standing_until: Option<f64> as "s",
        /// Variants in which staves bear more than they are stated to bear before any seat is lost.
        pub staves_overloaded: u32,
        /// The largest load on staves before any seat is lost, over what they are stated to bear, of all variants;
        /// null where none is known.
        pub stave_utilization: Option<f64> as "1",
        /// Variants by the mode of their collapse.
        pub modes: BTreeMap<&'static str, u32>,
        /// Variants of those that collapse which fall under their own weight, before they are shaken.
        pub cannot_stand: u32,
        /// Variants without a verdict: they could not be built, or their numbers broke down.
        pub broken: u32,
        /// Why the first of those that fall before they are shaken, or have no verdict, does.
        pub reason: Option<String>,
        /// Outcome of the nominal case.
        pub stated: &'static str ["stable", "collapse", "not-judged", "invalid"],
        /// The number of the run that is most like all others, by outcome, mode, time and what falls, in all
        /// planes together; 0 is the case as it is stated.
        pub typical: u32,
        /// The number of the run in which least happens.
        pub gentlest: u32,
        /// The number of the run in which most happens.
        pub worst: u32,
    }

    /// Distribution of values: their 5, 50 and 95 % fractiles, and the extremes.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Range {
        /// A share of 5 % lies below.
        pub p05: f64 as "that of the field",
        /// Half lies below.
        pub p50: f64 as "that of the field",
        /// A share of 95 % lies below.
        pub p95: f64 as "that of the field",
        /// The least.
        pub least: f64 as "that of the field",
        /// The greatest.
        pub most: f64 as "that of the field",
    }
}

impl Range {
    /// Summarizes values; `None` without any.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let [p05, p50, p95] = [0.05, 0.5, 0.95].map(|share| quantile(&values, share));
        Some(Self { p05, p50, p95, least, most })
    }
}

impl Spread {
    /// Summarizes the results of the nominal case of a plane and of its variants, in this order; `None` for a scene
    /// without variants.
    pub fn of(plane: &Plane, results: &[CaseResult]) -> Option<Self> {
        let imperfections = plane.scenario.imperfections()?;
        let variants = results.get(1..).unwrap_or_default();
        let judged = || variants.iter().filter(|result| judged(result));
        let falling = || judged().filter(|result| collapsed(result));
        let shaken = || falling().filter(|result| !result.fell_at_rest());
        let mut modes = BTreeMap::new();
        for result in falling() {
            if let Ok(Outcome::Collapse { mode, .. }) = &result.outcome {
                *modes.entry(mode.name()).or_default() += 1;
            }
        }
        let (count, falls) = (number(judged().count()), number(falling().count()));
        let broken = number(variants.len()) - count;
        let interval = |falls| wilson(falls, count + broken, LEVEL);
        let staves = || judged().filter_map(|result| result.demands.stave_utilization);
        let order = Order::of(results);
        let unknowns = decides::range(plane, results);
        // The duration may end a variant sooner; differences of times have rounding errors.
        let after = plane.counted_for();
        let cut = shaken().filter(|result| result.cut.is_some_and(|left| left > 0.0));
        let cut = cut.filter_map(|result| Some(result.end_time? - loss(result)?));
        let cut = cut.filter(|time| after.is_none_or(|after| *time < after - 1e-9));
        Some(Self {
            kind: imperfections.kind.name(),
            seed: imperfections.seed,
            variants: count,
            collapsed: falls,
            share: (count > 0).then(|| f64::from(falls) / f64::from(count)),
            interval: [interval(falls).low, interval(falls + broken).high],
            range: unknowns.as_ref().map(|found| found.range),
            share_as_stated: unknowns.as_ref().map(|found| found.as_stated),
            decides: unknowns.map(|found| found.decides).unwrap_or_default(),
            first_loss: Range::of(shaken().filter_map(loss)),
            first_fall: Range::of(shaken().filter_map(|result| result.first_fall)),
            barrels_fallen: Range::of(shaken().map(|result| fallen(result) as f64)),
            counted_for: cut.reduce(f64::min).or(after),
            barrels: results.iter().map(|result| result.barrels).max().unwrap_or(0),
            standing_until: judged()
                .filter(|result| !collapsed(result) && result.cut.is_some_and(|left| left > 0.0))
                .filter_map(|result| result.end_time)
                .reduce(f64::min),
            staves_overloaded: number(staves().filter(|load| *load > 1.0).count()),
            stave_utilization: staves().reduce(f64::max),
            modes,
            cannot_stand: number(variants.iter().filter(|one| one.fell_at_rest()).count()),
            broken,
            reason: variants.iter().find_map(|one| match &one.outcome {
                Err(reason) | Ok(Outcome::Invalid { reason }) => Some(reason.clone()),
                Ok(outcome) if outcome.fell_at_rest() => one.warnings.first().cloned(),
                Ok(
                    Outcome::Stable
                    | Outcome::Collapse { .. }
                    | Outcome::NotJudged
                    | Outcome::Interrupted,
                ) => None,
            }),
            stated: results.first().map_or("invalid", |result| match &result.outcome {
                Ok(outcome) => outcome.kind(),
                Err(_) => "invalid",
            }),
            typical: order.typical,
            gentlest: order.gentlest,
            worst: order.worst,
        })
    }

    /// Describes until when falls are counted: " within 2 s of" a loss of a seat; empty if until rest.
    pub fn counted(&self, loss: &str) -> String {
        let within = |time: f64| format!(" within {} s of {loss}", (10.0 * time).round() / 10.0);
        self.counted_for.map_or_else(String::new, within)
    }

    /// Returns the number of variants that were run, with or without a verdict.
    pub fn run(&self) -> u32 {
        self.variants + self.broken
    }

    /// Returns the share that collapses if every variant without a verdict does; `None` if none was run.
    pub fn largest_share(&self) -> Option<f64> {
        let run = self.run();
        (run > 0).then(|| f64::from(self.collapsed + self.broken) / f64::from(run))
    }
}

/// `true` if a case has a verdict.
pub(super) fn judged(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Stable | Outcome::Collapse { .. }))
}

/// `true` if a case collapses, or has no verdict, which counts against a change.
pub fn fails(result: &CaseResult) -> bool {
    collapsed(result) || !judged(result)
}

/// `true` if a case has a verdict and was shaken, so that it can be shown.
pub(super) fn shown(result: &CaseResult) -> bool {
    judged(result) && !result.fell_at_rest()
}

/// `true` if it collapsed.
pub(super) fn collapsed(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Collapse { .. }))
}

/// Returns the time (s) at which the first body lost its seat.
fn loss(result: &CaseResult) -> Option<f64> {
    match &result.outcome {
        Ok(Outcome::Collapse { time, .. }) => Some(*time),
        _ => None,
    }
}

/// Returns the number of barrels that fell.
pub(super) fn fallen(result: &CaseResult) -> usize {
    result.falls.iter().filter(|(_, at)| at.is_some()).count()
}

fn number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
