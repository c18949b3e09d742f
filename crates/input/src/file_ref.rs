//! A file named by an input file.

use std::path::PathBuf;

/// A file named by a scenario.
#[derive(Debug, Clone)]
pub struct FileRef {
    /// The path as written.
    pub path: String,
    /// Folder of the file that wrote it; empty for the current folder.
    pub folder: PathBuf,
}

impl FileRef {
    /// The path to open.
    pub fn resolve(&self) -> PathBuf {
        self.folder.join(&self.path)
    }
}

/// Two references are equal when they were written alike, so that a scenario keeps its identity
/// when its folder moves.
impl PartialEq for FileRef {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}
