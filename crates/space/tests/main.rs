//! Three-dimensional stacks: compared with plane stacks, at rest, rotated, with every device and under every ground
//! motion.
//!
//! All tests form one program, since each further program would compile and link the tested crates again.

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
