//! Archives treated as folders: `records.zip/a.AT2` is the file `a.AT2` in the archive.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use anyhow::anyhow;
use barrelstack_motion::Archive;

use super::input;

/// An opened archive, with the names of its files and the path of the archive.
struct Opened {
    path: PathBuf,
    changed: Option<SystemTime>,
    archive: Archive,
    names: Vec<String>,
}

/// The most recently opened archive, kept because its files are read one after another.
static LAST: Mutex<Option<Arc<Opened>>> = Mutex::new(None);

/// Opens a file on the disk as an archive; `None` if the file is not an archive.
fn open(path: &Path) -> anyhow::Result<Option<Arc<Opened>>> {
    if !path.is_file() {
        return Ok(None);
    }
    let changed = path.metadata().and_then(|about| about.modified()).ok();
    let last = || LAST.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(opened) = last().as_ref()
        && opened.path == path
        && opened.changed == changed
    {
        return Ok(Some(Arc::clone(opened)));
    }
    let Some(archive) = Archive::open(input::bytes(path)?, &path.display().to_string())? else {
        return Ok(None);
    };
    let names = archive.names()?;
    let opened = Arc::new(Opened { path: path.to_owned(), changed, archive, names });
    *last() = Some(Arc::clone(&opened));
    Ok(Some(opened))
}

/// Returns `true` if a file on the disk has the name of an archive and can be opened as one.
pub(super) fn is_archive(path: &Path) -> bool {
    Archive::is_named(&path.to_string_lossy()) && open(path).is_ok_and(|opened| opened.is_some())
}

/// Returns the names of the files of an archive on the disk, relative to the archive; `None` if the
/// path is not an archive.
///
/// # Errors
/// If the archive cannot be read.
pub(super) fn names(path: &Path) -> anyhow::Result<Option<Vec<String>>> {
    if !Archive::is_named(&path.to_string_lossy()) {
        return Ok(None);
    }
    Ok(open(path)?.map(|opened| opened.names.clone()))
}

/// Returns the bytes of a file in an archive; `None` if the path does not lead into an archive.
pub(super) fn bytes_inside(path: &Path) -> anyhow::Result<Option<Vec<u8>>> {
    if path.exists() {
        return Ok(None);
    }
    let Some((archive, inner)) = Archive::path_inside(path) else { return Ok(None) };
    let Some(opened) = open(&archive)? else { return Ok(None) };
    let bytes = opened.archive.file(&inner).map_err(|error| anyhow!("{error}"))?;
    Ok(Some(bytes))
}

/// Returns the files of a folder in an archive, excluding the files of subfolders; empty if the
/// folder is not in an archive.
pub(super) fn files_below(folder: &Path) -> Vec<PathBuf> {
    // The root of the archive counts as a folder too.
    let named = folder.join("file");
    let Some((archive, inner)) = Archive::path_inside(&named) else { return Vec::new() };
    let Ok(Some(opened)) = open(&archive) else { return Vec::new() };
    let before = inner.strip_suffix("file").unwrap_or_default();
    let own = opened
        .names
        .iter()
        .filter(|name| name.strip_prefix(before).is_some_and(|rest| !rest.contains('/')));
    own.map(|name| archive.join(name)).collect()
}
