//! Writes zip archives of files in memory (PKWARE, APPNOTE 4.3).

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::DeflateEncoder;

/// A file of an archive.
///
/// The date of all files is 1 January 1980, the first day of the format's calendar, so that equal
/// files give equal bytes.
#[derive(Clone, Debug)]
pub struct Entry {
    name: String,
    method: Method,
    sum: u32,
    /// Number of bytes before compression.
    size: u64,
    bytes: Vec<u8>,
}

#[derive(Clone, Copy, Debug)]
enum Method {
    Stored,
    Deflated,
}

impl Method {
    /// Returns the number of the method in the format, and the version of the format that it requires.
    fn code(self) -> (u16, u16) {
        match self {
            Self::Stored => (0, 10),
            Self::Deflated => (8, 20),
        }
    }
}

impl Entry {
    /// Creates a file that is not compressed.
    pub fn stored(name: String, bytes: Vec<u8>) -> Self {
        let (sum, size) = (crc32fast::hash(&bytes), bytes.len() as u64);
        Self { name, method: Method::Stored, sum, size, bytes }
    }
}

/// A file of an archive that is compressed while it is written.
pub struct Deflated {
    name: String,
    sum: crc32fast::Hasher,
    size: u64,
    packed: DeflateEncoder<Vec<u8>>,
}

impl Deflated {
    /// Creates an empty file.
    pub fn new(name: String) -> Self {
        let packed = DeflateEncoder::new(Vec::new(), Compression::default());
        Self { name, sum: crc32fast::Hasher::new(), size: 0, packed }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If the compression fails.
    pub fn finish(self) -> io::Result<Entry> {
        let Self { name, sum, size, packed } = self;
        let bytes = packed.finish()?;
        Ok(Entry { name, method: Method::Deflated, sum: sum.finalize(), size, bytes })
    }
}

impl Write for Deflated {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.packed.write(bytes)?;
        self.sum.update(&bytes[..written]);
        self.size += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.packed.flush()
    }
}

/// Joins files to an archive.
///
/// # Errors
/// If a name is repeated, or if a file or the archive is too large for the format.
pub fn zip(entries: &[Entry]) -> io::Result<Vec<u8>> {
    let refuse = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (at, entry) in entries.iter().enumerate() {
        let name = &entry.name;
        if entries[..at].iter().any(|earlier| earlier.name == *name) {
            return refuse(format!("two files are named {name}"));
        }
        let (Ok(start), Some(fields)) = (u32::try_from(archive.len()), fields(entry)) else {
            return refuse(format!("{name} ends beyond 4 GB, or its name is longer than 64 kB"));
        };
        archive.extend(b"PK\x03\x04");
        archive.extend(fields);
        archive.extend(name.as_bytes());
        archive.extend(&entry.bytes);
        directory.extend(b"PK\x01\x02");
        directory.extend(entry.method.code().1.to_le_bytes());
        directory.extend(fields);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (Ok(count), Ok(start), Ok(size)) = (
        u16::try_from(entries.len()),
        u32::try_from(archive.len()),
        u32::try_from(directory.len()),
    ) else {
        return refuse(format!("{} files are too many or too large", entries.len()));
    };
    archive.extend(directory);
    archive.extend(b"PK\x05\x06");
    // The archive has a single disk.
    archive.extend([0; 4]);
    archive.extend([count; 2].map(u16::to_le_bytes).concat());
    archive.extend(size.to_le_bytes());
    archive.extend(start.to_le_bytes());
    archive.extend([0; 2]);
    Ok(archive)
}

/// Returns the fields common to the header of a file and its directory entry (APPNOTE 4.3.7 and
/// 4.3.12); `None` if a size is too large for the format.
fn fields(entry: &Entry) -> Option<[u8; 26]> {
    const DATE: u16 = 0x21;
    let (method, version) = entry.method.code();
    let mut fields = [0; 26];
    fields[..2].copy_from_slice(&version.to_le_bytes());
    // No flags, time midnight.
    fields[4..6].copy_from_slice(&method.to_le_bytes());
    fields[8..10].copy_from_slice(&DATE.to_le_bytes());
    fields[10..14].copy_from_slice(&entry.sum.to_le_bytes());
    fields[14..18].copy_from_slice(&u32::try_from(entry.bytes.len()).ok()?.to_le_bytes());
    fields[18..22].copy_from_slice(&u32::try_from(entry.size).ok()?.to_le_bytes());
    fields[22..24].copy_from_slice(&u16::try_from(entry.name.len()).ok()?.to_le_bytes());
    Some(fields)
}
