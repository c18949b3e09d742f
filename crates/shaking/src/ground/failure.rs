//! Errors in reading or scaling the ground motion of a scenario.

use std::path::PathBuf;

use barrelstack_motion::{MotionError, ReadError};

/// The reason why a scenario has no ground motion.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    /// The file of a record cannot be opened.
    #[error("cannot read the record {path}: {reason}{obtain}", path = path.display())]
    Unreadable {
        /// Path of the file that cannot be opened.
        path: PathBuf,
        /// Error message from the operating system.
        reason: String,
        /// Advice on obtaining the file, worded so that it can follow `reason`; may be empty.
        obtain: String,
    },
    /// The content of the file cannot be read as a record.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The record lacks the component, or cannot be scaled as specified.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The record has no vertical component of the requested name.
    #[error("{error}; for a record without a vertical component set `motion.vertical = false`")]
    Vertical {
        /// Error that names the missing component and the available components.
        error: MotionError,
    },
    /// There is no bundled record of this name.
    #[error("there is no bundled record \"{name}\"; {next}")]
    UnknownBundled {
        /// The requested name.
        name: String,
        /// Advice to use one of the available names.
        next: String,
    },
    /// The unit that the scenario states for a file is not a supported unit of acceleration.
    #[error(
        "motion.unit = {unit} m/s² is not a supported unit of acceleration: use 1 g, 0.1 g, 1 m/s^2, \
         1 cm/s^2, 1 mm/s^2, 1 ft/s^2 or 1 in/s^2"
    )]
    Unit {
        /// The stated unit (m/s²).
        unit: f64,
    },
}
