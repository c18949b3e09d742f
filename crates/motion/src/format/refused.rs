//! Files that are known and hold no acceleration history that can be read here.

use super::source::{Source, parse_number};
use super::{Format, Hints};
use crate::error::{ReadError, Refusal};
use crate::instrument::station_xml;
use crate::record::{Quantity, Record};

pub(crate) const HDF5: Format = Format {
    name: "hdf5",
    title: "HDF5 and ASDF containers (refused)",
    sniff: |source| source.bytes.starts_with(b"\x89HDF\r\n\x1a\n"),
    read: |source, _| {
        Err(source.not_acceleration(
            (),
            "a strong-motion file",
            "an HDF5 container",
            "export the acceleration series to plain columns first",
        ))
    },
};

pub(crate) const XML: Format = Format {
    name: "xml",
    title: "StationXML and QuakeML (refused)",
    sniff: |source| {
        let text = source.text(0);
        text.starts_with("<?xml") || text.starts_with("<FDSNStationXML")
    },
    read: xml,
};

/// Blocks of acceleration, velocity and displacement that the USGS gave out around 1987; no sample of
/// them can be passed on, so that a reader could not be tested.
pub(crate) const USGS_BLOCKS: Format = Format {
    name: "usgs-1987",
    title: "USGS blocks of 1987 (refused)",
    sniff: |source| {
        ["SAMPLES/SEC=", "DATA TYPE="].iter().all(|key| (0..7).any(|line| source.has(line, key)))
    },
    read: |source, _| {
        Err(source.error(
            (0..7).find(|&line| source.has(line, "DATA TYPE=")),
            Refusal::Unrecognized,
            "a format with a reader",
            "blocks of the USGS layout of 1987",
            "cut the block with DATA TYPE=AC into a file of plain columns and state its unit and step",
        ))
    },
};

/// USGS SLAMMER: bare columns of values in g whose steps stand in a table beside them.
///
/// The records themselves are read as plain columns with unit and step given by the caller.
/// Spec: Jibson et al. 2013, USGS Techniques and Methods 12-B1, "Adding records".
pub(crate) const SLAMMER: Format = Format {
    name: "slammer",
    title: "USGS SLAMMER record table (refused)",
    sniff: |source| {
        let fields: Vec<&[u8]> = source.raw(0).split(|&b| b == b'\t').collect();
        // Counted from 0, the step stands in column 10.
        fields.len() >= 12
            && parse_number(fields[0]).is_none()
            && parse_number(fields[10]).is_some_and(|step| step > 0.0 && step < 1.0)
    },
    read: |source, _| {
        Err(source.not_acceleration(
            0,
            "an acceleration history",
            "SLAMMER's table of records",
            "give a record file beside it with unit g and the step that this table states for it",
        ))
    },
};

fn xml(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let mut found = station_xml(&String::from_utf8_lossy(source.bytes)).unwrap_or_default();
    found.retain(|known| known.quantity == Some(Quantity::Acceleration));
    let remedy = if found.is_empty() {
        "give the waveform file".to_owned()
    } else {
        let list: Vec<String> =
            found.iter().map(|known| format!("{} {}", known.channel, known.sensitivity)).collect();
        format!(
            "give the waveform file with the sensitivity stated here (counts per m/s2: {})",
            list.join(", ")
        )
    };
    Err(source.not_acceleration((), "an acceleration history", "XML metadata", remedy))
}
