//! Calibration of contact parameters from a user's tests, each with its 95 % interval.
//!
//! | test | file | gives |
//! |---|---|---|
//! | [`stiffness`] | penetration and force | `k` |
//! | [`mod@sag`] | load and sag of a rack | `k` |
//! | [`mod@sway`] | periods of a stack that was tapped | `k` |
//! | [`mod@drop`] | drop and rebound heights, or times of impact | restitution, `c` |
//! | [`friction`] | pull forces, or tilt angles | static and kinetic μ |
//! | [`response`] | histories of a shaken stack | `k`, `c`, μ together |
//! | [`mod@collapse`] | mode and fall times of collapses | `k`, `c`, μ together |
//!
//! In simulated records, the intervals of [`response`] covered the truth in only about 90 %.
//!
//! Files are CSV with a header whose columns carry their unit, such as `penetration (mm),force (kN)`.
//! Intervals cover the scatter in the file; values given as exact (a mass, the model itself) are not included.

// Results must be bit-identical on every machine, so transcendental functions are those of `libm`.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod collapse;
pub mod drop;
mod error;
mod figures;
pub mod friction;
mod impact;
pub mod least_squares;
mod page;
mod parameters;
pub mod response;
mod result;
pub mod sag;
pub mod statistics;
pub mod stiffness;
pub mod sway;

pub use barrelstack_input::measured::{Table, TableError};
pub use error::CalibrateError;
pub use impact::{Impact, impact};
pub use parameters::Parameter;
pub use result::{Calibration, CalibrationDocument, Estimate};
