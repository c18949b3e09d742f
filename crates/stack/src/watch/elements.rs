//! Forces and failure times of force elements.

use barrelstack_dynamics::real::{Mask as _, Real as _};
use barrelstack_dynamics::{Scratch, Space, State};

/// Largest forces of one force element, and its failure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementFate {
    /// Force (N) of the largest magnitude until the first loss of a seat, and its time (s).
    pub peak: (f64, f64),
    /// Force (N) of the largest magnitude over the whole run, and its time (s).
    pub peak_whole_run: (f64, f64),
    /// Time (s) at which the element broke; `None` if it did not break.
    pub broken_at: Option<f64>,
}

/// Largest forces and failure of each force element, in the order of the elements in the model.
#[derive(Clone, Debug, Default)]
pub struct ElementFates(pub Vec<ElementFate>);

impl ElementFates {
    /// Records an accepted step; `standing` is `true` if no seat had been lost before the step.
    pub fn observe<S: Space<Real = f64>>(
        &mut self,
        state: &State<S>,
        standing: bool,
        scratch: &Scratch<S>,
    ) {
        self.observe_lane(0, state, standing, scratch);
    }

    /// Records an accepted step of one lane, as [`ElementFates::observe`] does.
    pub fn observe_lane<S: Space>(
        &mut self,
        lane: usize,
        state: &State<S>,
        standing: bool,
        scratch: &Scratch<S>,
    ) {
        let time = state.time.lane(lane);
        self.0.resize(scratch.loads.len(), ElementFate::default());
        for ((fate, load), memory) in self.0.iter_mut().zip(&scratch.loads).zip(&state.memory) {
            let force = load.force.lane(lane);
            if force.abs() > fate.peak_whole_run.0.abs() {
                fate.peak_whole_run = (force, time);
                if standing {
                    fate.peak = fate.peak_whole_run;
                }
            }
            if memory.broken.lane(lane) && fate.broken_at.is_none() {
                fate.broken_at = Some(time);
            }
        }
    }
}
