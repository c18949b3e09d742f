//! Every normal law: signs, continuity, stored energy, limits, and restitution.

use crate::common;

use std::ops::ControlFlow;

use crate::common::{DOWN, Scene, assert_close, disc, floor, interface};
use barrelstack_dynamics::contact::{Exponent, restitution};
use barrelstack_dynamics::{FrictionLaw, Method, NormalLaw, Still, Twist, Vec2};
use barrelstack_scenes::theory::{contact_phase, rebound_under_gravity};
use proptest::prelude::*;

fn any_law() -> impl Strategy<Value = NormalLaw> {
    let (stiffness, damping) = (1e3..1e8_f64, 0.0..1e5_f64);
    prop_oneof![
        (stiffness.clone(), damping.clone())
            .prop_map(|(stiffness, damping)| NormalLaw::SpeedGap { stiffness, damping }),
        (stiffness.clone(), damping)
            .prop_map(|(stiffness, damping)| NormalLaw::KelvinVoigt { stiffness, damping }),
        (stiffness.clone(), 0.0..3.0_f64, any::<bool>()).prop_map(
            |(stiffness, dissipation, linear)| NormalLaw::HuntCrossley {
                stiffness,
                dissipation,
                exponent: if linear { Exponent::Linear } else { Exponent::Hertzian },
            }
        ),
        stiffness.prop_map(|stiffness| NormalLaw::Hertz { stiffness }),
    ]
}

proptest! {
    #![proptest_config(common::cases(200))]

    #[test]
    fn no_law_pulls_or_gives_energy(law in any_law(), depth in 0.0..0.1_f64, rate in -5.0..5.0_f64) {
        let force = law.force(depth, rate);
        prop_assert!(force.total >= 0.0 && force.elastic >= 0.0 && force.energy >= 0.0);
        prop_assert!((force.total - force.elastic) * rate >= 0.0);
    }

    #[test]
    fn the_elastic_force_is_the_slope_of_the_stored_energy(
        law in any_law(), depth in 1e-4..0.1_f64, rate in -5.0..5.0_f64
    ) {
        let h = 1e-4 * depth;
        let slope = (law.force(depth + h, rate).energy - law.force(depth - h, rate).energy) / (2.0 * h);
        let elastic = law.force(depth, rate).elastic;
        prop_assert!((slope - elastic).abs() <= 1e-8 * elastic); // measured 1.3e-9
    }

    #[test]
    fn tangents_are_slopes_of_the_force(law in any_law(), depth in 1e-4..0.1_f64, rate in 0.01..5.0_f64) {
        let h = 1e-4 * depth;
        let force = |depth: f64, rate: f64| law.force(depth, rate).total;
        let stiffness = (force(depth + h, 0.0) - force(depth - h, 0.0)) / (2.0 * h);
        prop_assert!((stiffness / law.tangent_stiffness(depth) - 1.0).abs() < 1e-8); // measured 4.2e-10
        let h = 1e-3 * rate;
        let damping = (force(depth, rate + h) - force(depth, rate - h)) / (2.0 * h);
        let expected = law.tangent_damping(depth);
        let rounding = 1e-12 * force(depth, rate) / h;
        prop_assert!((damping - expected).abs() <= 1e-9 * expected + rounding);
    }

    #[test]
    fn the_force_of_a_touching_node_never_jumps(
        law in any_law(), depth in 1e-4..0.1_f64, rate in -5.0..5.0_f64
    ) {
        // A small change of the arguments changes the force by a small fraction of its scale.
        let here = law.force(depth, rate).total;
        let scale = law.force(depth, rate.abs()).total + law.tangent_damping(depth) * rate.abs();
        for (d, r) in [(1e-9, 0.0), (-1e-9, 0.0), (0.0, 1e-9), (0.0, -1e-9)] {
            let there = law.force(depth * (1.0 + d), rate * (1.0 + r)).total;
            prop_assert!((there - here).abs() <= 1e-8 * scale);
        }
        // The force does not jump either where the rate passes through zero.
        let (in_, out) = (law.force(depth, 1e-12).total, law.force(depth, -1e-12).total);
        prop_assert!((in_ - out).abs() <= 1e-6 * law.force(depth, 0.0).total);
    }

    #[test]
    fn pushing_deeper_or_faster_never_weakens_the_force(
        law in any_law(), depth in 0.0..0.1_f64, rate in -5.0..5.0_f64, more in 0.0..1.0_f64
    ) {
        let here = law.force(depth, rate).total;
        prop_assert!(law.force(depth, rate + more).total >= here);
        prop_assert!(law.force(depth * (1.0 + more), rate).total >= here);
    }

    #[test]
    fn damping_and_restitution_are_inverse(e in 0.001..1.0_f64, speed in 0.01..10.0_f64) {
        let round = restitution::speed_gap(restitution::speed_gap_damping_ratio(e).unwrap());
        prop_assert!((round - e).abs() < 1e-12); // measured 2.8e-16
        let round = restitution::kelvin_voigt(restitution::kelvin_voigt_damping_ratio(e).unwrap());
        prop_assert!((round - e).abs() < 1e-12);
        let d = restitution::hunt_crossley_dissipation(e, speed).unwrap();
        prop_assert!((restitution::hunt_crossley(d, speed) - e).abs() < 1e-12); // measured 2.2e-16
    }

    #[test]
    fn hunt_crossley_restitution_solves_its_equation(exponent in -14.0..5.0_f64) {
        let u = libm::exp(exponent);
        let e = restitution::hunt_crossley(u, 1.0);
        prop_assert!(e > 0.0 && e < 1.0);
        let side = |w: f64| w - libm::log1p(w);
        if u > 10.0 {
            // Limit of hard impacts: the speed after is 1/d, whatever the speed before.
            prop_assert!((1.0 - e * u) <= (1.0 + u) * libm::exp(-u) + 1e-15);
        } else if u > 1e-3 {
            prop_assert!((side(-e * u) / side(u) - 1.0).abs() < 1e-9);
        } else {
            // Limit of soft impacts: e = 1 − ⅔ u + ⁴⁄₉ u² − …
            let series = 1.0 - 2.0 / 3.0 * u + 4.0 / 9.0 * u * u;
            prop_assert!((e - series).abs() < u * u * u + 1e-11, "u = {u:e}: {e} for {series}");
        }
    }
}

/// Returns a Hunt–Crossley law without dissipation.
fn soft_law(stiffness: f64, exponent: Exponent) -> NormalLaw {
    NormalLaw::HuntCrossley { stiffness, dissipation: 0.0, exponent }
}

#[test]
fn laws_have_the_limits_of_their_parameters() {
    let k = 1e6;
    for (depth, rate) in [(0.0, 0.0), (1e-3, 0.5), (1e-3, -0.5), (0.02, 3.0)] {
        let hertz = NormalLaw::Hertz { stiffness: k }.force(depth, rate);
        let soft = soft_law(k, Exponent::Hertzian).force(depth, rate);
        assert_eq!(hertz, soft);
        let spring = NormalLaw::SpeedGap { stiffness: k, damping: 0.0 }.force(depth, rate);
        assert_eq!(
            spring,
            NormalLaw::KelvinVoigt { stiffness: k, damping: 0.0 }.force(depth, rate)
        );
        assert_eq!(spring.total, k * depth);
        assert_eq!(spring, soft_law(k, Exponent::Linear).force(depth, rate));
        // On approach the two dampers are equal.
        let gap = NormalLaw::SpeedGap { stiffness: k, damping: 3e3 }.force(depth, rate.abs());
        assert_eq!(
            gap,
            NormalLaw::KelvinVoigt { stiffness: k, damping: 3e3 }.force(depth, rate.abs())
        );
    }
}

#[test]
fn the_force_at_touch_down_is_that_of_the_damper() {
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 2e3 };
    assert_eq!(law.force(0.0, 0.3).total, 600.0);
    assert_eq!(law.force(0.0, -0.3).total, 0.0);
    for law in [
        NormalLaw::HuntCrossley { stiffness: 1e6, dissipation: 0.5, exponent: Exponent::Hertzian },
        NormalLaw::Hertz { stiffness: 1e6 },
    ] {
        assert_eq!(law.force(0.0, 3.0).total, 0.0);
    }
}

/// ζ, restitution of the speed-gap law, of Kelvin–Voigt without tension, and ω t of the contact.
const TABLE: [(f64, f64, f64, f64); 9] = [
    (0.05, 0.92669, 0.85876, 3.0935),
    (0.0676, 0.90317, 0.81571, 3.0774),
    (0.1, 0.86260, 0.74408, 3.0488),
    (0.2, 0.75613, 0.57174, 2.9685),
    (0.3, 0.67155, 0.45098, 2.8980),
    (0.5, 0.54629, 0.29844, 2.7800),
    (0.7, 0.45857, 0.21028, 2.6846),
    (1.0, 0.36788, 0.13534, 2.5708),
    (2.0, 0.21856, 0.04777, 2.3311),
];

#[test]
fn restitution_formulas_give_the_table() {
    for (zeta, half, both, phase) in TABLE {
        assert!((restitution::speed_gap(zeta) - half).abs() < 6e-6, "ζ = {zeta}");
        assert!((restitution::kelvin_voigt(zeta) - both).abs() < 6e-6, "ζ = {zeta}");
        assert!((contact_phase(zeta) - phase).abs() < 6e-5, "ζ = {zeta}");
    }
    let inverse = [
        (0.1, 4.807),
        (0.2, 2.224),
        (0.3, 1.336),
        (0.4, 0.8790),
        (0.5, 0.5973),
        (0.6, 0.4047),
        (0.7, 0.2639),
        (0.8, 0.1559),
        (0.9, 0.0700),
        (0.95, 0.0333),
    ];
    for (e, zeta) in inverse {
        let found = restitution::speed_gap_damping_ratio(e).unwrap();
        assert!((found - zeta).abs() < 6e-4, "e = {e}: {found}");
    }
    assert!(restitution::speed_gap_damping_ratio(1.0).unwrap() < 1e-15);
    for e in [0.0, -0.1, 1.1, f64::NAN] {
        assert_eq!(restitution::speed_gap_damping_ratio(e), None);
        assert_eq!(restitution::kelvin_voigt_damping_ratio(e), None);
        assert_eq!(restitution::hunt_crossley_dissipation(e, 1.0), None);
    }
    assert_eq!(restitution::damping(1e6, restitution::damping_ratio(1e6, 500.0, 4.0), 4.0), 500.0);
}

/// Result of one bounce of a disc.
struct Bounce {
    /// Ratio of the speeds after and before the bounce; `None` if the disc stays on the floor.
    restitution: Option<f64>,
    /// Largest penetration (m).
    deepest: f64,
    /// Time (s) from touch to separation.
    duration: f64,
}

/// Mass (kg) of the bouncing disc.
const MASS: f64 = 4.0;

/// Simulates a disc that touches the floor at time zero with a speed (m/s).
fn bounce(law: NormalLaw, speed: f64, gravity: Vec2, time_step: f64, end: f64) -> Bounce {
    let radius = 0.25;
    // Slightly inside the floor, so that the jump of the damper is at the start of the first step.
    let start = Vec2::new(0.0, radius * (1.0 - 1e-15));
    let mut ball = disc("ball", radius, MASS, 0.5 * radius * radius, start);
    ball.twist = Twist { linear: Vec2::new(0.0, -speed), angular: 0.0 };
    let mut scene =
        Scene::new(vec![floor(), ball], interface(law, FrictionLaw::Frictionless), gravity)
            .unwrap();
    let mut found = Bounce { restitution: None, deepest: 0.0, duration: f64::NAN };
    let mut before = (0.0, 0.0);
    scene
        .by(Method::RungeKutta4)
        .watch(&Still, time_step, end, |state, scratch, _| {
            let depth = radius - state.poses[1].position.z;
            found.deepest = found.deepest.max(depth);
            let parted = state.time > 0.0 && scratch.contacts.is_empty();
            if parted {
                // Free flight conserves v²/2 + g z: the speed at separation follows from any later state.
                let v = state.twists[1].linear.z;
                let rise = (v * v + 2.0 * gravity.z * depth).max(0.0).sqrt();
                found.restitution = Some(rise / speed);
                let share = before.1 / (before.1 - depth);
                found.duration = before.0 + share * (state.time - before.0);
                return ControlFlow::Break(());
            }
            before = (state.time, depth);
            ControlFlow::Continue(())
        })
        .unwrap();
    found
}

/// Returns a step in which the contact phase advances by a two-thousandth of a radian.
fn fine_step(stiffness: f64) -> f64 {
    5e-4 / (stiffness / MASS).sqrt()
}

#[test]
fn a_bouncing_disc_shows_the_restitution_and_contact_time_of_the_table() {
    let (stiffness, speed) = (1e6, 0.7);
    let omega = (stiffness / MASS).sqrt();
    for (zeta, ..) in TABLE {
        let damping = restitution::damping(stiffness, zeta, MASS);
        let step = fine_step(stiffness);
        let half = NormalLaw::SpeedGap { stiffness, damping };
        let found = bounce(half, speed, Vec2::default(), step, 0.1);
        let e = found.restitution.unwrap();
        assert_close("speed-gap restitution", e, restitution::speed_gap(zeta), 2e-8); // measured 3.8e-9
        assert_close("phase", omega * found.duration, contact_phase(zeta), 1e-8); // measured 3.0e-9

        let both = NormalLaw::KelvinVoigt { stiffness, damping };
        // The force ends before the penetration does; from there to separation the disc flies freely.
        let found = bounce(both, speed, Vec2::default(), step, 0.2);
        let e = found.restitution.unwrap();
        assert_close("Kelvin–Voigt restitution", e, restitution::kelvin_voigt(zeta), 2e-8); // measured 3.4e-9
    }
}

#[test]
fn gravity_lowers_the_rebound_and_takes_it_away() {
    let stiffness = 1e6;
    let omega = (stiffness / MASS).sqrt();
    let run = |zeta: f64, gamma: f64| {
        let law =
            NormalLaw::SpeedGap { stiffness, damping: restitution::damping(stiffness, zeta, MASS) };
        let speed = 9.80665 / (omega * gamma);
        let found = bounce(law, speed, DOWN, fine_step(stiffness), 0.1);
        (found.restitution, found.deepest * omega / speed)
    };
    for (zeta, gamma, published) in
        [(0.0676, 0.1, 0.88988), (0.0676, 0.5, 0.80881), (0.3, 0.1, 0.62674), (0.3, 0.5, 0.24616)]
    {
        let (exact, deepest) = rebound_under_gravity(zeta, gamma);
        assert!((exact.unwrap() - published).abs() < 6e-6);
        let (found, depth) = run(zeta, gamma);
        assert_close("rebound", found.unwrap(), published, 2e-5); // measured 7.5e-6: the table's digits
        assert_close("rebound", found.unwrap(), exact.unwrap(), 4e-8); // measured 6.4e-9
        assert_close("depth", depth, deepest, 1e-7); // measured 1.4e-8
    }
    for (zeta, limit) in [(0.0676, 1.415), (0.2, 0.731), (0.3, 0.555)] {
        assert!(rebound_under_gravity(zeta, limit * 0.998).0.is_some());
        assert!(rebound_under_gravity(zeta, limit * 1.002).0.is_none());
        assert!(run(zeta, limit * 0.998).0.is_some(), "ζ = {zeta} must lift off below Γ = {limit}");
        assert!(run(zeta, limit * 1.002).0.is_none(), "ζ = {zeta} must stay above Γ = {limit}");
    }
}

#[test]
fn hunt_crossley_shows_the_restitution_it_was_made_for() {
    let speed = 0.8;
    for (exponent, stiffness) in [(Exponent::Hertzian, 1e8), (Exponent::Linear, 1e6)] {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let dissipation = restitution::hunt_crossley_dissipation(e, speed).unwrap();
            let law = NormalLaw::HuntCrossley { stiffness, dissipation, exponent };
            let found = bounce(law, speed, Vec2::default(), 1e-6, 0.2).restitution.unwrap();
            assert_close("restitution", found, e, 2e-8); // measured 2.8e-9
        }
    }
}

#[test]
fn hertz_contact_is_elastic_and_lasts_as_long_as_hertz_says() {
    let (stiffness, speed) = (1e8, 0.8);
    let found = bounce(NormalLaw::Hertz { stiffness }, speed, Vec2::default(), 1e-6, 0.1);
    assert_close("restitution", found.restitution.unwrap(), 1.0, 2e-9); // measured 3.5e-10
    let deepest = libm::pow(5.0 * MASS * speed * speed / (4.0 * stiffness), 0.4);
    assert_close("depth", found.deepest, deepest, 2e-7); // measured 3.4e-8
    // t = 2 √π Γ(7/5)/Γ(9/10) δ/v
    assert_close("duration", found.duration, 2.943_275 * deepest / speed, 2e-7); // measured 6.3e-8
}
