//! Records chosen so that their spectra have a target's mean and spread.

mod correlation;
mod greedy;
mod target;

pub use correlation::spectral_correlation;
pub use greedy::{Candidate, Choosing, Chosen, Selection, select};
pub use target::{Condition, SelectionTarget};
