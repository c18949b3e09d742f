//! What is seen of a run while it goes on: frames, histories, envelopes, and the fate of every body.

mod fate;
mod recording;
mod straps;
mod stress;

use std::ops::ControlFlow;

use barrelstack_dynamics::{EnergyLedger, Model, Observer, Planar, Scratch, State};

use crate::assemble::Assembly;
use crate::ground::Ground;

pub use fate::{Fate, Fates, Loss, Thresholds};
pub use recording::{Channel, Frames, JointForces, Recording};
pub use straps::{StrapFate, StrapFates};
pub use stress::{BoundaryPoint, StressEnvelope, Stresses};

/// Everything that watches a run, together.
pub struct Watch<'a> {
    /// Frames and histories.
    pub recording: Recording,
    /// Normal stress along every boundary.
    pub stresses: Stresses,
    /// Seats, falls, slips and tilts.
    pub fates: Fates,
    /// What straps bore.
    pub straps: StrapFates,
    ground: &'a Ground,
    assembly: &'a Assembly,
    /// How long (s) to go on after a collapse; none to go on to the end.
    after_collapse: Option<f64>,
    progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    /// When progress is told next (s).
    next_progress: f64,
    /// Whether the caller asked to stop.
    pub interrupted: bool,
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
        after_collapse: Option<f64>,
        progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        Self {
            recording: Recording::new(assembly, state, rates),
            stresses: Stresses::new(assembly, scratch),
            fates: Fates::new(assembly, state, thresholds),
            straps: StrapFates::default(),
            ground,
            assembly,
            after_collapse,
            progress,
            next_progress: 0.0,
            interrupted: false,
        }
    }
}

/// Whether a run is over at a time (s), because the time after its collapse is.
fn done(time: f64, after_collapse: Option<f64>, collapse: Option<f64>) -> ControlFlow<()> {
    match (after_collapse, collapse) {
        (Some(after), Some(collapse)) if time >= collapse + after => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    }
}

/// Simulated time (s) between two reports to the caller.
const PROGRESS: f64 = 0.05;

impl Observer<Planar> for Watch<'_> {
    fn observe(
        &mut self,
        model: &Model<Planar>,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        energy: &EnergyLedger<Planar>,
    ) -> ControlFlow<()> {
        self.fates.observe(state, scratch);
        self.straps.observe(state, scratch);
        // Envelopes are those of the standing stack: what falling barrels do to each other is another
        // question.
        if self.fates.collapse_time().is_none() {
            self.stresses.observe(model, scratch);
        }
        self.recording.observe(self.assembly, self.ground, model, state, scratch, energy);
        if state.time >= self.next_progress {
            self.next_progress = state.time + PROGRESS;
            if (self.progress)(state.time).is_break() {
                self.interrupted = true;
                return ControlFlow::Break(());
            }
        }
        done(state.time, self.after_collapse, self.fates.collapse_time())
    }
}
