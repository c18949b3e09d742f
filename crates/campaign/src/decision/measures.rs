//! Efficiency and sufficiency of intensity measures for collapse.

use barrelstack_fragility::{Demanded, FitError, Measured, demand_against, failure_against};

use super::cases::Cases;

/// One measure.
#[derive(Clone, Debug)]
pub struct MeasureRow {
    /// Index of the measure.
    pub measure: usize,
    /// Index of the measure that sufficiency is tested against.
    pub beside: Option<usize>,
    /// Collapse against it, or the reason why there is no curve.
    pub collapse: Result<Measured, FitError>,
    /// Drift of the top of standing stacks against it.
    pub drift: Option<Demanded>,
}

/// Compares all measures, sorted by the likelihood of the observed collapses, the largest first.
pub(super) fn compare(cases: &Cases) -> Vec<MeasureRow> {
    let by_name = |name: &str| cases.measures.iter().position(|measure| measure.name == name);
    let mut rows: Vec<MeasureRow> = (0..cases.measures.len())
        .map(|measure| {
            // Test each against the measure of the study, and that against PGA, or PGV if it is PGA.
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
    // There may be a million cases: keep only the needed numbers of each.
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
