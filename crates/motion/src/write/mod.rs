//! Writers of motion files: PEER AT2, CSV, NumPy archives and the crate's own text form.
//!
//! Every writer takes a [`Record`]; its notes are the provenance and go into the header.
//! Channels stand side by side, cut to the shortest.
//! None of the forms but the archive can hold a velocity at the first sample
//! ([`crate::Channel::initial_velocity`]): what is read back starts from rest.

mod at2;
mod csv;
mod npz;
mod text;

pub use at2::at2;
pub use csv::csv;
pub use npz::{archive, npz};
pub use text::text;

use crate::error::MotionError;
use crate::record::{Channel, Record};

/// Most lines of provenance in a header; readers look for numbers in the first lines of a file only.
const MOST_NOTES: usize = 40;

/// The step (s) of all channels and the number of samples of the shortest.
fn common(record: &Record) -> Result<(f64, usize), MotionError> {
    let Some(first) = record.channels.first() else {
        return Err(MotionError::parameter("channels to write", "at least 1", 0));
    };
    for other in &record.channels[1..] {
        if (first.time_step / other.time_step - 1.0).abs() > 1e-9 {
            return Err(MotionError::Mismatch {
                what: format!(
                    "channel {} has a step of {} s, channel {} of {} s",
                    first.name, first.time_step, other.name, other.time_step
                ),
                remedy: "write one component at a time".to_owned(),
            });
        }
    }
    let rows = record.channels.iter().map(|channel| channel.acceleration.len()).min().unwrap_or(0);
    Ok((first.time_step, rows))
}

/// A text on one line, without control characters.
fn line(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The provenance, one line each; a very long one ends with the rest on one line.
fn provenance(record: &Record) -> Vec<String> {
    let mut notes: Vec<String> = record
        .notes
        .iter()
        // Lines that were read from a header of ours already have the word in front.
        .map(|note| line(note.strip_prefix("processing: ").unwrap_or(note)))
        .collect();
    if notes.len() > MOST_NOTES {
        let rest = notes.split_off(MOST_NOTES - 1).join("; ");
        notes.push(rest);
    }
    notes
}

/// Names that can stand between commas, none twice.
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
