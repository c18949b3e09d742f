//! A run that advances step by step, accepts external forces, and can be copied at any time.

use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack_dynamics::{
    Applied, ApplyError, BodyId, EnergySummary, Planar, RunError, Scratch, Settled, State, Stepper,
};

use crate::assemble::Assembly;
use crate::ground::Ground;
use crate::outcome::Outcome;
use crate::run::{
    Ended, Run, RunFailure, Verdict, Work, check_memory, conclude, end_time, method, thresholds,
};
use crate::scenario::Scenario;
use crate::stand::{Standing, stand};
use crate::step::restitution_warning;
use crate::stick::SoftStick;
use crate::watch::{
    End, Ending, Eye, Fates, ForceBetween, Glance, Pace, Recording, Watch, leans_on,
};

/// A run of a scenario in a plane, which advances by any number of steps.
///
/// [`Scenario::run`] runs a simulation to its end, so the results of both are bit-identical. A clone has the complete
/// state: positions, velocities, friction springs, history of devices, recordings and stop criteria. It continues with
/// bit-identical results. Clones share the stack and the ground motion.
///
/// ```
/// use barrelstack_dynamics::{Applied, Vec2};
/// use barrelstack_stack::{Scenario, Simulation};
///
/// let scenario = Scenario::builtin("sliding-block", &[])?;
/// let mut simulation = Simulation::new(&scenario, scenario.ground()?)?;
/// simulation.step(100);
/// // A brake, which acts on the block until the force is changed.
/// let mut braked = simulation.clone();
/// let brake = Vec2::new(-500.0, 0.0);
/// braked.apply(Applied { body: 1, force: brake, point: Vec2::default(), moment: 0.0 })?;
/// braked.step(100);
/// simulation.step(100);
/// assert!(braked.state().twists[1].linear.x < simulation.state().twists[1].linear.x);
/// assert_eq!(simulation.run().end_time, scenario.run()?.end_time);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulation {
    fixed: Arc<Fixed>,
    state: State<Planar>,
    scratch: Scratch<Planar>,
    stepper: Stepper<Planar>,
    watch: Watch,
    /// The numerical failure that ended the run.
    failure: Option<RunError>,
}

/// Everything that does not change during a simulation.
#[derive(Clone, Debug)]
struct Fixed {
    scenario: Scenario,
    ground: Ground,
    assembly: Assembly,
    settled: Option<Settled>,
    settings: barrelstack_dynamics::Simulation,
    sticks: Vec<SoftStick>,
    /// Number of force evaluations before the run, including the evaluations during settling, and number of contact
    /// elements that were tested in these evaluations.
    before: (u64, u64),
}

impl Simulation {
    /// Builds the stack of a scenario, settles it, and prepares its run on a given ground.
    ///
    /// # Errors
    /// If the stack cannot be built or does not come to rest under its own weight, or if the run would be too long or
    /// need too much memory.
    pub fn new(scenario: &Scenario, ground: Ground) -> Result<Self, RunFailure> {
        let time_scale = scenario.run.similitude.sqrt();
        let end_time = end_time(scenario, ground.motion_end(), time_scale)?;
        let Standing { assembly, mut state, mut scratch, settled, step } =
            stand(scenario, end_time)?;
        let settings = barrelstack_dynamics::Simulation {
            method: method(scenario),
            time_step: step,
            end_time,
        };
        let record = &scenario.record;
        let rates = (record.frame_rate / time_scale, record.history_rate / time_scale);
        check_memory(&assembly, end_time, rates)?;
        let before = (scratch.evaluations, scratch.contact_evaluations);
        let sticks = SoftStick::of(&assembly, &scratch, ground.motion.as_ref());
        let end = End::new(scenario, &assembly, &ground);
        let mut watch = Watch::new(&assembly, &state, &scratch, thresholds(scenario), rates, end);
        let model = &assembly.model;
        let stepper = Stepper::start(model, &ground, &mut state, &mut scratch, &settings);
        watch.see(&assembly, &ground, &state, &scratch, &stepper.energy);
        watch.end(&state);
        let scenario = scenario.clone();
        let fixed = Fixed { scenario, ground, assembly, settled, settings, sticks, before };
        let fixed = Arc::new(fixed);
        Ok(Self { fixed, state, scratch, stepper, watch, failure: None })
    }

    /// Advances by up to `most` steps, or by fewer if the run ends. During impacts, a step is divided into shorter
    /// steps, and each of these counts.
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
        self.run_before(Pace::Time, &mut |_| ControlFlow::Continue(()))
    }

    /// Runs to the end with a callback that may stop the run, and returns the result.
    pub fn run_before(mut self, pace: Pace, eye: &mut Eye<'_>) -> Run {
        // The first state is the start, which is not the result of a step.
        let mut next_look = self.state.time;
        loop {
            let (time, steps) = (self.state.time, self.stepper.steps);
            let due = match pace {
                Pace::Time => time >= next_look,
                Pace::Steps(every) => steps.is_multiple_of(every.get()),
            };
            if due {
                next_look = time + crate::watch::PROGRESS;
                if eye(Glance { time, steps, state: &self.state }).is_break() {
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
        let Fixed { assembly, ground, .. } = &**fixed;
        match stepper.step(&assembly.model, ground, state, scratch) {
            Ok(()) => {
                watch.see(assembly, ground, state, scratch, &stepper.energy);
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
        // Other simulations may share the stack.
        let Fixed { scenario, ground, assembly, settled, settings, sticks, before } =
            Arc::unwrap_or_clone(fixed);
        let Watch { mut recording, mut stresses, fates, elements, .. } = watch;
        recording.finish();
        let Stepper { steps, energy, .. } = stepper;
        let ended = match failure {
            Some(error) => Err(error),
            None => Ok(Ended { energy: energy.summary(0), steps }),
        };
        let Verdict { outcome, energy, steps, mut warnings, ending } =
            conclude(&assembly, &ground, &fates, ended, state.time, ending);
        warnings.extend(restitution_warning(&scenario));
        if outcome == Outcome::Stable {
            // Soft friction springs cause errors in small slips only, which are of no interest once the stack has
            // collapsed.
            let slips = (0..assembly.parts.len()).map(|body| fates.fate(body).residual_slip.abs());
            let most = slips.fold(0.0, f64::max);
            warnings.extend(
                sticks.iter().filter(|stick| stick.shows_in(most)).map(ToString::to_string),
            );
        }
        Run {
            stated: Box::new(scenario.clone()),
            scenario,
            outcome,
            fates,
            elements: elements.0,
            stresses: stresses.finish(0),
            recording,
            energy,
            settled,
            simulation: settings,
            work: Work {
                steps,
                evaluations: scratch.evaluations - before.0,
                contact_evaluations: scratch.contact_evaluations - before.1,
            },
            end_time: state.time,
            ending,
            interrupted: ending == Ending::Interrupted,
            warnings,
            ground,
            assembly,
        }
    }

    /// Sets the external force on a body, in place of an earlier external force; it acts until it is changed.
    ///
    /// The work of such forces is part of the energy balance.
    ///
    /// # Errors
    /// If there is no such body, the body follows the ground, or a number is not finite.
    pub fn apply(&mut self, applied: Applied<Planar>) -> Result<(), ApplyError> {
        let model = &self.fixed.assembly.model;
        self.stepper.apply(model, &mut self.state, &mut self.scratch, applied)
    }

    /// Returns the simulated time (s).
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Returns the time (s) at which the run ends unless it ends earlier, at rest or after a collapse.
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
    pub fn state(&self) -> &State<Planar> {
        &self.state
    }

    /// Returns the data computed from the current state, such as contact forces and the loads of force elements.
    pub fn scratch(&self) -> &Scratch<Planar> {
        &self.scratch
    }

    /// Returns the contact forces between all bodies that touch in the current state.
    pub fn forces(&self) -> Vec<ForceBetween<Planar>> {
        let parts = &self.fixed.assembly.parts;
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

    /// Returns the losses of seats, falls and largest motions of all bodies so far.
    pub fn fates(&self) -> &Fates {
        &self.watch.fates
    }

    /// Returns the frames and histories so far, with the current forces between the bodies.
    pub fn recording(&self) -> &Recording {
        &self.watch.recording
    }

    /// Returns the scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.fixed.scenario
    }

    /// Returns the stack.
    pub fn assembly(&self) -> &Assembly {
        &self.fixed.assembly
    }

    /// Returns the ground motion.
    pub fn ground(&self) -> &Ground {
        &self.fixed.ground
    }

    /// Returns `true` if both simulations are clones of one simulation; the clones may be in different states.
    pub fn is_clone_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.fixed, &other.fixed)
    }
}
