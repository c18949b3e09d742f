//! What can go wrong between a file and a usable ground motion, as sentences with a next move.

pub use barrelstack_series::MotionError;

/// Why a file was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No reader recognizes the bytes.
    Unrecognized,
    /// The file is sound but holds something other than an acceleration history.
    NotAcceleration,
    /// The file contradicts itself or its format: cut, overflown, counted wrong, not a number.
    Damaged,
    /// The archive holds several records, of which one must be named.
    SeveralRecords,
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
