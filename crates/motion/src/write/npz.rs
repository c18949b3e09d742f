//! NumPy's archive of arrays.

use std::io::{self, Write as _};

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
    let mut archive = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
    // The default date of the archive is a constant, so equal runs give equal bytes.
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, values) in arrays {
        archive.start_file(format!("{name}.npy"), options)?;
        archive.write_all(&npy(values))?;
    }
    Ok(archive.finish()?.into_inner())
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
