//! Writes NumPy archives of arrays.

use std::collections::BTreeSet;
use std::io;

use crate::error::MotionError;
use crate::record::Record;
use crate::sampled::integrate;

/// Writes a record as a NumPy archive.
///
/// The arrays are `time` (s) and, for every channel, `NAME_acceleration` (m/s²), `NAME_velocity`
/// (m/s) and `NAME_displacement` (m). Characters other than letters and digits in names become
/// underscores.
///
/// Arrays of strings contain the header of this crate's text format, such as `station`, `unit`,
/// `channels` and `processing` (one string per step), so that [`crate::read`] restores the record
/// bit for bit. `azimuth` is in degrees clockwise from north, or NaN if unknown.
///
/// ```
/// use barrelstack_motion::{bundled, write};
/// let napa = bundled("napa-college-2014").unwrap();
/// assert!(write::npz(&napa)?.starts_with(b"PK"));
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
///
/// # Errors
/// If the record has no channel or the time steps differ.
pub fn npz(record: &Record) -> Result<Vec<u8>, MotionError> {
    let (step, rows) = super::common(record)?;
    let time: Vec<f64> = (0..rows).map(|row| row as f64 * step).collect();
    let azimuth: Vec<f64> =
        record.channels.iter().map(|c| c.direction.azimuth.unwrap_or(f64::NAN)).collect();
    let mut arrays = vec![("time".to_owned(), npy(&time)), ("azimuth".to_owned(), npy(&azimuth))];
    for (channel, name) in record.channels.iter().zip(super::names(&record.channels)) {
        let name = array_name(&name);
        let acceleration = &channel.acceleration[..rows];
        let (velocity, displacement) = integrate(step, acceleration, channel.initial_velocity);
        arrays.push((format!("{name}_acceleration"), npy(acceleration)));
        arrays.push((format!("{name}_velocity"), npy(&velocity)));
        arrays.push((format!("{name}_displacement"), npy(&displacement)));
    }
    let head = super::text::head(record, step);
    for key in head.iter().map(|(key, _)| *key).collect::<BTreeSet<_>>() {
        let values =
            head.iter().filter(|(other, _)| *other == key).map(|(_, value)| value.as_str());
        arrays.push((key.to_owned(), npy_words(&values.collect::<Vec<_>>())));
    }
    zipped(&arrays).map_err(|error| {
        let what = format!("cannot write the arrays as an archive: {error}");
        MotionError::mismatch(what, "give the channels different names")
    })
}

/// Converts a channel name to the first part of the names of its arrays: characters other than ASCII letters and digits
/// become underscores.
pub(crate) fn array_name(channel: &str) -> String {
    channel.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// Returns a NumPy archive of named arrays: an uncompressed zip with one `.npy` file per array.
///
/// Equal arrays give equal bytes.
///
/// # Errors
/// If a name is repeated or an array is too large for the format.
pub fn archive(arrays: &[(String, &[f64])]) -> io::Result<Vec<u8>> {
    zipped(&arrays.iter().map(|(name, values)| (name.clone(), npy(values))).collect::<Vec<_>>())
}

fn zipped(arrays: &[(String, Vec<u8>)]) -> io::Result<Vec<u8>> {
    let refuse = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (at, (name, bytes)) in arrays.iter().enumerate() {
        if arrays[..at].iter().any(|(earlier, _)| earlier == name) {
            return refuse(format!("two arrays are named {name}"));
        }
        let file = format!("{name}.npy");
        let (Ok(start), Ok(size), Ok(length)) =
            (u32::try_from(archive.len()), u32::try_from(bytes.len()), u16::try_from(file.len()))
        else {
            return refuse(format!(
                "array {name} ends beyond 4 GB, or its name is longer than 64 kB"
            ));
        };
        let entry = entry(crc32fast::hash(bytes), size, length);
        archive.extend(b"PK\x03\x04");
        archive.extend(entry);
        archive.extend(file.as_bytes());
        archive.extend(bytes);
        directory.extend(b"PK\x01\x02");
        directory.extend(VERSION.to_le_bytes());
        directory.extend(entry);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(file.as_bytes());
    }
    let (Ok(count), Ok(start), Ok(size)) =
        (u16::try_from(arrays.len()), u32::try_from(archive.len()), u32::try_from(directory.len()))
    else {
        return refuse(format!("{} arrays are too many or too large", arrays.len()));
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

/// Version of the zip format required to read stored files (1.0; PKWARE, APPNOTE 4.4.3).
const VERSION: u16 = 10;

/// Returns the fields common to the header of a stored file and its directory entry (PKWARE,
/// APPNOTE 4.3.7 and 4.3.12).
fn entry(sum: u32, size: u32, name_length: u16) -> [u8; 26] {
    /// Fixed date, the first day of the format's calendar (1 January 1980), so that equal runs give
    /// equal bytes.
    const DATE: u16 = 0x21;
    let mut entry = [0; 26];
    entry[..2].copy_from_slice(&VERSION.to_le_bytes());
    // No flags, no compression, time midnight.
    entry[8..10].copy_from_slice(&DATE.to_le_bytes());
    entry[10..14].copy_from_slice(&sum.to_le_bytes());
    entry[14..18].copy_from_slice(&size.to_le_bytes());
    entry[18..22].copy_from_slice(&size.to_le_bytes());
    entry[22..24].copy_from_slice(&name_length.to_le_bytes());
    entry
}

/// Encodes an array of numbers in NumPy's array format.
fn npy(values: &[f64]) -> Vec<u8> {
    let mut bytes = npy_head("<f8", values.len());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// Encodes an array of strings in UCS-4 as NumPy does; all strings are padded to the length of the
/// longest string.
fn npy_words(words: &[&str]) -> Vec<u8> {
    let longest = words.iter().map(|word| word.chars().count()).max().unwrap_or(0).max(1);
    let mut bytes = npy_head(&format!("<U{longest}"), words.len());
    for word in words {
        let padded = word.chars().map(u32::from).chain(std::iter::repeat(0)).take(longest);
        bytes.extend(padded.flat_map(u32::to_le_bytes));
    }
    bytes
}

/// Returns the header of NumPy's array format, version 1.0, with a padded description; the items
/// follow the header.
fn npy_head(kind: &str, count: usize) -> Vec<u8> {
    let mut description =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({count},), }}");
    // The header must fill a multiple of 64 bytes.
    while (10 + description.len() + 1) % 64 != 0 {
        description.push(' ');
    }
    description.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(description.len()).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend(description.as_bytes());
    bytes
}
