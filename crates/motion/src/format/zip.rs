//! Access to the files inside a zip archive; files may be stored or deflated.
//!
//! Spec: PKWARE, APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16; encryption, multi-part archives
//! and zip64 are not supported.

use std::io::Read as _;

/// Largest number of files in an archive.
const MOST: usize = 50_000;

/// A file in an archive.
pub(crate) struct ZipEntry<'a> {
    pub(crate) name: String,
    /// Packed bytes of the file.
    packed: &'a [u8],
    method: u16,
    sum: u32,
}

/// Returns all files of an archive in the order of its directory, or a description of the damage.
pub(crate) fn entries(bytes: &[u8]) -> Result<Vec<ZipEntry<'_>>, String> {
    let cut = || "an archive that ends before its directory".to_owned();
    // The end of the directory has 22 bytes and a comment of at most 64 kB.
    let reach = bytes.len().saturating_sub(22 + 0xFFFF);
    let end = (reach..bytes.len().saturating_sub(21))
        .rev()
        .find(|&at| bytes[at..].starts_with(b"PK\x05\x06"))
        .ok_or_else(cut)?;
    let count = usize::from(two(bytes, end + 10).ok_or_else(cut)?);
    let mut at = size(bytes, end + 16).ok_or_else(cut)?;
    if count > MOST {
        return Err(format!("{count} files in one archive"));
    }
    let mut found = Vec::with_capacity(count);
    for _ in 0..count {
        let (entry, next) = entry(bytes, at).ok_or_else(cut)?;
        found.push(entry);
        at = next;
    }
    Ok(found)
}

/// Returns the file described by the directory entry at an offset, and the offset of the next
/// entry.
fn entry(bytes: &[u8], at: usize) -> Option<(ZipEntry<'_>, usize)> {
    let head = bytes.get(at..)?;
    if !head.starts_with(b"PK\x01\x02") {
        return None;
    }
    let length = |from: usize| two(head, from).map(usize::from);
    let name_end = 46 + length(28)?;
    let next = at + name_end + length(30)? + length(32)?;
    let name = String::from_utf8_lossy(head.get(46..name_end)?).into_owned();
    let local = bytes.get(size(head, 42)?..)?;
    if !local.starts_with(b"PK\x03\x04") {
        return None;
    }
    let begin = 30 + usize::from(two(local, 26)?) + usize::from(two(local, 28)?);
    let packed = local.get(begin..)?.get(..size(head, 20)?)?;
    // Encrypted files are assigned the number of a compression method that does not exist.
    let method = if two(head, 8)? & 1 == 1 { u16::MAX } else { two(head, 10)? };
    let sum = four(head, 16)?;
    Some((ZipEntry { name, packed, method, sum }, next))
}

impl ZipEntry<'_> {
    /// Returns the unpacked file, which may have at most `limit` bytes, or a description of the
    /// error.
    pub(crate) fn unpack(&self, limit: u64) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let read = match self.method {
            0 => self.packed.take(limit + 1).read_to_end(&mut bytes),
            8 => {
                let inflated = flate2::read::DeflateDecoder::new(self.packed);
                inflated.take(limit + 1).read_to_end(&mut bytes)
            }
            u16::MAX => return Err(format!("{} encrypted", self.name)),
            other => return Err(format!("{} packed by method {other}", self.name)),
        };
        read.map_err(|error| format!("{} damaged ({error})", self.name))?;
        if bytes.len() as u64 > limit {
            return Err(format!("{} with more than {} MB", self.name, limit >> 20));
        }
        if crc32fast::hash(&bytes) != self.sum {
            return Err(format!(
                "{} whose checksum differs from the checksum in the archive",
                self.name
            ));
        }
        Ok(bytes)
    }
}

/// Returns `true` if the first file of a zip archive is a NumPy array.
pub(crate) fn is_numpy(bytes: &[u8]) -> bool {
    // The name of the first file is 30 bytes after the beginning of the archive.
    let name = bytes.get(30..bytes.len().min(200)).unwrap_or(&[]);
    bytes.starts_with(b"PK\x03\x04") && name.windows(4).any(|four| four == b".npy")
}

pub(super) fn two(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(bytes.get(at..at.checked_add(2)?)?.try_into().ok()?))
}

fn four(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

pub(super) fn size(bytes: &[u8], at: usize) -> Option<usize> {
    usize::try_from(four(bytes, at)?).ok()
}
