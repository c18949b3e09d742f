//! Draft files, which receive their final names only when they are complete and on the disk.

use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::system;

use super::error::StudyError;

/// Writes a file under a temporary name, syncs it to the disk, and renames it.
pub(super) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    let write = || -> std::io::Result<()> {
        let draft = Draft::create(path)?;
        (&draft.file).write_all(bytes)?;
        draft.name()
    };
    write().map_err(StudyError::system("write", path))
}

/// Maximum number of times that a folder is created again after another process has removed it.
const TRIES: u32 = 10;

/// Paths of the temporary files of this process.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the temporary files of this process before it exits.
///
/// The lock on the list of temporary files is never released, so that no thread can begin another file.
pub fn remove_drafts() {
    let drafts = system::taken(&DRAFTS);
    for draft in drafts.iter().flat_map(|drafts| drafts.iter()) {
        // Errors are ignored: a draft that was renamed in the meantime is complete.
        drop(fs::remove_file(draft));
    }
}

/// Temporary file. It is removed on drop unless it was renamed.
pub(super) struct Draft {
    pub(super) file: File,
    path: PathBuf,
    whole: PathBuf,
}

impl Draft {
    /// Creates a temporary file, which [`Draft::name`] renames to `whole`.
    ///
    /// The name of the temporary file is unique. Otherwise, a process that cleans the folder could remove a different
    /// draft with the same name.
    pub(super) fn create(whole: &Path) -> std::io::Result<Self> {
        let name = whole.file_name().unwrap_or_default().to_string_lossy();
        let mut tries = 0_u32;
        loop {
            // The random keys of the hasher make the name unique.
            let number = RandomState::new().build_hasher().finish();
            let path = whole.with_file_name(format!(".{name}.{number:016x}.part"));
            tries += 1;
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            let file = match File::options().write(true).create_new(true).open(&path) {
                Ok(file) => file,
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                // Another process has created the folder to test write access, and has removed it again.
                Err(error) if error.kind() == ErrorKind::NotFound && tries < TRIES => {
                    whole.parent().map_or(Ok(()), fs::create_dir_all)?;
                    continue;
                }
                Err(error) => return Err(error),
            };
            // Processes that clean the folder recognize by the lock that the writer is alive. One of them may have
            // locked the file first.
            let taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
            if !taken && path.exists() {
                drafts.push(path.clone());
                return Ok(Self { file, path, whole: whole.to_owned() });
            }
        }
    }

    /// Syncs the file to the disk and renames it to its final name.
    pub(super) fn name(self) -> std::io::Result<()> {
        system::replaceable(&self.whole)?;
        self.file.sync_all()?;
        fs::rename(&self.path, &self.whole)?;
        sync_folder(self.whole.parent().unwrap_or_else(|| Path::new(".")))
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Fails if the file was renamed, which is intended.
        drop(fs::remove_file(&self.path));
        if let Ok(mut drafts) = DRAFTS.lock() {
            drafts.retain(|path| *path != self.path);
        }
    }
}

/// Syncs the directory entries of a folder to the disk, if the system supports that.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> std::io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    /// A writer that has renamed its draft must not remove the draft that another writer has begun for the same file.
    #[test]
    fn writers_of_one_file_leave_the_drafts_of_the_others_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.json");
        let write = || (0..300).try_for_each(|_| write_whole(&path, b"{}"));
        thread::scope(|scope| {
            let writers = [0; 3].map(|_| scope.spawn(write));
            for writer in writers {
                writer.join().unwrap().unwrap();
            }
        });
        assert_eq!(fs::read(&path).unwrap(), b"{}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no draft is left");
    }
}
