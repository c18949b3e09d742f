//! Studies of many runs of stacks, and their evaluation: decisions, safe heights, rankings of protections, scores.
//!
//! ```text
//! STUDY.toml ─▶ study ─▶ table of cases ─▶ decision (fragility, losses, annual rates) ─▶ page
//!                 ▲                            │
//! heights, protect, score ◀────────────────────┘
//! ```
//!
//! ```
//! use barrelstack_campaign::Study;
//!
//! let study = Study::built_in("napa-four-levels")?;
//! println!("{}: {} cases under {} motions", study.title, study.cases(), study.motions());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Study`] runs in memory ([`Study::table`]) or in a folder that several processes can share
//! ([`Study::run`]).

// Results must be bit-identical on every machine, so transcendental functions are those of `libm`.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod decision;
mod direction;
pub mod heights;
pub mod protect;
pub mod score;
pub mod study;
mod uncertain;
mod unknown;

pub use direction::Direction;
pub use study::Study;
pub use uncertain::Fitted;

// Modules of other crates, which keep their names.
use barrelstack::{ensemble, ground, outcome, pool, run, scenario, watch};
use barrelstack_input::{measured, system};

/// Example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
