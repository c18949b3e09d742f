//! Files that are never half there.

use std::path::Path;

use anyhow::{Context as _, anyhow};

/// Writes under a name of this process alone and renames, so that the file is never half there.
pub(crate) fn store(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    if written.is_err() {
        // It may never have been made, and that is well.
        let _ = std::fs::remove_file(&part);
    }
    written.map_err(plain).with_context(|| format!("cannot write {}", path.display()))
}

/// What the system says, in words.
pub(crate) fn plain(error: std::io::Error) -> anyhow::Error {
    let kind = error.kind();
    if kind == std::io::ErrorKind::NotFound {
        anyhow!("there is no such file")
    } else if kind == std::io::ErrorKind::PermissionDenied {
        anyhow!("permission is denied")
    } else {
        error.into()
    }
}
