//! Writes this crate's own text format at full precision, so that it reads back with the same bits.
//!
//! ```text
//! # barrelstack motion 1
//! # station: Napa College, Napa
//! # event: South Napa, 2014-08-24, M 6.0
//! # processing: one line for every step that was done
//! # stage: raw, corrected or unknown
//! # unit: m/s2
//! # time_step: 0.005
//! # channels: E az=90, N az=0, UP vertical
//! 1.2345e-3 -2.3456e-4 0e0
//! ```
//!
//! There is one column per channel. Numbers have the fewest digits that read back to the same
//! double.
//!
//! `# recorded:` states the start (UTC), location and sensor, in one line for all channels or in
//! one line for each channel (wrapped here):
//!
//! ```text
//! # recorded: start 2014-08-24T10:20:33.000Z, latitude 38.27, longitude -122.28, elevation 12,
//!             vs30 330, sensor surface, station Napa
//! ```
//!
//! Unknown values are omitted. `# initial_velocity:` (m/s, one per channel) is written if any of
//! these velocities is not zero.
//!
//! In `# channels:`, `az=` is the azimuth (degrees clockwise from north); `vertical` means positive upward;
//! `horizontal` is a horizontal direction of unknown azimuth; a name alone means that the direction is unknown.
//! `# source:`, `# attribution:` and `# licence:` are kept; other `#` lines are comments.

use std::fmt::Write as _;

use crate::direction::Orientation;
use crate::error::MotionError;
use crate::record::{Channel, Record};

/// First line of every file in this format.
pub(crate) const TITLE: &str = "# barrelstack motion 1";

/// Writes a record in this crate's own text format. [`crate::read`] restores the accelerations and
/// the initial velocities bit for bit.
///
/// ```
/// use barrelstack_motion::{ReadOptions, bundled, read, write};
/// let napa = bundled("napa-college-2014").unwrap();
/// let text = write::text(&napa)?;
/// let again = read(text.as_bytes(), "copy.txt", &ReadOptions::default()).unwrap();
/// assert_eq!(again.channels, napa.channels);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
///
/// # Errors
/// If the record has no channel or the time steps differ.
pub fn text(record: &Record) -> Result<String, MotionError> {
    let (step, rows) = super::common(record)?;
    let mut text = format!("{TITLE}\n");
    for (key, value) in head(record, step) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "# {key}: {value}");
    }
    for row in 0..rows {
        for (k, channel) in record.channels.iter().enumerate() {
            let gap = if k == 0 { "" } else { " " };
            // Writing to a String cannot fail.
            let _ = write!(text, "{gap}{:e}", channel.acceleration[row]);
        }
        text.push('\n');
    }
    Ok(text)
}

/// Returns the keys and values of the header, in order.
pub(super) fn head(record: &Record, step: f64) -> Vec<(&'static str, String)> {
    let mut lines: Vec<(&'static str, String)> =
        vec![("station", record.station.clone()), ("event", record.event.clone())];
    for note in super::provenance(record) {
        match own_key(&note) {
            Some((key, value)) => lines.push((key, value.to_owned())),
            None => lines.push(("processing", note)),
        }
    }
    lines.extend(recorded(record).into_iter().map(|words| ("recorded", words)));
    lines.push(("stage", record.stage.to_string()));
    lines.push(("unit", "m/s2".to_owned()));
    lines.push(("time_step", format!("{step}")));
    let channels: Vec<String> = record
        .channels
        .iter()
        .zip(super::names(&record.channels))
        .map(|(channel, name)| with_direction(channel, &name))
        .collect();
    lines.push(("channels", channels.join(", ")));
    lines.extend(super::initial_velocities(record).map(|v| ("initial_velocity", v)));
    lines.into_iter().map(|(key, value)| (key, super::line(&value))).collect()
}

/// Returns the start and the location of the channels: one line if all channels share them, else
/// one line per channel; empty if nothing is known.
fn recorded(record: &Record) -> Vec<String> {
    let words = |channel: &Channel| {
        let site = &channel.site;
        let number = |key: &str, value: Option<f64>| value.map(|value| format!("{key} {value}"));
        let text = |key: &str, value: &str| {
            let value = super::line(&value.replace(',', " "));
            (!value.is_empty()).then(|| format!("{key} {value}"))
        };
        let other = site.station != record.station;
        let parts = [
            channel.start.map(|start| format!("start {start}")),
            number("latitude", site.latitude),
            number("longitude", site.longitude),
            number("elevation", site.elevation),
            number("vs30", site.vs30),
            text("sensor", &site.sensor),
            other.then(|| text("station", &site.station)).flatten(),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    };
    let mut all: Vec<String> = record.channels.iter().map(words).collect();
    if all.iter().all(|words| *words == all[0]) {
        all.truncate(usize::from(!all[0].is_empty()));
    }
    all
}

/// Splits a note such as `source: NAME` into key and text, if a header of this format has a line
/// for the key.
fn own_key(note: &str) -> Option<(&'static str, &str)> {
    ["source", "attribution", "licence"]
        .into_iter()
        .find_map(|key| Some((key, note.strip_prefix(key)?.strip_prefix(": ")?)))
}

fn with_direction(channel: &Channel, name: &str) -> String {
    match (channel.direction.azimuth, channel.direction.orientation) {
        (Some(azimuth), _) => format!("{name} az={azimuth}"),
        (None, Some(Orientation::Vertical)) => format!("{name} vertical"),
        (None, Some(Orientation::Horizontal)) => format!("{name} horizontal"),
        (None, None) => name.to_owned(),
    }
}
