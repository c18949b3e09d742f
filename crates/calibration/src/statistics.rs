//! Means and regression lines, with their 95 % intervals.

use barrelstack_fragility::student_quantile;

/// Returns the mean of at least two values and half the width of its 95 % interval, by Student's t
/// distribution.
pub fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let error = (squares / (count - 1.0) / count).sqrt();
    (mean, student_quantile(0.95, values.len() - 1) * error)
}

/// Least-squares line `y = intercept + slope x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Value of `y` at `x = 0`.
    pub intercept: f64,
    /// Change of `y` per unit of `x`.
    pub slope: f64,
    /// Variance of the slope.
    pub slope_variance: f64,
    /// Variance of the fitted `y` at the mean of `x`.
    pub center_variance: f64,
    /// Mean of `x`.
    pub center: f64,
    /// Sum of squared residuals.
    pub squares: f64,
    /// Degrees of freedom: number of points minus two.
    pub freedom: usize,
}

/// Fits the least-squares line through at least three points with different `x`.
pub fn line(x: &[f64], y: &[f64]) -> Option<Line> {
    let count = x.len().min(y.len());
    if count < 3 {
        return None;
    }
    let n = count as f64;
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let spread: f64 = x.iter().map(|x| (x - mean_x) * (x - mean_x)).sum();
    if spread <= 0.0 {
        return None;
    }
    let product: f64 = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let slope = product / spread;
    let intercept = mean_y - slope * mean_x;
    let squares: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (y - intercept - slope * x) * (y - intercept - slope * x))
        .sum();
    let freedom = count - 2;
    let variance = squares / freedom as f64;
    Some(Line {
        intercept,
        slope,
        slope_variance: variance / spread,
        center_variance: variance / n,
        center: mean_x,
        squares,
        freedom,
    })
}
