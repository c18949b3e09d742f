//! The table `[motion]` of a scenario, and the ground motion that it describes.
//!
//! ```text
//! [motion] ─ motion ─▶ MotionSpec ─ ground ─▶ Ground, which drives a model
//! ```

// Results are bit-identical on every machine, so the transcendental functions of the platform are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod ground;
pub mod motion;

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
