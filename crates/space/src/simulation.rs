//! A three-dimensional run that advances step by step. Forces can be applied to its bodies, and it can be copied at any
//! time.

use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack::RunFailure;
use barrelstack::run::{Ended, Progress, Verdict, Work, method, thresholds};
use barrelstack::scenario::Scenario;
use barrelstack::step::restitution_warning;
use barrelstack::watch::{ElementFates, Ending, ForceBetween, PROGRESS, after_collapse, leans_on};
use barrelstack_dynamics::forces::{PairForce, centers_of_pressure};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::space::Wrench;
use barrelstack_dynamics::{
    Applied, ApplyError, BodyId, EnergySummary, Model, Pose, RunError, Scratch, Settled, Spatial,
    State, Stepper, Twist, Vec3,
};

use crate::fate::Fates;
use crate::ground::Ground;
use crate::rest::Rest;
use crate::run::{Frames, Run, Standing, affordable, at_rest, judge};
use crate::seats::Seats;
use crate::stack::Stack;

/// A three-dimensional run of a scenario, which advances by any number of steps at a time.
///
/// [`run`](crate::run::run()) runs such a simulation to its end, so the results of both are bit-identical. A clone has
/// the complete state, so it continues exactly as the original does. Clones share the stack and the ground motion.
///
/// ```
/// use barrelstack::Scenario;
/// use barrelstack_space::{Ground, Simulation};
///
/// let scenario = Scenario::builtin("rolling-ball", &[])?;
/// let mut simulation = Simulation::new(&scenario, Ground::of(&scenario)?)?;
/// simulation.step(50);
/// let kept = simulation.clone();
/// simulation.step(50);
/// assert!(simulation.time() > kept.time());
/// assert_eq!(kept.run().last, simulation.run().last);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulation {
    fixed: Arc<Fixed>,
    state: State<Spatial>,
    scratch: Scratch<Spatial>,
    stepper: Stepper<Spatial>,
    watch: Watch,
    /// The numerical failure that ended the run; `None` if no step has failed.
    failure: Option<RunError>,
}

/// Everything that does not change during a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Fixed {
    pub(crate) scenario: Scenario,
    pub(crate) ground: Ground,
    pub(crate) stack: Arc<Stack>,
    settled: Option<Settled>,
    pub(crate) settings: barrelstack_dynamics::Simulation,
    /// Numbers of force evaluations and of tested contact elements while the stack settled, before the run.
    before: (u64, u64),
}

/// A run that is ready to start, with its stack at rest and its observers.
#[derive(Debug)]
pub(crate) struct Prepared {
    pub(crate) fixed: Arc<Fixed>,
    pub(crate) state: State<Spatial>,
    scratch: Scratch<Spatial>,
    pub(crate) watch: Watch,
}

/// Observers of a run, which record outcomes, seat forces and frames, and determine when the run ends.
#[derive(Clone, Debug)]
pub(crate) struct Watch {
    fates: Fates,
    elements: ElementFates,
    seats: Seats,
    rest: Rest,
    frames: Frames,
    /// Time (s) between two frames.
    every: f64,
    /// Time (s) for which the run continues after a collapse.
    after_collapse: f64,
    pub(crate) ending: Option<Ending>,
}

/// Maximum number of steps between two calls to the observer.
///
/// The simulated time between two calls is limited as well. That limit alone would not be enough, because a step with
/// many bodies takes a long time.
const PATIENCE: u32 = 16;

impl Prepared {
    /// Builds the three-dimensional stack of a scenario, settles the stack, and creates the observers of its run under
    /// a given ground motion.
    ///
    /// # Errors
    /// The same as for [`Simulation::new`].
    pub(crate) fn new(scenario: &Scenario, ground: Ground) -> Result<Self, RunFailure> {
        let stack = Stack::of(scenario)?;
        let end_time = affordable(scenario, &stack, &ground)?;
        let Standing { stack, state, scratch, settled } = at_rest(scenario, stack)?;
        let settings = barrelstack_dynamics::Simulation {
            method: method(scenario),
            time_step: stack.step,
            end_time,
        };
        let before = (scratch.evaluations, scratch.contact_evaluations);
        let stack = Arc::new(stack);
        let watch = Watch {
            fates: Fates::new(Arc::clone(&stack), &state, thresholds(scenario)),
            elements: ElementFates::default(),
            seats: Seats::new(&stack, state.time, &scratch),
            rest: Rest::new(scenario, Arc::clone(&stack), &ground),
            frames: Frames::default(),
            every: 1.0 / scenario.record.frame_rate,
            after_collapse: after_collapse(scenario),
            ending: None,
        };
        let scenario = scenario.clone();
        let fixed = Arc::new(Fixed { scenario, ground, stack, settled, settings, before });
        Ok(Self { fixed, state, scratch, watch })
    }

    /// Starts the run under the ground motion.
    pub(crate) fn start(self) -> Simulation {
        let Self { fixed, mut state, mut scratch, mut watch } = self;
        let Fixed { ground, stack, settings, .. } = &*fixed;
        let stepper = Stepper::start(&stack.model, ground, &mut state, &mut scratch, settings);
        watch.observe(&stack.model, &state, &scratch);
        watch.end(&state);
        Simulation { fixed, state, scratch, stepper, watch, failure: None }
    }

    /// Returns `true` if the run can advance in a lane, together with other runs. This requires that the method has
    /// fixed time steps, and that the run cannot end before its first step.
    pub(crate) fn can_share_steps(&self) -> bool {
        !self.fixed.settings.method.is_adaptive() && self.watch.after_collapse > 0.0
    }
}

impl Simulation {
    /// Builds the three-dimensional stack of a scenario, settles the stack, and prepares its run under a given ground
    /// motion.
    ///
    /// # Errors
    /// If the stack cannot be built in three dimensions or does not stand, or if the run would be too long or need too
    /// much memory.
    pub fn new(scenario: &Scenario, ground: Ground) -> Result<Self, RunFailure> {
        Ok(Prepared::new(scenario, ground)?.start())
    }

    /// Advances by `most` steps, or by fewer if the run ends earlier. During impacts, a time step is divided into
    /// several steps.
    ///
    /// Returns the number of steps that were taken.
    pub fn step(&mut self, most: u64) -> u64 {
        let before = self.stepper.steps;
        while self.stepper.steps - before < most && self.goes_on() && self.take_step() {
            self.watch.end(&self.state);
        }
        self.stepper.steps - before
    }

    /// Runs to the end and returns the result.
    pub fn run(self) -> Run {
        self.run_watched(&mut |_| ControlFlow::Continue(()))
    }

    /// Runs to the end with an observer that may stop the run, and returns the result.
    ///
    /// The observer receives the progress at least every 0.05 s of simulated time.
    pub fn run_watched(mut self, observer: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Run {
        // The result does not contain the list of contacts.
        self.scratch.keeps_contacts = false;
        let end_time = self.end_time();
        let (mut next_look, mut steps) = (self.state.time, 0);
        loop {
            let time = self.state.time;
            steps += 1;
            if time >= next_look || steps == PATIENCE {
                (next_look, steps) = (time + PROGRESS, 0);
                if observer(Progress { time, end_time }).is_break() {
                    self.watch.ending = Some(Ending::Interrupted);
                    break;
                }
            }
            self.watch.end(&self.state);
            if !(self.goes_on() && self.take_step()) {
                break;
            }
        }
        self.finish()
    }

    fn goes_on(&self) -> bool {
        self.watch.ending.is_none()
            && self.failure.is_none()
            && !self.stepper.is_at_end(&self.state)
    }

    /// Takes a step and observes the accepted state; returns `false` if the step failed.
    fn take_step(&mut self) -> bool {
        let Self { fixed, state, scratch, stepper, watch, failure } = self;
        match stepper.step(&fixed.stack.model, &fixed.ground, state, scratch) {
            Ok(()) => {
                watch.observe(&fixed.stack.model, state, scratch);
                true
            }
            Err(error) => {
                *failure = Some(error);
                false
            }
        }
    }

    /// Returns the result so far; a simulation that has not ended counts as interrupted.
    pub fn finish(self) -> Run {
        let ending = self.ending().unwrap_or(Ending::Interrupted);
        let Self { fixed, state, scratch, stepper, watch, failure } = self;
        let ended = match failure {
            Some(error) => Err(error),
            None => Ok(Ended { energy: stepper.energy.summary(0), steps: stepper.steps }),
        };
        let before = fixed.before;
        let work = Work {
            steps: stepper.steps,
            evaluations: scratch.evaluations - before.0,
            contact_evaluations: scratch.contact_evaluations - before.1,
        };
        watch.conclude(fixed, state, ended, work, ending)
    }

    /// Sets the external force on a body. It replaces the previous external force on this body, and acts until it is
    /// changed.
    ///
    /// The work of such forces is part of the energy balance.
    ///
    /// # Errors
    /// If there is no such body, if the body follows the ground, or if a number is not finite.
    pub fn apply(&mut self, applied: Applied<Spatial>) -> Result<(), ApplyError> {
        let model = &self.fixed.stack.model;
        self.stepper.apply(model, &mut self.state, &mut self.scratch, applied)
    }

    /// Returns the simulated time (s).
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Returns the latest time (s) at which the run ends. The run may end earlier, when all bodies are at rest or after
    /// a collapse.
    pub fn end_time(&self) -> f64 {
        self.fixed.settings.end_time
    }

    /// Returns the number of accepted steps.
    pub fn steps(&self) -> u64 {
        self.stepper.steps
    }

    /// Returns the reason for the end of the run; `None` while it goes on.
    pub fn ending(&self) -> Option<Ending> {
        if self.failure.is_some() {
            return Some(Ending::Broken);
        }
        let at_end = || self.stepper.is_at_end(&self.state);
        self.watch.ending.or_else(|| at_end().then(|| Ending::of_time(&self.fixed.scenario)))
    }

    /// Returns the current state.
    pub fn state(&self) -> &State<Spatial> {
        &self.state
    }

    /// Returns the contacts, the forces on the bodies, and the loads of the force elements in the current state.
    pub fn scratch(&self) -> &Scratch<Spatial> {
        &self.scratch
    }

    /// Returns the contact forces between all bodies that touch in the current state.
    pub fn forces(&self) -> Vec<ForceBetween<Spatial>> {
        let parts = &self.fixed.stack.parts;
        let supports = |body: BodyId| {
            let part = &parts[body];
            leans_on(part.kind, part.carrier, &part.supports)
        };
        ForceBetween::all(&self.scratch.pair_forces, supports)
    }

    /// Returns the energy balance since the start.
    pub fn energy(&self) -> EnergySummary {
        self.stepper.energy.summary(0)
    }

    /// Returns the outcomes of all bodies so far.
    pub fn fates(&self) -> &Fates {
        &self.watch.fates
    }

    /// Returns the scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.fixed.scenario
    }

    /// Returns the stack.
    pub fn stack(&self) -> &Stack {
        &self.fixed.stack
    }

    /// Returns the ground motion.
    pub fn ground(&self) -> &Ground {
        &self.fixed.ground
    }

    /// Returns `true` if both simulations are clones of the same simulation, even if they are in different states.
    pub fn is_clone_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.fixed, &other.fixed)
    }
}

impl Watch {
    /// Observes the initial state or an accepted step.
    pub(crate) fn observe(
        &mut self,
        model: &Model<Spatial>,
        state: &State<Spatial>,
        scratch: &Scratch<Spatial>,
    ) {
        self.observe_lane(0, (state, &scratch.wrenches), state, scratch);
        if state.time >= self.frames.times.len() as f64 * self.every {
            self.frames.times.push(state.time);
            let pose = |pose: &Pose<Spatial>| {
                let (p, q) = (pose.position, pose.orientation);
                [p.x, p.y, p.z, q.w, q.v.x, q.v.y, q.v.z]
            };
            self.frames.poses.push(state.poses.iter().map(pose).collect());
            let twist = |twist: &Twist<Spatial>| {
                let (v, w) = (twist.linear, twist.angular);
                [v.x, v.y, v.z, w.x, w.y, w.z]
            };
            self.frames.twists.push(state.twists.iter().map(twist).collect());
            let push = |(pair, center): (PairForce<Spatial>, Vec3)| {
                // Of the two opposite forces of a pair, the one that pushes its body upward is recorded.
                let force = if pair.force.z < 0.0 { -pair.force } else { pair.force };
                let numbers = [center.x, center.y, center.z, force.x, force.y, force.z];
                (pair.pair, numbers)
            };
            let pushes = centers_of_pressure(model, state, scratch).into_iter().map(push);
            self.frames.forces.push(pushes.collect());
        }
    }

    /// Observes an accepted step of one lane, without recording frames. `own` is the state of the lane, in which only
    /// time, poses and twists are current; `wrenches` are the wrenches on the bodies of the lane.
    pub(crate) fn observe_lane<R: Real>(
        &mut self,
        lane: usize,
        (own, wrenches): (&State<Spatial>, &[Wrench<Spatial>]),
        state: &State<Spatial<R>>,
        scratch: &Scratch<Spatial<R>>,
    ) {
        // The stack still counts as standing in the first state in which a body has left its seat.
        let standing = self.fates.collapse().is_none();
        self.fates.observe_bodies(own.time, &own.poses, wrenches);
        self.elements.observe_lane(lane, state, standing, scratch);
        self.seats.observe((lane, own.time), standing, scratch);
    }

    /// Returns the result of a run, given its final state.
    pub(crate) fn conclude(
        self,
        fixed: Arc<Fixed>,
        state: State<Spatial>,
        ended: Result<Ended, RunError>,
        work: Work,
        ending: Ending,
    ) -> Run {
        // The stack is copied if other simulations share it.
        let Fixed { scenario, ground, stack, settled, settings, .. } = Arc::unwrap_or_clone(fixed);
        let Self { fates, elements, seats, frames, .. } = self;
        let judge = || judge(&stack, &fates);
        let Verdict { outcome, energy, steps, warnings: warned, ending } =
            Verdict::of(ended, judge, state.time, ground.end(), ending);
        let warnings = ground
            .warnings
            .iter()
            .cloned()
            .chain(warned)
            .chain(restitution_warning(&scenario))
            .collect();
        let heading = fates.collapse().and_then(|(_, body)| fates.all()[body].left_seat);
        Run {
            outcome,
            heading: heading.map(|(.., heading)| heading),
            first_fall: fates.first_fall(),
            fates: fates.at_end(&state.poses),
            elements: elements.0,
            seats,
            frames,
            energy,
            settled,
            simulation: settings,
            work: Work { steps, ..work },
            end_time: state.time,
            ending,
            warnings,
            ground,
            stack: Arc::unwrap_or_clone(stack),
            last: state,
            scenario,
        }
    }

    /// Ends the run if the last observed state meets one of the criteria for the end of a run.
    pub(crate) fn end(&mut self, state: &State<Spatial>) {
        if self.ending.is_some() {
            return;
        }
        let collapse = self.fates.collapse();
        if self.rest.observe(state, collapse.is_some()) {
            self.ending = Some(Ending::Rest);
        } else if collapse.is_some_and(|(at, _)| at + self.after_collapse <= state.time) {
            self.ending = Some(Ending::AfterCollapse);
        }
    }
}
