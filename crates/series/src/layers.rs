//! Fast approximate response spectra: each oscillator runs at the coarsest sufficient time step.
//!
//! A search, such as spectral matching, evaluates spectra thousands of times; its result is then checked with the exact
//! recursion of [`crate::response`]. The approximate peaks differ from the exact peaks by at most 0.6 % with 20 steps
//! per period and by 0.3 % with 40.

use crate::math::{self, TAU};
use crate::response::{TOGETHER, larger};

/// Minimum number of time steps per oscillator period in every layer except the finest one.
/// Oscillators with shorter periods use a finer layer.
const LAYER_STEPS: f64 = 40.0;

/// A piecewise-linear acceleration at successively coarser time steps.
pub struct Layers {
    time_step: f64,
    /// Loads on the oscillators; one layer each for time steps of 1, 2, 4, … samples.
    ///
    /// Each load is a weighted mean of the acceleration. The weight decreases linearly from its maximum at the time of
    /// the load to zero one step before and one step after. If the impulse response of an oscillator is linear within
    /// each step, these loads give its exact response.
    layers: Vec<Vec<f64>>,
}

impl Layers {
    /// Creates the layers from accelerations (m/s²) at intervals of `time_step` (s), for
    /// oscillators with periods up to `longest` (s).
    pub fn new(time_step: f64, acceleration: &[f64], longest: f64) -> Self {
        let mut layers = vec![averaged(acceleration, 1, [4.0 / 6.0, 1.0 / 6.0])];
        let mut step = 2.0 * time_step;
        while step * LAYER_STEPS <= longest {
            let next = averaged(&layers[layers.len() - 1], 2, [0.5, 0.25]);
            layers.push(next);
            step *= 2.0;
        }
        Self { time_step, layers }
    }

    /// Computes the response of up to [`TOGETHER`] oscillators with ascending periods (s).
    ///
    /// `see` is called once per step, with the index of the sample in the motion and with the
    /// pseudo-accelerations of the oscillators (m/s²).
    #[inline]
    pub fn follow(
        &self,
        periods: &[f64],
        damping: f64,
        mut see: impl FnMut(usize, &[f64; TOGETHER]),
    ) {
        let (mut layer, mut stride) = (0, 1);
        let coarse = |stride: usize| self.time_step * stride as f64 * LAYER_STEPS;
        while layer + 1 < self.layers.len() && coarse(2 * stride) <= periods[0] {
            (layer, stride) = (layer + 1, 2 * stride);
        }
        let step = self.time_step * stride as f64;
        let shape = |k: usize| {
            let period = periods[k.min(periods.len() - 1)];
            let (w, q) = (TAU / period, (1.0 - damping * damping).sqrt());
            let (s, c) = math::sin_cos(w * q * step);
            let decay = math::exp(-damping * w * step);
            // Linear interpolation between the samples attenuates a sine at the oscillator's
            // frequency; the division by `taken` compensates for this attenuation.
            let half = 0.5 * w * step;
            let taken = math::powi(math::sin(half) / half, 2);
            [2.0 * decay * c, decay * decay, -step * decay * s * w / q / taken]
        };
        let of: [[f64; 3]; TOGETHER] = std::array::from_fn(shape);
        let [b1, b2, b3]: [[f64; TOGETHER]; 3] =
            std::array::from_fn(|c| std::array::from_fn(|k| of[k][c]));
        let (mut before, mut now) = ([0.0; TOGETHER], [0.0; TOGETHER]);
        for (i, load) in self.layers[layer].iter().enumerate() {
            see(stride * i, &now);
            for k in 0..TOGETHER {
                let next = b1[k] * now[k] - (b2[k] * before[k] - b3[k] * load);
                (before[k], now[k]) = (now[k], next);
            }
        }
    }

    /// Returns the peak pseudo-accelerations (m/s²) at ascending periods (s).
    pub fn pseudo_accelerations(&self, periods: &[f64], damping: f64) -> Vec<f64> {
        let mut out = Vec::with_capacity(periods.len());
        for some in periods.chunks(TOGETHER) {
            let mut peaks = [0.0_f64; TOGETHER];
            self.follow(some, damping, |_, now| {
                peaks = std::array::from_fn(|k| larger(peaks[k], now[k]));
            });
            out.extend(&peaks[..some.len()]);
        }
        out
    }
}

/// Returns, for every `stride`th value, the weighted sum of the value (weight `own`) and its two
/// neighbors (weight `beside` each).
fn averaged(values: &[f64], stride: usize, [own, beside]: [f64; 2]) -> Vec<f64> {
    let n = values.len();
    let one = |k: usize| {
        let left = if k == 0 { 0.0 } else { values[k - 1] };
        let right = if k + 1 < n { values[k + 1] } else { 0.0 };
        own * values[k] + beside * (left + right)
    };
    (0..n).step_by(stride).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::response::pseudo_accelerations;

    #[test]
    fn peaks_are_those_of_the_exact_recursion_as_nearly_as_they_are_stated() {
        let mut random = Random::new(4);
        let mut last = 0.0;
        let noise = |k: u32| {
            last = 0.9 * last + random.normal();
            last * math::exp(-f64::from(k) / 1500.0)
        };
        let a: Vec<f64> = (0..6000).map(noise).collect();
        let periods = math::log_space(0.1, 5.0, 300);
        let ours = Layers::new(0.005, &a, 5.0).pseudo_accelerations(&periods, 0.05);
        let exact = pseudo_accelerations(0.005, &a, &periods, 0.05);
        let worst = ours.iter().zip(&exact).map(|(o, e)| (o / e - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.006, "{worst}"); // measured 0.0042
    }
}
