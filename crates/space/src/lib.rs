//! Three-dimensional stacks of barrels and free scenes (individual bodies), in a ground motion with three components.
//!
//! ```text
//! Scenario ─ stack::assemble ─▶ Stack { Model, parts }
//! record ─ Ground ─────────────────────┐
//!                                      ▼
//!               Simulation: settle, step ─▶ Run ─▶ Summary (JSON), files, page
//! ```
//!
//! `x` is across the barrels, `y` along the barrels, and `z` up; columns are counted along `x`, rows along `y`. A
//! three-dimensional run differs from a run in a plane in geometry only: the contact laws, time steps, thresholds and
//! messages are the same.

// Results are bit-identical on every machine, so the transcendental functions of the platform are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod answered;
mod builder;
mod check;
pub mod columns;
mod compare;
mod device;
pub mod drawing;
pub mod export;
pub mod fate;
mod free;
pub mod ground;
mod known;
mod lanes;
pub mod mesh;
mod part;
mod rack;
pub mod report;
pub mod rest;
pub mod run;
pub mod seats;
mod simulation;
pub mod stack;
pub mod step;
pub mod summary;
pub mod variants;
mod verify;
pub mod words;

pub use answered::AnyAnswer;
pub use check::check;
pub use fate::{Fate, Heading};
pub use ground::Ground;
pub use run::Run;
pub use simulation::Simulation;
pub use stack::Stack;
pub use summary::Summary;
pub use variants::{Answer, answer};

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
