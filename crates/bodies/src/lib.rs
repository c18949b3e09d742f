//! Bodies in space: the tables `[[body]]` of a spatial free scene, and the bodies that they describe.
//!
//! ```text
//! [[body]] ─ body ─▶ SpatialBody { solid, … } ─ SpatialBody::build ─▶ Body<Spatial>, which a model moves
//! ```

// Results must be bit-identical on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body;
mod build;
mod solid;

pub use body::{BODY, SpatialBody, VISCOUS, Viscous};
pub use solid::{PART, PartSolid, SOLID, Solid};
