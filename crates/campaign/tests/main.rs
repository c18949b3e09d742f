//! Studies, decisions, scores, heights and protections: their tables, pages and folders, whatever stops or damages them.
//!
//! One program, since each would compile and link what it tests anew.

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
