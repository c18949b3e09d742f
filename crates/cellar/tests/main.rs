//! Tests of rooms, in one program.
#![allow(clippy::unwrap_used, reason = "a test panics on a wrong value")]

mod alone;
mod answer;
mod plan;
