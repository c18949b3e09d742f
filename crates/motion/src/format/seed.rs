//! Determines the quantity that a channel with SEED codes recorded, and converts its samples to
//! accelerations.

use super::Hints;
use super::source::{Source, quoted};
use crate::error::{ReadError, Refusal};
use crate::instrument::{Instrument, SeedName, differentiated};
use crate::record::{Quantity, Record};

/// Returns the quantity recorded by a channel, from the caller, the metadata or the channel code;
/// `None` if the metadata state a quantity other than motion.
pub(super) fn quantity(
    hints: &Hints<'_>,
    seed: &SeedName,
    instrument: Option<&Instrument>,
) -> Option<Quantity> {
    if instrument.is_some_and(|known| known.other_unit.is_some()) {
        return None;
    }
    let by_code = || seed.other_quantity().map_or(Quantity::Acceleration, |(quantity, _)| quantity);
    let metadata = instrument.and_then(|known| known.quantity);
    Some(hints.recorded().or(metadata).unwrap_or_else(by_code))
}

/// Converts `scaled`, the samples of a channel in SI units of the recorded quantity, to accelerations
/// (m/s²).
///
/// The quantity is taken from the caller, else from the metadata, else from the channel code. The
/// mean of recorded accelerations is removed. Velocities and displacements are differentiated if the
/// caller or the metadata state the quantity, but refused if only the channel code states it.
pub(super) fn as_acceleration(
    source: &Source<'_>,
    record: &mut Record,
    hints: &Hints<'_>,
    seed: &SeedName,
    instrument: Option<&Instrument>,
    time_step: f64,
    mut scaled: Vec<f64>,
) -> Result<Vec<f64>, ReadError> {
    let name = &seed.channel;
    let label = if name.is_empty() { "1" } else { name };
    let Some(quantity) = quantity(hints, seed, instrument) else {
        let unit = instrument.and_then(|known| known.other_unit.as_deref());
        return Err(other_unit(source, seed, unit.unwrap_or_default()));
    };
    let metadata = instrument.and_then(|known| known.quantity);
    let order = match quantity {
        Quantity::Acceleration => {
            super::remove_offset(record, label, &mut scaled);
            return Ok(scaled);
        }
        Quantity::Velocity => 1,
        Quantity::Displacement => 2,
    };
    if hints.recorded().is_none() && metadata.is_none() {
        let why = seed.other_quantity().map_or("", |(_, why)| why);
        return Err(source.error(
            (),
            Refusal::OtherInstrument,
            "a channel of an accelerometer",
            format!("{name}, which records {quantity} ({why})"),
            "give the channel of the accelerometer, or state that its velocities are to be \
             differentiated",
        ));
    }
    let times = if order == 1 { "once" } else { "twice" };
    record.notes.push(format!(
        "channel {label}: {quantity} differentiated {times} by central differences of fourth order"
    ));
    if hints.recorded().is_none() {
        record.warn(
            None,
            format!(
                "according to its metadata, channel {label} was recorded by a {quantity} sensor: the accelerations \
                 were obtained by differentiation; strong shaking may have exceeded the range of such a sensor"
            ),
        );
    }
    Ok((0..order).fold(scaled, |values, _| differentiated(&values, time_step)))
}

/// Returns the error for a channel whose metadata state no input unit, or one that is not a unit of
/// motion.
fn other_unit(source: &Source<'_>, seed: &SeedName, unit: &str) -> ReadError {
    let found = match unit {
        "" => "metadata without an input unit".to_owned(),
        _ => format!("metadata with the input unit {}", quoted(unit)),
    };
    source.not_acceleration(
        (),
        format!("an accelerometer as the source of channel {}", seed.channel),
        found,
        "give the channel of an accelerometer, or correct InputUnits in its StationXML",
    )
}
