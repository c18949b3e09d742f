//! The lognormal fragility curve.

use crate::math::{exp, ln, normal, normal_quantile};

/// Lognormal fragility curve: the probability of failure at an intensity `x` is `Φ(ln(x/θ)/β)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lognormal {
    /// Median capacity `θ`: the intensity at which half of the cases fail.
    pub median: f64,
    /// Dispersion `β`: the standard deviation of the logarithm of the capacity.
    pub dispersion: f64,
}

impl Lognormal {
    /// Returns the probability of failure at an intensity; 0 if the intensity is not positive.
    pub fn probability(&self, intensity: f64) -> f64 {
        if intensity <= 0.0 {
            return 0.0;
        }
        normal(ln(intensity / self.median) / self.dispersion)
    }

    /// Returns the intensity at which the probability of failure is `probability`.
    pub fn intensity(&self, probability: f64) -> f64 {
        self.median * exp(self.dispersion * normal_quantile(probability))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probability_and_intensity_are_inverse() {
        let curve = Lognormal { median: 0.4, dispersion: 0.5 };
        assert_eq!(curve.probability(0.4), 0.5);
        assert_eq!(curve.probability(0.0), 0.0);
        for p in [1e-9, 0.16, 0.5, 0.84, 0.999] {
            let back = curve.probability(curve.intensity(p));
            assert!((back / p - 1.0).abs() < 1e-12, "{p}"); // measured 1e-14
        }
    }
}
