//! Groups record files that are given together into motions, and lists files that contain no
//! motion.

use std::collections::BTreeMap;

use barrelstack::motion::{
    Channel, Given, Instrument, ReadError, ReadOptions, Record, Refusal, group_files, read,
    station_xml, write,
};
use barrelstack_report::Language;
use serde::{Deserialize, Serialize};

/// Information that the files lack and that the user supplies; each field is `None` if it is not supplied.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Reading {
    /// The unit of acceleration, such as "g".
    pub unit: Option<String>,
    /// Time step (s).
    pub time_step: Option<f64>,
}

/// The motions in the given files, and the files that contain no motion.
#[derive(Default, Serialize)]
pub(crate) struct Files {
    /// The motions in the files. The combined files follow the JSON in this order.
    motions: Vec<Motion>,
    /// Files that contain no motion.
    refused: Vec<Refused>,
}

/// A motion from one or several files.
#[derive(Serialize)]
pub(crate) struct Motion {
    /// File name for the motion.
    name: String,
    /// Files from which the motion was read.
    files: Vec<String>,
    /// Description of each channel.
    channels: Vec<String>,
    /// Length in bytes of the combined file of all channels, which follows the JSON; 0 if the motion is one of the
    /// given files.
    length: usize,
}

/// A file that contains no motion.
#[derive(Serialize)]
struct Refused {
    file: String,
    why: String,
    /// Missing information that would make the file readable: "unit", "step", "unit or sensitivity"
    /// or "sensitivity".
    missing: Option<&'static str>,
}

/// Maximum number of channels of one motion.
const COMPONENTS: usize = 3;

/// Reads record files and groups them into motions.
///
/// Returns the motions, with the files that contain no motion, and the bytes of the combined file of each motion. The
/// bytes are empty if the motion is one of the given files.
pub(crate) fn of(
    files: &BTreeMap<String, &[u8]>,
    reading: &Reading,
    language: Language,
) -> Result<(Files, Vec<Vec<u8>>), String> {
    let mut options = ReadOptions { time_step: reading.time_step, ..ReadOptions::default() };
    if let Some(unit) = &reading.unit {
        options.unit = Some(unit.parse().map_err(|error| format!("unit: {error}"))?);
    }
    let stations: BTreeMap<&String, Vec<Instrument>> =
        files.iter().filter_map(|(name, bytes)| Some((name, station(bytes)?))).collect();
    options.instruments = stations.values().flatten().cloned().collect();
    let mut found = Files::default();
    let mut records: Vec<Record> = Vec::new();
    for (name, bytes) in files.iter().filter(|(name, _)| !stations.contains_key(name)) {
        match read(bytes, name, &options) {
            Ok(record) => records.push(record),
            Err(error) => found.refused.push(Refused::of(name, &error)),
        }
    }
    let mut gathered = Vec::new();
    for records in records_of(records) {
        let (motion, bytes) = Motion::of(&records, !stations.is_empty())?;
        found.motions.push(motion);
        gathered.push(bytes);
    }
    let channels = found.motions.iter_mut().flat_map(|motion| &mut motion.channels);
    for text in channels.chain(found.refused.iter_mut().map(|refused| &mut refused.why)) {
        *text = language.text(text);
    }
    Ok((found, gathered))
}

/// Returns the instruments that a `StationXML` file describes; `None` if the file is not XML or describes no
/// instrument.
fn station(bytes: &[u8]) -> Option<Vec<Instrument>> {
    let text = std::str::from_utf8(bytes).ok().filter(|text| text.trim_start().starts_with('<'))?;
    station_xml(text).ok().filter(|found| !found.is_empty())
}

/// Groups records into motions.
///
/// Records form one motion if they are compatible and together have at most [`COMPONENTS`] channels. If all records
/// together do not form one motion, they are grouped by file name ([`group_files`]). The records of a group that does
/// not form one motion stay separate.
fn records_of(records: Vec<Record>) -> Vec<Vec<Record>> {
    let whole = |records: &[Record]| {
        records.iter().map(|record| record.channels.len()).sum::<usize>() <= COMPONENTS
            && Record::gather(records).is_ok()
    };
    if whole(&records) {
        return vec![records];
    }
    let names: Vec<String> = records.iter().map(|record| record.file.clone()).collect();
    let mut all = Vec::new();
    for group in group_files(&names) {
        let of_group = |record: &&Record| group.files.contains(&record.file);
        let group: Vec<Record> = records.iter().filter(of_group).cloned().collect();
        if whole(&group) {
            all.push(group);
        } else {
            all.extend(group.into_iter().map(|record| vec![record]));
        }
    }
    all
}

impl Motion {
    /// Returns the motion of compatible records, and the bytes of a file that combines them.
    ///
    /// `described` is `true` if station files describe the records. Otherwise, a single record needs no new file, since
    /// the given file contains all its data; the bytes are then empty.
    fn of(records: &[Record], described: bool) -> Result<(Self, Vec<u8>), String> {
        let files: Vec<String> = records.iter().map(|record| record.file.clone()).collect();
        let said = |record: &Record| -> Vec<String> {
            let said = |channel: &Channel| format!("{} {}", record.file, role(channel));
            record.channels.iter().map(said).collect()
        };
        let channels = records.iter().flat_map(said).collect();
        let (name, bytes) = match files.as_slice() {
            [file] if !described => (file.clone(), Vec::new()),
            _ => {
                let mut record = Record::gather(records).map_err(|error| error.to_string())?;
                record.cut_to_shortest();
                let text = write::text(&record).map_err(|error| error.to_string())?;
                (name_of(&files), text.into_bytes())
            }
        };
        Ok((Self { name, files, channels, length: bytes.len() }, bytes))
    }
}

/// Returns a name for a combined file: the common prefix of the names, or the first name.
fn name_of(files: &[String]) -> String {
    let first = files.first().map_or("", String::as_str);
    let same = |end: &usize| files.iter().all(|file| file.starts_with(&first[..*end]));
    let ends = (0..=first.len()).rev().filter(|end| first.is_char_boundary(*end));
    let stem = ends.clone().find(same).map_or("", |end| &first[..end]);
    let stem = stem.trim_end_matches(|c: char| !c.is_alphanumeric());
    let whole = first.rsplit_once('.').map_or(first, |(stem, _)| stem);
    format!("{}-set.txt", if files.len() == 1 || stem.len() < 3 { whole } else { stem })
}

/// Returns the role of a channel in words.
fn role(channel: &Channel) -> String {
    let direction = match channel.direction.azimuth {
        _ if channel.is_vertical() => "is up and down".to_owned(),
        Some(azimuth) => format!("is horizontal, {azimuth:.0}° from north"),
        None => "is horizontal".to_owned(),
    };
    format!("({}) {direction}", channel.name)
}

impl Refused {
    fn of(file: &str, error: &ReadError) -> Self {
        let missing = match error.refusal {
            Refusal::Missing(Given::Unit) => Some("unit"),
            Refusal::Missing(Given::Step) => Some("step"),
            Refusal::Missing(Given::Sensitivity) => Some("sensitivity"),
            Refusal::Missing(Given::UnitOrSensitivity) => Some("unit or sensitivity"),
            Refusal::Unrecognized
            | Refusal::NotAcceleration
            | Refusal::Damaged
            | Refusal::OtherInstrument
            | Refusal::SeveralRecords
            | Refusal::Options => None,
        };
        Self { file: file.to_owned(), why: error.to_string(), missing }
    }
}
