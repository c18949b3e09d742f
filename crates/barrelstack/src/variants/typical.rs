//! Selection of the runs to show: the most typical (the medoid), the gentlest and the worst.

use std::cmp::Ordering;

use super::spread::{collapsed, fallen, shown};
use crate::ensemble::CaseResult;
use crate::outcome::{CollapseMode, Outcome};

/// Variant numbers of the runs to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Order {
    pub(super) typical: u32,
    pub(super) gentlest: u32,
    pub(super) worst: u32,
}

impl Order {
    /// Selects the runs to show from `results`, whose first element belongs to the nominal case. Only a case that was
    /// shaken and has a verdict can be selected; if there is no such case, the nominal case is selected.
    pub(super) fn of(results: &[CaseResult]) -> Self {
        let shown: Vec<usize> = (0..results.len()).filter(|at| shown(&results[*at])).collect();
        let number = |at: Option<&usize>| at.and_then(|at| u32::try_from(*at).ok()).unwrap_or(0);
        let severity = |a: &&usize, b: &&usize| severity(&results[**a], &results[**b]);
        Self {
            typical: typical(&[results], &|_| true),
            // Among equals, the first is chosen.
            gentlest: number(shown.iter().min_by(severity)),
            worst: number(shown.iter().rev().max_by(severity)),
        }
    }
}

/// Compares two results by severity. A collapse is more severe than standing. Of two collapses, the one with more
/// fallen barrels is more severe or, if the numbers are equal, the earlier one. Of two standing stacks, the one with
/// the larger drift is more severe.
fn severity(a: &CaseResult, b: &CaseResult) -> Ordering {
    let sooner = |result: &CaseResult| -collapse(result).map_or(f64::INFINITY, |(_, time)| time);
    let drift = |result: &CaseResult| result.demands.top_drift_ratio.unwrap_or(0.0);
    collapsed(a)
        .cmp(&collapsed(b))
        .then(fallen(a).cmp(&fallen(b)))
        .then(sooner(a).total_cmp(&sooner(b)))
        .then(drift(a).total_cmp(&drift(b)))
}

/// Returns the number of the medoid: the run with the smallest sum of distances to all others.
///
/// The distances are added over all planes, because a variant number denotes the same stack in all
/// planes. Only runs whose index `allowed` accepts can be chosen. Of several runs with the smallest
/// sum, the first is chosen. The result is 0 if no allowed run has a verdict in all planes.
pub(super) fn typical(planes: &[&[CaseResult]], allowed: &dyn Fn(usize) -> bool) -> u32 {
    let sums: Vec<Vec<Option<f64>>> = planes.iter().map(|results| sums(results)).collect();
    let count = sums.iter().map(Vec::len).min().unwrap_or(0);
    let sum = |at: usize| sums.iter().map(|plane| plane[at]).sum::<Option<f64>>();
    let known = (0..count).filter(|at| allowed(*at)).filter_map(|at| Some((at, sum(at)?)));
    let least = known.min_by(|a, b| a.1.total_cmp(&b.1));
    least.and_then(|(at, _)| u32::try_from(at).ok()).unwrap_or(0)
}

/// Returns the sum of the distances of each run to all others; `None` for a run without a verdict.
fn sums(results: &[CaseResult]) -> Vec<Option<f64>> {
    let shown: Vec<usize> = (0..results.len()).filter(|at| shown(&results[*at])).collect();
    let times = extent(shown.iter().filter_map(|at| Some(collapse(&results[*at])?.1)));
    let drifts = extent(
        shown.iter().filter(|at| !collapsed(&results[**at])).filter_map(|at| drift(&results[*at])),
    );
    let sum = |result: &CaseResult| {
        let to = |other: &usize| distance(result, &results[*other], times, drifts);
        self::shown(result).then(|| shown.iter().map(to).sum())
    };
    results.iter().map(sum).collect()
}

/// Returns the distance between two runs.
///
/// The distance is 4 if only one of the two runs collapses. Otherwise, it is the sum of three terms: 1 if the modes
/// differ; the difference of the collapse times (or of the drifts), divided by the extent `times` (or `drifts`); and
/// the share of the barrels that fall in only one of the runs.
fn distance(a: &CaseResult, b: &CaseResult, times: f64, drifts: f64) -> f64 {
    let apart = |a: f64, b: f64, all: f64| if all > 0.0 { (a - b).abs() / all } else { 0.0 };
    match (collapse(a), collapse(b)) {
        (None, None) => match (drift(a), drift(b)) {
            (Some(a), Some(b)) => apart(a, b, drifts),
            _ => 0.0,
        },
        (Some((mode_a, time_a)), Some((mode_b, time_b))) => {
            let pairs = a.falls.iter().zip(&b.falls);
            let differ = pairs.filter(|((_, a), (_, b))| a.is_some() != b.is_some()).count();
            let mode = if mode_a == mode_b { 0.0 } else { 1.0 };
            mode + apart(time_a, time_b, times) + differ as f64 / a.falls.len().max(1) as f64
        }
        (Some(_), None) | (None, Some(_)) => 4.0,
    }
}

fn collapse(result: &CaseResult) -> Option<(CollapseMode, f64)> {
    match &result.outcome {
        Ok(Outcome::Collapse { mode, time, .. }) => Some((*mode, *time)),
        _ => None,
    }
}

fn drift(result: &CaseResult) -> Option<f64> {
    result.demands.top_drift_ratio
}

/// Returns the difference between the largest and the smallest value; zero if there are no values.
fn extent(values: impl Iterator<Item = f64>) -> f64 {
    let ends = values.fold(None, |ends: Option<(f64, f64)>, value| {
        Some(ends.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
    });
    ends.map_or(0.0, |(low, high)| high - low)
}

#[cfg(test)]
mod tests {
    use super::{Order, typical};
    use crate::ensemble::CaseResult;
    use crate::outcome::{CollapseMode, Outcome};

    fn stands(drift: f64) -> CaseResult {
        let mut result = CaseResult::failed(String::new());
        result.outcome = Ok(Outcome::Stable);
        result.demands.top_drift_ratio = Some(drift);
        result.falls = vec![("B1".into(), None), ("B2".into(), None)];
        result
    }

    fn falls(time: f64, down: [bool; 2]) -> CaseResult {
        let mut result = stands(0.0);
        let (mode, first) = (CollapseMode::Ejection, "B1".to_owned());
        result.outcome = Ok(Outcome::Collapse { mode, time, first, from_level: 1, to_level: 1 });
        for (fall, down) in result.falls.iter_mut().zip(down) {
            fall.1 = down.then_some(time + 0.5);
        }
        result
    }

    #[test]
    fn the_typical_run_is_amid_the_majority_and_the_ends_are_the_ends() {
        let both = [true, true];
        let results = [
            stands(0.02),
            falls(5.0, [true, false]),
            falls(6.0, both),
            falls(6.2, both),
            falls(6.5, both),
            falls(7.0, both),
            stands(0.01),
        ];
        assert_eq!(Order::of(&results), Order { typical: 3, gentlest: 6, worst: 2 });
        let standing = [stands(0.1), stands(0.2), stands(0.35), CaseResult::failed("no".into())];
        assert_eq!(Order::of(&standing), Order { typical: 1, gentlest: 0, worst: 2 });
        // Combined with another plane, in which the run at index 3 has no verdict.
        let mut other = vec![stands(0.1); 7];
        other[3] = CaseResult::failed("no".into());
        assert_eq!(typical(&[&results, &other], &|_| true), 2);
        let none = [CaseResult::failed("no".into())];
        assert_eq!(Order::of(&none), Order { typical: 0, gentlest: 0, worst: 0 });
    }
}
