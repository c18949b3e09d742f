//! Sliding and spinning blocks and rings: the friction limit must not depend on the direction of the slip.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::{Drive, Quaternion, Spatial, Still, Vec3};

use super::{G, STEP, STIFFNESS, down, firm, rough, scene};
use crate::problem::{absolute, relative, setting};
use crate::scene::Scene;
use crate::spatial::{corners, floor, free, gravity_on_slope, points, yaw};
use crate::{Failure, Problem};

const MASS: f64 = 100.0;
/// Half-lengths (m) of the sides of the block's footprint.
const HALF: (f64, f64) = (0.7365, 0.27);

pub(super) fn problems() -> Vec<Problem> {
    let mut list = circle().into();
    let mut add = |problems: Vec<Problem>| Vec::append(&mut list, &mut { problems });
    add([0.0, 17.0, 45.0].into_iter().flat_map(slope).collect());
    add(spinning(0.0, (0.170_890, -0.002_845), 0.307_76, 0.191_920).into());
    add(spinning(0.3, (0.173_191, -0.012_148), 0.311_64, 0.199_870).into());
    add(ring().into());
    add(circling().into());
    list
}

/// Creates a block that stands on its lower corners, which are `height` (m) below the center of mass.
fn block(
    friction: f64,
    height: f64,
    turned: f64,
    gravity: Vec3,
) -> Result<Scene<Spatial>, Failure> {
    let upright = MASS * (HALF.0 * HALF.0 + HALF.1 * HALF.1) / 3.0;
    sliding(
        points(&corners(HALF.0, HALF.1, -height)),
        4.0,
        upright,
        friction,
        height,
        turned,
        gravity,
    )
}

/// Creates a body that stands on feet and has a moment of inertia (kg·m²) about the vertical.
fn sliding(
    feet: barrelstack_dynamics::Nodes<Spatial>,
    count: f64,
    upright: f64,
    friction: f64,
    height: f64,
    turned: f64,
    gravity: Vec3,
) -> Result<Scene<Spatial>, Failure> {
    let (stiffness, share) = (STIFFNESS / count, MASS / count);
    let sunk = -MASS * gravity.z / STIFFNESS;
    let inertia = Vec3::new(0.6 * upright, 0.7 * upright, upright);
    let mut body = free("block", MASS, inertia, Vec3::new(0.0, 0.0, height - sunk));
    body.pose.orientation = yaw(turned);
    body.nodes = vec![feet];
    let friction = rough(friction, stiffness, share);
    scene(vec![floor(), body], firm(stiffness, share), friction, gravity)
}

/// Returns the rotation (rad) of a body about the vertical.
fn turn(orientation: Quaternion) -> f64 {
    2.0 * barrelstack_dynamics::math::atan2(orientation.v.z, orientation.w)
}

/// Returns the time (s) at which the body first reverses its motion, that is, at which `speed` (m/s or rad/s) changes
/// sign.
fn stops(
    scene: &mut Scene<Spatial>,
    end: f64,
    speed: impl Fn(Vec3, Vec3) -> f64,
) -> Result<f64, Failure> {
    let (mut before, mut found) = ((0.0, f64::INFINITY), None);
    scene.watch(&Still, STEP, end, |state, _, _| {
        let now = speed(state.twists[1].linear, state.twists[1].angular);
        if now <= 0.0 && found.is_none() {
            let (time, speed) = before;
            found = Some(time + (state.time - time) * speed / (speed - now));
        }
        before = (state.time, now);
        ControlFlow::Continue(())
    })?;
    found.ok_or_else(|| Failure::Absent("the body does not stop".into()))
}

const COULOMB: &str = "Coulomb friction opposite to the slip";

fn circle() -> [Problem; 3] {
    let title = "block thrown obliquely to its edges, μ = 0.4";
    let exact = 0.509_683_995_9;
    let thrown = || -> Result<(Scene<Spatial>, f64), Failure> {
        let mut scene = block(0.4, 0.0, 0.0, down())?;
        scene.state.twists[1].linear = Vec3::new(1.2, 1.6, 0.0);
        let time = stops(&mut scene, 0.6, |v, _| 0.6 * v.x + 0.8 * v.y)?;
        Ok((scene, time))
    };
    [
        setting("space-sliding/circle-time", title, COULOMB)
            .quantity("time until the body stops", "s", absolute(exact, 1e-4))
            .by(move |_| Ok(thrown()?.1)),
        setting("space-sliding/circle-way", title, COULOMB)
            .quantity("distance until the body stops", "m", absolute(exact, 1e-4))
            .by(move |_| {
                let place = thrown()?.0.state.poses[1].position;
                Ok(Vec3::new(place.x, place.y, 0.0).length())
            }),
        setting("space-sliding/circle-direction", title, COULOMB)
            .quantity(
                "error of the direction of the displacement, or rotation of the body",
                "rad",
                absolute(0.0, 1e-6),
            )
            .by(move |_| {
                let pose = thrown()?.0.state.poses[1];
                let aside = 0.6 * pose.position.y - 0.8 * pose.position.x;
                let along = 0.6 * pose.position.x + 0.8 * pose.position.y;
                Ok((aside / along).abs().max(turn(pose.orientation).abs()))
            }),
    ]
}

fn slope(degrees: f64) -> [Problem; 2] {
    let title = format!("block at an azimuth of {degrees}° on a slope of 25°, μ = 0.3");
    let start = move || -> Result<Scene<Spatial>, Failure> {
        let gravity = gravity_on_slope(G, 25_f64.to_radians(), 0.0);
        block(0.3, 0.15, degrees.to_radians(), gravity)
    };
    [
        setting(format!("space-sliding/slope-{degrees}-acceleration"), title.clone(), COULOMB)
            .quantity(
                "acceleration after the block has begun to slip",
                "m/s2",
                relative(2.0 * 0.739_310_665_2, 1e-4),
            )
            .by(move |_| {
                let mut scene = start()?;
                scene.run(&Still, STEP, 0.5)?;
                let before = scene.state.twists[1].linear.x;
                scene.run(&Still, STEP, 1.0)?;
                Ok((scene.state.twists[1].linear.x - before) / 0.5)
            }),
        setting(format!("space-sliding/slope-{degrees}-turn"), title, COULOMB)
            .quantity(
                "rotation, and ratio of lateral to downhill displacement",
                "rad",
                absolute(0.0, 1e-4),
            )
            .by(move |_| {
                let mut scene = start()?;
                scene.run(&Still, STEP, 1.0)?;
                let pose = scene.state.poses[1];
                let turned = (turn(pose.orientation) - degrees.to_radians()).abs();
                Ok(turned.max((pose.position.y / pose.position.x).abs()))
            }),
    ]
}

const QUADRATURE: &str = "sliding and spinning on four points, by quadrature";

fn spinning(turned: f64, place: (f64, f64), time: f64, spun: f64) -> [Problem; 3] {
    let title =
        format!("block at an azimuth of {turned} rad, thrown with 1 m/s and 2 rad/s, μ = 0.4");
    let run = move || -> Result<(Scene<Spatial>, f64), Failure> {
        let mut scene = block(0.4, 0.0, turned, down())?;
        scene.state.twists[1].linear = Vec3::new(1.0, 0.0, 0.0);
        scene.state.twists[1].angular = Vec3::new(0.0, 0.0, 2.0);
        let time = stops(&mut scene, 0.4, |v, _| v.x)?;
        Ok((scene, time))
    };
    [
        setting(format!("space-sliding/spinning-{turned}-time"), title.clone(), QUADRATURE)
            .quantity("time until the body stops", "s", absolute(time, 1e-4))
            .by(move |_| Ok(run()?.1)),
        setting(format!("space-sliding/spinning-{turned}-place"), title.clone(), QUADRATURE)
            .quantity(
                "distance from the exact position at which the body stops",
                "m",
                absolute(0.0, 2e-5),
            )
            .by(move |_| {
                let found = run()?.0.state.poses[1].position;
                let off = Vec3::new(found.x - place.0, found.y - place.1, 0.0);
                Ok(off.length())
            }),
        setting(format!("space-sliding/spinning-{turned}-turn"), title, QUADRATURE)
            .quantity("rotation until the body stops", "rad", absolute(spun, 2e-5))
            .by(move |_| Ok(turn(run()?.0.state.poses[1].orientation) - turned)),
    ]
}

/// Creates the problems of a ring that slides and spins: sliding reduces the friction that acts against the spin, and
/// spinning reduces the friction that acts against the sliding.
fn ring() -> [Problem; 3] {
    let title = "ring thrown at 1 m/s, spinning with a rim speed of 1.5 m/s, μ = 0.3";
    let source = "sliding ring: Farkas, Bartels, Unger and Wolf 2003";
    let run = || -> Result<(Scene<Spatial>, f64), Failure> {
        let (radius, count) = (0.3, 120);
        let at = |i: i32| {
            let angle = f64::from(i) * TAU / f64::from(count);
            Vec3::new(radius * cos(angle), radius * sin(angle), 0.0)
        };
        let feet = points(&(0..count).map(at).collect::<Vec<_>>());
        let upright = MASS * radius * radius;
        let mut scene = sliding(feet, f64::from(count), upright, 0.3, 0.0, 0.0, down())?;
        scene.state.twists[1].linear = Vec3::new(1.0, 0.0, 0.0);
        scene.state.twists[1].angular = Vec3::new(0.0, 0.0, 1.5 / radius);
        let time = stops(&mut scene, 0.7, |v, _| v.x)?;
        Ok((scene, time))
    };
    [
        setting("space-sliding/ring-time", title, source)
            .quantity("time until the body stops", "s", absolute(0.673_86, 2e-4))
            .by(move |_| Ok(run()?.1)),
        setting("space-sliding/ring-way", title, source)
            .quantity("distance until the body stops", "m", absolute(0.374_178, 2e-4))
            .by(move |_| Ok(run()?.0.state.poses[1].position.x)),
        setting("space-sliding/ring-turn", title, source)
            .quantity("rotation until the body stops", "rad", absolute(1.576_485, 2e-4))
            .by(move |_| Ok(turn(run()?.0.state.poses[1].orientation))),
    ]
}

/// Ground that moves in a circle; its acceleration (m/s²) rotates at the angular velocity ω (rad/s).
struct Circling {
    acceleration: f64,
    omega: f64,
}

impl Drive<Spatial> for Circling {
    fn at(&self, time: f64) -> (Vec3, Vec3) {
        let Self { acceleration, omega } = *self;
        let (sin, cos) = (sin(omega * time), cos(omega * time));
        let (place, speed) = (-acceleration / (omega * omega), acceleration / omega);
        (Vec3::new(place * cos, place * sin, 0.0), Vec3::new(speed * sin, -speed * cos, 0.0))
    }
}

/// Creates the problems of a block that slips steadily on ground that moves in a circle.
fn circling() -> [Problem; 2] {
    let problem = |name: &str, time: f64, place: (f64, f64)| {
        setting(
            format!("space-sliding/circling-{name}"),
            format!(
                "block on ground that moves in a circle with 5 m/s² and 1 Hz, μ = 0.3, after \
                 {time} s"
            ),
            "steady slip: friction moves the block in a circle, too",
        )
        .quantity(
            "distance from the exact position relative to the ground",
            "m",
            absolute(0.0, 1e-4),
        )
        .by(move |_| {
            let drive = Circling { acceleration: 5.0, omega: TAU };
            let mut scene = block(0.3, 0.0, 0.0, down())?;
            let (start, carried) = drive.at(0.0);
            scene.state.poses[1].position += start;
            scene.state.twists[1].linear =
                carried + Vec3::new(-0.378_660_336_5, 0.520_078_597_1, 0.0);
            let from = scene.state.poses[1].position - start;
            scene.run(&drive, STEP, time)?;
            let slip = scene.state.poses[1].position - scene.state.poses[0].position - from;
            let off = Vec3::new(slip.x - place.0, slip.y - place.1, 0.0);
            Ok(off.length())
        })
    };
    [
        problem("quarter", 0.25, (-0.143_038_743_8, 0.022_507_415_2)),
        problem("turn", 1.0, (0.0, 0.0)),
    ]
}
