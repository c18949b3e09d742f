//! The run loop: time steps, energy balance, external forces, observers, and the end of a run.

use std::ops::ControlFlow;

use crate::applied::{Applied, ApplyError};
use crate::energy::EnergyLedger;
use crate::forces::Scratch;
use crate::integrate::{Drive, Integrator, Method};
use crate::lanewise;
use crate::model::{Model, Substepping};
use crate::real::Real;
use crate::space::{Linear, Space, Twist, Wrench};
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
    /// Integration method.
    pub method: Method,
    /// Time step (s). During impacts, the step is divided into substeps if the model has [`Substepping`]. For an
    /// adaptive method, this is both the first step and the maximum step.
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
    /// A number in the state is no longer finite.
    #[error(
        "the step failed at t = {time:.6} s: the motion of body \"{body}\" is no longer finite; try a \
         step below {time_step:.2e} s"
    )]
    NotFinite {
        /// Time (s) at the end of the failed step.
        time: f64,
        /// Name of the body whose motion is not finite.
        body: String,
        /// Time step (s) of the run, [`Simulation::time_step`]; a substep is shorter.
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
    let mut stepper = Stepper::start(model, drive, state, scratch, simulation);
    let mut finish = Finish::EndTime;
    if observer.observe(model, state, scratch, &stepper.energy).is_break() {
        finish = Finish::Stopped;
    }
    while finish == Finish::EndTime && !stepper.is_at_end(state) {
        stepper.step(model, drive, state, scratch)?;
        if observer.observe(model, state, scratch, &stepper.energy).is_break() {
            finish = Finish::Stopped;
        }
    }
    Ok(RunTotals { finish, steps: stepper.steps, energy: stepper.energy })
}

/// A run that advances one accepted step at a time; [`simulate`] steps until the end.
///
/// Together with the state and the working memory, a copy of the stepper is the complete state of a run: a run that
/// continues from these copies gives bit-identical results.
///
/// ```
/// use barrelstack_dynamics::{
///     Applied, Body, Method, Model, Motion, Planar, Pose, Scratch, Simulation, State, Stepper, Still, Twist, Vec2,
/// };
///
/// let body = Body {
///     name: "load".to_owned(),
///     motion: Motion::Free,
///     mass: 100.0,
///     inertia: 5.0,
///     damping: None,
///     pose: Pose { position: Vec2::default(), orientation: 0.0 },
///     twist: Twist::<Planar>::default(),
///     surfaces: Vec::new(),
///     nodes: Vec::new(),
///     faces: Vec::new(),
/// };
/// let model = Model::new(vec![body], Vec::new(), Vec::new(), Vec2::default())?;
/// let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
/// let run = Simulation { method: Method::VelocityVerlet, time_step: 1e-3, end_time: 1.0 };
/// let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
/// let (force, point) = (Vec2::new(50.0, 0.0), Vec2::default());
/// let push = Applied { body: 0, force, point, moment: 0.0 };
/// stepper.apply(&model, &mut state, &mut scratch, push)?;
/// while !stepper.is_at_end(&state) {
///     stepper.step(&model, &Still, &mut state, &mut scratch)?;
/// }
/// assert!((state.poses[0].position.x - 0.25).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stepper<S: Space> {
    simulation: Simulation,
    integrator: Integrator<S>,
    times: StepTimes<S::Real>,
    /// Energy balance since the start.
    pub energy: EnergyLedger<S>,
    /// Time (s) of the initial state.
    start: f64,
    /// Number of accepted steps.
    pub steps: u64,
    /// Step (s) to try next, for an adaptive method.
    next_step: f64,
}

impl<S: Space<Real = f64>> Stepper<S> {
    /// Prepares a run from `state`: moves the prescribed bodies with the ground, and evaluates the forces.
    pub fn start(
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        simulation: &Simulation,
    ) -> Self {
        let mut times = StepTimes::new(model, simulation.time_step);
        if simulation.method.is_adaptive() {
            times.undivided();
        }
        scratch.lookahead = times.lookahead();
        Integrator::start(model, drive, state, scratch);
        Self {
            simulation: *simulation,
            integrator: Integrator::new(simulation.method),
            times,
            energy: EnergyLedger::new(model, state, scratch),
            start: state.time,
            steps: 0,
            next_step: simulation.time_step,
        }
    }

    /// Creates the stepper of a joined model, which continues the runs `sources` from `state`. If the sources took
    /// their steps at the same times, the new run continues this sequence of times.
    pub(crate) fn after(
        sources: &[&Self],
        model: &Model<S>,
        state: &State<S>,
        scratch: &mut Scratch<S>,
        energy: EnergyLedger<S>,
        simulation: &Simulation,
    ) -> Self {
        let first = sources[0];
        let mut times = StepTimes::new(model, simulation.time_step);
        if simulation.method.is_adaptive() {
            times.undivided();
        }
        let alike = |source: &&Self| {
            let own = source.times;
            (own.whole, own.short, own.shortest) == (times.whole, times.short, times.shortest)
                && (own.count, source.start) == (first.times.count, first.start)
                && source.start + own.count * own.shortest == state.time
        };
        let mut start = state.time;
        if sources.iter().all(alike) {
            (times.count, start) = (first.times.count, first.start);
        }
        times.hard = sources.iter().any(|source| source.times.hard);
        scratch.lookahead = times.lookahead();
        let next_step = sources.iter().map(|source| source.next_step);
        Self {
            simulation: *simulation,
            integrator: Integrator::new(simulation.method),
            times,
            energy,
            start,
            steps: 0,
            next_step: next_step.fold(simulation.time_step, f64::min),
        }
    }

    /// Takes one step. If the step would end after the time `until` (s), it is shortened to end at that time.
    ///
    /// # Errors
    /// The same as for [`Stepper::step`].
    pub fn step_until(
        &mut self,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: f64,
    ) -> Result<(), RunError> {
        let (end_time, times) = (self.simulation.end_time, self.times);
        self.simulation.end_time = end_time.min(until);
        let result = self.step(model, drive, state, scratch);
        self.simulation.end_time = end_time;
        // A shortened step does not count, so the next step ends at the time at which the shortened one would have
        // ended.
        if state.time < self.start + self.times.count * self.times.shortest {
            self.times.count = times.count;
        }
        result
    }

    /// Returns the duration (s) below which the remaining time of a run is a rounding error, so that no further step is
    /// taken.
    #[inline]
    fn sliver(&self) -> f64 {
        1e-9 * self.simulation.time_step
    }

    /// Returns `true` if the end time is reached.
    #[inline]
    pub fn is_at_end(&self, state: &State<S>) -> bool {
        state.time >= self.simulation.end_time - self.sliver()
    }

    /// Takes one step; during impacts, one substep.
    ///
    /// # Errors
    /// If a pose or twist is not finite; `state` is then the failed state.
    #[inline]
    pub fn step(
        &mut self,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
    ) -> Result<(), RunError> {
        let Simulation { method, time_step, end_time } = self.simulation;
        let target = if method.is_adaptive() {
            state.time + self.next_step.min(time_step)
        } else {
            self.start + self.times.next(scratch.needs_substeps, scratch.is_hard)
        };
        let until = if target < end_time - self.sliver() { target } else { end_time };
        self.next_step = self.integrator.step(model, drive, state, scratch, until);
        self.steps += 1;
        self.energy.enter(model, state, scratch);
        if !self.energy.finite() {
            return Err(lost_body(model, state, 0, time_step, self.steps - 1));
        }
        Ok(())
    }

    /// Sets the external force on a body, and replaces an earlier external force on this body. The force stays constant
    /// during the next steps; setting force and moment to zero removes it.
    ///
    /// Only the difference from the earlier force is added to the forces of the current state. So if the same force is
    /// set again, the results are bit-identical.
    ///
    /// # Errors
    /// If there is no such body, if the body follows the ground, or if a number is not finite.
    pub fn apply(
        &mut self,
        model: &Model<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        applied: Applied<S>,
    ) -> Result<(), ApplyError> {
        let [before, after] = applied.replace(model, &mut state.applied)?;
        let old = before.map_or_else(Wrench::default, |at| scratch.applied[at]);
        let new = after.map_or_else(Wrench::default, |_| applied.wrench(&scratch.rotations));
        for list in [&mut scratch.applied, &mut self.energy.applied] {
            match (before, after) {
                (_, Some(at)) if at == list.len() => list.push(new),
                (_, Some(at)) => list[at] = new,
                (Some(at), None) => {
                    list.remove(at);
                }
                (None, None) => {}
            }
        }
        let change = new.plus(old.times(-1.0));
        let (body, inert) = (applied.body, &model.inert[applied.body]);
        scratch.wrenches[body] += change;
        let kick = Twist {
            linear: change.force * (1.0 / inert.mass),
            angular: S::spin_rate(inert.inertia, scratch.rotations[body], change.moment),
        };
        scratch.accelerations[body] = scratch.accelerations[body].plus(kick, 1.0);
        Ok(())
    }
}

/// Times of the steps of a run, as integer multiples of the shortest substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTimes<R: Real> {
    /// Time since the start, as a multiple of the shortest substep.
    count: R,
    /// Lengths of a whole step (`whole`) and of an ordinary substep (`short`), as multiples of the shortest substep.
    whole: R,
    short: R,
    /// Length (s) of the shortest substep.
    shortest: R,
    time_step: R,
    /// Lanes in which the current impact is hard, as defined by [`Fast::hard`](crate::model::Fast::hard). They take the
    /// shortest substep until no substeps are needed anymore. The step length changes only before and after an impact,
    /// since a change during an impact would cause an energy error.
    hard: R::Mask,
}

/// Lookahead for impacts, in time steps. It exceeds one step because velocities change within a step.
const LOOKAHEAD: f64 = 1.25;

impl<R: Real> StepTimes<R> {
    /// Creates the step times of a run of `model` with the given time step (s).
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
