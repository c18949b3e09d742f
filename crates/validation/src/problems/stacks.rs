//! Stacked blocks: the joint that opens or slides first, and the four rocking patterns of two stacked blocks.

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::{ContactPair, Model, NormalLaw};

use crate::drive::Shake;
use crate::problem::{absolute, border, halvings, relative, setting};
use crate::scene::{DOWN, Scene, all_pairs, coulomb, floor, interface};
use crate::{Effort, Failure, GRAVITY, Outcome, Problem};

use super::gravity::{INSET, brick};

const UPLIFT: &str = "quasi-static balance, smallest c/h of all joints";
const PATTERNS: &str = "Psycharis 1990";
const MASS: f64 = 100.0;

/// Stiffness (N/m) of a joint's nodes.
const STIFFNESS: f64 = 1e9;

/// Creates a tower of blocks. `sizes` are the widths and heights (m) of the blocks, from the ground up.
///
/// `frictions` are the friction coefficients of the joint on the ground and of all other joints.
fn tower(sizes: &[(f64, f64)], frictions: (f64, f64)) -> Result<Scene, Failure> {
    let mut bodies = vec![floor()];
    let mut top = 0.0;
    for (i, size) in sizes.iter().enumerate() {
        bodies.push(brick(&format!("block {i}"), *size, MASS, (0.0, top + 0.5 * size.1)));
        top += size.1;
    }
    let damping = restitution::damping(STIFFNESS, 0.5, MASS);
    let laws = [frictions.0, frictions.1].map(|friction| {
        let normal = NormalLaw::SpeedGap { stiffness: STIFFNESS, damping };
        interface(normal, coulomb(friction, STIFFNESS, damping))
    });
    let on_ground = |pair: &ContactPair| pair.contactor == 0 || pair.target == 0;
    let pairs = all_pairs(&bodies)
        .into_iter()
        .map(|pair| ContactPair { interface: usize::from(!on_ground(&pair)), ..pair })
        .collect();
    Ok(Scene::of(Model::new(bodies, laws.to_vec(), pairs, DOWN)?).settled(1e-6)?)
}

/// Time step (s).
const STEP: f64 = 1e-5;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        opens("one", &[(0.4, 1.2)]),
        opens("two", &[(0.4, 0.8), (0.4, 0.8)]),
        opens("three", &[(0.5, 0.6), (0.5, 0.6), (0.5, 0.6)]),
        opens("upper-of-two", &[(1.2, 0.4), (0.4, 1.4)]),
        opens("lower-of-two", &[(0.4, 1.0), (0.5, 0.4)]),
        slides(0.5, 0.22, 0.22),
        slides(0.2, 0.4, 0.2),
        patterns(),
    ]
}

/// Computes a ratio for every joint: the half-width of the joint divided by the height of the center of mass of all
/// blocks above, measured from the joint. Returns the smallest ratio, and the index of the joint that has it.
fn least_ratio(sizes: &[(f64, f64)]) -> (f64, usize) {
    let joint = |k: usize| {
        // Equal masses: the mean of the heights of the centers above the joint.
        let above = &sizes[k..];
        let (mut base, mut sum) = (0.0, 0.0);
        for (_, height) in above {
            sum += base + 0.5 * height;
            base += height;
        }
        // The blocks above a joint rotate about the outermost node of the narrower face.
        let below = if k == 0 { f64::INFINITY } else { sizes[k - 1].0 };
        let half = 0.5 * sizes[k].0.min(below) - INSET;
        half / (sum / above.len() as f64)
    };
    (0..sizes.len())
        .map(|k| (joint(k), k))
        .fold((f64::INFINITY, 0), |least, one| if one.0 < least.0 { one } else { least })
}

fn opens(name: &str, sizes: &'static [(f64, f64)]) -> Problem {
    let (exact, joint) = least_ratio(sizes);
    setting(
        format!("stacks/opens-{name}"),
        match sizes.len() {
            1 => "a block on the ground".into(),
            count => {
                format!("{count} blocks on top of each other, joint {} opens first", joint + 1)
            }
        },
        UPLIFT,
    )
    .quantity("ground acceleration that opens a joint", "g", relative(exact, 5e-3).fast(1.2e-2))
    .by(move |effort| {
        let mut wrong = None;
        let found = border((0.98 * exact, 1.02 * exact), halvings(effort), |push| {
            let mut scene = tower(sizes, (5.0, 5.0))?;
            let drive = Shake::Ramped { acceleration: push * GRAVITY, ramp: 0.3 };
            scene.run(&drive, STEP, 1.0)?;
            let tilt = |body: usize| scene.state.poses[body].orientation;
            let turn = |k: usize| (tilt(k + 1) - tilt(k)).abs();
            let first = (0..sizes.len()).find(|k| turn(*k) > 2e-4);
            if first.is_some_and(|k| k != joint) {
                wrong = first;
            }
            Ok(first.is_some())
        })?;
        match wrong {
            Some(k) => Err(Failure::Absent(format!("joint {} opens instead", k + 1))),
            None => Ok(found),
        }
    })
}

fn slides(ground: f64, between: f64, exact: f64) -> Problem {
    let upper = between < ground;
    setting(
        format!("stacks/slides-{ground}-{between}"),
        format!("two low blocks, μ = {ground} on the ground and {between} between them"),
        UPLIFT,
    )
    .quantity(
        "ground acceleration at which the weaker joint starts to slide",
        "g",
        relative(exact, 2e-3).fast(1.2e-2),
    )
    .at_border(0.02, move |push| {
        let mut scene = tower(&[(2.0, 0.2), (2.0, 0.2)], (ground, between))?;
        let drive = Shake::Ramped { acceleration: push * GRAVITY, ramp: 0.2 };
        scene.run(&drive, STEP, 0.5)?;
        let slip = [scene.relative(1), scene.relative(2) - scene.relative(1)];
        let weaker = usize::from(upper);
        if slip[1 - weaker].abs() > 2e-5 {
            return Err(Failure::Absent("the stronger joint slides".into()));
        }
        Ok(slip[weaker].abs() > 2e-5)
    })
}

/// Names of the rocking patterns of Psycharis.
const NAMES: [&str; 4] = ["together", "upper alone", "same sense", "opposite senses"];

/// Returns the index of the rocking pattern of two blocks with the rotations `lower` and `upper` (rad); `None` near
/// rest.
fn pattern(lower: f64, upper: f64) -> Option<usize> {
    let (open, hair) = (2e-3, 2e-4);
    let between = upper - lower;
    match (lower.abs() > open, between.abs() > open) {
        (true, false) if between.abs() < hair => Some(0),
        (false, true) if lower.abs() < hair => Some(1),
        (true, true) => Some(if lower * between > 0.0 { 2 } else { 3 }),
        _ => None,
    }
}

fn patterns() -> Problem {
    setting(
        "stacks/four-patterns",
        "two blocks of height 1 m and of several widths, under one sine cycle of 0.33 g to 0.8 g",
        PATTERNS,
    )
    .quantity("rocking patterns that occur", "", absolute(4.0, 0.0))
    .by(|effort| {
        let mut times = [0.0; 4];
        // Strength (g), ω (rad/s), widths of the lower and the upper block (m).
        for (strength, omega, lower, upper) in
            [(0.33, 6.0, 0.8, 0.3), (0.4, 6.0, 0.5, 0.5), (0.8, 9.0, 0.5, 0.45)]
        {
            let mut scene = tower(&[(lower, 1.0), (upper, 1.0)], (5.0, 5.0))?;
            let drive = Shake::Sine { acceleration: strength * GRAVITY, omega, half_waves: 2.0 };
            let step = if effort == Effort::Full { STEP } else { 1.5 * STEP };
            scene.watch(&drive, step, 2.0, |state, _, _| {
                let (lower, upper) = (state.poses[1].orientation, state.poses[2].orientation);
                if let Some(at) = pattern(lower, upper) {
                    times[at] += step;
                }
                let fallen = lower.abs().max(upper.abs()) > 0.6;
                if fallen { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })?;
        }
        let slow = times.iter().filter(|time| **time > 5e-3).count();
        let said: Vec<String> =
            NAMES.iter().zip(times).map(|(name, time)| format!("{name} {time:.2} s")).collect();
        Ok(Outcome::of(slow as f64).noted(said.join(", ")))
    })
}
