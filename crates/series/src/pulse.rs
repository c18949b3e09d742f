//! Analytic pulses with closed forms for displacement, velocity and acceleration.

use crate::error::MotionError;
use crate::math::{self, PI, TAU};
use crate::sampled::Kinematics;

/// A motion given by a formula, starting at t = 0 from zero displacement.
///
/// Every pulse ends at [`Pulse::duration`]. Afterwards the acceleration is zero, the velocity keeps
/// its final value and the displacement grows linearly. A [`Pulse::Sine`] is the exception: its
/// velocity is zero after the end. In the formulas, `T` is the period, `w = 2π/T`, and `s` is the
/// time from the center of the pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pulse {
    /// Harmonic displacement `d = A sin(w t)` over `cycles` periods, with half-cosine ramps over
    /// the first and the last `ramp_cycles` periods.
    ///
    /// Without ramps, the velocity jumps from 0 to `A w` at t = 0, like an impact, and back to 0 at
    /// the end; the ground then keeps its last displacement.
    Sine {
        /// Displacement amplitude `A` (m).
        amplitude: f64,
        /// Period `T` (s).
        period: f64,
        /// Length in periods, including the ramps.
        cycles: f64,
        /// Length of each ramp in periods; 0 for none.
        ramp_cycles: f64,
    },
    /// Acceleration `a = A sin(π t / duration)`. The final velocity is `2 A duration/π`.
    HalfSine {
        /// Acceleration amplitude `A` (m/s²).
        acceleration: f64,
        /// Length of the half-wave (s).
        duration: f64,
    },
    /// Acceleration `a = A sin(w t)` over one period. The final velocity is zero and the final
    /// displacement is `A T²/(2π)`.
    OneSine {
        /// Acceleration amplitude `A` (m/s²).
        acceleration: f64,
        /// Period `T` (s).
        period: f64,
    },
    /// Acceleration `a = A cos(w t)` over one period. The final velocity and displacement are zero.
    OneCosine {
        /// Acceleration amplitude `A` (m/s²).
        acceleration: f64,
        /// Period `T` (s).
        period: f64,
    },
    /// Constant acceleration. The final velocity is `A duration`.
    Rectangular {
        /// Acceleration `A` (m/s²).
        acceleration: f64,
        /// Length of the pulse (s).
        duration: f64,
    },
    /// Ricker wavelet `a = A (1 - 2u) exp(-u)` with `u = (π s/T)²`, centered at `2 T` and of length
    /// `4 T`.
    ///
    /// Velocity and displacement return to zero, so the ground ends at rest in its initial position.
    Ricker {
        /// Peak acceleration `A` (m/s²).
        acceleration: f64,
        /// Period `T` of the spectral peak (s).
        period: f64,
    },
    /// Gabor wavelet `v = V exp(-(π s/(γ T))²) cos(w s + ν)`, centered at `2 γ T` and of length
    /// `4 γ T`.
    Gabor {
        /// Velocity amplitude `V` (m/s).
        velocity: f64,
        /// Period `T` (s).
        period: f64,
        /// Width `γ`, at most 12; the number of cycles grows with the width.
        gamma: f64,
        /// Phase `ν` (rad).
        phase: f64,
    },
    /// Cycloidal pulse of type A, a forward step: `v = V/2 (1 - cos w t)` over one period. The
    /// final displacement is `V T/2` (Jacobsen and Ayre 1958; Makris 1997).
    CycloidA {
        /// Peak velocity `V` (m/s).
        velocity: f64,
        /// Period `T` (s).
        period: f64,
    },
    /// Cycloidal pulse of type B, forward and back: `v = V sin(w t)` over one period. The final
    /// displacement is zero.
    CycloidB {
        /// Peak velocity `V` (m/s).
        velocity: f64,
        /// Period `T` (s).
        period: f64,
    },
    /// Cycloidal pulse of type C with `cycles` main cycles in displacement:
    /// `v = V sin(w t + φ) - V sin φ` up to `(n + 1/2 - φ/π) T` (Makris and Chang 2000).
    ///
    /// The phase `φ` is chosen so that the displacement returns to zero; the peak velocity is
    /// `V (1 + sin φ)`.
    CycloidC {
        /// Velocity amplitude `V` (m/s).
        velocity: f64,
        /// Period `T` (s).
        period: f64,
        /// Number of main cycles `n`, at least 1.
        cycles: u32,
    },
    /// Near-fault velocity pulse
    /// `v = A/2 (1 + cos(w s/γ)) cos(w s + ν)` for `|s| ≤ γ T/2`
    /// (Mavroeidis and Papageorgiou 2003, BSSA 93:1099-1131).
    MavroeidisPapageorgiou {
        /// Velocity amplitude `A` (m/s).
        velocity: f64,
        /// Prevailing period `T` (s).
        period: f64,
        /// Oscillatory character `γ`, above 1.
        gamma: f64,
        /// Phase `ν` (rad).
        phase: f64,
    },
}

/// Physical quantity in which the amplitude of a pulse is given. It determines how the amplitude
/// changes when the pulse is stretched in time.
#[derive(Clone, Copy)]
enum Amplitude {
    Displacement,
    Velocity,
    Acceleration,
}

impl Pulse {
    /// Returns the length of the pulse (s).
    pub fn duration(&self) -> f64 {
        match *self {
            Self::Sine { period, cycles, .. } => period * cycles,
            Self::HalfSine { duration, .. } | Self::Rectangular { duration, .. } => duration,
            Self::OneSine { period, .. }
            | Self::OneCosine { period, .. }
            | Self::CycloidA { period, .. }
            | Self::CycloidB { period, .. } => period,
            Self::Ricker { period, .. } => 4.0 * period,
            Self::Gabor { period, gamma, .. } => 4.0 * gamma * period,
            Self::CycloidC { period, cycles, .. } => {
                (f64::from(cycles) + 0.5 - cycloid_c_phase(cycles) / PI) * period
            }
            Self::MavroeidisPapageorgiou { period, gamma, .. } => gamma * period,
        }
    }

    fn time_scale_mut(&mut self) -> &mut f64 {
        match self {
            Self::Sine { period, .. }
            | Self::OneSine { period, .. }
            | Self::OneCosine { period, .. }
            | Self::CycloidA { period, .. }
            | Self::CycloidB { period, .. }
            | Self::CycloidC { period, .. }
            | Self::Ricker { period, .. }
            | Self::Gabor { period, .. }
            | Self::MavroeidisPapageorgiou { period, .. } => period,
            Self::HalfSine { duration, .. } | Self::Rectangular { duration, .. } => duration,
        }
    }

    /// Returns the characteristic time of the pulse (s): its period, or its length if it has no
    /// period.
    pub fn time_scale(&self) -> f64 {
        *self.clone().time_scale_mut()
    }

    /// Returns the displacement, velocity and acceleration at time `t` (s).
    pub fn at(&self, t: f64) -> Kinematics {
        if !(t >= 0.0) {
            return Kinematics::default();
        }
        let end = self.duration();
        if t <= end {
            return self.inside(t);
        }
        let last = self.inside(end);
        if matches!(self, Self::Sine { .. }) {
            Kinematics { displacement: last.displacement, ..Kinematics::default() }
        } else {
            last.coast(t - end)
        }
    }

    fn inside(&self, t: f64) -> Kinematics {
        match *self {
            Self::Sine { amplitude, period, cycles, ramp_cycles } => {
                ramped_sine(amplitude, period, cycles * period, ramp_cycles * period, t)
            }
            Self::HalfSine { acceleration, duration } => one_sine(acceleration, 2.0 * duration, t),
            Self::OneSine { acceleration, period } => one_sine(acceleration, period, t),
            Self::OneCosine { acceleration, period } => {
                let w = TAU / period;
                let (s, c) = math::sin_cos(w * t);
                Kinematics {
                    acceleration: acceleration * c,
                    velocity: acceleration / w * s,
                    displacement: acceleration / (w * w) * (1.0 - c),
                }
            }
            Self::Rectangular { acceleration, .. } => Kinematics {
                acceleration,
                velocity: acceleration * t,
                displacement: 0.5 * acceleration * t * t,
            },
            Self::Ricker { acceleration, period } => {
                let s = t - 2.0 * period;
                let b = PI / period;
                let u = b * b * s * s;
                let decay = math::exp(-u);
                Kinematics {
                    acceleration: acceleration * (1.0 - 2.0 * u) * decay,
                    velocity: acceleration * s * decay,
                    displacement: -0.5 * acceleration / (b * b) * decay,
                }
            }
            Self::Gabor { velocity, period, gamma, phase } => {
                gabor(velocity, period, gamma, phase, t)
            }
            Self::CycloidA { velocity, period } => one_sine(PI / period * velocity, period, t),
            Self::CycloidB { velocity, period } => {
                let w = TAU / period;
                let (s, c) = math::sin_cos(w * t);
                Kinematics {
                    acceleration: w * velocity * c,
                    velocity: velocity * s,
                    displacement: velocity / w * (1.0 - c),
                }
            }
            Self::CycloidC { velocity, period, cycles } => {
                let w = TAU / period;
                let (sin_phase, cos_phase) = math::sin_cos(cycloid_c_phase(cycles));
                let (sin_wt, cos_wt) = math::sin_cos(w * t);
                let s = sin_wt * cos_phase + cos_wt * sin_phase;
                let c = cos_wt * cos_phase - sin_wt * sin_phase;
                Kinematics {
                    acceleration: w * velocity * c,
                    velocity: velocity * (s - sin_phase),
                    displacement: velocity * ((cos_phase - c) / w - t * sin_phase),
                }
            }
            Self::MavroeidisPapageorgiou { velocity, period, gamma, phase } => {
                mavroeidis_papageorgiou(velocity, period, gamma, phase, t)
            }
        }
    }

    /// Returns the pulse with its amplitude multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.stretched(1.0, factor)
    }

    /// Returns the pulse with all times multiplied by `time` and all accelerations by `factor`.
    #[must_use]
    pub fn stretched(&self, time: f64, factor: f64) -> Self {
        let mut pulse = *self;
        let (amplitude, kind) = pulse.amplitude_mut();
        *amplitude *= match kind {
            Amplitude::Acceleration => factor,
            Amplitude::Velocity => factor * time,
            Amplitude::Displacement => factor * time * time,
        };
        *pulse.time_scale_mut() *= time;
        pulse
    }

    fn amplitude_mut(&mut self) -> (&mut f64, Amplitude) {
        match self {
            Self::Sine { amplitude, .. } => (amplitude, Amplitude::Displacement),
            Self::HalfSine { acceleration, .. }
            | Self::OneSine { acceleration, .. }
            | Self::OneCosine { acceleration, .. }
            | Self::Rectangular { acceleration, .. }
            | Self::Ricker { acceleration, .. } => (acceleration, Amplitude::Acceleration),
            Self::Gabor { velocity, .. }
            | Self::CycloidA { velocity, .. }
            | Self::CycloidB { velocity, .. }
            | Self::CycloidC { velocity, .. }
            | Self::MavroeidisPapageorgiou { velocity, .. } => (velocity, Amplitude::Velocity),
        }
    }

    /// Checks that every parameter is in range.
    ///
    /// # Errors
    /// If a parameter is out of range; the error names the first such parameter.
    pub fn check(&self) -> Result<(), MotionError> {
        let mut copy = *self;
        MotionError::require_finite("pulse amplitude", *copy.amplitude_mut().0)?;
        MotionError::require_positive("pulse period or duration (s)", self.time_scale())?;
        match *self {
            Self::Sine { cycles, ramp_cycles, .. } => {
                MotionError::require_positive("sine cycles", cycles)?;
                let within = ramp_cycles >= 0.0 && 2.0 * ramp_cycles <= cycles;
                let expected = format!("0 to {} (both ramps within {cycles} cycles)", 0.5 * cycles);
                MotionError::require(within, "sine ramp cycles", expected, ramp_cycles)
            }
            Self::Gabor { gamma, phase, .. } => {
                MotionError::require_finite("pulse phase (rad)", phase)?;
                let within = gamma > 0.0 && gamma <= 12.0;
                MotionError::require(within, "Gabor gamma", "above 0, up to 12", gamma)
            }
            Self::CycloidC { cycles, .. } => {
                let within = (1..=1000).contains(&cycles);
                MotionError::require(within, "cycloid cycles", "1 to 1000", cycles)
            }
            Self::MavroeidisPapageorgiou { gamma, phase, .. } => {
                MotionError::require_finite("pulse phase (rad)", phase)?;
                let within = gamma > 1.0 && gamma.is_finite();
                MotionError::require(within, "pulse gamma", "above 1", gamma)
            }
            Self::HalfSine { .. }
            | Self::OneSine { .. }
            | Self::OneCosine { .. }
            | Self::Rectangular { .. }
            | Self::Ricker { .. }
            | Self::CycloidA { .. }
            | Self::CycloidB { .. } => Ok(()),
        }
    }
}

/// Evaluates the acceleration `a = A sin(2π t/T)`, starting from rest.
fn one_sine(amplitude: f64, period: f64, t: f64) -> Kinematics {
    let w = TAU / period;
    let (s, c) = math::sin_cos(w * t);
    Kinematics {
        acceleration: amplitude * s,
        velocity: amplitude / w * (1.0 - c),
        displacement: amplitude / w * (t - s / w),
    }
}

/// Evaluates `d = A r(t) sin(w t)`, with a factor `r` that rises along a half cosine over the first
/// `ramp` seconds and falls over the last `ramp` seconds.
fn ramped_sine(amplitude: f64, period: f64, duration: f64, ramp: f64, t: f64) -> Kinematics {
    let w = TAU / period;
    let (s, c) = math::sin_cos(w * t);
    let (r, r1, r2) = if ramp > 0.0 && t < ramp {
        half_cosine(t, ramp, 1.0)
    } else if ramp > 0.0 && t > duration - ramp {
        half_cosine(duration - t, ramp, -1.0)
    } else {
        (1.0, 0.0, 0.0)
    };
    Kinematics {
        displacement: amplitude * r * s,
        velocity: amplitude * (r1 * s + r * w * c),
        acceleration: amplitude * (r2 * s + 2.0 * r1 * w * c - r * w * w * s),
    }
}

/// Evaluates `(1 - cos(π x/length))/2` with its first and second time derivative, where `dx/dt` is
/// `direction`.
fn half_cosine(x: f64, length: f64, direction: f64) -> (f64, f64, f64) {
    let w = PI / length;
    let (s, c) = math::sin_cos(w * x);
    (0.5 * (1.0 - c), direction * 0.5 * w * s, 0.5 * w * w * c)
}

/// Returns the root φ in (0, π/4) of
/// `cos((2n+1)π - φ) + ((2n+1)π - 2φ) sin φ - cos φ = 0`, that is `((2n+1)π - 2φ) tan φ = 2`.
pub fn cycloid_c_phase(cycles: u32) -> f64 {
    let turn = (2.0 * f64::from(cycles) + 1.0) * PI;
    let mut phase = 2.0 / turn;
    // Newton's method from the small-angle root. The initial error is below 0.02 and is squared in
    // each iteration.
    for _ in 0..6 {
        let tangent = math::tan(phase);
        let value = (turn - 2.0 * phase) * tangent - 2.0;
        let slope = (turn - 2.0 * phase) * (1.0 + tangent * tangent) - 2.0 * tangent;
        phase -= value / slope;
    }
    phase
}

fn mavroeidis_papageorgiou(
    velocity: f64,
    period: f64,
    gamma: f64,
    phase: f64,
    t: f64,
) -> Kinematics {
    let w = TAU / period;
    let s = t - 0.5 * gamma * period;
    let theta = w * s;
    let (sin_slow, cos_slow) = math::sin_cos(theta / gamma);
    let (sin_fast, cos_fast) = math::sin_cos(theta + phase);
    let (below, above) = ((gamma - 1.0) / gamma, (gamma + 1.0) / gamma);
    let integral = |theta: f64| {
        math::sin(theta + phase)
            + 0.5 / below * math::sin(theta * below + phase)
            + 0.5 / above * math::sin(theta * above + phase)
    };
    Kinematics {
        velocity: 0.5 * velocity * (1.0 + cos_slow) * cos_fast,
        acceleration: -0.5
            * velocity
            * w
            * (sin_slow * cos_fast / gamma + (1.0 + cos_slow) * sin_fast),
        displacement: 0.5 * velocity / w * (integral(theta) - integral(-PI * gamma)),
    }
}

/// Evaluates a Gabor wavelet. With `b = π/(γT)`:
/// `∫ exp(-b²s²) cos(ws + ν) ds = Re[e^{iν} e^{-γ²} √π/(2b) erf(bs - iγ)]`.
fn gabor(velocity: f64, period: f64, gamma: f64, phase: f64, t: f64) -> Kinematics {
    let b = PI / (gamma * period);
    let w = TAU / period;
    let s = t - 2.0 * gamma * period;
    let decay = math::exp(-b * b * s * s);
    let (sin_fast, cos_fast) = math::sin_cos(w * s + phase);
    let (sin_phase, cos_phase) = math::sin_cos(phase);
    let integral = |s: f64| {
        let (real, imaginary) = damped_erf(b * s, gamma);
        cos_phase * real - sin_phase * imaginary
    };
    let start = -2.0 * gamma * period;
    Kinematics {
        velocity: velocity * decay * cos_fast,
        acceleration: -velocity * decay * (2.0 * b * b * s * cos_fast + w * sin_fast),
        displacement: velocity * 0.5 * PI.sqrt() / b * (integral(s) - integral(start)),
    }
}

/// Returns the real and the imaginary part of `exp(-y²) erf(x - i y)` for `y > 0`. The real part is
/// odd in `x` (Abramowitz and Stegun 1964, 7.1.29).
fn damped_erf(x: f64, y: f64) -> (f64, f64) {
    let damping = math::exp(-y * y);
    let gauss = math::exp(-x * x);
    let (s, c) = math::sin_cos(2.0 * x * y);
    // These forms of (1 - cos 2xy)/(2πx) and sin(2xy)/(2πx) stay accurate as x approaches 0.
    let (first_real, first_imaginary) = if x == 0.0 {
        (0.0, y / PI)
    } else {
        let half = math::sin(x * y);
        (half * half / (PI * x), s / (TAU * x))
    };
    let mut real = damping * (math::erf(x) + gauss * first_real);
    let mut imaginary = damping * gauss * first_imaginary;
    let mut n = 1.0;
    while n <= 2.0 * y + 14.0 {
        // Evaluates exp(-n²/4 - y²) cosh(n y); adding the exponents first avoids overflow.
        let up = math::exp(-(0.5 * n - y) * (0.5 * n - y));
        let down = math::exp(-(0.5 * n + y) * (0.5 * n + y));
        let flat = math::exp(-0.25 * n * n) * damping;
        let (cosh, sinh) = (0.5 * (up + down), 0.5 * (up - down));
        let weight = 2.0 / PI * gauss / (n * n + 4.0 * x * x);
        real += weight * (2.0 * x * flat - 2.0 * x * cosh * c + n * sinh * s);
        imaginary += weight * (2.0 * x * cosh * s + n * sinh * c);
        n += 1.0;
    }
    (real, -imaginary)
}
