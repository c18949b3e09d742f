//! Requests about a motion that cannot be met, as sentences with a next move.

use std::fmt;

/// A request about a motion that cannot be met.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// A parameter lies outside its range.
    #[error("{what}: expected {expected}, found {found}")]
    Parameter {
        /// The parameter, in words.
        what: String,
        /// The permitted range.
        expected: String,
        /// The value given.
        found: String,
    },
    /// A measure that does not grow with the motion cannot be a scaling target.
    #[error("{measure} cannot be scaled to: {reason}; choose a measure such as PGV or Sa")]
    NotScalable {
        /// Name of the measure.
        measure: String,
        /// Why no factor exists.
        reason: String,
    },
    /// The motion is zero in the measure asked for.
    #[error(
        "{measure} of \"{motion}\" is zero, so no factor brings it to {target}; choose another component or another record"
    )]
    Zero {
        /// Name of the measure.
        measure: String,
        /// Name of the motion.
        motion: String,
        /// The wanted value with its unit.
        target: String,
    },
    /// No channel answers the selection.
    #[error("{file} has no channel {wanted}; it has {available}")]
    NoChannel {
        /// Name of the file.
        file: String,
        /// What was asked for.
        wanted: String,
        /// What there is.
        available: String,
    },
    /// Two series that must be combined differ in step or do not fit.
    #[error("{what}; {remedy}")]
    Mismatch {
        /// The disagreement.
        what: String,
        /// The next move.
        remedy: String,
    },
    /// An iteration did not reach its tolerance.
    #[error("{what} reached {reached} after {rounds} rounds, wanted {wanted}; {remedy}")]
    NotConverged {
        /// The iteration.
        what: String,
        /// Best misfit reached, printed.
        reached: String,
        /// Rounds done.
        rounds: usize,
        /// Tolerance, printed.
        wanted: String,
        /// The next move.
        remedy: String,
    },
}

impl MotionError {
    /// A number that is not what it should be: what it is, what was expected, what was found.
    pub fn parameter(
        what: impl Into<String>,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Self {
        Self::Parameter { what: what.into(), expected: expected.into(), found: found.to_string() }
    }

    /// Things that do not go together, and the next move.
    pub fn mismatch(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Mismatch { what: what.into(), remedy: remedy.into() }
    }

    /// `Ok` when a number is what it should be.
    ///
    /// # Errors
    /// When it is not, as [`MotionError::parameter`] says it.
    pub fn require(
        holds: bool,
        what: impl Into<String>,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::parameter(what, expected, found)) }
    }

    /// `Ok` when `value` is finite and above zero.
    ///
    /// # Errors
    /// When it is not, in words that begin with `what` it is.
    pub fn require_positive(what: &str, value: f64) -> Result<(), Self> {
        let positive = value.is_finite() && value > 0.0;
        Self::require(positive, what, "a finite number above 0", value)
    }

    /// `Ok` when `value` is finite.
    ///
    /// # Errors
    /// When it is not.
    pub fn require_finite(what: &str, value: f64) -> Result<(), Self> {
        Self::require(value.is_finite(), what, "a finite number", value)
    }
}
