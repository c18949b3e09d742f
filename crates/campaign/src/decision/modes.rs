//! Cumulative incidence of the modes of collapse, which are competing risks.

use barrelstack_fragility::{Interval, Shares, Stripe, wilson};

use super::cases::{Cases, JudgedCase};
use super::curve::{LEVEL, LimitCurve, stripe};

/// Incidence of one collapse mode as a function of the intensity measure of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeIncidence {
    /// Name of the mode.
    pub mode: String,
    /// Numbers of cases and of collapses in this mode, for each level or bin of intensity.
    pub stripes: Vec<Stripe>,
    /// Wilson score interval of the fraction of cases that collapse in this mode, for each element of `stripes`.
    pub intervals: Vec<Interval>,
    /// Probability of collapse in this mode, at each intensity of [`LimitCurve::grid`].
    ///
    /// Empty if collapse has no fitted curve, or if the cases do not determine the shares of the modes.
    pub fitted: Vec<f64>,
}

fn is(case: &JudgedCase, mode: usize) -> bool {
    case.mode.map(usize::from) == Some(mode)
}

/// Returns the incidence of every mode that occurs, the most frequent first.
///
/// The result is empty for an incremental dynamic analysis, because most of its levels are chosen close to collapse.
pub(super) fn of(cases: &Cases, collapse: &LimitCurve) -> Vec<ModeIncidence> {
    if cases.hunted {
        return Vec::new();
    }
    let count = |mode: usize| cases.all.iter().filter(|case| is(case, mode)).count();
    let mut names: Vec<(usize, usize)> =
        (0..cases.modes.len()).map(|mode| (count(mode), mode)).collect();
    let name = |mode: usize| cases.modes[mode].as_str();
    names.sort_by(|a, b| b.0.cmp(&a.0).then(name(a.1).cmp(name(b.1))));
    let number = |mode: u8| names.iter().position(|(_, name)| *name == usize::from(mode));
    let failures: Vec<(f64, usize)> = cases
        .all
        .iter()
        .filter_map(|case| Some((case.intensity(cases.main)?, number(case.mode?)?)))
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
    let incidence = |(index, (_, mode)): (usize, &(usize, usize))| {
        let own = |x: f64, of: &[_]| stripe(x, of, |case| is(case, *mode));
        let stripes: Vec<Stripe> = groups.iter().map(|(x, of)| own(*x, of)).collect();
        ModeIncidence {
            mode: name(*mode).to_owned(),
            intervals: stripes.iter().map(|s| wilson(s.failures, s.cases, LEVEL)).collect(),
            stripes,
            fitted: fitted(index),
        }
    };
    names.iter().enumerate().map(incidence).collect()
}
