//! Why a study cannot be planned, run or collected.

use std::path::{Path, PathBuf};

use crate::ground::GroundError;
use crate::scenario::ScenarioError;
use crate::system;

/// Why a study cannot be planned, run or collected.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study file, its base scenario or a value of a factor is wrong, at a place.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// A motion of the study cannot be read or made.
    #[error("the motion \"{name}\" of the study: {error}")]
    Motion {
        /// Its name.
        name: String,
        /// Why.
        error: Box<GroundError>,
    },
    /// The system refused.
    #[error("cannot {doing} {path}: {reason}", path = path.display())]
    System {
        /// What was tried, such as "write".
        doing: &'static str,
        /// The path.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// The folder holds something else.
    #[error("{folder} {reason}", folder = folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What it holds, and what to do, as a sentence that goes on from its name.
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
        /// What shows it.
        reason: String,
    },
    /// There is no built-in study of that name.
    #[error("{0}")]
    BuiltIn(String),
    /// A table that does not hold together.
    #[error("{0}")]
    Table(String),
    /// A chunk that the study does not have.
    #[error("{0}")]
    Chunk(String),
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
}

impl From<parquet::errors::ParquetError> for StudyError {
    fn from(error: parquet::errors::ParquetError) -> Self {
        Self::Table(error.to_string())
    }
}

impl StudyError {
    /// What the system said when something was tried with a path.
    pub(crate) fn system(
        doing: &'static str,
        path: &Path,
    ) -> impl Fn(std::io::Error) -> Self + Copy {
        move |error| Self::System { doing, path: path.to_owned(), reason: system::words(&error) }
    }
}
