//! Files as the system gives them: read with a limit, refused in plain words.

use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
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

/// Opens a file for reading, or a link to one.
///
/// A named pipe is refused, because one that nobody writes to would block for ever, and so is a device, which may have no
/// end. Pipes that the shell opened (`/dev/stdin`, `/dev/fd/63`) have a writer and are read.
///
/// # Errors
/// In words, when the file cannot be opened, or is a named pipe, a device or a socket.
pub fn open(path: &Path) -> Result<File, String> {
    let of_the_shell =
        ["/dev/stdin", "/dev/fd", "/proc"].iter().any(|place| path.starts_with(place));
    let found = fs::metadata(path).map_err(|error| words(&error))?;
    if !of_the_shell && !found.is_dir() {
        regular(&found).map_err(|error| words(&error))?;
    }
    File::open(path).map_err(|error| words(&error))
}

/// Refuses what is no regular file, in words.
fn regular(of: &fs::Metadata) -> io::Result<()> {
    if of.is_file() {
        return Ok(());
    }
    if of.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Err(io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("it is {}, not a file; write what it carries into a file and name that", kind(of)),
    ))
}

/// What is neither a file nor a folder.
#[cfg(unix)]
fn kind(of: &fs::Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    let kind = of.file_type();
    if kind.is_symlink() {
        "a link"
    } else if kind.is_fifo() {
        "a named pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn kind(of: &fs::Metadata) -> &'static str {
    if of.file_type().is_symlink() { "a link" } else { "a device" }
}

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// In words, when the file cannot be opened ([`open`]) or read, or is larger.
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let file = open(path)?;
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(|error| words(&error))?;
    if bytes.len() > limit {
        return Err(format!("it has more than {} MB, more than any such file", limit >> 20));
    }
    Ok(bytes)
}

/// Makes a folder and folders below it, and refuses a link in the place of one of those below: a folder of results that
/// somebody else made must not lead what is written into it to another place.
///
/// The folder itself may be a link, which whoever named it chose.
///
/// # Errors
/// When the system refuses, and for a link.
pub fn folder_below(root: &Path, below: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(root)?;
    let mut folder = root.to_owned();
    for part in below.components() {
        folder.push(part);
        match fs::create_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                let found = fs::symlink_metadata(&folder)?;
                if !found.is_dir() {
                    let what = if found.is_file() { "a file" } else { kind(&found) };
                    return Err(io::Error::other(format!(
                        "{} is {what}, not a folder: remove it, or name another folder",
                        folder.display()
                    )));
                }
            }
            made => made?,
        }
    }
    Ok(folder)
}

/// Begins a file that is written anew: what has its name, be it a link, is removed first and never written to.
///
/// # Errors
/// When the system refuses.
pub fn begin(path: &Path) -> io::Result<File> {
    let create = || File::options().read(true).write(true).create_new(true).open(path);
    match create() {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            fs::remove_file(path)?;
            create()
        }
        made => made,
    }
}

/// Opens a file of a folder of results to be changed, or makes it; refuses a link, behind which a file of somebody else
/// may lie.
///
/// # Errors
/// When the system refuses, and for what is no regular file.
pub fn open_to_change(path: &Path) -> io::Result<File> {
    // Another process may remove or make it in between.
    for _ in 0..100 {
        match File::options().read(true).write(true).create_new(true).open(path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            made => return made,
        }
        match fs::symlink_metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            found => {
                regular(&found?)?;
                match File::options().read(true).write(true).open(path) {
                    Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                    opened => return opened,
                }
            }
        }
    }
    Err(io::Error::other("it is made and removed all the time"))
}

/// The name under which a file is written until it is whole: of this process alone.
pub fn temporary(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(unfinished());
    path.with_file_name(name)
}

/// Whether a file is one that a process was writing when it was killed, by its name: that of the file as a whole, which
/// has to be one of those that are meant, and what [`temporary`] puts behind it.
pub fn is_unfinished(path: &Path, meant: impl Fn(&str) -> bool) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some((whole, process)) = name.strip_suffix(".part").and_then(|rest| rest.rsplit_once('.'))
    else {
        return false;
    };
    !process.is_empty() && process.bytes().all(|c| c.is_ascii_digit()) && meant(whole)
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
    let written = begin(&part)
        .and_then(|mut file| file.write_all(bytes))
        .and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        // It may never have been made, and that is well.
        let _ = fs::remove_file(&part);
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
    let tried = fs::create_dir_all(&folder)
        .and_then(|()| begin(&probe).map(drop))
        .and_then(|()| fs::remove_file(&probe));
    for made in missing {
        // What could not be made need not be removed, and what is not empty is somebody else's.
        let _ = fs::remove_dir(made);
    }
    tried.map_err(|error| words(&error))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;
    use std::process::Command;

    use super::*;

    /// A folder of its own below that of the system, gone with the value.
    struct Place(PathBuf);

    impl Place {
        fn new(name: &str) -> io::Result<Self> {
            let path =
                std::env::temp_dir().join(format!("barrelstack-{name}-{}", std::process::id()));
            fs::create_dir_all(&path)?;
            Ok(Self(path))
        }
    }

    impl Drop for Place {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn pipes_and_devices_are_refused_at_once() -> io::Result<()> {
        let place = Place::new("pipes")?;
        let pipe = place.0.join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status()?.success());
        let said = |path: &Path| read(path, 100).unwrap_err();
        assert_eq!(
            said(&pipe),
            "it is a named pipe, not a file; write what it carries into a file and name that"
        );
        assert!(said(Path::new("/dev/zero")).starts_with("it is a device, not a file"));
        assert_eq!(said(&place.0), "it is a folder, not a file");
        assert!(open_to_change(&pipe).is_err());
        fs::write(place.0.join("file"), "text")?;
        symlink(place.0.join("file"), place.0.join("link"))?;
        assert_eq!(read(&place.0.join("link"), 100).as_deref(), Ok(&b"text"[..]));
        Ok(())
    }

    #[test]
    fn nothing_is_written_behind_a_link() -> io::Result<()> {
        let place = Place::new("links")?;
        let (target, outside) = (place.0.join("target"), place.0.join("outside"));
        fs::write(&target, "kept")?;
        fs::create_dir(&outside)?;
        let out = place.0.join("out");
        fs::create_dir(&out)?;
        for name in ["a", "b", "c"] {
            symlink(&target, out.join(name))?;
        }
        symlink(&target, temporary(&out.join("a")))?;
        symlink(&outside, out.join("figures"))?;
        store(&out.join("a"), b"new")?;
        begin(&out.join("b"))?.write_all(b"new")?;
        assert!(open_to_change(&out.join("c")).is_err());
        let said = folder_below(&out, Path::new("figures/more")).unwrap_err().to_string();
        assert!(said.contains("figures is a link, not a folder"), "{said}");
        assert_eq!(fs::read_to_string(&target)?, "kept");
        assert_eq!(fs::read_dir(&outside)?.count(), 0);
        assert_eq!(fs::read_to_string(out.join("a"))?, "new");
        // Whoever names the folder itself may name a link.
        symlink(&outside, place.0.join("chosen"))?;
        folder_below(&place.0.join("chosen"), Path::new("shards"))?;
        assert!(outside.join("shards").is_dir());
        Ok(())
    }
}
