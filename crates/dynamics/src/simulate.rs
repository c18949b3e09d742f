//! The run loop: steps, energy books, observers, and what ends a run.

use std::ops::ControlFlow;

use crate::energy::EnergyLedger;
use crate::forces::Scratch;
use crate::integrate::{Drive, Integrator, Method};
use crate::lanewise;
use crate::model::{Model, Substepping};
use crate::real::Real;
use crate::space::{Linear, Space};
use crate::state::State;

/// Sees every accepted step; may ask to stop.
pub trait Observer<S: Space> {
    /// Looks at an accepted state and the forces at it.
    fn observe(
        &mut self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        energy: &EnergyLedger<S>,
    ) -> ControlFlow<()>;
}

/// Looks at nothing.
impl<S: Space> Observer<S> for () {
    fn observe(
        &mut self,
        _: &Model<S>,
        _: &State<S>,
        _: &Scratch<S>,
        _: &EnergyLedger<S>,
    ) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// An observer made of a function.
pub fn look<S: Space>(
    look: impl FnMut(&State<S>, &Scratch<S>, &EnergyLedger<S>) -> ControlFlow<()>,
) -> impl Observer<S> {
    Look(look)
}

struct Look<F>(F);

impl<S, F> Observer<S> for Look<F>
where
    S: Space,
    F: FnMut(&State<S>, &Scratch<S>, &EnergyLedger<S>) -> ControlFlow<()>,
{
    fn observe(
        &mut self,
        _: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        energy: &EnergyLedger<S>,
    ) -> ControlFlow<()> {
        (self.0)(state, scratch, energy)
    }
}

/// How a run is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulation {
    /// The method.
    pub method: Method,
    /// The time step (s), which impacts divide where the model says so ([`Substepping`]);
    /// for an adaptive method, the first and the longest.
    pub time_step: f64,
    /// When the run ends (s).
    pub end_time: f64,
}

/// How a run came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// The end time was reached.
    EndTime,
    /// The observer asked to stop.
    Stopped,
}

/// Why a run broke down.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A number was lost.
    #[error(
        "the step failed at t = {time:.6} s: body \"{body}\" left the finite numbers; try a step \
         below {time_step:.2e} s"
    )]
    NotFinite {
        /// When (s).
        time: f64,
        /// Which body.
        body: String,
        /// The step that was used (s).
        time_step: f64,
        /// Steps that had been accepted before.
        steps: u64,
    },
}

/// What a run leaves behind.
#[derive(Clone, Debug)]
pub struct RunTotals<S: Space> {
    /// How it ended.
    pub finish: Finish,
    /// Accepted steps.
    pub steps: u64,
    /// The energy books.
    pub energy: EnergyLedger<S>,
}

/// Runs `state` to the end time, or until the observer stops it.
///
/// The observer also sees the state at the start.
/// With a fixed step the times are whole multiples of it, or of its substeps, counted from the start, so
/// that no rounding adds up; the last step is shortened to end on time.
///
/// # Errors
/// When a pose or twist leaves the finite numbers; `state` is then the state it happened in.
pub fn simulate<S: Space<Real = f64>>(
    model: &Model<S>,
    drive: &impl Drive<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    simulation: &Simulation,
    observer: &mut impl Observer<S>,
) -> Result<RunTotals<S>, RunError> {
    let mut integrator = Integrator::new(simulation.method);
    let mut times = StepTimes::new(model, simulation.time_step);
    if simulation.method.is_adaptive() {
        times.undivided();
    }
    scratch.lookahead = times.lookahead();
    Integrator::start(model, drive, state, scratch);
    let mut energy = EnergyLedger::new(model, state, scratch);
    let start = state.time;
    let mut steps = 0_u64;
    let mut next_step = simulation.time_step;
    // A remainder below this is rounding, not a step.
    let sliver = 1e-9 * simulation.time_step;
    let mut finish = Finish::EndTime;
    if observer.observe(model, state, scratch, &energy).is_break() {
        finish = Finish::Stopped;
    }
    while finish == Finish::EndTime && state.time < simulation.end_time - sliver {
        let target = if simulation.method.is_adaptive() {
            state.time + next_step.min(simulation.time_step)
        } else {
            start + times.next(scratch.needs_substeps, scratch.is_hard)
        };
        let until =
            if target < simulation.end_time - sliver { target } else { simulation.end_time };
        next_step = integrator.step(model, drive, state, scratch, until);
        steps += 1;
        energy.enter(model, state, scratch);
        if !energy.finite() {
            return Err(lost_body(model, state, 0, simulation.time_step, steps - 1));
        }
        if observer.observe(model, state, scratch, &energy).is_break() {
            finish = Finish::Stopped;
        }
    }
    Ok(RunTotals { finish, steps, energy })
}

/// The times of the steps of a run: whole numbers of the shortest steps into which impacts divide a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTimes<R: Real> {
    /// Shortest steps since the start.
    count: R,
    /// Shortest steps in a step, and in a short one.
    whole: R,
    short: R,
    /// The shortest step (s).
    shortest: R,
    time_step: R,
    /// Whether an impact that is not over was hard: the length of steps changes before an impact and after it, since
    /// within one that would cost energy.
    hard: R::Mask,
}

/// How much longer than a step impacts are foreseen, since velocities change within it.
const LOOKAHEAD: f64 = 1.25;

impl<R: Real> StepTimes<R> {
    /// Those of a model, by a time step (s).
    pub(crate) fn new<S: Space<Real = R>>(model: &Model<S>, time_step: R) -> Self {
        let Substepping { substeps, fast, .. } = &model.substepping;
        let short = R::splat(if fast.is_some() { 2.0 } else { 1.0 });
        let whole = *substeps * short;
        let (count, shortest) = (R::zero(), time_step / whole);
        Self { count, whole, short, shortest, time_step, hard: R::Mask::default() }
    }

    /// No step is divided.
    fn undivided(&mut self) {
        (self.whole, self.short) = (R::splat(1.0), R::splat(1.0));
    }

    /// How far (s) impacts are foreseen; zero where no step is divided.
    pub(crate) fn lookahead(&self) -> R {
        let divided = self.short.lt(self.whole);
        R::select(divided, R::splat(LOOKAHEAD) * self.time_step, R::zero())
    }

    /// The time (s) since the start at which the next step ends, where impacts need short steps and are hard or not.
    #[inline(always)]
    pub(crate) fn next(&mut self, needs_substeps: R::Mask, is_hard: R::Mask) -> R {
        self.hard = needs_substeps & (self.hard | is_hard);
        let short = R::select(self.hard, R::splat(1.0), self.short);
        self.count += R::select(needs_substeps, short, self.whole);
        self.count * self.shortest
    }
}

lanewise!(struct StepTimes<R> { count, whole, short, shortest, time_step } masks { hard });

/// Names the first body of a lane that is not where a finite number says, or else the one that moves
/// most: its energy is the first to leave the finite numbers.
pub(crate) fn lost_body<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    lane: usize,
    time_step: f64,
    steps: u64,
) -> RunError {
    let size = |i: usize| {
        let (pose, twist) = (state.poses[i], state.twists[i]);
        let size = pose.position.dot(pose.position)
            + twist.linear.dot(twist.linear)
            + twist.angular.dot(twist.angular);
        // A lost number counts as infinite.
        if size.lane(lane).is_finite() { size.lane(lane) } else { f64::INFINITY }
    };
    let bodies = || 0..model.bodies.len();
    let lost = bodies().find(|i| size(*i).is_infinite());
    let fastest = || bodies().max_by(|a, b| size(*a).total_cmp(&size(*b)));
    let body = lost.or_else(fastest).unwrap_or(0);
    RunError::NotFinite {
        time: state.time.lane(lane),
        body: model.bodies[body].name.clone(),
        time_step,
        steps,
    }
}
