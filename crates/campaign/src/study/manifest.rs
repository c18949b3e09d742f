//! Manifest of a folder: the provenance of its shards, with a fingerprint that reveals damage.
//!
//! The last field of `study.json` is the fingerprint (FNV-1a, 64 bits) of the whole file, computed with zeros
//! in place of the fingerprint. The fingerprint reveals damage, but it does not protect against tampering.

use std::path::Path;

use super::draft::write_whole;
use super::error::StudyError;
use super::folder::{LAYOUT, MANIFEST, Provenance, read_file};
use crate::scenario::fnv1a;

/// Text that immediately precedes the fingerprint in the manifest.
const BEFORE: &str = ",\n  \"fingerprint\": \"";

/// Text that follows the fingerprint, up to the end of the manifest.
const BEHIND: &str = "\"\n}\n";

/// Number of digits of a fingerprint.
const DIGITS: usize = 16;

/// A manifest that has been read.
pub(super) enum Manifest {
    /// The manifest has not changed since it was written.
    Sound(Box<Provenance>),
    /// The manifest has changed since it was written. The string is a clause that describes the damage, such as "it
    /// does not end with its fingerprint".
    Damaged(String),
}

/// Returns the bytes of a manifest with zeros in place of the fingerprint, and the fingerprint itself; `None`
/// if there is no fingerprint.
fn parted(bytes: &[u8]) -> Option<(Vec<u8>, &[u8])> {
    let rest = bytes.strip_suffix(BEHIND.as_bytes())?;
    let (head, stated) = rest.split_at_checked(rest.len().checked_sub(DIGITS)?)?;
    head.ends_with(BEFORE.as_bytes()).then_some(())?;
    Some(([head, &[b'0'; DIGITS], BEHIND.as_bytes()].concat(), stated))
}

/// Writes the manifest of a folder.
pub(super) fn write(folder: &Path, made: &Provenance) -> Result<(), StudyError> {
    let text =
        serde_json::to_string_pretty(made).map_err(|error| StudyError::Table(error.to_string()))?;
    let body = text.trim_end().strip_suffix("\n}").unwrap_or(&text);
    let sealed = |digits: &str| format!("{body}{BEFORE}{digits}{BEHIND}");
    let found = fnv1a(sealed(&"0".repeat(DIGITS)).as_bytes());
    write_whole(&folder.join(MANIFEST), sealed(&format!("{found:016x}")).as_bytes())
}

/// Reads the manifest of a folder and checks its fingerprint.
///
/// # Errors
/// If the manifest is missing, cannot be read, or was written by an incompatible version.
pub(super) fn read(folder: &Path) -> Result<Manifest, StudyError> {
    let refuse = |reason: String| StudyError::Folder { folder: folder.to_owned(), reason };
    let path = folder.join(MANIFEST);
    if !path.is_file() {
        let there = |path: &Path| path.symlink_metadata().is_ok();
        let what = match (folder.is_dir(), there(&path), there(folder)) {
            (true, true, _) => format!("is not a study folder: its {MANIFEST} is not a file"),
            (true, false, _) => format!("is not a study folder: it has no {MANIFEST}"),
            (false, _, true) => "is not a folder".to_owned(),
            (false, _, false) => "does not exist".to_owned(),
        };
        return Err(refuse(format!("{what}; name the folder of a study")));
    }
    let bytes = read_file(&path)?;
    let known = serde_json::from_slice::<serde_json::Value>(&bytes).ok();
    let sealed =
        parted(&bytes).map(|(zeroed, stated)| (format!("{:016x}", fnv1a(&zeroed)), stated));
    let Some((found, stated)) = sealed else {
        // Manifests of earlier layouts have no fingerprint.
        let text = |key: &str| known.as_ref().map_or(String::new(), |known| known[key].to_string());
        if known
            .as_ref()
            .and_then(|known| known["schema"].as_u64())
            .is_some_and(|n| n < LAYOUT.into())
        {
            return Err(refuse(format!(
                "was written by version {} in layout {} of study folders, but this version reads layout {LAYOUT}; use \
                 the version that wrote it, or name another folder",
                text("version").trim_matches('"'),
                text("schema")
            )));
        }
        return Ok(Manifest::Damaged("it does not end with its fingerprint".to_owned()));
    };
    if found.as_bytes() != stated {
        return Ok(Manifest::Damaged(format!(
            "its {} bytes have the fingerprint {found}, not {}",
            bytes.len(),
            String::from_utf8_lossy(stated)
        )));
    }
    let known: Provenance = serde_json::from_slice(&bytes).map_err(|error| {
        refuse(format!(
            "holds a {MANIFEST} that is not the manifest of a study: {error}; name another folder"
        ))
    })?;
    if known.schema != LAYOUT {
        return Err(refuse(format!(
            "was written by version {} in layout {} of study folders, but this version reads layout {LAYOUT}; use the \
             version that wrote it, or name another folder",
            known.version, known.schema
        )));
    }
    Ok(Manifest::Sound(Box::new(known)))
}

/// Returns the provenance that the manifest of a folder states.
pub(crate) fn manifest_of(folder: &Path) -> Result<Provenance, StudyError> {
    match read(folder)? {
        Manifest::Sound(known) => Ok(*known),
        Manifest::Damaged(how) => Err(damaged(folder, &how)),
    }
}

/// Returns the error for a damaged manifest; `how` is a clause that describes the damage.
pub(super) fn damaged(folder: &Path, how: &str) -> StudyError {
    let reason = format!(
        "holds a damaged {MANIFEST}: {how}; run the study again into this folder, with the file study.toml there, which \
         rewrites {MANIFEST} and keeps every intact chunk"
    );
    StudyError::Folder { folder: folder.to_owned(), reason }
}
