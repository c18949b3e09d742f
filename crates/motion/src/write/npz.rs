//! NumPy's archive of arrays.

use std::io;

use crate::error::MotionError;
use crate::record::Record;
use crate::sampled::integrate;

/// A record as a NumPy archive: `time` (s) and for every channel `NAME_acceleration` (m/s²),
/// `NAME_velocity` (m/s) and `NAME_displacement` (m); signs other than letters and digits in names
/// become underscores.
///
/// ```
/// use barrelstack_motion::{bundled, write};
/// let napa = bundled("napa-college-2014").unwrap();
/// assert!(write::npz(&napa)?.starts_with(b"PK"));
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
///
/// # Errors
/// If there is no channel or the steps differ.
pub fn npz(record: &Record) -> Result<Vec<u8>, MotionError> {
    let (step, rows) = super::common(record)?;
    let time: Vec<f64> = (0..rows).map(|row| row as f64 * step).collect();
    let mut series = Vec::new();
    for (channel, name) in record.channels.iter().zip(super::names(&record.channels)) {
        let name: String =
            name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let acceleration = channel.acceleration[..rows].to_vec();
        let (velocity, displacement) = integrate(step, &acceleration, channel.initial_velocity);
        series.push((format!("{name}_acceleration"), acceleration));
        series.push((format!("{name}_velocity"), velocity));
        series.push((format!("{name}_displacement"), displacement));
    }
    let mut arrays = vec![("time".to_owned(), time.as_slice())];
    arrays.extend(series.iter().map(|(name, values)| (name.clone(), values.as_slice())));
    archive(&arrays).map_err(|error| MotionError::Mismatch {
        what: format!("the arrays make no archive: {error}"),
        remedy: "give the channels names of their own".to_owned(),
    })
}

/// NumPy's archive of named arrays: an uncompressed zip of one `.npy` for each.
///
/// Equal arrays give equal bytes.
///
/// # Errors
/// If a name occurs twice or an array is beyond the size of the format.
pub fn archive(arrays: &[(String, &[f64])]) -> io::Result<Vec<u8>> {
    let refuse = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (at, (name, values)) in arrays.iter().enumerate() {
        if arrays[..at].iter().any(|(earlier, _)| earlier == name) {
            return refuse(format!("two of them are called {name}"));
        }
        let (file, bytes) = (format!("{name}.npy"), npy(values));
        let (Ok(start), Ok(size), Ok(length)) =
            (u32::try_from(archive.len()), u32::try_from(bytes.len()), u16::try_from(file.len()))
        else {
            return refuse(format!("{name} ends beyond 4 GB, or its name beyond 64 kB"));
        };
        let entry = entry(crc32fast::hash(&bytes), size, length);
        archive.extend(b"PK\x03\x04");
        archive.extend(entry);
        archive.extend(file.as_bytes());
        archive.extend(bytes);
        directory.extend(b"PK\x01\x02");
        directory.extend(VERSION.to_le_bytes());
        directory.extend(entry);
        // No comment, the first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(file.as_bytes());
    }
    let (Ok(count), Ok(start), Ok(size)) =
        (u16::try_from(arrays.len()), u32::try_from(archive.len()), u32::try_from(directory.len()))
    else {
        return refuse(format!("{} of them are too many or too large", arrays.len()));
    };
    archive.extend(directory);
    archive.extend(b"PK\x05\x06");
    // One disk, which is this one.
    archive.extend([0; 4]);
    archive.extend([count; 2].map(u16::to_le_bytes).concat());
    archive.extend(size.to_le_bytes());
    archive.extend(start.to_le_bytes());
    archive.extend([0; 2]);
    Ok(archive)
}

/// Version of the zip format that a reader needs for stored files (PKWARE, APPNOTE 4.4.3: 1.0).
const VERSION: u16 = 10;

/// What the header of a stored file and the directory say of it alike (PKWARE, APPNOTE 4.3.7 and 4.3.12).
fn entry(sum: u32, size: u32, name_length: u16) -> [u8; 26] {
    /// The first day of the format's calendar, 1 January 1980, so that equal runs give equal bytes.
    const DATE: u16 = 0x21;
    let mut entry = [0; 26];
    entry[..2].copy_from_slice(&VERSION.to_le_bytes());
    // No flags, no compression, midnight.
    entry[8..10].copy_from_slice(&DATE.to_le_bytes());
    entry[10..14].copy_from_slice(&sum.to_le_bytes());
    entry[14..18].copy_from_slice(&size.to_le_bytes());
    entry[18..22].copy_from_slice(&size.to_le_bytes());
    entry[22..24].copy_from_slice(&name_length.to_le_bytes());
    entry
}

/// NumPy's array format, version 1.0: a magic word, a padded description, the numbers.
fn npy(values: &[f64]) -> Vec<u8> {
    let mut description =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.len());
    // Magic, version, length, description and line feed together fill a multiple of 64 bytes.
    while (10 + description.len() + 1) % 64 != 0 {
        description.push(' ');
    }
    description.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(description.len()).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend(description.as_bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::archive;

    #[test]
    fn a_name_that_occurs_twice_is_refused() {
        let twice = [("a".to_owned(), &[1.0][..]), ("a".to_owned(), &[2.0][..])];
        assert!(archive(&twice).is_err_and(|error| error.to_string().contains("called a")));
        assert!(archive(&twice[1..]).is_ok());
    }
}
