//! USC Los Angeles volume 1: the CDMG layout with `1X,10F7.3` pairs at uneven times.
//!
//! Film records were digitized where the trace bends, so the step varies from 0.003 to 0.013 s.
//! Spec: Trifunac and Lee 1973, EERL report 73-03, volume 1 card images; Todorovska et al. 1999,
//! USC network data release.

use super::source::{Columns, Source};
use super::{Format, Told, cdmg};
use crate::error::ReadError;
use crate::record::{Record, Stage};

pub(crate) const FORMAT: Format =
    Format { name: "usc", title: "USC Los Angeles volume 1", sniff, read };

const PAIRS: Columns = Columns { indent: 1, per_line: 10, width: 7 };

fn sniff(source: &Source<'_>) -> bool {
    source.text(0).to_ascii_uppercase().starts_with("FILE")
        && source.has(0, "UNCORRECTED ACCELEROGRAM")
}

fn read(source: &Source<'_>, told: &Told<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    cdmg::read_blocks(source, told, &mut record, PAIRS)?;
    Ok(record)
}
