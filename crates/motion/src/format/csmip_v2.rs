//! Reader of CSMIP volume 2: corrected acceleration, velocity and displacement. Volume 3 spectra
//! are refused.
//!
//! A channel has 25 text lines, 7 lines of integers (16I5), 13 lines of reals, then three blocks,
//! each with a data line. Spec: Shakal, Huang and Rojahn 1985, CSMIP report OSMS 85-03.

use super::cdmg::{channel_name, format_in, holds_integers, start, stated_start, station_name};
use super::source::{Columns, GAL, LARGEST_ACCELERATION, Source, leading_number, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::math;
use crate::record::{Channel, Quantity, Record, Stage};
use crate::site::{Site, position};
use crate::units::AccelerationUnit;

pub(crate) const FORMAT: Format =
    Format { name: "csmip-v2", title: "CSMIP/CDMG/CGS volume 2 (corrected)", sniff, read };

const TEXT_LINES: usize = 25;
const INTEGER_LINES: usize = 7;
/// Number of header lines: text, integers and reals.
const HEADER_LINES: usize = 45;

fn sniff(source: &Source<'_>) -> bool {
    (source.find(0, "CORRECTED ACCELEROGRAM").is_some_and(|at| at < 2) && holds_integers(source))
        || source.has(0, "RESPONSE AND FOURIER AMPLITUDE SPECTRA")
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    if source.has(0, "SPECTRA") {
        return Err(source.not_acceleration(
            0,
            "a volume 2 accelerogram",
            "a volume 3 file of response and Fourier spectra",
            "give the volume 2 file of the same record",
        ));
    }
    let mut record = Record::new(FORMAT.name, source.name, Stage::Corrected);
    source.each_block(|line| read_channel(source, hints, &mut record, line))?;
    Ok(record)
}

fn read_channel(
    source: &Source<'_>,
    hints: &Hints<'_>,
    record: &mut Record,
    first: usize,
) -> Result<usize, ReadError> {
    let mark = "\"Corrected accelerogram\" at the start of a channel";
    source.require_mark(first, "CORRECTED ACCELEROGRAM", mark)?;
    source.require_header(first, HEADER_LINES)?;
    let header = first..first + TEXT_LINES;
    if record.channels.is_empty() {
        record.event = source.text(first + 2);
    }
    // Normally line 7; if a line is missing, the first line that begins with CHAN.
    let name_line = header
        .clone()
        .find(|&line| source.text(line).to_ascii_uppercase().starts_with("CHAN"))
        .unwrap_or(first + 6);
    let name = channel_name(source, name_line);
    if record.channels.is_empty() {
        // The station is normally on the line before the channel name.
        record.station = station_name(source, name_line.saturating_sub(1));
    }
    let (accelerations, mut next) =
        read_block(source, record, first + HEADER_LINES, "acc", LARGEST_ACCELERATION * 1000.0)?
            .ok_or_else(|| {
                source.not_acceleration(
                    first + HEADER_LINES,
                    "a line such as \"7500 points of accel data equally spaced at .010 sec\"",
                    quoted(&source.text(first + HEADER_LINES)),
                    "give the file that holds the accelerations",
                )
            })?;
    let unit = unit(source, first + HEADER_LINES, hints)?;
    let step = time_step(source, first, first + HEADER_LINES)?;
    let values: Vec<f64> = accelerations.iter().map(|value| value * unit.factor()).collect();
    let mut channel = Channel::new(name.as_str(), Direction::parse(&name), step, values);
    channel.start = start(source, first);
    if let Some((line, stated)) = stated_start(source, first) {
        record.warn_of_start(line, stated.trim(), channel.start);
    }
    channel.site = Site::default().at(position(&source.text(name_line.saturating_sub(2))));
    let peak = math::peak(&channel.acceleration);
    let mut measured = vec![("accel", Quantity::Acceleration, unit.factor(), peak)];
    for (word, quantity) in [("veloc", Quantity::Velocity), ("displ", Quantity::Displacement)] {
        if let Some((block, after)) = read_block(source, record, next, &word[..3], 1e9)? {
            measured.push((word, quantity, GAL, GAL * math::peak(&block)));
            next = after;
        }
    }
    for (word, quantity, factor, measured) in measured {
        let stated = header
            .clone()
            .filter(|&line| source.text(line).to_ascii_uppercase().starts_with("PEAK"))
            .find(|&line| source.has(line, word))
            .and_then(|line| source.printed_after(line, "="));
        channel.state(quantity, stated, factor, measured);
    }
    let mut header = header;
    if let Some(velocity) = header.find_map(|line| source.number_after(line, "INITIAL VELOCITY")) {
        channel.initial_velocity = 0.01 * velocity;
    }
    record.channels.push(channel);
    source.end_of_channel(next, "CORRECTED ACCELEROGRAM")
}

/// Reads one block of the quantity `key` (acc, vel, dis), if the given line is the data line of
/// such a block.
fn read_block(
    source: &Source<'_>,
    record: &mut Record,
    line: usize,
    key: &str,
    limit: f64,
) -> Result<Option<(Vec<f64>, usize)>, ReadError> {
    if !source.has(line, "points") || !source.has(line, key) {
        return Ok(None);
    }
    let Some(count) = leading_number(source.raw(line)) else { return Ok(None) };
    let count = super::whole(source, line, "a number of points", count)?;
    let columns = format_in(source, line).unwrap_or(Columns::new(8, 10));
    source.counted(record, line + 1, count, columns, limit).map(Some)
}

fn unit(
    source: &Source<'_>,
    line: usize,
    hints: &Hints<'_>,
) -> Result<AccelerationUnit, ReadError> {
    if source.has(line, "cm/s") {
        return Ok(AccelerationUnit::Gal);
    }
    let stated = source.unit_after(line, &["in ", "units: ", "units of "]);
    stated.or_else(|| hints.unit()).ok_or_else(|| {
        source.error(
            line,
            Refusal::Missing(Given::Unit),
            "a unit of acceleration on the data line",
            quoted(&source.text(line)),
            "state the unit (cm/s2 by the rules of this format)",
        )
    })
}

/// Returns the time step (s). The data line states the step, and real number 61 of the header may state it with more
/// digits. Returns the number from the header if the two agree within the printed digits. Otherwise, returns the number
/// on the data line.
fn time_step(source: &Source<'_>, first: usize, data: usize) -> Result<f64, ReadError> {
    let printed = source
        .printed_after(data, "spaced at")
        .or_else(|| source.printed_after(data, "at"))
        .filter(|printed| printed.value > 0.0)
        .ok_or_else(|| {
            source.damaged(
                data,
                "the step, such as \"equally spaced at .010 sec\"",
                quoted(&source.text(data)),
                "restore the line from the original file",
            )
        })?;
    let line = first + TEXT_LINES + INTEGER_LINES + 7;
    let real = super::source::parse_number(source.slice(line, 40, 10));
    Ok(match real {
        Some(step) if (step - printed.value).abs() <= 0.5 * printed.resolution && step > 0.0 => {
            step
        }
        _ => printed.value,
    })
}
