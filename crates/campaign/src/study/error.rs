//! Errors of studies.

use std::path::{Path, PathBuf};

use crate::ground::GroundError;
use crate::scenario::ScenarioError;
use crate::system;

/// Error of planning, running or collecting a study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study file, its base scenario or a value of a factor is wrong, at a place.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// A motion of the study cannot be read or generated.
    #[error("the motion \"{name}\": {error}")]
    Motion {
        /// Its name.
        name: String,
        /// The reason.
        error: Box<GroundError>,
    },
    /// A system call failed.
    #[error("cannot {doing} {path}: {reason}", path = path.display())]
    System {
        /// The attempted action, such as "write".
        doing: &'static str,
        /// The path.
        path: PathBuf,
        /// The message of the system.
        reason: String,
    },
    /// The folder holds something else.
    #[error("{folder} {reason}", folder = folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Its contents, and the remedy, as a sentence that continues its name.
        reason: String,
    },
    /// A shard is damaged.
    #[error(
        "the shard {path} is damaged: {reason}; run the study again, which sets it aside and makes it anew",
        path = path.display()
    )]
    Shard {
        /// The file.
        path: PathBuf,
        /// The evidence.
        reason: String,
    },
    /// There is no built-in study of that name.
    #[error("{0}")]
    BuiltIn(String),
    /// A table is inconsistent.
    #[error("{0}")]
    Table(String),
    /// A chunk that the study does not have.
    #[error("{0}")]
    Chunk(String),
    /// The caller canceled.
    #[error("stopped")]
    Stopped,
}

impl From<parquet::errors::ParquetError> for StudyError {
    fn from(error: parquet::errors::ParquetError) -> Self {
        Self::Table(error.to_string())
    }
}

impl StudyError {
    /// Returns a function that wraps system errors of an action on a path.
    pub(crate) fn system(
        doing: &'static str,
        path: &Path,
    ) -> impl Fn(std::io::Error) -> Self + Copy {
        move |error| Self::System { doing, path: path.to_owned(), reason: system::words(&error) }
    }
}
