//! Confidence by resampling.

use std::collections::BTreeMap;

use crate::curve::Lognormal;
use crate::evidence::{Evidence, Stripe, evidence};
use crate::fit::{Dispersion, FitError, fit};
use crate::math::quantile;
use crate::proportion::Interval;

/// Curves fitted to resampled data.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// One curve for each resampled data set that determines one, in the order drawn.
    pub curves: Vec<Lognormal>,
    /// Resampled data sets that do not, for the reasons of [`FitError`]. They are left out of
    /// every interval; above a few percent the intervals are too narrow.
    pub refused: usize,
}

impl Replicates {
    /// The percentile interval of anything computed from a curve.
    pub fn interval(&self, level: f64, of: impl Fn(&Lognormal) -> f64) -> Interval {
        let mut values: Vec<f64> = self.curves.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        let tail = 0.5 * (1.0 - level);
        Interval { low: quantile(&values, tail), high: quantile(&values, 1.0 - tail) }
    }

    /// The interval of the chance of failure at each intensity.
    pub fn band(&self, level: f64, intensities: &[f64]) -> Vec<Interval> {
        intensities.iter().map(|x| self.interval(level, |curve| curve.probability(*x))).collect()
    }

    /// The interval of the median.
    pub fn median(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.median)
    }

    /// The interval of the dispersion.
    pub fn dispersion(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.dispersion)
    }

    /// Share of the resampled data sets that determine no curve.
    pub fn refused_share(&self) -> f64 {
        self.refused as f64 / (self.refused + self.curves.len()) as f64
    }
}

/// A whole number below `count` from a uniform number.
fn below(count: usize, uniform: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below count")]
    let index = (uniform * count as f64) as usize;
    index.min(count - 1)
}

/// Collects the curves of `replicates` data sets; at least half of them must determine one.
fn collect(
    replicates: usize,
    dispersion: Dispersion,
    mut sample: impl FnMut(&mut Vec<Evidence>),
) -> Result<Replicates, FitError> {
    let mut found = Replicates { curves: Vec::with_capacity(replicates), refused: 0 };
    let mut drawn = vec![];
    for _ in 0..replicates {
        drawn.clear();
        sample(&mut drawn);
        match fit(&drawn, dispersion) {
            Ok(fit) => found.curves.push(fit.curve),
            Err(_) => found.refused += 1,
        }
    }
    if found.curves.is_empty() || found.curves.len() < found.refused {
        return Err(FitError::Unstable { usable: found.curves.len(), replicates });
    }
    Ok(found)
}

/// Resamples whole groups with replacement: all that one record says is drawn or left out
/// together, so that the dependence between cases of one record is kept (Efron and Tibshirani
/// 1993, chapter 8).
///
/// # Errors
/// As [`fit`] for the data themselves, or when fewer than half of the resampled data sets
/// determine a curve.
pub fn bootstrap(
    all: &[Evidence],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Replicates, FitError> {
    fit(all, dispersion)?;
    let mut groups: BTreeMap<usize, Vec<Evidence>> = BTreeMap::new();
    for item in all {
        groups.entry(item.group).or_default().push(*item);
    }
    let groups: Vec<Vec<Evidence>> = groups.into_values().collect();
    collect(replicates, dispersion, |drawn| {
        for _ in 0..groups.len() {
            drawn.extend_from_slice(&groups[below(groups.len(), uniform())]);
        }
    })
}

/// How many of `cases` fail when each does with a chance.
pub(crate) fn binomial(cases: u32, chance: f64, uniform: &mut impl FnMut() -> f64) -> u32 {
    (0..cases).map(|_| u32::from(uniform() < chance)).sum()
}

/// Counts drawn from a curve at the intensities and numbers of cases of `stripes`.
pub(crate) fn drawn(
    stripes: &[Stripe],
    chance: impl Fn(usize) -> f64,
    uniform: &mut impl FnMut() -> f64,
) -> Vec<Stripe> {
    let draw =
        |(i, s): (usize, &Stripe)| Stripe { failures: binomial(s.cases, chance(i), uniform), ..*s };
    stripes.iter().enumerate().map(draw).collect()
}

/// Draws counts from the fitted curve itself and fits each again (parametric bootstrap): for
/// independent cases whose curve is believed.
///
/// # Errors
/// As [`bootstrap`].
pub fn simulate(
    stripes: &[Stripe],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Replicates, FitError> {
    let found = fit(&evidence(stripes), dispersion)?;
    let chance = |i: usize| found.curve.probability(stripes[i].intensity);
    collect(replicates, dispersion, |into| {
        into.extend(evidence(&drawn(stripes, chance, &mut uniform)));
    })
}
