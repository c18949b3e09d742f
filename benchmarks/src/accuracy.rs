//! Cost of each integration method at several time steps, and its error relative to the converged
//! motion.

use std::ops::ControlFlow;

use barrelstack_dynamics::{Method, Planar, Scratch, Simulation, State, look, simulate};

use crate::scene::Scene;
use crate::{Failure, time};

/// Time step (s) of the reference run; a shorter step changes no printed digit.
const CONVERGED: f64 = 0.015_625e-3;

/// Drop (m) at which a barrel counts as fallen.
const DROP: f64 = 0.2;

/// Interval (s) between the times at which trajectories are compared.
const SAMPLE: f64 = 4e-3;

/// Limit of the relative error of the displacements before the fall. A time step is precise enough only if its error is
/// below this limit.
const MOST_ERROR: f64 = 0.01;
/// Limit of the error (s) of the time of the fall. A time step is precise enough only if its error is below this limit.
const MOST_DELAY: f64 = 0.010;

/// Prints the table and returns the longest step (s) of the default method that is precise enough.
pub(crate) fn work_and_precision(scene: &Scene) -> Result<f64, Failure> {
    let exact = watched(scene, Method::VelocityVerlet, CONVERGED)?;
    let fall = exact.fall.ok_or("nothing falls in the converged run")?;
    println!(
        "work and precision: eight barrels, supports at ±20°, compared with velocity Verlet with steps of {:.4} ms",
        1e3 * CONVERGED
    );
    println!("  the first barrel falls after {fall:.4} s");
    println!("  method                 step     largest error of any barrel   fall    × real time");
    println!("                         ms       before the fall, % of its path ms later  one run");
    let mut chosen = CONVERGED;
    let methods = [Method::VelocityVerlet, Method::SemiImplicitEuler, Method::RungeKutta4];
    for method in methods {
        for step in [0.0625e-3, 0.125e-3, 0.25e-3, 0.5e-3, 1e-3] {
            let seen = watched(scene, method, step)?;
            let error = seen.error_against(&exact, fall);
            let late = seen.fall.map_or(f64::INFINITY, |time| time - fall);
            let cost = cost(scene, method, step, fall);
            println!(
                "  {:20} {:8.4} {:12.4} {:26.3} {:12.1}",
                method.name(),
                1e3 * step,
                100.0 * error,
                1e3 * late,
                fall / cost
            );
            let precise = error < MOST_ERROR && late.abs() < MOST_DELAY;
            if precise && method == Method::VelocityVerlet {
                chosen = step;
            }
        }
    }
    println!(
        "  longest step of the default method with errors within {} % and {} ms: {} ms",
        100.0 * MOST_ERROR,
        1e3 * MOST_DELAY,
        1e3 * chosen
    );
    Ok(chosen)
}

fn cost(scene: &Scene, method: Method, step: f64, end_time: f64) -> f64 {
    let simulation = Simulation { method, time_step: step, end_time };
    time::least(|| {
        let (mut state, mut scratch) = (scene.rest.clone(), Scratch::new(&scene.model));
        let ground = Scene::ground(1.0);
        let ended = simulate(&scene.model, &ground, &mut state, &mut scratch, &simulation, &mut ());
        assert!(ended.is_ok(), "the run fails");
    })
}

/// The trajectories of a run, and the time at which the first body falls.
struct Seen {
    /// Heights (m) at rest.
    rest: Vec<f64>,
    /// For each sample, the displacements (m) of all bodies along `x` relative to the ground.
    ways: Vec<Vec<f64>>,
    fall: Option<f64>,
}

impl Seen {
    /// Returns the largest error of the displacement of a body before a time (s), relative to the
    /// largest displacement of the same body.
    fn error_against(&self, exact: &Self, until: f64) -> f64 {
        let samples = (until / SAMPLE) as usize;
        let bodies = exact.rest.len();
        (1..bodies)
            .map(|body| {
                let pairs = || self.ways.iter().zip(&exact.ways).take(samples);
                let error = pairs().map(|(a, b)| (a[body] - b[body]).abs()).fold(0.0, f64::max);
                let way = pairs().map(|(_, b)| b[body].abs()).fold(0.0, f64::max);
                error / way
            })
            .fold(0.0, f64::max)
    }
}

fn watched(scene: &Scene, method: Method, step: f64) -> Result<Seen, Failure> {
    let (mut state, mut scratch) = (scene.rest.clone(), Scratch::new(&scene.model));
    let rest: Vec<f64> = state.poses.iter().map(|pose| pose.position.z).collect();
    let (mut ways, mut fall) = (Vec::new(), None);
    let mut observer = look(|state: &State<Planar>, _, _| {
        // Every sample falls on a step, since all time steps divide the sampling interval.
        if state.time > (ways.len() as f64 - 1e-6) * SAMPLE {
            let ground = state.poses[0].position.x;
            ways.push(state.poses.iter().map(|pose| pose.position.x - ground).collect());
        }
        let fallen =
            state.poses.iter().zip(&rest).any(|(pose, rest)| rest - pose.position.z > DROP);
        if fallen {
            fall = Some(state.time);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    let simulation = Simulation { method, time_step: step, end_time: 3.0 };
    let ground = Scene::ground(1.0);
    simulate(&scene.model, &ground, &mut state, &mut scratch, &simulation, &mut observer)?;
    drop(observer);
    Ok(Seen { rest, ways, fall })
}
