//! What straps bore, and when they tore.

use barrelstack_dynamics::{Planar, Scratch, State};

/// What became of one strap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrapFate {
    /// The largest tension (N) and when it was borne (s).
    pub peak: (f64, f64),
    /// When it tore (s).
    pub torn_at: Option<f64>,
}

/// What became of every strap, in the order of the model.
#[derive(Clone, Debug, Default)]
pub struct StrapFates(pub Vec<StrapFate>);

impl StrapFates {
    /// Looks at an accepted step.
    pub(super) fn observe(&mut self, state: &State<Planar>, scratch: &Scratch<Planar>) {
        self.0.resize(scratch.pulls.len(), StrapFate::default());
        for ((fate, pull), torn) in self.0.iter_mut().zip(&scratch.pulls).zip(&state.torn) {
            if pull.tension > fate.peak.0 {
                fate.peak = (pull.tension, state.time);
            }
            if *torn && fate.torn_at.is_none() {
                fate.torn_at = Some(state.time);
            }
        }
    }
}
