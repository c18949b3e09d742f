//! File system access: reading up to a size limit, atomic writing, and I/O errors in plain words.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, SystemTime};

/// Describes an I/O error so that the user can act on it.
pub fn words(error: &io::Error) -> String {
    let known = [
        (io::ErrorKind::NotFound, "there is no such file"),
        (io::ErrorKind::IsADirectory, "it is a folder, not a file"),
        (io::ErrorKind::NotADirectory, "a part of its path is a file, not a folder"),
        (io::ErrorKind::PermissionDenied, "permission is denied"),
        (
            io::ErrorKind::StorageFull,
            "the disk is full and the incomplete file was removed; free some space",
        ),
        (
            io::ErrorKind::FileTooLarge,
            "the file exceeds the size limit and was removed; raise the limit (ulimit -f)",
        ),
        (
            io::ErrorKind::QuotaExceeded,
            "the disk quota is used up and the incomplete file was removed; free some space",
        ),
    ];
    if let Some((_, words)) = known.into_iter().find(|(kind, _)| *kind == error.kind()) {
        return words.to_owned();
    }
    let text = error.to_string();
    // The error number adds nothing for the user.
    text.split(" (os error").next().unwrap_or(&text).to_lowercase()
}

/// Returns the current time (s since the start of 1970, UTC). If the environment variable `SOURCE_DATE_EPOCH` is set,
/// returns its value instead, so that files can be reproduced bit for bit.
///
/// # Errors
/// A message if the variable is not a whole number.
#[expect(clippy::disallowed_methods, reason = "pages state their date, which enters no result")]
pub fn clock() -> Result<u64, String> {
    let Some(given) = std::env::var_os("SOURCE_DATE_EPOCH").filter(|given| !given.is_empty())
    else {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        return Ok(now.map_or(0, |since| since.as_secs()));
    };
    let given = given.to_string_lossy();
    given.parse().map_err(|_| {
        format!(
            "SOURCE_DATE_EPOCH: expected whole seconds since 1970, found \"{given}\"; correct or unset this variable"
        )
    })
}

/// Opens an input file for reading.
///
/// If inputs are guarded ([`guard_inputs`]), [`store`] refuses to replace the file afterwards. Symbolic links are
/// followed. Named pipes are refused, because opening a pipe without a writer blocks forever. Devices are refused,
/// because they may be endless. Pipes opened by the shell (`/dev/stdin`, `/dev/fd/63`) have a writer and are read.
///
/// # Errors
/// A message if the file cannot be opened, or is a named pipe, a device or a socket.
pub fn open(path: &Path) -> Result<File, String> {
    let file = open_file(path)?;
    if let Some(inputs) = &mut *inputs()
        && let Ok(path) = fs::canonicalize(path)
    {
        inputs.insert(path);
    }
    Ok(file)
}

/// Opens a regular file, or a pipe opened by the shell.
fn open_file(path: &Path) -> Result<File, String> {
    let of_the_shell =
        ["/dev/stdin", "/dev/fd", "/proc"].iter().any(|place| path.starts_with(place));
    let found = fs::metadata(path).map_err(|error| words(&error))?;
    if !of_the_shell && !found.is_dir() {
        regular(&found).map_err(|error| words(&error))?;
    }
    File::open(path).map_err(|error| words(&error))
}

/// Canonical paths of the files opened as inputs; `None` while inputs are not guarded.
static INPUTS: Mutex<Option<BTreeSet<PathBuf>>> = Mutex::new(None);

fn inputs() -> MutexGuard<'static, Option<BTreeSet<PathBuf>>> {
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts guarding inputs, so that a command never replaces a file that it has read.
pub fn guard_inputs() {
    inputs().get_or_insert_default();
}

/// Returns an error if inputs are guarded and the path leads to an input, regardless of how the
/// path is written.
///
/// # Errors
/// If the file was opened as an input.
pub fn replaceable(path: &Path) -> io::Result<()> {
    let is_input = |inputs: &BTreeSet<PathBuf>| {
        fs::canonicalize(path).is_ok_and(|path| inputs.contains(&path))
    };
    if inputs().as_ref().is_some_and(is_input) {
        return Err(io::Error::other(
            "it is an input of this command and is never overwritten; name another file or folder",
        ));
    }
    Ok(())
}

/// Returns an error unless the metadata describe a regular file.
fn regular(of: &fs::Metadata) -> io::Result<()> {
    if of.is_file() {
        return Ok(());
    }
    if of.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Err(io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("it is {}, not a file; write its content to a file and name that file", kind(of)),
    ))
}

/// Returns the kind of a link or special file in words, such as `a named pipe`, for error messages.
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

/// Reads an input file of at most `limit` bytes.
///
/// # Errors
/// A message if the file cannot be opened ([`open`]) or read, or is larger than `limit`.
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>, String> {
    all_of(open(path)?, limit)
}

/// Reads a file of a results folder; unlike an input, the file may be replaced afterwards.
///
/// # Errors
/// The same as for [`read`].
pub fn read_result(path: &Path, limit: usize) -> Result<Vec<u8>, String> {
    all_of(open_file(path)?, limit)
}

/// Reads a file to its end, up to `limit` bytes.
fn all_of(file: File, limit: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(|error| words(&error))?;
    if bytes.len() > limit {
        return Err(format!("it is larger than {} MB; no valid file is that large", limit >> 20));
    }
    Ok(bytes)
}

/// Creates a folder and, inside it, the folders of the path `below`. Returns the path of the
/// innermost folder.
///
/// A link in place of a folder below the root is refused, because a results folder made by someone
/// else must not redirect output to another place. The root itself was chosen by the user and may
/// be a link. The check does not protect against a process that replaces a folder by a link
/// afterwards; such a process could change every result in the root anyway.
///
/// # Errors
/// If the operating system reports an error, or if a folder below the root is a link.
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

/// Creates a new file. An existing file or link of the same name is removed first, so that the content of the existing
/// file, or of the file to which the link leads, is never overwritten.
///
/// # Errors
/// If the operating system reports an error.
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

/// Opens a file of a results folder for modification, or creates it. Links are refused, because
/// they may lead to files outside the folder.
///
/// # Errors
/// If the operating system reports an error, or if the path is anything but a regular file.
pub fn open_to_change(path: &Path) -> io::Result<File> {
    // Another process may create or remove the file between the two attempts.
    for _ in 0..100 {
        match File::options().read(true).write(true).create_new(true).open(path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            made => return made,
        }
        match fs::symlink_metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            found => {
                regular(&found?)?;
                match open_unfollowed(path) {
                    Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                    opened => return opened,
                }
            }
        }
    }
    Err(io::Error::other("another process keeps creating and removing it"))
}

/// Opens an existing regular file for modification.
///
/// The file may have been replaced since it was checked. On Unix, it is therefore opened with
/// `O_NOFOLLOW`, which refuses symbolic links, and with `O_NONBLOCK`, which does not wait for the
/// other end of a named pipe.
fn open_unfollowed(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(
        &mut options,
        libc::O_NOFOLLOW | libc::O_NONBLOCK,
    );
    let file = options.read(true).write(true).open(path)?;
    regular(&file.metadata()?)?;
    Ok(file)
}

/// Returns the temporary name under which this process writes a file.
pub fn temporary(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(unfinished());
    path.with_file_name(name)
}

/// Returns `true` if the path names an incomplete file left by a killed process. The name of such a file consists of a
/// file name, which `meant` must accept, and the suffix that [`temporary`] appends.
pub fn is_unfinished(path: &Path, meant: impl Fn(&str) -> bool) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some((whole, process)) = name.strip_suffix(".part").and_then(|rest| rest.rsplit_once('.'))
    else {
        return false;
    };
    !process.is_empty() && process.bytes().all(|c| c.is_ascii_digit()) && meant(whole)
}

/// Returns the suffix that this process gives to the names of incomplete files.
pub fn unfinished() -> String {
    format!(".{}.part", std::process::id())
}

/// Lock that is held while files are being written.
static WRITING: Mutex<()> = Mutex::new(());

/// Acquires a lock and never releases it, so that no operation guarded by the lock starts while the
/// process ends.
///
/// Returns `None` if the lock is not free within 0.2 s, for example because a disk hangs.
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

/// Waits until the current file is written, and then blocks all further writing. Called before the
/// process ends.
pub fn write_no_more() {
    taken(&WRITING);
}

/// Writes a file under a temporary name and renames it, so that the file is never incomplete.
///
/// # Errors
/// If the operating system reports an error, or if the path is a guarded input ([`guard_inputs`]). No incomplete file
/// is left.
pub fn store(path: &Path, bytes: &[u8]) -> io::Result<()> {
    store_all(&std::iter::once((path.to_owned(), bytes))).map_err(|(_, error)| error)
}

/// Writes several files under temporary names, and renames them only when all are written. If the disk becomes full,
/// the earlier versions of all files are therefore kept.
///
/// # Errors
/// The same as for [`store`]. The error also contains the path that failed.
pub fn store_all<'a>(
    files: &(impl Iterator<Item = (PathBuf, &'a [u8])> + Clone),
) -> Result<(), (PathBuf, io::Error)> {
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let each = |act: &dyn Fn(&Path, &[u8]) -> io::Result<()>| {
        files.clone().try_for_each(|(path, bytes)| act(&path, bytes).map_err(|error| (path, error)))
    };
    each(&|path, _| replaceable(path))?;
    let written = each(&|path, bytes| begin(&temporary(path))?.write_all(bytes))
        .and_then(|()| each(&|path, _| fs::rename(temporary(path), path)));
    if written.is_err() {
        for (path, _) in files.clone() {
            // Ignore the error: a file that was never created cannot be removed.
            let _ = fs::remove_file(temporary(&path));
        }
    }
    written
}

/// Checks that files can be created in a folder, which need not exist yet. Nothing is left behind.
///
/// # Errors
/// A message if the operating system reports an error.
pub fn writable(folder: &Path) -> Result<(), String> {
    let folder = std::path::absolute(folder).map_err(|error| words(&error))?;
    let missing: Vec<&Path> = folder.ancestors().take_while(|folder| !folder.exists()).collect();
    let probe = temporary(&folder.join("barrelstack"));
    let tried = fs::create_dir_all(&folder)
        .and_then(|()| begin(&probe).map(drop))
        .and_then(|()| fs::remove_file(&probe));
    for made in missing {
        // Ignore the error: the folder may not exist, or another process may have written files into it.
        let _ = fs::remove_dir(made);
    }
    tried.map_err(|error| words(&error))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;
    use std::process::Command;

    use super::*;

    /// A temporary folder, removed on drop.
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
            "it is a named pipe, not a file; write its content to a file and name that file"
        );
        assert!(said(Path::new("/dev/zero")).starts_with("it is a device, not a file"));
        assert_eq!(said(&place.0), "it is a folder, not a file");
        assert!(open_to_change(&pipe).is_err());
        assert!(open_unfollowed(&pipe).is_err());
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
        // This represents a link that is created after the check.
        assert!(open_unfollowed(&out.join("c")).is_err());
        let said = folder_below(&out, Path::new("figures/more")).unwrap_err().to_string();
        assert!(said.contains("figures is a link, not a folder"), "{said}");
        assert_eq!(fs::read_to_string(&target)?, "kept");
        assert_eq!(fs::read_dir(&outside)?.count(), 0);
        assert_eq!(fs::read_to_string(out.join("a"))?, "new");
        // The root itself may be a link.
        symlink(&outside, place.0.join("chosen"))?;
        folder_below(&place.0.join("chosen"), Path::new("shards"))?;
        assert!(outside.join("shards").is_dir());
        Ok(())
    }
}
