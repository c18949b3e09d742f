//! Straps against closed forms: tension only, tearing, and energy balance.
#![allow(clippy::print_stdout, reason = "errors are printed beside their tolerance")]

use crate::common;

use std::ops::ControlFlow;

use crate::common::{DOWN, GRAVITY, Scene, disc, every_method, floor, interface};
use barrelstack_dynamics::{
    Body, Element, FrictionLaw, Link, Method, Model, NormalLaw, Planar, Still, Strap, Twist, Vec2,
};

const MASS: f64 = 100.0;
const STIFFNESS: f64 = 1e5;

/// Attachment point of the strap (m).
const HOOK: Vec2 = Vec2::new(0.0, 5.0);

/// Returns a strap of one meter from the ground to the top of a disc.
fn hung() -> Strap<Planar> {
    Strap {
        link: Link { name: "strap".into(), bodies: [0, 1], points: [HOOK, Vec2::new(0.0, 0.3)] },
        length: 1.0,
        stiffness: STIFFNESS,
        damping: 0.0,
        yields_at: f64::INFINITY,
        strength: f64::INFINITY,
    }
}

fn scene(bodies: Vec<Body<Planar>>, straps: Vec<Strap<Planar>>, gravity: Vec2) -> Scene {
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 0.0 };
    let interface = interface(law, FrictionLaw::Frictionless);
    let pairs = common::all_pairs(&bodies);
    let mut model = Model::new(bodies, vec![interface], pairs, gravity).unwrap();
    model.fasten(straps.into_iter().map(Element::from).collect()).unwrap();
    Scene::of(model)
}

/// Returns a disc at rest, on a strap that is slack by a length (m).
fn hanging(strap: Strap<Planar>, slack: f64) -> Scene {
    let center = HOOK + Vec2::new(0.0, slack - 1.3);
    let disc = disc("disc", 0.3, MASS, 0.045, center);
    scene(vec![floor(), disc], vec![strap], DOWN)
}

/// Returns the elongation (m) of the strap when a mass is caught after a fall (m).
fn stretch(fall: f64) -> f64 {
    let still = MASS * GRAVITY / STIFFNESS;
    still + (still * still + 2.0 * still * fall).sqrt()
}

#[test]
fn a_mass_on_a_taut_strap_swings_as_on_a_spring() {
    let omega = (STIFFNESS / MASS).sqrt();
    let still = MASS * GRAVITY / STIFFNESS;
    for (method, measured) in every_method(1e-9).into_iter().zip([1.6e-3, 1.3e-5, 3.3e-9, 4.2e-8]) {
        let mut scene = hanging(hung(), 0.0);
        let start = scene.state.poses[1].position.z;
        let mut worst = 0.0_f64;
        scene
            .by(method)
            .watch(&Still, 1e-4, 1.0, |state, _, _| {
                let sunk = start - state.poses[1].position.z;
                let exact = still * (1.0 - libm::cos(omega * state.time));
                worst = worst.max((sunk - exact).abs() / still);
                ControlFlow::Continue(())
            })
            .unwrap();
        println!("{}: {worst:e}", method.name());
        // measured as listed
        assert!(worst < 2.0 * measured, "{}: {worst:e}", method.name());
    }
}

#[test]
fn a_falling_mass_is_caught_and_thrown_back_to_where_it_came_from() {
    let slack = 0.2;
    let mut scene = hanging(hung(), slack);
    let start = scene.state.poses[1].position.z;
    let (mut most, mut highest_after) = (0.0_f64, f64::NEG_INFINITY);
    scene
        .by(Method::RungeKutta4)
        .watch(&Still, 1e-5, 0.6, |state, scratch, _| {
            most = most.max(scratch.loads[0].force);
            if state.time > 0.3 {
                highest_after = highest_after.max(state.poses[1].position.z);
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    let exact = STIFFNESS * stretch(slack);
    println!("tension {most} N, exact {exact} N; returns to {:e} m", start - highest_after);
    assert!((most / exact - 1.0).abs() < 1e-7); // measured 6.5e-9
    assert!((start - highest_after).abs() < 1e-8); // measured 1.2e-10
}

#[test]
fn a_damper_pulls_only_while_the_strap_is_taut_and_never_pushes() {
    // The damper is so strong that it would push the disc down on its return.
    let mut scene = hanging(Strap { damping: 2e4, ..hung() }, 0.2);
    let (mut least, mut slack) = (f64::INFINITY, 0);
    let energy = scene
        .by(Method::VelocityVerlet)
        .watch(&Still, 1e-5, 2.0, |state, scratch, _| {
            let distance = HOOK.z - state.poses[1].position.z - 0.3;
            least = least.min(scratch.loads[0].force);
            if distance < 1.0 {
                slack += 1;
                assert_eq!(scratch.loads[0].force, 0.0);
            }
            ControlFlow::Continue(())
        })
        .unwrap()
        .energy
        .summary(0);
    println!("slack in {slack} steps; {energy:?}");
    assert!(least == 0.0 && slack > 0);
    // The energy of the fall is dissipated: the disc hangs at rest.
    let still = MASS * GRAVITY / STIFFNESS;
    let hangs = HOOK.z - 1.3 - scene.state.poses[1].position.z;
    assert!((hangs / still - 1.0).abs() < 1e-3, "{hangs} m");
    let lost = MASS * GRAVITY * (0.2 + 0.5 * still);
    assert!((energy.damped / lost - 1.0).abs() < 1e-4, "{} J of {lost} J", energy.damped); // measured 1e-6
    assert!(energy.residual_ratio() < 1e-6, "{:e}", energy.residual_ratio());
}

#[test]
fn a_strap_tears_above_its_strength_and_the_energy_balances() {
    let slack = 0.2;
    let strength = 0.5 * STIFFNESS * stretch(slack);
    let mut scene = hanging(Strap { strength, ..hung() }, slack);
    let (mut most, mut torn_at) = (0.0_f64, None);
    let energy = scene
        .by(Method::VelocityVerlet)
        .watch(&Still, 1e-5, 0.5, |state, scratch, _| {
            most = most.max(scratch.loads[0].force);
            if state.memory[0].broken && torn_at.is_none() {
                torn_at = Some((state.time, state.twists[1].linear.z));
            }
            ControlFlow::Continue(())
        })
        .unwrap()
        .energy
        .summary(0);
    let (time, speed) = torn_at.unwrap();
    // The energy of the fall up to the tear, less the energy stored in the strap at that time.
    let given = MASS * GRAVITY * (slack + strength / STIFFNESS);
    let taken = 0.5 * strength * strength / STIFFNESS;
    let exact = -(2.0 * (given - taken) / MASS).sqrt();
    println!("torn at {time} s, speed {speed} m/s, exact {exact} m/s; {energy:?}");
    assert!((most / strength - 1.0).abs() < 2e-3); // measured: what a step adds
    assert!((speed / exact - 1.0).abs() < 1e-3); // measured 1.1e-4
    assert!((energy.damped / taken - 1.0).abs() < 4e-3, "{} J of {taken} J", energy.damped);
    // The step in which the strap tears still includes half of its force.
    assert!(energy.residual_ratio() < 1e-4, "{:e}", energy.residual_ratio()); // measured 3.0e-5
    // A torn strap never pulls again.
    assert!(scene.state.poses[1].position.z < HOOK.z - 2.0);
    assert_eq!(scene.scratch.loads[0].force, 0.0);
}

#[test]
fn two_bodies_on_a_strap_keep_momentum_spin_and_energy() {
    let flying = |name: &str, x: f64, velocity: Vec2, angular: f64| Body {
        twist: Twist { linear: velocity, angular },
        ..disc(name, 0.3, MASS, 0.045, Vec2::new(x, 3.0))
    };
    let bodies = vec![
        floor(),
        flying("left", -0.6, Vec2::new(-0.3, 1.0), 2.0),
        flying("right", 0.6, Vec2::new(0.5, -1.0), -1.0),
    ];
    let tie = Strap {
        link: Link {
            bodies: [1, 2],
            points: [Vec2::new(0.1, 0.2), Vec2::new(-0.2, 0.1)],
            ..hung().link
        },
        length: 1.0,
        ..hung()
    };
    let mut scene = scene(bodies, vec![tie], Vec2::default());
    let momenta = |scene: &Scene| {
        let mut sums = [0.0; 3];
        for (pose, twist) in scene.state.poses.iter().zip(&scene.state.twists).skip(1) {
            sums[0] += MASS * twist.linear.x;
            sums[1] += MASS * twist.linear.z;
            let (p, v) = (pose.position, twist.linear);
            sums[2] += MASS * (0.045 * twist.angular + p.x * v.z - p.z * v.x);
        }
        sums
    };
    let before = momenta(&scene);
    let mut most = 0.0_f64;
    let energy = scene
        .by(Method::VelocityVerlet)
        .watch(&Still, 1e-4, 1.5, |_, scratch, _| {
            most = most.max(scratch.loads[0].force);
            ControlFlow::Continue(())
        })
        .unwrap()
        .energy
        .summary(0);
    let after = momenta(&scene);
    println!(
        "{before:?} {after:?}, tension up to {most} N, residual {:e}",
        energy.residual_ratio()
    );
    assert!(most > 1000.0);
    for (a, b) in before.iter().zip(after) {
        assert!((a - b).abs() < 1e-8, "{before:?} {after:?}"); // measured 1.9e-10
    }
    assert!(energy.residual_ratio() < 1e-5, "{:e}", energy.residual_ratio()); // measured 5.6e-7
}

#[test]
fn what_is_no_strap_is_refused_with_its_name() {
    let wrong = [
        (Strap { link: Link { bodies: [1, 1], ..hung().link }, ..hung() }, "itself"),
        (Strap { link: Link { bodies: [0, 7], ..hung().link }, ..hung() }, "does not exist"),
        (Strap { stiffness: 0.0, ..hung() }, "stiffness"),
        (Strap { stiffness: f64::NAN, ..hung() }, "stiffness"),
        (Strap { damping: -1.0, ..hung() }, "damping"),
        (Strap { length: f64::INFINITY, ..hung() }, "length"),
        (Strap { strength: 0.0, ..hung() }, "strength"),
    ];
    for (strap, word) in wrong {
        let mut model = hanging(hung(), 0.0).model;
        let message = model.fasten(vec![strap.into()]).unwrap_err().to_string();
        assert!(message.contains("strap") && message.contains(word), "{message}");
    }
}
