//! Strong ground motion: read, process, scale, synthesize and measure.
//!
//! A file is read into a [`Record`]: the motion as recorded, in SI units, with all data of the
//! header. A record is processed and scaled to a [`GroundMotion`], which can drive a model.
//! [`History::at`] returns displacement, velocity and acceleration at any time; the three are exact
//! derivatives of one another.
//!
//! ```
//! use barrelstack_motion::{IntensityMeasure, bundled};
//! let record = bundled("napa-college-2014").unwrap();
//! let motion = record.default_motion()?.scale_to(IntensityMeasure::Pgv, 0.6)?;
//! let now = motion.horizontal.at(33.0);
//! assert!(now.velocity.abs() <= 0.6);
//! for step in &motion.provenance {
//!     println!("{step}");
//! }
//! # Ok::<(), barrelstack_motion::MotionError>(())
//! ```
//!
//! # Conventions
//!
//! - Numbers are SI: m, m/s, m/s², s, rad, with three exceptions. Directions, latitudes and
//!   longitudes are in degrees, and azimuths are clockwise from north. Sources and paths of
//!   [`BooreSource`] are in km, km/s, bar and g/cm³, as in the literature. Design codes and
//!   flatfiles keep their own units (PGA and Sa in g, distances in km).
//! - g is 9.80665 m/s² ([`STANDARD_GRAVITY`]).
//! - Vertical components are positive upward; the sign of a downward channel is reversed when read.
//! - Acceleration is linear between samples, velocity quadratic, displacement cubic.
//! - Before t = 0 the ground is at rest; after the end the acceleration is zero and the velocity is
//!   constant.
//! - Intensity measures use trapezoidal integration and the largest sample values, as is customary
//!   for published values. The displacement that drives a model is the exact integral of
//!   its acceleration; its peak ([`Sampled::pgd`]) is up to 0.4 % above the published value.
//! - Units and steps are never guessed: a file without them needs [`ReadOptions`].
//!
//! # Overview
//!
//! - Reading: [`read`], [`FORMATS`], [`ReadError`]. Parts and components: [`Record::join`],
//!   [`Record::gather`].
//! - Selecting and processing: [`Component`], [`Record::ground_motion`], [`Processing`].
//! - Filter corners determined from the noise: [`Record::noise_corners`]. Axes of a fault:
//!   [`Record::fault_axes`].
//! - Measuring: [`IntensityMeasure`], [`Horizontals`], [`ResponseSpectrum`], [`rotated_spectrum`],
//!   [`dominant_pulse`], [`classify_component`], [`classify_pair`].
//! - Downloaded archives: [`read`] reads a single record, [`Archive`] gives access to the files.
//! - Many records: [`group_files`], [`measure`], [`Flatfile`].
//! - Scaling and matching: [`GroundMotion::scale_to`], [`GroundMotion::froude`],
//!   [`GroundMotion::match_spectrum`], [`TargetSpectrum`].
//! - Synthesis: [`Pulse`], [`CloughPenzien`], [`BooreSource`], [`NearFault`]. Random numbers:
//!   [`Random`].

// Results must be bit-identical on every machine, so the system's transcendental functions are not
// used (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` also rejects NaN")]

#[macro_use]
mod printed;

mod align;
mod archive;
mod bundled;
mod changed;
mod collection;
mod corners;
mod direction;
mod earthquake;
mod error;
mod fault_axes;
mod format;
mod ground_motion;
mod horizontals;
mod instrument;
mod join;
mod matched;
mod matching;
mod matching_pair;
mod people;
mod process;
mod record;
mod rotd;
mod select;
mod site;
mod synthesis;
mod synthesis_text;
mod units;
mod utc;
mod wavelets;
pub mod write;

// Makes these modules available as modules of this crate.
use barrelstack_series::{
    fourier, history, intensity, layers, math, normal_equations, pulse, pulse_class, random,
    response, sampled, target,
};

pub use archive::Archive;
pub use barrelstack_series::pulse_fit::{PulseFit, dominant_pulse};
pub use bundled::{BUNDLED, bundled};
pub use collection::{
    FlatRow, Flatfile, Measured, MeasuredComponent, MeasuredPair, RecordFiles, group_files,
    measure, record_sequence_number,
};
pub use corners::{Corners, NoiseCriterion, noise_corners};
pub use direction::{Direction, Orientation};
pub use earthquake::Earthquake;
pub use error::{Given, MotionError, ReadError, ReadFailure, Refusal};
pub use fault_axes::Turned;
pub use format::{FORMATS, Format, ReadOptions, read};
pub use fourier::FourierSpectrum;
pub use ground_motion::GroundMotion;
pub use history::{Delayed, History};
pub use horizontals::Horizontals;
pub use instrument::{Instrument, station_xml};
pub use intensity::{IntensityMeasure, arias, husid};
pub use matched::{Matched, MatchedPair, Missed, missed_in_words};
pub use matching::{MatchMethod, Matching};
pub use math::STANDARD_GRAVITY;
pub use process::{MeanRemoval, Pads, Processed, Processing, Residuals};
pub use pulse::Pulse;
pub use pulse_class::{ClassifiedPulse, classify_component, classify_pair};
pub use random::Random;
pub use record::{Channel, Implausible, Quantity, Record, Stage, StatedPeak, Warning};
pub use response::{ResponsePeaks, ResponseSpectrum, response, standard_periods};
pub use rotd::{RotatedPeak, rotated_peak, rotated_spectrum};
pub use sampled::{Kinematics, Sampled};
pub use select::Component;
pub use site::Site;
pub use synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, Path, SiteAmplification};
pub use target::{ChileanZone, NCh2745Soil, SiteClass, TargetSpectrum};
pub use units::AccelerationUnit;
pub use utc::Utc;

/// The example in the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
