//! Impact of a mass on one contact under gravity: rebound speed and duration.

use barrelstack_dynamics::{NormalLaw, math};

/// Result of one impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Rebound speed (m/s); zero if the mass does not rebound.
    pub speed: f64,
    /// Time (s) from first contact to release; zero if the mass does not rebound.
    pub duration: f64,
    /// Largest penetration (m).
    pub depth: f64,
}

/// Number of integration steps per radian of the undamped oscillation, during the approach.
const STEPS: f64 = 100.0;

/// Speed, divided by the product of penetration and natural frequency, below which the mass counts as at rest.
const CREEP: f64 = 1e-9;

/// Computes the impact of a mass, under gravity, on a contact that follows the law [`NormalLaw::SpeedGap`].
///
/// `mass` is in kg, `stiffness` in N/m, `damping` in N·s/m, `gravity` in m/s² and the impact speed `speed` in m/s.
///
/// The damper acts only during the approach, which is integrated by the classical Runge–Kutta method up to
/// the maximum penetration `x`. The rebound is elastic, so the mass leaves with the speed `√(ω² x² − 2 g x)`,
/// where `ω` is the natural frequency `√(k/m)`. If `ω² x²` is at most `2 g x`, the mass does not rebound.
///
/// ```
/// use barrelstack_calibration::impact;
/// use barrelstack_dynamics::contact::restitution;
///
/// // Without gravity, the restitution is that of the closed form.
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
    // A strong damper acts faster than the spring, so the step shrinks with the damping.
    let step = 1.0 / (STEPS * omega * (1.0 + damping / (stiffness * mass).sqrt()));
    let (mut state, mut time) = ((0.0, speed), 0.0);
    loop {
        let next = advance(state, step);
        // NaN ends the approach as well; so does creep, since under a strong damper the speed never reaches zero.
        if next.1.is_nan() || next.1 <= CREEP * omega * next.0 {
            break;
        }
        (state, time) = (next, time + step);
    }
    // The deepest point lies within the last step; bisection finds it without stepping across the kink at zero speed.
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
