//! What shakes a scenario: the table `[motion]` of its file, and the ground motion that this table describes.
//!
//! ```text
//! [motion] ─ motion ─▶ MotionSpec ─ ground ─▶ Ground, which drives a model
//! ```

// Physics has the same bits on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod ground;
pub mod motion;
