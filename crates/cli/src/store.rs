//! Atomic writing of files.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use barrelstack_input::system;

/// Writes a file atomically.
pub(crate) fn store(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    crate::interrupt::writes_to(path.parent().unwrap_or(Path::new("")));
    system::store(path, bytes)
        .map_err(plain)
        .with_context(|| format!("cannot write {}", path.display()))
}

/// Writes the files of a folder: either all of them or none.
pub(crate) fn store_all<'a>(
    folder: &Path,
    files: &(impl Iterator<Item = (PathBuf, &'a [u8])> + Clone),
) -> anyhow::Result<()> {
    crate::interrupt::writes_to(folder);
    system::store_all(files)
        .map_err(|(path, error)| plain(error).context(format!("cannot write {}", path.display())))
}

/// Creates a folder if it is missing.
pub(crate) fn folder(path: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(path)
        .map_err(plain)
        .with_context(|| format!("cannot create the folder {}", path.display()))
}

/// Creates a folder within the folder of results; a symbolic link in its place is an error.
pub(crate) fn folder_below(root: &Path, name: &str) -> anyhow::Result<PathBuf> {
    system::folder_below(root, Path::new(name))
        .map_err(plain)
        .with_context(|| format!("cannot create the folder {}", root.join(name).display()))
}

/// Returns an error if a folder is not writable, so that this is known before the computation
/// starts.
pub(crate) fn writable(folder: &Path) -> anyhow::Result<()> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    system::writable(folder).map_err(|reason| {
        anyhow!("cannot write in {}: {reason}; give another folder", folder.display())
    })
}

/// Converts an I/O error to an error whose message helps the user to act on it.
#[expect(clippy::needless_pass_by_value, reason = "used with map_err")]
pub(crate) fn plain(error: std::io::Error) -> anyhow::Error {
    anyhow!(system::words(&error))
}
