//! Plain columns and CSV: values alone, time and values, or a count and a step on the first line.
//!
//! Neither unit nor step is ever guessed: both come from header words, a time column, or the caller.

use super::even::{Timed, even_steps};
use super::source::{Source, latin1, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::math;
use crate::record::{Channel, Record, Stage};
use crate::units::AccelerationUnit;
use crate::write::INITIAL_VELOCITY;

pub(crate) const FORMAT: Format =
    Format { name: "columns", title: "plain columns and CSV", sniff, read };

/// Header lines searched.
const MOST_HEADER_LINES: usize = 60;
/// Anything larger is damage whatever the unit.
const LIMIT: f64 = 1e12;

/// The first line that holds numbers only.
fn first_row(source: &Source<'_>) -> Option<usize> {
    (0..source.lines.len().min(MOST_HEADER_LINES)).find(|&line| {
        let mut values = Vec::new();
        source.tokens(line, f64::INFINITY, &mut values).is_ok() && !values.is_empty()
    })
}

fn sniff(source: &Source<'_>) -> bool {
    if source.bytes.iter().take(4096).any(|&b| b == 0) {
        return false;
    }
    let Some(first) = first_row(source) else { return false };
    // Two rows of numbers in succession, or the last line.
    let mut values = Vec::new();
    first + 1 >= source.lines.len()
        || source.tokens(first + 1, f64::INFINITY, &mut values).is_ok()
        || first == 0
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    source.require_text()?;
    let first = first_row(source).unwrap_or(0);
    let mut record = Record::new(FORMAT.name, source.name, Stage::Unknown);
    refuse_other_quantities(source, first)?;
    let (stated, first) = count_and_step(source, first);
    let mut end = source.lines.len();
    while end > first && is_comment(source, end - 1) {
        end -= 1;
    }
    let table = table(source, first, end)?;
    let width = table.len();
    let rows = table[0].len();
    let timed = width > 1 && rows > 2 && is_time(&table[0]);
    let names = header_names(source, first, width);
    let (time_step, columns) = if timed {
        let mut table = table;
        let time = table.remove(0);
        let resolution = time_resolution(source, first, end);
        let timed = Timed { first_line: first, per_line: 1, time, values: table, resolution };
        let (step, columns) = even_steps(source, &mut record, "all", timed)?;
        let given = stated.map(|(_, step)| step);
        if let Some(given) = given
            && (given / step - 1.0).abs() > 1e-3
        {
            record.warn(
                first + 1,
                format!(
                    "the time column has a step of {step} s; {given} s, stated here, is ignored"
                ),
            );
        }
        (step, columns)
    } else {
        let step = stated.map(|(_, step)| step).or_else(|| hints.time_step()).ok_or_else(|| {
            source.error(
                first,
                Refusal::Missing(Given::Step),
                "a time column or a time step",
                format!("{width} column(s) without time"),
                "state the time step (s)",
            )
        })?;
        (step, without_time(source, first, end, table, &names, &mut record)?)
    };
    let count = columns.first().map_or(0, Vec::len);
    let mut columns = columns;
    if let Some((stated, _)) = stated {
        let line = first.saturating_sub(1);
        let used = super::check_count(source, &mut record, line, stated, count)?;
        for column in &mut columns {
            column.truncate(used);
        }
    }
    let unit = unit(source, first, hints, &columns)?;
    let names = if timed { names.get(1..).unwrap_or(&[]).to_vec() } else { names };
    let stem = super::file_stem(source.name);
    let several = columns.len() > 1;
    let velocities = initial_velocities(source, first, columns.len())?;
    for (k, column) in columns.into_iter().enumerate() {
        let fallback = if several { format!("column {}", k + 1) } else { stem.clone() };
        // A single column is often called "acceleration"; the file's name says more.
        let tells = |name: &&String| several || Direction::parse(name) != Direction::default();
        let name = names.get(k).filter(tells).cloned().unwrap_or(fallback);
        let direction = Direction::parse(&name);
        let values = column.iter().map(|value| value * unit.factor()).collect();
        let mut channel = Channel::new(name, direction, time_step, values);
        channel.initial_velocity = velocities.get(k).copied().unwrap_or(0.0);
        record.channels.push(channel);
    }
    Ok(record)
}

/// Velocities (m/s) at the first samples, which files of our own state; none in all others.
fn initial_velocities(
    source: &Source<'_>,
    first: usize,
    channels: usize,
) -> Result<Vec<f64>, ReadError> {
    for line in 0..first {
        if let Some(text) = source.text(line).strip_prefix(INITIAL_VELOCITY) {
            return super::initial_velocities(source, line, text, channels);
        }
    }
    Ok(Vec::new())
}

fn is_comment(source: &Source<'_>, line: usize) -> bool {
    let text = source.text(line);
    text.is_empty() || text.starts_with(['#', '%', '!', '/'])
}

/// Header words that say the numbers are something else.
fn refuse_other_quantities(source: &Source<'_>, first: usize) -> Result<(), ReadError> {
    for line in 0..first {
        let text = source.text(line).to_ascii_lowercase();
        if text.contains("accel") {
            return Ok(());
        }
        for word in ["spectr", "displacement", "velocity", "degree", "period (s)", "counts"] {
            if text.contains(word) {
                return Err(source.not_acceleration(
                    line,
                    "accelerations",
                    quoted(&text),
                    "give the acceleration history",
                ));
            }
        }
    }
    Ok(())
}

/// A first line `11800 0.005` above rows of another shape, or `NPTS, DT` in words before it.
fn count_and_step(source: &Source<'_>, first: usize) -> (Option<(usize, f64)>, usize) {
    let mut row = Vec::new();
    let mut next = Vec::new();
    let both = source.tokens(first, f64::INFINITY, &mut row).is_ok()
        && source.tokens(first + 1, f64::INFINITY, &mut next).is_ok();
    if let (true, [count, step]) = (both, row.as_slice())
        && count.fract() == 0.0
        && *count >= 10.0
        && *count < 1e9
        && *step > 0.0
        && *step < 1.0
        && !source.text(first).split([' ', ',', '\t']).next().unwrap_or("").contains('.')
        && (next.len() != 2 || next[0] < *count)
    {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "10 to 1e9")]
        return (Some((*count as usize, *step)), first + 1);
    }
    (None, first)
}

/// Most columns that are taken for components; more are one series in long lines.
const MOST_COLUMNS: usize = 200;

/// All rows as columns, or one column of very long rows; rows of several values without a common
/// width are refused with their line, except a short last one.
fn table(source: &Source<'_>, first: usize, end: usize) -> Result<Vec<Vec<f64>>, ReadError> {
    let mut row = Vec::new();
    source.tokens(first, LIMIT, &mut row)?;
    let width = row.len();
    if width == 0 {
        return Err(source.bad_number(first, 0, source.raw(first)));
    }
    if width > MOST_COLUMNS {
        return Ok(vec![source.all_tokens(first, end, LIMIT)?]);
    }
    let mut columns: Vec<Vec<f64>> =
        (0..width).map(|_| Vec::with_capacity(end.saturating_sub(first))).collect();
    for line in first..end {
        if source.raw(line).trim_ascii().is_empty() {
            return Err(source.bad_number(line, 0, source.raw(line)));
        }
        row.clear();
        source.tokens(line, LIMIT, &mut row)?;
        if row.len() != width {
            if line + 1 == end && row.len() < width && !is_time(&columns[0]) {
                continue;
            }
            return Err(source.ragged(line, width, row.len()));
        }
        for (column, value) in columns.iter_mut().zip(&row) {
            column.push(*value);
        }
    }
    Ok(columns)
}

/// Several values to a line and no time: channels if the header names the columns, one series row by
/// row if it does not, with a warning.
fn without_time(
    source: &Source<'_>,
    first: usize,
    end: usize,
    table: Vec<Vec<f64>>,
    names: &[String],
    record: &mut Record,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let width = table.len();
    if width == 1 {
        return Ok(table);
    }
    let named = |name: &String| {
        Direction::parse(name) != Direction::default() || name.to_ascii_lowercase().contains("acc")
    };
    if names.len() == width && names.iter().any(named) {
        return Ok(table);
    }
    record.warn(
        first + 1,
        format!("{width} columns without names or time were read row by row as one series"),
    );
    Ok(vec![source.all_tokens(first, end, LIMIT)?])
}

/// Strictly rising values with no step above ten times the mean.
fn is_time(column: &[f64]) -> bool {
    if column.len() < 2 {
        return false;
    }
    let mean = (column[column.len() - 1] - column[0]) / (column.len() - 1) as f64;
    mean > 0.0 && column.windows(2).all(|pair| pair[1] > pair[0] && pair[1] - pair[0] < 10.0 * mean)
}

/// The coarsest resolution of the printed times: one unit of the most digits shown.
fn time_resolution(source: &Source<'_>, first: usize, end: usize) -> f64 {
    let resolution = |line: usize| {
        let text = latin1(source.raw(line));
        let word = text.split([' ', '\t', ',', ';']).find(|word| !word.is_empty()).unwrap_or("");
        super::source::resolution(word)
    };
    (first..end.min(first + 200)).map(resolution).reduce(f64::min).unwrap_or(1e-6)
}

/// Names from the last header line, when it has one to a column.
fn header_names(source: &Source<'_>, first: usize, width: usize) -> Vec<String> {
    let Some(line) = (0..first).rev().find(|&line| !source.text(line).is_empty()) else {
        return Vec::new();
    };
    let text = source.text(line);
    let text = text.trim_start_matches(['#', '%', '!', '/', ' ']);
    let names: Vec<String> = if text.contains([',', ';', '\t']) {
        text.split([',', ';', '\t']).map(|name| name.trim().to_owned()).collect()
    } else {
        text.split_whitespace().map(str::to_owned).collect()
    };
    // A line of numbers alone, such as count and step, names nothing.
    if names.len() == width && names.iter().any(|name| name.parse::<f64>().is_err()) {
        names
            .into_iter()
            .map(|name| name.split('(').next().unwrap_or("").trim().to_owned())
            .collect()
    } else {
        Vec::new()
    }
}

/// The unit in parentheses or after "units" in a header line that speaks of acceleration, or the one
/// that stands in parentheses behind every name but that of the time.
fn stated_unit(source: &Source<'_>, first: usize) -> Option<AccelerationUnit> {
    let in_parentheses = |text: &str| {
        let (_, rest) = text[text.find("acc")?..].split_once(['(', '['])?;
        rest.split([')', ']']).next()?.parse().ok()
    };
    let behind_its_word = |text: &str| {
        let word = text.split_once("unit")?.1.trim_start_matches(['s', ':', '=', ' ']);
        word.split([' ', ',', ';']).next()?.parse().ok()
    };
    (0..first).map(|line| source.text(line).to_ascii_lowercase()).find_map(|text| {
        in_parentheses(&text)
            .or_else(|| behind_its_word(&text))
            .or_else(|| unit_of_every_column(&text))
    })
}

/// `time (s),EW (m/s2),NS (m/s2)`: one unit of acceleration for all that is not time.
fn unit_of_every_column(header: &str) -> Option<AccelerationUnit> {
    let mut units =
        header.split([',', ';', '\t']).filter(|name| !name.contains("time")).map(|name| {
            let word = name.split_once(['(', '['])?.1.split([')', ']']).next()?;
            word.parse::<AccelerationUnit>().ok()
        });
    let unit = units.next()??;
    units.all(|other| other == Some(unit)).then_some(unit)
}

fn unit(
    source: &Source<'_>,
    first: usize,
    hints: &Hints<'_>,
    columns: &[Vec<f64>],
) -> Result<AccelerationUnit, ReadError> {
    stated_unit(source, first).or_else(|| hints.unit()).ok_or_else(|| {
        let peak = columns.iter().map(|column| math::peak(column)).fold(0.0, f64::max);
        source.error(
            first,
            Refusal::Missing(Given::Unit),
            "a unit of acceleration",
            format!("numbers up to {peak:.4} without one"),
            "state the unit (g, m/s2, cm/s2)",
        )
    })
}
