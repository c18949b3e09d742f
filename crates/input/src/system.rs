//! Files as the system gives them: read with a limit, refused in plain words.

use std::io::{self, Read as _};
use std::path::Path;

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
    let file = std::fs::File::open(path).map_err(|error| words(&error))?;
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(|error| words(&error))?;
    if bytes.len() > limit {
        return Err(format!("it has more than {} MB, more than any such file", limit >> 20));
    }
    Ok(bytes)
}
