//! Filtered incremental velocity: the sum of the three largest increments of velocity, each over a
//! time window of 0.7 times the period of an oscillator.

use crate::math::{self, PI};

/// Length of the time window, as a fraction of the period.
const WINDOW: f64 = 0.7;
/// Corner frequency of the low-pass filter, as a fraction of the oscillator's frequency.
const CORNER: f64 = 0.85;

/// Returns FIV3 (m/s) of accelerations (m/s²) for an oscillator with the period T = `period` (s):
///
/// ```text
/// V(t) = ∫ a dt from t to t + 0.7 T,   a low-passed at 0.85/T
/// FIV3 = max(sum of the three highest positive peaks of V,
///            −(sum of the three lowest negative peaks of V))
/// ```
///
/// (Dávalos and Miranda 2019, Earthquake Engineering and Structural Dynamics 48:1300-1316).
///
/// The filter is a causal Butterworth filter of second order, applied once. The publication does
/// not specify the direction; filtering in both directions would reduce the content at the corner.
pub(crate) fn fiv3(time_step: f64, acceleration: &[f64], period: f64) -> f64 {
    let filtered = low_pass(time_step, acceleration, CORNER / period);
    let velocity = crate::sampled::running_trapezoid(time_step, &filtered);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 1")]
    let width = (WINDOW * period / time_step).round().clamp(1.0, 1e9) as usize;
    let increments: Vec<f64> =
        velocity.iter().skip(width).zip(&velocity).map(|(end, start)| end - start).collect();
    let pushes = |sign: f64| {
        let mut peaks: Vec<f64> = increments
            .windows(3)
            .map(|v| [sign * v[0], sign * v[1], sign * v[2]])
            .filter(|v| v[1] > v[0] && v[1] >= v[2] && v[1] > 0.0)
            .map(|v| v[1])
            .collect();
        peaks.sort_by(|a, b| b.total_cmp(a));
        peaks.iter().take(3).sum::<f64>()
    };
    pushes(1.0).max(pushes(-1.0))
}

/// Applies a causal second-order Butterworth low-pass filter with a corner frequency (Hz). The
/// filter is derived by the bilinear transform with prewarping. Returns the input unchanged if the
/// corner is not below the Nyquist frequency.
fn low_pass(time_step: f64, a: &[f64], corner: f64) -> Vec<f64> {
    if corner * time_step >= 0.5 {
        return a.to_vec();
    }
    let k = math::tan(PI * corner * time_step);
    let root = std::f64::consts::SQRT_2 * k;
    let norm = 1.0 / (1.0 + root + k * k);
    let (b, c1, c2) = (k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - root + k * k) * norm);
    let (mut x1, mut x2, mut y1, mut y2) = (0.0, 0.0, 0.0, 0.0);
    a.iter()
        .map(|&x| {
            let y = b * (x + 2.0 * x1 + x2) - c1 * y1 - c2 * y2;
            (x2, x1, y2, y1) = (x1, x, y1, y);
            y
        })
        .collect()
}
