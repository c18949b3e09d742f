//! Response of linear oscillators to a piecewise-linear acceleration, by an exact recursion.

use crate::error::MotionError;
use crate::math::{self, TAU};

/// Peak response of one damped oscillator, at the samples of the record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResponsePeaks {
    /// Largest relative displacement `Sd` (m).
    pub displacement: f64,
    /// Largest relative velocity `Sv` (m/s).
    pub velocity: f64,
    /// Largest absolute acceleration of the mass (m/s²).
    pub acceleration: f64,
    /// Pseudo-velocity `PSV = w Sd` (m/s), where `w` is `2π` divided by the period.
    pub pseudo_velocity: f64,
    /// Pseudo-acceleration `PSA = w² Sd` (m/s²), with the same `w`; equals PGA at period 0.
    pub pseudo_acceleration: f64,
}

/// Coefficients that advance `(u, u̇)` by one time step; exact for a load that is linear within the
/// step (Nigam and Jennings 1969, BSSA 59:909-922).
#[derive(Clone, Copy, Debug)]
pub struct Step {
    displacement: [f64; 4],
    velocity: [f64; 4],
    frequency: f64,
    damping: f64,
}

impl Step {
    /// Creates the coefficients for an oscillator of the given period (s) and damping ratio.
    pub fn new(period: f64, damping: f64, time_step: f64) -> Self {
        let w = TAU / period;
        let q = (1.0 - damping * damping).sqrt();
        let decay = math::exp(-damping * w * time_step);
        let (s, c) = math::sin_cos(w * q * time_step);
        // Impulse response h at the end of the step, its integral, and its double integral.
        let impulse = decay * s / (w * q);
        let (mut once, mut twice) = (0.0, 0.0);
        let x = w * time_step;
        if x > 0.5 {
            once = (1.0 - decay * (c + damping / q * s)) / (w * w);
            twice = (time_step - impulse - 2.0 * damping * w * once) / (w * w);
        } else {
            // For short steps, the closed forms lose digits but the power series does not. `here`
            // is the term of order k of h, which is c_k dt^k.
            let (mut before, mut here) = (0.0, time_step);
            for k in 1..24 {
                let order = f64::from(k);
                once += here * time_step / (order + 1.0);
                twice += here * time_step * time_step / ((order + 1.0) * (order + 2.0));
                let after =
                    -(2.0 * damping * x * order * here + x * x * before) / (order * (order + 1.0));
                (before, here) = (here, after);
            }
        }
        let (ramp, ramp_rate) = (twice / time_step, once / time_step);
        Self {
            displacement: [decay * (damping / q * s + c), impulse, once - ramp, ramp],
            velocity: [
                -w / q * decay * s,
                decay * (c - damping / q * s),
                impulse - ramp_rate,
                ramp_rate,
            ],
            frequency: w,
            damping,
        }
    }

    /// Returns the relative displacement and velocity one step later. `load` and `next_load` are
    /// the ground acceleration, with its sign reversed, now and one step later.
    #[inline]
    pub fn advance(&self, u: f64, v: f64, load: f64, next_load: f64) -> (f64, f64) {
        let d = &self.displacement;
        let r = &self.velocity;
        (
            d[0] * u + d[1] * v + d[2] * load + d[3] * next_load,
            r[0] * u + r[1] * v + r[2] * load + r[3] * next_load,
        )
    }

    /// Returns the absolute acceleration of the mass.
    #[inline]
    fn total(&self, u: f64, v: f64) -> f64 {
        -2.0 * self.damping * self.frequency * v - self.frequency * self.frequency * u
    }
}

/// Checks that a period (s) is zero or positive, and that a damping ratio is in `0..1`.
///
/// # Errors
/// If the period or the damping ratio is out of range.
pub fn check_oscillator(period: f64, damping: f64) -> Result<(), MotionError> {
    let real = period >= 0.0 && period.is_finite();
    MotionError::require(real, "oscillator period (s)", "0 or above", period)?;
    let swings = (0.0..1.0).contains(&damping);
    MotionError::require(swings, "damping ratio", "0 to below 1 (5 % is 0.05)", damping)
}

/// Computes the peak response of one oscillator to accelerations (m/s²) at intervals of `time_step`
/// (s).
///
/// Peaks are taken at the samples; free vibration after the record is ignored. With fewer than ten
/// steps per period, peaks between the samples are missed.
///
/// # Errors
/// If the period is negative or the damping ratio is not in `0..1`.
pub fn response(
    time_step: f64,
    acceleration: &[f64],
    period: f64,
    damping: f64,
) -> Result<ResponsePeaks, MotionError> {
    check_oscillator(period, damping)?;
    MotionError::require_positive("time step (s)", time_step)?;
    if period == 0.0 {
        let pga = math::peak(acceleration);
        return Ok(ResponsePeaks {
            acceleration: pga,
            pseudo_acceleration: pga,
            ..ResponsePeaks::default()
        });
    }
    let step = Step::new(period, damping, time_step);
    let (mut u, mut v) = (0.0_f64, 0.0_f64);
    let (mut peak_u, mut peak_v, mut peak_a) = (0.0_f64, 0.0_f64, 0.0_f64);
    for pair in acceleration.windows(2) {
        (u, v) = step.advance(u, v, -pair[0], -pair[1]);
        peak_u = peak_u.max(u.abs());
        peak_v = peak_v.max(v.abs());
        peak_a = peak_a.max(step.total(u, v).abs());
    }
    let w = TAU / period;
    Ok(ResponsePeaks {
        displacement: peak_u,
        velocity: peak_v,
        acceleration: peak_a,
        pseudo_velocity: w * peak_u,
        pseudo_acceleration: w * w * peak_u,
    })
}

/// Number of oscillators that advance in parallel, to hide the latency of the recursion.
pub const TOGETHER: usize = 8;

/// Oscillators of several periods that advance together; each result is bit-identical to that of a
/// single oscillator.
pub struct Bank {
    /// The four displacement coefficients of a [`Step`], for each oscillator.
    displacement: [[f64; TOGETHER]; 4],
    velocity: [[f64; TOGETHER]; 4],
    /// Relative displacement of each oscillator.
    pub u: [f64; TOGETHER],
    /// Relative velocity of each oscillator.
    pub v: [f64; TOGETHER],
}

impl Bank {
    /// Creates oscillators at rest. If `steps` has fewer than [`TOGETHER`] entries, the last entry
    /// is repeated.
    pub fn new(steps: &[Step]) -> Self {
        let lane = |k: usize| &steps[k.min(steps.len() - 1)];
        let of = |take: fn(&Step) -> &[f64; 4]| {
            std::array::from_fn(|c| std::array::from_fn(|k| take(lane(k))[c]))
        };
        Self {
            displacement: of(|step| &step.displacement),
            velocity: of(|step| &step.velocity),
            u: [0.0; TOGETHER],
            v: [0.0; TOGETHER],
        }
    }

    /// Advances all oscillators by one step, like [`Step::advance`].
    #[inline]
    pub fn advance(&mut self, load: f64, next: f64) {
        let (d, r) = (&self.displacement, &self.velocity);
        for k in 0..TOGETHER {
            let (u, v) = (self.u[k], self.v[k]);
            self.u[k] = d[0][k] * u + d[1][k] * v + d[2][k] * load + d[3][k] * next;
            self.v[k] = r[0][k] * u + r[1][k] * v + r[2][k] * load + r[3][k] * next;
        }
    }
}

/// Returns the larger of a peak and the magnitude of a value. The function is so simple that the
/// compiler can vectorize loops that call it.
#[inline]
pub fn larger(peak: f64, value: f64) -> f64 {
    if value.abs() > peak { value.abs() } else { peak }
}

/// Returns the pseudo-accelerations (m/s²) at periods above zero; bit-identical to those of
/// [`response`].
pub fn pseudo_accelerations(
    time_step: f64,
    acceleration: &[f64],
    periods: &[f64],
    damping: f64,
) -> Vec<f64> {
    let mut out = Vec::with_capacity(periods.len());
    for some in periods.chunks(TOGETHER) {
        let steps: Vec<Step> = some.iter().map(|t| Step::new(*t, damping, time_step)).collect();
        let mut bank = Bank::new(&steps);
        let mut peaks = [0.0_f64; TOGETHER];
        for pair in acceleration.windows(2) {
            bank.advance(-pair[0], -pair[1]);
            peaks = std::array::from_fn(|k| larger(peaks[k], bank.u[k]));
        }
        out.extend(some.iter().zip(peaks).map(|(period, peak)| {
            let w = TAU / period;
            w * w * peak
        }));
    }
    out
}

/// Peak responses at a list of periods.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseSpectrum {
    /// Damping ratio.
    pub damping: f64,
    /// Periods (s) in the order given.
    pub periods: Vec<f64>,
    /// Peak response at each period.
    pub peaks: Vec<ResponsePeaks>,
}

impl ResponseSpectrum {
    /// Computes the response spectrum of accelerations (m/s²) at intervals of `time_step` (s).
    ///
    /// # Errors
    /// The same as for [`response`].
    pub fn new(
        time_step: f64,
        acceleration: &[f64],
        periods: &[f64],
        damping: f64,
    ) -> Result<Self, MotionError> {
        let peaks = periods
            .iter()
            .map(|&period| response(time_step, acceleration, period, damping))
            .collect::<Result<_, _>>()?;
        Ok(Self { damping, periods: periods.to_vec(), peaks })
    }

    /// Returns the pseudo-accelerations (m/s²), one per period.
    pub fn pseudo_acceleration(&self) -> Vec<f64> {
        self.peaks.iter().map(|peaks| peaks.pseudo_acceleration).collect()
    }
}

/// Returns periods from 0.01 s to 10 s, logarithmically spaced, with `per_decade` periods per
/// decade.
pub fn standard_periods(per_decade: usize) -> Vec<f64> {
    math::log_space(0.01, 10.0, 3 * per_decade.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oscillators_side_by_side_have_the_bits_of_one_alone() {
        let a: Vec<f64> = (0..900).map(|k| math::sin(0.13 * f64::from(k * k % 71))).collect();
        let periods = standard_periods(7);
        let together = pseudo_accelerations(0.01, &a, &periods, 0.05);
        for (period, value) in periods.iter().zip(together) {
            let alone = response(0.01, &a, *period, 0.05).unwrap().pseudo_acceleration;
            assert_eq!(alone.to_bits(), value.to_bits(), "{period}");
        }
    }
}
