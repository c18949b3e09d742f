//! Strong ground motion: read, process, scale, synthesise and measure.
//!
//! Inside, every number is SI: m, m/s, m/s², s, rad; azimuths alone are degrees clockwise from north.
//! Vertical components are positive upward.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(x > 0.0)` refuses NaN with everything else that is not above zero"
)]

mod bundled;
mod direction;
mod error;
mod format;
mod fourier;
mod ground_motion;
mod history;
mod intensity;
mod join;
mod matching;
mod math;
mod process;
mod pulse;
mod pulse_fit;
mod random;
mod record;
mod response;
mod rotd;
mod sampled;
mod select;
mod synthesis;
mod target;
mod units;
mod wavelets;

pub use bundled::{BUNDLED, bundled};
pub use direction::{Direction, Orientation};
pub use error::{MotionError, ReadError, ReadFailure, Refusal};
pub use format::{FORMATS, Format, ReadOptions, read, slammer_step, station_xml_sensitivities};
pub use fourier::FourierSpectrum;
pub use ground_motion::GroundMotion;
pub use history::{Delayed, History};
pub use intensity::{IntensityMeasure, arias, husid};
pub use matching::{MatchMethod, Matched, Matching};
pub use math::STANDARD_GRAVITY;
pub use process::{MeanRemoval, Pads, Processed, Processing, Residuals};
pub use pulse::Pulse;
pub use pulse_fit::{PulseFit, dominant_pulse};
pub use random::Random;
pub use record::{Channel, Quantity, Record, Stage, StatedPeak, Warning};
pub use response::{
    ResponsePeaks, ResponseSpectrum, response, response_subdivided, standard_periods,
};
pub use rotd::{RotatedPeak, rotated_peak, rotated_spectrum};
pub use sampled::{Kinematics, Sampled};
pub use select::Component;
pub use synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, Path, SiteAmplification};
pub use target::{ChileanZone, NCh2745Soil, SiteClass, TargetSpectrum};
pub use units::AccelerationUnit;
