//! Reader of full SEED volumes: control headers with the response of every channel, then data
//! records.
//!
//! The data records are read as miniSEED. Sensitivities, units and directions come from the control
//! headers, unless the caller overrides them. Spec: FDSN, SEED 2.4, chapters 4 to 8, blockettes
//! 010, 034, 050, 052 and 058.

use std::collections::BTreeMap;

use super::source::{Source, latin1};
use super::{Format, Hints, miniseed};
use crate::direction::Direction;
use crate::error::{ReadError, Refusal};
use crate::instrument::Instrument;
use crate::record::Record;
use crate::units::MotionUnit;

pub(crate) const FORMAT: Format = Format { name: "seed", title: "SEED 2.4 volumes", sniff, read };

/// Shortest control record (bytes).
const SHORTEST: usize = 256;

fn sniff(source: &Source<'_>) -> bool {
    let b = source.bytes;
    b.len() > SHORTEST
        && b[..6].iter().all(u8::is_ascii_digit)
        && matches!(b[6], b'V' | b'A' | b'S' | b'T')
        && matches!(b[7], b' ' | b'*')
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let bytes = source.bytes;
    let length = record_length(bytes).ok_or_else(|| {
        let remedy = "give the data as miniSEED and the dataless part as StationXML";
        source.damaged((), "the length of records in blockette 010", "none", remedy)
    })?;
    let (mut abbreviations, mut stations) = (Vec::new(), Vec::new());
    let mut at = 0;
    while let Some(control) = bytes.get(at..at + length) {
        match control[6] {
            b'A' => abbreviations.extend_from_slice(&control[8..]),
            b'S' => stations.extend_from_slice(&control[8..]),
            b'V' | b'T' | b' ' => {}
            _ => break,
        }
        at += length;
    }
    let data = bytes.get(at..).unwrap_or_default();
    if data.is_empty() {
        return Err(source.not_acceleration(
            (),
            "control headers and data records",
            "a dataless SEED volume with control headers only",
            "give the miniSEED file with the sensitivity that this volume states, or the station's \
             StationXML",
        ));
    }
    let mut found = instruments(&latin1(&abbreviations), &latin1(&stations));
    let mut options = hints.options().clone();
    if let Some(better) = options.sensitivity {
        for known in &mut found {
            known.sensitivity = better;
        }
    }
    options.instruments.extend(found);
    let inner = Hints::new(&options);
    let read = (miniseed::FORMAT.read)(&Source::new(source.name, data), &inner);
    hints.used_as(&inner);
    read.map_err(|error| {
        if !matches!(error.refusal, Refusal::Missing(_)) {
            return error;
        }
        let (expected, remedy) = (error.expected.clone(), error.remedy.clone());
        source.error((), error.refusal, expected, "none in the volume", remedy)
    })
}

/// Returns the record length (bytes), a power of two, from blockette 010, 005 or 008 of the first
/// record.
fn record_length(bytes: &[u8]) -> Option<usize> {
    let head = latin1(bytes.get(8..SHORTEST)?);
    // Fields: type, length of the blockette, version, exponent.
    let exponent: u32 = match head.get(..3)? {
        "010" | "005" | "008" => head.get(11..13)?.trim().parse().ok()?,
        _ => return None,
    };
    (8..=20).contains(&exponent).then(|| 1 << exponent)
}

/// Calls `take` with the number and the content of every blockette.
fn blockettes(text: &str, mut take: impl FnMut(&str, &str)) {
    let mut rest = text.trim_start();
    while let (Some(kind), Some(length)) = (rest.get(..3), rest.get(3..7)) {
        let Some(length) = length.trim().parse::<usize>().ok().filter(|length| *length >= 7) else {
            break;
        };
        let Some(content) = rest.get(7..length) else { break };
        take(kind, content);
        rest = rest.get(length..).unwrap_or_default().trim_start();
    }
}

/// The fields of a blockette that have not been read yet.
struct Fields<'a>(&'a str);

impl<'a> Fields<'a> {
    /// Reads a field of fixed width.
    fn fixed(&mut self, width: usize) -> Option<&'a str> {
        let (field, rest) = (self.0.get(..width)?, self.0.get(width..)?);
        self.0 = rest;
        Some(field.trim())
    }

    /// Reads a field that ends with a tilde.
    fn open(&mut self) -> Option<&'a str> {
        let (field, rest) = self.0.split_once('~')?;
        self.0 = rest;
        Some(field.trim())
    }

    fn number(&mut self, width: usize) -> Option<f64> {
        self.fixed(width)?.parse().ok().filter(|value: &f64| value.is_finite())
    }
}

/// Unit codes, each with the name of the unit and, if it is a unit of motion, the parsed unit.
type Units = BTreeMap<u32, (String, Option<MotionUnit>)>;

/// Reads, from the control headers, the metadata of every channel that states a sensitivity.
fn instruments(abbreviations: &str, stations: &str) -> Vec<Instrument> {
    let mut units = Units::new();
    blockettes(abbreviations, |kind, content| {
        let mut fields = Fields(content);
        if kind == "034"
            && let Some(code) = fields.fixed(3).and_then(|code| code.parse().ok())
            && let Some(name) = fields.open()
        {
            units.insert(code, (name.to_owned(), MotionUnit::parse(name)));
        }
    });
    let mut found: Vec<Instrument> = Vec::new();
    let mut station = (String::new(), String::new());
    let mut open: Option<(Instrument, f64)> = None;
    blockettes(stations, |kind, content| match kind {
        "050" => {
            open = None;
            station = names(content).unwrap_or_default();
        }
        "052" => open = channel(content, &station, &units),
        "058" => {
            let mut fields = Fields(content);
            if fields.number(2) == Some(0.0)
                && let Some(value) = fields.number(12).filter(|value| *value != 0.0)
                && let Some((mut known, factor)) = open.take()
            {
                // The sensitivity is in counts per unit of the volume, and `factor` is the SI value
                // of that unit.
                known.sensitivity = value / factor;
                found.push(known);
            }
        }
        _ => {}
    });
    found
}

/// Returns the network and station codes in blockette 050.
fn names(content: &str) -> Option<(String, String)> {
    let mut fields = Fields(content);
    let station = fields.fixed(5)?.to_owned();
    // Skip latitude, longitude, elevation, channels, comments.
    fields.fixed(10 + 11 + 7 + 4 + 3)?;
    fields.open()?;
    // Skip the owner, the byte and word orders, begin and end, and the update flag.
    fields.fixed(3 + 4 + 2)?;
    fields.open()?;
    fields.open()?;
    fields.fixed(1)?;
    Some((fields.fixed(2).unwrap_or_default().to_owned(), station))
}

/// Reads a channel from blockette 052, which does not contain the sensitivity. Also returns the factor
/// that converts the signal unit of the channel to SI.
fn channel(
    content: &str,
    (network, station): &(String, String),
    units: &Units,
) -> Option<(Instrument, f64)> {
    let mut fields = Fields(content);
    let location = fields.fixed(2)?.to_owned();
    let channel = fields.fixed(3)?.to_owned();
    // Skip the subchannel and the instrument.
    fields.fixed(4 + 3)?;
    fields.open()?;
    let (name, unit) = fields.fixed(3)?.parse().ok().and_then(|code: u32| units.get(&code))?;
    fields.fixed(3)?;
    let place = [fields.number(10), fields.number(11), fields.number(7)];
    // Skip the local depth.
    fields.fixed(5)?;
    let (azimuth, dip) = (fields.number(5), fields.number(5));
    // Skip the format, record length, rate, drift, comments and flags.
    fields.fixed(4 + 2 + 10 + 10 + 4)?;
    fields.open()?;
    let epoch = (fields.open().and_then(instant), fields.open().and_then(instant));
    let direction = match dip {
        Some(-90.0) => Some(Direction::up()),
        Some(90.0) => Some(Direction { downward: true, ..Direction::up() }),
        Some(0.0) => azimuth.map(Direction::horizontal),
        _ => None,
    };
    let known = Instrument {
        network: network.clone(),
        station: station.clone(),
        location: Some(location),
        channel,
        epoch,
        sensitivity: 1.0,
        quantity: unit.map(|unit| unit.quantity),
        other_unit: unit.is_none().then(|| name.clone()),
        direction,
        place,
    };
    Some((known, unit.map_or(1.0, |unit| unit.factor)))
}

/// Parses a time such as `2003,175,00:00:00.0000`: year, day of the year, time of day.
fn instant(text: &str) -> Option<crate::utc::Utc> {
    let mut parts = text.split([',', ':']).map(|part| part.trim().parse::<f64>().ok());
    let mut next = || parts.next().flatten();
    #[expect(clippy::cast_possible_truncation, reason = "saturates, and is checked then")]
    let mut whole = || next().map(|value| value as i64);
    let (year, day) = (whole()?, whole()?);
    let (hour, minute) = (whole().unwrap_or(0), whole().unwrap_or(0));
    crate::utc::Utc::ordinal(year, day, hour, minute, next().unwrap_or(0.0))
}
