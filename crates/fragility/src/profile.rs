//! Confidence from the likelihood itself: what values of a quantity the data do not refuse.
//!
//! The interval of a quantity holds the values at which the likelihood, maximized over everything
//! else, falls short of its top by no more than half the quantile of χ² with one degree of freedom
//! (Wilks 1938). It needs no normality of the estimates and does not leave 0 to 1.

use crate::evidence::Evidence;
use crate::fit::{Dispersion, FitError, fit, likelihood};
use crate::likelihood::{Likelihood, Score};
use crate::math::{chi_square_quantile_one, exp, ln, normal};
use crate::proportion::Interval;

/// Scores beyond these are certain: `Φ(−38)` is the smallest number there is.
const CERTAIN: f64 = 38.0;

/// The likelihood of evidence under the condition that the score at `ln x = place` is `score`.
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

    /// How far a score at a place lies outside of the interval: negative inside.
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

/// The top over slopes that are not negative.
fn highest(of: &Likelihood<1>, start: f64) -> f64 {
    match of.top([start]) {
        Some(top) if top.parameters[0] >= 0.0 => top.shape.value,
        // The likelihood is concave, so that its top over b ≥ 0 is at 0 where it is not inside.
        _ => of.shape(&[0.0]).value,
    }
}

/// Where `excess` passes zero, going from a place where it is negative by steps that double; `limit`
/// where it does not.
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

/// The interval of the chance of failure at each intensity.
///
/// # Errors
/// As [`fit`], or for a level outside 0 to 1.
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

/// The interval of the median; a bound is 0 or infinite where the data allow any.
///
/// # Errors
/// As [`fit`], or for a level outside 0 to 1.
pub fn profile_median(
    evidence: &[Evidence],
    dispersion: Dispersion,
    level: f64,
) -> Result<Interval, FitError> {
    let (profile, found) = Profile::new(evidence, dispersion, level)?;
    let place = ln(found.curve.median);
    let step = found.median_error.max(1e-6);
    let excess = |place: f64| profile.excess(place, 0.0);
    // A median further than e⁵⁰ from the fitted one is any.
    let (low, high) = (place - 50.0, place + 50.0);
    let bounds = [edge(excess, place, -step, low), edge(excess, place, step, high)];
    Ok(Interval {
        low: if bounds[0] <= low { 0.0 } else { exp(bounds[0]) },
        high: if bounds[1] >= high { f64::INFINITY } else { exp(bounds[1]) },
    })
}
