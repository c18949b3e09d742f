//! Files that are known and hold no acceleration history that can be read here.

use super::source::{Source, leading_number};
use super::{Format, ReadOptions};
use crate::error::{ReadError, Refusal};
use crate::record::Record;

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

fn usgs_blocks(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
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

fn hdf5(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
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

fn xml(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
    let found = station_xml_sensitivities(source.bytes);
    let remedy = if found.is_empty() {
        "give the waveform file".to_owned()
    } else {
        let list: Vec<String> =
            found.iter().map(|(channel, value)| format!("{channel} {value}")).collect();
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

/// The overall sensitivities of the acceleration channels in a `StationXML` file: channel code and
/// counts per m/s², in file order.
pub fn station_xml_sensitivities(bytes: &[u8]) -> Vec<(String, f64)> {
    let text = super::source::latin1(bytes);
    let mut found = Vec::new();
    for channel in text.split("<Channel ").skip(1) {
        let code = channel.split("code=\"").nth(1).and_then(|rest| rest.split('"').next());
        let Some(block) = channel
            .split("<InstrumentSensitivity>")
            .nth(1)
            .and_then(|rest| rest.split("</InstrumentSensitivity>").next())
        else {
            continue;
        };
        let unit = block.split("<Name>").nth(1).and_then(|rest| rest.split('<').next());
        let value = block
            .split("<Value>")
            .nth(1)
            .and_then(|rest| leading_number(rest.as_bytes()))
            .map(|(value, _)| value);
        if let (Some(code), Some("M/S**2" | "m/s**2" | "M/S^2" | "m/s^2"), Some(value)) =
            (code, unit, value)
        {
            found.push((code.to_owned(), value));
        }
    }
    found
}
