//! The run loop: time steps, energy balance, observers, and the end of a run.

use std::ops::ControlFlow;

use crate::energy::EnergyLedger;
use crate::forces::Scratch;
use crate::integrate::{Drive, Integrator, Method};
use crate::lanewise;
use crate::model::{Model, Substepping};
use crate::real::Real;
use crate::space::{Linear, Space};
use crate::state::State;

/// Observer of every accepted step, which may stop the run.
pub trait Observer<S: Space> {
    /// Receives an accepted state and its forces.
    fn observe(
        &mut self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        energy: &EnergyLedger<S>,
    ) -> ControlFlow<()>;
}

/// No-op observer.
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

/// Creates an observer from a function.
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

/// Integration settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulation {
    /// The method.
    pub method: Method,
    /// Time step (s). It is divided during impacts if the model has [`Substepping`]. For an adaptive method, it is the
    /// first step and the maximum step.
    pub time_step: f64,
    /// End time (s).
    pub end_time: f64,
}

/// Reason for the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// The end time was reached.
    EndTime,
    /// The observer stopped the run.
    Stopped,
}

/// Numerical failure of a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A number of the state is no longer finite.
    #[error(
        "the step failed at t = {time:.6} s: the motion of body \"{body}\" is no longer finite; try a \
         step below {time_step:.2e} s"
    )]
    NotFinite {
        /// Time (s).
        time: f64,
        /// The body.
        body: String,
        /// Time step (s).
        time_step: f64,
        /// Number of steps accepted before the failure.
        steps: u64,
    },
}

/// Totals of a run.
#[derive(Clone, Debug)]
pub struct RunTotals<S: Space> {
    /// Reason for the end of the run.
    pub finish: Finish,
    /// Number of accepted steps.
    pub steps: u64,
    /// Energy balance.
    pub energy: EnergyLedger<S>,
}

/// Runs `state` to the end time, or until the observer stops it.
///
/// The observer also receives the initial state. With a fixed step, times are whole multiples of the step or of its
/// substeps, counted from the start, so that rounding does not accumulate; the last step is shortened to end at the end
/// time.
///
/// # Errors
/// If a pose or twist is not finite; `state` is then the failed state.
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
    // A shorter remainder is due to rounding and is not a step.
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

/// Times of the steps of a run, in integer multiples of the shortest substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTimes<R: Real> {
    /// Number of shortest steps since the start.
    count: R,
    /// Numbers of shortest steps in a whole step (`whole`) and in an ordinary substep (`short`).
    whole: R,
    short: R,
    /// The shortest step (s).
    shortest: R,
    time_step: R,
    /// Lanes in which the current impact is hard. The step length changes only before and after an impact, since a
    /// change during an impact would cause an energy error.
    hard: R::Mask,
}

/// Lookahead for impacts, in time steps. It exceeds one step because velocities change within a step.
const LOOKAHEAD: f64 = 1.25;

impl<R: Real> StepTimes<R> {
    /// Creates the step times for a model with a time step (s).
    pub(crate) fn new<S: Space<Real = R>>(model: &Model<S>, time_step: R) -> Self {
        let Substepping { substeps, fast, .. } = &model.substepping;
        let short = R::splat(if fast.is_some() { 2.0 } else { 1.0 });
        let whole = *substeps * short;
        let (count, shortest) = (R::zero(), time_step / whole);
        Self { count, whole, short, shortest, time_step, hard: R::Mask::default() }
    }

    /// Disables substeps.
    fn undivided(&mut self) {
        (self.whole, self.short) = (R::splat(1.0), R::splat(1.0));
    }

    /// Returns the time span (s) over which impacts are predicted; zero if steps are never divided.
    pub(crate) fn lookahead(&self) -> R {
        let divided = self.short.lt(self.whole);
        R::select(divided, R::splat(LOOKAHEAD) * self.time_step, R::zero())
    }

    /// Returns the time (s) since the start at which the next step ends, given the lanes that need substeps and the
    /// lanes with a hard impact.
    #[inline(always)]
    pub(crate) fn next(&mut self, needs_substeps: R::Mask, is_hard: R::Mask) -> R {
        self.hard = needs_substeps & (self.hard | is_hard);
        let short = R::select(self.hard, R::splat(1.0), self.short);
        self.count += R::select(needs_substeps, short, self.whole);
        self.count * self.shortest
    }
}

lanewise!(struct StepTimes<R> { count, whole, short, shortest, time_step } masks { hard });

/// Returns the error for a lane in which a number is no longer finite.
///
/// The error names the first body whose motion is not finite or, if there is none, the body with the largest position
/// or velocity, since its energy overflows first.
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
        // NaN counts as infinite.
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
