//! Transcendental functions with bit-identical results on every platform, from the pure-Rust
//! `libm`.

pub use std::f64::consts::{PI, TAU};

pub use libm::{
    atan2, cos, erf, exp, hypot, log as ln, log10, pow as powf, sin, sincos as sin_cos, tan,
};

/// Standard gravity (m/s²), used for all conversions from g.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Returns `x` to the integer power `n`, by repeated multiplication in a fixed order.
pub fn powi(x: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

/// Returns `n + 1` logarithmically spaced values from `first` to `last`.
pub fn log_space(first: f64, last: f64, n: usize) -> Vec<f64> {
    let step = ln(last / first) / n as f64;
    (0..=n).map(|i| if i == n { last } else { first * exp(step * i as f64) }).collect()
}

/// Returns the largest absolute value, or 0 for an empty slice.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()))
}

/// Subtracts the mean from the values and returns the mean.
pub fn take_mean(values: &mut [f64]) -> f64 {
    let mean = mean(values);
    for value in values {
        *value -= mean;
    }
    mean
}

/// Returns the arithmetic mean, or 0 for an empty slice.
pub fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// Integrates equally spaced values by the trapezoidal rule.
pub fn trapezoid(values: impl Iterator<Item = f64>, step: f64) -> f64 {
    let mut sum = 0.0;
    let mut previous: Option<f64> = None;
    for value in values {
        if let Some(p) = previous {
            sum += 0.5 * step * (p + value);
        }
        previous = Some(value);
    }
    sum
}

/// Interpolates linearly between points of ascending abscissa; beyond both ends the value is
/// constant.
pub fn interpolate(x: &[f64], y: &[f64], at: f64) -> f64 {
    let n = x.len().min(y.len());
    if n == 0 {
        return 0.0;
    }
    let after = x[..n].partition_point(|&value| value < at);
    if after == 0 {
        y[0]
    } else if after == n {
        y[n - 1]
    } else {
        let (x0, x1) = (x[after - 1], x[after]);
        if x1 > x0 {
            y[after - 1] + (y[after] - y[after - 1]) * (at - x0) / (x1 - x0)
        } else {
            y[after]
        }
    }
}
