//! The Daubechies wavelet of fourth order, and its coefficients in a velocity history.

use std::sync::OnceLock;

use crate::fourier::{Complex, correlate, forward, inverse};

/// Length of the mother wavelet's support. At scale `s`, the support is this number times `s`.
const SUPPORT: usize = 7;
/// Number of times that the point spacing of the wavelet table is halved; the initial spacing is 1.
const LEVELS: u32 = 8;
/// Center frequency of the mother wavelet, in cycles per unit of its argument. A pulse of scale `s` has the period
/// `s/0.7143`.
const CENTER_FREQUENCY: f64 = 5.0 / 7.0;

/// The wavelet at one scale, sampled in time.
#[derive(Clone, Debug)]
pub(super) struct Wavelet {
    /// Values at the samples, with unit norm; the middle value is at the center of the wavelet.
    values: Vec<f64>,
}

/// Returns the period (s) of a pulse with the given scale (s).
pub(super) fn period(scale: f64) -> f64 {
    scale / CENTER_FREQUENCY
}

/// Returns the scale (s) of a pulse with the given period (s).
pub(super) fn scale(period: f64) -> f64 {
    period * CENTER_FREQUENCY
}

impl Wavelet {
    /// Creates the wavelet of the given scale (s), sampled at `time_step` (s).
    pub(super) fn new(scale: f64, time_step: f64) -> Self {
        let per_sample = time_step / scale;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
        let half = (0.5 * SUPPORT as f64 / per_sample).ceil() as usize;
        let middle = 0.5 * SUPPORT as f64;
        let mut values: Vec<f64> = (0..=2 * half)
            .map(|k| mother(middle + (k as f64 - half as f64) * per_sample))
            .collect();
        let norm = values.iter().map(|v| v * v).sum::<f64>().sqrt();
        for value in &mut values {
            *value /= norm;
        }
        Self { values }
    }

    fn half(&self) -> usize {
        self.values.len() / 2
    }

    /// Returns the coefficient of the wavelet, centered on sample `at`, in `series`.
    pub(super) fn coefficient(&self, series: &[f64], at: usize) -> f64 {
        let half = self.half();
        let first = half.saturating_sub(at);
        let start = at.saturating_sub(half);
        self.values[first..].iter().zip(&series[start..]).map(|(w, v)| w * v).sum()
    }

    /// Returns the Fourier transform, with `length` values, of the wavelet centered on sample 0.
    fn spectrum(&self, length: usize) -> Vec<Complex> {
        let half = self.half();
        let mut placed = vec![Complex::default(); length];
        for (k, value) in self.values.iter().enumerate() {
            placed[(k + length - half) % length].re += value;
        }
        forward(&mut placed);
        placed
    }

    /// Adds the wavelet, multiplied by `factor` and centered on sample `at`, to a series.
    pub(super) fn add_to(&self, series: &mut [f64], at: usize, factor: f64) {
        let half = self.half();
        let first = half.saturating_sub(at);
        let start = at.saturating_sub(half);
        for (w, v) in self.values[first..].iter().zip(&mut series[start..]) {
            *v += factor * w;
        }
    }

    /// Returns the autocorrelation of the wavelet at lags of 0, 1, … samples. Removing a wavelet
    /// from a series reduces the coefficients at neighboring samples in proportion to these values.
    pub(super) fn overlap(&self) -> Vec<f64> {
        let n = self.values.len();
        let length = (2 * n).next_power_of_two();
        let mut spectrum = self.spectrum(length);
        for value in &mut spectrum {
            *value = Complex { re: value.re * value.re + value.im * value.im, im: 0.0 };
        }
        inverse(&mut spectrum);
        spectrum[..n].iter().map(|value| value.re).collect()
    }
}

/// Fourier transform of two velocity histories, which are the real and the imaginary part of one series. It is computed
/// once for many wavelets.
pub(super) struct Pair {
    spectrum: Vec<Complex>,
    samples: usize,
}

impl Pair {
    /// Computes the transform. Both histories are padded with zeros such that wavelets up to the length of `largest` do
    /// not wrap around.
    pub(super) fn new(first: &[f64], second: &[f64], largest: &Wavelet) -> Self {
        let length = (first.len() + largest.half()).next_power_of_two();
        let mut spectrum: Vec<Complex> =
            first.iter().zip(second).map(|(re, im)| Complex { re: *re, im: *im }).collect();
        spectrum.resize(length, Complex::default());
        forward(&mut spectrum);
        Self { spectrum, samples: first.len() }
    }

    /// Returns the coefficients of both series for the wavelet centered on each sample.
    pub(super) fn coefficients(&self, wavelet: &Wavelet) -> Vec<(f64, f64)> {
        let kernel = wavelet.spectrum(self.spectrum.len());
        // The two series are the real and the imaginary part; a real wavelet keeps them separate.
        let both = correlate(&self.spectrum, &kernel);
        both[..self.samples].iter().map(|value| (value.re, value.im)).collect()
    }
}

/// Returns the mother wavelet at `x` from 0 to 7, interpolated linearly in its table.
fn mother(x: f64) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE.get_or_init(table);
    let place = x * f64::from(1 << LEVELS);
    if !(place >= 0.0 && place < (table.len() - 1) as f64) {
        return 0.0;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in the table")]
    let k = place.floor() as usize;
    table[k] + (table[k + 1] - table[k]) * (place - k as f64)
}

/// Filter of the scaling function, from the conditions of Daubechies (1988): orthogonal shifts,
/// four vanishing moments, minimum phase.
const FILTER: [f64; 8] = [
    0.230_377_813_308_896_5,
    0.714_846_570_552_915_6,
    0.630_880_767_929_858_9,
    -0.027_983_769_416_859_854,
    -0.187_034_811_719_093_1,
    0.030_841_381_835_560_764,
    0.032_883_011_666_885_2,
    -0.010_597_401_785_069_032,
];

/// Computes the table of the wavelet from the two-scale relation. The grid begins with the
/// integers, and its spacing is halved [`LEVELS`] times.
fn table() -> Vec<f64> {
    let root = std::f64::consts::SQRT_2;
    // At the integers, the scaling function is an eigenvector of the relation with eigenvalue 1.
    let mut scaling = vec![1.0 / SUPPORT as f64; SUPPORT + 1];
    let relation = |values: &[f64], filter: &dyn Fn(usize) -> f64, at: usize, per: usize| -> f64 {
        // `at` is the index of the point in the finer grid; `values` has `per` points per unit.
        (0..8).filter_map(|k| Some(filter(k) * values.get(at.checked_sub(k * per)?)?)).sum::<f64>()
            * root
    };
    let low = |k: usize| FILTER[k];
    for _ in 0..200 {
        let next: Vec<f64> = (0..=SUPPORT).map(|x| relation(&scaling, &low, 2 * x, 1)).collect();
        let sum: f64 = next.iter().sum();
        scaling = next.iter().map(|v| v / sum).collect();
    }
    // Each halving computes the values between the known ones.
    for level in 0..LEVELS {
        let per = 1_usize << level;
        scaling = (0..=SUPPORT * 2 * per).map(|j| relation(&scaling, &low, j, per)).collect();
    }
    let per = 1_usize << LEVELS;
    let high = |k: usize| if k.is_multiple_of(2) { FILTER[7 - k] } else { -FILTER[7 - k] };
    (0..=SUPPORT * per).map(|j| relation(&scaling, &high, 2 * j, per)).collect()
}

#[cfg(test)]
mod tests {
    use super::{Wavelet, mother, table};

    #[test]
    fn the_wavelet_has_unit_norm_and_four_vanishing_moments() {
        let table = table();
        let step = 1.0 / 256.0;
        let integral = |power: i32| -> f64 {
            let at = |k: usize| k as f64 * step;
            let terms = table.iter().enumerate().map(|(k, v)| v * at(k).powi(power));
            terms.sum::<f64>() * step
        };
        for power in 0..4 {
            // Measured: 4e-13 at most.
            assert!(integral(power).abs() < 1e-11, "moment {power}: {}", integral(power));
        }
        let norm: f64 = table.iter().map(|v| v * v).sum::<f64>() * step;
        assert!((norm - 1.0).abs() < 2e-7, "{:e}", norm - 1.0); // measured 7.8e-8
        assert_eq!(mother(-0.1), 0.0);
        assert_eq!(mother(7.5), 0.0);
    }

    #[test]
    fn what_is_added_is_found() {
        let wavelet = Wavelet::new(1.0, 0.01);
        let mut series = vec![0.0; 3000];
        wavelet.add_to(&mut series, 1200, 2.5);
        // Measured: 4e-16.
        assert!((wavelet.coefficient(&series, 1200) - 2.5).abs() < 1e-14);
        let pair = super::Pair::new(&series, &vec![0.0; 3000], &wavelet);
        let found = pair.coefficients(&wavelet);
        let overlap = wavelet.overlap();
        let off = [
            found[1200].0 - 2.5,
            found[1200].1,
            overlap[0] - 1.0,
            found[1230].0 - 2.5 * overlap[30],
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-14), "{off:?}"); // measured 8.9e-16 at most
    }
}
