//! Reader of plain columns and CSV. A file contains values alone, times and values, or a first line
//! with the number of values and the time step.
//!
//! Unit and step are never guessed: they come from the header, from a time column, or from the
//! caller. A header line is taken as column names only if the names are quantities. A stated time
//! step, number of samples and duration must agree with the numbers.

mod factors;
pub(in crate::format) mod facts;
mod names;
mod rows;
mod shape;
mod times;
mod words;

use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::format::even::{Timed, even_steps};
use crate::format::source::{Source, quoted};
use crate::format::{Format, Hints};
use crate::math;
use crate::record::{Channel, Quantity, Record, Stage};
use crate::units::MotionUnit;
use crate::write::{FIRST_LINE, INITIAL_VELOCITY};
use facts::{Facts, Stated};
use names::{Holds, Name};
use rows::{count_and_step, end, first_row, is_row, table, without_time};
use shape::Commas;

pub(crate) const FORMAT: Format =
    Format { name: "columns", title: "plain columns and CSV", sniff, read };

/// Relative tolerance between a stated duration and the duration of the samples.
const DURATION_TOLERANCE: f64 = 0.02;

fn sniff(source: &Source<'_>) -> bool {
    !source.bytes.iter().take(4096).any(|&b| b == 0)
        && (first_row(source).is_some() || is_row(source, 0))
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    source.require_text()?;
    let first = first_row(source).unwrap_or(0);
    let end = end(source, first);
    match shape::commas(source, first, end) {
        Commas::Separate => read_table(source, first, end, hints),
        Commas::Both => Err(source.damaged(
            first,
            "decimal points, or a column separator other than a comma",
            quoted(&source.text(first)),
            "write the numbers with decimal points, or with semicolons between them",
        )),
        Commas::Decimal => {
            let mut bytes = source.bytes.to_vec();
            let start = source.raw(first).as_ptr().addr() - source.bytes.as_ptr().addr();
            for byte in &mut bytes[start..] {
                if *byte == b',' {
                    *byte = b'.';
                }
            }
            let points = Source::new(source.name, &bytes);
            let mut record = read_table(&points, first, end, hints)?;
            record.notes.push("commas in numbers were read as decimal points".to_owned());
            Ok(record)
        }
    }
}

/// Refuses a table that is a spectrum: its first column contains periods, frequencies or spectral
/// ordinates.
fn refuse_spectrum(
    source: &Source<'_>,
    line: usize,
    names: Option<&[Name]>,
) -> Result<(), ReadError> {
    if !names.is_some_and(|names| names.first().is_some_and(|name| name.holds == Holds::Spectrum)) {
        return Ok(());
    }
    Err(source.not_acceleration(
        line,
        "an acceleration history, not a spectrum",
        quoted(&source.text(line)),
        "give the file with the time history from which this spectrum was computed",
    ))
}

fn read_table(
    source: &Source<'_>,
    first: usize,
    end: usize,
    hints: &Hints<'_>,
) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Unknown);
    let (first_line, header) = (count_and_step(source, first), first);
    let first = if first_line.is_some() { first + 1 } else { first };
    let table = table(source, first, end)?;
    rows::require_rows(source, first, &table)?;
    let (width, rows) = (table.len(), table[0].len());
    // In files written by this crate, comments are free text about the source and the processing.
    let own = header > 0 && source.text(0) == FIRST_LINE;
    let mut named = names::find(source, header, width)?;
    if let Some((_, names)) = named.as_mut().filter(|_| own) {
        let acceleration = Holds::Motion(Quantity::Acceleration);
        for name in names.iter_mut().skip(1) {
            name.holds = acceleration;
        }
    }
    let behind = named.as_ref().and_then(|(_, names)| names::time_behind(names));
    if behind.is_some_and(|at| !shape::rises(&table[at])) {
        named = None;
    }
    let names_line = named.as_ref().map(|(line, _)| *line);
    rows::require_no_lost_row(source, header, names_line, width)?;
    let prose = (0..header).filter(|line| Some(*line) != names_line && (!own || *line == 0));
    let mut facts = Facts::read(source, prose)?;
    if let Some((line, count, step)) = first_line {
        facts.count = Some(Stated { line, value: count });
        facts.step = Some(Stated { line, value: step });
    }
    let (mut names, mut table) =
        without_index(&mut record, named.map(|(_, names)| names), table, names_line, first);
    let mut time_column = width - table.len();
    if let Some(names) = names.as_mut() {
        let line = names_line.unwrap_or(first);
        time_column += times::one(source, &mut record, line, names, &mut table)?;
    }
    if let Some(names) = names.as_mut()
        && let Some(at) = names::time_behind(names)
    {
        time_column += at;
        names[..=at].rotate_right(1);
        table[..=at].rotate_right(1);
    }
    let width = table.len();
    let line = names_line.unwrap_or(first);
    let speaks = |name: &Name| name.holds == Holds::Motion(Quantity::Acceleration);
    if !names.as_ref().is_some_and(|names| names.iter().any(speaks)) {
        facts::refuse_other_quantities(source, 0..header)?;
    }
    refuse_spectrum(source, line, names.as_deref())?;
    let time = times::unit_of(source, first, &table, names.as_deref())?;
    let (time_step, names, columns) = if let Some(factor) = time {
        let (names, mut table) = (without_first(names), table);
        let time = scaled(&table.remove(0), factor);
        let resolution = factor * shape::time_resolution(source, first, end, time_column);
        if let Some(row) = shape::repeated_time(&time, resolution) {
            return Err(source.damaged(
                first + row,
                format!("a time after {} s", time[row - 1]),
                format!("{} s again", time[row]),
                "two rows have the same time; get the file again from its source, or remove one of the rows",
            ));
        }
        let (names, table) = accelerations(source, line, &mut record, names, table)?;
        require_no_mark(source, &table, Some(first))?;
        let timed = Timed { first_line: first, per_line: 1, time, values: table, resolution };
        let (step, columns) = even_steps(source, &mut record, "all", timed)?;
        require_step(source, &facts, step)?;
        (step, names, columns)
    } else {
        let table = without_time(source, first, end, table, names.as_deref(), &facts, &mut record)?;
        let (names, table) = accelerations(source, line, &mut record, names, table)?;
        require_no_mark(source, &table, None)?;
        (step(source, first, width, &facts, hints)?, names, table)
    };
    let found = if time.is_some() { rows } else { columns[0].len() };
    let columns = counted(source, &mut record, &facts, first_line.is_some(), found, columns)?;
    require_duration(source, &facts, time_step, columns[0].len(), hints)?;
    let units = units(source, first, line, &names, &facts, hints, &columns)?;
    let velocities = initial_velocities(source, header, columns.len())?;
    let stem = crate::format::file_stem(source.name);
    let several = columns.len() > 1;
    for (k, (column, unit)) in columns.into_iter().zip(units).enumerate() {
        let label = names.get(k).map(|name| name.label.clone());
        // A single column is often named "acceleration"; the header or the file name is more
        // specific.
        let says = |name: &String| several || Direction::parse(name) != Direction::default();
        let name = label.filter(says).or_else(|| facts.component.clone().filter(|_| !several));
        let fallback = || if several { format!("column {}", k + 1) } else { stem.clone() };
        let name = name.unwrap_or_else(fallback);
        let direction = Direction::parse(&name);
        let values = column.iter().map(|value| value * unit).collect();
        let mut channel = Channel::new(name, direction, time_step, values);
        channel.initial_velocity = velocities.get(k).copied().unwrap_or(0.0);
        if let (Some(peak), false) = (facts.peak, several) {
            let peak = peak.value;
            let printed = crate::format::Printed { value: peak.value, resolution: peak.resolution };
            channel.state_peak(Some(printed), peak.factor.unwrap_or(unit));
        }
        record.channels.push(channel);
    }
    Ok(record)
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    if factor == 1.0 {
        values.to_vec()
    } else {
        values.iter().map(|value| value * factor).collect()
    }
}

/// Removes the first column and its name if this column contains row numbers.
fn without_index(
    record: &mut Record,
    names: Option<Vec<Name>>,
    mut table: Vec<Vec<f64>>,
    names_line: Option<usize>,
    first: usize,
) -> (Option<Vec<Name>>, Vec<Vec<f64>>) {
    let counts = match &names {
        Some(names) => {
            names[0].holds == Holds::Index || shape::is_index(&table[0]) && names[0].label == "N"
        }
        None => shape::is_index(&table[0]),
    };
    if table.len() < 2 || !counts {
        return (names, table);
    }
    record
        .warn(names_line.unwrap_or(first) + 1, "the first column numbers the rows and was ignored");
    table.remove(0);
    (without_first(names), table)
}

fn without_first(names: Option<Vec<Name>>) -> Option<Vec<Name>> {
    names.map(|mut names| {
        names.remove(0);
        names
    })
}

/// Returns the acceleration columns with their names. Columns named as velocity, displacement or
/// another quantity are left out with a warning.
fn accelerations(
    source: &Source<'_>,
    line: usize,
    record: &mut Record,
    names: Option<Vec<Name>>,
    table: Vec<Vec<f64>>,
) -> Result<(Vec<Name>, Vec<Vec<f64>>), ReadError> {
    let unsure = |names: &Option<Vec<Name>>| {
        names.as_ref().is_none_or(|names| names.iter().all(|name| name.holds == Holds::Unknown))
    };
    if unsure(&names) {
        let columns: Vec<&[f64]> = table.iter().map(Vec::as_slice).collect();
        if let Some([of, integral]) = shape::integral(&columns) {
            return Err(source.not_acceleration(
                line,
                "columns of acceleration only, or names above the columns",
                format!("unnamed columns, one of them the integral of another ({} of {})", integral + 1, of + 1),
                "name the columns in a line above them, such as \"time (s), acceleration (g), velocity (cm/s)\"",
            ));
        }
        let times = |column: &Vec<f64>| shape::is_time(column) && shape::is_even(column);
        if names.is_none() && table.len() > 1 && table.iter().any(times) {
            return Err(source.damaged(
                line,
                "one time per row",
                "a further unnamed column whose values rise evenly, as times do",
                "write one pair of time and acceleration per row, or name the columns in a line above them",
            ));
        }
        if names.is_none() && shape::is_one_sided(&table) {
            return Err(source.not_acceleration(
                line,
                "positive and negative accelerations",
                "no value below 0, as in a spectrum",
                "give the acceleration history; if this is an acceleration history, name its columns in a line above \
                 them, such as \"time (s), acceleration (g)\"",
            ));
        }
    }
    let lengths = shape::lengths(&table);
    let Some(names) = names.filter(|names| names.len() == table.len()) else {
        let mut table = table;
        if let Some(at) = lengths.iter().position(|length| *length) {
            table.remove(at);
            record.warn(
                line + 1,
                "a column contains the vector length of the other columns and was ignored",
            );
        }
        return Ok((Vec::new(), table));
    };
    let held: Vec<Holds> = names.iter().map(|name| name.holds).collect();
    let holds = |wanted: Holds| held.contains(&wanted);
    let acceleration = Holds::Motion(Quantity::Acceleration);
    let others = names.iter().any(|name| !matches!(name.holds, Holds::Component | Holds::Unknown));
    let taken = |name: &Name| match name.holds {
        Holds::Motion(quantity) => quantity == Quantity::Acceleration,
        Holds::Component => !holds(acceleration) || name.unit.is_none(),
        Holds::Unknown => !others && !holds(Holds::Component),
        Holds::Time | Holds::Index | Holds::Spectrum | Holds::Other => false,
    };
    let all: Vec<String> = names.iter().map(Name::shown).collect();
    let several = names.iter().filter(|name| taken(name)).count() > 1;
    // Phones write the length of the acceleration vector in a column next to the components.
    let length = |name: &Name, values: &[f64]| {
        several && name.says_length() && values.iter().all(|value| *value >= 0.0)
    };
    let (mut kept, mut left) = (Vec::new(), Vec::new());
    for ((name, values), is_length) in names.into_iter().zip(table).zip(lengths) {
        let keeps = taken(&name) && !length(&name, &values) && !is_length;
        if keeps { &mut kept } else { &mut left }.push((name, values));
    }
    if kept.is_empty() {
        return Err(source.not_acceleration(
            line,
            "a column of acceleration",
            all.join(", "),
            "give the acceleration history",
        ));
    }
    if !left.is_empty() {
        let left: Vec<String> = left.iter().map(|(name, _)| name.shown()).collect();
        let text = format!("columns that are not accelerations were ignored: {}", left.join(", "));
        record.warn(line + 1, text);
    }
    Ok(kept.into_iter().unzip())
}

/// Refuses placeholders for missing values among accelerations. `first` is the line of the first
/// row, or `None` if a row of the table may not be a line of the file.
fn require_no_mark(
    source: &Source<'_>,
    table: &[Vec<f64>],
    first: Option<usize>,
) -> Result<(), ReadError> {
    let found = table.iter().find_map(|column| Some((shape::mark(column)?, column)));
    found.map_or(Ok(()), |(row, column)| {
        Err(source.damaged(
            first.map_or(crate::format::FilePosition::from(()), |first| (first + row).into()),
            "accelerations only",
            format!(
                "{} as sample {}, which looks like a placeholder for a missing value",
                column[row],
                row + 1
            ),
            "get the record without gaps, or cut the file before the gap",
        ))
    })
}

/// Returns the time step (s) of columns without a time column.
fn step(
    source: &Source<'_>,
    first: usize,
    width: usize,
    facts: &Facts,
    hints: &Hints<'_>,
) -> Result<f64, ReadError> {
    let stated = facts.step.map(|step| step.value);
    if let (None, Some(step), Some(rate)) = (stated, hints.time_step(), facts.possible_rate)
        && (step * rate.value - 1.0).abs() > 1e-2
    {
        return Err(source.error(
            rate.line,
            Refusal::Options,
            format!("samples at {} Hz, as this line seems to state", rate.value),
            format!("a step of {step} s"),
            "state the step of this sampling rate, or delete this line if it states another frequency",
        ));
    }
    stated.or_else(|| hints.time_step()).ok_or_else(|| {
        let remedy = match facts.step_by_duration() {
            Some(step) => format!(
                "state the time step (s), which is about {step:.4} s according to the count and \
                 the duration in the header"
            ),
            None => "state the time step (s)".to_owned(),
        };
        source.error(
            first,
            Refusal::Missing(Given::Step),
            "a time column or a time step",
            if width == 1 {
                "1 column without time".to_owned()
            } else {
                format!("{width} columns without time")
            },
            remedy,
        )
    })
}

/// Refuses a stated step that contradicts the time column.
fn require_step(source: &Source<'_>, facts: &Facts, step: f64) -> Result<(), ReadError> {
    match facts.step {
        Some(stated) if (stated.value / step - 1.0).abs() > 1e-2 => Err(source.damaged(
            stated.line,
            format!("a step of {step} s, as in the time column"),
            format!("{} s, as stated here", stated.value),
            "correct the header or the times",
        )),
        _ => Ok(()),
    }
}

/// Refuses samples whose duration differs from the stated duration; the error states both.
fn require_duration(
    source: &Source<'_>,
    facts: &Facts,
    time_step: f64,
    samples: usize,
    hints: &Hints<'_>,
) -> Result<(), ReadError> {
    let Some(Stated { line, value: [stated, resolution] }) = facts.duration else { return Ok(()) };
    let length = time_step * samples as f64;
    let tolerance = (1.01 * resolution).max(2.0 * time_step).max(DURATION_TOLERANCE * stated);
    if (length - stated).abs() <= tolerance {
        return Ok(());
    }
    let given = facts.step.is_none() && hints.time_step() == Some(time_step);
    let (refusal, remedy) = if given {
        let step = stated / samples as f64;
        (Refusal::Options, format!("give the step that leads to this duration, about {step:.4} s"))
    } else {
        let remedy = if length < stated {
            "the file is truncated or its header belongs to another file; get it again from its source"
        } else {
            "the step or the duration of the header is wrong; get the file again from its source"
        };
        (Refusal::Damaged, remedy.to_owned())
    };
    Err(source.error(
        line,
        refusal,
        format!("a total duration of {stated} s, as stated here"),
        format!("a total duration of {length:.4} s: {samples} samples at a step of {time_step} s"),
        remedy,
    ))
}

/// Compares the number of samples with the number stated in the header, and truncates the columns to
/// the number returned by `check_count`.
fn counted(
    source: &Source<'_>,
    record: &mut Record,
    facts: &Facts,
    on_first_line: bool,
    found: usize,
    mut columns: Vec<Vec<f64>>,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let Some(Stated { line, value: stated }) = facts.count else { return Ok(columns) };
    if !on_first_line && found > stated + 2 {
        return Err(source.damaged(
            line,
            format!("{stated} values as stated here"),
            format!("{found}"),
            "the header belongs to another file, or the numbers are those of several components; get the file \
             again from its source",
        ));
    }
    let used = crate::format::check_count(source, record, line, stated, found)?;
    // Interpolated columns have a different length than the counted rows.
    if columns[0].len() == found {
        for column in &mut columns {
            column.truncate(used);
        }
    }
    Ok(columns)
}

/// Returns the velocities (m/s) at the first samples, as stated in files written by this crate;
/// empty for other files.
fn initial_velocities(
    source: &Source<'_>,
    first: usize,
    channels: usize,
) -> Result<Vec<f64>, ReadError> {
    for line in 0..first {
        if let Some(text) = source.text(line).strip_prefix(INITIAL_VELOCITY) {
            return crate::format::initial_velocities(source, line, text, channels);
        }
    }
    Ok(Vec::new())
}

/// Returns the factors that convert the columns to SI units, one per column. The unit of a column is
/// stated next to its name, in the header, or by the caller.
fn units(
    source: &Source<'_>,
    first: usize,
    names_line: usize,
    names: &[Name],
    facts: &Facts,
    hints: &Hints<'_>,
    columns: &[Vec<f64>],
) -> Result<Vec<f64>, ReadError> {
    let acceleration = |unit: MotionUnit, line: usize, word: String| {
        if unit.quantity == Quantity::Acceleration {
            return Ok(unit.factor);
        }
        let expected = "a unit of acceleration";
        Err(source.not_acceleration(line, expected, quoted(&word), "give the acceleration history"))
    };
    let instrument = |word: &str| {
        source.not_acceleration(
            names_line,
            "a unit of acceleration",
            format!("{}, the unit of the instrument's output", quoted(word)),
            "convert the values with the sensitivity of the sensor, and write the resulting unit",
        )
    };
    let missing = |found: String| {
        source.error(
            first,
            Refusal::Missing(Given::Unit),
            "a unit of acceleration",
            found,
            "state the unit (g, m/s2, cm/s2)",
        )
    };
    (0..columns.len())
        .map(|k| {
            let name = names.get(k);
            if let Some(name) = name.filter(|name| factors::has_factor(&name.label, "*")) {
                return Err(source.damaged(
                    names_line,
                    "a column name without a factor",
                    format!("{}, a name with a factor", quoted(&name.label)),
                    "multiply the values by the factor, unless they already contain the factor, and write the name \
                     without the factor",
                ));
            }
            if let Some(name) = name
                && let Some(unit) = name.motion_unit()
            {
                return acceleration(unit, names_line, name.shown());
            }
            let unknown = name.and_then(|name| name.unit.clone());
            let word = unknown.clone().or_else(|| Some(facts.unknown_unit.as_ref()?.value.clone()));
            if let Some(word) = word.as_deref().filter(|word| words::is_of_instrument(word)) {
                return Err(instrument(word));
            }
            let in_header = facts.unit.filter(|_| unknown.is_none());
            // Units after the names of some columns do not apply to the other columns.
            let some = names.iter().any(|name| name.motion_unit().is_some());
            if let Some(stated) = in_header.filter(|_| !some) {
                return acceleration(stated.value, stated.line, source.text(stated.line));
            }
            if let Some(word) = unknown.as_deref().filter(|word| factors::is_unit_with_factor(word))
            {
                return Err(source.damaged(
                    names_line,
                    "a unit without a factor",
                    format!("{}, a unit with a factor", quoted(word)),
                    "multiply the values by the factor, and write the unit without the factor",
                ));
            }
            if let Some(unit) = hints.unit() {
                return Ok(unit.factor());
            }
            if let Some(word) = word {
                return Err(missing(format!("the unit {}", quoted(&word))));
            }
            let peak = columns.iter().map(|column| math::peak(column)).fold(0.0, f64::max);
            Err(missing(format!("numbers up to {peak:.4} without a unit")))
        })
        .collect()
}
