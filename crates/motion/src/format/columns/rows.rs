//! Reads rows of numbers, and checks their width and the lines between them.

use super::facts::Facts;
use super::names::Name;
use super::shape;
use crate::error::{ReadError, Refusal};
use crate::format::source::{Source, quoted};
use crate::record::Record;

/// Largest number of header lines that are searched.
const MOST_HEADER_LINES: usize = 60;
/// Largest valid number in any unit; larger numbers are errors.
const LIMIT: f64 = 1e12;
/// Largest valid time. The limit is higher than [`LIMIT`], because a time may be in nanoseconds
/// since 1970.
const LARGEST_TIME: f64 = 1e19;
/// Largest number of columns that are treated as components; wider rows are one series written in
/// long lines.
const MOST_COLUMNS: usize = 200;
/// Smallest number of values in a file with a single line.
const FEWEST_ON_ONE_LINE: usize = 50;

pub(super) fn is_row(source: &Source<'_>, line: usize) -> bool {
    let mut values = Vec::new();
    source.tokens(line, f64::INFINITY, &mut values).is_ok() && !values.is_empty()
}

/// Returns the first line of numbers that is followed by another line of numbers or by the end of
/// the file.
pub(super) fn first_row(source: &Source<'_>) -> Option<usize> {
    let end = source.lines.len();
    (0..end.min(MOST_HEADER_LINES))
        .find(|&line| is_row(source, line) && (line + 1 == end || is_row(source, line + 1)))
}

/// Returns the line after the last row of numbers.
pub(super) fn end(source: &Source<'_>, first: usize) -> usize {
    let mut end = source.lines.len();
    while end > first && is_comment(source, end - 1) {
        end -= 1;
    }
    end
}

/// Refuses a file with a single row, unless the row is long.
pub(super) fn require_rows(
    source: &Source<'_>,
    first: usize,
    table: &[Vec<f64>],
) -> Result<(), ReadError> {
    let (width, rows) = (table.len(), table[0].len());
    if rows > 1 || width >= FEWEST_ON_ONE_LINE {
        return Ok(());
    }
    // The row above may belong to the table but contain an invalid number.
    require_no_lost_row(source, first, None, width)?;
    Err(source.damaged(
        first,
        "at least 2 rows of numbers",
        "a single row",
        "this is not a time history; give the file with all rows",
    ))
}

/// Refuses a file in which the line directly above the table is itself a row of the table, but
/// contains an invalid number.
pub(super) fn require_no_lost_row(
    source: &Source<'_>,
    first: usize,
    names_line: Option<usize>,
    width: usize,
) -> Result<(), ReadError> {
    let Some(line) = first.checked_sub(1).filter(|line| Some(*line) != names_line) else {
        return Ok(());
    };
    let text = source.text(line);
    let words: Vec<&str> =
        text.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty()).collect();
    let number = |word: &str| word.parse::<f64>().is_ok();
    let numbers = words.iter().filter(|word| number(word)).count();
    let stars = words.iter().any(|word| word.starts_with("**"));
    if words.len() == width && (numbers == width || numbers + 1 == width && (stars || width > 1)) {
        source.tokens(line, LIMIT, &mut Vec::new())?;
    }
    Ok(())
}

fn is_comment(source: &Source<'_>, line: usize) -> bool {
    let text = source.text(line);
    text.is_empty() || text.starts_with(['#', '%', '!', '/'])
}

/// Parses a first line that states the number of samples and the time step (s), such as `11800 0.005` or `0.005 11800`.
/// Returns the line and both values; `None` if the line may be a row of numbers like the rows below it.
pub(super) fn count_and_step(source: &Source<'_>, first: usize) -> Option<(usize, usize, f64)> {
    let (mut row, mut next) = (Vec::new(), Vec::new());
    source.tokens(first, f64::INFINITY, &mut row).ok()?;
    source.tokens(first + 1, f64::INFINITY, &mut next).ok()?;
    let text = source.text(first);
    let words: Vec<&str> =
        text.split([' ', ',', '\t', ';']).filter(|word| !word.is_empty()).collect();
    let [one, two] = *row.as_slice() else { return None };
    let is_count = |word: &str, value: f64| {
        value.fract() == 0.0 && (10.0..1e9).contains(&value) && !word.contains('.')
    };
    let is_step = |value: f64| value > 0.0 && value < 1.0;
    let (count, step) = match words.as_slice() {
        [a, _] if is_count(a, one) && is_step(two) => (one, two),
        [_, b] if is_count(b, two) && is_step(one) && next.len() != 2 => (two, one),
        _ => return None,
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "10 to 1e9")]
    (next.len() != 2 || next[0] < count).then_some((first, count as usize, step))
}

/// Reads all rows as columns, or very long rows as one series. Rows of several values must have a
/// common width, except for a shorter last row; the error names the first bad line.
pub(super) fn table(
    source: &Source<'_>,
    first: usize,
    end: usize,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let mut row = Vec::new();
    tokens(source, first, &mut row)?;
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
        tokens(source, line, &mut row)?;
        if row.len() != width {
            if line + 1 == end && row.len() < width && !shape::is_time(&columns[0]) {
                continue;
            }
            return Err(ragged(source, first, line, width, row.len()));
        }
        for (column, value) in columns.iter_mut().zip(&row) {
            column.push(*value);
        }
    }
    Ok(columns)
}

/// Reads the numbers of a row. In a row of several numbers, the first may be a time up to
/// [`LARGEST_TIME`]; all other numbers are limited to [`LIMIT`].
fn tokens(source: &Source<'_>, line: usize, row: &mut Vec<f64>) -> Result<(), ReadError> {
    let result = source.tokens(line, LIMIT, row);
    if result.is_err() {
        row.clear();
        let clock = source.tokens(line, LARGEST_TIME, row).is_ok() && row.len() > 1;
        if !(clock && row[1..].iter().all(|value| value.abs() <= LIMIT)) {
            return result;
        }
    }
    Ok(())
}

/// Returns the error for a row whose number of values differs from the width of the table. The remedy depends on
/// whether the first row may be the one that does not belong to the table, and on whether a cell is empty.
fn ragged(source: &Source<'_>, first: usize, line: usize, width: usize, found: usize) -> ReadError {
    let text = source.text(line);
    let at_end = found < width && text.ends_with([',', ';']);
    if at_end || [",,", ";;", "\t\t", ", ,"].iter().any(|empty| text.contains(empty)) {
        return source.damaged(
            line,
            format!("{width} numbers"),
            format!("an empty cell in {}", quoted(&text)),
            "fill in the cell or remove the row",
        );
    }
    if line == first + 1 {
        return source.error(
            first,
            Refusal::Unrecognized,
            "rows with equally many numbers, or a first line with the number of samples and the time step",
            format!("{width} numbers in the first row and {found} in the next"),
            "the first row does not belong to the table and has an unknown meaning; remove it and state \
             step and unit",
        );
    }
    if found > width {
        return source.damaged(
            line,
            format!("{width} numbers"),
            format!("{found} numbers in {}", quoted(&text)),
            "a number may contain a comma for thousands or decimals, or the row belongs to another table; \
             correct or remove the row",
        );
    }
    source.ragged(line, width, found)
}

/// Interprets rows of several values without times. If the header names the columns, each is a channel.
/// Otherwise, the rows must be parts of one series, as indicated by the stated number of samples or by
/// the values themselves; the series is read row by row, with a warning unless the stated number of
/// samples confirms it. Any other file is refused.
pub(super) fn without_time(
    source: &Source<'_>,
    first: usize,
    end: usize,
    table: Vec<Vec<f64>>,
    names: Option<&[Name]>,
    facts: &Facts,
    record: &mut Record,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let (width, rows) = (table.len(), table[0].len());
    if width == 1 {
        return Ok(vec![without_count(source, first, record, &table[0])]);
    }
    if names.is_some_and(|names| names.len() == width) {
        return Ok(table);
    }
    let series = source.all_tokens(first, end, LIMIT)?;
    let last_is_short = series.len() < width * rows || series.len() > width * rows;
    let counted = facts.count.is_some_and(|count| count.value.abs_diff(series.len()) <= 2);
    if !(counted || last_is_short || rows == 1 || shape::is_one_series(&table)) {
        return Err(source.error(
            first,
            Refusal::Unrecognized,
            "names above the columns, or one value per line",
            format!("{width} unnamed columns, which do not form a single series row by row"),
            "name the columns in a line above them, such as \"EW NS UD\", or give a file of one component",
        ));
    }
    if !counted {
        record.warn(
            first + 1,
            format!("{width} columns without names or time were read row by row as one series"),
        );
    }
    Ok(vec![series])
}

/// Removes the first value of a single column if this value is the number of values below it.
fn without_count(
    source: &Source<'_>,
    first: usize,
    record: &mut Record,
    column: &[f64],
) -> Vec<f64> {
    let count = column[0];
    let whole = !source.text(first).contains(['.', 'e', 'E']);
    if whole && count >= 10.0 && count == (column.len() - 1) as f64 {
        record.warn(first + 1, format!("{count} is the number of values below it and was ignored"));
        return column[1..].to_vec();
    }
    // The number of values may also be below the values.
    let (last, above) = column.split_last().unwrap_or((&0.0, &[]));
    let end = source.lines.len() - 1;
    if *last >= 10.0 && *last == above.len() as f64 && !source.text(end).contains('.') {
        record.warn(end + 1, format!("{last} is the number of values above it and was ignored"));
        return above.to_vec();
    }
    column.to_vec()
}
