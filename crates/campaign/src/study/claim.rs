//! Claims: a process works on a chunk as long as it holds a file of the folder locked.
//!
//! The lock is one of the operating system (`flock`, on network file systems too), so it ends with its process
//! however that ends, and the next one takes the chunk over.
//! A process that was stopped (`kill -STOP`) holds it, too: the file says which one that is.
//! Where a file system has no locks, nobody is kept out: a chunk may be run twice, and either shard will do.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::error::StudyError;
use crate::system;

/// A chunk that no other process works on while this lives.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    // Closed, and so unlocked, behind the removal of its name.
    _file: File,
}

/// Who holds a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// The process and its machine, as people say it: "process 4711 on node-3".
    pub who: String,
    /// How long it has held the chunk.
    pub age: Duration,
}

impl Claim {
    /// Takes it; none while another process or thread has it.
    pub(super) fn take(path: PathBuf) -> Result<Option<Self>, StudyError> {
        let failed = StudyError::system("claim a chunk by", &path);
        remove_foreign(&path).map_err(failed)?;
        let mut file = system::open_to_change(&path).map_err(failed)?;
        match file.try_lock() {
            // Any other refusal says that there are no locks here, each file system in its own words.
            Ok(()) | Err(TryLockError::Error(_)) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
        }
        // Only for people: a full disk keeps nobody from working.
        drop(file.set_len(0).and_then(|()| file.write_all(this_process().as_bytes())));
        Ok(Some(Self { path, _file: file }))
    }
}

/// Removes what stands in the place of a claim and is none: a link, or a second name of some other file.
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

/// This process and its machine, as people say it.
fn this_process() -> String {
    let host = ["/proc/sys/kernel/hostname", "/etc/hostname"]
        .iter()
        .find_map(|file| String::from_utf8(system::read(Path::new(file), 1000).ok()?).ok());
    let host = host.as_deref().map(str::trim).filter(|host| !host.is_empty());
    let process = format!("process {}", std::process::id());
    host.map_or(process.clone(), |host| format!("{process} on {host}"))
}

/// Who holds a chunk of a folder, as its claim says; none where there is no claim or this process has it.
pub fn holder(folder: &Path, chunk: usize) -> Option<Holder> {
    let path = folder.join("shards").join(format!("{chunk:06}.claim"));
    let text = String::from_utf8(system::read(&path, 1000).ok()?).ok()?;
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
        // Whoever opened the file before and locks it after looks for the shard once more, and finds it.
        drop(fs::remove_file(&self.path));
    }
}
