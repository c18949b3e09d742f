//! Time columns: determines their unit, and selects one column if there are several.

use super::names::{Holds, Name};
use super::{facts, shape};
use crate::error::ReadError;
use crate::format::source::{Source, quoted};
use crate::record::{Quantity, Record};

/// Largest time step (s) of a time column with an unstated unit.
pub(super) const LARGEST_BARE_STEP: f64 = 0.5;
/// Smallest time step (s) of a time column with an unstated unit. Times in minutes, hours or days
/// have smaller steps.
const SMALLEST_BARE_STEP: f64 = 4e-4;
/// Smallest step (s) of a time column in seconds. No recorder has smaller steps, but spreadsheet
/// times in days do.
const SMALLEST_STEP: f64 = 1e-5;

/// Returns the length (s) of the time unit of the first column, or `None` if the column does not
/// contain times.
pub(super) fn unit_of(
    source: &Source<'_>,
    first: usize,
    table: &[Vec<f64>],
    names: Option<&[Name]>,
) -> Result<Option<f64>, ReadError> {
    if table.len() < 2 {
        return Ok(None);
    }
    let rises = shape::is_time(&table[0]);
    let (stated, unit) = match names {
        Some([Name { holds: Holds::Time, unit, label }, ..]) => {
            let in_label = label.rsplit([' ', '_', ',', '.']).next().and_then(facts::time_factor);
            let unit = unit.as_deref();
            let factor = unit.map(|unit| {
                facts::time_factor(unit).ok_or_else(|| {
                    source.damaged(
                        first,
                        "a time column in s, ms, us, ns or min",
                        quoted(unit),
                        "write the times in one of these units, and name the unit in the header",
                    )
                })
            });
            (true, factor.transpose()?.or(in_label))
        }
        // Values that increase evenly are times, even if the column has no name, or has the name of
        // a motion because the header is damaged: no ground acceleration increases evenly.
        Some([Name { holds, label, .. }, ..])
            if rises
                && shape::is_even(&table[0])
                && matches!(
                    holds,
                    Holds::Component | Holds::Unknown | Holds::Motion(Quantity::Acceleration)
                ) =>
        {
            return Err(source.damaged(
                first,
                "a column of accelerations, or a time column with a name such as time (s)",
                format!(
                    "a first column called {} whose values rise by {} from row to row",
                    quoted(label),
                    table[0][1] - table[0][0]
                ),
                "name the columns in a line above them, such as \"time (s), acceleration (g)\", or remove the first column",
            ));
        }
        // An increasing column with another name does not contain times.
        Some(_) => return Ok(None),
        None => (false, None),
    };
    let steps = (table[0].len() - 1) as f64;
    let step = (table[0].last().unwrap_or(&0.0) - table[0][0]) / steps;
    if unit.is_none() && !stated && (!rises || shape::is_index(&table[0])) {
        return Ok(None);
    }
    let (smallest, largest) = match unit {
        Some(_) => (SMALLEST_STEP, f64::INFINITY),
        None => (SMALLEST_BARE_STEP, LARGEST_BARE_STEP),
    };
    let seconds = step * unit.unwrap_or(1.0);
    // Times that do not increase are refused later.
    if seconds > largest || seconds > 0.0 && seconds < smallest {
        let (found, remedy) = if unit.is_some() {
            (
                format!("steps of {seconds:.3e} s"),
                "write seconds since the first sample; multiply days by 86400",
            )
        } else {
            (
                format!("steps of {step} without a unit"),
                "name the columns in a line above them, such as \"time (ms), acceleration (g)\"; days and hours \
                 must be written in seconds",
            )
        };
        return Err(source.damaged(
            first,
            "a time column in seconds or in a stated unit, with a time step that is plausible for a strong-motion \
             record",
            found,
            remedy,
        ));
    }
    Ok(Some(unit.unwrap_or(1.0)))
}

/// Keeps only the first time column that has a unit, or else the first time column. Returns the
/// number of columns removed before it.
///
/// # Errors
/// If the time columns do not increase in proportion to each other.
pub(super) fn one(
    source: &Source<'_>,
    record: &mut Record,
    line: usize,
    names: &mut Vec<Name>,
    table: &mut Vec<Vec<f64>>,
) -> Result<usize, ReadError> {
    let unit = |name: &Name| name.unit.as_deref().and_then(facts::time_factor);
    let times: Vec<usize> = (0..names.len()).filter(|at| names[*at].holds == Holds::Time).collect();
    if times.len() < 2 {
        return Ok(0);
    }
    let kept = *times.iter().find(|at| unit(&names[**at]).is_some()).unwrap_or(&times[0]);
    let others: Vec<usize> = times.into_iter().filter(|at| *at != kept).collect();
    for at in &others {
        let units = unit(&names[*at]).zip(unit(&names[kept]));
        if !shape::rise_alike(&table[kept], &table[*at], units.map(|(other, own)| own / other)) {
            return Err(source.damaged(
                line,
                "one time column, or several time columns that agree with each other",
                format!("{} and {}, which disagree", names[kept].shown(), names[*at].shown()),
                "remove the column that does not belong to the accelerations",
            ));
        }
        record.warn(
            line + 1,
            format!(
                "{} contains the same times as {} and was ignored",
                names[*at].shown(),
                names[kept].shown()
            ),
        );
    }
    for at in others.iter().rev() {
        names.remove(*at);
        table.remove(*at);
    }
    Ok(others.iter().filter(|at| **at < kept).count())
}
