//! Static equilibrium under gravity, before anything shakes.

use crate::body::Motion;
use crate::forces::Scratch;
use crate::integrate::{Integrator, Method, Still};
use crate::model::Model;
use crate::real::Real;
use crate::space::{Linear, Space, Twist};
use crate::state::State;

/// What settling found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Steps it took.
    pub steps: u64,
    /// Largest acceleration left over, as a share of gravity.
    pub unbalanced: f64,
}

/// Why bodies did not come to rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettleError {
    /// Still moving after all steps.
    #[error(
        "body \"{body}\" does not come to rest under gravity (it moved {moved:.3} m): does it \
         stand on anything? set run.settle = false to start without equilibrium"
    )]
    NotAtRest {
        /// The body that moves most.
        body: String,
        /// How far it moved (m).
        moved: f64,
    },
}

/// Lets the bodies sink into their contacts until all forces balance.
///
/// Motion is real (gravity, contacts, friction) but for its ends: whenever the kinetic energy passes
/// a peak, all bodies are stopped (kinetic relaxation, Cundall 1982), which leads to equilibrium in a
/// few dozen stops without any damping constant.
/// Friction acts all the while, so forces locked in by sticking as the stack sinks remain, as they
/// would after stacking.
///
/// `state` is left at rest at its time; prescribed bodies stay where they are.
///
/// # Errors
/// When a body moves away, or the forces do not balance to `tolerance` (share of gravity).
pub fn settle<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    time_step: f64,
    tolerance: f64,
) -> Result<Settled, SettleError> {
    const MOST_STEPS: u64 = 400_000;
    let start_time = state.time;
    let start = state.poses.clone();
    let gravity = model.gravity.dot(model.gravity).sqrt().largest_lane().max(1e-12);
    let mut integrator = Integrator::new(Method::VelocityVerlet);
    stop(model, state);
    Integrator::start(model, &Still, state, scratch);
    let (mut kinetic_before, mut steps) = (0.0, 0);
    loop {
        let unbalanced = unbalanced(model, scratch) / gravity;
        let kinetic = kinetic(model, state);
        if unbalanced < tolerance && kinetic_before == 0.0 {
            stop(model, state);
            state.time = start_time;
            return Ok(Settled { steps, unbalanced });
        }
        if kinetic < kinetic_before {
            stop(model, state);
            crate::forces::evaluate(model, state, scratch);
            kinetic_before = 0.0;
            continue;
        }
        kinetic_before = kinetic;
        if steps >= MOST_STEPS || !kinetic.is_finite() {
            return Err(most_moved(model, state, &start));
        }
        let until = state.time + S::Real::splat(time_step);
        integrator.step(model, &Still, state, scratch, until);
        steps += 1;
        if steps % 1000 == 0 && has_left(model, state, &start) {
            return Err(most_moved(model, state, &start));
        }
    }
}

fn stop<S: Space>(model: &Model<S>, state: &mut State<S>) {
    for (twist, body) in state.twists.iter_mut().zip(&model.bodies) {
        if body.motion == Motion::Free {
            *twist = Twist::default();
        }
    }
}

/// Kinetic energy of translation and of rotation (J), the worst lane.
fn kinetic<S: Space>(model: &Model<S>, state: &State<S>) -> f64 {
    let mut sum = S::Real::zero();
    for (i, body) in model.bodies.iter().enumerate() {
        if body.motion == Motion::Free {
            let twist = state.twists[i];
            let rotation = S::rotation(state.poses[i].orientation);
            sum += S::Real::splat(0.5) * body.mass * twist.linear.dot(twist.linear)
                + S::spin_energy(body.inertia, rotation, twist.angular);
        }
    }
    sum.largest_lane()
}

/// The largest acceleration of any body (m/s²), rotation counted at its reach.
fn unbalanced<S: Space>(model: &Model<S>, scratch: &Scratch<S>) -> f64 {
    let mut worst = 0.0_f64;
    for (i, acceleration) in scratch.accelerations.iter().enumerate() {
        let linear = acceleration.linear.dot(acceleration.linear).sqrt().largest_lane();
        let angular = acceleration.angular.dot(acceleration.angular).sqrt().largest_lane();
        worst = worst.max(linear).max(angular * model.reach[i]);
    }
    worst
}

fn moved<S: Space>(state: &State<S>, start: &[crate::space::Pose<S>], body: usize) -> f64 {
    let way = state.poses[body].position - start[body].position;
    way.dot(way).sqrt().largest_lane()
}

/// Whether a body went further than any sinking explains.
fn has_left<S: Space>(model: &Model<S>, state: &State<S>, start: &[crate::space::Pose<S>]) -> bool {
    (0..model.bodies.len()).any(|i| {
        let way = moved(state, start, i);
        !way.is_finite() || way > 0.5 * model.reach[i].max(0.1)
    })
}

fn most_moved<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    start: &[crate::space::Pose<S>],
) -> SettleError {
    let (mut body, mut most) = (0, -1.0);
    for i in 0..model.bodies.len() {
        let way = moved(state, start, i);
        if way.is_nan() || way > most {
            (body, most) = (i, way);
        }
    }
    SettleError::NotAtRest { body: model.bodies[body].name.clone(), moved: most }
}
