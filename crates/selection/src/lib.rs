//! Selection of ground-motion records whose spectra together match a target mean and spread.
//!
//! ```
//! use barrelstack_selection::{Candidate, Choosing, Condition, SelectionTarget, select};
//! let periods = [0.5, 1.0, 2.0];
//! let given = Condition { period: 1.0, acceleration: 3.0 };
//! let target = SelectionTarget::new(&periods, &[4.0, 2.5, 1.2], &[0.6, 0.6, 0.7], Some(given))?;
//! let candidates: Vec<Candidate> = (0..20)
//!     .map(|k| {
//!         let spectrum = vec![4.0 + 0.2 * f64::from(k % 5), 3.0, 1.0 + 0.1 * f64::from(k % 7)];
//!         Candidate { name: k.to_string(), spectrum, group: String::new() }
//!     })
//!     .collect();
//! let choosing = Choosing { count: 8, scale: [0.5, 2.0], most_of_group: None, seed: 1 };
//! assert_eq!(select(&target, &candidates, &choosing)?.chosen.len(), 8);
//! # Ok::<(), barrelstack_motion::MotionError>(())
//! ```

// Selected sets must be identical on every machine, so transcendental functions are those of `libm` (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod correlation;
mod greedy;
mod target;

pub use correlation::spectral_correlation;
pub use greedy::{Candidate, Choosing, Chosen, Selection, select};
pub use target::{Condition, PERIODS, SelectionTarget};

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
