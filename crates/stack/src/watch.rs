//! What is seen of a run while it goes on: frames, histories, envelopes, and the fate of every body.

mod elements;
mod fate;
mod joints;
mod recording;
pub mod rest;
mod stress;

use std::num::NonZero;
use std::ops::ControlFlow;

use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{EnergyLedger, Model, Observer, Planar, Scratch, State, lanewise};

use crate::assemble::Assembly;
use crate::ground::Ground;
use crate::scenario::Scenario;

pub use elements::{ElementFate, ElementFates};
pub use fate::{Fate, Fates, Loss, PeakMotion, Thresholds};
pub use joints::{Joint, Joints, PeakForces, leans_on};
pub use recording::{Channel, Frames, JointForces, Recording};
pub use rest::{Ending, Rest};
pub(crate) use stress::StressWatch;
pub use stress::{BoundaryPoint, StressEnvelope, Stresses, TotalForce};

/// Everything that watches a run, together.
pub struct Watch<'a> {
    /// Frames and histories.
    pub recording: Recording,
    /// Normal stress along every boundary.
    pub(crate) stresses: StressWatch,
    /// Seats, falls, slips and tilts.
    pub fates: Fates,
    /// What force elements bore.
    pub elements: ElementFates,
    ground: &'a Ground,
    assembly: &'a Assembly,
    end: End,
    eye: &'a mut Eye<'a>,
    pace: Pace,
    /// When the eye looks next (s).
    next_look: f64,
    /// Accepted states that were passed to it or over.
    states: u64,
    /// Why the run is over; none while it goes on, or to the end of its time.
    pub ending: Option<Ending>,
}

/// What an eye sees of a run while it goes on.
#[derive(Clone, Copy)]
pub struct Glance<'a> {
    /// Simulated time (s).
    pub time: f64,
    /// Accepted steps until then.
    pub steps: u64,
    /// Poses and twists of all bodies, in the order of the parts.
    pub state: &'a State<Planar>,
}

/// Who looks at a run while it goes on, and may stop it.
pub type Eye<'a> = dyn FnMut(Glance<'_>) -> ControlFlow<()> + 'a;

/// When an eye looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// At the start and every 0.05 s of simulated time.
    Time,
    /// At the start and after every so many accepted steps.
    Steps(NonZero<u64>),
}

/// What ends a run before its time is over.
#[derive(Clone, Debug)]
pub struct End<R: Real = f64> {
    rest: Rest<R>,
    /// How long (s) it goes on after a collapse; infinite to go on.
    after_collapse: R,
}

impl End {
    /// As a scenario says.
    pub fn new(scenario: &Scenario, assembly: &Assembly, ground: &Ground) -> Self {
        let run = &scenario.run;
        let after = run.stop_after_collapse.map(|after| after * run.similitude.sqrt());
        Self {
            rest: Rest::new(scenario, assembly, ground),
            after_collapse: after.unwrap_or(f64::INFINITY),
        }
    }
}

impl<R: Real> End<R> {
    /// Where a run is over at an accepted state: because of its collapse, and by rest.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
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
    /// Why a run is over at an accepted state; rest goes first, since nothing is left to see then.
    pub(crate) fn why(&mut self, state: &State<Planar>, fates: &Fates) -> Option<Ending> {
        match self.observe(state, fates) {
            (_, true) => Some(Ending::Rest),
            (true, false) => Some(Ending::AfterCollapse),
            (false, false) => None,
        }
    }
}

impl<'a> Watch<'a> {
    /// Watches a run of an assembly from the state at rest in `state`.
    #[expect(clippy::too_many_arguments, reason = "the parts of a watch, named once")]
    pub fn new(
        assembly: &'a Assembly,
        ground: &'a Ground,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        thresholds: Thresholds,
        rates: (f64, f64),
        end: End,
        eye: &'a mut Eye<'a>,
        pace: Pace,
    ) -> Self {
        Self {
            recording: Recording::new(assembly, state, rates),
            stresses: StressWatch::new(assembly, state, scratch),
            fates: Fates::new(assembly, state, thresholds),
            elements: ElementFates::default(),
            ground,
            assembly,
            end,
            eye,
            pace,
            next_look: 0.0,
            states: 0,
            ending: None,
        }
    }
}

/// Simulated time (s) between two looks of an eye whose pace is time.
pub const PROGRESS: f64 = 0.05;

impl Observer<Planar> for Watch<'_> {
    fn observe(
        &mut self,
        model: &Model<Planar>,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        energy: &EnergyLedger<Planar>,
    ) -> ControlFlow<()> {
        // Until the first loss of seat, the state in which it is found included.
        let standing = self.fates.stands();
        self.fates.observe(state, scratch);
        self.elements.observe(state, standing, scratch);
        self.stresses.observe(standing, state, scratch, &|_| Some(model));
        self.recording.observe(self.assembly, self.ground, standing, state, scratch, energy);
        let due = match self.pace {
            Pace::Time => state.time >= self.next_look,
            Pace::Steps(every) => self.states.is_multiple_of(every.get()),
        };
        // The first state is the start, which no step has made.
        let glance = Glance { time: state.time, steps: self.states, state };
        self.states += 1;
        if due {
            self.next_look = state.time + PROGRESS;
            if (self.eye)(glance).is_break() {
                self.ending = Some(Ending::Interrupted);
                return ControlFlow::Break(());
            }
        }
        self.ending = self.end.why(state, &self.fates);
        if self.ending.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
