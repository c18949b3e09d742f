//! Claims: a process works on a chunk as long as it holds a file of the folder locked.
//!
//! The lock is one of the operating system (`flock`, on network file systems too), so it ends with its process
//! however that ends, and the next one takes the chunk over.
//! Where a file system has no locks, nobody is kept out: a chunk may be run twice, and either shard will do.

use std::fs::{self, File, TryLockError};
use std::path::PathBuf;

use super::error::StudyError;

/// A chunk that no other process works on while this lives.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    // Closed, and so unlocked, behind the removal of its name.
    _file: File,
}

impl Claim {
    /// Takes it; none while another process or thread has it.
    pub(super) fn take(path: PathBuf) -> Result<Option<Self>, StudyError> {
        let file = File::create(&path).map_err(StudyError::system("claim a chunk by", &path))?;
        match file.try_lock() {
            // Any other refusal says that there are no locks here, each file system in its own words.
            Ok(()) | Err(TryLockError::Error(_)) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
        }
        Ok(Some(Self { path, _file: file }))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // Whoever opened the file before and locks it after looks for the shard once more, and finds it.
        drop(fs::remove_file(&self.path));
    }
}
