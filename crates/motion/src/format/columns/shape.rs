//! Infers the meaning of columns from their numbers. Recognizes times, decimal commas, series
//! written in rows, integrals and spectra.

use crate::format::source::{Source, latin1};
use crate::math;

/// Number of rows that are examined to determine the number format.
const ROWS: usize = 200;
/// Fraction of the steps from row to row that must be positive if an unnamed first column is to count as times.
const RISING: f64 = 0.95;

/// Returns `true` if an unnamed column contains times or row numbers: it increases almost
/// everywhere, and every step is smaller than ten times the mean step.
///
/// Times that repeat or decrease in places are included; they are refused later with a specific
/// error.
pub(super) fn is_time(column: &[f64]) -> bool {
    if column.len() < 3 {
        return false;
    }
    let steps = column.len() - 1;
    let mean = (column[steps] - column[0]) / steps as f64;
    let even = column.windows(2).all(|pair| pair[1] - pair[0] < 10.0 * mean);
    mean > 0.0 && even && rises(column)
}

/// Returns `true` if a column increases almost everywhere.
pub(super) fn rises(column: &[f64]) -> bool {
    let rising = column.windows(2).filter(|pair| pair[1] > pair[0]).count();
    rising as f64 >= RISING * (column.len() - 1) as f64
}

/// Minimum number of rows that a column needs to be recognized as times by its evenly increasing
/// values alone.
const EVEN_ROWS: usize = 20;

/// Returns `true` if every value of a column deviates from a straight line by less than the mean step. This includes
/// evenly spaced times that were rounded when they were printed. A column with fewer than [`EVEN_ROWS`] rows fails.
pub(super) fn is_even(column: &[f64]) -> bool {
    let [from, .., to] = *column else { return false };
    let mean = (to - from) / (column.len() - 1) as f64;
    let line = |row: usize| from + mean * row as f64;
    let off = |(row, value): (usize, &f64)| (value - line(row)).abs();
    column.len() >= EVEN_ROWS && column.iter().enumerate().map(off).all(|off| off < mean.abs())
}

/// Returns `true` if a second time column increases in proportion to the first. Deviations must be
/// smaller than the mean step of the second column.
///
/// `ratio` is the factor of proportionality; `None` if it follows from the first and last rows.
pub(super) fn rise_alike(first: &[f64], other: &[f64], ratio: Option<f64>) -> bool {
    let last = first.len() - 1;
    let ratio = ratio.unwrap_or((other[last] - other[0]) / (first[last] - first[0]));
    let step = ratio * (first[last] - first[0]) / last.max(1) as f64;
    let off = |row: usize| (other[row] - other[0] - ratio * (first[row] - first[0])).abs();
    step > 0.0 && (0..first.len()).all(|row| off(row) < step)
}

/// Returns `true` if a column contains the row numbers, counted from 0 or 1.
pub(super) fn is_index(column: &[f64]) -> bool {
    matches!(column.first(), Some(0.0 | 1.0))
        && column.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
}

/// Returns the first row that repeats the time of the previous row, although the printed digits
/// suffice to distinguish consecutive times.
pub(super) fn repeated_time(column: &[f64], resolution: f64) -> Option<usize> {
    let steps = column.len().saturating_sub(1);
    let mean = (column.last()? - column.first()?) / steps.max(1) as f64;
    if resolution > 0.5 * mean {
        return None;
    }
    (1..column.len()).find(|&row| column[row] == column[row - 1])
}

/// Returns the finest resolution of the printed times in a column, which is one unit of the last digit.
pub(super) fn time_resolution(source: &Source<'_>, first: usize, end: usize, column: usize) -> f64 {
    let resolution = |line: usize| {
        let text = latin1(source.raw(line));
        let mut words = text.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty());
        let word = words.nth(column).unwrap_or("");
        crate::format::source::resolution(word)
    };
    (first..end.min(first + ROWS)).map(resolution).reduce(f64::min).unwrap_or(1e-6)
}

/// Meaning of commas in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Commas {
    /// Commas separate numbers, or there are no commas.
    Separate,
    /// Commas are decimal commas.
    Decimal,
    /// Commas are both separators and decimal commas, so that the numbers are ambiguous.
    Both,
}

/// Determines the meaning of commas in the first [`ROWS`] rows of a table.
///
/// If a row has a decimal point, a comma before a space or a comma at its end, commas are separators. Otherwise, commas
/// are decimal commas if no field has several commas, and if either every row has several fields or the digits after
/// some comma are a zero and more digits. Fields are separated by semicolons, tabs or spaces.
pub(super) fn commas(source: &Source<'_>, first: usize, end: usize) -> Commas {
    let (mut any, mut zeros, mut one_each, mut other) = (false, false, true, true);
    for line in first..end.min(first + ROWS) {
        let row = latin1(source.raw(line));
        let row = row.trim();
        if row.contains('.') || row.contains(", ") || row.ends_with(',') {
            return Commas::Separate;
        }
        let fields: Vec<&str> =
            row.split([';', '\t', ' ']).filter(|field| !field.is_empty()).collect();
        any |= row.contains(',');
        other &= fields.len() > 1;
        one_each &= fields.iter().all(|field| field.matches(',').count() <= 1);
        zeros |= fields.iter().any(|field| {
            field.split(',').skip(1).any(|digits| digits.len() > 1 && digits.starts_with('0'))
        });
    }
    match (any, one_each, other, zeros) {
        (true, true, true, _) | (true, true, false, true) => Commas::Decimal,
        (true, false, _, true) => Commas::Both,
        _ => Commas::Separate,
    }
}

/// Returns `true` if rows of several numbers are one series written row by row. In such a series,
/// consecutive values within a row, and across the end of a row, differ less than consecutive
/// values in a column.
pub(super) fn is_one_series(table: &[Vec<f64>]) -> bool {
    let (width, rows) = (table.len(), table[0].len());
    let (mut along, mut down) = (0.0, 0.0);
    for row in 1..rows {
        for column in 0..width {
            let before =
                if column == 0 { table[width - 1][row - 1] } else { table[column - 1][row] };
            along += (table[column][row] - before).abs();
            down += (table[column][row] - table[column][row - 1]).abs();
        }
    }
    along <= down
}

/// Returns the first pair of columns where the second is the integral of the first.
pub(super) fn integral(columns: &[&[f64]]) -> Option<[usize; 2]> {
    let pairs = (0..columns.len()).flat_map(|a| (0..columns.len()).map(move |b| [a, b]));
    pairs.into_iter().filter(|[a, b]| a != b).find(|[a, b]| {
        let (of, integral) = (columns[*a], columns[*b]);
        if of.len() < 8 {
            return false;
        }
        let (mut cross, mut one, mut two) = (0.0, 0.0, 0.0);
        for row in 1..of.len() - 1 {
            let rate = integral[row + 1] - integral[row - 1];
            let value = of[row - 1] + 2.0 * of[row] + of[row + 1];
            cross += rate * value;
            one += rate * rate;
            two += value * value;
        }
        cross > 0.95 * (one * two).sqrt() && one > 0.0
    })
}

/// Returns one flag per column: `true` if, in every row, the value of the column is the length of a vector, within
/// 1 %. The components of the vector are the values in all other columns, or in two or three of the other columns that
/// are adjacent.
pub(super) fn lengths(columns: &[Vec<f64>]) -> Vec<bool> {
    let is_length = |at: usize| {
        let of = &columns[at];
        let others: Vec<usize> = (0..columns.len()).filter(|k| *k != at).collect();
        let fits = |set: &[usize]| {
            let peak = math::peak(of);
            (0..of.len()).all(|row| {
                let sum: f64 = set.iter().map(|k| columns[*k][row] * columns[*k][row]).sum();
                (of[row] - sum.sqrt()).abs() <= 1e-2 * of[row].abs() + 1e-3 * peak
            })
        };
        others.len() > 1
            && of.len() > 4
            && of.iter().all(|value| *value >= 0.0)
            && math::peak(of) > 0.0
            && (fits(&others) || others.windows(3).any(fits) || others.windows(2).any(fits))
    };
    (0..columns.len()).map(is_length).collect()
}

/// Returns `true` if no value is negative and the first value is not small, as is typical of a
/// spectrum. An accelerometer at rest under gravity is excluded: most of its values, including
/// those at both ends, are close to their mean.
pub(super) fn is_one_sided(columns: &[Vec<f64>]) -> bool {
    let rests = |column: &[f64]| {
        let mean = math::mean(column);
        let near = |value: &&f64| (*value / mean - 1.0).abs() < 0.1;
        let ends = [column[0], column[column.len() - 1]];
        ends.iter().all(|end| near(&end))
            && 2 * column.iter().filter(near).count() > column.len()
            && column.iter().any(|value| *value != column[0])
    };
    let one_sided = |column: &Vec<f64>| {
        column.len() > 4
            && column.iter().all(|value| *value >= 0.0)
            && column.first().is_some_and(|first| *first > 1e-3 * math::peak(column))
    };
    columns.iter().all(one_sided) && !columns.iter().any(|column| rests(column))
}

/// Returns the first row that contains a placeholder for a missing value, such as -999. A placeholder
/// consists of nines only, and its magnitude is clearly larger than that of all other values.
pub(super) fn mark(column: &[f64]) -> Option<usize> {
    let peak = math::peak(column);
    if !crate::format::is_nines(peak) {
        return None;
    }
    let marks = column.iter().filter(|value| value.abs() == peak).count();
    let below = column.iter().map(|value| value.abs()).filter(|value| *value < peak);
    let limit = if marks > 1 { 0.9 } else { 0.6 };
    let stands_out = below.fold(0.0, f64::max) < limit * peak;
    column.iter().position(|value| value.abs() == peak).filter(|_| stands_out)
}
