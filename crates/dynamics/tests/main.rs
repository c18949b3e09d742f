//! Tests of the dynamics: symmetries, bit-identity, energy balance, limits of laws, and errors.
//!
//! All tests form one program, since each further program would compile the physics again.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod applied;
mod common;
mod contact_laws;
mod determinism;
mod elements;
mod extruded;
mod flush;
mod friction;
mod integrators;
mod invariants;
mod masses;
mod order;
mod patches;
mod racks;
mod regimes;
mod reversal;
mod shapes;
mod solids;
mod statics;
mod straps;
