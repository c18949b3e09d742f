//! Tests of fragility curves and rates: fits, intervals and their coverage.
//!
//! All tests are one program, so that the crates are linked only once.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod claims;
mod common;
mod coverage;
mod drawing;
mod fits;
mod resampling;
mod unknowns;
