//! Stacks of barrels and free scenes in space, under all three components of a motion.
//!
//! ```text
//! Scenario ─ stack::assemble ─▶ Stack { Model, parts }
//! record ─ Ground ─────────────────────┐
//!                                      ▼
//!               settle ─▶ simulate, watched ─▶ Run ─▶ Summary (JSON), files, page
//! ```
//!
//! Across the barrels is `x`, along them `y`, and `z` is up; columns count along `x`, rows along `y`.
//! A run differs from that of the plane in geometry only: the laws, steps, thresholds and words are the same.

// Physics has the same bits on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod builder;
mod check;
pub mod columns;
mod device;
pub mod drawing;
pub mod export;
pub mod fate;
mod free;
pub mod ground;
mod known;
pub mod mesh;
mod part;
mod rack;
pub mod report;
mod rest;
pub mod run;
pub mod seats;
pub mod stack;
mod step;
pub mod summary;
pub mod variants;
pub mod words;

pub use check::check;
pub use fate::{Fate, Heading};
pub use ground::Ground;
pub use run::Run;
pub use stack::Stack;
pub use summary::Summary;
pub use variants::{Answer, answer};
