//! What can go wrong between a file and a usable ground motion, as sentences with a next move.

use std::fmt;

/// Why a file was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No reader recognizes the bytes.
    Unrecognized,
    /// The file is sound but holds something other than an acceleration history.
    NotAcceleration,
    /// The file contradicts itself or its format: cut, overflown, counted wrong, not a number.
    Damaged,
    /// The file does not say something that must be known and was not given by the caller.
    Missing(Given),
    /// The channel is of another instrument than an accelerometer; the caller may have it
    /// differentiated.
    OtherInstrument,
    /// Something that the caller gave is out of its range; the file was not looked at.
    Options,
}

/// What a caller may have to say of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// The unit of acceleration.
    Unit,
    /// The step.
    Step,
    /// The sensitivity, as the file holds counts.
    Sensitivity,
    /// One of both, as the file may hold accelerations or counts.
    UnitOrSensitivity,
}

/// A file that could not be read: where, what was expected, what was found and what to do.
///
/// The fields are those of [`ReadFailure`], reached directly: `error.line`, `error.refusal`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(transparent)]
pub struct ReadError(Box<ReadFailure>);

impl std::ops::Deref for ReadError {
    type Target = ReadFailure;

    fn deref(&self) -> &ReadFailure {
        &self.0
    }
}

impl From<ReadFailure> for ReadError {
    fn from(failure: ReadFailure) -> Self {
        Self(Box::new(failure))
    }
}

/// The facts of a [`ReadError`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}: expected {expected}, found {found}; {remedy}", place(*line, *column))]
pub struct ReadFailure {
    /// Name of the file as given by the caller.
    pub file: String,
    /// Line, counted from 1.
    pub line: Option<usize>,
    /// Column of the first offending character, counted from 1.
    pub column: Option<usize>,
    /// The kind of refusal, for programs.
    pub refusal: Refusal,
    /// What the reader expected there.
    pub expected: String,
    /// What stands there.
    pub found: String,
    /// The next move.
    pub remedy: String,
}

/// `, line 5, column 3`, as far as it is known.
fn place(line: Option<usize>, column: Option<usize>) -> String {
    let part =
        |what: &str, of: Option<usize>| of.map_or_else(String::new, |n| format!(", {what} {n}"));
    part("line", line) + &part("column", column)
}

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
    pub(crate) fn require_finite(what: &str, value: f64) -> Result<(), Self> {
        Self::require(value.is_finite(), what, "a finite number", value)
    }
}
