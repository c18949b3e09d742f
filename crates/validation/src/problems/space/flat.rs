//! Three-dimensional bodies in face or line contact with the floor or with each other: rest, rocking and rolling.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;

use barrelstack_dynamics::math::{asin, atan, cos, sin};
use barrelstack_dynamics::solid::{Barrel, Capsule, Hull};
use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{
    Body, FrictionLaw, Motion, NormalLaw, Quaternion, Spatial, Still, Vec3,
};

use super::{G, STEP, axis, down, firm, rough, scene, upright};
use crate::problem::{absent, relative, setting};
use crate::scene::Scene;
use crate::spatial::{floor, gravity_on_slope, solid, yaw};
use crate::swing::{mean_time, run_crossings};
use crate::{Failure, Problem, theory};

/// Mass (kg) of the bodies.
const MASS: f64 = 269.0;
/// Moment of inertia (kg·m²) of the barrel about its axis.
const ABOUT: f64 = 14.1;
/// Moment of inertia (kg·m²) of the barrel about a transverse axis.
const ACROSS: f64 = 22.6;
/// Half the length (m) of the barrel.
const HALF: f64 = 0.4725;
/// Radius (m) of the flat part of the head of the barrel.
const HEAD: f64 = 0.269_982_558_045_203;
/// Stiffness (N/m) of a contact, low enough for measurable deformations.
const SOFT: f64 = 1e6;

pub(super) fn problems() -> Vec<Problem> {
    vec![
        stands(1),
        stands(2),
        springs("barrel", "barrel on its head that rocks on its springs", barrel_on_springs),
        springs("tube", "tube on the floor that pitches on its ends", tube_on_springs),
        rocks("time"),
        rocks("rate"),
        groove(),
        rolls(0.0),
        rolls(30.0),
    ]
}

fn barrel(name: &str, height: f64, rounding: f64) -> Result<Body<Spatial>, Failure> {
    let shape = Barrel::new(2.0 * HALF, 0.2775, 0.345, rounding).map_err(absent)?;
    let inertia = Vec3::new(ABOUT, ACROSS, ACROSS);
    let place = Vec3::new(0.0, 0.0, height);
    let mut body = solid(name, Hull::Barrel(shape), MASS, inertia, place);
    body.pose.orientation = upright(0.0);
    Ok(body)
}

fn spring() -> NormalLaw {
    NormalLaw::KelvinVoigt { stiffness: SOFT, damping: 0.0 }
}

/// Creates the problem of barrels that are stacked on their heads.
fn stands(count: u32) -> Problem {
    let exact: f64 = (1..=count).map(|above| f64::from(above) * MASS * G / (4.0 * SOFT)).sum();
    setting(
        format!("space-flat/stands-{count}"),
        format!("{count} barrels that stand on their heads, one on top of the other"),
        "disc on four springs",
    )
    .quantity("settlement of the top barrel", "m", relative(exact, 1e-6))
    .by(move |_| {
        let mut bodies = vec![floor()];
        for level in 0..count {
            let height = HALF * (1.0 + 2.0 * f64::from(level));
            bodies.push(barrel(&format!("barrel {level}"), height - 1e-4, 0.01)?);
        }
        let law = firm(SOFT, MASS);
        let friction = rough(0.5, SOFT, MASS);
        let scene = scene(bodies, law, friction, down())?.settled(1e-10)?;
        let top = HALF * (2.0 * f64::from(count) - 1.0);
        Ok(top - scene.state.poses[count as usize].position.z)
    })
}

/// Returns the period (s) with which one component of the axis of body 1 oscillates.
fn period(mut scene: Scene<Spatial>, of: fn(Vec3) -> f64, guess: f64) -> Result<f64, Failure> {
    let through =
        run_crossings(&mut scene, 1e-5, 5.3 * guess, |state| of(axis(state.poses[1].orientation)))?;
    let half =
        mean_time(&through, 2).ok_or_else(|| Failure::Absent("the body does not rock".into()))?;
    Ok(2.0 * half)
}

/// Returns a barrel on its head that rocks on its contact springs, and the exact period.
///
/// Without friction the barrel rotates about its center of mass; it bears on the flat part of its head, inside the
/// rounded chime.
fn barrel_on_springs() -> Swing {
    let sunk = MASS * G / (4.0 * SOFT);
    let square = (2.0 * SOFT * HEAD * HEAD - MASS * G * (HALF - 0.01)) / ACROSS;
    let start = || {
        let mut body = barrel("barrel", HALF - sunk, 0.01)?;
        // The whole head is in contact.
        body.pose.orientation = upright(0.3 * sunk / HEAD);
        scene(vec![floor(), body], spring(), FrictionLaw::Frictionless, down())
    };
    (TAU / square.sqrt(), start())
}

fn tube_on_springs() -> Swing {
    let half = 0.7;
    let sunk = MASS * G / (2.0 * SOFT);
    let shape = Hull::Capsule(Capsule { half_length: half, radius: 0.1 });
    let inertia = Vec3::new(1.3, 50.0, 50.0);
    let mut body = solid("tube", shape, MASS, inertia, Vec3::new(0.0, 0.0, 0.1 - sunk));
    body.pose.orientation = Quaternion::turn(Vec3::new(0.0, 0.3 * sunk / half, 0.0));
    // The round ends of the tube roll, so its weight has no overturning moment.
    let square = 2.0 * SOFT * half * half / inertia.y;
    let scene = scene(vec![floor(), body], spring(), FrictionLaw::Frictionless, down());
    (TAU / square.sqrt(), scene)
}

/// The exact period (s), and a scene in which the period is measured.
type Swing = (f64, Result<Scene<Spatial>, Failure>);

fn springs(name: &str, title: &str, start: fn() -> Swing) -> Problem {
    let of: fn(Vec3) -> f64 = if name == "barrel" { |axis| axis.x } else { |axis| axis.z };
    let (exact, _) = start();
    setting(
        format!("space-flat/springs-{name}"),
        title,
        "rigid body on equal springs, reduced by the overturning moment of its weight",
    )
    .quantity("period", "s", relative(exact, 1e-4))
    .by(move |_| period(start().1?, of, exact))
}

/// Creates the problem of a barrel that is released while it leans on the rim of its head, at half the angle of
/// unstable equilibrium.
fn rocks(which: &'static str) -> Problem {
    // An almost sharp rim.
    let rounding = 1e-6;
    let (half, head) = (HALF - rounding, 0.2775 - 0.43 * rounding);
    let alpha = atan(head / half);
    let square = half * half + head * head;
    let rate = (MASS * G * square.sqrt() / (ACROSS + MASS * square)).sqrt();
    let (quantity, unit, exact) = if which == "time" {
        ("time until the barrel stands upright", "s", theory::quarter_period(alpha, 0.5) / rate)
    } else {
        let fall = 2.0 * (cos(0.5 * alpha) - cos(alpha));
        ("angular velocity when the barrel is upright", "rad/s", rate * fall.sqrt())
    };
    setting(
        format!("space-flat/rocks-{which}"),
        "barrel that is released on the rim of its head at half its slenderness angle",
        "Housner 1963, exact equation, for a block as wide as the head",
    )
    .quantity(quantity, unit, relative(exact, 1e-3))
    .by(move |_| {
        let stiffness = 1e9;
        let lean = 0.5 * alpha;
        let height = half * cos(lean) + head * sin(lean) + rounding;
        let mut body = barrel("barrel", height - MASS * G / stiffness, rounding)?;
        body.pose.orientation = upright(lean);
        let (law, friction) = (firm(stiffness, MASS), rough(20.0, stiffness, MASS));
        let mut scene = scene(vec![floor(), body], law, friction, down())?;
        let (mut found, mut before) = (None, (0.0, lean, 0.0));
        scene.watch(&Still, 1e-5, 2.0, |state, _, _| {
            let axis = axis(state.poses[1].orientation);
            let (lean, rate) = (asin(axis.x), state.twists[1].angular.y);
            // Measured shortly before the barrel stands, while the middle of the head is not yet in contact.
            let level = 2e-4;
            if lean < level {
                let part = (before.1 - level) / (before.1 - lean);
                let now = before.0 + part * (state.time - before.0);
                let rate = before.2 + part * (rate - before.2);
                found = Some((now - level / rate, -rate));
                return ControlFlow::Break(());
            }
            before = (state.time, lean, rate);
            ControlFlow::Continue(())
        })?;
        let (time, rate) =
            found.ok_or_else(|| Failure::Absent("the barrel does not fall".into()))?;
        Ok(if which == "time" { time } else { rate })
    })
}

/// Creates the problem of a tube that lies in the groove between two other tubes, in line contact.
fn groove() -> Problem {
    let (radius, aside) = (0.05, 0.06);
    let slope = asin(aside / (2.0 * radius));
    let exact = 2.0 * radius * cos(slope) - {
        // Each line contact is two springs; the tube sinks by their deformation along the inclined normals.
        let pressed = |sunk: f64| {
            let height = 2.0 * radius * cos(slope) - sunk;
            let apart = (height * height + aside * aside).sqrt();
            4.0 * SOFT * (2.0 * radius - apart) * height / apart
        };
        let (mut low, mut high) = (0.0, 0.01);
        for _ in 0..60 {
            let sunk = 0.5 * (low + high);
            if pressed(sunk) < MASS * G { low = sunk } else { high = sunk }
        }
        low
    };
    setting(
        "space-flat/groove",
        "tube in the groove between two shorter parallel tubes",
        "equilibrium of springs at the ends of both lines",
    )
    .quantity(
        "height of the axis of the tube above the axes of the others",
        "m",
        relative(exact, 1e-6),
    )
    .by(move |_| {
        let shape = |half_length| Hull::Capsule(Capsule { half_length, radius });
        let side = |name: &str, y: f64| Body {
            motion: Motion::Prescribed,
            ..solid(name, shape(0.4), 1.0, Vec3::new(1.0, 1.0, 1.0), Vec3::new(0.0, y, 0.0))
        };
        let place = Vec3::new(0.0, 0.0, 2.0 * radius * cos(slope));
        let tube = solid("tube", shape(0.6), MASS, Vec3::new(0.4, 40.0, 40.0), place);
        let bodies = vec![tube, side("left", -aside), side("right", aside)];
        // Friction would carry a part of the load.
        let law = firm(SOFT, MASS);
        let scene = scene(bodies, law, FrictionLaw::Frictionless, down())?.settled(1e-10)?;
        Ok(scene.state.poses[0].position.z)
    })
}

/// Creates the problem of a tube that rolls down a slope. Its motion must not depend on the azimuth of the slope.
fn rolls(degrees: f64) -> Problem {
    let (radius, half_length) = (0.1, 0.7);
    let slope = 5.0_f64.to_radians();
    let inertia = Vec3::new(0.5 * MASS * radius * radius, 45.0, 45.0);
    let exact = G * sin(slope) / (1.0 + inertia.x / (MASS * radius * radius));
    setting(
        format!("space-flat/rolls-{degrees}"),
        format!("tube that rolls down a slope of 5°, with the scene rotated by {degrees}°"),
        "g sin θ / (1 + I / (m r²))",
    )
    .quantity("acceleration", "m/s2", relative(exact, 1e-4))
    .by(move |_| {
        let heading = degrees.to_radians();
        let gravity = gravity_on_slope(G, slope, heading);
        let stiffness = 1e8;
        let height = radius + MASS * gravity.z / (2.0 * stiffness);
        let shape = Hull::Capsule(Capsule { half_length, radius });
        let mut body = solid("tube", shape, MASS, inertia, Vec3::new(0.0, 0.0, height));
        body.pose.orientation = yaw(heading + FRAC_PI_2);
        let laws = (firm(stiffness, MASS), rough(0.5, stiffness, MASS));
        let mut scene = scene(vec![floor(), body], laws.0, laws.1, gravity)?;
        let toward = Vec3::new(cos(heading), sin(heading), 0.0);
        scene.run(&Still, STEP, 0.3)?;
        let before = scene.state.twists[1].linear.dot(toward);
        scene.run(&Still, STEP, 0.8)?;
        Ok((scene.state.twists[1].linear.dot(toward) - before) / 0.5)
    })
}
