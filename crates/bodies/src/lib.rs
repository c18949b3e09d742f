//! Three-dimensional bodies: the `[[body]]` tables of a free scene in three dimensions, and the model bodies built from
//! them.
//!
//! ```text
//! [[body]] ─ body ─▶ SpatialBody { solid, … } ─ SpatialBody::build ─▶ Body<Spatial>, a body of a model
//! ```

// Results must be bit-identical on every machine, so the standard transcendental functions are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body;
mod build;
mod solid;

pub use body::{BODY, SpatialBody, VISCOUS, Viscous};
pub use solid::{PART, PartSolid, SOLID, Solid};

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
