//! Tests of studies, decisions, scores, heights and protections: tables, pages and folders, also interrupted and damaged.
//!
//! All tests are one program, so that the crates are linked only once.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod common;
mod damage;
mod decision;
mod endings;
mod exports;
mod gravity;
mod grow;
mod heights;
mod hunts_and_stripes;
mod protect;
mod samples;
mod score;
mod space;
mod study;
mod study_hostile;
