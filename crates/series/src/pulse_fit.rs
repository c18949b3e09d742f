//! Fits the dominant velocity pulse of a motion: period, amplitude, position and share of the
//! energy.

use crate::error::MotionError;
use crate::fourier::{Complex, correlate, forward_real};
use crate::history::History;
use crate::math::{self, TAU};
use crate::pulse::Pulse;
use crate::sampled::Sampled;

/// A velocity pulse of Mavroeidis and Papageorgiou, fitted to a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseFit {
    /// The pulse. Its time is counted from [`PulseFit::start`].
    pub pulse: Pulse,
    /// Prevailing period (s).
    pub period: f64,
    /// Velocity amplitude `A` of the formula (m/s). The amplitude exceeds the peak velocity if the
    /// phase is not zero.
    pub amplitude: f64,
    /// Largest velocity of the pulse (m/s).
    pub peak_velocity: f64,
    /// Time in the record at which the pulse starts (s); negative if the pulse starts before the record.
    pub start: f64,
    /// Share of the energy (the sum of the squared velocities) that the pulse explains, 0 to 1.
    ///
    /// For pulse-like near-fault records, the share is above about one half.
    pub energy_share: f64,
}

/// Trial values of the width `γ`. Below 1 the pulse has no zero crossing; above 3 it is a wave
/// train.
const WIDTHS: [f64; 5] = [1.05, 1.5, 2.0, 2.5, 3.0];
/// Number of trial periods in a range of periods that spans a factor of e.
const PER_E_FOLD: f64 = 14.0;

/// Finds the pulse with a period from `shortest` to `longest` (s) that explains the largest share
/// of the energy, as defined for [`PulseFit::energy_share`].
///
/// All combinations of shift, period and width on a grid are compared by correlation with the sine
/// and cosine forms of the pulse. The best combination is refined by coordinate search.
///
/// # Errors
/// If the range of periods is empty, the shortest period is below eight time steps, or the velocity is
/// zero throughout.
pub fn dominant_pulse(
    motion: &Sampled,
    shortest: f64,
    longest: f64,
) -> Result<PulseFit, MotionError> {
    MotionError::require_positive("shortest pulse period (s)", shortest)?;
    let longer = longest > shortest && longest.is_finite();
    let expected = format!("above the shortest, {shortest} s");
    MotionError::require(longer, "longest pulse period (s)", expected, longest)?;
    let least = 8.0 * motion.time_step();
    let expected = format!("at least eight steps, {least} s");
    MotionError::require(shortest >= least, "shortest pulse period (s)", expected, shortest)?;
    // For the correlation, a time step of 1/16 of the shortest period is fine enough.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 1")]
    let every = (shortest / 16.0 / motion.time_step()).floor().max(1.0) as usize;
    let dt = motion.time_step() * every as f64;
    let velocity: Vec<f64> = motion.velocity().iter().copied().step_by(every).collect();
    let energy: f64 = velocity.iter().map(|v| v * v).sum();
    MotionError::require(energy > 0.0, "motion", "a velocity other than zero", "zero")?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let longest_support = (WIDTHS[WIDTHS.len() - 1] * longest / dt).ceil().min(1e8) as usize;
    let length = (velocity.len() + 2 * longest_support).next_power_of_two();
    let spectrum = forward_real(&velocity, length);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let count = (PER_E_FOLD * math::ln(longest / shortest)).ceil().clamp(1.0, 1e4) as usize;
    let mut best = Fit { period: shortest, gamma: WIDTHS[0], center: 0.0, explained: 0.0 };
    for period in math::log_space(shortest, longest, count) {
        for gamma in WIDTHS {
            let (center, explained) = best_shift(&spectrum, dt, velocity.len(), period, gamma);
            if explained > best.explained {
                best = Fit { period, gamma, center, explained };
            }
        }
    }
    let best = refine(&velocity, dt, best, shortest, longest);
    let projection = project(&velocity, dt, &best);
    let amplitude = math::hypot(projection.even, projection.odd);
    let phase = math::atan2(-projection.odd, projection.even);
    let pulse = Pulse::MavroeidisPapageorgiou {
        velocity: amplitude,
        period: best.period,
        gamma: best.gamma,
        phase,
    };
    Ok(PulseFit {
        pulse,
        peak_velocity: History::Analytic(pulse).pgv(),
        period: best.period,
        amplitude,
        start: best.center - 0.5 * best.gamma * best.period,
        energy_share: projection.explained / energy,
    })
}

#[derive(Clone, Copy)]
struct Fit {
    period: f64,
    gamma: f64,
    center: f64,
    explained: f64,
}

/// Returns the cosine and the sine form of the pulse at time `s` (s) from its center.
fn quadratures(period: f64, gamma: f64, s: f64) -> (f64, f64) {
    if s.abs() > 0.5 * gamma * period {
        return (0.0, 0.0);
    }
    let theta = TAU * s / period;
    let window = 0.5 * (1.0 + math::cos(theta / gamma));
    let (sin, cos) = math::sin_cos(theta);
    (window * cos, window * sin)
}

/// Shifts the pulse to the center time at which it explains the largest sum of squared velocities. Returns this time
/// (s) and this sum. The motion is correlated with the cosine form and with the sine form of the pulse.
fn best_shift(
    spectrum: &[Complex],
    dt: f64,
    samples: usize,
    period: f64,
    gamma: f64,
) -> (f64, f64) {
    let length = spectrum.len();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the pads")]
    let half = (0.5 * gamma * period / dt).floor() as usize;
    let (mut even, mut odd) = (vec![0.0; length], vec![0.0; length]);
    let (mut even_norm, mut odd_norm) = (0.0, 0.0);
    for k in 0..=2 * half {
        let s = (k as f64 - half as f64) * dt;
        let (e, o) = quadratures(period, gamma, s);
        let at = (k + length - half) % length;
        even[at] = e;
        odd[at] = o;
        even_norm += e * e;
        odd_norm += o * o;
    }
    let with = |series: &[f64]| correlate(spectrum, &forward_real(series, length));
    let (even, odd) = (with(&even), with(&odd));
    let mut best = (0.0, 0.0);
    for k in 0..samples {
        let explained = even[k].re * even[k].re / even_norm + odd[k].re * odd[k].re / odd_norm;
        if explained > best.1 {
            best = (k as f64 * dt, explained);
        }
    }
    best
}

struct Projection {
    even: f64,
    odd: f64,
    explained: f64,
}

/// Computes the least-squares amplitudes of the cosine and sine forms of a trial pulse, and the sum
/// of squared velocities that they explain. The forms are evaluated at the times of the samples.
fn project(velocity: &[f64], dt: f64, trial: &Fit) -> Projection {
    let Fit { period, gamma, center, .. } = *trial;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let index = |t: f64| (t / dt).clamp(0.0, velocity.len() as f64) as usize;
    let (first, last) = (
        index(center - 0.5 * gamma * period),
        index(center + 0.5 * gamma * period + dt).min(velocity.len()),
    );
    let (mut ee, mut oo, mut eo, mut ve, mut vo) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (k, v) in velocity.iter().enumerate().take(last).skip(first) {
        let (e, o) = quadratures(period, gamma, k as f64 * dt - center);
        ee += e * e;
        oo += o * o;
        eo += e * o;
        ve += v * e;
        vo += v * o;
    }
    let determinant = ee * oo - eo * eo;
    if !(determinant > 1e-12 * ee * oo) {
        return Projection { even: 0.0, odd: 0.0, explained: 0.0 };
    }
    let even = (ve * oo - vo * eo) / determinant;
    let odd = (vo * ee - ve * eo) / determinant;
    Projection { even, odd, explained: even * ve + odd * vo }
}

/// Refines the period, the width and the center time of the pulse by coordinate search with decreasing steps.
fn refine(velocity: &[f64], dt: f64, start: Fit, shortest: f64, longest: f64) -> Fit {
    let mut best = start;
    best.explained = project(velocity, dt, &best).explained;
    let mut size = 0.05;
    while size > 1e-4 {
        let mut improved = false;
        for (dp, dg, dc) in [
            (size, 0.0, 0.0),
            (-size, 0.0, 0.0),
            (0.0, size, 0.0),
            (0.0, -size, 0.0),
            (0.0, 0.0, size),
            (0.0, 0.0, -size),
        ] {
            let mut next = Fit {
                period: (best.period * (1.0 + dp)).clamp(shortest, longest),
                gamma: (best.gamma * (1.0 + dg)).clamp(WIDTHS[0], WIDTHS[WIDTHS.len() - 1]),
                center: best.center + dc * best.period,
                explained: 0.0,
            };
            next.explained = project(velocity, dt, &next).explained;
            if next.explained > best.explained * (1.0 + 1e-12) {
                best = next;
                improved = true;
            }
        }
        if !improved {
            size *= 0.5;
        }
    }
    best
}
