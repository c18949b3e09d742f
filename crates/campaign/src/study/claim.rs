//! Claims on chunks: a process keeps a file in the folder locked while it works on a chunk.
//!
//! The lock is an operating-system lock (`flock`), which also works on network file systems. It is released when the
//! process ends for any reason, so that another process can take over the chunk. A suspended process (`kill -STOP`)
//! keeps its lock; the locked file contains the name of the process. On file systems without locks, two processes may
//! run the same chunk. This does no harm, since both write the same rows.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::error::StudyError;
use crate::system;

/// Exclusive claim on a chunk, which is released on drop.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    // Dropped last, so that the file is removed before it is unlocked.
    _file: File,
}

/// Process that has claimed a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// Name of the process and its machine, such as "process 4711 on node-3".
    pub who: String,
    /// Time since the process claimed the chunk.
    pub age: Duration,
}

impl Claim {
    /// Claims a chunk by locking the file at `path`; returns `None` while another process or thread holds the
    /// claim.
    pub(super) fn take(path: PathBuf) -> Result<Option<Self>, StudyError> {
        let failed = StudyError::system("claim a chunk by", &path);
        remove_foreign(&path).map_err(failed)?;
        let mut file = system::open_to_change(&path).map_err(failed)?;
        match file.try_lock() {
            // Any other error means that the file system does not support locks.
            Ok(()) | Err(TryLockError::Error(_)) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
        }
        // The content is for information only, so errors such as a full disk are ignored.
        drop(file.set_len(0).and_then(|()| file.write_all(this_process().as_bytes())));
        Ok(Some(Self { path, _file: file }))
    }
}

/// Removes a symbolic link, or a hard link to another file, that has taken the place of a claim file.
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

/// Returns the name of this process and its machine.
fn this_process() -> String {
    let host = ["/proc/sys/kernel/hostname", "/etc/hostname"]
        .iter()
        .find_map(|file| String::from_utf8(system::read_result(Path::new(file), 1000).ok()?).ok());
    let host = host.as_deref().map(str::trim).filter(|host| !host.is_empty());
    let process = format!("process {}", std::process::id());
    host.map_or(process.clone(), |host| format!("{process} on {host}"))
}

/// Returns the process that has claimed a chunk; `None` if the chunk is not claimed, or if this process has
/// claimed it.
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
        // Another process may have opened the file before its removal and may lock it afterwards. That process then
        // looks for the shard again, and finds it.
        drop(fs::remove_file(&self.path));
    }
}
