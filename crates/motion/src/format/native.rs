//! Reader of this crate's text format: `# key: value` lines, then one column per channel.
//!
//! Spec: [`crate::write::text`] writes the format; its module documentation explains each key.

use super::source::{LARGEST_ACCELERATION, Source, parse_number, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::units::AccelerationUnit;
use crate::utc::Utc;
use crate::write::TITLE;

pub(crate) const FORMAT: Format =
    Format { name: "barrelstack", title: "plain text form of this crate", sniff, read };

fn sniff(source: &Source<'_>) -> bool {
    written(source, 0).starts_with("# barrelstack motion")
}

/// Returns the trimmed text of a line, decoded as UTF-8, or as Latin-1 if it is not valid UTF-8.
fn written(source: &Source<'_>, line: usize) -> String {
    std::str::from_utf8(source.raw(line))
        .map_or_else(|_| source.text(line), |t| t.trim().to_owned())
}

fn field(source: &Source<'_>, end: usize, key: &str) -> Option<(usize, String)> {
    (0..end).find_map(|line| {
        let text = written(source, line);
        let (name, value) = text.strip_prefix('#')?.split_once(':')?;
        (name.trim() == key).then(|| (line, value.trim().to_owned()))
    })
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let end = (0..source.lines.len())
        .find(|&line| !written(source, line).starts_with('#'))
        .ok_or_else(|| source.cut("rows of numbers after the header", "none"))?;
    described(source, end, |names, limit| {
        super::rows(source, end, source.lines.len(), names.len(), limit)
    })
}

/// Builds the record described by the header in the lines before `end`. The function `columns` receives the names of
/// the channels and the largest valid value of a sample; it returns the samples of each channel, in the unit that the
/// header states.
pub(super) fn described(
    source: &Source<'_>,
    end: usize,
    columns: impl FnOnce(&[&str], f64) -> Result<Vec<Vec<f64>>, ReadError>,
) -> Result<Record, ReadError> {
    let refuse = |line: usize, expected: &str, found: &str| {
        source.damaged(line, expected, quoted(found), "correct the header line")
    };
    if written(source, 0) != TITLE {
        return Err(refuse(0, &format!("\"{TITLE}\""), &written(source, 0)));
    }
    let need = |key: &str| {
        field(source, end, key).ok_or_else(|| {
            source.damaged(
                end.saturating_sub(1),
                format!("a line \"# {key}: ...\" in the header, which ends here"),
                "none",
                "add the line",
            )
        })
    };
    let (line, text) = need("unit")?;
    let unit: AccelerationUnit = text
        .parse()
        .map_err(|_| refuse(line, "g, g/10, m/s2, cm/s2, mm/s2, ft/s2 or in/s2", &text))?;
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
            None => return Err(refuse(line, "channel names separated by commas", &text)),
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
    let places = places(source, end, channels.len())?;
    let limit = LARGEST_ACCELERATION / unit.factor();
    let names: Vec<&str> = channels.iter().map(|(name, _)| name.as_str()).collect();
    let columns = columns(&names, limit)?;
    let mut record = Record::new(FORMAT.name, source.name, stage);
    record.station = field(source, end, "station").map(|(_, text)| text).unwrap_or_default();
    record.event = field(source, end, "event").map(|(_, text)| text).unwrap_or_default();
    for text in (0..end).map(|line| written(source, line)) {
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
        (channel.start, channel.site) = places.get(k).cloned().unwrap_or_default();
        record.channels.push(channel);
    }
    Ok(record)
}

/// Reads the start and site of every channel, from one line for all channels or one line per
/// channel.
fn places(
    source: &Source<'_>,
    end: usize,
    channels: usize,
) -> Result<Vec<(Option<Utc>, Site)>, ReadError> {
    let (mut found, mut last) = (Vec::new(), 0);
    for line in 0..end {
        let text = written(source, line);
        let Some(words) = text.strip_prefix("# recorded:") else { continue };
        last = line;
        found.push(place(words).ok_or_else(|| {
            source.damaged(
                line,
                "start, latitude, longitude, elevation, vs30, sensor or station, separated by \
                 commas",
                quoted(words),
                "correct the header line",
            )
        })?);
    }
    match found.len() {
        1 => Ok(vec![found.remove(0); channels]),
        count if count == 0 || count == channels => Ok(found),
        count => Err(source.damaged(
            last,
            format!(
                "one line \"# recorded:\" for all channels, or one line for each of the {channels} channels"
            ),
            format!("{count} such lines"),
            "correct the header lines",
        )),
    }
}

/// Parses a start and a site, such as
/// `start 2014-08-24T10:20:33.000Z, latitude 38.27, longitude -122.28, sensor surface`.
fn place(words: &str) -> Option<(Option<Utc>, Site)> {
    let (mut start, mut site) = (None, Site::default());
    for part in words.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let (key, value) = part.split_once(' ')?;
        let number = || parse_number(value.as_bytes());
        match key {
            "start" => start = Some(value.parse().ok()?),
            "latitude" => site.latitude = Some(number()?),
            "longitude" => site.longitude = Some(number()?),
            "elevation" => site.elevation = Some(number()?),
            "vs30" => site.vs30 = Some(number()?),
            "sensor" => value.trim().clone_into(&mut site.sensor),
            "station" => value.trim().clone_into(&mut site.station),
            _ => return None,
        }
    }
    Some((start, site))
}
