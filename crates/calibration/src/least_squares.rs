//! Nonlinear least squares for a few parameters, by the method of Levenberg and Marquardt.
//!
//! Derivatives are central differences that are evaluated in one batch, so that simulations run in parallel.
//! There are at most four parameters, so the linear algebra is a Cholesky factorization of a matrix of at
//! most 4 × 4. A library for that would be larger than this whole crate.

/// Function that returns the residuals for each parameter set of a batch; `None` for a set for which the
/// model has no result.
pub type Evaluate<'a> = dyn Fn(&[Vec<f64>]) -> Vec<Option<Vec<f64>>> + 'a;

/// Maximum number of steps; a fit that needs more counts as not converged.
const MOST_STEPS: usize = 30;

/// Maximum change of a parameter in one step. Parameters are logarithms, or are scaled to a magnitude of
/// about 1.
const LONGEST: f64 = 0.5;

/// Result of a fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Fitted parameters.
    pub parameters: Vec<f64>,
    /// Residuals at the fitted parameters.
    pub residuals: Vec<f64>,
    /// Derivatives of the residuals: one row per parameter, one column per residual. They are taken at the
    /// fitted parameters or at most one final step away from them.
    pub slopes: Vec<Vec<f64>>,
    /// `true` for each parameter on which at least one residual depends.
    pub matters: Vec<bool>,
    /// Covariance of the parameters that matter, in the order of the parameters; `None` if they are
    /// inseparable.
    pub covariance: Option<Vec<Vec<f64>>>,
    /// Matrix `JᵀJ`, where `J` holds the derivatives with respect to the parameters that matter, in the order
    /// of the parameters.
    pub information: Vec<Vec<f64>>,
    /// Degrees of freedom: number of residuals minus number of parameters that matter.
    pub freedom: usize,
    /// `true` if the fit converged: its last step was short enough.
    pub converged: bool,
}

/// Initial values and settings of a fit.
#[derive(Clone, Debug)]
pub struct Start {
    /// Parameters at which the fit starts.
    pub parameters: Vec<f64>,
    /// Derivatives of the residuals at the start: one row per parameter, one column per residual. If this is
    /// `None`, they are computed by finite differences.
    pub slopes: Option<Vec<Vec<f64>>>,
    /// Step of the central differences.
    pub width: f64,
    /// Length of a step, relative to the standard error, below which the fit ends.
    pub share: f64,
}

/// Minimizes the sum of squared residuals.
///
/// Returns `None` if the model has no result at the start or at a point of the finite differences of any step, or if
/// the linear equations of a step cannot be solved.
pub fn fit(start: Start, evaluate: &Evaluate<'_>) -> Option<Fit> {
    let Start { mut parameters, slopes, width, share } = start;
    let mut residuals = evaluate(std::slice::from_ref(&parameters)).pop()??;
    let mut lambda = 1e-3;
    let mut converged = false;
    let mut slopes = match slopes {
        Some(slopes) => slopes,
        None => jacobian(&parameters, width, evaluate)?,
    };
    for _ in 0..MOST_STEPS {
        let normal = products(&slopes);
        let gradient: Vec<f64> = slopes.iter().map(|slope| dot(slope, &residuals)).collect();
        let cost = dot(&residuals, &residuals);
        let freedom = residuals.len().saturating_sub(parameters.len()).max(1);
        let variance = cost / freedom as f64;
        let mut better = None;
        let mut short = false;
        for _ in 0..12 {
            let step = damped_step(&normal, &gradient, lambda)?;
            // δᵀ JᵀJ δ / s² is the squared length of the step in standard errors.
            let length = quadratic(&normal, &step);
            let trial: Vec<f64> = parameters.iter().zip(&step).map(|(p, d)| p + d).collect();
            short = length <= share * share * variance || length == 0.0;
            let found = evaluate(std::slice::from_ref(&trial)).pop().flatten();
            if let Some(found) = found.filter(|found| dot(found, found) < cost) {
                better = Some((trial, found));
                lambda = (lambda * 0.1_f64).max(1e-9);
                break;
            }
            if short {
                break;
            }
            lambda = lambda.max(1e-6) * 10.0;
        }
        let moved = better.is_some();
        if let Some((trial, found)) = better {
            (parameters, residuals) = (trial, found);
        }
        if short {
            converged = true;
            break;
        }
        if !moved {
            break;
        }
        slopes = jacobian(&parameters, width, evaluate)?;
    }
    Some(finish(parameters, residuals, slopes, converged))
}

fn finish(
    parameters: Vec<f64>,
    residuals: Vec<f64>,
    slopes: Vec<Vec<f64>>,
    converged: bool,
) -> Fit {
    let matters: Vec<bool> = slopes.iter().map(|slope| dot(slope, slope) > 0.0).collect();
    let kept: Vec<Vec<f64>> =
        slopes.iter().zip(&matters).filter(|(_, m)| **m).map(|(slope, _)| slope.clone()).collect();
    let information = products(&kept);
    let freedom = residuals.len().saturating_sub(kept.len());
    let variance = dot(&residuals, &residuals) / freedom.max(1) as f64;
    let covariance = inverse(&information).map(|inverse| {
        inverse.iter().map(|row| row.iter().map(|value| value * variance).collect()).collect()
    });
    Fit { parameters, residuals, slopes, matters, covariance, information, freedom, converged }
}

/// Computes the derivatives of the residuals: one row per parameter, one column per residual. `None` if the model has
/// no result at a point of the finite differences.
fn jacobian(at: &[f64], width: f64, evaluate: &Evaluate<'_>) -> Option<Vec<Vec<f64>>> {
    let moved = |which: usize, by: f64| {
        let mut point = at.to_vec();
        point[which] += by;
        point
    };
    let points: Vec<Vec<f64>> =
        (0..at.len()).flat_map(|which| [moved(which, width), moved(which, -width)]).collect();
    let found: Option<Vec<Vec<f64>>> = evaluate(&points).into_iter().collect();
    let found = found?;
    let slope = |pair: &[Vec<f64>]| -> Vec<f64> {
        pair[0].iter().zip(&pair[1]).map(|(above, below)| (above - below) / (2.0 * width)).collect()
    };
    Some(found.chunks_exact(2).map(slope).collect())
}

/// Solves `(JᵀJ + λ diag JᵀJ) δ = −Jᵀr` for the step `δ`; parameters that affect no residual do not change.
fn damped_step(normal: &[Vec<f64>], gradient: &[f64], lambda: f64) -> Option<Vec<f64>> {
    let mut matrix = normal.to_vec();
    for (at, row) in matrix.iter_mut().enumerate() {
        row[at] = if normal[at][at] > 0.0 { row[at] * (1.0 + lambda) } else { 1.0 };
    }
    // With a tiny λ, rounding may make a singular matrix indefinite.
    let factor = cholesky(&matrix).or_else(|| {
        for (at, row) in matrix.iter_mut().enumerate() {
            row[at] *= 1.0 + 1e-6;
        }
        cholesky(&matrix)
    })?;
    let mut step = solve(&factor, &gradient.iter().map(|g| -g).collect::<Vec<_>>());
    let longest = step.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if longest > LONGEST {
        for value in &mut step {
            *value *= LONGEST / longest;
        }
    }
    Some(step)
}

fn products(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    rows.iter().map(|a| rows.iter().map(|b| dot(a, b)).collect()).collect()
}

fn quadratic(matrix: &[Vec<f64>], vector: &[f64]) -> f64 {
    matrix.iter().zip(vector).map(|(row, value)| value * dot(row, vector)).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Computes the lower Cholesky factor of a symmetric matrix; `None` unless the matrix is positive definite,
/// with a margin for rounding errors.
fn cholesky(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let mut lower = vec![vec![0.0; size]; size];
    for row in 0..size {
        for column in 0..=row {
            let rest = matrix[row][column] - dot(&lower[row][..column], &lower[column][..column]);
            if row == column {
                if rest.is_nan() || rest <= 1e-13 * matrix[row][row] {
                    return None;
                }
                lower[row][row] = rest.sqrt();
            } else {
                lower[row][column] = rest / lower[column][column];
            }
        }
    }
    Some(lower)
}

fn solve(lower: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let size = right.len();
    let mut solution = right.to_vec();
    for row in 0..size {
        let known = dot(&lower[row][..row], &solution[..row]);
        solution[row] = (solution[row] - known) / lower[row][row];
    }
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size).map(|below| lower[below][row] * solution[below]).sum();
        solution[row] = (solution[row] - known) / lower[row][row];
    }
    solution
}

fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let lower = cholesky(matrix)?;
    let unit =
        |at: usize| (0..matrix.len()).map(|i| f64::from(u8::from(i == at))).collect::<Vec<_>>();
    Some((0..matrix.len()).map(|at| solve(&lower, &unit(at))).collect())
}

/// Scales a symmetric matrix to a unit diagonal; a covariance matrix becomes a correlation matrix.
pub fn normalized(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = |at: usize| matrix[at][at].sqrt();
    let row = |i: usize| (0..matrix.len()).map(|j| matrix[i][j] / (size(i) * size(j))).collect();
    (0..matrix.len()).map(row).collect()
}

/// Returns the ratio of the largest to the smallest eigenvalue of a positive definite matrix; infinite if it is
/// singular.
///
/// The power method is applied to the matrix and to its inverse.
pub fn condition(matrix: &[Vec<f64>]) -> f64 {
    let largest = |matrix: &[Vec<f64>]| {
        let mut vector: Vec<f64> = (0..matrix.len()).map(|at| 1.0 + 0.3 * at as f64).collect();
        let mut value = 0.0;
        for _ in 0..200 {
            vector = matrix.iter().map(|row| dot(row, &vector)).collect();
            value = dot(&vector, &vector).sqrt();
            for entry in &mut vector {
                *entry /= value;
            }
        }
        value
    };
    inverse(matrix).map_or(f64::INFINITY, |inverse| largest(matrix) * largest(&inverse))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exact_curve_is_found_and_a_parameter_without_effect_stays() {
        let evaluate = |points: &[Vec<f64>]| -> Vec<Option<Vec<f64>>> {
            let residual = |p: &Vec<f64>| {
                (0..9)
                    .map(|i| {
                        p[0].exp() * (-p[1].exp() * f64::from(i) * 0.2).exp()
                            - 3.0 * (-1.5 * f64::from(i) * 0.2_f64).exp()
                    })
                    .collect()
            };
            points.iter().map(|p| Some(residual(p))).collect()
        };
        let start =
            Start { parameters: vec![0.0, 0.0, 7.0], slopes: None, width: 1e-4, share: 0.01 };
        let fit = fit(start, &evaluate).unwrap();
        assert!(fit.converged);
        assert_eq!(
            (fit.parameters[2], fit.matters.as_slice()),
            (7.0, [true, true, false].as_slice())
        );
        assert!((fit.parameters[0].exp() - 3.0).abs() < 1e-6, "{:?}", fit.parameters);
        assert!((fit.parameters[1].exp() - 1.5).abs() < 1e-6, "{:?}", fit.parameters);
    }

    #[test]
    fn the_condition_of_a_known_matrix_is_found() {
        // Eigenvalues 1 ± 0.9.
        let found = condition(&[vec![1.0, 0.9], vec![0.9, 1.0]]);
        assert!((found - 19.0).abs() < 1e-6, "{found}");
    }
}
