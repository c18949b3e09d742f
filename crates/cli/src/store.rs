//! Files that are never half there.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use barrelstack_input::system;

/// Writes a file, so that it is never half there.
pub(crate) fn store(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    crate::interrupt::writes_to(path.parent().unwrap_or(Path::new("")));
    system::store(path, bytes)
        .map_err(plain)
        .with_context(|| format!("cannot write {}", path.display()))
}

/// Makes a folder where it is missing.
pub(crate) fn folder(path: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(path)
        .map_err(plain)
        .with_context(|| format!("cannot make the folder {}", path.display()))
}

/// Makes a folder below one of results; a link in its place is refused.
pub(crate) fn folder_below(root: &Path, name: &str) -> anyhow::Result<PathBuf> {
    system::folder_below(root, Path::new(name))
        .map_err(plain)
        .with_context(|| format!("cannot make the folder {}", root.join(name).display()))
}

/// Refuses a folder in which nothing can be written, before the work is done.
pub(crate) fn writable(folder: &Path) -> anyhow::Result<()> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    system::writable(folder).map_err(|reason| {
        anyhow!("cannot write in {}: {reason}; name another folder", folder.display())
    })
}

/// What the system says, in words.
#[expect(clippy::needless_pass_by_value, reason = "as errors are mapped")]
pub(crate) fn plain(error: std::io::Error) -> anyhow::Error {
    anyhow!(system::words(&error))
}
