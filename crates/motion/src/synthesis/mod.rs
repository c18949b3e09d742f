//! Synthetic ground motions from formulas and from random numbers with a stated seed.

mod boore;
mod clough_penzien;
mod near_fault;

pub use boore::{BooreSource, Path, SiteAmplification};
pub use clough_penzien::{CloughPenzien, Envelope};
pub use near_fault::NearFault;

use crate::error::MotionError;
use crate::ground_motion::GroundMotion;
use crate::history::History;
use crate::process::Processing;
use crate::sampled::Sampled;

/// Largest number of samples of a synthetic motion.
const MOST_SAMPLES: f64 = 2e7;

/// Returns the number of time steps of a synthetic motion.
fn step_count(duration: f64, time_step: f64) -> Result<usize, MotionError> {
    MotionError::require_positive("duration (s)", duration)?;
    MotionError::require_positive("time step (s)", time_step)?;
    let steps = (duration / time_step * (1.0 - 1e-12)).ceil();
    let fits = (2.0..=MOST_SAMPLES).contains(&steps);
    let expected = format!("2 to {MOST_SAMPLES:e}");
    MotionError::require(fits, "duration over time step", expected, steps)?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 2e7")]
    Ok(steps as usize)
}

/// Processes simulated accelerations into a ground motion with its provenance.
fn motion(
    name: &str,
    time_step: f64,
    acceleration: &[f64],
    processing: &Processing,
    made: String,
) -> Result<GroundMotion, MotionError> {
    let processed = processing.apply(time_step, acceleration, 0.0)?;
    let history = History::Sampled(Sampled::new(time_step, processed.acceleration)?);
    let mut motion = GroundMotion::new(name, history, None);
    motion.provenance.push(made);
    motion.provenance.extend(processed.steps);
    Ok(motion)
}
