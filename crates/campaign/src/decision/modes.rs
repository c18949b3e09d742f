//! Modes of collapse: competing risks, told by their cumulative incidence.

use barrelstack_fragility::{Interval, Shares, Stripe, wilson};

use super::cases::Cases;
use super::curve::{LEVEL, LimitCurve, stripe};

/// One mode against the measure of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeIncidence {
    /// The mode.
    pub mode: String,
    /// Cases that collapsed in it, of all cases of each group.
    pub stripes: Vec<Stripe>,
    /// Wilson's interval of each fraction.
    pub intervals: Vec<Interval>,
    /// Chance of collapse in it at each intensity of the grid of the curve of collapse; empty without such a
    /// curve, or where the cases determine no shares.
    pub fitted: Vec<f64>,
}

/// Every mode that occurs, the most frequent first; none of hunts, which go where collapses are.
pub(super) fn of(cases: &Cases, collapse: &LimitCurve) -> Vec<ModeIncidence> {
    let mut names: Vec<(usize, &str)> = Vec::new();
    for mode in cases.all.iter().filter_map(|case| case.mode.as_deref()) {
        match names.iter_mut().find(|(_, name)| *name == mode) {
            Some((count, _)) => *count += 1,
            None => names.push((1, mode)),
        }
    }
    if cases.hunted {
        return Vec::new();
    }
    names.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(b.1)));
    let number = |mode: &str| names.iter().position(|(_, name)| *name == mode);
    let failures: Vec<(f64, usize)> = cases
        .all
        .iter()
        .filter_map(|case| Some((case.intensity(cases.main)?, number(case.mode.as_deref()?)?)))
        .collect();
    let shares = Shares::fit(&failures, names.len());
    let groups = cases.groups(cases.main);
    let fitted = |mode: usize| match (&collapse.fit, &shares) {
        (Ok(fit), Some(shares)) => {
            let at = |x: &f64| fit.curve.probability(*x) * shares.at(*x)[mode];
            collapse.grid.iter().map(at).collect()
        }
        _ => Vec::new(),
    };
    let incidence = |(index, (_, mode)): (usize, &(usize, &str))| {
        let own = |x: f64, of: &[_]| stripe(x, of, |case| case.mode.as_deref() == Some(*mode));
        let stripes: Vec<Stripe> = groups.iter().map(|(x, of)| own(*x, of)).collect();
        ModeIncidence {
            mode: (*mode).to_owned(),
            intervals: stripes.iter().map(|s| wilson(s.failures, s.cases, LEVEL)).collect(),
            stripes,
            fitted: fitted(index),
        }
    };
    names.iter().enumerate().map(incidence).collect()
}
