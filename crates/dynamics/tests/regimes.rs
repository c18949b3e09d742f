//! Initial motion of a block on shaking ground, compared with the theory of rigid blocks.

use crate::common::{DOWN, GRAVITY, Scene, block, coulomb, floor, interface, pose};
use barrelstack_dynamics::NormalLaw;
use barrelstack_dynamics::contact::restitution;
use barrelstack_scenes::drive::Shake;
use barrelstack_scenes::theory::least_friction_for_rocking;

const MASS: f64 = 100.0;

/// Initial motion of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    Rest,
    Slide,
    Rock,
    SlideRock,
}

/// Returns a block on nearly rigid corners, at rest on the ground.
fn standing(width: f64, height: f64, friction: f64, stiffness: f64) -> Scene {
    let sunk = MASS * GRAVITY / (2.0 * stiffness);
    let damping = restitution::damping(stiffness, 0.7, 0.5 * MASS);
    let body = block("block", (width, height), MASS, pose(0.0, 0.5 * height - sunk, 0.0));
    Scene::new(
        vec![floor(), body],
        interface(
            NormalLaw::KelvinVoigt { stiffness, damping },
            coulomb(friction, stiffness, damping),
        ),
        DOWN,
    )
    .unwrap()
}

/// Returns the initial motion of a block of height 2 m and slenderness `s = b/h` under a base acceleration `β g`.
fn start(s: f64, beta: f64, friction: f64) -> Start {
    let stiffness = 1e10;
    let mut scene = standing(2.0 * s, 2.0, friction, stiffness);
    // The acceleration is slow for the contact (ω = 14 000 /s) and instantaneous for the block (p = 2.6 /s).
    let ramp = 0.004;
    let drive = Shake::Ramped { acceleration: beta * GRAVITY, ramp };
    scene.run(&drive, 5e-6, ramp + 0.02).unwrap();
    let moved = |point: [f64; 2]| {
        let pose = scene.state.poses[1];
        let (sin, cos) = (libm::sin(pose.orientation), libm::cos(pose.orientation));
        let x = pose.position.x + cos * point[0] - sin * point[1];
        x - point[0] - scene.state.poses[0].position.x
    };
    // The ground moves to the right, so the block rotates about its left lower corner.
    let slip = moved([-s, -1.0]).abs();
    let turned = scene.state.poses[1].orientation.abs();
    match (slip > 5e-6, turned > 1e-5) {
        (false, false) => Start::Rest,
        (true, false) => Start::Slide,
        (false, true) => Start::Rock,
        (true, true) => Start::SlideRock,
    }
}

#[test]
fn a_block_starts_to_move_as_friction_and_slenderness_say() {
    // Tests one percent to either side of every boundary between regimes.
    for s in [0.2, 0.25, 1.0] {
        for share in [0.5, 0.9, 1.25, 1.5, 2.0, 3.0] {
            let beta = share * s;
            let rocks = least_friction_for_rocking(beta, s);
            for friction in [0.5 * s, 0.99 * s, 1.01 * s, 0.99 * rocks, 1.01 * rocks, 2.0 * rocks] {
                let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.0099;
                if near(friction, beta) || (beta > s && near(friction, s) && near(rocks, s)) {
                    continue;
                }
                let expected = if beta < friction.min(s) {
                    Start::Rest
                } else if friction < s {
                    Start::Slide
                } else if friction > rocks {
                    Start::Rock
                } else {
                    Start::SlideRock
                };
                let found = start(s, beta, friction);
                assert_eq!(found, expected, "s = {s}, β = {beta}, μ = {friction}, μ_r = {rocks}");
            }
        }
    }
}
