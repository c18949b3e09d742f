//! Writers of motion files: PEER AT2, CSV, NumPy archives and the crate's own text form.
//!
//! Every writer takes a [`Record`]; its notes are the provenance and go into the header.
//! Channels stand side by side, cut to the shortest.
//! AT2 has no place for a velocity at the first sample ([`crate::Channel::initial_velocity`]): it
//! stands in the title, and what is read back starts from rest. All other forms keep it.

mod at2;
mod csv;
mod npz;
mod text;

pub use at2::at2;
pub(crate) use csv::INITIAL_VELOCITY;
pub use csv::csv;
pub(crate) use npz::array_name;
pub use npz::{archive, npz};
pub(crate) use text::TITLE;
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

/// Words by which files of other formats are known.
const FOREIGN: [&str; 4] = ["NPTS", "RAW PGA", "ARCHIVO EST", "GNS SCIENCE"];

/// A text with a hyphen behind the second letter of each of `words`: still legible, the word no more.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::Direction;
    use crate::format::{ReadOptions, read};
    use crate::record::Stage;

    /// Words that headers use for themselves, in every place where a text can stand.
    fn hostile(channels: Vec<Channel>) -> Record {
        let mut record = Record::new("columns", "a, b (c).csv", Stage::Corrected);
        record.event = "NPTS= 3, DT= 9 SEC (spectrum), units of cm/s\nvelocity".to_owned();
        record.station = "# unit: g, \u{3b1} displacement; 1 2 3".to_owned();
        record.channels = channels;
        record.notes = vec![
            "processing: response spectrum in units of g, NPTS, DT".to_owned(),
            "# time_step: 7\r\n1.0 2.0 3.0".to_owned(),
            "acceleration (cm/s2), counts per degree".to_owned(),
        ];
        record
    }

    fn channel(name: &str, direction: Direction) -> Channel {
        // Subnormal, tiny, negative zero and long fractions must survive.
        let values = vec![1.0 / 3.0, -0.0, 5e-324, -2.5e-9, 12.25, -1.0 / 7.0, 0.0];
        Channel::new(name, direction, 0.1 / 3.0, values)
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn text_reads_back_bit_for_bit_whatever_the_header_says() {
        let record = hostile(vec![
            channel("a, (b); #c", Direction::horizontal(33.3)),
            channel("a, (b); #c", Direction::up()),
            channel("", Direction::some_horizontal()),
        ]);
        let text = text(&record).unwrap();
        let again = read(text.as_bytes(), "again.txt", &ReadOptions::default()).unwrap();
        assert_eq!(again.stage, Stage::Corrected);
        assert_eq!(again.channels.len(), 3);
        for (old, new) in record.channels.iter().zip(&again.channels) {
            assert_eq!(bits(&old.acceleration), bits(&new.acceleration));
            assert_eq!(old.time_step.to_bits(), new.time_step.to_bits());
            assert_eq!(old.direction, new.direction);
        }
        let names: Vec<&str> = again.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["a b c", "a b c 2", "channel 3"]);
        assert_eq!(again.notes.len(), 3);
        // Written again it is the same file: the past is not told twice.
        assert_eq!(super::text(&again).unwrap().lines().count(), text.lines().count());
    }

    #[test]
    fn csv_reads_back_whatever_the_header_says() {
        let record = hostile(vec![
            channel("N28W", Direction::parse("N28W")),
            channel("UP", Direction::up()),
        ]);
        let text = csv(&record).unwrap();
        let again = read(text.as_bytes(), "again.csv", &ReadOptions::default()).unwrap();
        for (old, new) in record.channels.iter().zip(&again.channels) {
            assert_eq!(bits(&old.acceleration), bits(&new.acceleration));
            // Times are rounded to a nanosecond: measured 2e-9.
            assert!((new.time_step / old.time_step - 1.0).abs() < 1e-8, "{}", new.time_step);
            assert_eq!(old.direction, new.direction);
        }
    }

    #[test]
    fn at2_reads_back_whatever_the_header_says() {
        for (name, direction) in [
            ("N28W", Direction::parse("N28W")),
            ("a name, far too long (for this)", Direction::horizontal(44.4)),
            ("velocity", Direction::up()),
            ("", Direction::default()),
        ] {
            let record = hostile(vec![channel(name, direction)]);
            let text = at2(&record).unwrap();
            assert!(text.is_ascii());
            let again = read(text.as_bytes(), "again.at2", &ReadOptions::default()).unwrap();
            let (old, new) = (&record.channels[0], &again.channels[0]);
            assert_eq!(old.time_step.to_bits(), new.time_step.to_bits());
            assert_eq!(new.direction.azimuth, direction.azimuth, "{name}");
            assert_eq!(new.is_vertical(), old.is_vertical(), "{name}");
            for (a, b) in old.acceleration.iter().zip(&new.acceleration) {
                // Eight digits: half a unit of the last is 5e-8 of a number that starts with 1.
                assert!((a - b).abs() <= 5.1e-8 * a.abs() + 1e-97, "{a} {b}");
            }
        }
    }

    #[test]
    fn at2_has_columns_of_fifteen() {
        let record = hostile(vec![channel("90", Direction::horizontal(90.0))]);
        let text = at2(&record).unwrap();
        let rows: Vec<&str> = text.lines().skip(4).collect();
        assert_eq!(rows.iter().map(|row| row.len()).collect::<Vec<_>>(), [75, 30]);
        assert!(at2(&hostile(vec![])).is_err());
    }

    #[test]
    fn channels_of_different_steps_are_refused() {
        let mut other = channel("UP", Direction::up());
        other.time_step = 0.02;
        let record = hostile(vec![channel("90", Direction::horizontal(90.0)), other]);
        for error in [text(&record).err(), csv(&record).err(), npz(&record).err()] {
            assert!(error.unwrap().to_string().contains("one component at a time"));
        }
    }

    #[test]
    fn a_long_past_leaves_room_for_the_numbers() {
        let mut record = hostile(vec![channel("90", Direction::horizontal(90.0))]);
        record.notes = (0..500).map(|k| format!("step {k}")).collect();
        for written in [text(&record).unwrap(), csv(&record).unwrap()] {
            assert!(written.contains("step 499"));
            let again = read(written.as_bytes(), "again", &ReadOptions::default()).unwrap();
            assert_eq!(again.channels[0].acceleration.len(), 7);
        }
    }
}
