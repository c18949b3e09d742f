//! Dynamics of rigid bodies with penalty contact, in two and three dimensions.
//!
//! The crate contains the physics only: it does no input or output, reads no clock, starts no threads and writes no
//! log.
//!
//! # A step
//!
//! 1. The ground, and everything fixed to it, moves with the ground motion.
//! 2. For each pair of nearby boundaries and each node of the contactor, the distance from the target's surface and the
//!    normal are computed.
//! 3. The normal law turns penetration and its rate into a compressive force.
//! 4. The friction law turns slip rate and displacement of the tangential spring into a tangential force.
//! 5. The force acts on both bodies at one point: the middle of the overlap or, for a fixed node, the companion point,
//!    which is the point of the surface from which the penetration is measured.
//! 6. The sum of the forces of contacts, force elements, gravity and viscous damping gives the accelerations
//!    ([`evaluate`]).
//! 7. The integrator repeats 1 to 6 as its method requires and advances poses, twists and displacements of the
//!    tangential springs.
//! 8. Once the step is accepted, the displacement of every tangential spring is limited to the friction capacity.
//! 9. The energy ledger and the observers receive the accepted state.
//!
//! # Signs
//!
//! - `x` points right and `z` points up; angles grow from `x` toward `z`. All units are SI units; angles are in
//!   radians. In three dimensions, `y` points away from the viewer and rotations are right-handed, so an angle in the
//!   plane is a rotation about `-y`.
//! - A gap has a negative distance where the bodies penetrate each other; the penetration is never negative.
//! - The penetration rate is positive while the bodies approach each other.
//! - Normals point out of the target.
//! - Slip is the motion of the contactor relative to the target; on a level floor it is positive to the right.
//! - A friction force is given in the direction of the slip; the opposite force acts on the contactor.

// Results are bit-identical on every machine, so the transcendental functions of the platform are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(
    clippy::inline_always,
    reason = "bundles are fast only if their code is inlined into the function that enables the vector unit"
)]

pub mod applied;
pub mod body;
pub mod contact;
pub mod contact_elements;
pub mod element;
pub mod energy;
pub mod forces;
pub mod integrate;
pub mod join;
pub mod lanes;
pub mod math;
pub mod model;
mod pair_frame;
mod pairs;
pub mod real;
pub mod settle;
pub mod shape;
pub mod simulate;
pub mod solid;
pub mod space;
pub mod state;

pub use applied::{Applied, ApplyError};
pub use body::{Body, BodyId, Face, Motion, Node, Nodes, Placed, Round};
pub use contact::{Basis, FrictionLaw, Interface, NormalLaw};
pub use element::*;
pub use energy::{EnergyLedger, EnergySummary};
pub use forces::{Contact, Scratch, evaluate};
pub use integrate::{Drive, Method, Still};
pub use model::{ContactPair, Counts, Fast, InterfaceId, Model, ModelError, Substepping};
pub use settle::{Lack, SettleError, Settled, settle};
pub use shape::Shape;
pub use simulate::{Finish, Observer, RunError, Simulation, Stepper, look, simulate};
pub use solid::Solid;
pub use space::{Linear, Planar, Pose, Quaternion, Rotation3, Space, Spatial, Twist, Vec2, Vec3};
pub use state::State;

/// The example in the README, which is compiled and run as a doc test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
