//! USGS SLAMMER: bare columns of values in g whose steps stand in a table beside them.
//!
//! The records themselves are read as plain columns with unit and step given by the caller;
//! [`slammer_step`] finds the step in the program's table `EQdata.txt`.
//! Spec: Jibson et al. 2013, USGS Techniques and Methods 12-B1, "Adding records".

use super::source::{Source, parse_number};
use super::{Format, ReadOptions};
use crate::error::{ReadError, Refusal};
use crate::record::Record;

pub(crate) const FORMAT: Format =
    Format { name: "slammer", title: "USGS SLAMMER record table (refused)", sniff, read };

/// Column of the step, counted from 0.
const STEP: usize = 10;
const RECORD: usize = 3;

fn sniff(source: &Source<'_>) -> bool {
    let fields: Vec<&[u8]> = source.raw(0).split(|&b| b == b'\t').collect();
    fields.len() >= STEP + 2
        && parse_number(fields[0]).is_none()
        && parse_number(fields[STEP]).is_some_and(|step| step > 0.0 && step < 1.0)
}

fn read(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
    Err(source.error(
        0,
        Refusal::NotAcceleration,
        "an acceleration history",
        "SLAMMER's table of records",
        "give a record file beside it with unit g and the step that this table states for it",
    ))
}

/// The step (s) that SLAMMER's table states for a record such as `PEL-360` of an event whose name
/// starts with `event`.
///
/// ```
/// let table = b"Northridge 1994\t6.7\tR\tPEL-360\tLA\tCGS\t34.09\t-118.34\tD\t318\t0.020\t24\t\t\n";
/// assert_eq!(barrelstack_motion::slammer_step(table, "Northridge", "PEL-360"), Some(0.02));
/// ```
pub fn slammer_step(table: &[u8], event: &str, record: &str) -> Option<f64> {
    let source = Source::new("table", table);
    (0..source.lines.len()).find_map(|line| {
        let text = super::source::latin1(source.raw(line));
        let fields: Vec<&str> = text.split('\t').map(str::trim).collect();
        (fields.first()?.starts_with(event) && fields.get(RECORD)?.eq_ignore_ascii_case(record))
            .then(|| fields.get(STEP)?.parse().ok())
            .flatten()
    })
}
