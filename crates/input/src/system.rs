//! Files as the system gives them: read with a limit, refused in plain words.

use std::io::{self, Read as _};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

/// What the system says of a file, in words that a person can act on.
pub fn words(error: &io::Error) -> String {
    let known = [
        (io::ErrorKind::NotFound, "there is no such file"),
        (io::ErrorKind::IsADirectory, "it is a folder, not a file"),
        (io::ErrorKind::NotADirectory, "a part of its path is a file, not a folder"),
        (io::ErrorKind::PermissionDenied, "permission is denied"),
        (io::ErrorKind::StorageFull, "no space is left"),
    ];
    if let Some((_, words)) = known.into_iter().find(|(kind, _)| *kind == error.kind()) {
        return words.to_owned();
    }
    let text = error.to_string();
    // The number of the error says nothing that its words do not say.
    text.split(" (os error").next().unwrap_or(&text).to_lowercase()
}

/// Reads a file of at most `limit` bytes, so that a device without end is refused and not read.
///
/// # Errors
/// In words, when the file cannot be read or is larger.
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let file = open(path)?;
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(|error| words(&error))?;
    if bytes.len() > limit {
        return Err(format!("it has more than {} MB, more than any such file", limit >> 20));
    }
    Ok(bytes)
}

/// Opens a file for reading; a named pipe is refused, because one that nobody writes to would block for ever.
///
/// Pipes that the shell opened (`/dev/stdin`, `/dev/fd/63`) have a writer and are read.
///
/// # Errors
/// In words, when the file cannot be opened or is a named pipe.
pub fn open(path: &Path) -> Result<std::fs::File, String> {
    if is_named_pipe(path) {
        return Err(
            "it is a named pipe, not a file; write what it carries into a file and name that"
                .to_owned(),
        );
    }
    std::fs::File::open(path).map_err(|error| words(&error))
}

#[cfg(unix)]
fn is_named_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt as _;
    let of_the_shell = path.starts_with("/dev") || path.starts_with("/proc");
    !of_the_shell && std::fs::metadata(path).is_ok_and(|file| file.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_named_pipe(_: &Path) -> bool {
    false
}

/// The name under which a file is written until it is whole: of this process alone.
pub fn temporary(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(unfinished());
    path.with_file_name(name)
}

/// What the names of files end with that this process has not finished.
pub fn unfinished() -> String {
    format!(".{}.part", std::process::id())
}

/// Held while a file is not yet under its own name.
static WRITING: Mutex<()> = Mutex::new(());

/// A lock that whoever ends the process never gives back, so that nobody begins what it guards; none after a fifth of a
/// second, for a disk that hangs.
pub fn taken<T>(lock: &'static Mutex<T>) -> ManuallyDrop<Option<MutexGuard<'static, T>>> {
    for _ in 0..20 {
        match lock.try_lock() {
            Ok(guard) => return ManuallyDrop::new(Some(guard)),
            Err(TryLockError::Poisoned(guard)) => {
                return ManuallyDrop::new(Some(guard.into_inner()));
            }
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
        }
    }
    ManuallyDrop::new(None)
}

/// Waits for the file that is being written, and lets nobody begin another one: the process ends.
pub fn write_no_more() {
    taken(&WRITING);
}

/// Writes under a name of this process alone and renames, so that the file is never half there.
///
/// # Errors
/// When the system refuses.
pub fn store(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let part = temporary(path);
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    if written.is_err() {
        // It may never have been made, and that is well.
        let _ = std::fs::remove_file(&part);
    }
    written
}

/// Whether files can be made in a folder that may have to be made itself; tried, and nothing left.
///
/// # Errors
/// In words, when the system refuses.
pub fn writable(folder: &Path) -> Result<(), String> {
    let folder = std::path::absolute(folder).map_err(|error| words(&error))?;
    let missing: Vec<&Path> = folder.ancestors().take_while(|folder| !folder.exists()).collect();
    let probe = temporary(&folder.join("barrelstack"));
    let tried = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(&probe, []))
        .and_then(|()| std::fs::remove_file(&probe));
    for made in missing {
        // What could not be made need not be removed, and what is not empty is somebody else's.
        let _ = std::fs::remove_dir(made);
    }
    tried.map_err(|error| words(&error))
}
