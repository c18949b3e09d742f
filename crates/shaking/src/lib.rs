//! The table `[motion]` of a scenario, and the ground motion that it describes.
//!
//! ```text
//! [motion] ─ motion ─▶ MotionSpec ─ ground ─▶ Ground, which drives a model
//! ```

// Results must be bit-identical on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod ground;
pub mod motion;
