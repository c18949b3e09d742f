//! Rotation of two horizontals: across and along a fault, or to the direction of the largest velocity.

use crate::error::MotionError;
use crate::record::{Channel, Record};
use crate::rotd::rotated_peak;
use crate::select::Component;

/// Two rotated horizontals.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned {
    /// Across the fault, or along the direction of the largest velocity.
    pub first: Channel,
    /// Along the fault, or across the direction of the largest velocity.
    pub second: Channel,
    /// Description of the rotation, one sentence.
    pub note: String,
}

impl Record {
    /// Returns the motion across (fault-normal) and along (fault-parallel) a fault of a strike (degrees clockwise
    /// from north), positive at 90 degrees clockwise from the strike and along it.
    ///
    /// # Errors
    /// If the strike is not finite or there are not two horizontals of known azimuth.
    pub fn fault_axes(&self, strike: f64) -> Result<Turned, MotionError> {
        MotionError::require_finite("strike (degrees)", strike)?;
        Ok(Turned {
            first: self.named_along(strike + 90.0, "FN")?,
            second: self.named_along(strike, "FP")?,
            note: format!(
                "turned to fault-normal FN (azimuth {}) and fault-parallel FP (azimuth {}) of strike \
                 {strike} degrees",
                (strike + 90.0).rem_euclid(360.0),
                strike.rem_euclid(360.0)
            ),
        })
    }

    /// Returns the motion along the horizontal direction of the largest velocity, and across it.
    ///
    /// # Errors
    /// If there are not two horizontals of known azimuth.
    pub fn fastest_axes(&self) -> Result<Turned, MotionError> {
        let north = self.component(&Component::Azimuth(0.0))?;
        let east = self.component(&Component::Azimuth(90.0))?;
        let peak = rotated_peak(&north.velocity(), &east.velocity());
        let across = peak.angle - 90.0;
        Ok(Turned {
            first: self.named_along(peak.angle, "VMAX")?,
            second: self.named_along(across, "VMAX-90")?,
            note: format!(
                "turned to VMAX, the direction of the largest velocity, {:.1} cm/s at azimuth {}, and \
                 VMAX-90, 90 degrees before it",
                100.0 * peak.largest,
                peak.angle
            ),
        })
    }

    /// Returns the motion along an azimuth (degrees) under a given name.
    fn named_along(&self, azimuth: f64, name: &str) -> Result<Channel, MotionError> {
        let mut channel = self.component(&Component::Azimuth(azimuth.rem_euclid(360.0)))?;
        name.clone_into(&mut channel.name);
        // Stated peaks of the header do not apply to another direction.
        channel.peaks.clear();
        Ok(channel)
    }
}
