//! Probability that a stack falls, as a function of its height and the unknowns, fitted to individual cases.

use barrelstack_motion::Random;

use super::cases::{FieldCase, FieldCases, UNKNOWNS};

/// Medians of the unknowns in the catalog: barrel–rack friction, rack–ground friction, stiffness of a seat (MN/m),
/// and factor on the motion.
pub const MEDIANS: [f64; UNKNOWNS] = [0.30, 0.50, 3.0, 1.0];

/// Scales of ln(u/m), where u is an unknown and m is its median ([`MEDIANS`]). In the regression, ln(u/m) is divided by
/// twice the scale of the unknown.
const UNITS: [f64; UNKNOWNS] = [0.35, 0.2, 0.6, 0.25];

/// Standard deviations of the normal priors of the coefficients: constant, linear, and all others.
const LOOSE: [f64; 3] = [5.0, 3.0, 1.0];

/// Logistic regression of second degree in the logarithms of the unknowns and in the height. For three-dimensional
/// simulations, the regression also contains the cosine and the sine of twice the azimuth.
///
/// ```text
/// ln(p / (1 − p)) = β · f(levels, u, φ)
/// ```
///
/// The coefficients maximize the posterior density under independent normal priors. The standard deviations of the
/// priors are 5 for the constant, 3 for the linear terms and 1 for all other terms, in units in which the simulated
/// range of an unknown is about ±1.3. The uncertainty of the coefficients is sampled by a Metropolis chain, whose steps
/// have the covariance of the Laplace approximation.
#[derive(Clone, Debug)]
pub struct Chance {
    /// Coefficients that maximize the posterior density.
    coefficients: Vec<f64>,
    /// Draws of the coefficients from their posterior.
    draws: Vec<Vec<f64>>,
}

/// Number of draws of the coefficients.
pub(super) const FITS: usize = 400;

/// Number of steps of the Metropolis chain from one draw to the next.
const THIN: usize = 20;

/// Values of the unknowns, and the azimuth of a stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Unknowns, in the units of [`MEDIANS`].
    pub unknowns: [f64; UNKNOWNS],
    /// Azimuth (rad).
    pub azimuth: f64,
}

/// Returns the regressors at a point, in the order of their coefficients.
fn features(levels: usize, point: &Point) -> Vec<f64> {
    let mut axes = vec![(levels as f64 - 4.0) / 1.4];
    for ((value, median), unit) in point.unknowns.iter().zip(MEDIANS).zip(UNITS) {
        axes.push(libm::log(value / median) / (2.0 * unit));
    }
    let mut all = vec![1.0];
    all.extend(&axes);
    for (at, one) in axes.iter().enumerate() {
        all.extend(axes[at..].iter().map(|other| one * other));
    }
    all.extend([libm::cos(2.0 * point.azimuth), libm::sin(2.0 * point.azimuth)]);
    all
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-x))
}

/// Returns the upper triangular factor U of a positive definite matrix Uᵀ U.
fn cholesky(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = matrix.len();
    let mut upper = vec![vec![0.0; size]; size];
    for row in 0..size {
        for column in row..size {
            let before: f64 = (0..row).map(|k| upper[k][row] * upper[k][column]).sum();
            let rest = matrix[row][column] - before;
            upper[row][column] = if row == column { rest.sqrt() } else { rest / upper[row][row] };
        }
    }
    upper
}

/// Solves U x = b.
fn back(upper: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    for row in (0..b.len()).rev() {
        let known: f64 = (row + 1..b.len()).map(|k| upper[row][k] * x[k]).sum();
        x[row] = (x[row] - known) / upper[row][row];
    }
    x
}

/// Solves Uᵀ x = b.
fn forward(upper: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    for row in 0..b.len() {
        let known: f64 = (0..row).map(|k| upper[k][row] * x[k]).sum();
        x[row] = (x[row] - known) / upper[row][row];
    }
    x
}

impl Chance {
    /// Fits the regression to the cases of a study.
    pub fn fit(cases: &FieldCases) -> Self {
        let point = |case: &FieldCase| Point {
            unknowns: case.unknowns,
            azimuth: case.azimuth.unwrap_or(std::f64::consts::FRAC_PI_4),
        };
        // A stack in a plane has no azimuth, so the terms of the azimuth are zero.
        let row = |case: &FieldCase| {
            let mut row = features(case.levels, &point(case));
            if case.azimuth.is_none() {
                let size = row.len();
                row[size - 2..].fill(0.0);
            }
            row
        };
        let rows: Vec<Vec<f64>> = cases.cases.iter().map(row).collect();
        let size = features(4, &Point { unknowns: MEDIANS, azimuth: 0.0 }).len();
        let penalty = |at: usize| {
            let loose = LOOSE[if at == 0 {
                0
            } else if at <= UNKNOWNS + 1 {
                1
            } else {
                2
            }];
            1.0 / (loose * loose)
        };
        let mut coefficients = vec![0.0; size];
        let mut factor = vec![];
        // Newton's method converges, because the density is log-concave and the prior keeps the steps short.
        for _ in 0..60 {
            let mut slope: Vec<f64> =
                coefficients.iter().enumerate().map(|(at, c)| -penalty(at) * c).collect();
            let mut information = vec![vec![0.0; size]; size];
            for (at, row) in information.iter_mut().enumerate() {
                row[at] = penalty(at);
            }
            for (row, case) in rows.iter().zip(&cases.cases) {
                let p = logistic(dot(row, &coefficients));
                let off = f64::from(u8::from(case.falls)) - p;
                for (i, x) in row.iter().enumerate() {
                    slope[i] += off * x;
                    for (k, y) in row.iter().enumerate() {
                        information[i][k] += p * (1.0 - p) * x * y;
                    }
                }
            }
            factor = cholesky(&information);
            let step = back(&factor, &forward(&factor, &slope));
            let longest = step.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let shorter = if longest > 1.0 { 1.0 / longest } else { 1.0 };
            for (c, x) in coefficients.iter_mut().zip(&step) {
                *c += shorter * x;
            }
            if longest < 1e-10 {
                break;
            }
        }
        let density = |coefficients: &[f64]| {
            let prior: f64 =
                coefficients.iter().enumerate().map(|(at, c)| -0.5 * penalty(at) * c * c).sum();
            let case = |(row, case): (&Vec<f64>, &FieldCase)| {
                let x = dot(row, coefficients);
                -libm::log1p(libm::exp(if case.falls { -x } else { x }))
            };
            prior + rows.iter().zip(&cases.cases).map(case).sum::<f64>()
        };
        let mut random = Random::new(11);
        let length = 2.4 / (size as f64).sqrt();
        let (mut at, mut here) = (coefficients.clone(), density(&coefficients));
        let mut draws = Vec::new();
        // The first draws are discarded: the chain starts at the maximum of the density, which is not typical of the
        // posterior.
        for turn in 0..THIN * (FITS + FITS / 10) {
            let normal: Vec<f64> = at.iter().map(|_| random.normal()).collect();
            let step = back(&factor, &normal);
            let next: Vec<f64> = at.iter().zip(&step).map(|(c, x)| c + length * x).collect();
            let there = density(&next);
            if libm::log(random.uniform()) < there - here {
                (at, here) = (next, there);
            }
            if turn % THIN == 0 && turn >= THIN * FITS / 10 {
                draws.push(at.clone());
            }
        }
        Self { coefficients, draws }
    }

    /// Returns the probability that a stack falls. If `draw` is a number, the coefficients come from the draw with this
    /// index, modulo the number of draws. If `draw` is `None`, the coefficients maximize the posterior density.
    pub fn of(&self, levels: usize, point: &Point, in_space: bool, draw: Option<usize>) -> f64 {
        let mut row = features(levels, point);
        if !in_space {
            let size = row.len();
            row[size - 2..].fill(0.0);
        }
        let drawn = draw.and_then(|draw| self.draws.get(draw % self.draws.len().max(1)));
        logistic(dot(&row, drawn.unwrap_or(&self.coefficients)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_recovers_the_chance_that_made_the_cases() {
        let mut random = Random::new(7);
        let truth = |levels: usize, friction: f64| {
            logistic(1.5 * (levels as f64 - 4.0) - 2.0 * libm::log(friction / 0.3))
        };
        let cases = (0..2000)
            .map(|at| {
                let levels = 2 + at % 5;
                let friction = 0.3 * libm::exp(0.5 * random.normal());
                FieldCase {
                    levels,
                    azimuth: None,
                    unknowns: [friction, 0.5, 3.0, 1.0],
                    falls: random.uniform() < truth(levels, friction),
                    mode: String::new(),
                    fallen: 0.5,
                    heading: String::new(),
                }
            })
            .collect();
        let fit = Chance::fit(&FieldCases { study: "made".into(), cases, unjudged: 0 });
        for (levels, friction) in [(3, 0.2), (4, 0.3), (5, 0.5)] {
            let point = Point { unknowns: [friction, 0.5, 3.0, 1.0], azimuth: 0.0 };
            let found = fit.of(levels, &point, false, None);
            let expected = truth(levels, friction);
            // In these cases, the largest difference is 0.02.
            assert!((found - expected).abs() < 0.05, "{levels} {friction}: {found} {expected}");
        }
    }
}
