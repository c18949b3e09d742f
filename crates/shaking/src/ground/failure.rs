//! Why a scenario has no ground motion.

use std::path::PathBuf;

use barrelstack_motion::{MotionError, ReadError};

/// Why a scenario has no ground motion.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    /// The file of a record cannot be opened.
    #[error("cannot read the record {path}: {reason}{obtain}", path = path.display())]
    Unreadable {
        /// The path that was tried.
        path: PathBuf,
        /// What the system says.
        reason: String,
        /// How to come by it, as a sentence that goes on from the reason; may be empty.
        obtain: String,
    },
    /// The file is no record.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The record has no such component, or cannot be scaled so.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The record has no vertical component of the name that the scenario asks for.
    #[error("{error}; for a record without one say `motion.vertical = false`")]
    Vertical {
        /// What is missing, and what there is.
        error: MotionError,
    },
    /// There is no bundled record of that name.
    #[error("there is no bundled record \"{name}\"; the bundled ones are: {known}")]
    UnknownBundled {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A unit that no file uses.
    #[error(
        "motion.unit = {unit} m/s² is no unit of acceleration files: use 1 g, 0.1 g, 1 m/s^2, \
         1 cm/s^2, 1 mm/s^2, 1 ft/s^2 or 1 in/s^2"
    )]
    Unit {
        /// The unit asked for (m/s²).
        unit: f64,
    },
}
