//! Wine-barrel stacks in earthquakes: scenario, run, outcome, report.
//!
//! ```text
//! scenario.toml ─▶ Scenario ─ assemble ─▶ Assembly { Model, parts }
//! record ─ ground ─▶ Ground ────────────────────┐
//!                                               ▼
//!                   settle ─▶ simulate, watched by Watch ─▶ Run
//!                                               │
//!                     Summary (JSON) · files · report (HTML, Markdown)
//! ```

// Physics has the same bits on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod assemble;
pub mod check;
pub mod compare;
pub mod demand;
pub mod ensemble;
pub mod export;
pub mod ground;
pub mod outcome;
pub mod overlap;
pub mod period;
pub mod pool;
pub mod render;
pub mod report;
mod rest;
pub mod run;
pub mod scenario;
pub mod step;
mod stick;
pub mod summary;
pub mod verify;
pub mod watch;

use barrelstack_input::system;

pub use check::check;
pub use rest::Restless;
pub use run::{Progress, Run, RunFailure, run};
pub use scenario::Scenario;
pub use summary::Summary;
