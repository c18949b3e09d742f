//! One record inside a gzip or zip file.

use std::borrow::Cow;
use std::io::{Cursor, Read};

use super::source::{Source, shorten};
use crate::error::{ReadError, Refusal};

/// Most bytes that are unpacked; the longest strong-motion files have a fifth of it.
const LARGEST: u64 = 128 << 20;

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
    let mut archive = zip::ZipArchive::new(Cursor::new(source.bytes))
        .map_err(|error| damaged(source, &error.to_string()))?;
    // Folders, and what one system adds about its own files, are no records.
    let files: Vec<String> = archive
        .file_names()
        .map(|name| name.map_or_else(|_| "without a legible name".to_owned(), Cow::into_owned))
        .filter(|name| !name.ends_with('/') && !name.starts_with("__MACOSX"))
        .collect();
    let [name] = files.as_slice() else {
        return Err(source.error(
            (),
            Refusal::Unrecognized,
            "an archive of one file",
            format!("{} files ({})", files.len(), shorten(&files.join(", "))),
            "unpack it and give the files of one record",
        ));
    };
    let inside = archive.by_name(name).map_err(|error| damaged(source, &error.to_string()))?;
    let bytes = all(source, inside)?;
    Ok(Some((bytes, format!("{}/{name}", source.name))))
}

fn damaged(source: &Source<'_>, found: &str) -> ReadError {
    source.error(
        (),
        Refusal::Damaged,
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
        return Err(source.error(
            (),
            Refusal::Damaged,
            "at most 128 MB when unpacked",
            "more",
            "no strong-motion file is that long; cut it to one record",
        ));
    }
    Ok(bytes)
}
