//! Coefficient of restitution of a contact as a function of its damping, and the inverse function.
//!
//! For a mass `m` that strikes a node of stiffness `k` and damping `c` without gravity, ζ = c / (2 √(k m)) is the
//! damping ratio, and the restitution e is the speed after the impact divided by the speed before the impact.

use crate::math;

/// Returns the damping ratio ζ = c / (2 √(k m)) from stiffness (N/m), damping (N·s/m) and mass (kg).
pub fn damping_ratio(stiffness: f64, damping: f64, mass: f64) -> f64 {
    damping / (2.0 * (stiffness * mass).sqrt())
}

/// Returns the damping (N·s/m) from stiffness (N/m), damping ratio (1) and mass (kg).
pub fn damping(stiffness: f64, damping_ratio: f64, mass: f64) -> f64 {
    2.0 * damping_ratio * (stiffness * mass).sqrt()
}

/// Returns the restitution of the speed-gap law at a damping ratio ζ ≥ 0: `e = exp(−ζ arccos ζ / √(1 − ζ²))`. For ζ >
/// 1, `arcosh ζ` replaces `arccos ζ`, and `√(ζ² − 1)` replaces `√(1 − ζ²)`.
pub fn speed_gap(damping_ratio: f64) -> f64 {
    let zeta = damping_ratio;
    let exponent = if (zeta - 1.0).abs() < 1e-7 {
        // arccos ζ / √(1−ζ²) = 1 − (ζ−1)/3 + …
        zeta * (1.0 - (zeta - 1.0) / 3.0)
    } else if zeta < 1.0 {
        zeta * math::acos(zeta) / (1.0 - zeta * zeta).sqrt()
    } else {
        zeta * math::acosh(zeta) / (zeta * zeta - 1.0).sqrt()
    };
    math::exp(-exponent)
}

/// Returns the restitution of the Kelvin–Voigt law without tension at a damping ratio ζ ≥ 0.
///
/// Contact ends when the force returns to zero, before the penetration does. For ζ < 1 this is at the time
/// `t = 2 arccos ζ / ω_d`, with the damped angular frequency `ω_d = √(k/m) √(1 − ζ²)`. So
/// `e = exp(−2 ζ arccos ζ / √(1 − ζ²))`, the square of the restitution of the speed-gap law. For ζ > 1, `arcosh ζ`
/// replaces `arccos ζ`, and `√(ζ² − 1)` replaces `√(1 − ζ²)`.
pub fn kelvin_voigt(damping_ratio: f64) -> f64 {
    let e = speed_gap(damping_ratio);
    e * e
}

/// Returns the damping ratio ζ at which the speed-gap law has a restitution `0 < e ≤ 1`.
///
/// Returns `None` for other values: no finite damping makes the rebound vanish (e → 0 only as ζ → ∞).
pub fn speed_gap_damping_ratio(restitution: f64) -> Option<f64> {
    invert(restitution, speed_gap)
}

/// Returns the damping ratio ζ at which the Kelvin–Voigt law has a restitution `0 < e ≤ 1`; `None` for other values, as
/// in [`speed_gap_damping_ratio`].
pub fn kelvin_voigt_damping_ratio(restitution: f64) -> Option<f64> {
    invert(restitution, kelvin_voigt)
}

/// Solves `law(ζ) = e` by bisection; `law` decreases monotonically from 1 at ζ = 0. Returns `None` unless `0 < e ≤ 1`.
fn invert(restitution: f64, law: impl Fn(f64) -> f64) -> Option<f64> {
    if !(restitution > 0.0 && restitution <= 1.0) {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while law(high) > restitution {
        high *= 2.0;
        if high > 1e300 {
            return None;
        }
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if law(middle) > restitution { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// Returns the restitution of the Hunt–Crossley law for an impact at `speed` (m/s) with dissipation `d` (s/m).
///
/// During the whole contact `u − ln(1 + u)`, with `u = d δ̇`, is a function of the penetration alone, so the speeds
/// before and after satisfy `u₀ − ln(1 + u₀) = −e u₀ − ln(1 − e u₀)`. The restitution depends on the speed; this is a
/// property of the law, not a numerical error.
pub fn hunt_crossley(dissipation: f64, speed: f64) -> f64 {
    let before = dissipation * speed;
    if before <= 0.0 {
        return 1.0;
    }
    let level = excess(before);
    let (mut low, mut high) = (0.0, 1.0_f64.min(1.0 / before));
    for _ in 0..200 {
        let e = 0.5 * (low + high);
        if e <= low || e >= high {
            break;
        }
        if excess(-e * before) < level { low = e } else { high = e }
    }
    0.5 * (low + high)
}

/// Returns `u − ln(1 + u)`, evaluated by a series for small `u`, where the subtraction would lose precision.
fn excess(u: f64) -> f64 {
    if u.abs() < 1e-3 {
        u * u * (1.0 / 2.0 - u * (1.0 / 3.0 - u * (1.0 / 4.0 - u * (1.0 / 5.0 - u / 6.0))))
    } else {
        u - math::log1p(u)
    }
}

/// Returns the dissipation `d` (s/m) at which the Hunt–Crossley law has a restitution `0 < e ≤ 1` for an impact at
/// `speed` (m/s); `None` for other values of the restitution.
pub fn hunt_crossley_dissipation(restitution: f64, speed: f64) -> Option<f64> {
    invert(restitution, |u| hunt_crossley(u, 1.0)).map(|u| u / speed)
}
