//! Reader of CSMNC files (China Strong Motion Networks Center): a header of sixteen lines, then
//! values separated by blanks.
//!
//! Times are Beijing time (BTM, UTC+8).

use super::source::{LARGEST_ACCELERATION, Source, latin1, leading_number, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::{Site, position};
use crate::units::AccelerationUnit;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "csmnc", title: "CSMNC text (China)", sniff, read };

const MOST_HEADER_LINES: usize = 24;
/// Offset of Beijing time from universal time (s).
const BEIJING: f64 = 8.0 * 3600.0;

fn line_with(source: &Source<'_>, key: &str) -> Option<usize> {
    (0..MOST_HEADER_LINES).find(|&line| source.has(line, key))
}

fn sniff(source: &Source<'_>) -> bool {
    ["NO. OF POINTS", "EQUALLY SPACED INTERVALS OF", "UNIT:", "PEAK VALUE"]
        .iter()
        .all(|key| line_with(source, key).is_some())
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let need = |key: &str| {
        line_with(source, key).ok_or_else(|| source.header((), format!("\"{key}\""), "none"))
    };
    let number = |line: usize, key: &str, what: &str| {
        source
            .number_after(line, key)
            .ok_or_else(|| source.header(line, what, quoted(&source.text(line))))
    };
    let unit_line = need("UNIT:")?;
    let (_, word) = source.word_after(unit_line, "UNIT:").unwrap_or_default();
    let unit = word.parse::<AccelerationUnit>().ok().filter(|_| source.has(unit_line, "ACCEL"));
    let unit = unit.ok_or_else(|| {
        source.not_acceleration(
            unit_line,
            "acceleration in a unit such as CM/SEC/SEC",
            quoted(&source.text(unit_line)),
            "give the acceleration file of the same component",
        )
    })?;
    let count_line = need("NO. OF POINTS")?;
    let count = number(count_line, "NO. OF POINTS", "a number of points")?;
    let count = super::whole(source, count_line, "a number of points", count)?;
    let time_step = number(count_line, "INTERVALS OF", "a step (s)")?;
    let peak_line = need("PEAK VALUE")?;
    check_duration(source, peak_line, count, time_step)?;
    let numbers = |line: usize| {
        let mut row = Vec::new();
        source.tokens(line, f64::INFINITY, &mut row).map_or(0, |()| row.len())
    };
    let below = peak_line + 1..source.lines.len();
    // A header line may consist of a single number, such as the number of the record. If there is
    // one value per line, only as many lines as the header states are values.
    let first = below
        .clone()
        .find(|&line| numbers(line) > 1)
        .or_else(|| below.clone().rev().take_while(|&line| numbers(line) == 1).take(count).last())
        .ok_or_else(|| source.cut(format!("{count} values"), "none"))?;
    let limit = LARGEST_ACCELERATION / unit.factor();
    let mut values = source.all_tokens(first, source.lines.len(), limit)?;
    let raw = source.has(unit_line, "UNCORRECTED");
    let stage = if raw { Stage::Raw } else { Stage::Corrected };
    let mut record = Record::new(FORMAT.name, source.name, stage);
    let used = super::check_count(source, &mut record, count_line, count, values.len())?;
    values.truncate(used);
    for value in &mut values {
        *value *= unit.factor();
    }
    let after = |key: &str| {
        let line = line_with(source, key)?;
        let at = source.find(line, key)? + key.len();
        Some(latin1(&source.raw(line)[at..]).trim_start_matches([':', '.', ' ']).trim().to_owned())
    };
    let name =
        after("COMP").filter(|name| !name.is_empty()).unwrap_or_else(|| "channel 1".to_owned());
    let mut channel = Channel::new(name.clone(), Direction::parse(&name), time_step, values);
    channel.state_peak(source.printed_after(peak_line, "PEAK VALUE"), unit.factor());
    channel.start = after("RECORDER TIME")
        .and_then(|text| Utc::in_header(&text, DateOrder::DayFirst))
        .map(|beijing| beijing.later(-BEIJING));
    let station = after("STATION").unwrap_or_default();
    let point = after("OBSERVING POINT").unwrap_or_default();
    channel.site =
        Site { sensor: point.to_ascii_lowercase(), ..Site::default() }.at(position(&station));
    station.split_whitespace().next().unwrap_or_default().clone_into(&mut record.station);
    let magnitude = after("MAGNITUDE").unwrap_or_default();
    let scale = magnitude.split(['(', ')']).nth(1).unwrap_or_default();
    let depth = line_with(source, "EPICENTER").and_then(|line| source.number_after(line, "DEPTH"));
    record.earthquake = Earthquake::of_magnitude([(scale, leading_number(magnitude.as_bytes()))])
        .at(after("EPICENTER").and_then(|text| position(&text)), depth);
    let title = line_with(source, "EPICENTER").and_then(|line| line.checked_sub(1));
    record.event = title.map(|line| source.text(line)).unwrap_or_default();
    record.channels.push(channel);
    Ok(record)
}

/// Checks that the number of samples and the time step agree with the stated duration. A difference
/// of one time step plus one unit of the last printed digit is allowed, because publishers count
/// samples and round the duration differently.
fn check_duration(
    source: &Source<'_>,
    line: usize,
    count: usize,
    time_step: f64,
) -> Result<(), ReadError> {
    let Some(stated) = source.printed_after(line, "DURATION") else { return Ok(()) };
    let length = count as f64 * time_step;
    let slack = 1.01 * time_step + stated.resolution;
    if stated.value <= 0.0 || (length - stated.value).abs() <= slack {
        return Ok(());
    }
    Err(source.damaged(
        line,
        format!("a duration of {length:.3} s ({count} points at a step of {time_step} s)"),
        format!("a duration of {} s", stated.value),
        "the header contradicts itself; get the file again from its source",
    ))
}
