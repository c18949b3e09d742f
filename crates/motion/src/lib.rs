//! Strong ground motion: read, process, scale, synthesize and measure.
//!
//! A file becomes a [`Record`] (as recorded, SI, with all data of its header), a record becomes a
//! [`GroundMotion`] (processed, scaled, ready to drive a model), and [`History::at`] returns displacement,
//! velocity and acceleration of a motion at any time, which are exact derivatives of one another.
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
//! - Numbers are SI: m, m/s, m/s², s, rad. Three exceptions: directions, latitudes and longitudes are
//!   degrees, azimuths clockwise from north; sources and paths of [`BooreSource`] are km, km/s, bar and
//!   g/cm³, as in the literature; codes and flatfiles keep their own (PGA and Sa in g, distances in
//!   km).
//! - g is 9.80665 m/s² ([`STANDARD_GRAVITY`]).
//! - Vertical components are positive upward; a downward channel is reversed when read.
//! - Acceleration is linear between samples, velocity quadratic, displacement cubic.
//! - Before t = 0 the ground is at rest; after the end the acceleration is zero and the velocity is held.
//! - Measures are trapezoids and peaks of the samples, as published values are; the displacement that
//!   drives a model is the exact integral of its acceleration, whose peak ([`Sampled::pgd`]) lies up to
//!   0.4 % above the published one.
//! - Units and steps are never guessed: a file without them needs [`ReadOptions`].
//!
//! # Overview
//!
//! - Reading: [`read`], [`FORMATS`], [`ReadError`]; parts and components: [`Record::join`],
//!   [`Record::gather`].
//! - Choosing and processing: [`Component`], [`Record::ground_motion`], [`Processing`].
//! - Corners from the noise: [`Record::noise_corners`]; across and along a fault:
//!   [`Record::fault_axes`].
//! - Measuring: [`IntensityMeasure`], [`Horizontals`], [`ResponseSpectrum`], [`rotated_spectrum`],
//!   [`dominant_pulse`], [`classify_component`], [`classify_pair`].
//! - Archives as downloaded: [`read`] reads one record, [`Archive`] its files.
//! - Many records: [`group_files`], [`measure`], [`Flatfile`].
//! - Scaling and matching: [`GroundMotion::scale_to`], [`GroundMotion::froude`],
//!   [`GroundMotion::match_spectrum`], [`TargetSpectrum`].
//! - Synthesis: [`Pulse`], [`CloughPenzien`], [`BooreSource`], [`NearFault`], all from stated seeds of
//!   [`Random`].

// Physics has the same bits on every machine, so transcendental functions are our own (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(x > 0.0)` refuses NaN with everything else that is not above zero"
)]

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

// Available in this crate under their own names, like the modules beside them.
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
pub use record::{Channel, Quantity, Record, Stage, StatedPeak, Warning};
pub use response::{ResponsePeaks, ResponseSpectrum, response, standard_periods};
pub use rotd::{RotatedPeak, rotated_peak, rotated_spectrum};
pub use sampled::{Kinematics, Sampled};
pub use select::Component;
pub use site::Site;
pub use synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, Path, SiteAmplification};
pub use target::{ChileanZone, NCh2745Soil, SiteClass, TargetSpectrum};
pub use units::AccelerationUnit;
pub use utc::Utc;
