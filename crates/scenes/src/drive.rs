//! Ground motions given by formulas, with exact displacement, velocity and acceleration.

use std::f64::consts::PI;

use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::{Drive, Planar, Vec2};

/// A horizontal ground motion given by a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shake {
    /// Constant velocity (m/s).
    Cruise(f64),
    /// Acceleration that grows linearly until the time `ramp` and is constant from then on.
    Ramped {
        /// Final acceleration (m/s²).
        acceleration: f64,
        /// Duration of the growth (s).
        ramp: f64,
    },
    /// Constant acceleration for a duration, then constant velocity.
    Rectangular {
        /// Acceleration during the pulse (m/s²).
        acceleration: f64,
        /// Duration of the pulse (s).
        duration: f64,
    },
    /// Acceleration `a sin ωt` for a number of half waves, then constant velocity.
    Sine {
        /// Acceleration amplitude `a` (m/s²).
        acceleration: f64,
        /// Angular frequency ω (rad/s).
        omega: f64,
        /// Number of half waves: 1 for a half-sine, 2 for one full sine.
        half_waves: f64,
    },
    /// Acceleration `a cos ωt` for one period, then rest.
    Cosine {
        /// Acceleration amplitude `a` (m/s²).
        acceleration: f64,
        /// Angular frequency ω (rad/s).
        omega: f64,
    },
    /// Acceleration `a sin ωt` for all times, with an initial velocity such that the motion oscillates about a fixed
    /// position.
    Harmonic {
        /// Acceleration amplitude `a` (m/s²).
        acceleration: f64,
        /// Angular frequency ω (rad/s).
        omega: f64,
    },
    /// Displacement `A sin ωt` for all times; the initial velocity is `A ω`.
    Swing {
        /// Displacement amplitude `A` (m).
        amplitude: f64,
        /// Angular frequency ω (rad/s).
        omega: f64,
    },
}

impl Shake {
    /// Creates a motion with a constant acceleration (m/s²) for all times.
    pub fn constant(acceleration: f64) -> Self {
        Self::Rectangular { acceleration, duration: f64::INFINITY }
    }

    /// Creates a half-sine pulse with a peak acceleration (m/s²) and a duration (s), followed by constant velocity.
    pub fn half_sine(acceleration: f64, duration: f64) -> Self {
        Self::Sine { acceleration, omega: PI / duration, half_waves: 1.0 }
    }

    /// Returns the time (s) at which the acceleration ends; infinity for a motion that never ends.
    pub fn end(&self) -> f64 {
        match *self {
            Self::Cruise(_) => 0.0,
            Self::Ramped { .. } | Self::Harmonic { .. } | Self::Swing { .. } => f64::INFINITY,
            Self::Rectangular { duration, .. } => duration,
            Self::Sine { omega, half_waves, .. } => half_waves * PI / omega,
            Self::Cosine { omega, .. } => 2.0 * PI / omega,
        }
    }

    /// Returns the acceleration (m/s²) at a time (s). At the end time, this is the acceleration just before the end.
    pub fn acceleration(&self, t: f64) -> f64 {
        if t > self.end() {
            return 0.0;
        }
        match *self {
            Self::Cruise(_) => 0.0,
            Self::Ramped { acceleration, ramp } => acceleration * (t / ramp).min(1.0),
            Self::Rectangular { acceleration, .. } => acceleration,
            Self::Sine { acceleration, omega, .. } | Self::Harmonic { acceleration, omega } => {
                acceleration * sin(omega * t)
            }
            Self::Cosine { acceleration, omega } => acceleration * cos(omega * t),
            Self::Swing { amplitude, omega } => -amplitude * omega * omega * sin(omega * t),
        }
    }

    /// Returns the displacement (m) and velocity (m/s) at a time (s).
    pub fn place(&self, t: f64) -> (f64, f64) {
        let during = t.min(self.end());
        let (x, v) = match *self {
            Self::Cruise(velocity) => return (velocity * t, velocity),
            Self::Ramped { acceleration: a, ramp } => {
                if t < ramp {
                    (a * t * t * t / (6.0 * ramp), a * t * t / (2.0 * ramp))
                } else {
                    let (start, speed, s) = (a * ramp * ramp / 6.0, 0.5 * a * ramp, t - ramp);
                    (start + speed * s + 0.5 * a * s * s, speed + a * s)
                }
            }
            Self::Rectangular { acceleration: a, .. } => (0.5 * a * during * during, a * during),
            Self::Sine { acceleration: a, omega, .. } => (
                a / omega * (during - sin(omega * during) / omega),
                a / omega * (1.0 - cos(omega * during)),
            ),
            Self::Cosine { acceleration: a, omega } => {
                (a / (omega * omega) * (1.0 - cos(omega * during)), a / omega * sin(omega * during))
            }
            Self::Harmonic { acceleration: a, omega } => {
                (-a / (omega * omega) * sin(omega * t), -a / omega * cos(omega * t))
            }
            Self::Swing { amplitude, omega } => {
                (amplitude * sin(omega * t), amplitude * omega * cos(omega * t))
            }
        };
        (x + v * (t - during), v)
    }
}

impl Drive<Planar> for Shake {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let (x, v) = self.place(time);
        (Vec2::new(x, 0.0), Vec2::new(v, 0.0))
    }
}

/// A horizontal and a vertical motion at the same time.
pub struct Both {
    /// Horizontal motion, along `x`.
    pub x: Shake,
    /// Vertical motion, along `z`.
    pub z: Shake,
}

impl Drive<Planar> for Both {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let ((x, vx), (z, vz)) = (self.x.place(time), self.z.place(time));
        (Vec2::new(x, z), Vec2::new(vx, vz))
    }
}

/// A sampled record: linear acceleration between samples, integrated exactly to velocity and displacement.
#[derive(Clone, Debug)]
pub struct Sampled {
    step: f64,
    acceleration: Vec<f64>,
    velocity: Vec<f64>,
    displacement: Vec<f64>,
}

impl Sampled {
    /// Creates a record that starts at rest, from acceleration samples (m/s²) that are a time step (s) apart.
    pub fn new(step: f64, acceleration: Vec<f64>) -> Self {
        let (mut velocity, mut displacement) = (vec![0.0], vec![0.0]);
        for (i, pair) in acceleration.windows(2).enumerate() {
            let (x, v) = advance(pair[0], pair[1], step, step, velocity[i], displacement[i]);
            displacement.push(x);
            velocity.push(v);
        }
        Self { step, acceleration, velocity, displacement }
    }

    /// Returns the duration (s) of the record.
    pub fn duration(&self) -> f64 {
        (self.acceleration.len() - 1) as f64 * self.step
    }

    /// Returns the index of the last sample at or before a time (s), and the time elapsed since that sample (s).
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "times from 0 on")]
    fn cell(&self, t: f64) -> (usize, f64) {
        let i = ((t / self.step) as usize).min(self.acceleration.len() - 2);
        (i, t - i as f64 * self.step)
    }

    /// Returns the acceleration (m/s²) at a time (s); zero after the end of the record.
    pub fn acceleration(&self, t: f64) -> f64 {
        if t > self.duration() {
            return 0.0;
        }
        let (i, s) = self.cell(t);
        self.acceleration[i] + (self.acceleration[i + 1] - self.acceleration[i]) * s / self.step
    }
}

/// Returns the displacement and velocity at the time `s` after the start of a step.
///
/// At the start of the step, the displacement is `x` and the velocity is `v`. Over the step, the acceleration changes
/// linearly from `a` to `b`.
fn advance(a: f64, b: f64, step: f64, s: f64, v: f64, x: f64) -> (f64, f64) {
    let slope = (b - a) / step;
    (x + v * s + 0.5 * a * s * s + slope * s * s * s / 6.0, v + a * s + 0.5 * slope * s * s)
}

impl Drive<Planar> for Sampled {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let during = time.min(self.duration());
        let (i, s) = self.cell(during);
        let (a, b) = (self.acceleration[i], self.acceleration[i + 1]);
        let (x, v) = advance(a, b, self.step, s, self.velocity[i], self.displacement[i]);
        (Vec2::new(x + v * (time - during), 0.0), Vec2::new(v, 0.0))
    }
}
