//! Run observers: frames, histories, stress envelopes, and losses of seats and falls.

mod elements;
mod fate;
mod joints;
mod recording;
pub mod rest;
mod stress;

use std::num::NonZero;
use std::ops::ControlFlow;

use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{EnergyLedger, Planar, Scratch, State, lanewise};

use crate::assemble::Assembly;
use crate::ground::Ground;
use crate::scenario::{Scenario, Until};

pub use elements::{ElementFate, ElementFates};
pub use fate::{Fate, Fates, Loss, PeakMotion, Thresholds};
pub use joints::{ForceBetween, Joint, Joints, PeakForces, leans_on};
pub use recording::{Channel, Frames, JointForces, Recording};
pub use rest::{Ending, Rest};
pub(crate) use stress::StressWatch;
pub use stress::{BoundaryPoint, StressEnvelope, Stresses, TotalForce};

/// Combined observer of a run.
#[derive(Clone, Debug)]
pub struct Watch {
    /// Frames and histories.
    pub recording: Recording,
    /// Normal stress along every boundary.
    pub(crate) stresses: StressWatch,
    /// Losses of seats, falls, slips and tilts of all bodies.
    pub fates: Fates,
    /// Forces and failures of force elements.
    pub elements: ElementFates,
    end: End,
    /// Reason for the end of the run, if a stop criterion or the caller ended it. `None` while the run continues, and
    /// after a run that reached its end time or broke down numerically.
    pub ending: Option<Ending>,
}

/// State of a run that is passed to the callback.
#[derive(Clone, Copy)]
pub struct Glance<'a> {
    /// Simulated time (s).
    pub time: f64,
    /// Number of accepted steps so far.
    pub steps: u64,
    /// Poses and twists of all bodies, in the order of the parts.
    pub state: &'a State<Planar>,
}

/// Step callback of a run, which may stop the run.
pub type Eye<'a> = dyn FnMut(Glance<'_>) -> ControlFlow<()> + 'a;

/// Interval between callbacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// At the start and every 0.05 s of simulated time.
    Time,
    /// At the start, and then each time this number of steps has been accepted.
    Steps(NonZero<u64>),
}

/// Stop criteria of a run.
#[derive(Clone, Debug)]
pub struct End<R: Real = f64> {
    rest: Rest<R>,
    /// Duration (s) of the run after a collapse; infinite for no limit.
    after_collapse: R,
}

impl End {
    /// Creates the stop criteria of a scenario.
    pub fn new(scenario: &Scenario, assembly: &Assembly, ground: &Ground) -> Self {
        Self {
            rest: Rest::new(scenario, assembly, ground),
            after_collapse: after_collapse(scenario),
        }
    }
}

/// Duration (s), at full scale, for which a run with [`Until::Verdict`] continues after the first loss of a seat.
pub const VERDICT: f64 = 2.0;

/// Returns the duration (s) for which a run continues after a collapse, at the time scale of the scenario; infinity for
/// no limit.
pub fn after_collapse(scenario: &Scenario) -> f64 {
    let run = &scenario.run;
    let by_verdict = (run.until == Until::Verdict).then_some(VERDICT);
    run.stop_after_collapse.or(by_verdict).unwrap_or(f64::INFINITY) * run.similitude.sqrt()
}

impl<R: Real> End<R> {
    /// Observes an accepted state. Returns the lanes in which the time limit after a collapse has expired, and the
    /// lanes in which all bodies are at rest.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub(crate) fn observe(
        &mut self,
        state: &State<Planar<R>>,
        fates: &Fates<R>,
    ) -> (R::Mask, R::Mask) {
        let rest = self.rest.observe(state, !fates.stands());
        ((fates.collapse() + self.after_collapse).le(state.time), rest)
    }
}

lanewise!(struct End<R> { rest, after_collapse });

impl End {
    /// Returns the reason to end the run at an accepted state, if any; rest takes precedence over a collapse.
    pub(crate) fn why(&mut self, state: &State<Planar>, fates: &Fates) -> Option<Ending> {
        match self.observe(state, fates) {
            (_, true) => Some(Ending::Rest),
            (true, false) => Some(Ending::AfterCollapse),
            (false, false) => None,
        }
    }
}

impl Watch {
    /// Creates the observer of a run that starts from the state at rest in `state`.
    pub fn new(
        assembly: &Assembly,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        thresholds: Thresholds,
        rates: (f64, f64),
        end: End,
    ) -> Self {
        Self {
            recording: Recording::new(assembly, state, rates),
            stresses: StressWatch::new(assembly, state, scratch),
            fates: Fates::new(assembly, state, thresholds),
            elements: ElementFates::default(),
            end,
            ending: None,
        }
    }

    /// Observes the initial state or an accepted step.
    #[inline]
    pub fn see(
        &mut self,
        assembly: &Assembly,
        ground: &Ground,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        energy: &EnergyLedger<Planar>,
    ) {
        // The state in which the first loss of a seat is found still counts as standing.
        let standing = self.fates.stands();
        self.fates.observe(state, scratch);
        self.elements.observe(state, standing, scratch);
        self.stresses.observe(standing, state, scratch, &|_| Some(&assembly.model));
        self.recording.observe(assembly, ground, standing, state, scratch, energy);
    }

    /// Ends the run if one of its stop criteria is met in the last observed state.
    #[inline]
    pub fn end(&mut self, state: &State<Planar>) {
        if self.ending.is_none() {
            self.ending = self.end.why(state, &self.fates);
        }
    }
}

/// Simulated time (s) between two callbacks with [`Pace::Time`].
pub const PROGRESS: f64 = 0.05;
