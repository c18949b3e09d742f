//! Stacks in space: against those of the plane, at rest, turned, under every device and ground.
//!
//! One program, since each would compile and link what it tests anew.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod answers;
mod bits;
mod common;
mod compare;
mod devices;
mod free;
mod ground;
mod lanes;
mod plane;
mod rack_walk;
mod simulation;
mod standing;
mod turned;
mod two_seats;
mod variants;
