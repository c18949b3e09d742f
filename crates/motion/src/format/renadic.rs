//! RENADIC, Universidad de Chile: CDMG volume 1 with pairs in g/10 and often a clock channel.
//!
//! Coordinates, dates and azimuth integers of these files are mostly zero or of another day and are
//! not used.
//! Spec: the CDMG volume 1 layout; "UNIVERSIDAD DE CHILE - RENADIC" on line 8 of each channel.

use super::source::Source;
use super::{Format, Told, cdmg};
use crate::error::ReadError;
use crate::record::{Record, Stage};
use crate::site::Site;

pub(crate) const FORMAT: Format =
    Format { name: "renadic", title: "RENADIC (Universidad de Chile)", sniff, read };

fn sniff(source: &Source<'_>) -> bool {
    source.has(0, "UNCORRECTED ACCELEROGRAM DATA") && source.has(7, "RENADIC")
}

fn read(source: &Source<'_>, told: &Told<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    cdmg::read_blocks(source, told, &mut record, cdmg::PAIRS)?;
    // Times and coordinates of these headers are those of the software's first day, or zero.
    record.place(None, &Site::default());
    if source.name.to_ascii_lowercase().contains("parte") {
        record.warn(
            None,
            "the name says that this is one part of a longer record; join the parts, which overlap",
        );
    }
    Ok(record)
}
