//! Efficiency and sufficiency of intensity measures.

use crate::Evidence;
use crate::fit::{Dispersion, Fit, FitError, fit};
use crate::likelihood::{Likelihood, Observation, Score, solve};
use crate::math::{chi_square_above, ln, student_beyond};

/// Fit of failures to one intensity measure, with its efficiency and sufficiency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Fragility curve in terms of this measure. The more efficient the measure, the smaller the dispersion.
    pub fit: Fit,
    /// Concordance: the probability that a failed case had a higher intensity than a standing case (area
    /// under the ROC curve). It is 0.5 if the measure does not discriminate and 1 if it discriminates
    /// perfectly.
    pub concordance: f64,
    /// p-value of the sufficiency test: the probability that a second quantity without further information would
    /// improve the fit at least as much as the tested quantity does. A small value means that the first measure is not
    /// sufficient. `None` if there is no second quantity with one positive value for each case, or if this quantity is
    /// a power of the first measure, up to a constant factor.
    pub sufficiency: Option<f64>,
}

/// Fits failures against an intensity measure alone, and against this measure together with a second
/// quantity.
///
/// `cases` holds pairs `(intensity, failed)`, and `second` holds another quantity of each case, such as
/// another measure or the duration. Sufficiency is tested by a likelihood ratio: a probit regression on the
/// logarithms of both quantities is compared with a regression on the measure alone. The test assumes independent
/// cases.
///
/// # Errors
/// As for [`fit`].
pub fn failure_against(
    cases: &[(f64, bool)],
    second: Option<&[f64]>,
) -> Result<Measured, FitError> {
    let evidence: Vec<Evidence> =
        cases.iter().map(|(x, failed)| Evidence::case(*x, *failed, 0)).collect();
    let fit = fit(&evidence, Dispersion::Free)?;
    let sufficiency = second.and_then(|second| sufficiency(cases, second, &fit));
    Ok(Measured { fit, concordance: concordance(cases), sufficiency })
}

fn sufficiency(cases: &[(f64, bool)], second: &[f64], alone: &Fit) -> Option<f64> {
    if second.len() != cases.len() || second.iter().any(|x| !(x.is_finite() && *x > 0.0)) {
        return None;
    }
    let first: Vec<f64> = cases.iter().map(|(x, _)| ln(*x)).collect();
    let rest = residuals(&first, &second.iter().map(|x| ln(*x)).collect::<Vec<_>>())?;
    let terms = cases
        .iter()
        .zip(first.iter().zip(&rest))
        .map(|((_, failed), (u, v))| {
            let score = Score { offset: 0.0, row: [1.0, *u, *v] };
            (if *failed { Observation::Below(score) } else { Observation::Above(score) }, 1.0)
        })
        .collect();
    let b = 1.0 / alone.curve.dispersion;
    let both = Likelihood { terms, slope: Some(1) };
    // If there is no maximum, the two measures separate failures from survivals completely, and the likelihood tends to
    // 1.
    let highest =
        both.top([-b * ln(alone.curve.median), b, 0.0]).map_or(0.0, |top| top.shape.value);
    Some(chi_square_above(2.0 * (highest - alone.ln_likelihood), 1))
}

/// Returns the standardized residuals of the linear regression of `y` on `x`; `None` if all residuals vanish.
fn residuals(x: &[f64], y: &[f64]) -> Option<Vec<f64>> {
    let line = Line::through(x, y)?;
    let rest: Vec<f64> = x.iter().zip(y).map(|(x, y)| y - line.at(*x)).collect();
    let scale = (rest.iter().map(|r| r * r).sum::<f64>() / rest.len() as f64).sqrt();
    (scale > 1e-9).then(|| rest.iter().map(|r| r / scale).collect())
}

/// Returns the fraction of all pairs of a failed and a standing case in which the failed case has the higher intensity.
/// Pairs with equal intensities count half.
fn concordance(cases: &[(f64, bool)]) -> f64 {
    let mut sorted = cases.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut pairs, mut stood) = (0.0, 0.0);
    let mut failed_in_all = 0.0;
    let mut rest = sorted.as_slice();
    while let Some((x, _)) = rest.first() {
        let same = rest.iter().take_while(|(y, _)| y == x).count();
        let failed = rest[..same].iter().filter(|(_, failed)| *failed).count() as f64;
        let standing = same as f64 - failed;
        pairs += failed * (stood + 0.5 * standing);
        stood += standing;
        failed_in_all += failed;
        rest = &rest[same..];
    }
    pairs / (failed_in_all * stood)
}

/// Regression of demand on one intensity measure: `ln D = ln a + b ln x + ε`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demanded {
    /// Slope `b` of the regression.
    pub slope: f64,
    /// Standard deviation of `ε`, which is small for an efficient measure (Luco and Cornell 2007).
    pub dispersion: f64,
    /// Proficiency `dispersion/b`: the scatter expressed in terms of intensity. It also penalizes measures on
    /// which the demand depends only weakly (Padgett et al. 2008).
    pub proficiency: f64,
    /// p-value of the sufficiency test for a second quantity: the probability of a correlation between `ε` and this
    /// quantity that is at least as strong as the observed one, if `ε` does not depend on the quantity. `None` if
    /// there is no second quantity with one positive value for each case, if this quantity is a power of the intensity
    /// measure up to a constant factor, or if there are only three cases.
    pub sufficiency: Option<f64>,
    /// Number of cases.
    pub cases: usize,
}

/// Regresses the demands of standing cases on an intensity measure, and the residuals on a second quantity.
///
/// Each case is a pair `(intensity, demand)` of positive numbers. Returns `None` for fewer than three cases,
/// if all intensities are equal, or if one of these numbers is not positive and finite.
pub fn demand_against(cases: &[(f64, f64)], second: Option<&[f64]>) -> Option<Demanded> {
    let sound = |x: f64| x.is_finite() && x > 0.0;
    if cases.len() < 3 || !cases.iter().all(|(x, d)| sound(*x) && sound(*d)) {
        return None;
    }
    let (x, d): (Vec<f64>, Vec<f64>) = cases.iter().map(|(x, d)| (ln(*x), ln(*d))).unzip();
    let line = Line::through(&x, &d)?;
    let freedom = (cases.len() - 2) as f64;
    let rest: Vec<f64> = x.iter().zip(&d).map(|(x, d)| d - line.at(*x)).collect();
    let squares: f64 = rest.iter().map(|r| r * r).sum();
    let dispersion = (squares / freedom).sqrt();
    let sufficiency = second.and_then(|second| {
        let other = second.iter().all(|x| sound(*x)).then(|| second.iter().map(|x| ln(*x)));
        let other = residuals(&x, &other?.collect::<Vec<_>>())?;
        let line = Line::through(&other, &rest)?;
        let left: f64 = other.iter().zip(&rest).map(|(v, r)| r - line.at(*v)).map(|d| d * d).sum();
        let freedom = cases.len().checked_sub(3).filter(|freedom| *freedom > 0)?;
        let error = (left / freedom as f64 / other.len() as f64).sqrt();
        Some(if error > 0.0 { student_beyond(line.slope / error, freedom) } else { 0.0 })
    });
    Some(Demanded {
        slope: line.slope,
        dispersion,
        proficiency: dispersion / line.slope,
        sufficiency,
        cases: cases.len(),
    })
}

/// Least-squares straight line.
struct Line {
    intercept: f64,
    slope: f64,
}

impl Line {
    fn through(x: &[f64], y: &[f64]) -> Option<Self> {
        if x.len() != y.len() {
            return None;
        }
        let n = x.len() as f64;
        let center = x.iter().sum::<f64>() / n;
        // Centering decouples the two equations and keeps digits.
        let (mut sxx, mut sxy, mut sy) = (0.0, 0.0, 0.0);
        for (x, y) in x.iter().zip(y) {
            sxx += (x - center) * (x - center);
            sxy += (x - center) * y;
            sy += y;
        }
        if sxx <= 1e-12 * n {
            return None;
        }
        let [at_center, slope] = solve([[n, 0.0], [0.0, sxx]], [sy, sxy])?;
        Some(Self { intercept: at_center - slope * center, slope })
    }

    fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}
