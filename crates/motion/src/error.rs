//! Errors in reading ground-motion files, written as sentences that include a remedy.

pub use barrelstack_series::MotionError;

/// Reason why a file is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No reader recognizes the content.
    Unrecognized,
    /// The file is valid but contains no acceleration history.
    NotAcceleration,
    /// The file is inconsistent or violates its format: it is truncated, or contains wrong numbers or
    /// numbers that overflowed their columns.
    Damaged,
    /// The archive contains several records; the caller must name one.
    SeveralRecords,
    /// The file lacks required information that the caller did not provide.
    Missing(Given),
    /// The channel was not recorded by an accelerometer; the caller may request differentiation.
    OtherInstrument,
    /// An option is out of range or contradicts the file.
    Options,
}

/// Information that a caller may have to provide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// The unit of the accelerations.
    Unit,
    /// The time step.
    Step,
    /// The sensitivity, because the file contains counts.
    Sensitivity,
    /// The unit or the sensitivity, because the file may contain accelerations or counts.
    UnitOrSensitivity,
}

/// An error in reading a file: the place, the expected content, the content found, and a remedy.
///
/// The fields of [`ReadFailure`] are accessible directly, as in `error.line` and `error.refusal`.
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

/// The fields of a [`ReadError`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}: expected {expected}, found {found}; {remedy}", place(*line, *column))]
pub struct ReadFailure {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Line, counted from 1.
    pub line: Option<usize>,
    /// Column of the first offending character, counted from 1.
    pub column: Option<usize>,
    /// Category of the refusal, so that callers can handle each category separately.
    pub refusal: Refusal,
    /// Content expected by the reader.
    pub expected: String,
    /// Content found.
    pub found: String,
    /// Remedy for the user.
    pub remedy: String,
}

/// Formats the place as `, line 5, column 3`, as far as known.
fn place(line: Option<usize>, column: Option<usize>) -> String {
    let part =
        |what: &str, of: Option<usize>| of.map_or_else(String::new, |n| format!(", {what} {n}"));
    part("line", line) + &part("column", column)
}
