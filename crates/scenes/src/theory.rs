//! Closed-form solutions for rocking, overturning, sliding, impact, rolling and stacking, each with its source.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use barrelstack_dynamics::math::{acos, acosh, atan, atan2, cos, exp, sin};

use crate::GRAVITY;

/// Returns the rocking frequency parameter p = √(3g/4R) (rad/s) of a rectangle with half-diagonal R (m) (Housner
/// 1963).
pub fn rocking_rate(radius: f64) -> f64 {
    (0.75 * GRAVITY / radius).sqrt()
}

/// Returns the coefficient of restitution η = 1 − (3/2) sin² α of a rocking rectangle of slenderness angle α (rad).
///
/// Angular momentum about the new corner is conserved (Housner 1963).
pub fn housner_restitution(alpha: f64) -> f64 {
    1.0 - 1.5 * sin(alpha) * sin(alpha)
}

/// Returns the time in which a rocking rectangle returns to upright from rest at the rotation `share · α`, multiplied
/// by the frequency parameter p.
///
/// `alpha` is the slenderness angle α (rad) of the rectangle. The result is exact for any α. Conservation of
/// energy gives θ'²/2p² = cos(α − θ₀) − cos(α − θ). The substitution θ = θ₀ (1 − s²) removes the square root from the
/// integrand, which is then integrated by the midpoint rule.
pub fn quarter_period(alpha: f64, share: f64) -> f64 {
    let start = share * alpha;
    let parts = 20_000;
    (0..parts)
        .map(|i| {
            let s = (f64::from(i) + 0.5) / f64::from(parts);
            let theta = start * (1.0 - s * s);
            // The difference of the cosines as a product, which avoids cancellation.
            let fall = 2.0 * sin(alpha - 0.5 * (start + theta)) * sin(0.5 * (start - theta));
            2.0 * start * s / (2.0 * fall).sqrt() / f64::from(parts)
        })
        .sum()
}

/// Returns the quarter period of a slender block that starts at rest from φ = θ₀/α, multiplied by the frequency
/// parameter p: arcosh[1/(1 − φ)] (Housner 1963).
pub fn slender_quarter_period(share: f64) -> f64 {
    acosh(1.0 / (1.0 - share))
}

/// Returns the peak rotation of a rocking rectangle after an impact that keeps the fraction `ratio` = η² of the energy,
/// divided by the slenderness angle α (rad).
///
/// The rectangle starts at rest from the rotation `share · α`; the result is exact for any α.
pub fn next_peak(alpha: f64, share: f64, ratio: f64) -> f64 {
    // The impact reduces cos(α − θ) − cos α by the ratio; half angles avoid cancellation.
    let height = |theta: f64| 2.0 * sin(alpha - 0.5 * theta) * sin(0.5 * theta);
    let left = ratio * height(share * alpha);
    let (mut low, mut high) = (0.0, share * alpha);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if height(middle) < left { low = middle } else { high = middle }
    }
    0.5 * (low + high) / alpha
}

/// Returns the least amplitude A/(gα) of a rectangular pulse of duration t₁ that overturns a slender block, as a
/// function of `p t₁` (Housner 1963).
pub fn rectangular_overturning(rate_times_duration: f64) -> f64 {
    1.0 / (1.0 - exp(-rate_times_duration))
}

/// Returns the least amplitude A/(gα) of a half-sine pulse that overturns a slender block.
///
/// `ratio` is ρ = ω/p. The amplitude is 1/sin ψ, where ψ is the root of cos ψ + e^{−(π−ψ)/ρ} = ρ sin ψ (Makris and
/// Roussos 2000).
pub fn half_sine_overturning(ratio: f64) -> f64 {
    sine_root(ratio, |psi| cos(psi) + exp(-(PI - psi) / ratio))
}

/// Returns the least amplitude A/(gα) of a one-sine pulse that overturns a slender block without impact.
///
/// `ratio` is ρ = ω/p. The amplitude is 1/sin ψ, where ψ is the root of cos ψ − e^{−(2π−ψ)/ρ} = ρ sin ψ (Makris and
/// Roussos 2000).
pub fn one_sine_overturning(ratio: f64) -> f64 {
    sine_root(ratio, |psi| cos(psi) - exp(-(TAU - psi) / ratio))
}

/// Returns `1/sin ψ` at the angle ψ below π/2 that solves `side(ψ) = ρ sin ψ`.
fn sine_root(ratio: f64, side: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (1e-9, FRAC_PI_2);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if side(middle) > ratio * sin(middle) { low = middle } else { high = middle }
    }
    1.0 / sin(0.5 * (low + high))
}

/// Returns the least amplitude A/(gα) of a one-cosine pulse that overturns a slender block without impact.
///
/// The amplitude is (1 + ρ²)/(1 − e^{−2π/ρ}), where `ratio` is ρ = ω/p (Makris and Roussos 2000).
pub fn one_cosine_overturning(ratio: f64) -> f64 {
    (1.0 + ratio * ratio) / (1.0 - exp(-TAU / ratio))
}

/// Returns the least friction coefficient at which a block of slenderness `s` rocks without sliding on a base
/// that accelerates at `β g`, with β > s (Shao and Tung 1999, Taniguchi 2002).
pub fn least_friction_for_rocking(beta: f64, s: f64) -> f64 {
    (beta * (1.0 + 4.0 * s * s) + 3.0 * s) / (4.0 + s * s + 3.0 * beta * s)
}

/// Returns the slip (m) of a block with yield acceleration `n g` on ground that accelerates at `a g` for `duration` (s)
/// (Newmark 1965).
pub fn slide_in_rectangular_pulse(a: f64, n: f64, duration: f64) -> f64 {
    let speed = a * GRAVITY * duration;
    speed * speed / (2.0 * GRAVITY * n) * (1.0 - n / a)
}

/// Returns the slip (m) of a block with yield acceleration `n g` on ground whose acceleration is a half-sine pulse of
/// amplitude `a g` and length `duration` (s). The motion is integrated in closed form.
pub fn slide_in_half_sine(a: f64, n: f64, duration: f64) -> f64 {
    let omega = PI / duration;
    let start = atan(n / (a * a - n * n).sqrt());
    let rest = duration - start / omega;
    let speed = a * GRAVITY / omega * (1.0 + cos(start)) - n * GRAVITY * rest;
    let slip = a * GRAVITY / omega * cos(start) * rest + a * GRAVITY / (omega * omega) * sin(start)
        - 0.5 * n * GRAVITY * rest * rest;
    slip + speed * speed / (2.0 * n * GRAVITY)
}

/// Returns the amplitude (m) of the motion relative to the ground, for a block with yield acceleration `n g` that
/// slides without pause on ground with the acceleration `a g sin ωt` (Den Hartog 1931).
pub fn steady_slide_amplitude(a: f64, n: f64, omega: f64) -> f64 {
    let share = PI * n / (2.0 * a);
    a * GRAVITY / (omega * omega) * (1.0 - share * share).sqrt()
}

/// Returns the coefficient of restitution and the deepest penetration (in units of v₀/ω) of a mass that falls on a
/// spring and a damper, where the damper acts on approach only.
///
/// The coefficient e is `None` if the mass does not lift off. `gravity_number` is Γ = g/(ωv₀). The approach is a damped
/// motion about the rest position Γ (in units of v₀/ω), and the rebound is undamped: e = √(x² − 2Γx), where x is
/// the deepest penetration.
pub fn rebound_under_gravity(damping_ratio: f64, gravity_number: f64) -> (Option<f64>, f64) {
    let (zeta, gamma) = (damping_ratio, gravity_number);
    let omega = (1.0 - zeta * zeta).sqrt();
    // x = Γ + e^{−ζt} (−Γ cos ωt + B sin ωt), with x(0) = 0 and x'(0) = 1.
    let b = (1.0 - zeta * gamma) / omega;
    let t = atan2(zeta * gamma + b * omega, -(gamma * omega - zeta * b)) / omega;
    let deepest = gamma + exp(-zeta * t) * (b * sin(omega * t) - gamma * cos(omega * t));
    let square = deepest * deepest - 2.0 * gamma * deepest;
    ((square > 0.0).then(|| square.sqrt()), deepest)
}

/// Returns the least Γ = g/(ωv₀) at which a mass does not lift off after the impact described in
/// [`rebound_under_gravity`].
pub fn lift_off_lost(damping_ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if rebound_under_gravity(damping_ratio, middle).0.is_some() {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Returns the duration t of an impact on a spring and a damper, as the phase ω t. The damper acts on approach only.
///
/// The duration is the sum of the damped approach and the undamped rebound, which lasts a quarter period.
pub fn contact_phase(damping_ratio: f64) -> f64 {
    let zeta = damping_ratio;
    let way_in = if (zeta - 1.0).abs() < 1e-9 {
        1.0
    } else if zeta < 1.0 {
        acos(zeta) / (1.0 - zeta * zeta).sqrt()
    } else {
        acosh(zeta) / (zeta * zeta - 1.0).sqrt()
    };
    way_in + FRAC_PI_2
}

/// Returns the acceleration of a body that rolls on a moving base, as a fraction of the acceleration of the base.
///
/// `ratio` is k²/r², with the radius of gyration k and the radius r of the body.
pub fn rolling_share(ratio: f64) -> f64 {
    ratio / (1.0 + ratio)
}

/// Returns the angular frequency (rad/s) of small oscillations of a cylinder that rolls without slip in a round cradle.
///
/// `ratio` is k²/r², with the radius of gyration k and the radius r of the cylinder.
pub fn swing_in_cradle(cradle_radius: f64, radius: f64, ratio: f64) -> f64 {
    (GRAVITY / ((cradle_radius - radius) * (1.0 + ratio))).sqrt()
}

/// Returns the largest overhang (m) of a stack of `n` equal bricks of the given length (m), one brick per layer.
pub fn overhang(n: u32, length: f64) -> f64 {
    0.5 * length * (1..=n).map(|i| 1.0 / f64::from(i)).sum::<f64>()
}
