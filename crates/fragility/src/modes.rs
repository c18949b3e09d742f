//! Competing failure modes: a failure in one mode precludes the others.

use crate::likelihood::{Likelihood, Observation, Score};
use crate::math::{ln, normal};

/// Share of each mode among failures, as a function of intensity.
///
/// ```text
/// s₁(x) = Φ(a₁ + b₁ ln x)                      share of all failures
/// s₂(x) = (1 − s₁(x)) Φ(a₂ + b₂ ln x)          share of the remaining failures, and so on
/// ```
///
/// The last mode takes all remaining failures, so that the shares add up to one. The share of a mode
/// multiplied by the probability of failure is the cumulative incidence of the mode (Kalbfleisch and Prentice
/// 2002, chapter 8). The cumulative incidence may decrease where another mode takes over. The incidences of
/// all modes add up to the probability of failure.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Coefficients `a` and `b` of every mode except the last.
    splits: Vec<[f64; 2]>,
}

impl Shares {
    /// Fits the shares of the modes to failures by maximum likelihood.
    ///
    /// Each failure is a pair `(intensity, mode)`; modes are numbered from 0. Returns `None` if the failures
    /// do not determine the shares, for example if two modes occur only on different sides of some intensity.
    pub fn fit(failures: &[(f64, usize)], modes: usize) -> Option<Self> {
        let mut splits = Vec::new();
        for mode in 0..modes.checked_sub(1)? {
            let left = || failures.iter().filter(|(_, of)| *of >= mode);
            let span = |own: bool| {
                let of = left().filter(|(_, of)| (*of == mode) == own).map(|(x, _)| *x);
                of.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)))
            };
            let ((low, high), (others_low, others_high)) = (span(true), span(false));
            if high <= others_low || others_high <= low {
                return None;
            }
            let terms: Vec<(Observation<2>, f64)> = left()
                .map(|(x, of)| {
                    let score = Score { offset: 0.0, row: [1.0, ln(*x)] };
                    (
                        if *of == mode {
                            Observation::Below(score)
                        } else {
                            Observation::Above(score)
                        },
                        1.0,
                    )
                })
                .collect();
            splits.push(Likelihood { terms, slope: None }.top([0.0, 0.0])?.parameters);
        }
        Some(Self { splits })
    }

    /// Returns the share of every mode at an intensity.
    pub fn at(&self, intensity: f64) -> Vec<f64> {
        let mut left = 1.0;
        let mut shares: Vec<f64> = self
            .splits
            .iter()
            .map(|[a, b]| {
                let share = left * normal(a + b * ln(intensity));
                left -= share;
                share
            })
            .collect();
        shares.push(left);
        shares
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns failures in three modes, whose shares at each of 40 intensities are those of `truth`.
    fn divided(truth: &Shares) -> Vec<(f64, usize)> {
        let mut failures = vec![];
        for i in 0..40 {
            let x = 0.1 * crate::math::exp(0.06 * f64::from(i));
            let shares = truth.at(x);
            for j in 0..200 {
                let u = (f64::from(j) + 0.5) / 200.0;
                let mode = if u < shares[0] {
                    0
                } else if u < shares[0] + shares[1] {
                    1
                } else {
                    2
                };
                failures.push((x, mode));
            }
        }
        failures
    }

    #[test]
    fn shares_that_are_known_are_found_and_add_up_to_one() {
        let truth = Shares { splits: vec![[-1.2, -0.9], [0.4, 0.8]] };
        let found = Shares::fit(&divided(&truth), 3).unwrap();
        for x in [0.12, 0.3, 0.8] {
            let (mine, exact) = (found.at(x), truth.at(x));
            assert!((mine.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for (a, b) in mine.iter().zip(&exact) {
                assert!((a - b).abs() < 2e-3, "{mine:?} {exact:?}"); // measured 4e-4
            }
        }
    }

    #[test]
    fn one_mode_has_all_and_modes_that_do_not_overlap_determine_no_shares() {
        assert_eq!(Shares::fit(&[(0.3, 0), (0.4, 0)], 1).unwrap().at(0.5), [1.0]);
        assert!(Shares::fit(&[(0.3, 0), (0.4, 0), (0.6, 1), (0.7, 1)], 2).is_none());
        assert!(Shares::fit(&[], 0).is_none());
    }
}
