//! Tests of rooms, in one program.
#![allow(clippy::unwrap_used, reason = "a test panics on a wrong value")]

mod common;

mod alone;
mod answer;
mod dominoes;
mod impacts;
mod plan;
mod stacks;
