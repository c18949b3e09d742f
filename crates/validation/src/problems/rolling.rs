//! Rolling discs: on a moving base, down a slope, and in cradles.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{atan, cos, sin, tan};
use barrelstack_dynamics::shape::Cradle;
use barrelstack_dynamics::{Drive, FrictionLaw, NormalLaw, Planar, Shape, State, Still, Vec2};

use crate::drive::Shake;
use crate::problem::{absolute, relative, setting};
use crate::scene::{
    DOWN, Scene, centered, coulomb, disc, floor, gravity_on_slope, ground_of, interface,
};
use crate::swing::{mean_time, run_crossings};
use crate::{Failure, GRAVITY, Problem, theory};

use super::gravity::on_two_points;

const SOURCE: &str = "rigid-body dynamics of rolling";
const MASS: f64 = 100.0;
const RADIUS: f64 = 0.35;

/// Squared ratios k²/r² of the radius of gyration to the radius, for a full barrel whose wine does not rotate, a ball,
/// a solid cylinder and a hoop.
const RATIOS: [f64; 4] = [0.1236, 0.4, 0.5, 1.0];

/// Returns the stiffness (N/m) at a refinement level.
fn stiffness(level: i32) -> f64 {
    1e8 * 4.0_f64.powi(level)
}

/// Returns the time step (s) at a refinement level.
fn step(level: i32) -> f64 {
    1e-4 / 2.0_f64.powi(level)
}

fn firm(level: i32) -> NormalLaw {
    let stiffness = stiffness(level);
    NormalLaw::KelvinVoigt { stiffness, damping: restitution::damping(stiffness, 1.0, MASS) }
}

fn stick(coefficient: f64, level: i32) -> FrictionLaw {
    let stiffness = stiffness(level);
    coulomb(coefficient, stiffness, restitution::damping(stiffness, 0.5, MASS))
}

/// Creates a disc with k²/r² = `ratio` on a floor, at its static penetration.
fn roller(ratio: f64, friction: f64, gravity: Vec2, level: i32) -> Result<Scene, Failure> {
    let sunk = -MASS * gravity.z / stiffness(level);
    let center = Vec2::new(0.0, RADIUS - sunk);
    let body = disc("roller", RADIUS, MASS, ratio * RADIUS * RADIUS, center);
    Ok(Scene::new(vec![floor(), body], interface(firm(level), stick(friction, level)), gravity)?)
}

/// Returns the mean acceleration (m/s²) of the center of the disc between 0.5 s and 1 s.
fn acceleration(scene: &mut Scene, drive: &impl Drive<Planar>, level: i32) -> Result<f64, Failure> {
    scene.run(drive, step(level), 0.5)?;
    let before = scene.state.twists[1].linear.x;
    scene.run(drive, step(level), 1.0)?;
    Ok((scene.state.twists[1].linear.x - before) / 0.5)
}

/// Returns the slip speed (m/s) of the disc relative to its base.
fn slip(scene: &Scene) -> f64 {
    let (ground, twist) = (scene.state.twists[0], scene.state.twists[1]);
    (twist.linear.x + RADIUS * twist.angular - ground.linear.x).abs()
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    for ratio in RATIOS {
        list.extend([base(ratio), base_slip(ratio), slope(ratio), slope_slip(ratio), swing(ratio)]);
    }
    list.push(slipping());
    list.extend([0.3, 0.5, 0.7].map(leaves));
    list.push(no_turn());
    list
}

fn base(ratio: f64) -> Problem {
    let exact = theory::rolling_share(ratio);
    setting(
        format!("rolling/base-{ratio}"),
        format!("disc of k²/r² = {ratio} on a base that accelerates at 1.5 m/s²"),
        SOURCE,
    )
    .quantity("acceleration of the disc, divided by that of the base", "", relative(exact, 1e-4))
    .refined(move |_, level| {
        let drive = Shake::Rectangular { acceleration: 1.5, duration: 1e9 };
        Ok(acceleration(&mut roller(ratio, 0.5, DOWN, level)?, &drive, level)? / 1.5)
    })
}

fn base_slip(ratio: f64) -> Problem {
    let exact = 0.2 * (1.0 + 1.0 / ratio);
    setting(
        format!("rolling/base-slip-{ratio}"),
        format!("disc of k²/r² = {ratio}, μ = 0.2, on a base whose acceleration grows"),
        SOURCE,
    )
    .quantity(
        "base acceleration at which the disc starts to slip",
        "g",
        relative(exact, 5e-3).fast(1.2e-2),
    )
    .at_border(0.02, move |push| {
        let mut scene = roller(ratio, 0.2, DOWN, 0)?;
        let drive = Shake::Ramped { acceleration: push * GRAVITY, ramp: 0.1 };
        scene.run(&drive, step(0), 1.0)?;
        Ok(slip(&scene) > 1e-3)
    })
}

fn slipping() -> Problem {
    let exact = 0.2 * GRAVITY;
    setting(
        "rolling/base-slipping",
        "solid disc, μ = 0.2, on a base that accelerates at 1 g",
        SOURCE,
    )
    .quantity("its acceleration", "m/s2", relative(exact, 1e-10)) // measured 9.5e-13
    .by(move |_| {
        let drive = Shake::Rectangular { acceleration: GRAVITY, duration: 1e9 };
        acceleration(&mut roller(0.5, 0.2, DOWN, 0)?, &drive, 0)
    })
}

fn slope(ratio: f64) -> Problem {
    let exact = GRAVITY * sin(0.3) / (1.0 + ratio);
    setting(
        format!("rolling/slope-{ratio}"),
        format!("disc of k²/r² = {ratio} on a slope of 0.3 rad"),
        SOURCE,
    )
    .quantity("its acceleration", "m/s2", relative(exact, 1e-4))
    .refined(move |_, level| {
        let mut scene = roller(ratio, 0.6, gravity_on_slope(0.3), level)?;
        acceleration(&mut scene, &Still, level)
    })
}

fn slope_slip(ratio: f64) -> Problem {
    let exact = 0.1 * (1.0 + 1.0 / ratio);
    setting(
        format!("rolling/slope-slip-{ratio}"),
        format!("disc of k²/r² = {ratio}, μ = 0.1, on a slope"),
        SOURCE,
    )
    .quantity(
        "tangent of the smallest slope on which the disc slips",
        "",
        relative(exact, 1e-2).fast(1.2e-2),
    )
    .at_border(0.02, move |tangent| {
        let mut scene = roller(ratio, 0.1, gravity_on_slope(atan(tangent)), 0)?;
        scene.run(&Still, step(0), 1.0)?;
        let start = slip(&scene);
        scene.run(&Still, step(0), 2.0)?;
        // A disc that rolls on springs creeps at a steady speed; beyond the limit the slip speed grows.
        Ok(slip(&scene) - start > 2e-3)
    })
}

fn swing(ratio: f64) -> Problem {
    let cradle_radius = 0.6;
    let exact = TAU / theory::swing_in_cradle(cradle_radius, RADIUS, ratio);
    setting(
        format!("rolling/cradle-{ratio}"),
        format!("disc of k²/r² = {ratio} in a round cradle of 0.6 m, swings of 0.01 rad"),
        SOURCE,
    )
    .quantity("period", "s", relative(exact, 1e-3))
    .refined(move |_, level| {
        let arm = cradle_radius - RADIUS + MASS * GRAVITY / stiffness(level);
        let angle = 0.01;
        let center = Vec2::new(arm * sin(angle), -arm * cos(angle));
        let body = disc("roller", RADIUS, MASS, ratio * RADIUS * RADIUS, center);
        let cradle = ground_of(vec![centered(Shape::Cradle(Cradle::new(cradle_radius, 1.2)))]);
        let laws = interface(firm(level), stick(0.9, level));
        let mut scene = Scene::new(vec![cradle, body], laws, DOWN)?;
        let place = |state: &State<Planar>| state.poses[1].position.x;
        let through = run_crossings(&mut scene, step(level), 8.0, place)?;
        // The disc starts on the right, so every second crossing comes from the right.
        let leftward: Vec<f64> = through.into_iter().step_by(2).collect();
        mean_time(&leftward, 4).ok_or_else(|| Failure::Absent("the disc does not swing".into()))
    })
}

/// Creates a disc that rests on two points of the ground.
fn two_points(angle: f64, friction: FrictionLaw) -> Result<Scene, Failure> {
    let body = disc("barrel", RADIUS, MASS, 0.5 * RADIUS * RADIUS, Vec2::default());
    Ok(on_two_points(body, RADIUS, angle, interface(firm(0), friction))?.settled(1e-9)?)
}

fn leaves(angle: f64) -> Problem {
    let exact = tan(angle);
    setting(
        format!("rolling/leaves-cradle-{angle}"),
        format!(
            "disc on two frictionless points at ±{angle} rad, on ground whose acceleration grows"
        ),
        SOURCE,
    )
    .quantity(
        "ground acceleration at which the disc leaves one point",
        "g",
        relative(exact, 5e-3).fast(1.2e-2),
    )
    .at_border(0.02, move |push| {
        let mut scene = two_points(angle, FrictionLaw::Frictionless)?;
        let drive = Shake::Ramped { acceleration: push * GRAVITY, ramp: 0.5 };
        let mut left = false;
        scene.watch(&drive, step(0), 2.0, |state, _, _| {
            let place = state.poses[1].position.x - state.poses[0].position.x;
            left = place.abs() > 1e-3;
            if left { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(left)
    })
}

fn no_turn() -> Problem {
    setting(
        "rolling/cradle-holds",
        "disc on two rough points at ±0.5 rad, spun at 0.2 rad/s",
        SOURCE,
    )
    .quantity("spin after two seconds", "rad/s", absolute(0.0, 1e-6))
    .by(|_| {
        let mut scene = two_points(0.5, stick(0.5, 0))?;
        scene.state.twists[1].angular = 0.2;
        scene.run(&Still, step(0), 2.0)?;
        Ok(scene.state.twists[1].angular)
    })
}
