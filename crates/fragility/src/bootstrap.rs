//! Parametric bootstrap of a fitted fragility curve.

use crate::curve::Lognormal;
use crate::evidence::{Stripe, evidence};
use crate::fit::{Dispersion, FitError, fit};
use crate::math::{ln, normal, normal_quantile, quantile};
use crate::proportion::Interval;

/// Fragility curves fitted to resampled data.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// Curve fitted to the original data.
    pub fitted: Lognormal,
    /// Curves fitted to those resampled data sets that determine a curve, in the order of sampling.
    pub curves: Vec<Lognormal>,
    /// Number of resampled data sets that determine no curve ([`FitError`]).
    ///
    /// Intervals are computed without these data sets. If more than a few percent of the resampled data sets are
    /// excluded in this way, the intervals are too narrow.
    pub refused: usize,
}

impl Replicates {
    /// Returns the confidence interval of the quantity that `of` computes from a curve. The interval consists of
    /// bias-corrected percentiles (Efron 1987).
    pub fn interval(&self, level: f64, of: impl Fn(&Lognormal) -> f64) -> Interval {
        let mut values: Vec<f64> = self.curves.iter().map(&of).collect();
        values.sort_by(f64::total_cmp);
        let bias = bias(&values, of(&self.fitted));
        let reach = -normal_quantile(0.5 * (1.0 - level));
        let bounds = [-reach, reach].map(|z| quantile(&values, normal(2.0 * bias + z)));
        Interval { low: bounds[0], high: bounds[1] }
    }

    /// Returns the confidence interval of the probability of failure at each intensity.
    pub fn band(&self, level: f64, intensities: &[f64]) -> Vec<Interval> {
        // The interval is computed for the score, which increases with the probability and is not bounded, and is then
        // converted to probabilities.
        let score = |curve: &Lognormal, x: f64| ln(x / curve.median) / curve.dispersion;
        let chance = |x: &f64| {
            let scores = self.interval(level, |curve| score(curve, *x));
            Interval { low: normal(scores.low), high: normal(scores.high) }
        };
        intensities.iter().map(chance).collect()
    }

    /// Returns the confidence interval of the median.
    pub fn median(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.median)
    }

    /// Returns the confidence interval of the dispersion.
    pub fn dispersion(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.dispersion)
    }
}

/// Returns `Φ⁻¹(p)`, where `p` is the fraction of the sorted values that are less than `value`. Each value equal to
/// `value` counts as one half.
fn bias(ascending: &[f64], value: f64) -> f64 {
    let below = ascending.partition_point(|x| *x < value);
    let same = ascending[below..].partition_point(|x| *x <= value);
    let n = ascending.len() as f64;
    let share = (below as f64 + 0.5 * same as f64) / n;
    normal_quantile(share.clamp(1.0 / (n + 1.0), n / (n + 1.0)))
}

/// Draws the number of failures among `cases` cases, each of which fails with the probability `chance`.
pub(crate) fn binomial(cases: u32, chance: f64, uniform: &mut impl FnMut() -> f64) -> u32 {
    (0..cases).map(|_| u32::from(uniform() < chance)).sum()
}

/// Draws a random number of failures for each stripe and returns stripes with these numbers. `chance` returns the
/// probability of failure in the stripe with the given index.
pub(crate) fn drawn(
    stripes: &[Stripe],
    chance: impl Fn(usize) -> f64,
    uniform: &mut impl FnMut() -> f64,
) -> Vec<Stripe> {
    let draw =
        |(i, s): (usize, &Stripe)| Stripe { failures: binomial(s.cases, chance(i), uniform), ..*s };
    stripes.iter().enumerate().map(draw).collect()
}

/// Draws failure counts from the fitted curve and fits a curve to each sample (parametric bootstrap).
///
/// The method assumes that cases are independent and follow the curve.
///
/// # Errors
/// As for [`fit`] of the original data, or if fewer than half of the samples determine a curve.
pub fn simulate(
    stripes: &[Stripe],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Replicates, FitError> {
    let fitted = fit(&evidence(stripes), dispersion)?.curve;
    let chance = |i: usize| fitted.probability(stripes[i].intensity);
    let mut found = Replicates { fitted, curves: Vec::with_capacity(replicates), refused: 0 };
    for _ in 0..replicates {
        match fit(&evidence(&drawn(stripes, chance, &mut uniform)), dispersion) {
            Ok(fit) => found.curves.push(fit.curve),
            Err(_) => found.refused += 1,
        }
    }
    if found.curves.is_empty() || found.curves.len() < found.refused {
        return Err(FitError::Unstable { usable: found.curves.len(), replicates });
    }
    Ok(found)
}
