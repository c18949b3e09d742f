//! A single run of a scenario and its result.

mod failure;
mod verdict;

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::Basis;
use barrelstack_dynamics::{EnergySummary, Interface, Method, Planar, RunError, Settled};

use crate::assemble::Assembly;
use crate::ground::{Ground, from_disk};
use crate::outcome::{Outcome, judge};
use crate::scenario::{self, Scenario, Scene, Until};
use crate::simulation::Simulation;
use crate::step::critical_time_step;
use crate::watch::{
    ElementFate, Ending, Eye, Fates, Glance, Pace, Recording, Stresses, Thresholds,
};

pub use crate::stand::UNBALANCED;
use failure::MOST_KEPT;
pub use failure::RunFailure;
pub use verdict::{Ended, Verdict, cut};

/// Result of a run.
///
/// ```
/// use barrelstack_stack::Scenario;
///
/// let run = Scenario::builtin("rocking-block", &["run.duration=2 s".to_owned()])?.run()?;
/// let tilt = run.recording.frames.poses.iter().map(|poses| poses[1][2].abs()).fold(0.0, f64::max);
/// println!("{}: tilts by {tilt:.3} rad in {} steps", run.outcome.kind(), run.work.steps);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Run {
    /// The scenario that was run.
    pub scenario: Scenario,
    /// The scenario as given; `scenario` may be a variant of it.
    pub stated: Box<Scenario>,
    /// The assembled stack.
    pub assembly: Assembly,
    /// The ground motion.
    pub ground: Ground,
    /// The outcome.
    pub outcome: Outcome,
    /// Losses of seats, falls and largest motions of all bodies.
    pub fates: Fates,
    /// Largest forces and failure of each force element, in the order of the elements in the model.
    pub elements: Vec<ElementFate>,
    /// Normal contact stress along the boundary of every barrel and rack: at rest, and the largest values until the
    /// first loss of a seat and over the whole run.
    pub stresses: Stresses,
    /// Frames and histories.
    pub recording: Recording,
    /// Energy balance at the end; `None` after a numerical breakdown.
    pub energy: Option<EnergySummary>,
    /// Result of settling; `None` if the scenario starts without settling.
    pub settled: Option<Settled>,
    /// Integration settings.
    pub simulation: barrelstack_dynamics::Simulation,
    /// Work counters.
    pub work: Work,
    /// Simulated time (s) that the run reached.
    pub end_time: f64,
    /// Reason for the end of the run.
    pub ending: Ending,
    /// `true` if the caller stopped the run early.
    pub interrupted: bool,
    /// Warnings for the reader of the result, one sentence each.
    pub warnings: Vec<String>,
}

/// Amount of computation in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Number of accepted steps.
    pub steps: u64,
    /// Number of force evaluations.
    pub evaluations: u64,
    /// Number of contact elements tested for contact, summed over all force evaluations.
    pub contact_evaluations: u64,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time (s) reached.
    pub time: f64,
    /// Simulated time (s) at which the run ends unless it ends earlier, at rest or after a collapse.
    pub end_time: f64,
}

/// Part of the ground motion (s) that may be left at the end of a run. If more is left, the run counts as cut short.
pub const CUT: f64 = 0.01;

/// Maximum number of steps of a run; about 10⁵ steps of a stack are computed in a second.
const MOST_STEPS: f64 = 1e9;

impl Scenario {
    /// Runs the scenario.
    ///
    /// A numerical breakdown, or an energy balance that does not close, is not an error but an outcome:
    /// [`Outcome::Invalid`].
    ///
    /// ```
    /// use barrelstack_stack::{Run, Scenario};
    ///
    /// let run: Run = Scenario::builtin("sliding-block", &[])?.run()?;
    /// println!("{} after {:.1} s", run.outcome.kind(), run.end_time);
    /// assert!(run.energy.is_some_and(|energy| energy.residual_ratio() < 1e-3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the motion cannot be read, if the stack cannot be built or does not come to rest under its own weight, or if
    /// the run would be too long or need too much memory.
    pub fn run(&self) -> Result<Run, RunFailure> {
        self.run_watched(&mut |_| ControlFlow::Continue(()))
    }

    /// Runs the scenario with an observer that may stop the run. If the run is stopped, the results up to that time are
    /// returned.
    ///
    /// The observer receives the progress every 0.05 s of simulated time.
    ///
    /// # Errors
    /// Same as [`Scenario::run`].
    pub fn run_watched(
        &self,
        observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Run, RunFailure> {
        let held = self.with_records(&mut from_disk)?;
        held.run_on(held.ground()?, observer)
    }

    /// Runs the scenario on a given ground with an observer.
    ///
    /// The motion stated in the scenario is ignored, although it enters the fingerprint of the run. Use
    /// [`Scenario::with_record`] for a scenario with another record.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use barrelstack_stack::{Ground, Scenario};
    /// use barrelstack_motion::GroundMotion;
    ///
    /// // Acceleration (m/s²) at steps of 0.01 s: half a second at 2 m/s², then back.
    /// let samples: Vec<f64> = (0..100).map(|at| if at < 50 { 2.0 } else { -2.0 }).collect();
    /// let ground = Ground::from(GroundMotion::from_acceleration("push", 0.01, samples)?);
    /// let scenario = Scenario::builtin("rocking-block", &["run.duration=2 s".to_owned()])?;
    /// let run = scenario.run_on(ground, &mut |_| ControlFlow::Continue(()))?;
    /// assert_eq!(run.end_time, 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the stack cannot be built or does not come to rest under its own weight, or if the run would be too long or
    /// need too much memory.
    pub fn run_on(
        &self,
        ground: Ground,
        observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Run, RunFailure> {
        let end_time = end_time(self, ground.motion_end(), self.run.similitude.sqrt())?;
        let mut eye = |glance: Glance<'_>| observer(Progress { time: glance.time, end_time });
        self.run_before(ground, Pace::Time, &mut eye)
    }

    /// Runs the scenario on a given ground with a callback that may stop the run.
    ///
    /// The callback is called at the given pace. Use it for a custom stop criterion, or for a quantity that is in no
    /// history.
    ///
    /// ```
    /// use std::num::NonZero;
    /// use std::ops::ControlFlow;
    ///
    /// use barrelstack_stack::Scenario;
    /// use barrelstack_stack::watch::Pace;
    ///
    /// let scenario = Scenario::builtin("sliding-block", &[])?;
    /// let every = Pace::Steps(NonZero::new(10).ok_or("ten")?);
    /// let run = scenario.run_before(scenario.ground()?, every, &mut |glance| {
    ///     let speed = glance.state.twists[1].linear.x;
    ///     if speed > 0.5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    /// })?;
    /// assert!(run.interrupted && run.end_time < 0.2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Same as [`Scenario::run_on`].
    pub fn run_before(
        &self,
        ground: Ground,
        pace: Pace,
        eye: &mut Eye<'_>,
    ) -> Result<Run, RunFailure> {
        Ok(Simulation::new(self, ground)?.run_before(pace, eye))
    }
}

impl Run {
    /// Returns the duration (s) of the ground motion that was left when `run.duration` ended the run. Returns `None`
    /// if at most [`CUT`] was left, or if the run ended for another reason.
    pub fn cut(&self) -> Option<f64> {
        cut(self.ending, self.ground.end(), self.end_time)
    }
}

/// Returns the verdict on a planar run that ended at `time` (s). The warnings include those of the ground motion.
pub(crate) fn conclude(
    assembly: &Assembly,
    ground: &Ground,
    fates: &Fates,
    ended: Result<Ended, RunError>,
    time: f64,
    ending: Ending,
) -> Verdict {
    let judge = || judge(assembly, fates);
    let mut verdict = Verdict::of(ended, judge, time, ground.end(), ending);
    verdict.warnings.splice(0..0, ground.warnings.iter().cloned());
    verdict.warnings.extend(creep_warning(assembly));
    verdict
}

/// Returns the time step (s) that a scenario sets; by default, a step that suits the stiffest contact.
///
/// The step in a scenario is the step of the full-size stack. At another length scale, it is multiplied by the time
/// scale, so that the run is equivalent to the run at full size.
///
/// # Errors
/// If the method has a fixed step, and the step in the scenario is not below the critical step, beyond which every
/// explicit fixed-step method is unstable.
pub fn time_step(scenario: &Scenario, assembly: &Assembly) -> Result<f64, RunFailure> {
    let scale = scenario.run.similitude.sqrt();
    let Some(step) = scenario.run.step.map(|step| step * scale) else {
        return Ok(assembly.step * scenario.run.accuracy.step());
    };
    let critical = critical_time_step(assembly, scale);
    let adapts = matches!(scenario.run.method, scenario::Method::BogackiShampine { .. });
    if adapts || step < critical {
        return Ok(step);
    }
    Err(RunFailure::Step {
        given: milliseconds(step / scale),
        reason: format!("the stiffest contact allows {:.2} ms at most", 1e3 * critical / scale),
        instead: milliseconds(assembly.step / scale),
    })
}

/// Converts a time step (s) to milliseconds, rounded for display.
fn milliseconds(step: f64) -> f64 {
    (1e9 * step).round() / 1e6
}

/// Returns the integration method of a scenario.
pub fn method(scenario: &Scenario) -> Method {
    match scenario.run.method {
        scenario::Method::SemiImplicitEuler => Method::SemiImplicitEuler,
        scenario::Method::VelocityVerlet => Method::VelocityVerlet,
        scenario::Method::RungeKutta4 => Method::RungeKutta4,
        scenario::Method::BogackiShampine { tolerance } => Method::BogackiShampine { tolerance },
    }
}

/// Returns the thresholds beyond which a body of a scenario counts as having left its seat, or as fallen.
pub fn thresholds(scenario: &Scenario) -> Thresholds {
    match &scenario.scene {
        Scene::Stack { outcome, .. } => Thresholds::of(outcome, scenario.run.similitude),
        // A free scene is not judged: none of its bodies has a seat.
        Scene::Free(_) | Scene::Spatial(_) => Thresholds {
            seat_loss_ratio: f64::INFINITY,
            fall_drop: f64::INFINITY,
            rack_slide_ratio: f64::INFINITY,
            rocking_angle: f64::INFINITY,
            overturning_angle: f64::INFINITY,
        },
    }
}

/// Returns the latest time (s) at which a run of the scenario ends.
///
/// `motion_end` is the time (s) at which the motion ends, if there is a motion. `time_scale` is the ratio of times in
/// the model to times at full size; it is 1 for a model at full size.
///
/// # Errors
/// If neither the scenario nor a motion defines an end.
pub fn end_time(
    scenario: &Scenario,
    motion_end: Option<f64>,
    time_scale: f64,
) -> Result<f64, RunFailure> {
    let run = &scenario.run;
    if let Some(duration) = run.duration {
        return Ok(duration * time_scale);
    }
    match (run.until, motion_end) {
        (Until::Rest | Until::Verdict, end) => Ok(end.unwrap_or(0.0) + run.patience * time_scale),
        (Until::Duration, Some(end)) => Ok(end + 5.0 * time_scale),
        (Until::Duration, None) => Err(RunFailure::Duration(
            "the scenario has no motion, so nothing determines the end of the run: set run.duration, for example \
             \"10 s\""
                .into(),
        )),
    }
}

/// Rejects a run that would take too many steps; both times are in s.
///
/// # Errors
/// If the run takes more than 10⁹ steps.
pub fn check_length(end_time: f64, step: f64) -> Result<(), RunFailure> {
    let steps = end_time / step;
    if steps <= MOST_STEPS {
        return Ok(());
    }
    Err(RunFailure::Duration(format!(
        "a run of {end_time:e} s with a step of {step:e} s has {steps:.0e} steps, but at most {MOST_STEPS:.0e} are \
         allowed: shorten run.duration, or check whether run.step and the stiffness of the contacts have the right unit"
    )))
}

/// Rejects a recording that would not fit into memory, before memory is allocated.
///
/// The rates (Hz) are the sampling rates of frames and of histories.
pub(crate) fn check_memory(
    assembly: &Assembly,
    end_time: f64,
    (frame_rate, history_rate): (f64, f64),
) -> Result<(), RunFailure> {
    // A frame holds the pose and the stress of every body, and the forces of about four contacts per body.
    let frame = (end_time * frame_rate + 1.0, assembly.parts.len(), 3 + 1 + 4 * 4);
    let channels = Recording::histories(assembly);
    check_kept(frame, (end_time * history_rate + 1.0, channels))
}

/// Checks that the frames and the histories of a run fit into memory.
///
/// Each of the `frames` holds `numbers` values per body. Each of the `channels` histories has `samples` values.
///
/// # Errors
/// If the frames and histories take more than 2 GB.
pub fn check_kept(
    (frames, bodies, numbers): (f64, usize, usize),
    (samples, channels): (f64, usize),
) -> Result<(), RunFailure> {
    const NUMBER: f64 = size_of::<f64>() as f64;
    let kept = NUMBER * (samples * channels as f64 + frames * (bodies * numbers) as f64);
    if kept <= MOST_KEPT {
        return Ok(());
    }
    Err(RunFailure::Memory { samples, channels, frames, bodies, gigabytes: kept / 1e9 })
}

/// Returns a warning, with the creep speed, for each friction law that cannot hold a body at rest.
fn creep_warning(assembly: &Assembly) -> Vec<String> {
    assembly
        .model
        .interfaces()
        .iter()
        .filter(|interface| interface.friction.creep_speed(0.5) > 0.0)
        .map(|interface| {
            format!(
                "{}: contacts creep under the regularized friction law: if the friction force is half of its limit, \
                 they slide at {:.2e} m/s",
                interface.name,
                interface.friction.creep_speed(0.5)
            )
        })
        .collect()
}

impl Run {
    /// Returns the name of the [`Basis`] of the contact constants, such as "seat"; "mixed" if the contact laws differ
    /// in their basis.
    ///
    /// In a stack, only the contact laws of seats are considered; in a free scene, all contact laws.
    pub fn stiffness_basis(&self) -> &'static str {
        let model = &self.assembly.model;
        let seats = |interface: &&Interface<Planar>| {
            self.assembly.view.is_none() || interface.stop.is_some()
        };
        let used = model.pairs().map(|pair| pair.interface);
        let used: std::collections::BTreeSet<usize> = used.collect();
        let all = used.iter().map(|interface| &model.interfaces()[*interface]).filter(seats);
        let mut bases = all.map(|interface| interface.basis);
        let Some(first) = bases.next() else { return Basis::Node.name() };
        if bases.all(|basis| basis == first) { first.name() } else { "mixed" }
    }
}
