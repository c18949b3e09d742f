//! Rocking blocks: Housner's period, the start of rocking, and overturning by one push.
#![allow(clippy::unwrap_used, reason = "a scene that cannot be made fails its test")]

mod common;

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::{Drive, NormalLaw, Planar, Still};
use barrelstack_scenes::drive::Shake;
use common::{DOWN, GRAVITY, Scene, assert_close, block, coulomb, floor, interface, pose};

const MASS: f64 = 100.0;

/// A block on near rigid corners, of a half-diagonal (m) and a slenderness angle (rad), that leans on
/// its right corner by an angle (rad, clockwise positive).
fn leaning(radius: f64, alpha: f64, lean: f64) -> Scene {
    let stiffness = 1e9;
    let (half_width, half_height) = (radius * libm::sin(alpha), radius * libm::cos(alpha));
    let damping = restitution::damping(stiffness, 1.0, MASS);
    // One corner carries a leaning block, two an upright one.
    let corners = if lean > 0.0 { 1.0 } else { 2.0 };
    let sunk = MASS * GRAVITY / (corners * stiffness);
    let (x, z) = if lean > 0.0 {
        let direction = alpha - lean;
        (half_width - radius * libm::sin(direction), radius * libm::cos(direction))
    } else {
        (0.0, half_height)
    };
    let size = (2.0 * half_width, 2.0 * half_height);
    let body = block("block", size, MASS, pose(x, z - sunk, -lean));
    let laws =
        interface(NormalLaw::SpeedGap { stiffness, damping }, coulomb(3.0, stiffness, damping));
    Scene::new(vec![floor(), body], laws, DOWN).unwrap()
}

/// p² = 3 g / 4 R of a rectangle.
fn pulse_rate(radius: f64) -> f64 {
    (0.75 * GRAVITY / radius).sqrt()
}

/// Quarter period times p from a lean of `share · α`: θ'' = −p² sin(α − θ), by the midpoint rule over
/// an angle that takes the root out of the integrand.
fn quarter_period(alpha: f64, share: f64) -> f64 {
    // With energy: θ'²/2p² = cos(α − θ₀) − cos(α − θ); set θ = θ₀ cos² u... the root at θ₀ vanishes
    // with θ = θ₀ − θ₀ s², dθ = −2 θ₀ s ds.
    let start = share * alpha;
    let parts = 20_000;
    (0..parts)
        .map(|i| {
            let s = (f64::from(i) + 0.5) / f64::from(parts);
            let theta = start * (1.0 - s * s);
            // cos(α − θ₀) − cos(α − θ) = 2 sin((2α − θ₀ − θ)/2) sin((θ₀ − θ)/2), free of cancellation.
            let fall =
                2.0 * libm::sin(alpha - 0.5 * (start + theta)) * libm::sin(0.5 * (start - theta));
            2.0 * start * s / (2.0 * fall).sqrt() / f64::from(parts)
        })
        .sum()
}

#[test]
fn a_block_let_go_falls_back_in_housners_quarter_period() {
    // Slender and exact values of p T / 4 at α = 0.25.
    for (share, slender, published) in [
        (0.10, 0.46715, 0.46920),
        (0.25, 0.79537, 0.79798),
        (0.50, 1.31696, 1.31938),
        (0.75, 2.06344, 2.06520),
        (0.90, 2.99322, 2.99464),
    ] {
        let exact = quarter_period(0.25, share);
        assert!((exact - published).abs() < 1e-5, "{exact} for {published}");
        assert!((libm::acosh(1.0 / (1.0 - share)) - slender).abs() < 1e-5);

        let radius = 1.0;
        let mut scene = leaning(radius, 0.25, share * 0.25);
        let mut before = (0.0, -share * 0.25);
        let mut upright = f64::NAN;
        scene
            .watch(&Still, 2e-5, 2.0, |state, _, _| {
                let angle = state.poses[1].orientation;
                if angle >= 0.0 {
                    upright = before.0 + before.1 / (before.1 - angle) * (state.time - before.0);
                    return ControlFlow::Break(());
                }
                before = (state.time, angle);
                ControlFlow::Continue(())
            })
            .unwrap();
        assert_close("p T/4", upright * pulse_rate(radius), exact, 1e-3);
    }
}

#[test]
fn a_block_begins_to_rock_at_its_slenderness() {
    for alpha in [0.15_f64, 0.25, 0.4] {
        let lifted = |share: f64| {
            let mut scene = leaning(1.0, alpha, 0.0);
            let acceleration = share * GRAVITY * libm::tan(alpha);
            scene.run(&Shake::Ramped { acceleration, ramp: 0.2 }, 2e-5, 0.5).unwrap();
            scene.state.poses[1].orientation.abs()
        };
        let (below, above) = (lifted(0.99), lifted(1.01));
        assert!(below < 1e-5, "α = {alpha}: {below:e} below the limit");
        assert!(above > 1e-4, "α = {alpha}: {above:e} above the limit");
    }
}

/// Whether a block ends up on its side; the largest lean decides.
fn overturns(drive: &impl Drive<Planar>, radius: f64, alpha: f64) -> bool {
    let mut scene = leaning(radius, alpha, 0.0);
    let mut fell = false;
    scene
        .watch(drive, 5e-5, 6.0, |state, _, _| {
            let lean = state.poses[1].orientation.abs();
            fell = lean > 2.0 * alpha;
            // Once it falls back upright after the push, the first swing is over.
            let back =
                state.time > 2.0 && state.twists[1].angular * state.poses[1].orientation < 0.0;
            if fell || back { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    fell
}

#[test]
fn a_half_sine_push_overturns_a_block_at_the_exact_strength() {
    // p = 2.14 /s and α = 0.25; thresholds of A / (g tan α) without the slender simplification.
    let (p, alpha) = (2.14, 0.25);
    let radius = 0.75 * GRAVITY / (p * p);
    for (ratio, threshold) in [(2.0, 1.8015), (3.0, 2.2974), (5.0, 3.2993)] {
        let duration = std::f64::consts::PI / (ratio * p);
        let push =
            |share: f64| Shake::half_sine(share * threshold * GRAVITY * libm::tan(alpha), duration);
        assert!(!overturns(&push(0.995), radius, alpha), "ω/p = {ratio}: falls below");
        assert!(overturns(&push(1.005), radius, alpha), "ω/p = {ratio}: stands above");
    }
}
