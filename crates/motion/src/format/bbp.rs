//! Reader of Broadband Platform text (SCEC, `.000`, `.090`, `.ver`).
//!
//! The first line contains the station and the component. The second line contains eight numbers; the first two are the
//! number of samples and the time step. The values follow, separated by blanks. Accelerations and velocities have the
//! same layout, and the files state neither quantity nor unit, so the caller must provide the unit. Files with four
//! columns including time (`.bbp`) are read as plain columns.

use super::source::{LARGEST_ACCELERATION, Source, parse_number, quoted};
use super::{Format, Hints};
use crate::direction::{Direction, Orientation};
use crate::error::{Given, ReadError, Refusal};
use crate::instrument::differentiated;
use crate::math;
use crate::record::{Channel, Quantity, Record, Stage};
use crate::units::{AccelerationUnit, MotionUnit};

pub(crate) const FORMAT: Format =
    Format { name: "bbp", title: "Broadband Platform text (SCEC)", sniff, read };

/// Number of values on the second line. The values are the number of samples, the time step, hour,
/// minute, second, epicentral distance, azimuth and back azimuth.
const NUMBERS: usize = 8;

/// Parses the number of samples and the time step (s) on the second line.
fn count_and_step(source: &Source<'_>) -> Option<(usize, f64)> {
    let mut row = Vec::new();
    source.tokens(1, f64::INFINITY, &mut row).ok()?;
    let [count, step, ..] = row.as_slice() else { return None };
    let whole = source.text(1).split_whitespace().next()?.parse::<usize>().ok()?;
    let fits = row.len() == NUMBERS && *count >= 10.0 && (1e-5..1.0).contains(step);
    fits.then_some((whole, *step))
}

/// Returns `true` if the first line contains words and the second line states the number of values
/// below it.
fn sniff(source: &Source<'_>) -> bool {
    let title = source.text(0);
    let words: Vec<&str> = title.split_whitespace().collect();
    let named = words.len() >= 2 && parse_number(words[0].as_bytes()).is_none();
    let mut row = Vec::new();
    let below =
        source.tokens(2, f64::INFINITY, &mut row).is_ok() && (1..=NUMBERS).contains(&row.len());
    named && below && count_and_step(source).is_some()
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    source.require_text()?;
    let (count, time_step) = count_and_step(source).ok_or_else(|| {
        source.header(1, "count, step and six more numbers", quoted(&source.text(1)))
    })?;
    let mut values = source.all_tokens(2, source.lines.len(), 1e12)?;
    let mut record = Record::new(FORMAT.name, source.name, Stage::Unknown);
    let used = super::check_count(source, &mut record, 1, count, values.len())?;
    values.truncate(used);
    let stated = stated_unit(source);
    let velocity = hints.recorded() == Some(Quantity::Velocity);
    let factor = match stated {
        Some(MotionUnit { quantity: Quantity::Acceleration, factor }) => factor,
        Some(MotionUnit { quantity: Quantity::Velocity, factor }) if velocity => factor,
        Some(_) => {
            return Err(source.not_acceleration(
                0,
                "accelerations",
                quoted(&source.text(0)),
                "give the accelerations of the same station, or state that velocities are to be \
                 differentiated",
            ));
        }
        // Velocities of the platform are in cm/s.
        None if velocity => AccelerationUnit::Gal.factor(),
        None => hints
            .unit()
            .map(AccelerationUnit::factor)
            .ok_or_else(|| missing_unit(source, &values))?,
    };
    for (index, value) in values.iter_mut().enumerate() {
        *value *= factor;
        if value.abs() > LARGEST_ACCELERATION {
            let expected = format!("numbers up to {LARGEST_ACCELERATION} m/s2");
            let found = format!("{value:e} m/s2 as number {}", index + 1);
            return Err(source.damaged((), expected, found, "check the unit"));
        }
    }
    let text = source.text(0);
    let mut words = text.split_whitespace();
    words.next().unwrap_or_default().clone_into(&mut record.station);
    let name = words.next().unwrap_or_default().to_owned();
    if velocity {
        values = differentiated(&values, time_step);
        record.notes.push(format!(
            "channel {name}: velocity in cm/s differentiated once by central differences of fourth \
             order"
        ));
    }
    let direction = Direction::parse(&name);
    let unknown = direction.orientation.is_none() && name.eq_ignore_ascii_case("ver");
    let direction = if unknown {
        Direction { orientation: Some(Orientation::Vertical), ..direction }
    } else {
        direction
    };
    record.channels.push(Channel::new(name, direction, time_step, values));
    Ok(record)
}

/// Returns the unit that some programs write in the title, after the station and the component;
/// `None` if the title states no unit.
fn stated_unit(source: &Source<'_>) -> Option<MotionUnit> {
    let text = source.text(0).to_lowercase();
    let words = text.split([' ', '\t', '(', ')', '[', ']', ',']).filter(|word| !word.is_empty());
    // A unit of length alone may be a word of the title, such as "in".
    words.skip(2).filter_map(MotionUnit::parse).find(|u| u.quantity != Quantity::Displacement)
}

fn missing_unit(source: &Source<'_>, values: &[f64]) -> ReadError {
    source.error(
        (),
        Refusal::Missing(Given::Unit),
        "a unit of acceleration (files of the Broadband Platform state none)",
        format!("numbers up to {:.4} without a unit", math::peak(values)),
        "state the unit of accelerations, mostly cm/s2, or that velocities in cm/s are to be \
         differentiated",
    )
}
