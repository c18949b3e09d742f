//! Blocks that slide under pulses, on shaking ground and on slopes, and blocks that must not slide.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use barrelstack_dynamics::math::{atan, cos, sin};
use barrelstack_dynamics::{FrictionLaw, NormalLaw, Still, Twist, Vec2};

use crate::drive::Shake;
use crate::problem::{absolute, relative, setting};
use crate::scene::{Scene, block, coulomb, floor, gravity_on_slope, interface, pose};
use crate::{Failure, GRAVITY, Problem, theory};

use super::regimes::{base, ridden, standing};

const SOURCE: &str = "Newmark 1965";
const STEADY: &str = "Den Hartog 1931";
const COULOMB: &str = "Coulomb";

const MASS: f64 = 50.0;
const STIFFNESS: f64 = 1e6;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let (a, n, duration) = (0.5, 0.2, 0.4);
    let half_sine =
        Shake::Sine { acceleration: a * GRAVITY, omega: PI / duration, half_waves: 1.0 };
    let mut list = vec![
        slide(
            "rectangular",
            "constant push of 0.5 g for 0.4 s, μ = 0.2",
            Shake::Rectangular { acceleration: a * GRAVITY, duration },
            theory::slide_in_rectangular_pulse(a, n, duration),
        ),
        slide(
            "half-sine",
            "half-sine push of 0.5 g for 0.4 s, μ = 0.2",
            half_sine,
            theory::slide_in_half_sine(a, n, duration),
        ),
        ride_along(),
        steady(),
        no_creep(),
        thrown(),
    ];
    list.extend([(0.2, 0.3), (0.5, 0.6), (0.0, 0.4)].map(|(mu, slope)| slope_slide(mu, slope)));
    list.extend([0.3, 0.6, 0.9].map(creep));
    list
}

fn slide(name: &str, title: &str, drive: Shake, exact: f64) -> Problem {
    setting(format!("sliding/{name}"), title, SOURCE)
        .quantity(
            "displacement of the block relative to the ground",
            "m",
            relative(exact, 2e-4).fast(1e-3),
        )
        .refined(move |effort, level| {
            Ok(-ridden(0.2, &drive, 3.0, base(effort) + level)?.relative(1))
        })
}

fn ride_along() -> Problem {
    setting("sliding/below-yield", "half-sine push of 0.19 g for 0.4 s, μ = 0.2", SOURCE)
        .quantity("displacement of the block relative to the ground", "m", absolute(0.0, 1e-9)) // measured 1.2e-12
        .by(|effort| {
            let drive =
                Shake::Sine { acceleration: 0.19 * GRAVITY, omega: PI / 0.4, half_waves: 1.0 };
            Ok(ridden(0.2, &drive, 2.0, base(effort))?.relative(1))
        })
}

fn steady() -> Problem {
    let (a, n, omega) = (0.5, 0.2, TAU);
    let exact = theory::steady_slide_amplitude(a, n, omega);
    setting("sliding/steady", "block on ground that shakes with 0.5 g at 1 Hz, μ = 0.2", STEADY)
        .quantity("relative amplitude", "m", relative(exact, 1e-3).fast(3e-3))
        .refined(move |effort, level| {
            let finer = 2.0_f64.powi(base(effort) + level);
            let mut scene = standing((2.0, 0.2), n, 1e9 * finer * finer)?;
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            let drive = Shake::Harmonic { acceleration: a * GRAVITY, omega };
            scene.watch(&drive, 2e-5 / finer, 9.0, |state, _, _| {
                if state.time > 8.0 {
                    let place = state.poses[1].position.x - state.poses[0].position.x;
                    (low, high) = (low.min(place), high.max(place));
                }
                ControlFlow::Continue(())
            })?;
            Ok(0.5 * (high - low))
        })
}

/// Creates a low block on its lower corners, at its static penetration, on a slope of an angle (rad).
fn sledge(friction: FrictionLaw, slope: f64, speed: f64) -> Result<Scene, Failure> {
    let gravity = gravity_on_slope(slope);
    let sunk = -MASS * gravity.z / (2.0 * STIFFNESS);
    let mut body = block("sledge", (0.6, 0.1), MASS, pose(0.0, 0.05 - sunk, 0.0));
    body.twist = Twist { linear: Vec2::new(speed, 0.0), angular: 0.0 };
    // Damped in both directions, so that initial vibrations decay.
    let normal = NormalLaw::KelvinVoigt { stiffness: STIFFNESS, damping: 1e4 };
    Ok(Scene::new(vec![floor(), body], interface(normal, friction), gravity)?)
}

fn no_creep() -> Problem {
    setting(
        "sliding/no-creep",
        "block on a slope of 90 % of the friction angle, one minute",
        COULOMB,
    )
    .quantity("displacement downhill after the first two seconds", "m", absolute(0.0, 1e-12)) // measured 0
    .by(|_| {
        let mut scene = sledge(coulomb(0.5, STIFFNESS, 1e4), atan(0.45), 0.0)?;
        scene.run(&Still, 5e-4, 2.0)?;
        let start = scene.state.poses[1].position.x;
        scene.run(&Still, 5e-4, 60.0)?;
        Ok(scene.state.poses[1].position.x - start)
    })
}

fn creep(share: f64) -> Problem {
    let law = FrictionLaw::Regularized { coefficient: 0.5, velocity: 0.01 };
    let exact = 0.01 * share / (1.0 - share * share).sqrt();
    setting(
        format!("sliding/regularized-creep-{share}"),
        format!("regularized friction, slope of {share} times the friction angle"),
        "equilibrium of the smooth law",
    )
    .quantity("creep speed", "m/s", relative(exact, 1e-12)) // measured 3e-15
    .by(move |_| {
        let mut scene = sledge(law, atan(0.5 * share), 0.0)?;
        scene.run(&Still, 5e-4, 2.0)?;
        Ok(scene.state.twists[1].linear.x)
    })
}

fn slope_slide(friction: f64, slope: f64) -> Problem {
    let exact = GRAVITY * (sin(slope) - friction * cos(slope));
    setting(
        format!("sliding/slope-{friction}-{slope}"),
        format!("block on a slope of {slope} rad, μ = {friction}"),
        COULOMB,
    )
    .quantity("acceleration", "m/s2", relative(exact, 1e-10)) // measured 1.4e-12
    .by(move |_| {
        let mut scene = sledge(coulomb(friction, STIFFNESS, 1e4), slope, 0.0)?;
        scene.run(&Still, 2e-4, 1.0)?;
        let before = scene.state.twists[1].linear.x;
        scene.run(&Still, 2e-4, 2.0)?;
        Ok(scene.state.twists[1].linear.x - before)
    })
}

fn thrown() -> Problem {
    let exact = 1.0 / (2.0 * 0.3 * GRAVITY);
    setting("sliding/thrown", "block thrown at 1 m/s, μ = 0.3", COULOMB)
        .quantity("sliding distance v²/2μg", "m", relative(exact, 1e-6)) // measured 7.7e-8
        .by(|_| {
            let mut scene = sledge(coulomb(0.3, STIFFNESS, 1e4), 0.0, 1.0)?;
            let mut farthest = 0.0_f64;
            scene.watch(&Still, 2e-4, 3.0, |state, _, _| {
                farthest = farthest.max(state.poses[1].position.x);
                ControlFlow::Continue(())
            })?;
            Ok(farthest)
        })
}
