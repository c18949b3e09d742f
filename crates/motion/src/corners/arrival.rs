//! Detects the first arrival, which ends the noise before the shaking.

use crate::math;

/// Fraction of the peak acceleration; strong motion begins at the first sample that reaches it.
const SURE: f64 = 0.2;
/// Time by which each search for the arrival is extended, as a fraction of the time before the strong motion. Without
/// the extension, the first search would end at the beginning of the strong motion, and the second search at the result
/// of the first.
const BEHIND: f64 = 0.1;

/// Returns the time (s) from the first sample to the first arrival; 0 if the shaking starts with
/// the record.
///
/// The record up to its first strong motion is modeled as two intervals of constant variance. The
/// two intervals fit the record best if they meet at the arrival, where Akaike's criterion
/// `k ln var(a₁…k) + (n − k − 1) ln var(a₍k₊₁₎…n)` is smallest (Maeda 1985). A second search, which
/// ends shortly after the first result, finds a weak first arrival before a strong second one.
pub(super) fn arrival(time_step: f64, a: &[f64]) -> f64 {
    let level = math::mean(&a[..a.len().min(100)]);
    let peak = a.iter().fold(0.0_f64, |peak, a| peak.max((a - level).abs()));
    let Some(strong) = a.iter().position(|a| (a - level).abs() >= SURE * peak) else { return 0.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, small")]
    let behind = (BEHIND * strong as f64).ceil() as usize;
    let until = |end: usize| &a[..(end + behind).min(a.len())];
    let Some(first) = split(until(strong)) else { return 0.0 };
    time_step * split(until(first)).unwrap_or(first) as f64
}

/// Returns the number of samples in the first of the two intervals of constant variance that fit the samples best;
/// `None` if there are too few samples, or if all samples are equal.
fn split(a: &[f64]) -> Option<usize> {
    // The variance of fewer samples is meaningless.
    let margin = 10;
    if a.len() < 4 * margin {
        return None;
    }
    let n = a.len();
    let mean = math::mean(a);
    let mut sums = vec![(0.0, 0.0)];
    let (mut sum, mut squares) = (0.0, 0.0);
    for value in a {
        let value = value - mean;
        sum += value;
        squares += value * value;
        sums.push((sum, squares));
    }
    let variance = |from: usize, to: usize| {
        let count = (to - from) as f64;
        let mean = (sums[to].0 - sums[from].0) / count;
        // Printed digits limit the resolution of noise; an interval of equal values would have zero
        // variance.
        ((sums[to].1 - sums[from].1) / count - mean * mean).max(1e-12 * squares / n as f64)
    };
    let criterion = |k: usize| {
        k as f64 * math::ln(variance(0, k)) + (n - k - 1) as f64 * math::ln(variance(k, n))
    };
    let mut best = (margin, f64::INFINITY);
    for k in margin..n - margin {
        let value = criterion(k);
        if value < best.1 {
            best = (k, value);
        }
    }
    (squares > 0.0).then_some(best.0)
}
