//! Reader of SAC text files ("alphanumeric"): the header of the binary format in lines, then the
//! samples.
//!
//! The text is converted to the equivalent binary file, which is then read. Spec: SAC users manual,
//! "SAC data file format", alphanumeric files.

use super::source::{Columns, Source};
use super::{Format, Hints, sac};
use crate::error::ReadError;
use crate::record::Record;

pub(crate) const FORMAT: Format =
    Format { name: "sac-text", title: "SAC text (alphanumeric)", sniff, read };

/// Number of reals in the header, which has 14 lines of 5 reals, 8 lines of 5 integers, and 8 lines of
/// 24 characters.
const REALS: usize = 70;
const INTEGERS: usize = 40;
const WORD_LINES: usize = 8;
const HEADER_LINES: usize = REALS / 5 + INTEGERS / 5 + WORD_LINES;
/// Index of the header version (word 76) among the integers of the header. The integer at index 9 is the
/// number of samples.
const VERSION: usize = 6;
const POINTS: usize = 9;

fn integers(source: &Source<'_>) -> Option<Vec<f64>> {
    source.fixed(REALS / 5, INTEGERS, Columns::new(5, 10), f64::INFINITY).ok().map(|(all, _)| all)
}

fn sniff(source: &Source<'_>) -> bool {
    let reals = source.fixed(0, REALS, Columns::new(5, 15), f64::INFINITY);
    reals.is_ok() && integers(source).is_some_and(|all| all[VERSION] == 6.0)
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    source.require_header(0, HEADER_LINES)?;
    let (reals, line) = source.fixed(0, REALS, Columns::new(5, 15), f64::MAX)?;
    let (integers, line) =
        source.fixed(line, INTEGERS, Columns::new(5, 10), f64::from(i32::MAX))?;
    let points = super::whole(source, REALS / 5 + 1, "a number of points", integers[POINTS])?;
    let data = line + WORD_LINES;
    // There are five values per line; some programs write each of the last few values on a line of
    // its own.
    let values = source.all_tokens(data, source.lines.len(), f64::from(f32::MAX))?;
    if values.len() != points {
        let stated = format!("{points} values as the header states");
        let found = values.len().to_string();
        if values.len() >= 2 * points {
            let remedy =
                "give a time series; spectra and pairs of time and value are not supported";
            return Err(source.not_acceleration((), stated, found, remedy));
        }
        if values.len() > points {
            let remedy = "the header belongs to another file, or lines were added; get it again from \
                          its source";
            return Err(source.damaged((), stated, found, remedy));
        }
        return Err(source.cut(stated, found));
    }
    let mut bytes = Vec::with_capacity(632 + 4 * points);
    let single = |bytes: &mut Vec<u8>, value: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "SAC holds single precision")]
        let value = value as f32;
        bytes.extend_from_slice(&value.to_le_bytes());
    };
    for value in reals {
        single(&mut bytes, value);
    }
    for value in integers {
        #[expect(clippy::cast_possible_truncation, reason = "at most the largest of 32 bits")]
        let value = value as i32;
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    for line in line..data {
        let mut words = [b' '; 24];
        for (to, from) in words.iter_mut().zip(source.raw(line)) {
            *to = *from;
        }
        bytes.extend_from_slice(&words);
    }
    for value in values {
        single(&mut bytes, value);
    }
    (sac::FORMAT.read)(&Source::new(source.name, &bytes), hints)
}
