//! Tests of rooms, in one program.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test panics on a wrong value, and shows what it measured"
)]

mod common;

mod alone;
mod answer;
mod comparison;
mod plan;
mod sequence;
mod stacks;
