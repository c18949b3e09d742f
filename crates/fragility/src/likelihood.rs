//! Likelihood of evidence: its value, its derivatives and its maximization.
//!
//! The score `z = offset + row · p` is linear in the parameters `p`. The log-likelihood of every kind of
//! evidence is therefore concave in `p` (Olsen 1978 for exact and censored values; probit for failures and
//! survivals), and damped Newton steps find its only maximum.

use crate::math::{LN_ROOT_TAU, ln, ln_normal, mills, normal_between, normal_density};

/// Normal score `z`, as a linear function of the parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Score<const N: usize> {
    pub offset: f64,
    pub row: [f64; N],
}

impl<const N: usize> Score<N> {
    fn at(&self, p: &[f64; N]) -> f64 {
        self.row.iter().zip(p).fold(self.offset, |sum, (row, p)| sum + row * p)
    }
}

/// An observation of a standard normal variable `Z`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Observation<const N: usize> {
    /// `Z = z`, since the capacity `x` is known. Its log-density is `ln φ(z) + ln b − ln x`, where `b` is the slope of
    /// `z` as a function of `ln x`. The second field is subtracted from `ln φ(z)`. If `b` is not a parameter, this
    /// field is `ln x − ln b`. If `b` is a parameter, the field is `ln x`, and [`Likelihood::term`] adds `ln b`.
    At(Score<N>, f64),
    /// `Z` is at most `z`.
    Below(Score<N>),
    /// `Z` is above `z`.
    Above(Score<N>),
    /// `Z` lies between the two values of `z`.
    Between(Score<N>, Score<N>),
}

/// Weighted sum of the log-likelihoods of observations.
#[derive(Clone, Debug)]
pub(crate) struct Likelihood<const N: usize> {
    pub terms: Vec<(Observation<N>, f64)>,
    /// Index of the parameter that is the slope `1/β`; `None` if the slope is not a parameter.
    pub slope: Option<usize>,
}

/// Value, gradient and Hessian of a log-likelihood at one point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<const N: usize> {
    pub value: f64,
    pub gradient: [f64; N],
    pub curvature: [[f64; N]; N],
}

impl<const N: usize> Shape<N> {
    const ZERO: Self = Self { value: 0.0, gradient: [0.0; N], curvature: [[0.0; N]; N] };

    /// Adds the derivatives of a term with respect to the parameters, from its first and second derivatives
    /// with respect to `z`.
    fn push(&mut self, score: &Score<N>, first: f64, second: f64) {
        for i in 0..N {
            self.gradient[i] += first * score.row[i];
            for j in 0..N {
                self.curvature[i][j] += second * score.row[i] * score.row[j];
            }
        }
    }
}

/// Maximum of a likelihood.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Top<const N: usize> {
    pub parameters: [f64; N],
    pub shape: Shape<N>,
}

/// Newton decrement `√(gᵀ (−H)⁻¹ g)` below which the gradient `g` counts as zero; `H` is the Hessian.
const FLAT: f64 = 1e-9;

/// Maximum number of Newton steps; usually five to ten suffice.
const STEPS: usize = 200;

impl<const N: usize> Likelihood<N> {
    /// Returns the log-likelihood of one observation with its derivatives.
    pub(crate) fn term(&self, observation: &Observation<N>, weight: f64, p: &[f64; N]) -> Shape<N> {
        let mut shape = Shape::ZERO;
        match observation {
            Observation::At(score, ln_x) => {
                let z = score.at(p);
                shape.value = -weight * (0.5 * z * z + LN_ROOT_TAU + ln_x);
                shape.push(score, -weight * z, -weight);
                if let Some(k) = self.slope {
                    if p[k] <= 0.0 {
                        shape.value = f64::NEG_INFINITY;
                    } else {
                        shape.value += weight * ln(p[k]);
                        shape.gradient[k] += weight / p[k];
                        shape.curvature[k][k] -= weight / (p[k] * p[k]);
                    }
                }
            }
            Observation::Below(score) => {
                let z = score.at(p);
                let h = mills(z);
                shape.value = weight * ln_normal(z);
                shape.push(score, weight * h, -weight * h * (z + h));
            }
            Observation::Above(score) => {
                let z = score.at(p);
                let h = mills(-z);
                shape.value = weight * ln_normal(-z);
                shape.push(score, -weight * h, -weight * h * (h - z));
            }
            Observation::Between(low, high) => {
                let (a, b) = (low.at(p), high.at(p));
                let between = normal_between(a, b);
                if between <= 0.0 {
                    shape.value = f64::NEG_INFINITY;
                    return shape;
                }
                let (f, g) = (normal_density(a) / between, normal_density(b) / between);
                shape.value = weight * ln(between);
                shape.push(low, -weight * f, weight * (a * f - f * f));
                shape.push(high, weight * g, -weight * (b * g + g * g));
                for i in 0..N {
                    for j in 0..N {
                        let cross = low.row[i] * high.row[j] + high.row[i] * low.row[j];
                        shape.curvature[i][j] += weight * f * g * cross;
                    }
                }
            }
        }
        shape
    }

    /// Returns the log-likelihood of all observations with its derivatives.
    pub(crate) fn shape(&self, p: &[f64; N]) -> Shape<N> {
        let mut sum = Shape::ZERO;
        for (observation, weight) in &self.terms {
            let term = self.term(observation, *weight, p);
            sum.value += term.value;
            for i in 0..N {
                sum.gradient[i] += term.gradient[i];
                for j in 0..N {
                    sum.curvature[i][j] += term.curvature[i][j];
                }
            }
        }
        sum
    }

    /// Maximizes the likelihood from a starting point at which it is finite; returns `None` if no maximum is found.
    pub(crate) fn top(&self, start: [f64; N]) -> Option<Top<N>> {
        let mut parameters = start;
        let mut shape = self.shape(&parameters);
        for _ in 0..STEPS {
            let step = solve(negated(&shape.curvature), shape.gradient)?;
            let rise = dot(&shape.gradient, &step);
            if !rise.is_finite() {
                return None;
            }
            if rise.abs().sqrt() < FLAT {
                return Some(Top { parameters, shape });
            }
            let mut length = 1.0;
            loop {
                let mut tried = parameters;
                for i in 0..N {
                    tried[i] += length * step[i];
                }
                let there = self.shape(&tried);
                // Near the maximum the increase is lost in rounding, and the full step is accepted.
                let enough = 1e-4 * length * rise - 1e-13 * shape.value.abs();
                if there.value.is_finite() && there.value - shape.value >= enough {
                    parameters = tried;
                    shape = there;
                    break;
                }
                length *= 0.5;
                if length < 1e-12 {
                    return None;
                }
            }
        }
        None
    }
}

fn negated<const N: usize>(matrix: &[[f64; N]; N]) -> [[f64; N]; N] {
    matrix.map(|row| row.map(|value| -value))
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Solves `A x = b` for a symmetric, positive definite `A` by Cholesky factorization; returns `None` if `A`
/// is not positive definite.
pub(crate) fn solve<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> Option<[f64; N]> {
    for j in 0..N {
        for k in 0..j {
            let part = a[j][k];
            for row in a.iter_mut().skip(j) {
                row[j] -= part * row[k];
            }
        }
        if a[j][j] <= 0.0 || !a[j][j].is_finite() {
            return None;
        }
        let pivot = a[j][j].sqrt();
        for row in a.iter_mut().skip(j) {
            row[j] /= pivot;
        }
    }
    for i in 0..N {
        for k in 0..i {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    Some(b)
}

/// Returns the covariance matrix of the parameters, which is the inverse of `−H`, where `H` is the Hessian `curvature`;
/// `None` if `−H` is not positive definite.
pub(crate) fn covariance<const N: usize>(curvature: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let information = negated(curvature);
    let mut inverse = [[0.0; N]; N];
    for column in 0..N {
        let mut unit = [0.0; N];
        unit[column] = 1.0;
        let solved = solve(information, unit)?;
        for row in 0..N {
            inverse[row][column] = solved[row];
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mixed() -> Likelihood<2> {
        let score = |u: f64| Score { offset: 0.0, row: [1.0, u] };
        Likelihood {
            terms: vec![
                (Observation::At(score(0.3), 0.3), 1.0),
                (Observation::Below(score(0.7)), 2.0),
                (Observation::Above(score(-0.2)), 3.0),
                (Observation::Between(score(-0.5), score(0.4)), 1.5),
                (Observation::Between(score(2.5), score(2.9)), 0.5),
            ],
            slope: Some(1),
        }
    }

    #[test]
    fn slopes_and_curvatures_are_derivatives_of_the_value() {
        let likelihood = mixed();
        let p = [0.2, 1.3];
        let here = likelihood.shape(&p);
        let h = 1e-5;
        for i in 0..2 {
            let moved = |by: f64| {
                let mut q = p;
                q[i] += by;
                likelihood.shape(&q)
            };
            let (up, down) = (moved(h), moved(-h));
            let slope = (up.value - down.value) / (2.0 * h);
            assert!((slope - here.gradient[i]).abs() < 1e-7, "{slope}"); // measured 3e-10
            for j in 0..2 {
                let bend = (up.gradient[j] - down.gradient[j]) / (2.0 * h);
                assert!((bend - here.curvature[i][j]).abs() < 1e-7, "{bend}"); // measured 1e-9
            }
        }
    }

    #[test]
    fn the_top_is_flat_and_does_not_depend_on_the_start() {
        let likelihood = mixed();
        let one = likelihood.top([0.0, 1.0]).unwrap();
        let two = likelihood.top([-2.0, 4.0]).unwrap();
        for i in 0..2 {
            assert!((one.parameters[i] - two.parameters[i]).abs() < 1e-9);
            assert!(one.shape.gradient[i].abs() < 1e-7);
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_solution() {
        assert!(solve([[1.0, 2.0], [2.0, 1.0]], [1.0, 1.0]).is_none());
        let x = solve([[4.0, 2.0], [2.0, 3.0]], [2.0, 5.0]).unwrap();
        assert!((x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
    }
}
