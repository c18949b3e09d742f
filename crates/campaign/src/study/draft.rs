//! Files that have their names only when they are whole and on the disk.

use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::system;

use super::error::StudyError;

/// Writes a file under another name, brings it to the disk, and gives it its own.
pub(super) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    let write = || -> std::io::Result<()> {
        let draft = Draft::create(path)?;
        (&draft.file).write_all(bytes)?;
        draft.name()
    };
    write().map_err(StudyError::system("write", path))
}

/// How often a folder is made anew that others take away.
const TRIES: u32 = 10;

/// Files of this process that have not got their names.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the files that this process is writing and that have not got their names, and lets it begin no others: it
/// ends.
pub fn remove_drafts() {
    let drafts = system::taken(&DRAFTS);
    for draft in drafts.iter().flat_map(|drafts| drafts.iter()) {
        // It may have got its name since, and then it is whole.
        drop(fs::remove_file(draft));
    }
}

/// A file that is being written under another name; gone again where it never gets its own.
pub(super) struct Draft {
    pub(super) file: File,
    path: PathBuf,
    whole: PathBuf,
}

impl Draft {
    /// Begins a file, under a name that no other draft ever had or will have: whoever tidies up behind a draft that got
    /// its own name in between must not find another one in its place.
    pub(super) fn create(whole: &Path) -> std::io::Result<Self> {
        let name = whole.file_name().unwrap_or_default().to_string_lossy();
        let mut tries = 0_u32;
        loop {
            // Keyed anew each time by numbers that the system draws.
            let number = RandomState::new().build_hasher().finish();
            let path = whole.with_file_name(format!(".{name}.{number:016x}.part"));
            tries += 1;
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            let file = match File::options().write(true).create_new(true).open(&path) {
                Ok(file) => file,
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                // Another process that only tried whether it may write here took its empty folder away again.
                Err(error) if error.kind() == ErrorKind::NotFound && tries < TRIES => {
                    whole.parent().map_or(Ok(()), fs::create_dir_all)?;
                    continue;
                }
                Err(error) => return Err(error),
            };
            // Tells those who tidy the folder that its writer is alive. One of them may have come before.
            let taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
            if !taken && path.exists() {
                drafts.push(path.clone());
                return Ok(Self { file, path, whole: whole.to_owned() });
            }
        }
    }

    /// Brings it to the disk, and gives it its name.
    pub(super) fn name(self) -> std::io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.path, &self.whole)?;
        sync_folder(self.whole.parent().unwrap_or_else(|| Path::new(".")))
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Not there any more where it got its name.
        drop(fs::remove_file(&self.path));
        if let Ok(mut drafts) = DRAFTS.lock() {
            drafts.retain(|path| *path != self.path);
        }
    }
}

/// Brings the names in a folder to the disk, where the system has a way to.
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

    /// Between the moment when a draft gets its name and the one when its writer is done, another writer may have begun
    /// a draft that is called as the first was.
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
