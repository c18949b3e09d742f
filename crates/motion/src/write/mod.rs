//! Writers of ground-motion files: PEER AT2, CSV, NumPy archives and this crate's own text format.
//!
//! Every writer takes a [`Record`]. The notes of the record are the provenance and are written into
//! the header. Channels are written side by side, cut to the length of the shortest channel. AT2
//! has no field for the velocity at the first sample ([`crate::Channel::initial_velocity`]); this
//! velocity is written into the title, and a record that is read from the file starts from rest.
//! All other formats keep the velocity.

mod at2;
mod csv;
mod npz;
mod text;

pub use at2::at2;
pub(crate) use at2::{NO_EVENT, NO_STATION};
pub use csv::csv;
pub(crate) use csv::{FIRST_LINE, INITIAL_VELOCITY};
pub(crate) use npz::array_name;
pub use npz::{archive, npz};
pub(crate) use text::TITLE;
pub use text::text;

use crate::error::MotionError;
use crate::join::require_step;
use crate::record::{Channel, Record};

/// Largest number of provenance lines in a header. The number is limited, because readers look for
/// numbers only in the first lines of a file.
const MOST_NOTES: usize = 40;

/// Returns the common time step (s) of all channels and the number of samples of the shortest
/// channel.
fn common(record: &Record) -> Result<(f64, usize), MotionError> {
    let Some(first) = record.channels.first() else {
        return Err(MotionError::parameter("channels to write", "at least 1", 0));
    };
    for other in &record.channels[1..] {
        require_step(first, other, "write one component at a time")?;
    }
    let rows = record.channels.iter().map(|channel| channel.acceleration.len()).min().unwrap_or(0);
    Ok((first.time_step, rows))
}

/// Formats the initial velocities (m/s) of all channels, separated by spaces; returns `None` if all are zero.
fn initial_velocities(record: &Record) -> Option<String> {
    let some = record.channels.iter().any(|channel| channel.initial_velocity != 0.0);
    let all = record.channels.iter().map(|c| format!("{:e}", c.initial_velocity));
    some.then(|| all.collect::<Vec<_>>().join(" "))
}

/// Joins a string to one line: replaces each control character and each run of white space by one space, and trims both
/// ends.
fn line(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Keywords by which readers of other formats recognize their files.
const FOREIGN: [&str; 4] = ["NPTS", "RAW PGA", "ARCHIVO EST", "GNS SCIENCE"];

/// Inserts a hyphen into each of `words`, after the second letter, so that the words remain legible
/// but are no longer recognized as keywords.
fn broken(text: &str, words: &[&str]) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let starts = |word: &&&str| {
            rest.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
        };
        let length = if let Some(word) = words.iter().find(starts) {
            out.push_str(&rest[..2]);
            out.push('-');
            out.push_str(&rest[2..word.len()]);
            word.len()
        } else {
            out.push(first);
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    out
}

/// Returns the provenance, one step per line. If there are too many steps, the last line contains
/// all remaining steps.
fn provenance(record: &Record) -> Vec<String> {
    let mut notes: Vec<String> = record
        .notes
        .iter()
        // Notes that were read from a header of this crate already have the prefix.
        .map(|note| line(note.strip_prefix("processing: ").unwrap_or(note)))
        .collect();
    if notes.len() > MOST_NOTES {
        let rest = notes.split_off(MOST_NOTES - 1).join("; ");
        notes.push(rest);
    }
    notes
}

/// Returns unique channel names that contain no separators.
fn names(channels: &[Channel]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (k, channel) in channels.iter().enumerate() {
        let plain = line(&channel.name.replace([',', ';', '(', ')', '#'], " "));
        let base = if plain.is_empty() { format!("channel {}", k + 1) } else { plain };
        let mut name = base.clone();
        let mut count = 1;
        while names.contains(&name) {
            count += 1;
            name = format!("{base} {count}");
        }
        names.push(name);
    }
    names
}
