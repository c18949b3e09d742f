//! Onset of motion of a block on accelerating ground: rest, sliding, rocking, or sliding and rocking.

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::{Drive, NormalLaw, Planar};

use crate::drive::Shake;
use crate::problem::{border, halvings, relative, setting};
use crate::scene::{DOWN, Scene, block, coulomb, floor, interface, pose};
use crate::{Effort, Failure, GRAVITY, Problem, theory};

const SOURCE: &str = "Shao and Tung 1999, Taniguchi 2002";
const MASS: f64 = 100.0;

/// Creates a block on nearly rigid corners, at rest on the ground.
pub(super) fn standing(
    (width, height): (f64, f64),
    friction: f64,
    stiffness: f64,
) -> Result<Scene, Failure> {
    let sunk = MASS * GRAVITY / (2.0 * stiffness);
    let damping = restitution::damping(stiffness, 0.7, 0.5 * MASS);
    let body = block("block", (width, height), MASS, pose(0.0, 0.5 * height - sunk, 0.0));
    let laws = interface(
        NormalLaw::KelvinVoigt { stiffness, damping },
        coulomb(friction, stiffness, damping),
    );
    Ok(Scene::new(vec![floor(), body], laws, DOWN)?)
}

/// Returns two flags: whether a block has begun to slide, and whether it has begun to rock, under a ground acceleration
/// that grows to `beta` (g) and is then constant. The block is 2 m high, and its width is `s` times its height.
fn start(s: f64, beta: f64, friction: f64, refinement: i32) -> Result<(bool, bool), Failure> {
    let finer = 2.0_f64.powi(refinement);
    let mut scene = standing((2.0 * s, 2.0), friction, 1e10 * finer * finer)?;
    // The ramp is slow compared with the contact and sudden compared with the block (p = 2.6 /s).
    let ramp = 0.004;
    let drive = Shake::Ramped { acceleration: beta * GRAVITY, ramp };
    scene.run(&drive, 5e-6 / finer, ramp + 0.02)?;
    let at = scene.state.poses[1];
    // The ground moves to the right, so the block rotates about its lower left corner.
    let (sin, cos) = barrelstack_dynamics::math::sin_cos(at.orientation);
    let slip = scene.relative(1) - cos * s + sin + s;
    // The tangential (sticking) springs stretch by micrometers before they slip; stiffer springs stretch less.
    Ok((slip.abs() > 4e-6 / finer, at.orientation.abs() > 1e-5))
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    for s in [0.2, 0.25, 1.0] {
        list.extend([1.25, 1.5, 2.0, 3.0, 5.0].map(|share| least_friction(s, share)));
    }
    list.extend([0.1, 0.22, 0.4].map(slide));
    list.extend([(0.25, 0.5), (0.25, 1.0), (1.0, 2.0)].map(|(s, beta)| first_spin(s, beta)));
    list
}

fn least_friction(s: f64, share: f64) -> Problem {
    let exact = theory::least_friction_for_rocking(share * s, s);
    setting(
        format!("regimes/friction-for-rocking-{s}-{share}"),
        format!("block of s = {s} on ground that accelerates at {share} s g"),
        SOURCE,
    )
    .quantity(
        "smallest friction coefficient with which the block rocks without sliding",
        "",
        relative(exact, 4e-3).fast(1.2e-2),
    )
    .refined(move |effort, level| {
        border((0.98 * exact, 1.02 * exact), halvings(effort), |friction| {
            Ok(!start(s, share * s, friction, level)?.0)
        })
    })
}

fn slide(friction: f64) -> Problem {
    setting(
        format!("regimes/slide-{friction}"),
        "low block on ground whose acceleration grows",
        SOURCE,
    )
    .quantity(
        "ground acceleration at which the block starts to slide",
        "g",
        relative(friction, 2e-3).fast(1.2e-2),
    )
    .at_border(0.02, move |beta| {
        let mut scene = standing((2.0, 0.2), friction, 1e9)?;
        let drive = Shake::Ramped { acceleration: beta * GRAVITY, ramp: 0.2 };
        scene.run(&drive, 2e-5, 0.5)?;
        Ok(scene.relative(1).abs() > 2e-5)
    })
}

fn first_spin(s: f64, beta: f64) -> Problem {
    // Half-height 1 m: R² = 1 + s².
    let exact = 3.0 * GRAVITY * (beta - s) / (4.0 * (1.0 + s * s));
    setting(
        format!("regimes/first-spin-{s}-{beta}"),
        format!("block of s = {s} under a sudden ground acceleration of {beta} g, no sliding"),
        SOURCE,
    )
    .quantity(
        "angular acceleration at the start of rocking",
        "rad/s2",
        relative(exact, 5e-3).fast(2e-2),
    )
    .refined(move |_, level| {
        let finer = 2.0_f64.powi(level);
        let mut scene = standing((2.0 * s, 2.0), 10.0, 1e10 * finer * finer)?;
        let drive = Shake::Ramped { acceleration: beta * GRAVITY, ramp: 1e-9 };
        // The acceleration is measured between two times, after the springs have come to rest and before the block has
        // turned much.
        let step = 5e-6 / finer;
        scene.run(&drive, step, 0.004)?;
        let before = scene.state.twists[1].angular;
        scene.run(&drive, step, 0.008)?;
        Ok((scene.state.twists[1].angular - before).abs() / 0.004)
    })
}

/// Simulates, on moving ground, a block that is too flat to rock. Returns the scene at the time `end` (s).
///
/// # Errors
/// If the run fails numerically.
pub(super) fn ridden(
    friction: f64,
    drive: &impl Drive<Planar>,
    end: f64,
    refinement: i32,
) -> Result<Scene, Failure> {
    let finer = 2.0_f64.powi(refinement);
    let mut scene = standing((2.0, 0.2), friction, 1e9 * finer * finer)?;
    scene.run(drive, 2e-5 / finer, end)?;
    Ok(scene)
}

/// Returns the coarsest refinement level for an effort.
pub(super) fn base(effort: Effort) -> i32 {
    match effort {
        Effort::Fast => -1,
        Effort::Full => 0,
    }
}
