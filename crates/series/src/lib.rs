//! Time series of ground motion.
//!
//! The crate contains samples and their exact integrals, analytic pulses, response spectra,
//! intensity measures, target spectra, and the transforms they need. All numbers are SI. Files,
//! stations and components belong to `barrelstack-motion`, which re-exports the public parts of
//! this crate.

// Results must be bit-identical on every machine, so the system's transcendental functions are not
// used (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` also rejects NaN")]

mod error;
mod fiv3;
pub mod fourier;
pub mod history;
pub mod intensity;
pub mod layers;
pub mod math;
pub mod normal_equations;
pub mod pulse;
pub mod pulse_class;
pub mod pulse_fit;
pub mod random;
pub mod response;
pub mod sampled;
pub mod target;
pub mod words;

pub use error::MotionError;

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
