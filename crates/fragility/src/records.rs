//! Confidence over records: how a curve changes when one record is left out.

use std::collections::BTreeSet;

use crate::curve::Lognormal;
use crate::evidence::Evidence;
use crate::fit::{Dispersion, FitError, fit};
use crate::math::{exp, ln, normal, normal_quantile, student_quantile};
use crate::proportion::Interval;

/// A curve, and those with each group of evidence, such as all cases of one record, left out.
///
/// Intervals are the delete-one jackknife of groups about the curve itself (the correction for few groups
/// that Bell and `McCaffrey` 2002 compare as the jackknife, and others call CR3) with Student's t of one degree
/// of freedom less than there are groups.
/// They take nothing for granted of how the cases of one record depend on each other.
/// Where tried, 95 % intervals hold the truth in 93.7 to 98.3 of 100 campaigns with 8 to 40 records at ten
/// levels, at one tenth, one half and nine tenths (`tests/coverage.rs`).
#[derive(Clone, Debug, PartialEq)]
pub struct LeaveOneOut {
    fitted: Lognormal,
    others: Vec<Lognormal>,
}

/// Intercept and slope of the score `a + b ln x`.
fn score(curve: &Lognormal) -> [f64; 2] {
    [-ln(curve.median) / curve.dispersion, 1.0 / curve.dispersion]
}

/// Fits evidence and what is left of it without each of its groups.
///
/// # Errors
/// As [`fit`]; [`FitError::Unstable`] for fewer than three groups, and where the evidence determines no curve
/// without one of them: one record then decides everything, and nothing can be said of how sure the curve is.
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
    /// Groups.
    pub fn groups(&self) -> usize {
        self.others.len()
    }

    /// Student's t of a level.
    fn reach(&self, level: f64) -> f64 {
        student_quantile(level, self.others.len() - 1)
    }

    /// The sum over the groups of the products of two changes, over what makes it a covariance.
    fn spread(&self, one: impl Fn(&Lognormal) -> f64, two: impl Fn(&Lognormal) -> f64) -> f64 {
        let n = self.others.len() as f64;
        let change =
            |other: &Lognormal| (one(other) - one(&self.fitted)) * (two(other) - two(&self.fitted));
        (n - 1.0) / n * self.others.iter().map(change).sum::<f64>()
    }

    /// The interval of anything computed from a curve whose errors are about as large to either side, such
    /// as the logarithm of a rate.
    pub fn interval(&self, level: f64, of: impl Fn(&Lognormal) -> f64) -> Interval {
        let here = of(&self.fitted);
        let half = self.reach(level) * self.spread(&of, &of).sqrt();
        Interval { low: here - half, high: here + half }
    }

    /// The interval of the chance of failure at each intensity.
    pub fn band(&self, level: f64, intensities: &[f64]) -> Vec<Interval> {
        let chance = |x: &f64| {
            // The score does not run into 0 and 1, and is linear in what is fitted.
            let scores = self.interval(level, |curve| ln(x / curve.median) / curve.dispersion);
            Interval { low: normal(scores.low), high: normal(scores.high) }
        };
        intensities.iter().map(chance).collect()
    }

    /// The interval of the intensity at which failure has a chance: where the band holds that chance
    /// (Fieller 1954). A bound is 0 or infinite where the band never leaves it.
    pub fn intensity(&self, level: f64, probability: f64) -> Interval {
        let part = |k: usize| move |curve: &Lognormal| score(curve)[k];
        let [a, b] = score(&self.fitted);
        let a = a - normal_quantile(probability);
        let t2 = self.reach(level) * self.reach(level);
        let (aa, ab, bb) = (
            a * a - t2 * self.spread(part(0), part(0)),
            a * b - t2 * self.spread(part(0), part(1)),
            b * b - t2 * self.spread(part(1), part(1)),
        );
        // (a + b u)² = t² V(u) with the logarithm u of the intensity.
        let root = ab * ab - aa * bb;
        if bb <= 0.0 || root < 0.0 {
            return Interval { low: 0.0, high: f64::INFINITY };
        }
        let bound = |sign: f64| exp((-ab + sign * root.sqrt()) / bb);
        Interval { low: bound(-1.0), high: bound(1.0) }
    }

    /// The interval of the dispersion.
    pub fn dispersion(&self, level: f64) -> Interval {
        let logs = self.interval(level, |curve| ln(curve.dispersion));
        Interval { low: exp(logs.low), high: exp(logs.high) }
    }

    /// The interval of the median.
    pub fn median(&self, level: f64) -> Interval {
        self.intensity(level, 0.5)
    }
}

/// The interval of the mean of a quantity between 0 and 1 over cases that go together in groups, each
/// `(sum, cases)`.
///
/// Wilson's interval with Student's t for the normal quantile, of as many independent cases as would scatter
/// like the groups do; as many as there are groups, where these do not scatter at all.
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
    Interval { low: (center - half).max(0.0), high: (center + half).min(1.0) }
}
