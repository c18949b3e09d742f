//! What force elements bore, and when they broke.

use barrelstack_dynamics::{Scratch, Space, State};

/// What became of one force element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementFate {
    /// The force (N) that is largest in size until the first loss of seat, and when it was borne (s).
    pub peak: (f64, f64),
    /// The same over the whole run.
    pub peak_whole_run: (f64, f64),
    /// When it broke (s).
    pub broken_at: Option<f64>,
}

/// What became of every force element, in the order of the model.
#[derive(Clone, Debug, Default)]
pub struct ElementFates(pub Vec<ElementFate>);

impl ElementFates {
    /// Looks at an accepted step; `standing` where no seat had been lost before it.
    pub fn observe<S: Space<Real = f64>>(
        &mut self,
        state: &State<S>,
        standing: bool,
        scratch: &Scratch<S>,
    ) {
        self.0.resize(scratch.loads.len(), ElementFate::default());
        for ((fate, load), memory) in self.0.iter_mut().zip(&scratch.loads).zip(&state.memory) {
            if load.force.abs() > fate.peak_whole_run.0.abs() {
                fate.peak_whole_run = (load.force, state.time);
                if standing {
                    fate.peak = fate.peak_whole_run;
                }
            }
            if memory.broken && fate.broken_at.is_none() {
                fate.broken_at = Some(state.time);
            }
        }
    }
}
