//! Profile-likelihood confidence intervals.
//!
//! For each value of a quantity, the log-likelihood is maximized over the other parameters. The interval
//! contains all values for which this log-likelihood is below the overall maximum by at most half the
//! quantile of χ² with one degree of freedom (Wilks 1938). Estimates need not be normally distributed, and
//! intervals of probabilities remain between 0 and 1.

use crate::evidence::Evidence;
use crate::fit::{Dispersion, FitError, fit, likelihood};
use crate::likelihood::{Likelihood, Score};
use crate::math::{chi_square_quantile_one, exp, ln, normal};
use crate::proportion::Interval;

/// Magnitude of a normal score beyond which the probability counts as 0 or 1. `Φ(−38)` is close to the
/// smallest representable number.
const CERTAIN: f64 = 38.0;

/// Profile likelihood of the evidence: the highest likelihood of all curves that have a given normal score at a given
/// intensity.
struct Profile<'a> {
    evidence: &'a [Evidence],
    dispersion: Dispersion,
    top: f64,
    drop: f64,
    slope: f64,
}

impl<'a> Profile<'a> {
    fn new(
        evidence: &'a [Evidence],
        dispersion: Dispersion,
        level: f64,
    ) -> Result<(Self, crate::Fit), FitError> {
        if !(level > 0.0 && level < 1.0) {
            return Err(FitError::BadLevel(level));
        }
        let found = fit(evidence, dispersion)?;
        let profile = Self {
            evidence,
            dispersion,
            top: found.ln_likelihood,
            drop: 0.5 * chi_square_quantile_one(level),
            slope: 1.0 / found.curve.dispersion,
        };
        Ok((profile, found))
    }

    /// Returns the drop of the profile log-likelihood below its maximum, minus the drop at the ends of the confidence
    /// interval. The result is negative inside the interval.
    ///
    /// The profile log-likelihood is the largest log-likelihood of all curves that have the normal score `score` at
    /// `ln x = place`.
    fn excess(&self, place: f64, score: f64) -> f64 {
        let highest = match self.dispersion {
            Dispersion::Free => {
                let of = likelihood(self.evidence, Some(0), 0.0, |u| Score {
                    offset: score,
                    row: [u - place],
                });
                highest(&of, self.slope)
            }
            Dispersion::Fixed(beta) => {
                let of: Likelihood<0> = likelihood(self.evidence, None, -ln(beta), |u| Score {
                    offset: score + (u - place) / beta,
                    row: [],
                });
                of.shape(&[]).value
            }
        };
        self.top - highest - self.drop
    }
}

/// Returns the maximum of the log-likelihood over slopes of at least 0.
fn highest(of: &Likelihood<1>, start: f64) -> f64 {
    match of.top([start]) {
        Some(top) if top.parameters[0] >= 0.0 => top.shape.value,
        // The likelihood is concave, so if it has no maximum at a slope b > 0, its highest value for b ≥ 0 is at b = 0.
        _ => of.shape(&[0.0]).value,
    }
}

/// Returns the zero of `excess` between `from`, where `excess` is negative, and `limit`; returns `limit` if
/// there is no zero.
///
/// The zero is bracketed with steps of doubling length and then found by bisection.
fn edge(excess: impl Fn(f64) -> f64, from: f64, step: f64, limit: f64) -> f64 {
    let beyond = |x: f64| if step > 0.0 { x >= limit } else { x <= limit };
    let (mut inside, mut stride) = (from, step);
    let mut outside = inside + stride;
    loop {
        if beyond(outside) {
            outside = limit;
        }
        let there = excess(outside);
        if there > 0.0 || !there.is_finite() {
            break;
        }
        if outside == limit {
            return limit;
        }
        inside = outside;
        stride *= 2.0;
        outside = inside + stride;
    }
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        let there = excess(middle);
        *(if there <= 0.0 { &mut inside } else { &mut outside }) = middle;
        if (outside - inside).abs() <= 1e-9 * inside.abs().max(1.0) {
            break;
        }
    }
    0.5 * (inside + outside)
}

/// Returns the confidence interval of the probability of failure at each intensity.
///
/// # Errors
/// As for [`fit`], or if the level is not between 0 and 1.
pub fn profile_band(
    evidence: &[Evidence],
    dispersion: Dispersion,
    level: f64,
    intensities: &[f64],
) -> Result<Vec<Interval>, FitError> {
    let (profile, found) = Profile::new(evidence, dispersion, level)?;
    let mut band = Vec::with_capacity(intensities.len());
    for (index, &intensity) in intensities.iter().enumerate() {
        if !(intensity.is_finite() && intensity > 0.0) {
            let expected = "a positive, finite intensity";
            return Err(FitError::Invalid { index, expected, found: intensity });
        }
        let place = ln(intensity);
        let score = (place - ln(found.curve.median)) / found.curve.dispersion;
        let inside = score.clamp(-CERTAIN, CERTAIN);
        let step = 0.5;
        let excess = |score: f64| profile.excess(place, score);
        band.push(Interval {
            low: normal(edge(excess, inside, -step, -CERTAIN)),
            high: normal(edge(excess, inside, step, CERTAIN)),
        });
    }
    Ok(band)
}

/// Returns the confidence interval of the median. If the data do not bound the median, the lower bound is 0 or the
/// upper bound is infinite.
///
/// # Errors
/// As for [`fit`], or if the level is not between 0 and 1.
pub fn profile_median(
    evidence: &[Evidence],
    dispersion: Dispersion,
    level: f64,
) -> Result<Interval, FitError> {
    let (profile, found) = Profile::new(evidence, dispersion, level)?;
    let place = ln(found.curve.median);
    let step = found.median_error.max(1e-6);
    let excess = |place: f64| profile.excess(place, 0.0);
    // A bound further than e⁵⁰ from the fitted median counts as unbounded.
    let (low, high) = (place - 50.0, place + 50.0);
    let bounds = [edge(excess, place, -step, low), edge(excess, place, step, high)];
    Ok(Interval {
        low: if bounds[0] <= low { 0.0 } else { exp(bounds[0]) },
        high: if bounds[1] >= high { f64::INFINITY } else { exp(bounds[1]) },
    })
}
