//! Strong ground motion: read, process, scale, synthesise and measure.
//!
//! Inside, every number is SI: m, m/s, m/s², s, rad; azimuths alone are degrees clockwise from north.
//! Vertical components are positive upward.

mod error;
mod fourier;
mod ground_motion;
mod history;
mod intensity;
mod math;
mod pulse;
mod response;
mod sampled;

pub use error::{MotionError, ReadError, Refusal};
pub use fourier::FourierSpectrum;
pub use ground_motion::GroundMotion;
pub use history::{Delayed, History};
pub use intensity::{IntensityMeasure, arias, husid};
pub use math::STANDARD_GRAVITY;
pub use pulse::Pulse;
pub use response::{
    ResponsePeaks, ResponseSpectrum, response, response_subdivided, standard_periods,
};
pub use sampled::{Kinematics, Sampled};
