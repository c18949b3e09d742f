//! Fragility and rates: fits, intervals and their coverage.
//!
//! One program, since each would compile and link what it tests anew.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod claims;
mod common;
mod coverage;
mod drawing;
mod fits;
mod resampling;
mod unknowns;
