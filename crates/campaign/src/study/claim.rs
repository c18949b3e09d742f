//! Claims: a process works on a chunk as long as it holds a file of the folder locked.
//!
//! The lock is one of the operating system (`flock`, on network file systems too), so it ends with its process
//! however that ends, and another process takes over the chunk.
//! A stopped process (`kill -STOP`) keeps its lock; the file names it.
//! File systems without locks exclude nobody: a chunk may be run twice, and either shard will do.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::error::StudyError;
use crate::system;

/// Exclusive claim of a chunk, released on drop.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    // Dropped, and so unlocked, after its name is removed.
    _file: File,
}

/// Holder of a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// The process and its machine: "process 4711 on node-3".
    pub who: String,
    /// Time since it claimed the chunk.
    pub age: Duration,
}

impl Claim {
    /// Claims the chunk; `None` while another process or thread holds it.
    pub(super) fn take(path: PathBuf) -> Result<Option<Self>, StudyError> {
        let failed = StudyError::system("claim a chunk by", &path);
        remove_foreign(&path).map_err(failed)?;
        let mut file = system::open_to_change(&path).map_err(failed)?;
        match file.try_lock() {
            // Any other error means that the file system has no locks, each in its own words.
            Ok(()) | Err(TryLockError::Error(_)) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
        }
        // For information only: a full disk must not prevent the work.
        drop(file.set_len(0).and_then(|()| file.write_all(this_process().as_bytes())));
        Ok(Some(Self { path, _file: file }))
    }
}

/// Removes anything in the place of a claim that is not one: a link, or a second name of another file.
fn remove_foreign(path: &Path) -> std::io::Result<()> {
    let found = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        found => found?,
    };
    if found.is_file() && !has_other_names(&found) {
        return Ok(());
    }
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

#[cfg(unix)]
fn has_other_names(file: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    file.nlink() > 1
}

#[cfg(not(unix))]
fn has_other_names(_: &fs::Metadata) -> bool {
    false
}

/// Names this process and its machine.
fn this_process() -> String {
    let host = ["/proc/sys/kernel/hostname", "/etc/hostname"]
        .iter()
        .find_map(|file| String::from_utf8(system::read_result(Path::new(file), 1000).ok()?).ok());
    let host = host.as_deref().map(str::trim).filter(|host| !host.is_empty());
    let process = format!("process {}", std::process::id());
    host.map_or(process.clone(), |host| format!("{process} on {host}"))
}

/// Returns the holder of a chunk by its claim; `None` if there is no claim or this process has it.
pub fn holder(folder: &Path, chunk: usize) -> Option<Holder> {
    let path = folder.join("shards").join(format!("{chunk:06}.claim"));
    let text = String::from_utf8(system::read_result(&path, 1000).ok()?).ok()?;
    let age = fs::metadata(&path).ok()?.modified().ok()?.elapsed().unwrap_or_default();
    let plain: String = text.trim().chars().filter(|c| !c.is_control()).take(200).collect();
    if plain == this_process() {
        return None;
    }
    let who = if plain.starts_with("process ") { plain } else { "another process".to_owned() };
    Some(Holder { who, age })
}

impl Drop for Claim {
    fn drop(&mut self) {
        // A process that opened the file before and locks it later looks for the shard once more, and finds it.
        drop(fs::remove_file(&self.path));
    }
}
