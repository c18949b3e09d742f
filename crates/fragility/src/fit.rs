//! Maximum-likelihood fit of a lognormal fragility curve.

use crate::Stripe;
use crate::curve::Lognormal;
use crate::evidence::{Capacity, Evidence, check};
use crate::likelihood::{Likelihood, Observation, Score, Top, covariance};
use crate::math::{exp, ln, ln_choose, normal_quantile};
use crate::proportion::Interval;

/// Treatment of the dispersion in a fit: fitted or given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dispersion {
    /// The dispersion is fitted together with the median.
    Free,
    /// The dispersion `β > 0` is given, for example from similar structures, because the data cannot
    /// determine it.
    Fixed(f64),
}

/// Reason why data do not determine a curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// There is no evidence.
    #[error("expected at least one observation, found none; run some cases first")]
    Empty,
    /// A number is not valid as an intensity or a count.
    #[error("observation {}: expected {expected}, found {found}", index + 1)]
    Invalid {
        /// Index of the observation in the evidence, counted from 0.
        index: usize,
        /// Description of a valid value.
        expected: &'static str,
        /// Invalid value.
        found: f64,
    },
    /// The given dispersion is not a positive number.
    #[error("expected a positive, finite dispersion, found {0}")]
    BadDispersion(f64),
    /// The confidence level is not between 0 and 1.
    #[error("expected a confidence level between 0 and 1, found {0}")]
    BadLevel(f64),
    /// Every case stood.
    #[error(
        "no case failed up to an intensity of {largest}: the median is above this intensity, and no curve can be \
         fitted; add cases of higher intensity"
    )]
    NothingFailed {
        /// Highest intensity of all cases.
        largest: f64,
    },
    /// Every case failed.
    #[error(
        "every case failed, even at the lowest intensity of {smallest}: the median is below this intensity, and no \
         curve can be fitted; add cases of lower intensity"
    )]
    EverythingFailed {
        /// Lowest intensity of all cases.
        smallest: f64,
    },
    /// The highest intensity at which a case survived is not above the lowest intensity at which a case
    /// failed.
    #[error(
        "no case survived above an intensity of {above}, and no case failed below {below}, so the dispersion cannot be \
         determined; add cases around these intensities, or give the dispersion"
    )]
    Separated {
        /// Highest intensity at which a case survived.
        above: f64,
        /// Lowest intensity at which a case failed.
        below: f64,
    },
    /// Failure does not become likelier as intensity increases.
    #[error(
        "the probability of failure does not increase with intensity, so no fragility curve describes the cases; \
         compare the share of failed cases at each intensity, and try another intensity measure"
    )]
    NotIncreasing,
    /// The iteration did not converge.
    #[error(
        "the fit did not converge; check whether the intensities differ by many orders of magnitude"
    )]
    NotConverged,
    /// Too few resampled data sets determine a curve.
    #[error(
        "a curve can be fitted to only {usable} of {replicates} resampled data sets; add cases, or give the dispersion"
    )]
    Unstable {
        /// Number of resampled data sets that determine a curve.
        usable: usize,
        /// Number of resampled data sets.
        replicates: usize,
    },
}

/// Fitted fragility curve with its standard errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Fitted curve.
    pub curve: Lognormal,
    /// Standard error of `ln θ`.
    pub median_error: f64,
    /// Standard error of `ln β`; zero if the dispersion was given.
    pub dispersion_error: f64,
    /// Covariance of `ln θ` and `ln β`.
    pub covariance: f64,
    /// Logarithm of the likelihood without binomial coefficients; see [`Fit::ln_likelihood_of`].
    pub ln_likelihood: f64,
    /// Number of fitted parameters: 1 or 2.
    pub parameters: usize,
}

impl Fit {
    /// Returns the log-likelihood of failure counts, including binomial coefficients (Baker 2015, eq. 9).
    pub fn ln_likelihood_of(&self, stripes: &[Stripe]) -> f64 {
        let coefficients: f64 =
            stripes.iter().map(|s| ln_choose(s.cases, s.failures.min(s.cases))).sum();
        self.ln_likelihood + coefficients
    }

    /// Returns the confidence interval of the median, computed from the standard error of its logarithm.
    pub fn median_interval(&self, level: f64) -> Interval {
        around(self.curve.median, self.median_error, level)
    }

    /// Returns the confidence interval of the dispersion, computed from the standard error of its logarithm.
    pub fn dispersion_interval(&self, level: f64) -> Interval {
        around(self.curve.dispersion, self.dispersion_error, level)
    }
}

/// Returns the interval from `value / exp(z error)` to `value exp(z error)`, where `z` is the normal quantile
/// for the confidence level.
fn around(value: f64, error: f64, level: f64) -> Interval {
    let reach = exp(-normal_quantile(0.5 * (1.0 - level)) * error);
    Interval { low: value / reach, high: value * reach }
}

/// Fits a lognormal curve to evidence by maximum likelihood.
///
/// The likelihood of an observation is the probability (or, for an exact capacity, the density) of its capacity. For
/// failure counts, the fit follows Baker (2015). For `n` exact capacities, `ln θ` and `β²` are the mean and the
/// variance of the logarithms of the capacities. This variance is the sum of the squared deviations divided by `n`,
/// whereas [`moments`] divides by `n − 1`. Standard errors follow from the observed information matrix and assume
/// independent cases.
///
/// # Errors
/// A [`FitError`] if the evidence does not determine a curve.
pub fn fit(evidence: &[Evidence], dispersion: Dispersion) -> Result<Fit, FitError> {
    check(evidence)?;
    existence(evidence, dispersion)?;
    match dispersion {
        Dispersion::Free => free(evidence),
        Dispersion::Fixed(beta) => fixed(evidence, beta),
    }
}

fn free(evidence: &[Evidence]) -> Result<Fit, FitError> {
    let top = top_free(evidence)?;
    let [a, b] = top.parameters;
    let c = covariance(&top.shape.curvature).ok_or(FitError::NotConverged)?;
    // Derivatives of ln θ = −a/b and ln β = −ln b with respect to (a, b).
    let by_median = [-1.0 / b, a / (b * b)];
    let by_dispersion = [0.0, -1.0 / b];
    let product = |u: [f64; 2], v: [f64; 2]| {
        (0..2).map(|i| (0..2).map(|j| u[i] * c[i][j] * v[j]).sum::<f64>()).sum::<f64>()
    };
    Ok(Fit {
        curve: Lognormal { median: exp(-a / b), dispersion: 1.0 / b },
        median_error: product(by_median, by_median).sqrt(),
        dispersion_error: product(by_dispersion, by_dispersion).sqrt(),
        covariance: product(by_median, by_dispersion),
        ln_likelihood: top.shape.value,
        parameters: 2,
    })
}

fn fixed(evidence: &[Evidence], beta: f64) -> Result<Fit, FitError> {
    let likelihood = fixed_likelihood(evidence, beta);
    let start = -middle(evidence) / beta;
    let top = likelihood.top([start]).ok_or(FitError::NotConverged)?;
    let [[variance]] = covariance(&top.shape.curvature).ok_or(FitError::NotConverged)?;
    Ok(Fit {
        curve: Lognormal { median: exp(-top.parameters[0] * beta), dispersion: beta },
        median_error: beta * variance.sqrt(),
        dispersion_error: 0.0,
        covariance: 0.0,
        ln_likelihood: top.shape.value,
        parameters: 1,
    })
}

/// Maximizes the likelihood over the intercept `a = −ln θ/β` and the slope `b = 1/β`.
pub(crate) fn top_free(evidence: &[Evidence]) -> Result<Top<2>, FitError> {
    let start = [-middle(evidence), 1.0];
    // The iteration starts from β = 1 and from ln θ at the mean logarithm of the intensities. This start is wide enough
    // for any data.
    let top = free_likelihood(evidence).top(start).ok_or(FitError::NotConverged)?;
    let [intercept, slope] = top.parameters;
    // A slope so small that the median overflows counts as zero.
    let median = exp(-intercept / slope);
    if slope > 0.0 && median > 0.0 && median.is_finite() {
        Ok(top)
    } else {
        Err(FitError::NotIncreasing)
    }
}

/// Returns the likelihood as a function of `a` and `b`, where `z = a + b ln x`.
fn free_likelihood(evidence: &[Evidence]) -> Likelihood<2> {
    likelihood(evidence, Some(1), 0.0, |u| Score { offset: 0.0, row: [1.0, u] })
}

/// Returns the likelihood as a function of `a`, where `z = a + ln x/β` and `β` is given.
pub(crate) fn fixed_likelihood(evidence: &[Evidence], beta: f64) -> Likelihood<1> {
    likelihood(evidence, None, -ln(beta), |u| Score { offset: u / beta, row: [1.0] })
}

/// Returns the likelihood of evidence. The function `score` returns the normal score `z` for a given `ln x`.
///
/// `slope` is the index of the parameter that is the slope `1/β`. If the slope is not a parameter, `slope` is `None`
/// and `ln_slope` is the logarithm of `1/β`; otherwise `ln_slope` is 0.
pub(crate) fn likelihood<const N: usize>(
    evidence: &[Evidence],
    slope: Option<usize>,
    ln_slope: f64,
    score: impl Fn(f64) -> Score<N>,
) -> Likelihood<N> {
    let observation = |capacity: Capacity| match capacity {
        Capacity::At(x) => Observation::At(score(ln(x)), ln(x) - ln_slope),
        Capacity::Below(x) => Observation::Below(score(ln(x))),
        Capacity::Above(x) => Observation::Above(score(ln(x))),
        Capacity::Between(low, high) => Observation::Between(score(ln(low)), score(ln(high))),
    };
    let terms = evidence.iter().map(|item| (observation(item.capacity), item.weight)).collect();
    Likelihood { terms, slope }
}

/// Returns the mean of the logarithms of all intensities.
fn middle(evidence: &[Evidence]) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for item in evidence {
        let (low, high) = item.capacity.bounds();
        let u = match (low > 0.0, high.is_finite()) {
            (true, true) => 0.5 * (ln(low) + ln(high)),
            (true, false) => ln(low),
            (false, _) => ln(high),
        };
        sum += item.weight * u;
        weight += item.weight;
    }
    sum / weight
}

/// Checks that the likelihood has its maximum at a positive, finite dispersion.
///
/// There is no such maximum if a single capacity agrees with all evidence, since the dispersion then tends to zero.
/// There is no such maximum either if the likelihood decreases with increasing `b` at `b = 1/β = 0`, since failure then
/// becomes less likely as intensity increases. Both criteria are exact, because the log-likelihood is concave.
fn existence(evidence: &[Evidence], dispersion: Dispersion) -> Result<(), FitError> {
    let (mut above, mut below) = (0.0_f64, f64::INFINITY);
    let (mut largest, mut smallest) = (0.0_f64, f64::INFINITY);
    for item in evidence {
        let (low, high) = item.capacity.bounds();
        above = above.max(low);
        below = below.min(high);
        if let Capacity::Below(x) | Capacity::Above(x) = item.capacity {
            largest = largest.max(x);
            smallest = smallest.min(x);
        }
    }
    if below.is_infinite() {
        return Err(FitError::NothingFailed { largest });
    }
    if above == 0.0 {
        return Err(FitError::EverythingFailed { smallest });
    }
    if let Dispersion::Fixed(beta) = dispersion {
        let sound = beta.is_finite() && beta > 0.0;
        return if sound { Ok(()) } else { Err(FitError::BadDispersion(beta)) };
    }
    if above <= below {
        return Err(FitError::Separated { above, below });
    }
    let only_cases =
        |item: &Evidence| matches!(item.capacity, Capacity::Below(_) | Capacity::Above(_));
    if evidence.iter().all(only_cases) {
        // At b = 0 every case fails with the same probability, the overall share of failures. The derivative of the
        // likelihood there is the sum of (failed − share) ln x over the cases, up to a positive factor.
        let total: f64 = evidence.iter().map(|item| item.weight).sum();
        let failed =
            |item: &Evidence| f64::from(u8::from(matches!(item.capacity, Capacity::Below(_))));
        let share = evidence.iter().map(|item| item.weight * failed(item)).sum::<f64>() / total;
        let center = middle(evidence);
        let rise: f64 = evidence
            .iter()
            .map(|item| {
                let (low, high) = item.capacity.bounds();
                let x = if low > 0.0 { low } else { high };
                item.weight * (failed(item) - share) * (ln(x) - center)
            })
            .sum();
        if rise <= 1e-12 * total {
            return Err(FitError::NotIncreasing);
        }
    }
    Ok(())
}

/// Estimates median and dispersion of exact capacities by the method of moments.
///
/// `ln θ` is the mean of the logarithms of the capacities, and `β` is their sample standard deviation with
/// the divisor `n − 1` (Baker 2015, eqs. 2 and 3).
///
/// # Errors
/// If there are fewer than two different capacities, or if a capacity is not a positive number.
pub fn moments(capacities: &[f64]) -> Result<Lognormal, FitError> {
    let all: Vec<Evidence> =
        capacities.iter().map(|x| Evidence::capacity(Capacity::At(*x), 0)).collect();
    check(&all)?;
    existence(&all, Dispersion::Free)?;
    let n = capacities.len() as f64;
    let mean = capacities.iter().map(|x| ln(*x)).sum::<f64>() / n;
    let squares: f64 = capacities.iter().map(|x| (ln(*x) - mean) * (ln(*x) - mean)).sum();
    Ok(Lognormal { median: exp(mean), dispersion: (squares / (n - 1.0)).sqrt() })
}
