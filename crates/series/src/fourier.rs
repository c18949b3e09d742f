//! Discrete Fourier transform in a fixed order of operations, and the Fourier amplitude spectrum.
//!
//! The transform is a plain radix-2 implementation. Its results do not depend on the instruction
//! set, unlike those of libraries that select vector code at run time.

use crate::math::{self, TAU};

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// Returns the absolute value of the number.
    pub fn norm(self) -> f64 {
        (self.re * self.re + self.im * self.im).sqrt()
    }

    /// Returns the number multiplied by a real factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

/// Transforms in place: `X[k] = Σ x[n] exp(-2πi kn/N)`; the length must be a power of two.
pub fn forward(values: &mut [Complex]) {
    transform(values, -1.0);
}

/// Computes the inverse transform in place, including the division by the number of values.
pub fn inverse(values: &mut [Complex]) {
    transform(values, 1.0);
    let factor = 1.0 / values.len() as f64;
    for value in values {
        *value = value.times(factor);
    }
}

fn transform(values: &mut [Complex], sign: f64) {
    let n = values.len();
    assert!(n.is_power_of_two(), "the transform works on powers of two");
    let mut j = 0;
    for i in 1..n {
        let mut bit = n >> 1;
        while j & bit != 0 {
            j ^= bit;
            bit >>= 1;
        }
        j |= bit;
        if i < j {
            values.swap(i, j);
        }
    }
    // All stages use one table of twiddle factors: factor k of the stage with `size` points is
    // entry k * n/size.
    let table: Vec<Complex> = (0..n / 2)
        .map(|k| {
            let (s, c) = math::sin_cos(TAU * k as f64 / n as f64);
            Complex { re: c, im: sign * s }
        })
        .collect();
    let mut size = 2;
    while size <= n {
        let (half, stride) = (size / 2, n / size);
        for block in values.chunks_exact_mut(size) {
            let (low, high) = block.split_at_mut(half);
            for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let t = table[k * stride];
                let product =
                    Complex { re: b.re * t.re - b.im * t.im, im: b.re * t.im + b.im * t.re };
                *b = Complex { re: a.re - product.re, im: a.im - product.im };
                *a = Complex { re: a.re + product.re, im: a.im + product.im };
            }
        }
        size *= 2;
    }
}

/// Returns the correlation of two series at every shift, computed from their transforms `series`
/// and `kernel`. If the untransformed kernel is real, the real part of the result is the
/// correlation of the real part of the series, and likewise for the imaginary part.
pub fn correlate(series: &[Complex], kernel: &[Complex]) -> Vec<Complex> {
    let mut product: Vec<Complex> = series
        .iter()
        .zip(kernel)
        .map(|(a, b)| Complex { re: a.re * b.re + a.im * b.im, im: a.im * b.re - a.re * b.im })
        .collect();
    inverse(&mut product);
    product
}

/// Returns the transform of real values, padded with zeros to `length`, a power of two.
pub fn forward_real(values: &[f64], length: usize) -> Vec<Complex> {
    let mut padded: Vec<Complex> = values.iter().map(|&re| Complex { re, im: 0.0 }).collect();
    padded.resize(length, Complex::default());
    forward(&mut padded);
    padded
}

/// Multiplies the transform of a real signal by a real gain that depends on frequency (Hz). Phases
/// are preserved. `time_step` is the time between the samples of the signal (s).
pub fn apply_gain(spectrum: &mut [Complex], time_step: f64, gain: impl Fn(f64) -> f64) {
    let n = spectrum.len();
    for k in 0..=n / 2 {
        let g = gain(k as f64 / (n as f64 * time_step));
        spectrum[k] = spectrum[k].times(g);
        if k != 0 && k != n - k {
            spectrum[n - k] = spectrum[n - k].times(g);
        }
    }
}

/// Fourier amplitude spectrum of an acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierSpectrum {
    /// Frequencies (Hz), from 0 to the Nyquist frequency.
    pub frequency: Vec<f64>,
    /// Amplitudes `|∫ a exp(-2πi f t) dt|` (m/s).
    pub amplitude: Vec<f64>,
}

impl FourierSpectrum {
    /// Computes the spectrum of accelerations (m/s²) at intervals of `time_step` (s). The
    /// accelerations are padded with zeros to the next power of two.
    pub fn new(time_step: f64, acceleration: &[f64]) -> Self {
        let length = acceleration.len().max(2).next_power_of_two();
        let transform = forward_real(acceleration, length);
        let half = length / 2;
        Self {
            frequency: (0..=half).map(|k| k as f64 / (length as f64 * time_step)).collect(),
            amplitude: transform[..=half].iter().map(|x| x.norm() * time_step).collect(),
        }
    }
}
