//! Reader of NumPy archives written by this crate: arrays of accelerations, and arrays of strings
//! that contain the header.
//!
//! Spec: NumPy enhancement proposal 1, the `.npy` format, versions 1.0 and 2.0;
//! [`crate::write::npz`].

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::source::{Source, latin1, shorten};
use super::{Format, Hints, native, zip};
use crate::error::{ReadError, ReadFailure, Refusal};
use crate::record::Record;
use crate::write::{TITLE, array_name};

pub(crate) const FORMAT: Format =
    Format { name: "npz", title: "NumPy archive of this crate", sniff, read };

/// Largest total size of all arrays (bytes).
const LARGEST: u64 = 64 << 20;

enum Array {
    Numbers(Vec<f64>),
    Words(Vec<String>),
}

fn sniff(source: &Source<'_>) -> bool {
    zip::is_numpy(source.bytes)
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let damaged = |expected: &str, found: String| {
        source.damaged((), expected, found, "write the archive again")
    };
    let mut arrays = BTreeMap::new();
    let entries = zip::entries(source.bytes).map_err(|found| damaged("a NumPy archive", found))?;
    let mut room = LARGEST;
    for entry in entries {
        let Some(name) = entry.name.strip_suffix(".npy").map(str::to_owned) else { continue };
        let bytes = entry.unpack(room).map_err(|found| damaged("an array", found))?;
        room -= bytes.len() as u64;
        let array = array(&bytes).ok_or_else(|| {
            let found = match bytes.get(10..90) {
                Some(head) => shorten(&latin1(head)),
                None => format!("{} bytes", bytes.len()),
            };
            damaged(&format!("a one-dimensional array {name} of numbers or strings"), found)
        })?;
        arrays.insert(name, array);
    }
    if !matches!(arrays.get("channels"), Some(Array::Words(_))) {
        let names: Vec<&str> = arrays.keys().map(String::as_str).collect();
        let found = match names.as_slice() {
            [] => "no arrays".to_owned(),
            names => shorten(&names.join(", ")),
        };
        return Err(source.error(
            (),
            Refusal::Unrecognized,
            "an array of strings named channels, as written by this program",
            found,
            "save the accelerations as plain columns and state their unit and step",
        ));
    }
    let mut header = format!("{TITLE}\n");
    for (key, array) in &arrays {
        if let Array::Words(words) = array {
            for word in words {
                let word: String =
                    word.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
                // Writing to a String cannot fail.
                let _ = writeln!(header, "# {key}: {word}");
            }
        }
    }
    let text = Source::new(source.name, header.as_bytes());
    let described = native::described(&text, text.lines.len(), |names, limit| {
        let mut rows = None;
        let mut columns = Vec::new();
        for name in names {
            let key = format!("{}_acceleration", array_name(name));
            let Some(Array::Numbers(values)) = arrays.get(&key) else {
                return Err(damaged(
                    &format!("an array of numbers named {key}"),
                    "none".to_owned(),
                ));
            };
            if *rows.get_or_insert(values.len()) != values.len() {
                return Err(damaged(
                    "arrays of the same length",
                    format!("{} in {key}", values.len()),
                ));
            }
            if let Some(bad) = values.iter().find(|value| !(value.abs() <= limit)) {
                return Err(damaged(&format!("accelerations in {key}"), bad.to_string()));
            }
            columns.push(values.clone());
        }
        Ok(columns)
    });
    // Archives have no lines, so positions are removed from the error.
    described.map_err(|error| ReadFailure { line: None, column: None, ..(*error).clone() }.into())
}

/// Parses a one-dimensional array of numbers or strings; returns `None` for anything else.
fn array(bytes: &[u8]) -> Option<Array> {
    let rest = bytes.strip_prefix(b"\x93NUMPY")?;
    let (start, length) = match rest.first()? {
        1 => (4, usize::from(zip::two(rest, 2)?)),
        2 | 3 => (6, zip::size(rest, 2)?),
        _ => return None,
    };
    let (head, data) = rest.get(start..)?.split_at_checked(length)?;
    let head = std::str::from_utf8(head).ok()?;
    let after =
        |key: &str| head.split_once(key).map(|(_, rest)| rest.trim_start_matches([':', ' ']));
    let kind = after("'descr'")?.strip_prefix('\'')?.split('\'').next()?;
    let shape = after("'shape'")?.strip_prefix('(')?.split(')').next()?;
    let count: usize = shape.strip_suffix(',')?.trim().parse().ok()?;
    if kind == "<f8" {
        let whole = count.checked_mul(8)? == data.len();
        let number = |eight: &[u8]| eight.try_into().map(f64::from_le_bytes).ok();
        return whole
            .then(|| data.chunks_exact(8).filter_map(number).collect())
            .map(Array::Numbers);
    }
    let length: usize = kind.strip_prefix("<U")?.parse().ok()?;
    let size = length.checked_mul(4).filter(|size| *size > 0)?;
    if size.checked_mul(count)? != data.len() {
        return None;
    }
    let sign =
        |four: &[u8]| four.try_into().ok().and_then(|b| char::from_u32(u32::from_le_bytes(b)));
    let word = |bytes: &[u8]| -> Option<String> {
        let signs: Option<String> = bytes.chunks_exact(4).map(sign).collect();
        Some(signs?.trim_end_matches('\0').to_owned())
    };
    data.chunks_exact(size).map(word).collect::<Option<_>>().map(Array::Words)
}
