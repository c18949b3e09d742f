//! Reads records inside gzip, zip and tar files.

use std::io::Read;

use super::source::{Source, shorten};
use super::{ReadOptions, check_bytes, read_any};
use crate::archive::Archive;
use crate::collection::{RecordFiles, group_files};
use crate::error::{Given, ReadError, Refusal};
use crate::instrument::station_xml;
use crate::record::Record;

/// Largest size of an unpacked file (bytes), so that a small archive cannot exhaust the memory.
///
/// The worst case is a text file with one digit per line, which needs sixteen times its size in memory while it is
/// read: 192 MB for a file of this size, and 1 GB for a file of 64 MB. An hour of one component at 100 Hz, written as
/// text, takes about a quarter of this size.
pub(crate) const LARGEST: u64 = 12 << 20;

/// Reads the record in a packed file; `None` if the file is not packed.
pub(super) fn read(
    source: &Source<'_>,
    options: &ReadOptions,
) -> Result<Option<Record>, ReadError> {
    let packed = [&b"PK"[..], &[0x1F, 0x8B]].iter().any(|magic| source.bytes.starts_with(magic));
    // Copy the bytes only if they may be an archive. The full check for tar, with the checksum,
    // follows later.
    let tar = source.bytes.get(257..262) == Some(b"ustar");
    if !packed && !tar {
        return Ok(None);
    }
    if let Some(archive) = Archive::open(source.bytes.to_vec(), source.name)? {
        return from_archive(source, &archive, options).map(Some);
    }
    if !source.bytes.starts_with(&[0x1F, 0x8B]) {
        return Ok(None);
    }
    let inside = flate2::read::MultiGzDecoder::new(source.bytes);
    let name = source.name.strip_suffix(".gz").unwrap_or(source.name);
    let mut record = unpacked(&all(source, inside)?, name, options)?;
    source.name.clone_into(&mut record.file);
    Ok(Some(record))
}

/// Reads an unpacked file. If this file is packed itself, it is refused.
fn unpacked(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Record, ReadError> {
    let inside = Source::new(name, bytes);
    check_bytes(&inside)?;
    let zip = bytes.starts_with(b"PK\x03\x04") && !super::zip::is_numpy(bytes);
    if zip || bytes.starts_with(&[0x1F, 0x8B]) {
        return Err(inside.error(
            (),
            Refusal::Unrecognized,
            "a record, or an archive nested in at most one other archive",
            "a more deeply nested archive",
            "unpack it and give its content",
        ));
    }
    read_any(&inside, options)
}

/// Reads the record in an archive. Files are grouped by their names; files without acceleration are
/// left out and listed with the reason.
fn from_archive(
    source: &Source<'_>,
    archive: &Archive,
    options: &ReadOptions,
) -> Result<Record, ReadError> {
    let names = archive.names()?;
    let groups = group_files(&names);
    let mut found: Vec<(String, Record)> = Vec::new();
    let mut left_out: Vec<(String, ReadError)> = Vec::new();
    let mut metadata = Metadata { names: &names, options: None, damaged: None };
    for group in &groups {
        let mut parts = Vec::new();
        for file in &group.files {
            match metadata.read(source, archive, file, options) {
                Ok(record) => parts.push(record),
                Err(error) => left_out.push((file.clone(), error)),
            }
        }
        if parts.is_empty() {
            continue;
        }
        let record = Record::gather(&parts).map_err(|error| {
            let remedy = "give the paths of the files of one record inside the archive";
            source.damaged((), "files of one record", error.to_string(), remedy)
        })?;
        match found.last_mut() {
            Some((_, last)) if belongs(last, &record) => {
                *last = Record::gather(&[last.clone(), record])
                    .map_err(|e| source.damaged((), "one record", e.to_string(), "unpack it"))?;
            }
            _ => found.push((group.name.clone(), record)),
        }
        // The file names give an upper bound on the number of records; two readable records prove
        // that there are several.
        if found.len() > 1 {
            return Err(several(source, &groups, &found));
        }
    }
    let Some((_, mut record)) = found.pop() else {
        return Err(none(source, &names, left_out));
    };
    // A component that cannot be read would change every measure of both horizontals, so the
    // archive is refused.
    let ending = |file: &str| file.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let alike = |file: &str| record.file.split(", ").any(|read| ending(read) == ending(file));
    let lost =
        |(file, error): &(String, ReadError)| error.refusal == Refusal::Damaged && alike(file);
    if let Some(at) = left_out.iter().position(lost) {
        return Err(left_out.swap_remove(at).1);
    }
    let prefix = format!("{}/", source.name);
    let files: Vec<&str> =
        record.file.split(", ").map(|file| file.strip_prefix(&prefix).unwrap_or(file)).collect();
    if names.len() > 1 {
        let files = files.join(", ");
        record.notes.push(format!("one record of the archive {}: {files}", source.name));
    }
    if !left_out.is_empty() {
        let list: Vec<String> =
            left_out.iter().map(|(file, error)| format!("{file} ({})", error.found)).collect();
        record.notes.push(format!("files of the archive that were ignored: {}", list.join(", ")));
    }
    source.name.clone_into(&mut record.file);
    Ok(record)
}

/// Returns `true` if two records of an archive are components of one record although their names do
/// not match.
fn belongs(one: &Record, other: &Record) -> bool {
    let named = !(one.event.is_empty() && one.station.is_empty());
    let new = |name: &str| one.channels.iter().all(|channel| channel.name != name);
    named
        && other.channels.iter().all(|channel| new(&channel.name))
        && Record::gather(&[one.clone(), other.clone()]).is_ok()
}

/// `StationXML` files in the archive, read only if a file of counts needs them.
struct Metadata<'a> {
    names: &'a [String],
    options: Option<ReadOptions>,
    /// Description of the first damaged `StationXML` file.
    damaged: Option<String>,
}

impl Metadata<'_> {
    fn read(
        &mut self,
        source: &Source<'_>,
        archive: &Archive,
        file: &str,
        options: &ReadOptions,
    ) -> Result<Record, ReadError> {
        let name = format!("{}/{file}", source.name);
        let bytes = archive.file(file)?;
        // A file in an archive may be compressed once more with gzip.
        let read = |options: &ReadOptions| match bytes.strip_prefix(&[0x1F, 0x8B]) {
            Some(_) => {
                let packed = Source::new(&name, &bytes);
                let inside = flate2::read::MultiGzDecoder::new(bytes.as_slice());
                unpacked(&all(&packed, inside)?, &name, options)
            }
            None => unpacked(&bytes, &name, options),
        };
        let first = read(options);
        let counts = [Given::Sensitivity, Given::UnitOrSensitivity].map(Refusal::Missing);
        if !first.as_ref().is_err_and(|error| counts.contains(&error.refusal)) {
            return first;
        }
        let more = self.options.get_or_insert_with(|| {
            let mut more = options.clone();
            let xml = |name: &&String| name.to_ascii_lowercase().ends_with(".xml");
            for name in self.names.iter().filter(xml) {
                let found =
                    archive.file(name).map_err(|error| error.to_string()).and_then(|bytes| {
                        station_xml(&String::from_utf8_lossy(&bytes)).map_err(|e| e.to_string())
                    });
                match found {
                    Ok(found) => more.instruments.extend(found),
                    Err(why) => {
                        self.damaged = self.damaged.take().or(Some(format!("{name} ({why})")));
                    }
                }
            }
            more
        });
        let read =
            if more.instruments.len() == options.instruments.len() { first } else { read(more) };
        match (&self.damaged, read) {
            (Some(why), Err(error)) if counts.contains(&error.refusal) => {
                Err(Source::new(&name, &[]).error(
                    (),
                    error.refusal,
                    error.expected.clone(),
                    format!("{}, and {why} in the archive cannot be used", error.found),
                    error.remedy.clone(),
                ))
            }
            (_, read) => read,
        }
    }
}

/// Returns the error for an archive of several records, with the names of its files.
fn several(source: &Source<'_>, groups: &[RecordFiles], found: &[(String, Record)]) -> ReadError {
    let named: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    let first = groups.iter().find(|group| group.name == named[0]).map(|g| g.files[0].as_str());
    source.error(
        (),
        Refusal::SeveralRecords,
        "an archive of one record",
        format!(
            "several: {}; according to the file names, there are up to {} records",
            named.join(" and "),
            groups.len()
        ),
        format!(
            "give the path of one file inside, such as {}/{}, or use the archive as a folder of records",
            source.name,
            first.unwrap_or_default()
        ),
    )
}

/// Returns the error for an archive without a record: the error of the only file in the archive, or
/// of the first file that lacks information.
fn none(
    source: &Source<'_>,
    names: &[String],
    mut left_out: Vec<(String, ReadError)>,
) -> ReadError {
    if names.iter().any(|name| name == "[Content_Types].xml" || name == "mimetype") {
        return source.error(
            (),
            Refusal::Unrecognized,
            "a record",
            "an Excel, Word or LibreOffice file",
            "save the sheet as CSV, with time and acceleration in columns, and give that file",
        );
    }
    if names.is_empty() {
        return source.error(
            (),
            Refusal::Unrecognized,
            "a record",
            "an archive without files, except hidden ones",
            "give an archive with the acceleration files of a record",
        );
    }
    let missing = |(_, error): &(String, ReadError)| matches!(error.refusal, Refusal::Missing(_));
    let wanting = left_out.iter().position(missing);
    if let Some(at) = wanting.or((left_out.len() == 1).then_some(0)) {
        return left_out.swap_remove(at).1;
    }
    let reason = left_out.first().map_or_else(String::new, |(file, error)| {
        format!("; of {file}: expected {}, found {}", error.expected, error.found)
    });
    source.error(
        (),
        Refusal::Unrecognized,
        "a record",
        format!(
            "{} files, none of them a record ({}){reason}",
            names.len(),
            shorten(&names.join(", "))
        ),
        "give an archive with the acceleration files of a record",
    )
}

fn all(source: &Source<'_>, inside: impl Read) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = inside.take(LARGEST + 1).read_to_end(&mut bytes);
    read.map_err(|error| {
        source.damaged(
            (),
            "a readable packed file",
            error.to_string(),
            "unpack it with another program, or get it again from its source",
        )
    })?;
    if bytes.len() as u64 > LARGEST {
        return Err(source.damaged(
            (),
            format!("at most {} MB when unpacked", LARGEST >> 20),
            "more",
            "unpack it with another program and give the unpacked file",
        ));
    }
    Ok(bytes)
}
