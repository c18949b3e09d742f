//! Smoothing of Fourier amplitudes on a logarithmic frequency axis.

use crate::math;

/// Returns amplitudes smoothed at `centers` (Hz), with the window
///
/// ```text
/// W(f, fc) = (sin(b log10(f/fc)) / (b log10(f/fc)))⁴
/// ```
///
/// cut off where `|b log10(f/fc)|` exceeds 3 (Konno and Ohmachi 1998, BSSA 88:228-241). On a
/// logarithmic frequency axis, the window has the same width everywhere.
pub(super) fn konno_ohmachi(
    frequency: &[f64],
    amplitude: &[f64],
    centers: &[f64],
    bandwidth: f64,
) -> Vec<f64> {
    let reach = math::powf(10.0, 3.0 / bandwidth);
    centers
        .iter()
        .map(|&center| {
            let first = frequency.partition_point(|f| *f < center / reach).max(1);
            let last = frequency.partition_point(|f| *f <= center * reach);
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in first..last {
                let x = bandwidth * math::log10(frequency[k] / center);
                let w = if x.abs() < 1e-9 { 1.0 } else { math::powi(math::sin(x) / x, 4) };
                sum += w * amplitude[k];
                weights += w;
            }
            if weights > 0.0 { sum / weights } else { 0.0 }
        })
        .collect()
}
