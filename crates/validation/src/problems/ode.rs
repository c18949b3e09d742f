//! Smooth motions, compared with independent equations of motion that a library solves.
//!
//! In some problems the equations are those of rigid bodies, which the contact model approaches as the contact becomes
//! stiffer. In the other problems they contain the contact springs and dampers; there, the program differs from the
//! solution only by the error of its time steps.

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{acos, atan2, cos, sin};
use barrelstack_dynamics::shape::Cradle;
use barrelstack_dynamics::{FrictionLaw, NormalLaw, Shape, Still, Vec2};

use crate::drive::{Both, Shake};
use crate::ode::solution;
use crate::oracle::Rocker;
use crate::problem::{relative, setting};
use crate::rocking::{Corner, RockingBlock};
use crate::scene::{
    DOWN, Scene, block, centered, coulomb, disc, floor, ground_of, interface, points, pose,
};
use crate::{Failure, GRAVITY, Problem, theory};

use super::housner::firm;

const SOURCE: &str =
    "equations of motion, solved by the library differential-equations 0.7, DOP853";
const MASS: f64 = 100.0;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        rocking("leaning", (0.25, 6.0, 0.3)),
        rocking("over", (0.40, 5.0, 0.6)),
        corner(),
        springs(),
        pendulum(),
        bowl(),
        flight(),
        own_lean(),
        own_peak(),
    ]
}

/// Returns the velocity (m/s) and the displacement (m) of ground that starts at rest and has the acceleration `a sin
/// ωt`.
fn ground(a: f64, omega: f64, t: f64) -> (f64, f64) {
    let velocity = a / omega * (1.0 - cos(omega * t));
    (velocity, a / omega * (t - sin(omega * t) / omega))
}

/// Returns the equations of motion of a block of half-diagonal R = 1 m that rocks on a corner under a ground
/// acceleration (m/s²): the rates of rotation and angular velocity.
fn leaning(alpha: f64, acceleration: impl Fn(f64) -> f64) -> impl Fn(f64, &[f64; 2]) -> [f64; 2] {
    // Moments about the corner: I θ″ = −m R [g sin(α − θ) + a cos(α − θ)] with I = 4/3 m R².
    move |t, y| {
        let from_upright = alpha - y[0];
        let moment = GRAVITY * sin(from_upright) + acceleration(t) * cos(from_upright);
        [y[1], -0.75 * moment]
    }
}

/// Creates the problem of a block that rocks on one corner under one sine cycle of ground acceleration with the
/// amplitude `push` (g).
///
/// Depending on the parameters, the block stays near its unstable equilibrium or overturns.
fn rocking(name: &str, (alpha, omega, push): (f64, f64, f64)) -> Problem {
    let (radius, until) = (1.0, 1.0);
    let rates = leaning(alpha, move |t| -push * GRAVITY * sin(omega * t));
    let exact = solution(rates, [0.5 * alpha, 0.0], (0.0, until))[0];
    setting(
        format!("ode/rocking-{name}"),
        format!(
            "block of α = {alpha} released at φ = 0.5, ground acceleration with a sine of {push} \
             g, {omega} rad/s"
        ),
        SOURCE,
    )
    .quantity("rotation after 1 s, without impact", "rad", relative(exact, 1e-4).fast(1e-3)) // measured 2.1e-6 and 1.3e-4
    .refined(move |effort, level| {
        let block = firm(effort, radius, alpha).refined(level - 1);
        let acceleration = -push * GRAVITY;
        let drive = Shake::Sine { acceleration, omega, half_waves: 2.0 };
        let mut scene = block.scene(0.5 * alpha)?;
        scene.run(&drive, block.step(), until)?;
        Ok(-scene.state.poses[1].orientation)
    })
}

/// Creates the problem of a block on a soft corner, with the full equations of the springs and dampers in the normal
/// and tangential directions.
fn corner() -> Problem {
    let (alpha, omega, push, until) = (0.25, 6.0, 0.3, 0.8);
    let block = RockingBlock {
        corner: Corner::KelvinVoigt,
        contact_frequency: 200.0,
        damping_ratio: 0.1,
        ..RockingBlock::new(1.0, alpha)
    };
    let (k, c) = (200.0 * 200.0, 2.0 * 0.1 * 200.0); // per unit of mass
    let (width, height) = (sin(alpha), cos(alpha));
    // The state is x, z and angle of the block, their rates, and the elongation of the tangential (sticking) spring.
    // Contact force and velocities are evaluated at the point of the floor below the corner.
    let rates = move |t: f64, y: &[f64; 7]| {
        let [_, z, angle, vx, vz, spin, stick] = *y;
        let (right, up) =
            (width * cos(angle) + height * sin(angle), width * sin(angle) - height * cos(angle));
        let slip = vx + spin * z - ground(-push * GRAVITY, omega, t).0;
        let press = (-k * (z + up) - c * (vz + spin * right)).max(0.0);
        let drag = k * stick + c * slip;
        // I = m R²/3 about the center.
        let turn = 3.0 * (right * press - z * drag);
        [vx, vz, spin, -drag, press - GRAVITY, turn, slip]
    };
    let lean = 0.5 * alpha;
    let start = cos(alpha - lean) - GRAVITY / k;
    let exact = solution(rates, [0.0, start, -lean, 0.0, 0.0, 0.0, 0.0], (0.0, until))[2];
    setting(
        "ode/corner-springs",
        "block of α = 0.25 at φ = 0.5 on a soft, lightly damped corner (200 rad/s, ζ = 0.1)",
        SOURCE,
    )
    .quantity(
        "rotation after 0.8 s on ground with a sine of 0.3 g, 6 rad/s",
        "rad",
        relative(exact, 1e-6).fast(1e-4),
    ) // measured 1.5e-7 and 2.5e-6
    .refined(move |_, level| {
        let acceleration = -push * GRAVITY;
        let drive = Shake::Sine { acceleration, omega, half_waves: 2.0 };
        let mut scene = block.scene(lean)?;
        scene.run(&drive, 4e-4 / 2.0_f64.powi(level), until)?;
        Ok(scene.state.poses[1].orientation)
    })
}

/// Creates the problem of a block that bounces and pitches on two springs without leaving them, on a floor that moves
/// vertically.
fn springs() -> Problem {
    let (half_width, half_height, until) = (0.4, 0.3, 1.0);
    let (frequency, zeta) = (60.0, 0.02);
    let (stiffness, damping) = (MASS * frequency * frequency, 2.0 * zeta * MASS * frequency);
    let (push, omega) = (1.5, 40.0);
    let (start, tilt) = (half_height - 0.8 * MASS * GRAVITY / (2.0 * stiffness), 1e-3);
    let inertia = MASS * (half_width * half_width + half_height * half_height) / 3.0;
    // Coordinates of a corner relative to the center: to the right, and upward.
    let corner = move |side: f64, angle: f64| {
        (
            side * half_width * cos(angle) + half_height * sin(angle),
            side * half_width * sin(angle) - half_height * cos(angle),
        )
    };
    let rates = move |t: f64, y: &[f64; 4]| {
        let [z, angle, rise, spin] = *y;
        let (floor_rise, floor) = ground(push, omega, t);
        let (mut force, mut moment) = (0.0, 0.0);
        for side in [-1.0, 1.0] {
            let (right, up) = corner(side, angle);
            let press = stiffness * (floor - z - up) + damping * (floor_rise - rise - spin * right);
            force += press.max(0.0);
            moment += right * press.max(0.0);
        }
        [rise, spin, force / MASS - GRAVITY, moment / inertia]
    };
    let depth = move |z: f64, angle: f64| ground(push, omega, until).1 - z - corner(-1.0, angle).1;
    let [z, angle, ..] = solution(rates, [start, tilt, 0.0, 0.0], (0.0, until));
    let exact = depth(z, angle);
    setting(
        "ode/two-springs",
        "tilted block on two frictionless springs (60 rad/s, ζ = 0.02) on a floor that moves up \
         and down",
        SOURCE,
    )
    .quantity("penetration of the left corner after 1 s", "m", relative(exact, 1e-4).fast(1e-3)) // measured 2.3e-6 and 3.6e-5
    .refined(move |_, level| {
        let size = (2.0 * half_width, 2.0 * half_height);
        let body = block("block", size, MASS, pose(0.0, start, tilt));
        let law = NormalLaw::KelvinVoigt { stiffness, damping };
        let laws = interface(law, FrictionLaw::Frictionless);
        let mut scene = Scene::new(vec![floor(), body], laws, DOWN)?;
        let z = Shake::Sine { acceleration: push, omega, half_waves: 100.0 };
        let drive = Both { x: Shake::Cruise(0.0), z };
        scene.run(&drive, 4e-4 / 2.0_f64.powi(level), until)?;
        let there = scene.state.poses[1];
        Ok(depth(there.position.z, there.orientation))
    })
}

/// Radius (m) of the cradle.
const CRADLE: f64 = 0.6;
/// Radius (m) of the disc that lies in the cradle.
const DISC: f64 = 0.35;

/// Creates a solid disc in a wide cradle, displaced by an angle (rad) from the bottom and at its static penetration.
/// Returns the scene and its time step (s).
///
/// Each refinement has a stiffer contact and a shorter step.
fn cradled(angle: f64, friction: f64, level: i32) -> Result<(Scene, f64), Failure> {
    let stiffness = 1e8 * 4.0_f64.powi(level);
    let arm = CRADLE - DISC + MASS * GRAVITY * cos(angle) / stiffness;
    let center = Vec2::new(arm * sin(angle), -arm * cos(angle));
    let body = disc("disc", DISC, MASS, 0.5 * DISC * DISC, center);
    let cradle = ground_of(vec![centered(Shape::Cradle(Cradle::new(CRADLE, 1.5)))]);
    let damping = |zeta: f64| restitution::damping(stiffness, zeta, MASS);
    let law = NormalLaw::KelvinVoigt { stiffness, damping: damping(1.0) };
    let laws = interface(law, coulomb(friction, stiffness, damping(0.5)));
    Ok((Scene::new(vec![cradle, body], laws, DOWN)?, 1e-4 / 2.0_f64.powi(level)))
}

/// Returns the angle (rad) of the disc in its cradle, positive to the right.
fn angle_in_cradle(scene: &Scene) -> f64 {
    let place = scene.state.poses[1].position;
    atan2(place.x, -place.z)
}

/// Creates the problem of a disc that rolls without slip in a cradle, at large angles.
fn pendulum() -> Problem {
    let until = 1.1;
    let length = 1.5 * (CRADLE - DISC);
    let rates = move |_: f64, y: &[f64; 2]| [y[1], -GRAVITY / length * sin(y[0])];
    let exact = solution(rates, [1.0, 0.0], (0.0, until))[0];
    setting(
        "ode/cradle-pendulum",
        "solid disc released at 1 rad in a round cradle of 0.6 m, rolling",
        SOURCE,
    )
    .quantity("angle after 1.1 s", "rad", relative(exact, 1e-4).fast(1e-3)) // measured 2.4e-5 and 3.9e-4
    .refined(move |_, level| {
        let (mut scene, step) = cradled(1.0, 0.9, level)?;
        scene.run(&Still, step, until)?;
        Ok(angle_in_cradle(&scene))
    })
}

/// Creates the problem of a disc that climbs in its cradle and spins so fast that the contact always slips in the same
/// direction.
fn bowl() -> Problem {
    let (friction, spin, until) = (0.4, 40.0, 0.6);
    let arm = CRADLE - DISC;
    // m d φ″ = −m g sin φ − μN and I ω′ = −r μN, with N = m (g cos φ + d φ′²), I = ½ m r².
    let rates = move |_: f64, y: &[f64; 3]| {
        let press = GRAVITY * cos(y[0]) + arm * y[1] * y[1];
        let drag = friction * press;
        [y[1], (-GRAVITY * sin(y[0]) - drag) / arm, -2.0 * drag / DISC]
    };
    let exact = solution(rates, [0.0, 0.0, spin], (0.0, until))[0];
    setting(
        "ode/cradle-slip",
        "solid disc, μ = 0.4, set down in a round cradle of 0.6 m with a spin of 40 rad/s; it \
         slips",
        SOURCE,
    )
    .quantity("angle after 0.6 s", "rad", relative(exact, 1e-4).fast(1e-3)) // measured 2.7e-6 and 4.4e-5
    .refined(move |_, level| {
        let (mut scene, step) = cradled(0.0, friction, level)?;
        scene.state.twists[1].angular = spin;
        scene.run(&Still, step, until)?;
        Ok(angle_in_cradle(&scene))
    })
}

/// Creates the problem of a thrown body whose viscous drag, relative to shaking ground, couples translation and
/// rotation.
fn flight() -> Problem {
    let until = 1.0;
    let (inertia, push, omega) = (8.0, 3.0, 7.0);
    let drag = [[60.0, 10.0, 5.0], [10.0, 90.0, -8.0], [5.0, -8.0, 4.0]];
    let start = [2.0, 5.0, 3.0];
    let rates = move |_: f64, y: &[f64; 4]| {
        let force = |row: [f64; 3]| row[0] * y[1] + row[1] * y[2] + row[2] * y[3];
        let [x, z, turn] = drag.map(force);
        [y[1], -x / MASS, -GRAVITY - z / MASS, -turn / inertia]
    };
    let [x, ..] = solution(rates, [0.0, start[0], start[1], start[2]], (0.0, until));
    let exact = x - ground(push, omega, until).1;
    setting(
        "ode/flight",
        "thrown body with a full matrix of viscous drag relative to shaking ground",
        SOURCE,
    )
    .quantity("displacement along the ground after 1 s", "m", relative(exact, 1e-6).fast(1e-4)) // measured 2.8e-9 and 4.6e-8
    .refined(move |_, level| {
        let mut body = block("body", (0.5, 0.5), MASS, pose(0.0, 50.0, 0.0));
        body.inertia = inertia;
        body.damping = Some(drag);
        body.nodes = vec![points(&[])];
        let law = NormalLaw::KelvinVoigt { stiffness: 1e6, damping: 0.0 };
        let laws = interface(law, FrictionLaw::Frictionless);
        let mut scene = Scene::new(vec![floor(), body], laws, DOWN)?;
        let twist = &mut scene.state.twists[1];
        (twist.linear, twist.angular) = (Vec2::new(start[0], start[1]), start[2]);
        let drive = Shake::Sine { acceleration: push, omega, half_waves: 100.0 };
        scene.run(&drive, 2e-3 / 2.0_f64.powi(level), until)?;
        Ok(scene.relative(1))
    })
}

/// Returns the block of the module `statistics`, as input for the independent integrator of this crate.
fn rigid() -> Rocker {
    let alpha = 0.25;
    let restitution = theory::housner_restitution(alpha);
    Rocker { alpha, rate: theory::rocking_rate(1.0), restitution, slender: false }
}

/// Creates the problem that verifies the independent rigid-block integrator of this crate over an interval without
/// impact.
fn own_lean() -> Problem {
    let (omega, push, until) = (6.0, 0.3, 1.0);
    let rigid = rigid();
    let acceleration = move |t: f64| -push * GRAVITY * sin(omega * t);
    let rates = leaning(rigid.alpha, acceleration);
    let start = 0.5 * rigid.alpha;
    let exact = solution(rates, [start, 0.0], (0.0, until))[0];
    setting(
        "ode/own-integrator-lean",
        "the problem ode/rocking-leaning, solved by the integrator for rigid blocks of this crate, \
         in steps of at most 10 ms",
        SOURCE,
    )
    .quantity("rotation after 1 s, without impact", "rad", relative(exact, 1e-8).fast(1e-6)) // measured 6.6e-11 and 1.7e-8
    .refined(move |_, level| {
        let steps = 100 << level;
        Ok(rigid.stretch((start, 0.0), acceleration, until, steps).0)
    })
}

/// Creates the problem that verifies the rigid-block integrator for a block that starts at rest: uplift, one swing
/// under a half-sine, and the peak rotation, which follows from the energy.
fn own_peak() -> Problem {
    let rigid = rigid();
    let omega = 2.0 * rigid.rate;
    let strength = 1.7 * GRAVITY * rigid.uplift();
    let share = rigid.uplift() * GRAVITY / strength;
    let lift = atan2(share, (1.0 - share * share).sqrt()) / omega;
    let end = std::f64::consts::PI / omega;
    // The ground moves right, so the block rotates left; the rotation is counted positive.
    let rates = leaning(rigid.alpha, move |t| -strength * sin(omega * t));
    let [lean, spin] = solution(rates, [0.0, 0.0], (lift, end));
    // Energy after the half-sine: ½ θ′² = p² [cos(α − peak) − cos(α − θ)].
    let left = cos(rigid.alpha - lean) + 0.5 * spin * spin / (rigid.rate * rigid.rate);
    let exact = rigid.alpha - acos(left);
    setting(
        "ode/own-integrator-peak",
        "block at rest under a half-sine of 1.7 g tan α, solved by the integrator of this crate \
         with the time step of the ensembles",
        SOURCE,
    )
    .quantity("largest rotation", "rad", relative(exact, 1e-5)) // measured 1.9e-7
    .by(move |_| {
        let drive = Shake::Sine { acceleration: strength, omega, half_waves: 1.0 };
        let ride = rigid.ride(|t| drive.acceleration(t), drive.end(), 5e-4, 8.0);
        Ok(ride.peak)
    })
}
