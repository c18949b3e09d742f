//! Bodies in space: the tables `[[body]]` of a free scene there, and the bodies that these tables describe.
//!
//! ```text
//! [[body]] ─ body ─▶ SpatialBody { solid, … } ─ SpatialBody::build ─▶ Body<Spatial>, which a model moves
//! ```

// Physics has the same bits on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body;
mod build;
mod solid;

pub use body::{BODY, SpatialBody, VISCOUS, Viscous};
pub use solid::{PART, PartSolid, SOLID, Solid};
