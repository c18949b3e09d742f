//! Goodness-of-fit tests of a fitted fragility curve.

use crate::bootstrap::drawn;
use crate::curve::Lognormal;
use crate::evidence::{Stripe, evidence};
use crate::fit::{Dispersion, Fit, FitError, fit, moments};
use crate::math::{chi_square_above, exp, ln, normal, normal_quantile};

/// Result of a goodness-of-fit test of failure counts against a fitted curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goodness {
    /// Deviance: twice the log-likelihood ratio between the observed fractions and the curve, over all
    /// stripes.
    pub deviance: f64,
    /// Pearson's statistic: sum over the pooled groups of the squared residual divided by its binomial
    /// variance.
    pub pearson: f64,
    /// Number of groups. Neighboring stripes are pooled until every group has at least one expected failure
    /// and one expected survival.
    pub groups: usize,
    /// Degrees of freedom: number of groups minus number of fitted parameters.
    pub freedom: usize,
    /// p-value: the probability of a statistic `pearson` at least as large as this one if the cases follow the curve.
    /// If there are no degrees of freedom, `p` is 1 and the test is meaningless.
    pub p: f64,
}

/// Returns twice the log-likelihood ratio between the observed fractions and given probabilities.
pub(crate) fn deviance(stripes: &[Stripe], chance: impl Fn(usize) -> f64) -> f64 {
    // x ln(x/y), which is zero at x = 0.
    let part = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x * ln(x / y) };
    stripes
        .iter()
        .enumerate()
        .map(|(i, s)| {
            let (n, k, p) = (f64::from(s.cases), f64::from(s.failures), chance(i));
            2.0 * (part(k, n * p) + part(n - k, n * (1.0 - p)))
        })
        .sum()
}

/// Computes Pearson's test of failure counts against a fitted curve, and the deviance.
///
/// Neighboring stripes are pooled into groups (Hosmer and Lemeshow 1980). Cases must be independent. If the
/// same records are used at every level, counts scatter less than binomial counts, and the test is too
/// lenient.
pub fn goodness(stripes: &[Stripe], found: &Fit) -> Goodness {
    let mut sorted = stripes.to_vec();
    sorted.sort_by(|a, b| a.intensity.total_cmp(&b.intensity));
    goodness_in_bins(&sorted.iter().map(|stripe| vec![*stripe]).collect::<Vec<_>>(), found)
}

/// Computes [`goodness`] for bins in which cases have different intensities. Each bin is a list of stripes. The bins
/// must be in ascending order of intensity.
///
/// The expected number of failures in a bin is the sum of the failure probabilities of its cases, each at its own
/// intensity, because the curve is not linear within the bin.
pub fn goodness_in_bins(bins: &[Vec<Stripe>], found: &Fit) -> Goodness {
    let chance = |s: &Stripe| found.curve.probability(s.intensity);
    // Cases, failures, expected failures, variance.
    let mut groups: Vec<[f64; 4]> = vec![];
    let expects_both = |g: &[f64; 4]| g[2] >= 1.0 && g[0] - g[2] >= 1.0;
    let mut open = [0.0; 4];
    for bin in bins {
        for stripe in bin {
            let (n, p) = (f64::from(stripe.cases), chance(stripe));
            let part = [n, f64::from(stripe.failures), n * p, n * p * (1.0 - p)];
            open.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        if expects_both(&open) {
            groups.push(open);
            open = [0.0; 4];
        }
    }
    if open[0] > 0.0 {
        match groups.last_mut() {
            Some(last) => last.iter_mut().zip(open).for_each(|(sum, part)| *sum += part),
            None => groups.push(open),
        }
    }
    let pearson = groups.iter().map(|g| (g[1] - g[2]) * (g[1] - g[2]) / g[3]).sum();
    let freedom = groups.len().saturating_sub(found.parameters);
    let all: Vec<Stripe> = bins.iter().flatten().copied().collect();
    Goodness {
        deviance: deviance(&all, |i| chance(&all[i])),
        pearson,
        groups: groups.len(),
        freedom,
        p: chi_square_above(pearson, freedom),
    }
}

/// Estimates by simulation the probability of a deviance at least as large as the observed one if the cases follow
/// the fitted curve.
///
/// Counts are sampled from the curve, and a curve is fitted to each sample. The result is valid even for
/// small counts, for which the χ² approximation is not.
///
/// # Errors
/// As for [`fit`], or if fewer than half of the samples determine a curve.
pub fn goodness_by_simulation(
    stripes: &[Stripe],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<f64, FitError> {
    let misfit = |stripes: &[Stripe], curve: &Lognormal| {
        deviance(stripes, |i| curve.probability(stripes[i].intensity))
    };
    let curve = fit(&evidence(stripes), dispersion)?.curve;
    let observed = misfit(stripes, &curve);
    let chance = |i: usize| curve.probability(stripes[i].intensity);
    let (mut usable, mut worse) = (0_usize, 0_usize);
    for _ in 0..replicates {
        let draw = drawn(stripes, chance, &mut uniform);
        if let Ok(again) = fit(&evidence(&draw), dispersion) {
            usable += 1;
            worse += usize::from(misfit(&draw, &again.curve) >= observed - 1e-12);
        }
    }
    if usable == 0 || 2 * usable < replicates {
        return Err(FitError::Unstable { usable, replicates });
    }
    Ok((worse + 1) as f64 / (usable + 1) as f64)
}

/// Result of a test of whether capacities are lognormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normality {
    /// Largest distance between the empirical distribution function of the capacities and the fitted one
    /// (Lilliefors 1967).
    pub distance: f64,
    /// p-value: the probability of a distance at least as large as this one if capacities are lognormal.
    pub p: f64,
}

/// Tests whether exact capacities are lognormal with unknown median and dispersion (Lilliefors 1967).
///
/// The test statistic is [`Normality::distance`]. Its distribution, which does not depend on the median and the
/// dispersion, is simulated.
///
/// # Errors
/// As for [`moments`].
pub fn normality(
    capacities: &[f64],
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Normality, FitError> {
    let observed = distance(capacities)?;
    let mut worse = 0_usize;
    for _ in 0..replicates {
        let draw: Vec<f64> = (0..capacities.len())
            .map(|_| exp(normal_quantile(uniform().max(f64::MIN_POSITIVE))))
            .collect();
        worse += usize::from(distance(&draw)? >= observed);
    }
    Ok(Normality { distance: observed, p: (worse + 1) as f64 / (replicates + 1) as f64 })
}

fn distance(capacities: &[f64]) -> Result<f64, FitError> {
    let curve = moments(capacities)?;
    let mut scores: Vec<f64> =
        capacities.iter().map(|x| (ln(*x) - ln(curve.median)) / curve.dispersion).collect();
    scores.sort_by(f64::total_cmp);
    let n = scores.len() as f64;
    let gap = |(i, z): (usize, &f64)| {
        let p = normal(*z);
        (p - i as f64 / n).max((i + 1) as f64 / n - p)
    };
    Ok(scores.iter().enumerate().map(gap).fold(0.0, f64::max))
}
