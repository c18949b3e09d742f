//! Ground motions with exact displacement and velocity.

use barrelstack_dynamics::{Drive, Planar, Vec2};

/// A ground motion along `x` given by its displacement (m) and velocity (m/s).
pub struct Along<F>(pub F);

impl<F: Fn(f64) -> (f64, f64)> Drive<Planar> for Along<F> {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let (displacement, velocity) = (self.0)(time);
        (Vec2::new(displacement, 0.0), Vec2::new(velocity, 0.0))
    }
}

/// Constant velocity (m/s).
pub fn cruise(velocity: f64) -> impl Drive<Planar> {
    Along(move |t: f64| (velocity * t, velocity))
}

/// Constant acceleration (m/s²) from rest.
pub fn constant(acceleration: f64) -> impl Drive<Planar> {
    Along(move |t: f64| (0.5 * acceleration * t * t, acceleration * t))
}

/// An acceleration (m/s²) that grows in proportion to time until `ramp` (s) and then stays.
pub fn ramped(acceleration: f64, ramp: f64) -> impl Drive<Planar> {
    Along(move |t: f64| {
        if t < ramp {
            (acceleration * t * t * t / (6.0 * ramp), acceleration * t * t / (2.0 * ramp))
        } else {
            let (start, speed, s) =
                (acceleration * ramp * ramp / 6.0, 0.5 * acceleration * ramp, t - ramp);
            (start + speed * s + 0.5 * acceleration * s * s, speed + acceleration * s)
        }
    })
}

/// A constant acceleration (m/s²) for a duration (s), then constant velocity.
pub fn rectangular_pulse(acceleration: f64, duration: f64) -> impl Drive<Planar> {
    Along(move |t: f64| {
        let during = t.min(duration);
        let velocity = acceleration * during;
        (0.5 * acceleration * during * during + velocity * (t - during), velocity)
    })
}

/// Acceleration `a sin(π t / T)` for one half-wave of duration `T` (s), then constant velocity.
pub fn half_sine_pulse(acceleration: f64, duration: f64) -> impl Drive<Planar> {
    let omega = std::f64::consts::PI / duration;
    Along(move |t: f64| {
        let during = t.min(duration);
        let velocity = acceleration / omega * (1.0 - libm::cos(omega * during));
        let way = acceleration / omega * (during - libm::sin(omega * during) / omega);
        (way + velocity * (t - during), velocity)
    })
}

/// Acceleration `a sin(ω t)` for ever, about a place that stays.
pub fn harmonic(acceleration: f64, omega: f64) -> impl Drive<Planar> {
    let amplitude = acceleration / (omega * omega);
    Along(move |t: f64| {
        (-amplitude * libm::sin(omega * t), -amplitude * omega * libm::cos(omega * t))
    })
}
