//! Balls that roll down a slope, move with side spin, or bounce, in three dimensions.

use std::ops::ControlFlow;

use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{Body, FrictionLaw, Nodes, NormalLaw, Spatial, Still, Vec3};

use super::{G, Role, STEP, STIFFNESS, firm, rough, scene};
use crate::problem::{absolute, relative, setting};
use crate::scene::{Scene, coulomb};
use crate::spatial::{ball, floor, gravity_on_slope, ground_of};
use crate::{Failure, Outcome, Problem};

const SOURCE: &str = "rigid-body dynamics of a homogeneous ball";
const RADIUS: f64 = 0.3;
const MASS: f64 = 10.0;
/// Azimuth (rad) of the downhill direction of the slopes; the direction is not parallel to a coordinate axis.
const HEADING: f64 = 0.5;

pub(super) fn problems() -> Vec<Problem> {
    let mut list = Vec::new();
    for (degrees, friction, acceleration, spin) in [
        (20.0, 0.2, 2.396_584_004, 7.988_613_348),
        (20.0, 0.08, 2.617_746_837, 6.145_589_740),
        (35.0, 0.1, 4.823_196_685, 6.696_567_962),
    ] {
        list.extend(incline(degrees, friction, acceleration, spin));
    }
    for role in [Role::Contactor, Role::Target] {
        for friction in [0.15, 0.5] {
            list.extend(carried(role, friction));
        }
    }
    list.extend(side_spin());
    list.extend(bounce());
    list
}

/// Creates a ball at rest on a floor, with gravity inclined as on a slope.
fn on_slope(radians: f64, friction: f64) -> Result<Scene<Spatial>, Failure> {
    let gravity = gravity_on_slope(G, radians, HEADING);
    let sunk = -MASS * gravity.z / STIFFNESS;
    let bodies = vec![floor(), ball(RADIUS, MASS, Vec3::new(0.0, 0.0, RADIUS - sunk))];
    scene(bodies, firm(STIFFNESS, MASS), rough(friction, STIFFNESS, MASS), gravity)
}

/// Returns the downhill component of a vector.
fn downhill(vector: Vec3) -> f64 {
    vector.dot(Vec3::new(cos(HEADING), sin(HEADING), 0.0))
}

fn incline(degrees: f64, friction: f64, acceleration: f64, spin: f64) -> [Problem; 2] {
    let title = format!("ball on a slope of {degrees}°, μ = {friction}");
    let run = move || -> Result<Scene<Spatial>, Failure> {
        let mut scene = on_slope(degrees.to_radians(), friction)?;
        scene.run(&Still, STEP, 1.0)?;
        Ok(scene)
    };
    [
        setting(format!("space-rolling/slope-{degrees}-{friction}-way"), title.clone(), SOURCE)
            .quantity("displacement down after 1 s", "m", relative(0.5 * acceleration, 1e-4))
            .by(move |_| Ok(downhill(run()?.state.poses[1].position))),
        setting(format!("space-rolling/slope-{degrees}-{friction}-spin"), title, SOURCE)
            .quantity("spin after 1 s", "rad/s", relative(spin, 1e-4))
            .by(move |_| {
                let spin = run()?.state.twists[1].angular;
                // The ball rotates about the horizontal axis across the slope.
                let across = Vec3::new(-sin(HEADING), cos(HEADING), 0.0);
                Ok(spin.dot(across))
            }),
    ]
}

/// Radius (m) of the large ball that represents the floor if the rolling ball is the target of the contact pair.
const EARTH: f64 = 1e5;

/// Creates a ball on a slope for the problems of [`carried`]; `role` is the role of the ball in the contact pair.
fn rolling(role: Role, friction: f64) -> Result<Scene<Spatial>, Failure> {
    let gravity = gravity_on_slope(G, 20_f64.to_radians(), HEADING);
    let stiffness = 1e7;
    let sunk = -MASS * gravity.z / stiffness;
    let mut ball = ball(RADIUS, MASS, Vec3::new(0.0, 0.0, RADIUS - sunk));
    let ground = match role {
        Role::Contactor => floor(),
        Role::Target => {
            ball.nodes = Vec::new();
            let center = Vec3::new(0.0, 0.0, -EARTH);
            let round = Nodes::Rolling { center, radius: EARTH, tributary_length: 1.0 };
            Body { nodes: vec![round], ..ground_of(Vec::new()) }
        }
    };
    let friction = coulomb(friction, stiffness, 2e3);
    scene(vec![ground, ball], firm(stiffness, MASS), friction, gravity)
}

/// Creates the problems of a ball that rolls a long distance as contactor or as target. The tangential spring of the
/// contact then moves over the floor or over the surface of the ball, and the forces must be the same for both roles.
fn carried(role: Role, friction: f64) -> [Problem; 3] {
    let (name, place) = match role {
        Role::Contactor => ("contactor", 10.784_628),
        Role::Target => ("target", 10.785_161),
    };
    let title = format!("ball as {name} on a slope of 20°, μ = {friction}, for 3 s");
    // Forces after initial vibrations have decayed.
    let forces = move |measure: fn(f64, f64, f64) -> f64| -> Result<f64, Failure> {
        let mut scene = rolling(role, friction)?;
        let mut worst = 0.0_f64;
        scene.watch(&Still, 5e-5, 3.0, |state, scratch, _| {
            for contact in scratch.contacts.iter().filter(|_| state.time > 0.1) {
                let (normal, friction) = (contact.normal_force, contact.friction_force);
                worst = worst.max(measure(normal, friction.length(), friction.dot(contact.normal)));
            }
            ControlFlow::Continue(())
        })?;
        Ok(worst)
    };
    [
        setting(format!("space-rolling/carried-{name}-{friction}-forces"), title.clone(), SOURCE)
            .quantity(
                "largest relative error of normal force and friction",
                "",
                absolute(0.0, 1e-3),
            )
            .by(move |_| {
                let error = |normal: f64, friction: f64, _: f64| {
                    (normal / 92.183_85 - 1.0).abs().max((friction / 9.586_76 - 1.0).abs())
                };
                forces(error)
            }),
        setting(
            format!("space-rolling/carried-{name}-{friction}-tangential"),
            title.clone(),
            SOURCE,
        )
        .quantity(
            "largest component of the friction force along the normal",
            "N",
            absolute(0.0, 1e-9),
        )
        .by(move |_| forces(|_, _, along| along.abs())),
        setting(format!("space-rolling/carried-{name}-{friction}-way"), title, SOURCE)
            .quantity("displacement down after 3 s", "m", relative(place, 1e-4))
            .by(move |_| {
                let mut scene = rolling(role, friction)?;
                scene.run(&Still, 5e-5, 3.0)?;
                Ok(downhill(scene.state.poses[1].position))
            }),
    ]
}

/// Creates the problems of a ball that slips obliquely: the center of the ball moves on a parabola, then along a
/// straight line.
fn side_spin() -> [Problem; 3] {
    let title = "ball thrown along x with spin (6, 4, 7) rad/s, μ = 0.2";
    let source = "the slip keeps its direction; Coriolis 1835";
    let run = |end: f64| -> Result<Scene<Spatial>, Failure> {
        let mut scene = on_slope(0.0, 0.2)?;
        scene.state.twists[1].linear = Vec3::new(2.0, 0.0, 0.0);
        scene.state.twists[1].angular = Vec3::new(6.0, 4.0, 7.0);
        scene.run(&Still, STEP, end)?;
        Ok(scene)
    };
    let off = move |end: f64, x: f64, y: f64| -> Result<Outcome, Failure> {
        let place = run(end)?.state.poses[1].position;
        let off = Vec3::new(place.x - x, place.y - y, 0.0).length();
        Ok(Outcome::of(off).noted(format!("at ({:.7}, {:.7}) m", place.x, place.y)))
    };
    [
        setting("space-rolling/side-spin-rolls", title, source)
            .quantity(
                "distance from the exact position at which the ball begins to roll",
                "m",
                absolute(0.0, 1e-5),
            )
            .by(move |_| off(0.286_846_011_4, 0.540_909_62, -0.073_760_40)),
        setting("space-rolling/side-spin-place", title, source)
            .quantity("distance from the exact position after 1.5 s", "m", absolute(0.0, 1e-5))
            .by(move |_| off(1.5, 2.689_925_26, -0.697_668_17)),
        setting("space-rolling/side-spin-spin", title, source)
            .quantity("error of the spin after 1.5 s", "rad/s", absolute(0.0, 1e-4))
            .by(move |_| {
                let spin = run(1.5)?.state.twists[1].angular;
                let exact = Vec3::new(1.714_285_7, 5.904_761_9, 7.0);
                Ok((spin - exact).length())
            }),
    ]
}

/// Creates the problems of a ball that bounces while it slides, so that the friction force is always μ times the normal
/// force.
fn bounce() -> [Problem; 3] {
    let problem = |name: &'static str,
                   quantity: &'static str,
                   unit: &'static str,
                   exact: f64,
                   of: fn(&Scene<Spatial>) -> f64| {
        setting(
            format!("space-rolling/bounce-{name}"),
            "ball of 10 kg that bounces with a spin of 30 rad/s, μ = 0.05",
            "impulse of a half-damped spring; Candia, de la Llera and Almazán 2008",
        )
        .quantity(quantity, unit, relative(exact, 1e-4))
        .by(move |_| {
            let radius = 0.1;
            let mut ball = ball(radius, 10.0, Vec3::new(0.0, 0.0, radius));
            ball.twist.linear = Vec3::new(3.0, 1.0, -2.0);
            ball.twist.angular = Vec3::new(0.0, 30.0, 0.0);
            // The contact is so stiff that the penetration hardly changes the lever arm.
            let law = NormalLaw::SpeedGap { stiffness: 1e12, damping: 4e5 };
            // The slip is far above the velocity of regularization.
            let sliding = FrictionLaw::Regularized { coefficient: 0.05, velocity: 1e-6 };
            let mut scene = scene(vec![floor(), ball], law, sliding, Vec3::default())?;
            scene.run(&Still, 1e-9, 2e-5)?;
            Ok(of(&scene))
        })
    };
    [
        problem("up", "upward speed after the bounce", "m/s", 1.817_774_060_7, |scene| {
            scene.state.twists[1].linear.z
        }),
        problem("aside", "speed along y after the bounce", "m/s", 0.809_111_297_0, |scene| {
            scene.state.twists[1].linear.y
        }),
        problem("spin", "spin about x after the bounce", "rad/s", -4.772_217_575_9, |scene| {
            scene.state.twists[1].angular.x
        }),
    ]
}
