//! Motion of one component as a function of time: sampled, analytic, or a sum of several histories.

use crate::error::MotionError;
use crate::pulse::Pulse;
use crate::sampled::{Kinematics, Sampled};

/// Displacement, velocity and acceleration of one component as functions of time.
///
/// Velocity and acceleration are the exact derivatives of the displacement. Before t = 0, all three
/// are zero. After [`History::duration`], the acceleration is zero, the velocity is constant and
/// the displacement grows linearly.
#[derive(Clone, Debug, PartialEq)]
pub enum History {
    /// Accelerations at equal time steps, linear between the samples.
    Sampled(Sampled),
    /// A closed-form pulse.
    Analytic(Pulse),
    /// Sum of several histories, each with its own delay.
    Sum(Vec<Delayed>),
}

/// A history that starts after a delay.
#[derive(Clone, Debug, PartialEq)]
pub struct Delayed {
    /// Time (s) at which the history starts; not negative.
    pub delay: f64,
    /// The history; its time is counted from its own start.
    pub history: History,
}

impl History {
    /// Returns the displacement, velocity and acceleration at time `t` (s).
    pub fn at(&self, t: f64) -> Kinematics {
        match self {
            Self::Sampled(sampled) => sampled.at(t),
            Self::Analytic(pulse) => pulse.at(t),
            Self::Sum(parts) => parts.iter().fold(Kinematics::default(), |sum, part| {
                let k = part.history.at(t - part.delay);
                Kinematics {
                    displacement: sum.displacement + k.displacement,
                    velocity: sum.velocity + k.velocity,
                    acceleration: sum.acceleration + k.acceleration,
                }
            }),
        }
    }

    /// Returns the time (s) after which the acceleration is zero.
    pub fn duration(&self) -> f64 {
        match self {
            Self::Sampled(sampled) => sampled.duration(),
            Self::Analytic(pulse) => pulse.duration(),
            Self::Sum(parts) => {
                parts.iter().fold(0.0_f64, |end, p| end.max(p.delay + p.history.duration()))
            }
        }
    }

    /// Returns the history with all amplitudes multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.stretched(1.0, factor)
    }

    /// Returns the history for a model whose lengths are multiplied by `length_scale` under the
    /// same gravity (Froude scaling). Time is multiplied by `√length_scale` and displacement by
    /// `length_scale`; acceleration is unchanged.
    #[must_use]
    pub fn froude(&self, length_scale: f64) -> Self {
        self.stretched(length_scale.sqrt(), 1.0)
    }

    fn stretched(&self, time: f64, factor: f64) -> Self {
        match self {
            Self::Sampled(sampled) => Self::Sampled(sampled.stretched(time, factor)),
            Self::Analytic(pulse) => Self::Analytic(pulse.stretched(time, factor)),
            Self::Sum(parts) => Self::Sum(
                parts
                    .iter()
                    .map(|part| Delayed {
                        delay: part.delay * time,
                        history: part.history.stretched(time, factor),
                    })
                    .collect(),
            ),
        }
    }

    /// Returns the time step (s) at which samples represent this history well: the time step of a
    /// sampled history, 1/400 of [`Pulse::time_scale`] for a pulse, or the smallest such step among
    /// the parts of a sum.
    pub fn natural_step(&self) -> f64 {
        match self {
            Self::Sampled(sampled) => sampled.time_step(),
            Self::Analytic(pulse) => pulse.time_scale() / 400.0,
            Self::Sum(parts) => parts
                .iter()
                .map(|part| part.history.natural_step())
                .fold(f64::INFINITY, f64::min)
                .min(self.duration()),
        }
    }

    /// Samples the accelerations at equal steps of at most `time_step` (s) and integrates them.
    ///
    /// A sampled history that already has this step is returned unchanged. Otherwise, the step is
    /// reduced, if necessary, so that the last sample is at the end of the history.
    ///
    /// # Errors
    /// If the step is not above zero or would require more than 100 million samples.
    pub fn sampled(&self, time_step: f64) -> Result<Sampled, MotionError> {
        MotionError::require_positive("time step (s)", time_step)?;
        if let Self::Sampled(sampled) = self
            && sampled.time_step() == time_step
        {
            return Ok(sampled.clone());
        }
        let duration = self.duration();
        let steps = (duration / time_step * (1.0 - 1e-12)).ceil();
        let expected = format!("at least {:e} for a motion of {duration} s", duration / 1e8);
        MotionError::require(steps <= 1e8, "time step (s)", expected, time_step)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e8")]
        let n = (steps as usize).max(1);
        let even = duration / n as f64;
        let acceleration = (0..=n).map(|k| self.at(k as f64 * even).acceleration).collect();
        Sampled::with_initial_velocity(even, acceleration, self.at(0.0).velocity)
    }

    /// Returns a time (s) from which the absolute acceleration does not exceed a limit (m/s²).
    ///
    /// For a sampled history, this is the time of the sample that follows the last sample above the limit. For an
    /// analytic history, this is the end of the history, because the shaking stops abruptly. For a sum of `n`
    /// histories, this is the latest of the times of its parts, each computed for the limit divided by `n`.
    pub fn calm_from(&self, limit: f64) -> f64 {
        match self {
            Self::Sampled(sampled) => {
                let last = sampled.acceleration().iter().rposition(|a| a.abs() > limit);
                last.map_or(0.0, |last| (last + 1) as f64 * sampled.time_step())
                    .min(self.duration())
            }
            Self::Analytic(_) => self.duration(),
            Self::Sum(parts) => {
                let share = limit / parts.len() as f64;
                parts.iter().map(|p| p.delay + p.history.calm_from(share)).fold(0.0, f64::max)
            }
        }
    }

    /// Returns the largest absolute acceleration (m/s²).
    pub fn pga(&self) -> f64 {
        self.peak(Sampled::pga, |k| k.acceleration)
    }

    /// Returns the largest absolute velocity (m/s). A sampled history is evaluated at its samples.
    pub fn pgv(&self) -> f64 {
        self.peak(Sampled::pgv, |k| k.velocity)
    }

    /// Returns the largest absolute displacement (m) up to the end of shaking. A sampled history is
    /// evaluated at its samples.
    pub fn pgd(&self) -> f64 {
        self.peak(Sampled::pgd, |k| k.displacement)
    }

    /// Returns the peak of a quantity. For a sampled history, `sampled` computes the peak. Other
    /// histories are scanned at the natural step, and every local extremum is refined by
    /// golden-section search.
    fn peak(&self, sampled: fn(&Sampled) -> f64, quantity: fn(Kinematics) -> f64) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        if let Self::Sampled(samples) = self {
            return sampled(samples);
        }
        let duration = self.duration();
        let step = self.natural_step();
        if !(step > 0.0 && duration / step <= 1e8) {
            return f64::NAN;
        }
        let value = |t: f64| quantity(self.at(t.clamp(0.0, duration))).abs();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e8")]
        let n = (duration / step).ceil() as usize;
        let (mut best, mut before, mut here) = (value(0.0), value(0.0), value(step));
        for k in 1..=n {
            let after = value((k + 1) as f64 * step);
            best = best.max(here);
            if here >= before && here >= after {
                let (mut low, mut high) = ((k - 1) as f64 * step, (k + 1) as f64 * step);
                for _ in 0..60 {
                    let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
                    if value(left) > value(right) {
                        high = right;
                    } else {
                        low = left;
                    }
                }
                best = best.max(value(0.5 * (low + high)));
            }
            before = here;
            here = after;
        }
        best
    }
}
