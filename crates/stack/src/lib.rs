//! Stacks of barrels and free scenes: scenarios, assembly, runs and outcomes.
//!
//! ```text
//! scenario.toml ─▶ Scenario ─ assemble ─▶ Assembly { Model, parts }
//! record ─ ground ─▶ Ground ────────────────────┐
//!                                               ▼
//!                   Simulation: settle, step, Watch ─▶ Run
//! ```
//!
//! One run comes from [`Scenario::run`], many from an [`Ensemble`]; a [`Simulation`] advances step by step.
//! Verdicts, reports and pictures are in `barrelstack`, which reexports all of this under the same names.

// Results must be bit-identical on every machine, so the standard transcendental functions are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod assemble;
pub mod check;
pub mod demand;
pub mod device;
pub mod ensemble;
pub mod ground;
pub mod outcome;
pub mod overlap;
pub mod pool;
mod rest;
pub mod run;
pub mod scenario;
mod simulation;
pub mod slosh;
pub mod stand;
pub mod step;
mod stick;
pub mod watch;

use barrelstack_input::system;

pub use check::check;
pub use ensemble::Ensemble;
pub use ground::Ground;
pub use rest::Restless;
pub use run::{Progress, Run, RunFailure};
pub use scenario::Scenario;
pub use simulation::Simulation;

/// The example of the README, which is compiled and run with the doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
