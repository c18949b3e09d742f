//! Calibration of contact parameters from tests, each parameter with its 95 % interval.
//!
//! | test | file | gives |
//! |---|---|---|
//! | [`stiffness`] | penetration and force | `k` |
//! | [`mod@sag`] | load and sag of a rack | `k` |
//! | [`mod@sway`] | periods at which a stack sways after a tap | `k` |
//! | [`mod@drop`] | drop and rebound heights, or times of impact | restitution, `c` |
//! | [`friction`] | pull forces, or tilt angles | static and kinetic μ |
//! | [`response`] | histories of a shaken stack | `k`, `c`, μ together |
//! | [`mod@collapse`] | mode and fall times of collapses | `k`, `c`, μ together |
//!
//! In tests with simulated records, the intervals of [`response`] covered the true value in only about 90 %.
//!
//! Files are CSV with a header that names each column and its unit, such as `penetration (mm),force (kN)`.
//! Intervals cover the scatter in the file, not the errors of values taken as exact (a mass, the model itself).

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
