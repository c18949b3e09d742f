//! Errors between a file and a usable ground motion, as sentences with a remedy.

pub use barrelstack_series::MotionError;

/// Reason for the refusal of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No reader recognizes the bytes.
    Unrecognized,
    /// The file is sound but holds something other than an acceleration history.
    NotAcceleration,
    /// The file contradicts itself or its format: truncated, overflowed, miscounted, not a number.
    Damaged,
    /// The archive has several records, of which one must be named.
    SeveralRecords,
    /// The file lacks required information that the caller did not give.
    Missing(Given),
    /// The channel is of another instrument than an accelerometer; the caller may request differentiation.
    OtherInstrument,
    /// An option is out of range; the file was not read.
    Options,
}

/// Information that a caller may have to supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// The unit of acceleration.
    Unit,
    /// The step.
    Step,
    /// The sensitivity, since the file has counts.
    Sensitivity,
    /// Either of both, since the file may have accelerations or counts.
    UnitOrSensitivity,
}

/// Error of reading a file: its place, the expectation, the finding, and the remedy.
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
    /// The expectation of the reader.
    pub expected: String,
    /// The finding there.
    pub found: String,
    /// The remedy.
    pub remedy: String,
}

/// Formats `, line 5, column 3`, as far as known.
fn place(line: Option<usize>, column: Option<usize>) -> String {
    let part =
        |what: &str, of: Option<usize>| of.map_or_else(String::new, |n| format!(", {what} {n}"));
    part("line", line) + &part("column", column)
}
