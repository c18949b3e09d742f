//! Reader of BHRC files (Iran): one block in the volume 1 layout per component, with values as
//! `10E13.6` in g/10, closed by `/&`.
//!
//! Spec: header lines of files from the Iran Strong Motion Network (Building and Housing Research
//! Center); the layout descends from CDMG volume 1 with equally spaced values.

use super::source::{Columns, LARGEST_ACCELERATION, Source, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::{Site, position};
use crate::units::AccelerationUnit;

pub(crate) const FORMAT: Format =
    Format { name: "bhrc", title: "BHRC (Iran) volume 1", sniff, read };

/// Number of header lines: 13 of text, 7 of integers, 7 of reals.
const HEADER_LINES: usize = 27;

fn sniff(source: &Source<'_>) -> bool {
    source.find(0, "VOL1DS FILE").is_some_and(|at| at < 6)
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    source.each_block(|line| read_component(source, &mut record, line))?;
    Ok(record)
}

fn read_component(
    source: &Source<'_>,
    record: &mut Record,
    first: usize,
) -> Result<usize, ReadError> {
    let mark = "\"* VOL1DS FILE\" at the start of a component";
    source.require_mark(first, "VOL1DS FILE", mark)?;
    let count_line = first + 10;
    let stated = source
        .number_after(count_line, "POINTS")
        .zip(source.number_after(count_line, "DURATION"))
        .ok_or_else(|| {
            source.header(
                count_line.min(source.lines.len().saturating_sub(1)),
                "number of points and duration",
                quoted(&source.text(count_line)),
            )
        })?;
    let count = super::whole(source, count_line, "a number of points", stated.0)?;
    // The stated duration is the number of samples times the time step: it includes a time step
    // after the last sample.
    let time_step = stated.1 / stated.0;
    if !source.has(first + 11, "G/10") {
        return Err(source.not_acceleration(
            first + 11,
            "\"UNITS ARE SECONDS AND G/10\"",
            quoted(&source.text(first + 11)),
            "give the volume 1 acceleration file",
        ));
    }
    let unit = AccelerationUnit::TenthG;
    let (mut values, next) = source.counted(
        record,
        first + HEADER_LINES,
        count,
        Columns::new(10, 13),
        LARGEST_ACCELERATION / unit.factor(),
    )?;
    for value in &mut values {
        *value *= unit.factor();
    }
    let name = source.text(first + 4);
    let about = source.text(first + 7);
    if record.channels.is_empty() {
        about.split("Station").next().unwrap_or("").trim().clone_into(&mut record.station);
        record.event = source.text(first + 8);
    }
    let direction = match azimuth(&about, &name) {
        Some(azimuth) => Direction::horizontal(azimuth),
        None => Direction::parse(&name),
    };
    let mut channel = Channel::new(name, direction, time_step, values);
    let elevation = source.number_after(first + 7, "Altitude");
    channel.site = Site { elevation, ..Site::default() }.at(position(&about));
    record.channels.push(channel);
    source.end_of_channel(next, "VOL1DS FILE")
}

/// Parses an azimuth from text such as `Azimuth L 50    T 140`; either component may be missing.
fn azimuth(text: &str, component: &str) -> Option<f64> {
    let mut words = text.split("Azimuth").nth(1)?.split_whitespace();
    while let Some(word) = words.next() {
        if word.eq_ignore_ascii_case(component) {
            return words.next()?.parse().ok().filter(|a| (0.0..=360.0).contains(a));
        }
    }
    None
}
