//! Static equilibrium under gravity, computed before the ground moves.
//!
//! Equilibrium depends only on the positions of the bodies and on the displacements of the tangential springs. So it is
//! computed in a fictitious time, with masses chosen for fast convergence and with vanishing velocities, at which no
//! damper acts.

mod lanes;
mod refusal;
mod relax;

use crate::body::{BodyId, Motion};
use crate::forces::{Scratch, evaluate};
use crate::integrate::{Integrator, Still};
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Linear, Space, Twist};
use crate::state::State;

pub use lanes::{Stack, settle_all};
use refusal::Departure;
pub use refusal::{Lack, SettleError};
use relax::Relaxation;

/// Result of settling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Number of steps of the successful attempt; each step has one force evaluation.
    pub steps: u64,
    /// Largest residual acceleration, as a fraction of gravity.
    pub unbalanced: f64,
    /// Friction that is locked in at rest.
    pub locked: Locked,
}

/// Friction at rest: forces that equilibrium alone does not determine, since they depend on how equilibrium was
/// reached.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Locked {
    /// Number of sticking contacts, whose friction is below the limit.
    pub holding: usize,
    /// Number of contacts at the friction limit.
    pub slipping: usize,
    /// Sum of the magnitudes of the friction forces of all contacts, divided by the sum of their normal forces; zero if
    /// there are no normal forces.
    pub friction: f64,
}

/// Maximum number of steps in one attempt.
const MOST_STEPS: u64 = 40_000;

/// Retry schedule: for each attempt, the factor of the fictitious masses and the number of initial steps without
/// momentum. With heavier masses, convergence is slower and overshoots less.
const TRIES: [(f64, u64); 3] = [(2.0, 0), (16.0, 0), (64.0, 4000)];

/// Number of steps between two checks for bodies that have moved out of place.
const LOOK: u64 = 20;

/// Relative rounding error of the position of a body: a few units in the last place. A residual force that an error of
/// this size can cause counts as balanced, since springs that are very stiff in comparison with their load cannot be
/// balanced better at any representable position.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Lets the bodies sink into their contacts until all forces balance.
///
/// Gravity acts on all bodies at once, and friction acts throughout. So friction forces that build up as the stack
/// sinks stay locked in, as they would after real stacking; [`Settled::locked`] reports them.
///
/// The method is relaxation with momentum: every step repeats a growing share of the displacement of the preceding
/// step, and all bodies are stopped whenever the power of the forces becomes negative. If relaxation fails, it is
/// retried with heavier masses before an error is returned, unless a body lacks any support ([`Lack::Support`]). The
/// mass of a body is the stiffness of its contacts times a factor, and velocities are too small for dampers to act, so
/// neither damping constants nor the time step affect the equilibrium or the number of steps.
///
/// On return, `state` is at rest at its original time; prescribed bodies do not move.
///
/// # Errors
/// If a body moves out of place, or the remaining accelerations exceed `tolerance` (a fraction of gravity).
pub fn settle<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    tolerance: f64,
) -> Result<Settled, SettleError> {
    let keeps_contacts = std::mem::replace(&mut scratch.keeps_contacts, true);
    let start_time = state.time;
    stop(model, state);
    Integrator::start(model, &Still, state, scratch);
    let start = state.clone();
    let mut result = sink(model, state, scratch, tolerance, TRIES[0]);
    for attempt in &TRIES[1..] {
        // With momentum, bodies overshoot and may leave their supports. If every attempt fails, the first error is
        // returned.
        if result.as_ref().is_err_and(|error| error.lack != Lack::Support) {
            state.clone_from(&start);
            evaluate(model, state, scratch);
            result = sink(model, state, scratch, tolerance, *attempt).or(result);
        }
    }
    state.time = start_time;
    stop(model, state);
    evaluate(model, state, scratch);
    let locked = Locked::of(state, scratch);
    scratch.keeps_contacts = keeps_contacts;
    result.map(|(steps, unbalanced)| Settled { steps, unbalanced, locked })
}

/// Relaxes until every lane is at rest, with the parameters of one entry of [`TRIES`]; returns the number of steps and
/// the residual.
fn sink<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    tolerance: f64,
    (margin, calm): (f64, u64),
) -> Result<(u64, f64), SettleError> {
    let mut relaxation = Relaxation::new(model, margin, calm);
    let mut departure = Departure::new(model, state.poses.clone());
    let mut steps = 0;
    loop {
        relaxation.weigh(model, state, scratch);
        let (rests, worst) = relaxation.left_over(model, state, scratch, tolerance);
        let unbalanced = worst.largest_lane() / gravity(model).largest_lane();
        relaxation.resting = relaxation.resting | rests;
        if relaxation.resting.all() {
            return Ok((steps, unbalanced));
        }
        if steps % LOOK == 0 {
            departure.watch(model, state, scratch, &relaxation.met)?;
        }
        if steps == MOST_STEPS {
            let left = |body: BodyId| relaxation.acceleration(scratch, body).largest_lane();
            let free = (0..model.bodies.len()).filter(|i| model.bodies[*i].motion == Motion::Free);
            let larger = |most, body| if left(body) > left(most) { body } else { most };
            let body = free.reduce(larger).unwrap_or_default();
            return Err(departure.unbalanced(model, state, (steps, body, unbalanced)));
        }
        relaxation.advance(model, state, scratch);
        steps += 1;
    }
}

/// Stops all free bodies.
fn stop<S: Space>(model: &Model<S>, state: &mut State<S>) {
    for (twist, body) in state.twists.iter_mut().zip(&model.bodies) {
        if body.motion == Motion::Free {
            *twist = Twist::default();
        }
    }
}

impl Locked {
    /// Summarizes the contacts at rest, over all lanes.
    fn of<S: Space>(state: &State<S>, scratch: &Scratch<S>) -> Self {
        let mut locked = Self::default();
        let (mut friction, mut normal) = (0.0, 0.0);
        for contact in &scratch.contacts {
            let slipping = state.contact_elements.sticks[contact.element].slipping;
            let force = contact.friction_force.dot(contact.friction_force).sqrt();
            for lane in (0..S::Real::LANES).filter(|lane| contact.touching.lane(*lane)) {
                let slips = slipping.lane(lane);
                locked.slipping += usize::from(slips);
                locked.holding += usize::from(!slips && force.lane(lane) > 0.0);
                friction += force.lane(lane);
                normal += contact.normal_force.lane(lane);
            }
        }
        if normal > 0.0 {
            locked.friction = friction / normal;
        }
        locked
    }
}

/// Returns the magnitude of gravity (m/s²), with a lower bound, so that it can be used as a divisor.
fn gravity<S: Space>(model: &Model<S>) -> S::Real {
    model.gravity.dot(model.gravity).sqrt().max(S::Real::splat(1e-12))
}
