//! Zero crossings of oscillations.

use std::ops::ControlFlow;

use barrelstack_dynamics::{Space, State, Still};

use crate::Failure;
use crate::scene::Scene;

/// Returns the time (s) of the zero crossing between two samples, each a pair of time (s) and value, by linear
/// interpolation.
pub fn crossing(before: (f64, f64), now: (f64, f64)) -> f64 {
    before.0 + before.1 / (before.1 - now.1) * (now.0 - before.0)
}

/// Returns the times (s) at which a quantity changes sign, from its samples as pairs of time (s) and value.
pub fn crossings(values: &[(f64, f64)]) -> Vec<f64> {
    let changes = values.windows(2).filter(|pair| pair[0].1 * pair[1].1 < 0.0);
    changes.map(|pair| crossing(pair[0], pair[1])).collect()
}

/// Runs a scene on ground at rest up to a time (s), and returns the times (s) of the zero crossings of a quantity.
///
/// # Errors
/// If the run fails numerically.
pub fn run_crossings<S: Space<Real = f64>>(
    scene: &mut Scene<S>,
    step: f64,
    end: f64,
    of: impl Fn(&State<S>) -> f64,
) -> Result<Vec<f64>, Failure> {
    let mut values = vec![];
    scene.watch(&Still, step, end, |state, _, _| {
        values.push((state.time, of(state)));
        ControlFlow::Continue(())
    })?;
    Ok(crossings(&values))
}

/// Returns the mean interval (s) between successive times; `None` if there are fewer than `least` times.
pub fn mean_time(instants: &[f64], least: usize) -> Option<f64> {
    match instants {
        [first, .., last] if instants.len() >= least => {
            Some((last - first) / (instants.len() - 1) as f64)
        }
        _ => None,
    }
}
