//! Confidence intervals for dependent cases, by omitting one record at a time.

use std::collections::BTreeSet;

use crate::curve::Lognormal;
use crate::evidence::Evidence;
use crate::fit::{Dispersion, FitError, fit};
use crate::math::{exp, ln, normal, normal_quantile, student_quantile};
use crate::proportion::{Interval, unobserved};

/// Curve fitted to all evidence, and the curves fitted with one group of evidence omitted. A group is, for
/// example, all cases of one record.
///
/// Intervals come from the delete-one jackknife over groups, centered on the curve of all evidence, and from Student's
/// t distribution, with the number of groups minus one as degrees of freedom. (Bell and `McCaffrey` 2002 call this
/// correction for few groups the jackknife; others call it CR3.) The jackknife is applied to the logarithms of the
/// median and the dispersion. Functions of these are approximated to first order. Cases of one record may depend on
/// each other in any way. In simulations with 8 to 40 records at ten levels, the 95 % intervals at failure
/// probabilities of one tenth, one half and nine tenths contain the true value in 93 to 97.3 % of the simulated
/// campaigns (`tests/coverage.rs`).
#[derive(Clone, Debug, PartialEq)]
pub struct LeaveOneOut {
    fitted: Lognormal,
    others: Vec<Lognormal>,
}

/// Fits one curve to all evidence, and for each group one curve to the evidence without that group.
///
/// # Errors
/// As for [`fit`]; [`FitError::Unstable`] if there are fewer than three groups, or if the evidence determines no
/// curve when one of the groups is omitted. In the latter case a single record decides the result, and the
/// uncertainty cannot be estimated.
pub fn leave_one_out(all: &[Evidence], dispersion: Dispersion) -> Result<LeaveOneOut, FitError> {
    let fitted = fit(all, dispersion)?.curve;
    let groups: BTreeSet<usize> = all.iter().map(|item| item.group).collect();
    let mut others = Vec::with_capacity(groups.len());
    for group in &groups {
        let rest: Vec<Evidence> = all.iter().filter(|item| item.group != *group).copied().collect();
        others.extend(fit(&rest, dispersion).map(|fit| fit.curve));
    }
    if others.len() < groups.len() || groups.len() < 3 {
        return Err(FitError::Unstable { usable: others.len(), replicates: groups.len() });
    }
    Ok(LeaveOneOut { fitted, others })
}

impl LeaveOneOut {
    /// Returns the number of groups.
    pub fn groups(&self) -> usize {
        self.others.len()
    }

    /// Returns the quantile of Student's t distribution for a confidence level.
    fn reach(&self, level: f64) -> f64 {
        student_quantile(level, self.others.len() - 1)
    }

    /// Returns the jackknife covariance of two functions of the curve.
    fn spread(&self, one: impl Fn(&Lognormal) -> f64, two: impl Fn(&Lognormal) -> f64) -> f64 {
        let n = self.others.len() as f64;
        let change =
            |other: &Lognormal| (one(other) - one(&self.fitted)) * (two(other) - two(&self.fitted));
        (n - 1.0) / n * self.others.iter().map(change).sum::<f64>()
    }

    /// Returns the standard error of the logarithm of the median. It is valid even if cases of one record
    /// depend on each other.
    pub fn median_error(&self) -> f64 {
        self.spread(|curve| ln(curve.median), |curve| ln(curve.median)).sqrt()
    }

    /// Returns the standard error of the logarithm of the dispersion. It is valid even if cases of one record
    /// depend on each other.
    pub fn dispersion_error(&self) -> f64 {
        self.spread(|curve| ln(curve.dispersion), |curve| ln(curve.dispersion)).sqrt()
    }

    /// Returns the confidence interval of the quantity that `of` computes from a curve. The errors of this quantity
    /// must be nearly symmetric, as for the logarithm of a rate.
    pub fn interval(&self, level: f64, of: impl Fn(&Lognormal) -> f64) -> Interval {
        let here = of(&self.fitted);
        let half = self.reach(level) * self.spread(&of, &of).sqrt();
        Interval { low: here - half, high: here + half }
    }

    /// Returns the confidence interval of the probability of failure at each intensity.
    pub fn band(&self, level: f64, intensities: &[f64]) -> Vec<Interval> {
        let chance = |x: &f64| {
            // The interval is computed for the score, which is not bounded, and is then converted to probabilities.
            let score = ln(x / self.fitted.median) / self.fitted.dispersion;
            let half = self.reach(level) * self.score_error(score);
            Interval { low: normal(score - half), high: normal(score + half) }
        };
        intensities.iter().map(chance).collect()
    }

    /// Returns the standard error of a score `(ln x − ln m) / β`, to first order in the errors of `ln m` and `ln β`.
    ///
    /// The scores of the curves with one record omitted are not used, since such a curve may be so steep that
    /// its score diverges.
    fn score_error(&self, score: f64) -> f64 {
        let (place, width) = (|c: &Lognormal| ln(c.median), |c: &Lognormal| ln(c.dispersion));
        let beta = self.fitted.dispersion;
        let variance = self.spread(place, place) / (beta * beta)
            + 2.0 * score / beta * self.spread(place, width)
            + score * score * self.spread(width, width);
        variance.max(0.0).sqrt()
    }

    /// Returns the confidence interval of the intensity at which the probability of failure is `probability`.
    pub fn intensity(&self, level: f64, probability: f64) -> Interval {
        let Lognormal { median, dispersion } = self.fitted;
        let score = normal_quantile(probability);
        let half = self.reach(level) * self.score_error(score);
        let at = |score: f64| median * exp(dispersion * score);
        Interval { low: at(score - half), high: at(score + half) }
    }

    /// Returns the confidence interval of the dispersion.
    pub fn dispersion(&self, level: f64) -> Interval {
        let logs = self.interval(level, |curve| ln(curve.dispersion));
        Interval { low: exp(logs.low), high: exp(logs.high) }
    }

    /// Returns the confidence interval of the median.
    pub fn median(&self, level: f64) -> Interval {
        self.intensity(level, 0.5)
    }
}

/// Returns the confidence interval of the mean of a quantity between 0 and 1. Cases of the same group depend on each
/// other.
///
/// Each group is `(sum, cases)`. The interval is Wilson's, with two changes. A quantile of Student's t distribution
/// replaces the normal quantile, and an effective number of independent cases replaces the number of cases. The scatter
/// of the groups determines the variance of the mean; the effective number is the number of independent cases whose
/// mean would have the same variance. If the groups do not scatter at all, the number of groups is used instead.
///
/// A few groups may agree by chance, and groups with other means may be missing from the sample ([`unobserved`]). The
/// interval is therefore extended to the means that would result if the missing groups contained only zeros, or only
/// ones.
pub fn grouped_mean(groups: &[(f64, f64)], level: f64) -> Interval {
    let count = groups.len() as f64;
    let cases: f64 = groups.iter().map(|(_, cases)| cases).sum();
    if groups.len() < 2 || cases <= 0.0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let p = groups.iter().map(|(sum, _)| sum).sum::<f64>() / cases;
    let squares: f64 = groups.iter().map(|(sum, cases)| sum - p * cases).map(|off| off * off).sum();
    let variance = count / (count - 1.0) * squares / (cases * cases);
    let alike = p * (1.0 - p) / variance;
    let n = if variance > 0.0 && alike > 0.0 { alike } else { count };
    let z = student_quantile(level, groups.len() - 1);
    let scale = 1.0 + z * z / n;
    let center = (p + z * z / (2.0 * n)) / scale;
    let half = z / scale * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let missed = unobserved(groups.len(), level);
    Interval {
        low: (center - half).min((1.0 - missed) * p).max(0.0),
        high: (center + half).max((1.0 - missed) * p + missed).min(1.0),
    }
}

/// Returns the confidence interval of the mean of paired differences; `None` for fewer than two differences.
///
/// `differences` holds one difference for each group, between `-most` and `most`. The interval is based on Student's t
/// distribution. It is widened like the interval of [`grouped_mean`], since a few differences may agree by chance.
/// `tries` is the number of such intervals from which one is selected. The level applies to all of them together
/// (Bonferroni), so that the best of many differences is not overrated.
pub fn mean_difference(
    differences: &[f64],
    most: f64,
    level: f64,
    tries: usize,
) -> Option<Interval> {
    let count = differences.len();
    if count < 2 {
        return None;
    }
    let mean = differences.iter().sum::<f64>() / count as f64;
    let squares: f64 = differences.iter().map(|one| (one - mean) * (one - mean)).sum();
    let error = (squares / (count as f64 * (count as f64 - 1.0))).sqrt();
    let together = 1.0 - (1.0 - level) / tries.max(1) as f64;
    let half = student_quantile(together, count - 1) * error;
    let missed = unobserved(count, level);
    Some(Interval {
        low: (mean - half).min((1.0 - missed) * mean - missed * most).max(-most),
        high: (mean + half).max((1.0 - missed) * mean + missed * most).min(most),
    })
}
