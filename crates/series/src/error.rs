//! Errors in ground-motion computations, written as sentences that include a remedy.

use std::fmt;

/// The reason why a computation on a ground motion failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// A parameter lies outside its range.
    #[error("{what}: expected {expected}, found {found}")]
    Parameter {
        /// Name of the parameter, such as "period of FIV3 (s)".
        what: String,
        /// The permitted range.
        expected: String,
        /// The value given.
        found: String,
    },
    /// A measure that does not grow with the amplitude of the motion cannot be a scaling target.
    #[error("a motion cannot be scaled to {measure}: {reason}; choose a measure such as PGV or Sa")]
    NotScalable {
        /// Name of the measure.
        measure: String,
        /// Reason why no scale factor exists.
        reason: String,
    },
    /// The requested measure of the motion is zero.
    #[error(
        "{measure} of \"{motion}\" is zero, so no factor can scale it to {target}; choose another component or another \
         record"
    )]
    Zero {
        /// Name of the measure.
        measure: String,
        /// Name of the motion.
        motion: String,
        /// The requested value, with its unit.
        target: String,
    },
    /// No channel of the record matches the selection.
    #[error("{file} has no channel {wanted}; it has {available}")]
    NoChannel {
        /// Name of the file.
        file: String,
        /// The requested channel.
        wanted: String,
        /// Names of the channels in the file, or their number.
        available: String,
    },
    /// Two time series that are to be combined have different time steps or otherwise do not match.
    #[error("{what}; {remedy}")]
    Mismatch {
        /// Description of the mismatch.
        what: String,
        /// Suggested remedy.
        remedy: String,
    },
    /// An iterative computation did not reach its tolerance.
    #[error(
        "{what} reached {reached} after {rounds} iterations, but at most {wanted} is allowed; {remedy}"
    )]
    NotConverged {
        /// Name of the computation, such as "spectral matching".
        what: String,
        /// Smallest misfit reached, formatted.
        reached: String,
        /// Number of iterations.
        rounds: usize,
        /// Required tolerance, formatted.
        wanted: String,
        /// Suggested remedy.
        remedy: String,
    },
}

impl MotionError {
    /// Creates an error about a parameter from its name, its permitted range and its value.
    pub fn parameter(
        what: impl Into<String>,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Self {
        Self::Parameter { what: what.into(), expected: expected.into(), found: found.to_string() }
    }

    /// Creates an error about inputs that do not match, with a remedy.
    pub fn mismatch(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Mismatch { what: what.into(), remedy: remedy.into() }
    }

    /// Returns `Ok` if a condition on a parameter holds.
    ///
    /// # Errors
    /// [`MotionError::Parameter`] if the condition does not hold.
    pub fn require(
        holds: bool,
        what: impl Into<String>,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::parameter(what, expected, found)) }
    }

    /// Returns `Ok` if `value` is finite and above zero.
    ///
    /// # Errors
    /// If `value` is not finite or not above zero; the message begins with `what`.
    pub fn require_positive(what: &str, value: f64) -> Result<(), Self> {
        let positive = value.is_finite() && value > 0.0;
        Self::require(positive, what, "a finite number above 0", value)
    }

    /// Returns `Ok` if `value` is finite.
    ///
    /// # Errors
    /// If `value` is not finite; the message begins with `what`.
    pub fn require_finite(what: &str, value: f64) -> Result<(), Self> {
        Self::require(value.is_finite(), what, "a finite number", value)
    }
}
