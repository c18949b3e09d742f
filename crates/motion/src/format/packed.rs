//! One record inside a gzip or zip file.

use std::io::Read;

use super::source::{Source, shorten};
use super::zip;
use crate::error::{ReadError, Refusal};

/// Most bytes that are unpacked, lest a few packed bytes take all memory: lines of one digit take sixteen
/// times their size while they are read, 192 MB of as many as this; 64 MB of them would take 1 GB.
/// An hour of one component at 100 Hz has a quarter of it as text.
const LARGEST: u64 = 12 << 20;

/// The bytes of the one file inside, and its name; nothing where the file is not packed.
pub(super) fn unpack(source: &Source<'_>) -> Result<Option<(Vec<u8>, String)>, ReadError> {
    if source.bytes.starts_with(&[0x1F, 0x8B]) {
        let inside = flate2::read::MultiGzDecoder::new(source.bytes);
        let name = source.name.strip_suffix(".gz").unwrap_or(source.name);
        return Ok(Some((all(source, inside)?, name.to_owned())));
    }
    if !source.bytes.starts_with(b"PK\x03\x04") || super::npz::is_numpy(source) {
        return Ok(None);
    }
    let entries = zip::entries(source.bytes).map_err(|found| damaged(source, &found))?;
    // Folders, and what one system adds about its own files, are no records.
    let files: Vec<zip::Entry<'_>> = entries
        .into_iter()
        .filter(|entry| !entry.name.ends_with('/') && !entry.name.starts_with("__MACOSX"))
        .collect();
    let [file] = files.as_slice() else {
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        return Err(source.error(
            (),
            Refusal::Unrecognized,
            "an archive of one file",
            format!("{} files ({})", files.len(), shorten(&names.join(", "))),
            "unpack it and give the files of one record",
        ));
    };
    let bytes = file.unpack(LARGEST).map_err(|found| damaged(source, &found))?;
    Ok(Some((bytes, format!("{}/{}", source.name, file.name))))
}

fn damaged(source: &Source<'_>, found: &str) -> ReadError {
    source.damaged(
        (),
        "a file that can be unpacked",
        found,
        "unpack it by itself, or get it again from its source",
    )
}

fn all(source: &Source<'_>, inside: impl Read) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = inside.take(LARGEST + 1).read_to_end(&mut bytes);
    read.map_err(|error| damaged(source, &error.to_string()))?;
    if bytes.len() as u64 > LARGEST {
        return Err(source.damaged(
            (),
            format!("at most {} MB when unpacked", LARGEST >> 20),
            "more",
            "unpack it by itself and give that file",
        ));
    }
    Ok(bytes)
}
