//! Efficiency and sufficiency of intensity measures as predictors of collapse.

use barrelstack_fragility::{Demanded, FitError, Measured, demand_against, failure_against};

use super::cases::Cases;

/// Efficiency and sufficiency of one intensity measure.
#[derive(Clone, Debug)]
pub struct MeasureRow {
    /// Index of the measure in [`Cases::measures`].
    pub measure: usize,
    /// Index of the second measure in the test of sufficiency: `measure` is sufficient if the second measure adds no
    /// information on collapse or drift. `None` if there is no second measure, so that sufficiency is not tested.
    pub beside: Option<usize>,
    /// Fit of collapse against the measure, or the reason why there is no curve.
    pub collapse: Result<Measured, FitError>,
    /// Regression of the peak drift ratio at the top of the stack on the measure, for stacks that did not collapse.
    /// `None` if there are fewer than three such stacks of known drift, or if all have the same
    /// intensity.
    pub drift: Option<Demanded>,
}

/// Evaluates every intensity measure as a predictor of collapse and drift.
///
/// The rows are sorted by the likelihood of the observed outcomes under the fitted curve of the measure, the largest
/// first. Measures without a curve come last.
pub(super) fn compare(cases: &Cases) -> Vec<MeasureRow> {
    let by_name = |name: &str| cases.measures.iter().position(|measure| measure.name == name);
    let mut rows: Vec<MeasureRow> = (0..cases.measures.len())
        .map(|measure| {
            // Each measure is tested against the measure of the study. The measure of the study itself is tested
            // against PGA, or against PGV if it is PGA.
            let beside = if measure == cases.main {
                ["pga", "pgv"].into_iter().filter_map(by_name).find(|other| *other != measure)
            } else {
                Some(cases.main)
            };
            row(cases, measure, beside)
        })
        .collect();
    let likelihood = |row: &MeasureRow| {
        row.collapse.as_ref().map_or(f64::NEG_INFINITY, |found| found.fit.ln_likelihood)
    };
    rows.sort_by(|a, b| likelihood(b).total_cmp(&likelihood(a)));
    rows
}

fn row(cases: &Cases, measure: usize, beside: Option<usize>) -> MeasureRow {
    let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
    // There may be a million cases, so only the needed numbers of each are copied.
    let (mut outcomes, mut second) = (Vec::new(), Vec::new());
    let (mut demands, mut second_stood) = (Vec::new(), Vec::new());
    for case in &cases.all {
        let other = beside.map_or(Some(1.0), |at| positive(case.intensity(at)));
        let (Some(other), Some(x)) = (other, positive(case.intensity(measure))) else { continue };
        outcomes.push((x, case.collapsed));
        second.push(other);
        if let (false, Some(drift)) = (case.collapsed, positive(case.drift())) {
            demands.push((x, drift));
            second_stood.push(other);
        }
    }
    MeasureRow {
        measure,
        beside,
        collapse: failure_against(&outcomes, beside.is_some().then_some(second.as_slice())),
        drift: demand_against(&demands, beside.is_some().then_some(second_stood.as_slice())),
    }
}
