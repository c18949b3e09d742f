//! A sampled acceleration with its exact velocity and displacement at any time.

use crate::error::MotionError;
use crate::math;

/// Displacement, velocity and acceleration of one component at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kinematics {
    /// Displacement (m).
    pub displacement: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Acceleration (m/s²).
    pub acceleration: f64,
}

impl Kinematics {
    /// Returns the state `elapsed` seconds later, at constant velocity.
    #[must_use]
    pub fn coast(self, elapsed: f64) -> Self {
        Self {
            displacement: self.displacement + self.velocity * elapsed,
            velocity: self.velocity,
            acceleration: 0.0,
        }
    }
}

/// Equally spaced accelerations, linear between the samples, with their exact integrals:
///
/// ```text
/// v[k+1] = v[k] + dt/2 (a[k] + a[k+1])
/// d[k+1] = d[k] + dt v[k] + dt² (a[k]/3 + a[k+1]/6)
/// ```
///
/// Within a step, the velocity is quadratic and the displacement cubic. Velocity and acceleration
/// are therefore the exact derivatives of the displacement at every time. Before t = 0, all three
/// are zero. After the last sample, the acceleration is zero, the velocity is constant and the
/// displacement grows linearly.
///
/// ```
/// use barrelstack_series::sampled::Sampled;
/// let ramp = Sampled::new(0.5, vec![0.0, 1.0, 2.0])?;
/// let middle = ramp.at(0.75);
/// assert_eq!(middle.acceleration, 1.5);
/// assert_eq!(middle.velocity, 0.75 * 0.75);
/// # Ok::<(), barrelstack_series::MotionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    time_step: f64,
    acceleration: Vec<f64>,
    velocity: Vec<f64>,
    displacement: Vec<f64>,
}

impl Sampled {
    /// Integrates `acceleration` (m/s²), sampled at intervals of `time_step` (s), starting from
    /// rest at zero displacement.
    ///
    /// # Errors
    /// If the step is not above zero, there are fewer than two samples, or a sample is not finite.
    pub fn new(time_step: f64, acceleration: Vec<f64>) -> Result<Self, MotionError> {
        Self::with_initial_velocity(time_step, acceleration, 0.0)
    }

    /// Integrates like [`Sampled::new`], but from an initial velocity (m/s).
    ///
    /// Some corrected records state an initial velocity. The velocity then jumps from 0 to this
    /// value at t = 0.
    ///
    /// # Errors
    /// The same as for [`Sampled::new`], or if the velocity is not finite.
    pub fn with_initial_velocity(
        time_step: f64,
        acceleration: Vec<f64>,
        initial_velocity: f64,
    ) -> Result<Self, MotionError> {
        MotionError::require_positive("time step (s)", time_step)?;
        MotionError::require_finite("initial velocity (m/s)", initial_velocity)?;
        let count = acceleration.len();
        MotionError::require(count >= 2, "acceleration samples", "at least 2", count)?;
        if let Some(k) = acceleration.iter().position(|a| !a.is_finite()) {
            return Err(MotionError::parameter(
                format!("acceleration sample {}", k + 1),
                "a finite number",
                acceleration[k],
            ));
        }
        let (velocity, displacement) = integrate(time_step, &acceleration, initial_velocity);
        Ok(Self { time_step, acceleration, velocity, displacement })
    }

    /// Returns the time between samples (s).
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Checks that another component has the same time step.
    ///
    /// # Errors
    /// If the steps differ.
    pub fn require_step(&self, other: &Self) -> Result<(), MotionError> {
        let (one, two) = (self.time_step, other.time_step);
        if (two / one - 1.0).abs() > 1e-9 {
            let what = format!("one horizontal has a step of {one} s, the other of {two} s");
            return Err(MotionError::mismatch(what, "choose components with the same time step"));
        }
        Ok(())
    }

    /// Returns the time of the last sample (s); the first sample is at time 0.
    pub fn duration(&self) -> f64 {
        self.time_step * (self.acceleration.len() - 1) as f64
    }

    /// Returns the accelerations at the samples (m/s²).
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// Returns the velocities at the samples (m/s).
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Returns the displacements at the samples (m).
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// Returns the displacement, velocity and acceleration at time `t` (s), in constant time.
    pub fn at(&self, t: f64) -> Kinematics {
        // A NaN fails this comparison, too, and returns the state at rest.
        if !(t >= 0.0) {
            return Kinematics::default();
        }
        let last = self.acceleration.len() - 1;
        let position = t / self.time_step;
        if position >= last as f64 {
            let end = Kinematics {
                displacement: self.displacement[last],
                velocity: self.velocity[last],
                acceleration: self.acceleration[last],
            };
            let elapsed = t - self.duration();
            return if elapsed > 0.0 { end.coast(elapsed) } else { end };
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 <= position < last, checked above"
        )]
        let k = position as usize;
        let elapsed = t - k as f64 * self.time_step;
        let slope = (self.acceleration[k + 1] - self.acceleration[k]) / self.time_step;
        let a = self.acceleration[k];
        Kinematics {
            acceleration: a + slope * elapsed,
            velocity: self.velocity[k] + elapsed * (a + 0.5 * slope * elapsed),
            displacement: self.displacement[k]
                + elapsed * (self.velocity[k] + elapsed * (0.5 * a + slope * elapsed / 6.0)),
        }
    }

    /// Returns the largest absolute acceleration (m/s²). The value is exact, because the
    /// acceleration is linear between samples.
    pub fn pga(&self) -> f64 {
        math::peak(&self.acceleration)
    }

    /// Returns the largest absolute velocity at the samples (m/s). Published values are computed in the same manner.
    pub fn pgv(&self) -> f64 {
        math::peak(&self.velocity)
    }

    /// Returns the largest absolute displacement at the samples (m).
    pub fn pgd(&self) -> f64 {
        math::peak(&self.displacement)
    }

    /// Returns the largest absolute displacement (m). The displacement is integrated from the
    /// sampled velocities by the trapezoidal rule, as for published values and for the displacement
    /// files of PEER.
    ///
    /// The peak of the exact displacement, [`Sampled::pgd`], is larger: by 0.4 % if the time step is 0.02 s and the
    /// motion has a period of 0.3 s around its peak.
    pub fn pgd_by_trapezoid(&self) -> f64 {
        math::peak(&running_trapezoid(self.time_step, &self.velocity))
    }

    /// Returns the motion with all amplitudes multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.stretched(1.0, factor)
    }

    /// Returns the motion with all times multiplied by `time` and all accelerations by `factor`.
    #[must_use]
    pub fn stretched(&self, time: f64, factor: f64) -> Self {
        let times = |values: &[f64], f: f64| values.iter().map(|v| v * f).collect();
        Self {
            time_step: self.time_step * time,
            acceleration: times(&self.acceleration, factor),
            velocity: times(&self.velocity, factor * time),
            displacement: times(&self.displacement, factor * time * time),
        }
    }
}

/// Returns, for each sample, the integral of the values from the first sample to this sample, by
/// the trapezoidal rule.
pub fn running_trapezoid(time_step: f64, values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let after = values.windows(2).map(|pair| {
        sum += 0.5 * time_step * (pair[0] + pair[1]);
        sum
    });
    std::iter::once(0.0).chain(after).collect()
}

/// Integrates a piecewise-linear acceleration to the velocity and displacement at the samples.
pub fn integrate(
    time_step: f64,
    acceleration: &[f64],
    initial_velocity: f64,
) -> (Vec<f64>, Vec<f64>) {
    let mut velocity = Vec::with_capacity(acceleration.len());
    let mut displacement = Vec::with_capacity(acceleration.len());
    let (mut v, mut d) = (initial_velocity, 0.0);
    velocity.push(v);
    displacement.push(d);
    for pair in acceleration.windows(2) {
        d += time_step * v + time_step * time_step * (pair[0] / 3.0 + pair[1] / 6.0);
        v += 0.5 * time_step * (pair[0] + pair[1]);
        velocity.push(v);
        displacement.push(d);
    }
    (velocity, displacement)
}
