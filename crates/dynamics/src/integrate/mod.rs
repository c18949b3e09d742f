//! Time integration, which advances a model from one accepted state to the next.
//!
//! Every method starts with the forces of the initial state in `scratch`, and leaves the forces of the accepted state
//! there. The displacements of the tangential springs are integrated from their rates, like all other coordinates; the
//! contact history is committed only when a state is accepted.

mod runge_kutta;
mod verlet;

use crate::body::Motion;
use crate::forces::{self, Scratch, evaluate};
use crate::model::Model;
use crate::space::{Pose, Space, Twist};
use crate::state::State;

/// Ground motion that drives the prescribed bodies.
pub trait Drive<S: Space> {
    /// Returns the displacement (m) and the velocity (m/s) of the ground at a time (s); the velocity is the derivative
    /// of the displacement.
    fn at(&self, time: S::Real) -> (S::Vector, S::Vector);
}

impl<S: Space, D: Drive<S> + ?Sized> Drive<S> for &D {
    fn at(&self, time: S::Real) -> (S::Vector, S::Vector) {
        (**self).at(time)
    }
}

/// Ground at rest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Still;

impl<S: Space> Drive<S> for Still {
    fn at(&self, _time: S::Real) -> (S::Vector, S::Vector) {
        (S::Vector::default(), S::Vector::default())
    }
}

/// Integration method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Symplectic Euler: one evaluation per step, first order.
    SemiImplicitEuler,
    /// Velocity Verlet with predicted velocities (Groot and Warren 1997): one evaluation per step, second order where
    /// the motion is smooth.
    VelocityVerlet,
    /// The classical Runge–Kutta method: four evaluations per step, fourth order where the motion is smooth.
    RungeKutta4,
    /// Bogacki–Shampine 3(2) with step control: three evaluations per step.
    BogackiShampine {
        /// Largest permitted local error (m) of a position, and of a velocity multiplied by the step.
        tolerance: f64,
    },
}

impl Method {
    /// Returns the name that files and reports use for the method.
    pub fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::VelocityVerlet => "velocity-verlet",
            Self::RungeKutta4 => "runge-kutta-4",
            Self::BogackiShampine { .. } => "bogacki-shampine",
        }
    }

    /// Returns `true` if the method is adaptive.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Self::BogackiShampine { .. })
    }
}

/// Advances states by an integration method. Apart from the method, it contains only working memory.
#[derive(Clone, Debug)]
pub struct Integrator<S: Space> {
    method: Method,
    stages: runge_kutta::Stages<S>,
}

impl<S: Space> Integrator<S> {
    /// Creates an integrator for a method.
    pub fn new(method: Method) -> Self {
        Self { method, stages: runge_kutta::Stages::default() }
    }

    /// Prepares a state for the first step of any method: moves the prescribed bodies with the ground, and evaluates
    /// the forces.
    pub fn start(
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
    ) {
        place_prescribed(model, drive, state);
        state.contact_elements.rebuild(model, &state.poses, &state.twists);
        evaluate(model, state, scratch);
    }

    /// Advances `state` by one step: to the time `until` (s), or to an earlier time if an adaptive method requires a
    /// shorter step.
    ///
    /// Returns the step (s) to try next.
    pub fn step(
        &mut self,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: S::Real,
    ) -> S::Real {
        let dt = until - state.time;
        refresh(model, state, scratch, dt + scratch.lookahead);
        let next = match self.method {
            Method::SemiImplicitEuler => {
                verlet::semi_implicit_euler(model, drive, state, scratch, until);
                dt
            }
            Method::VelocityVerlet => {
                verlet::velocity_verlet(model, drive, state, scratch, until);
                dt
            }
            Method::RungeKutta4 => {
                let tableau = &runge_kutta::CLASSICAL;
                self.stages.fixed(tableau, model, drive, state, scratch, until);
                dt
            }
            Method::BogackiShampine { tolerance } => {
                let tableau = &runge_kutta::BOGACKI_SHAMPINE;
                self.stages.adaptive(tableau, tolerance, model, drive, state, scratch, until)
            }
        };
        state.contact_elements.end_step();
        next
    }
}

/// Updates the element list; if it changed, renumbers the elements in `scratch`.
///
/// The forces in `scratch` are kept. If they were evaluated again, they would change, because the velocities have since
/// been corrected and the contact history has been committed. Rebuilding the list would then affect the results, and
/// not only the speed.
fn refresh<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    dt: S::Real,
) {
    if let Some(origins) = state.contact_elements.refresh(model, &state.poses, &state.twists, dt) {
        scratch.renumber(&origins);
    }
}

/// Moves every prescribed body with the ground to the time of the state.
pub(crate) fn place_prescribed<S: Space>(
    model: &Model<S>,
    drive: &impl Drive<S>,
    state: &mut State<S>,
) {
    let (displacement, velocity) = drive.at(state.time);
    for i in (0..model.inert.len()).filter(|i| model.inert[*i].motion == Motion::Prescribed) {
        let Pose { position, orientation } = model.bodies[i].pose;
        state.poses[i] = Pose { position: position + displacement, orientation };
        state.twists[i] = Twist { linear: velocity, angular: S::Spin::default() };
    }
}

/// Returns the free bodies.
fn free<S: Space>(model: &Model<S>) -> impl Iterator<Item = usize> + '_ {
    model.inert.iter().enumerate().filter(|(_, b)| b.motion == Motion::Free).map(|(i, _)| i)
}

/// Ends a step: accepts the state at which `scratch` was evaluated.
fn accept<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>) {
    forces::commit(model, state, scratch);
}

/// Adds the slip rates, multiplied by a time (s), to the displacements of the tangential springs.
#[inline(always)]
fn advance_sticks<S: Space>(state: &mut State<S>, slip_rates: &[S::Tangent], time: S::Real) {
    for (stick, rate) in state.contact_elements.sticks.iter_mut().zip(slip_rates) {
        stick.displacement += *rate * time;
    }
}
