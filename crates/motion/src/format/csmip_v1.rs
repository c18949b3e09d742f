//! CSMIP, CDMG and CGS volume 1: uncorrected accelerograms in three data layouts.
//!
//! Time and value pairs `10F7.3` in g/10; a data line with its own format; a data line without one.
//! Spec: Shakal, Huang and Rojahn 1985, CSMIP report OSMS 85-03, "CSMIP strong-motion data file
//! format"; CDMG volume 1 of the 1970s.

use super::source::Source;
use super::{Format, Told, cdmg};
use crate::error::ReadError;
use crate::record::{Record, Stage};

pub(crate) const FORMAT: Format =
    Format { name: "csmip-v1", title: "CSMIP/CDMG/CGS volume 1 (uncorrected)", sniff, read };

fn sniff(source: &Source<'_>) -> bool {
    source.find(0, "UNCORRECTED ACCELEROGRAM DATA").is_some_and(|at| at < 4)
}

fn read(source: &Source<'_>, told: &Told<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    cdmg::read_blocks(source, told, &mut record, cdmg::PAIRS)?;
    Ok(record)
}
