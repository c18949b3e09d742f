//! Why a test gives no parameters.

use std::path::PathBuf;

use crate::run::RunFailure;

/// Why a test gives no parameters.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// The file cannot be read.
    #[error("cannot read {path}: {reason}", path = path.display())]
    Unreadable {
        /// The path.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// A place of the file is not what it should be.
    #[error("{file}, line {line}{place}: expected {expected}, found {found}; {remedy}", place = in_column(column.as_deref()))]
    Table {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The column, as the header names it; none where the whole line is meant.
        column: Option<String>,
        /// What should stand there.
        expected: Box<str>,
        /// What stands there.
        found: Box<str>,
        /// The next move.
        remedy: Box<str>,
    },
    /// The file is sound, and no parameter can be had from it.
    #[error("{file}: {reason}")]
    Unsuited {
        /// The file.
        file: String,
        /// Why, with the next move.
        reason: String,
    },
    /// The scenario does not go with the fit.
    #[error("{0}")]
    Scenario(String),
    /// The simulation that the fit starts from fails.
    #[error(transparent)]
    Run(#[from] RunFailure),
}

fn in_column(column: Option<&str>) -> String {
    column.map(|name| format!(", column \"{name}\"")).unwrap_or_default()
}
