//! Reader of the PEER strong-motion database: AT2 accelerations. VT2 velocities and DT2
//! displacements are refused.
//!
//! A file has a few title lines, a line with quantity and unit, a line with the number of samples
//! and the time step, then values row by row. Spec: header lines of the NGA and NGA-West2 flat
//! files (Chiou et al. 2008, Earthquake Spectra 24:23-44; Ancheta et al. 2014, Earthquake Spectra
//! 30:989-1005); spellings surveyed over 2416 files.

use super::columns::facts;
use super::source::{LARGEST_ACCELERATION, Source, leading_number, leading_text, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::record::{Channel, Quantity, Record, Stage};
use crate::units::AccelerationUnit;
use crate::write::{NO_EVENT, NO_STATION};

pub(crate) const FORMAT: Format =
    Format { name: "peer", title: "PEER AT2 (NGA, NGA-West2, PEER 2000)", sniff, read };

/// Number of lines searched for the number of samples and the time step.
const HEADER_LINES: usize = 12;

struct Counts {
    line: usize,
    count: usize,
    time_step: f64,
}

fn sniff(source: &Source<'_>) -> bool {
    // Other formats state the number of samples and the time step on separate lines.
    (0..HEADER_LINES.min(source.lines.len()))
        .any(|line| source.has(line, "NPTS") && source.has(line, "DT"))
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let counts = find_counts(source)?;
    let unit = find_unit(source, counts.line, hints)?;
    let mut record = Record::new(FORMAT.name, source.name, Stage::Corrected);
    let (event, station, component) = names(source, counts.line);
    record.event = event;
    record.station = station;
    let first = counts.line + 1;
    let mut end = source.lines.len();
    while end > first && is_end_mark(source, end - 1) {
        end -= 1;
    }
    let mut start = first;
    while start < end && is_begin_mark(source, start) {
        start += 1;
    }
    let limit = LARGEST_ACCELERATION / unit.factor();
    let mut values = source.all_tokens(start, end, limit)?;
    if values.len() < counts.count
        && let Some((by_column, blanks)) = in_columns(source, start, end, limit)?
        && by_column.len() == counts.count
    {
        for (line, column) in blanks {
            record.warn(
                line + 1,
                format!("column {}: a blank field, read as 0 as in Fortran", column + 1),
            );
        }
        values = by_column;
    }
    let used = super::check_count(source, &mut record, counts.line, counts.count, values.len())?;
    values.truncate(used);
    for value in &mut values {
        *value *= unit.factor();
    }
    let direction = Direction::parse(&component);
    record.channels.push(Channel::new(component, direction, counts.time_step, values));
    Ok(record)
}

/// Positions of blank fields: line and first column, counted from 0.
type Blanks = Vec<(usize, usize)>;

/// Reads the values in fixed columns, whose width is taken from the first row. Also returns the
/// positions of blank fields. Returns `None` if the rows do not have fixed columns.
fn in_columns(
    source: &Source<'_>,
    start: usize,
    end: usize,
    limit: f64,
) -> Result<Option<(Vec<f64>, Blanks)>, ReadError> {
    let mut row = Vec::new();
    source.tokens(start, limit, &mut row)?;
    let length = source.end_of(start);
    if row.is_empty() || !length.is_multiple_of(row.len()) {
        return Ok(None);
    }
    let width = length / row.len();
    let (mut values, mut blanks) = (Vec::new(), Vec::new());
    for line in start..end {
        let last = line + 1 == end;
        let filled = if last { source.end_of(line) } else { length };
        for column in (0..filled).step_by(width) {
            let field = source.slice(line, column, width);
            if field.trim_ascii().is_empty() {
                blanks.push((line, column));
                values.push(0.0);
            } else if let Some(value) = super::source::parse_number(field) {
                values.push(source.within(line, column, value, limit)?);
            } else {
                return Ok(None);
            }
        }
        if source.end_of(line) > length {
            return Ok(None);
        }
    }
    Ok(Some((values, blanks)))
}

/// Returns `true` for a blank line, and for `*** Begin data ***` and similar lines, which precede the values in some
/// copies of PEER files.
fn is_begin_mark(source: &Source<'_>, line: usize) -> bool {
    let text = source.text(line);
    text.is_empty() || text.starts_with("***") && source.has(line, "begin")
}

fn is_end_mark(source: &Source<'_>, line: usize) -> bool {
    let text = source.text(line);
    text.is_empty() || text.starts_with("***") && source.has(line, "end")
}

/// Parses the number of samples and the time step (s) from a line such as
/// `NPTS= 2000, DT= .0200 SEC` or `4096 0.0100 NPTS, DT`.
fn find_counts(source: &Source<'_>) -> Result<Counts, ReadError> {
    let line = (0..HEADER_LINES)
        .find(|&line| source.has(line, "NPTS") && source.has(line, "DT"))
        .unwrap_or(0);
    let after = source.number_after(line, "NPTS").zip(source.number_after(line, "DT"));
    let before = leading_text(source.raw(line)).and_then(|(count, text)| {
        let rest = source.find(line, &text)? + text.len();
        leading_number(&source.raw(line)[rest..]).map(|step| (count, step))
    });
    let in_words = || facts::count_and_step(&facts::folded(source.raw(line)));
    let (count, time_step) = after.or(before).or_else(in_words).ok_or_else(|| {
        source.damaged(
            line,
            "count and step, such as \"NPTS= 2000, DT= .0200 SEC\"",
            quoted(&source.text(line)),
            "write the number of values and the step in seconds on this line, in this form",
        )
    })?;
    let count = super::whole(source, line, "a number of points", count)?;
    if !(time_step > 0.0) {
        return Err(source.header(line, "a step above 0", time_step.to_string()));
    }
    Ok(Counts { line, count, time_step })
}

fn find_unit(
    source: &Source<'_>,
    last: usize,
    hints: &Hints<'_>,
) -> Result<AccelerationUnit, ReadError> {
    for line in 0..=last {
        let stated = |quantity: &str| {
            source.find(line, quantity).is_some_and(|at| at < 4) && !source.has(line, "ACCEL")
        };
        if stated("VELOCITY") || stated("DISPLACEMENT") || source.has(line, "SPECTR") {
            return Err(source.not_acceleration(
                line,
                "an acceleration history",
                quoted(&source.text(line)),
                "give the .AT2 file of the same component",
            ));
        }
    }
    for line in 0..=last {
        for key in ["UNITS OF ", "UNITS ARE ", "UNITS: "] {
            let Some((column, word)) = source.word_after(line, key) else { continue };
            return word.parse().map_err(|_| {
                source.not_acceleration(
                    (line, column),
                    "a unit of acceleration",
                    format!("\"{word}\""),
                    "give the .AT2 file of the same component",
                )
            });
        }
    }
    // Headers of other programs state the unit in other words.
    let elsewhere = (0..=last).find_map(|line| facts::unit(&facts::folded(source.raw(line))));
    let known = AccelerationUnit::ALL.into_iter().find(|known| {
        elsewhere.is_some_and(|unit| {
            unit.quantity == Quantity::Acceleration && unit.factor == known.factor()
        })
    });
    known.or_else(|| hints.unit()).ok_or_else(|| {
        source.error(
            (),
            Refusal::Missing(Given::Unit),
            "a header line with the unit of acceleration",
            "none",
            "state the unit (g, m/s2, cm/s2)",
        )
    })
}

/// Returns the event, station and component in the title lines.
fn names(source: &Source<'_>, last: usize) -> (String, String, String) {
    for line in 0..last.min(4) {
        let text = source.text(line);
        let plain = text.split(" (").next().unwrap_or(&text);
        let parts: Vec<&str> = plain.split(',').map(str::trim).collect();
        if let [event @ .., station, component] = parts.as_slice()
            && !event.is_empty()
            && !component.is_empty()
            && component.len() <= 12
        {
            let stated = |text: String, none: &str| if text == none { String::new() } else { text };
            return (
                stated(event.join(", "), NO_EVENT),
                stated((*station).to_owned(), NO_STATION),
                (*component).to_owned(),
            );
        }
    }
    let title = source.text(0);
    let component = super::file_stem(source.name);
    (title, String::new(), component)
}
