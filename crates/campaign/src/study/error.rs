//! Errors of studies.

use std::path::{Path, PathBuf};

use crate::ground::GroundError;
use crate::scenario::ScenarioError;
use crate::system;

/// Error that occurs when a study is planned, run or collected.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study file, its base scenario or a value of a factor is invalid.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// A motion of the study cannot be read or generated.
    #[error("the motion \"{name}\": {error}")]
    Motion {
        /// Name of the motion.
        name: String,
        /// Reason for the error.
        error: Box<GroundError>,
    },
    /// A system call failed.
    #[error("cannot {doing} {path}: {reason}", path = path.display())]
    System {
        /// The action that failed, such as "write".
        doing: &'static str,
        /// Path of the file or folder.
        path: PathBuf,
        /// Error message from the operating system.
        reason: String,
    },
    /// The folder does not belong to this study.
    #[error("{folder} {reason}", folder = folder.display())]
    Folder {
        /// Path of the folder.
        folder: PathBuf,
        /// Description of the problem and of its remedy. The phrase follows the path in the error message, as in "is a
        /// file, not a folder; name a folder".
        reason: String,
    },
    /// A shard is damaged.
    #[error(
        "the shard {path} is damaged: {reason}; run the study again, which renames the damaged shard and runs its \
         chunk again",
        path = path.display()
    )]
    Shard {
        /// Path of the shard.
        path: PathBuf,
        /// Description of the damage.
        reason: String,
    },
    /// There is no built-in study with this name.
    #[error("{0}")]
    BuiltIn(String),
    /// The columns or rows of a table are invalid, or the table cannot be converted to or from Parquet.
    #[error("{0}")]
    Table(String),
    /// The study has no chunk with this number.
    #[error("{0}")]
    Chunk(String),
    /// The caller canceled the run.
    #[error("stopped")]
    Stopped,
}

impl From<parquet::errors::ParquetError> for StudyError {
    fn from(error: parquet::errors::ParquetError) -> Self {
        Self::Table(error.to_string())
    }
}

impl StudyError {
    /// Returns a function that converts an I/O error to [`StudyError::System`], for the action `doing` on `path`.
    pub(crate) fn system(
        doing: &'static str,
        path: &Path,
    ) -> impl Fn(std::io::Error) -> Self + Copy {
        move |error| Self::System { doing, path: path.to_owned(), reason: system::words(&error) }
    }
}
