//! Closed forms, each with where it comes from.

use super::GRAVITY;

/// Restitution under gravity of a node with a damper on approach only, and its deepest penetration.
///
/// `gravity_number` is Γ = g / (ω v₀); the penetration comes in units of v₀/ω.
/// Approach is damped motion about the sunken rest position Γ, the way out is undamped, so the
/// rebound is `e = √(x² − 2 Γ x)`; none when `x ≤ 2 Γ`: the mass stays.
pub fn rebound_under_gravity(damping_ratio: f64, gravity_number: f64) -> (Option<f64>, f64) {
    let (zeta, gamma) = (damping_ratio, gravity_number);
    let omega = (1.0 - zeta * zeta).sqrt();
    // x(0) = 0, x'(0) = 1: x = Γ + e^{−ζt} (−Γ cos ωt + B sin ωt) with B = (1 − ζΓ)/ω.
    let b = (1.0 - zeta * gamma) / omega;
    // x' = e^{−ζt} [(ζΓ + Bω) cos ωt + (Γω − ζB) sin ωt] vanishes first at
    let t = libm::atan2(zeta * gamma + b * omega, -(gamma * omega - zeta * b)) / omega;
    let (sin, cos) = (libm::sin(omega * t), libm::cos(omega * t));
    let deepest = gamma + libm::exp(-zeta * t) * (b * sin - gamma * cos);
    let square = deepest * deepest - 2.0 * gamma * deepest;
    ((square > 0.0).then(|| square.sqrt()), deepest)
}

/// ω t of a contact with a damper on approach only: a damped way in, an undamped quarter out.
pub fn contact_phase(damping_ratio: f64) -> f64 {
    let zeta = damping_ratio;
    let way_in = if (zeta - 1.0).abs() < 1e-9 {
        1.0
    } else if zeta < 1.0 {
        libm::acos(zeta) / (1.0 - zeta * zeta).sqrt()
    } else {
        libm::acosh(zeta) / (zeta * zeta - 1.0).sqrt()
    };
    way_in + std::f64::consts::FRAC_PI_2
}

/// Share of the base acceleration that a rolling body of `ratio = k²/r²` takes.
pub fn rolling_share(ratio: f64) -> f64 {
    ratio / (1.0 + ratio)
}

/// The friction coefficient from which a block of slenderness `s = b/h` rocks without sliding when its
/// base accelerates at `β g`, β > s.
pub fn least_friction_for_rocking(beta: f64, s: f64) -> f64 {
    (beta * (1.0 + 4.0 * s * s) + 3.0 * s) / (4.0 + s * s + 3.0 * beta * s)
}

/// Way (m) that a block with yield acceleration `N g` slides in a rectangular pulse `A g` of a
/// duration (s).
pub fn slide_in_rectangular_pulse(a: f64, n: f64, duration: f64) -> f64 {
    let speed = a * GRAVITY * duration;
    speed * speed / (2.0 * GRAVITY * n) * (1.0 - n / a)
}

/// The same in a half-sine pulse.
pub fn slide_in_half_sine(a: f64, n: f64, duration: f64) -> f64 {
    let omega = std::f64::consts::PI / duration;
    let start = libm::asin(n / a);
    let rest = duration - start / omega;
    let speed = a * GRAVITY / omega * (1.0 + libm::cos(start)) - n * GRAVITY * rest;
    let way = a * GRAVITY / omega * libm::cos(start) * rest
        + a * GRAVITY / (omega * omega) * libm::sin(start)
        - 0.5 * n * GRAVITY * rest * rest;
    way + speed * speed / (2.0 * n * GRAVITY)
}

/// Relative amplitude (m) of a block that slides all the while on ground that shakes with `A g sin ωt`.
pub fn steady_slide_amplitude(a: f64, n: f64, omega: f64) -> f64 {
    let share = std::f64::consts::PI * n / (2.0 * a);
    a * GRAVITY / (omega * omega) * (1.0 - share * share).sqrt()
}

/// ω (rad/s) of small rolling swings of a cylinder in a round cradle, without slip.
pub fn swing_in_cradle(cradle_radius: f64, radius: f64, ratio: f64) -> f64 {
    (GRAVITY / ((cradle_radius - radius) * (1.0 + ratio))).sqrt()
}

/// Farthest overhang (m) of `n` equal bricks of a length (m): the harmonic stack.
pub fn overhang(n: u32, length: f64) -> f64 {
    0.5 * length * (1..=n).map(|i| 1.0 / f64::from(i)).sum::<f64>()
}
