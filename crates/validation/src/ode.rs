//! Solutions of ordinary differential equations by an independent library.
//!
//! The library locates events with an interpolant of low order, so the library is used only for smooth motions between
//! given times.

use differential_equations::prelude::{ExplicitRungeKutta, IVP};

/// Integrates `y' = rates(t, y)` from `start` at `from` (s) to `until` (s).
///
/// Uses the method of order 8 of Dormand and Prince with a relative tolerance of 10⁻¹³ per step.
/// Returns NaN, which no tolerance admits, if the integration fails.
pub fn solution<const N: usize>(
    rates: impl Fn(f64, &[f64; N]) -> [f64; N],
    start: [f64; N],
    (from, until): (f64, f64),
) -> [f64; N] {
    let method = ExplicitRungeKutta::dop853()
        .rtol(1e-13)
        .atol(1e-15)
        .h_max((until - from) / 20.0)
        .max_steps(1_000_000);
    IVP::ode_from_fn(|t, y: &[f64; N], out: &mut [f64; N]| *out = rates(t, y), from, until, start)
        .method(method)
        .solve()
        .ok()
        .and_then(|solved| solved.last().ok().map(|(_, y)| *y))
        .unwrap_or([f64::NAN; N])
}

#[cfg(test)]
mod tests {
    use barrelstack_dynamics::math::{cos, exp, sin};

    use super::solution;

    #[test]
    fn the_library_keeps_its_tolerance_on_closed_forms() {
        // A damped oscillator driven at resonance: y'' + 2ζω y' + ω² y = sin ωt from rest.
        let (omega, zeta) = (60.0, 0.02_f64);
        let rates = |t: f64, y: &[f64; 2]| {
            [y[1], sin(omega * t) - 2.0 * zeta * omega * y[1] - omega * omega * y[0]]
        };
        let found = solution(rates, [0.0, 0.0], (0.0, 2.0))[0];
        let swing = omega * (1.0 - zeta * zeta).sqrt();
        let ring = cos(swing * 2.0) + zeta * omega / swing * sin(swing * 2.0);
        let exact =
            (exp(-zeta * omega * 2.0) * ring - cos(omega * 2.0)) / (2.0 * zeta * omega * omega);
        let error = (found / exact - 1.0).abs();
        assert!(error < 1e-11, "{found} for {exact}: {error:e}"); // measured 3.5e-13
        // A pendulum released at 1 rad conserves its energy.
        let [angle, spin] = solution(|_, y| [y[1], -sin(y[0])], [1.0, 0.0], (0.0, 20.0));
        let missing = (0.5 * spin * spin - cos(angle) + cos(1.0)).abs();
        assert!(missing < 1e-12, "{missing:e}"); // measured 8.9e-16
    }

    #[test]
    fn what_cannot_be_solved_is_not_a_number() {
        // y' = y² diverges after one second.
        assert!(!solution(|_, y| [y[0] * y[0]], [1.0], (0.0, 2.0))[0].is_finite());
    }
}
