//! Statistics of the variants of a stack.

use std::collections::BTreeMap;

use barrelstack_fragility::{quantile, wilson};
use barrelstack_report::described;

use super::Plane;
use super::decides::{self, Unknown};
use super::typical::Order;
use crate::ensemble::CaseResult;
use crate::outcome::Outcome;

/// Confidence level of all intervals of single shares.
pub const LEVEL: f64 = 0.95;

described! {
    /// Statistics of all variants, without the nominal case.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Spread {
        /// Quantities that differ between the variants: positions and masses ("imperfections"), uncertain constants
        /// ("unknowns"), both, or neither.
        pub kind: &'static str ["imperfections", "unknowns", "both", "neither"],
        /// Seed of the random sequence from which the variants are drawn.
        pub seed: u32,
        /// Number of variants with a verdict.
        pub variants: u32,
        /// Number of variants that collapse, either under their own weight before they are shaken, or while they are
        /// shaken.
        pub collapsed: u32,
        /// Share of variants that collapse, among those with a verdict; null if no variant has a verdict.
        pub share: Option<f64> as "1",
        /// Wilson's 95 % interval of the share that collapses, widened so that it holds regardless
        /// of whether the variants without a verdict stand or collapse. This share is an average over the uncertain
        /// constants, and the interval is its sampling error.
        pub interval: [f64; 2] as "1",
        /// Range of the share of stacks that collapse, over the true values of the uncertain constants of the seats: it
        /// contains 95 % of these shares if the constants are drawn from their distributions, sampling error included;
        /// so it may be wider than `interval`. Null if there are fewer than 16 variants, if one of them has no verdict,
        /// or if they differ only in positions and masses.
        pub range: Option<[f64; 2]> as "1",
        /// Share of stacks that collapse if all uncertain constants are at their medians; null if `range` is null. The
        /// medians are the stated values, except that of a static coefficient of friction that is drawn at random: it
        /// lies above the stated value.
        pub share_as_stated: Option<f64> as "1",
        /// The uncertain constants of the seats, in the order of the difference between the largest and the smallest
        /// of their `shares`, the largest first; empty if `range` is null.
        pub decides: Vec<Unknown>,
        /// Time of the first loss of a seat, over the variants that collapse while shaken.
        pub first_loss: Option<Range> as "s",
        /// Time of the first fall of a barrel, over those of these variants in which a barrel falls before the run
        /// ends. They may be fewer than for `first_loss`, so a fractile of the first fall may be less than that of the
        /// first loss of a seat.
        pub first_fall: Option<Range> as "s",
        /// Number of barrels fallen by the end of the run, over the variants that collapse while
        /// shaken.
        pub barrels_fallen: Option<Range> as "1",
        /// Time after the first loss of a seat during which falls are counted in every variant;
        /// null if all variants are followed until nothing moves.
        pub counted_for: Option<f64> as "s",
        /// Total number of barrels.
        pub barrels: usize,
        /// Earliest time at which the run of a standing variant ended before its ground motion ended; null if there is
        /// no such variant.
        pub standing_until: Option<f64> as "s",
        /// Number of variants in which the load on staves exceeds their stated capacity before any
        /// seat is lost.
        pub staves_overloaded: u32,
        /// Largest load on staves before any seat is lost, as a share of their stated capacity,
        /// over all variants; null if unknown.
        pub stave_utilization: Option<f64> as "1",
        /// Number of variants per mode of collapse.
        pub modes: BTreeMap<&'static str, u32>,
        /// Number of collapsing variants that fall under their own weight, before they are shaken.
        pub cannot_stand: u32,
        /// Number of variants without a verdict, because their model could not be built or their
        /// computation failed.
        pub broken: u32,
        /// Reason why a variant has no verdict or falls before it is shaken, for the first such variant; null if there
        /// is none.
        pub reason: Option<String>,
        /// Outcome of the nominal case.
        pub stated: &'static str ["stable", "collapse", "not-judged", "invalid"],
        /// Number of the most typical run: the one that is most similar to all others in outcome,
        /// mode, time and fallen barrels, in all planes together; 0 is the nominal case.
        pub typical: u32,
        /// Number of the run with the least severe outcome.
        pub gentlest: u32,
        /// Number of the run with the most severe outcome.
        pub worst: u32,
    }

    /// Distribution of values: the 5, 50 and 95 % fractiles, and the extremes.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Range {
        /// 5 % fractile.
        pub p05: f64 as "that of the field",
        /// Median.
        pub p50: f64 as "that of the field",
        /// 95 % fractile.
        pub p95: f64 as "that of the field",
        /// Smallest value.
        pub least: f64 as "that of the field",
        /// Largest value.
        pub most: f64 as "that of the field",
    }
}

/// Number of values below which a sentence states the range of all values instead of fractiles.
pub const FEW: u32 = 20;

impl Range {
    /// Summarizes values; `None` if there are none.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let [p05, p50, p95] = [0.05, 0.5, 0.95].map(|share| quantile(&values, share));
        Some(Self { p05, p50, p95, least, most })
    }

    /// Returns the range that a sentence states for a number of values: the 5 and 95 % fractiles or, for fewer than
    /// [`FEW`] values, the smallest and the largest value, since fractiles of so few values would be interpolated.
    pub fn stated(&self, values: u32) -> [f64; 2] {
        if values < FEW { [self.least, self.most] } else { [self.p05, self.p95] }
    }
}

impl Spread {
    /// Summarizes the results in a plane; the first result is that of the nominal case. Returns
    /// `None` for a scene without variants.
    pub fn of(plane: &Plane, results: &[CaseResult]) -> Option<Self> {
        let imperfections = plane.scenario.imperfections()?;
        let unknown = plane.scenario.unknowns()?;
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
        // `run.duration` may end a variant before this time has passed; the tolerance covers the
        // rounding of time differences.
        let after = plane.counted_for();
        let cut = shaken().filter(|result| result.cut.is_some_and(|left| left > 0.0));
        let cut = cut.filter_map(|result| Some(result.end_time? - loss(result)?));
        let cut = cut.filter(|time| after.is_none_or(|after| *time < after - 1e-9));
        Some(Self {
            kind: match (imperfections.drawn, unknown.drawn) {
                (true, false) => "imperfections",
                (false, true) => "unknowns",
                (true, true) => "both",
                (false, false) => "neither",
            },
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

    /// Returns a phrase for the time during which falls are counted, such as " within 2 s of
    /// {loss}"; empty if falls are counted until nothing moves.
    pub fn counted(&self, loss: &str) -> String {
        let within = |time: f64| format!(" within {} s of {loss}", (10.0 * time).round() / 10.0);
        self.counted_for.map_or_else(String::new, within)
    }

    /// Returns the number of variants that were run, with or without a verdict.
    pub fn run(&self) -> u32 {
        self.variants + self.broken
    }

    /// Returns the share that collapses if every variant without a verdict is counted as collapsed;
    /// `None` if no variant was run.
    pub fn largest_share(&self) -> Option<f64> {
        let run = self.run();
        (run > 0).then(|| f64::from(self.collapsed + self.broken) / f64::from(run))
    }
}

/// `true` if a case has a verdict.
pub(super) fn judged(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Stable | Outcome::Collapse { .. }))
}

/// Returns whether a case collapses; `None` if it has no verdict.
pub fn verdict(result: &CaseResult) -> Option<bool> {
    judged(result).then(|| collapsed(result))
}

/// `true` if a case has a verdict and was shaken, so that it can be shown.
pub(super) fn shown(result: &CaseResult) -> bool {
    judged(result) && !result.fell_at_rest()
}

/// `true` if a case collapsed.
pub(super) fn collapsed(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Collapse { .. }))
}

/// Returns the time (s) at which the first body lost its seat; `None` if the case did not collapse.
pub(super) fn loss(result: &CaseResult) -> Option<f64> {
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
