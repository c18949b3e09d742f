//! Impact of a mass on one contact under gravity: rebound speed and duration.

use barrelstack_dynamics::{NormalLaw, math};

/// One impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Rebound speed (m/s); zero if the mass stays.
    pub speed: f64,
    /// Time (s) from touch to release; zero if the mass stays.
    pub duration: f64,
    /// Largest penetration (m).
    pub depth: f64,
}

/// Steps of the approach per radian of the undamped oscillation.
const STEPS: f64 = 100.0;

/// Ratio of speed to depth × frequency below which the mass is at rest.
const CREEP: f64 = 1e-9;

/// Computes the impact of `mass` (kg) on the speed-gap law of `stiffness` (N/m) and `damping` (N·s/m) at `speed`
/// (m/s) under `gravity` (m/s²).
///
/// The approach, on which the damper acts, is integrated by the classical Runge–Kutta method to the
/// deepest point `x`; the rebound is elastic, so the mass leaves at `√(ω² x² − 2 g x)`, if at all.
///
/// ```
/// use barrelstack_calibration::impact;
/// use barrelstack_dynamics::contact::restitution;
///
/// // Without gravity it has the restitution of the closed form.
/// let found = impact(100.0, 1e6, 2000.0, 0.0, 1.0);
/// let e = restitution::speed_gap(restitution::damping_ratio(1e6, 2000.0, 100.0));
/// assert!((found.speed - e).abs() < 1e-8); // measured 2e-11
/// ```
pub fn impact(mass: f64, stiffness: f64, damping: f64, gravity: f64, speed: f64) -> Impact {
    let law = NormalLaw::SpeedGap { stiffness, damping };
    let acceleration = |depth: f64, rate: f64| gravity - law.force(depth, rate).total / mass;
    let advance = |(x, v): (f64, f64), h: f64| {
        let (k1, l1) = (v, acceleration(x, v));
        let (k2, l2) = (v + 0.5 * h * l1, acceleration(x + 0.5 * h * k1, v + 0.5 * h * l1));
        let (k3, l3) = (v + 0.5 * h * l2, acceleration(x + 0.5 * h * k2, v + 0.5 * h * l2));
        let (k4, l4) = (v + h * l3, acceleration(x + h * k3, v + h * l3));
        (x + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4), v + h / 6.0 * (l1 + 2.0 * (l2 + l3) + l4))
    };
    let omega = (stiffness / mass).sqrt();
    // A strong damper is faster than the spring.
    let step = 1.0 / (STEPS * omega * (1.0 + damping / (stiffness * mass).sqrt()));
    let (mut state, mut time) = ((0.0, speed), 0.0);
    loop {
        let next = advance(state, step);
        // NaN ends the approach as well, and so does creep into a strong damper, whose speed never quite vanishes.
        if next.1.is_nan() || next.1 <= CREEP * omega * next.0 {
            break;
        }
        (state, time) = (next, time + step);
    }
    // The deepest point lies within the last step; the law's kink at zero speed is not crossed.
    let (mut low, mut high) = (0.0, step);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if advance(state, middle).1 > 0.0 { low = middle } else { high = middle }
    }
    let depth = advance(state, low).0;
    let rest = gravity / (omega * omega);
    if depth.is_nan() || depth <= 2.0 * rest {
        return Impact { speed: 0.0, duration: 0.0, depth };
    }
    let amplitude = depth - rest;
    let back = (std::f64::consts::PI - math::acos(rest / amplitude)) / omega;
    let speed = omega * (amplitude * amplitude - rest * rest).sqrt();
    Impact { speed, duration: time + low + back, depth }
}
