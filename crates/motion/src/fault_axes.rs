//! Rotates two horizontal components to the axes of a fault or to the horizontal direction with the
//! largest velocity.

use crate::error::MotionError;
use crate::record::{Channel, Record};
use crate::rotd::rotated_peak;
use crate::select::Component;

/// Two horizontal components after rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned {
    /// Component normal to the fault, or along the direction of the largest velocity.
    pub first: Channel,
    /// Component parallel to the fault, or perpendicular to the direction of the largest velocity.
    pub second: Channel,
    /// Description of the rotation, in one sentence.
    pub note: String,
}

impl Record {
    /// Returns the fault-normal and the fault-parallel component for a strike (degrees clockwise
    /// from north). The fault-parallel component is positive along the strike; the fault-normal
    /// component is positive 90 degrees clockwise from the strike.
    ///
    /// # Errors
    /// If the strike is not finite, or there are not two horizontal components of known azimuth.
    pub fn fault_axes(&self, strike: f64) -> Result<Turned, MotionError> {
        MotionError::require_finite("strike (degrees)", strike)?;
        Ok(Turned {
            first: self.named_along(strike + 90.0, "FN")?,
            second: self.named_along(strike, "FP")?,
            note: format!(
                "rotated to fault-normal FN (azimuth {}) and fault-parallel FP (azimuth {}) for a \
                 strike of {strike} degrees",
                (strike + 90.0).rem_euclid(360.0),
                strike.rem_euclid(360.0)
            ),
        })
    }

    /// Returns the components along and perpendicular to the horizontal direction of the largest
    /// velocity.
    ///
    /// # Errors
    /// If there are not two horizontal components of known azimuth.
    pub fn fastest_axes(&self) -> Result<Turned, MotionError> {
        let north = self.component(&Component::Azimuth(0.0))?;
        let east = self.component(&Component::Azimuth(90.0))?;
        let peak = rotated_peak(&north.velocity(), &east.velocity());
        let across = peak.angle - 90.0;
        Ok(Turned {
            first: self.named_along(peak.angle, "VMAX")?,
            second: self.named_along(across, "VMAX-90")?,
            note: format!(
                "rotated to VMAX, the direction of the largest velocity, {:.1} cm/s at azimuth {}, and \
                 VMAX-90, 90 degrees counterclockwise from it",
                100.0 * peak.largest,
                peak.angle
            ),
        })
    }

    /// Returns the motion along an azimuth (degrees), as a channel with the given name.
    fn named_along(&self, azimuth: f64, name: &str) -> Result<Channel, MotionError> {
        let mut channel = self.component(&Component::Azimuth(azimuth.rem_euclid(360.0)))?;
        name.clone_into(&mut channel.name);
        // The peaks stated in the header do not apply to another direction.
        channel.peaks.clear();
        Ok(channel)
    }
}
