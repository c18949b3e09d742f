//! The text form of this crate: `# key: value` lines, then one column to a channel.
//!
//! ```text
//! # barrelstack motion 1
//! # station: Napa College, Napa
//! # event: South Napa, 2014-08-24, M 6.0
//! # stage: corrected
//! # unit: m/s2
//! # time_step: 0.005
//! # channels: E az=90, N az=0, Up vertical
//! 1.2345e-3 -2.3456e-4 0
//! ```
//!
//! `# initial_velocity:` gives the velocity (m/s) at the first sample of each channel where it is not
//! zero. Other `#` lines are comments. Spec: this file; written by [`crate::write::text`].

use super::source::{LARGEST_ACCELERATION, Source, parse_number, shorten};
use super::{Format, ReadOptions};
use crate::direction::Direction;
use crate::error::{ReadError, Refusal};
use crate::record::{Channel, Record, Stage};
use crate::units::AccelerationUnit;

pub(crate) const FORMAT: Format =
    Format { name: "barrelstack", title: "plain text form of this crate", sniff, read };

const TITLE: &str = "# barrelstack motion 1";

fn sniff(source: &Source<'_>) -> bool {
    source.text(0).starts_with("# barrelstack motion")
}

fn field(source: &Source<'_>, end: usize, key: &str) -> Option<(usize, String)> {
    (0..end).find_map(|line| {
        let text = source.text(line);
        let (name, value) = text.strip_prefix('#')?.split_once(':')?;
        (name.trim() == key).then(|| (line, value.trim().to_owned()))
    })
}

fn read(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
    let end = (0..source.lines.len())
        .find(|&line| !source.text(line).starts_with('#'))
        .ok_or_else(|| source.cut("rows of numbers after the header", "none"))?;
    let refuse = |line: usize, expected: &str, found: &str| {
        source.error(
            line,
            Refusal::Damaged,
            expected,
            format!("\"{}\"", shorten(found)),
            "correct the header line",
        )
    };
    if source.text(0) != TITLE {
        return Err(refuse(0, &format!("\"{TITLE}\""), &source.text(0)));
    }
    let need = |key: &str| {
        field(source, end, key).ok_or_else(|| {
            source.error(
                (),
                Refusal::Missing,
                format!("a line \"# {key}: ...\""),
                "none",
                "add the line to the header",
            )
        })
    };
    let (line, text) = need("unit")?;
    let unit: AccelerationUnit =
        text.parse().map_err(|_| refuse(line, "g, g/10, m/s2, cm/s2 or mm/s2", &text))?;
    let (line, text) = need("time_step")?;
    let time_step = parse_number(text.as_bytes())
        .filter(|step| *step > 0.0)
        .ok_or_else(|| refuse(line, "a step above 0 (s)", &text))?;
    let (line, text) = need("channels")?;
    let mut channels = Vec::new();
    for part in text.split(',') {
        let mut words: Vec<&str> = part.split_whitespace().collect();
        let direction = match words.last().copied() {
            Some("vertical") => Some(Direction::up()),
            Some("horizontal") => Some(Direction::some_horizontal()),
            Some(word) => word
                .strip_prefix("az=")
                .and_then(|azimuth| azimuth.parse::<f64>().ok())
                .filter(|azimuth| azimuth.is_finite())
                .map(Direction::horizontal),
            None => return Err(refuse(line, "channel names between commas", &text)),
        };
        if direction.is_some() && words.len() > 1 {
            words.pop();
        }
        channels.push((words.join(" "), direction.unwrap_or_default()));
    }
    let velocities = match field(source, end, "initial_velocity") {
        None => Vec::new(),
        Some((line, text)) => super::initial_velocities(source, line, &text, channels.len())?,
    };
    let stage = match field(source, end, "stage") {
        None => Stage::Unknown,
        Some((line, text)) => match text.as_str() {
            "raw" => Stage::Raw,
            "corrected" => Stage::Corrected,
            "unknown" => Stage::Unknown,
            _ => return Err(refuse(line, "raw, corrected or unknown", &text)),
        },
    };
    let limit = LARGEST_ACCELERATION / unit.factor();
    let columns = super::rows(source, end, source.lines.len(), channels.len(), limit)?;
    let mut record = Record::new(FORMAT.name, source.name, stage);
    record.station = field(source, end, "station").map(|(_, text)| text).unwrap_or_default();
    record.event = field(source, end, "event").map(|(_, text)| text).unwrap_or_default();
    for text in (0..end).map(|line| source.text(line)) {
        for key in ["source", "attribution", "licence", "processing"] {
            if let Some(value) = text.strip_prefix(&format!("# {key}: ")) {
                record.notes.push(format!("{key}: {value}"));
            }
        }
    }
    for (k, ((name, direction), column)) in channels.into_iter().zip(columns).enumerate() {
        let values = column.iter().map(|value| value * unit.factor()).collect();
        let mut channel = Channel::new(name, direction, time_step, values);
        channel.initial_velocity = velocities.get(k).copied().unwrap_or(0.0);
        record.channels.push(channel);
    }
    Ok(record)
}
