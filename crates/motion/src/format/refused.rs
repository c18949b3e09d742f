//! Files that are known and hold no acceleration history that can be read here.

use super::source::Source;
use super::{Format, Told};
use crate::error::{ReadError, Refusal};
use crate::instrument::station_xml;
use crate::record::{Quantity, Record};

pub(crate) const HDF5: Format = Format {
    name: "hdf5",
    title: "HDF5 and ASDF containers (refused)",
    sniff: is_hdf5,
    read: hdf5,
};

pub(crate) const XML: Format =
    Format { name: "xml", title: "StationXML and QuakeML (refused)", sniff: is_xml, read: xml };

/// Blocks of acceleration, velocity and displacement that the USGS gave out around 1987; no sample of
/// them can be passed on, so that a reader could not be tested.
pub(crate) const USGS_BLOCKS: Format = Format {
    name: "usgs-1987",
    title: "USGS blocks of 1987 (refused)",
    sniff: is_usgs_blocks,
    read: usgs_blocks,
};

fn is_usgs_blocks(source: &Source<'_>) -> bool {
    (0..7).any(|line| source.has(line, "SAMPLES/SEC="))
        && (0..7).any(|line| source.has(line, "DATA TYPE="))
}

fn usgs_blocks(source: &Source<'_>, _: &Told<'_>) -> Result<Record, ReadError> {
    let line = (0..7).find(|&line| source.has(line, "DATA TYPE="));
    Err(source.error(
        line,
        Refusal::Unrecognized,
        "a format with a reader",
        "blocks of the USGS layout of 1987",
        "cut the block with DATA TYPE=AC into a file of plain columns and state its unit and step",
    ))
}

fn is_hdf5(source: &Source<'_>) -> bool {
    source.bytes.starts_with(b"\x89HDF\r\n\x1a\n")
}

fn hdf5(source: &Source<'_>, _: &Told<'_>) -> Result<Record, ReadError> {
    Err(source.error(
        (),
        Refusal::NotAcceleration,
        "a strong-motion file",
        "an HDF5 container",
        "export the acceleration series to plain columns first",
    ))
}

fn is_xml(source: &Source<'_>) -> bool {
    let text = source.text(0);
    text.starts_with("<?xml") || text.starts_with("<FDSNStationXML")
}

fn xml(source: &Source<'_>, _: &Told<'_>) -> Result<Record, ReadError> {
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
    Err(source.error(
        (),
        Refusal::NotAcceleration,
        "an acceleration history",
        "XML metadata",
        remedy,
    ))
}
