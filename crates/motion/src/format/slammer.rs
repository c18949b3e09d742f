//! USGS SLAMMER: bare columns of values in g whose steps stand in a table beside them.
//!
//! The records themselves are read as plain columns with unit and step given by the caller.
//! Spec: Jibson et al. 2013, USGS Techniques and Methods 12-B1, "Adding records".

use super::source::{Source, parse_number};
use super::{Format, Told};
use crate::error::{ReadError, Refusal};
use crate::record::Record;

pub(crate) const FORMAT: Format =
    Format { name: "slammer", title: "USGS SLAMMER record table (refused)", sniff, read };

/// Column of the step, counted from 0.
const STEP: usize = 10;

fn sniff(source: &Source<'_>) -> bool {
    let fields: Vec<&[u8]> = source.raw(0).split(|&b| b == b'\t').collect();
    fields.len() >= STEP + 2
        && parse_number(fields[0]).is_none()
        && parse_number(fields[STEP]).is_some_and(|step| step > 0.0 && step < 1.0)
}

fn read(source: &Source<'_>, _: &Told<'_>) -> Result<Record, ReadError> {
    Err(source.error(
        0,
        Refusal::NotAcceleration,
        "an acceleration history",
        "SLAMMER's table of records",
        "give a record file beside it with unit g and the step that this table states for it",
    ))
}
