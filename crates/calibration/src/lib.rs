//! Calibration of contact parameters from tests, with a 95 % interval for each parameter.
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
//! | [`mod@shares`] | shares of stacks that fell in an earthquake | `k`, `c`, μ together |
//!
//! In tests with simulated records, the 95 % intervals of [`response`] covered the true value in only about
//! 90 % of cases.
//!
//! Files are CSV with a header that names each column and its unit, such as `penetration (mm),force (kN)`.
//! Intervals cover the scatter of the data in the file. They do not cover errors of values that are taken as
//! exact, such as a mass, or errors of the model itself.

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
pub mod shares;
pub mod statistics;
pub mod stiffness;
pub mod sway;

pub use barrelstack_input::measured::{Table, TableError};
pub use error::CalibrateError;
pub use impact::{Impact, impact};
pub use parameters::Parameter;
pub use result::{Calibration, CalibrationDocument, Estimate, ModelShare};

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
