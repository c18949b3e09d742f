//! Wine-barrel stacks in earthquakes: scenario, run, outcome, report.
//!
//! ```text
//! scenario.toml ─▶ Scenario ─ assemble ─▶ Assembly { Model, parts }
//! record ─ ground ─▶ Ground ────────────────────┐
//!                                               ▼
//!                   Simulation: settle, step, Watch ─▶ Run
//!                                               │
//!                     Summary (JSON) · files · report (HTML, Markdown)
//! ```
//!
//! ```
//! use barrelstack::{Run, Scenario, Summary};
//!
//! let text = r#"
//!     schema = 1
//!     [stack]
//!     levels = 2
//!     columns = 2
//!     [motion.sine]
//!     amplitude = "10 cm"
//!     period = "1 s"
//!     cycles = 2
//! "#;
//! let run: Run = Scenario::from_str(text)?.run()?;
//! println!("{}", Summary::of(&run, None).to_json());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Scenario`] is read from text, from a file or from the scenarios shipped with the program; it runs under its own
//! motion ([`Scenario::run`]), under a given [`Record`] ([`Scenario::with_record`]) or on any [`Ground`]
//! ([`Scenario::run_on`]). No file is needed: records can be given as bytes ([`Scenario::with_records`]) or samples
//! ([`Record::of_samples`]). [`variants::answer`] judges a stack by the share of its variants that falls, as the
//! command-line program does. Many cases run together as an [`Ensemble`], whose results form one
//! [table](ensemble::table); the `Study` of `barrelstack-campaign` runs ensembles. `examples/` has a stack, a record, a
//! free scene and an ensemble in about ten lines each; the examples of [`dynamics`] include user-defined force
//! elements.

// Results must be bit-identical on every machine, so only the transcendental functions of this project are used
// (`clippy.toml` forbids those of the standard library).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod breakage;
pub mod compare;
pub mod export;
pub mod period;
pub mod render;
pub mod report;
pub mod spreadsheet;
pub mod stability;
pub mod summary;
pub mod variants;
pub mod verify;

pub use barrelstack_dynamics as dynamics;
pub use barrelstack_motion as motion;
pub use barrelstack_motion::Record;
pub use barrelstack_stack::{
    Ensemble, Ground, Progress, Restless, Run, RunFailure, Scenario, Simulation, assemble, check,
    demand, device, ensemble, ground, outcome, overlap, pool, run, scenario, slosh, step, watch,
};
pub use summary::Summary;

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
