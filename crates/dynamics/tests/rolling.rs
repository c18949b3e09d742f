//! Discs that roll: on a moving base, down a slope, and in cradles.
#![allow(clippy::unwrap_used, reason = "a scene that cannot be made fails its test")]

mod common;

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::shape::{Circle, Cradle};
use barrelstack_dynamics::{
    Body, Drive, FrictionLaw, Method, Motion, Node, Nodes, NormalLaw, Planar, Shape, Still, Twist,
    Vec2,
};
use barrelstack_scenes::drive::Shake;
use barrelstack_scenes::theory::{rolling_share, swing_in_cradle};
use common::{
    DOWN, GRAVITY, Scene, assert_close, centered, coulomb, disc, floor, gravity_on_slope,
    ground_of, interface,
};

const MASS: f64 = 100.0;
const RADIUS: f64 = 0.35;
const STIFFNESS: f64 = 1e8;

/// k²/r² of a full barrel, a ball, a solid cylinder and a hoop.
const RATIOS: [f64; 4] = [0.1236, 0.4, 0.5, 1.0];

fn firm() -> NormalLaw {
    NormalLaw::KelvinVoigt {
        stiffness: STIFFNESS,
        damping: restitution::damping(STIFFNESS, 1.0, MASS),
    }
}

fn stick(coefficient: f64) -> FrictionLaw {
    coulomb(coefficient, STIFFNESS, restitution::damping(STIFFNESS, 0.5, MASS))
}

/// A disc of `k²/r² = ratio`, sunk to rest on a floor.
fn roller(ratio: f64, friction: f64, gravity: Vec2) -> Scene {
    let sunk = -MASS * gravity.z / STIFFNESS;
    let center = Vec2::new(0.0, RADIUS - sunk);
    let body = disc("roller", RADIUS, MASS, ratio * RADIUS * RADIUS, center);
    Scene::new(vec![floor(), body], interface(firm(), stick(friction)), gravity).unwrap()
}

/// Mean accelerations of the center (m/s²) and of the spin (rad/s²) between two instants.
fn accelerations(scene: &mut Scene, drive: &impl Drive<Planar>) -> (f64, f64) {
    let method = Method::VelocityVerlet;
    scene.by(method).run(drive, 1e-4, 0.5).unwrap();
    let before = scene.state.twists[1];
    scene.by(method).run(drive, 1e-4, 1.0).unwrap();
    let after = scene.state.twists[1];
    ((after.linear.x - before.linear.x) / 0.5, (after.angular - before.angular) / 0.5)
}

#[test]
fn a_rolling_disc_takes_its_share_of_the_base_acceleration() {
    for ratio in RATIOS {
        let acceleration = 1.5;
        let mut scene = roller(ratio, 0.5, DOWN);
        let (found, spin) = accelerations(&mut scene, &Shake::constant(acceleration));
        let expected = acceleration * rolling_share(ratio);
        assert_close("acceleration", found, expected, 1e-4); // measured 5.0e-5
        assert_close("spin", spin, (acceleration - expected) / RADIUS, 5e-5); // measured 2.2e-5
    }
}

#[test]
fn a_disc_slips_on_its_base_beyond_the_exact_acceleration() {
    let friction = 0.2;
    for ratio in RATIOS {
        let limit = friction * GRAVITY * (1.0 + 1.0 / ratio);
        let slips = |acceleration: f64| {
            let mut scene = roller(ratio, friction, DOWN);
            let ramp = 0.1;
            scene
                .by(Method::VelocityVerlet)
                .run(&Shake::Ramped { acceleration, ramp }, 1e-4, 1.0)
                .unwrap();
            let (ground, twist) = (scene.state.twists[0], scene.state.twists[1]);
            let touch = twist.linear.x + RADIUS * twist.angular - ground.linear.x;
            (touch.abs() > 1e-3, twist.linear.x)
        };
        assert!(!slips(0.995 * limit).0, "k²/r² = {ratio}: slips below {limit}");
        assert!(slips(1.005 * limit).0, "k²/r² = {ratio}: rolls above {limit}");
        // Once it slips, friction alone moves it.
        let mut scene = roller(ratio, friction, DOWN);
        let (found, _) = accelerations(&mut scene, &Shake::constant(1.5 * limit));
        assert_close("acceleration of slip", found, friction * GRAVITY, 1e-10); // measured 9.5e-13
    }
}

#[test]
fn a_disc_rolls_down_a_slope_with_its_share_of_gravity() {
    let slope = 0.3_f64;
    for ratio in RATIOS {
        let mut scene = roller(ratio, 0.6, gravity_on_slope(slope));
        let (found, spin) = accelerations(&mut scene, &Still);
        let expected = GRAVITY * libm::sin(slope) / (1.0 + ratio);
        assert_close("acceleration", found, expected, 6e-5); // measured 2.7e-5
        assert_close("spin", spin, -expected / RADIUS, 6e-5); // measured 2.1e-5
    }
}

#[test]
fn on_a_slope_a_disc_slips_beyond_the_exact_angle() {
    let friction = 0.1;
    for ratio in RATIOS {
        let limit = libm::atan(friction * (1.0 + 1.0 / ratio));
        let slip = |slope: f64| {
            let mut scene = roller(ratio, friction, gravity_on_slope(slope));
            scene.by(Method::VelocityVerlet).run(&Still, 1e-4, 1.0).unwrap();
            let twist = scene.state.twists[1];
            (twist.linear.x + RADIUS * twist.angular).abs()
        };
        assert!(slip(0.99 * limit) < 5e-3, "{ratio}: slips at {}", slip(0.99 * limit));
        assert!(slip(1.01 * limit) > 5e-3, "{ratio}: rolls at {}", slip(1.01 * limit));
    }
}

/// A cradle of a radius (m) about the origin.
fn cradle(radius: f64) -> Body<Planar> {
    ground_of(vec![centered(Shape::Cradle(Cradle::new(radius, 1.2)))])
}

#[test]
fn a_cylinder_swings_in_a_round_cradle_with_the_exact_period() {
    let cradle_radius = 0.6;
    for ratio in RATIOS {
        let sunk = MASS * GRAVITY / STIFFNESS;
        let arm = cradle_radius - RADIUS + sunk;
        let angle = 0.01;
        let center = Vec2::new(arm * libm::sin(angle), -arm * libm::cos(angle));
        let body = disc("roller", RADIUS, MASS, ratio * RADIUS * RADIUS, center);
        let mut scene =
            Scene::new(vec![cradle(cradle_radius), body], interface(firm(), stick(0.9)), DOWN)
                .unwrap();
        let (mut crossings, mut before) = (vec![], (0.0, angle));
        scene
            .by(Method::VelocityVerlet)
            .watch(&Still, 1e-4, 8.0, |state, _, _| {
                let x = state.poses[1].position.x;
                if x < 0.0 && before.1 >= 0.0 {
                    crossings.push(before.0 + before.1 / (before.1 - x) * (state.time - before.0));
                }
                before = (state.time, x);
                ControlFlow::Continue(())
            })
            .unwrap();
        let periods = crossings.len() - 1;
        let period = (crossings[periods] - crossings[0]) / periods as f64;
        let omega = swing_in_cradle(cradle_radius + sunk, RADIUS, ratio);
        assert!(periods >= 3);
        assert_close("period", period, std::f64::consts::TAU / omega, 5e-5); // measured 2.5e-5
    }
}

/// A disc on two points of the ground at ± an angle (rad) from straight down.
fn two_points(angle: f64, law: NormalLaw, friction: FrictionLaw) -> Scene {
    let radius = RADIUS;
    let mut ground = ground_of(vec![]);
    let node = |side: f64| Node {
        position: Vec2::new(side * radius * libm::sin(angle), -radius * libm::cos(angle)),
        tributary_length: 1.0,
    };
    ground.nodes = vec![Nodes::Fixed(vec![node(-1.0), node(1.0)])];
    let mut body = disc("barrel", radius, MASS, 0.5 * radius * radius, Vec2::default());
    body.nodes = vec![];
    assert_eq!(body.motion, Motion::Free);
    assert!(matches!(body.surfaces[0].surface, Shape::Circle(Circle { .. })));
    Scene::new(vec![ground, body], interface(law, friction), DOWN).unwrap().settled(1e-9).unwrap()
}

#[test]
fn a_barrel_leaves_two_smooth_points_when_the_push_exceeds_their_slope() {
    for angle in [0.3_f64, 0.5, 0.7] {
        let limit = GRAVITY * libm::tan(angle);
        let lifted = |acceleration: f64| {
            let mut scene = two_points(angle, firm(), FrictionLaw::Frictionless);
            let rest = scene.state.poses[1].position;
            let drive = Shake::Ramped { acceleration, ramp: 0.5 };
            scene.by(Method::VelocityVerlet).run(&drive, 1e-4, 1.0).unwrap();
            scene.state.poses[1].position.z - rest.z
        };
        // Just below, one point carries nearly all and the barrel has not moved.
        assert!(lifted(0.995 * limit).abs() < 1e-5, "{:e}", lifted(0.995 * limit));
        assert!(lifted(1.01 * limit) > 1e-4, "{:e}", lifted(1.01 * limit));
    }
}

#[test]
fn friction_at_two_points_keeps_a_cradled_barrel_from_turning() {
    let mut scene = two_points(0.5, firm(), stick(0.5));
    scene.state.twists[1] = Twist { linear: Vec2::default(), angular: 0.2 };
    scene.by(Method::VelocityVerlet).run(&Still, 1e-4, 2.0).unwrap();
    let (turned, spin) = (scene.state.poses[1].orientation, scene.state.twists[1].angular);
    // Free of friction it would have turned by 0.4 rad.
    assert!(spin.abs() < 1e-6 && turned.abs() < 1e-3, "turned {turned:e}, turns {spin:e}");
}
