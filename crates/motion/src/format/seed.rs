//! Channels with SEED codes, which tell what the instrument measures.

use super::Hints;
use super::source::Source;
use crate::error::{ReadError, Refusal};
use crate::instrument::{Instrument, SeedName, differentiated};
use crate::record::{Quantity, Record};

/// Whether accelerations come from other quantities, whose offsets differentiation takes off.
pub(super) fn differentiates(hints: &Hints<'_>) -> bool {
    matches!(hints.recorded(), Some(Quantity::Velocity | Quantity::Displacement))
}

/// What a channel with SEED codes recorded, differentiated to accelerations; refused where its code or
/// its metadata say that it is no acceleration and the caller did not ask for it.
pub(super) fn as_acceleration(
    source: &Source<'_>,
    record: &mut Record,
    hints: &Hints<'_>,
    seed: &SeedName,
    instrument: Option<&Instrument>,
    time_step: f64,
    values: Vec<f64>,
) -> Result<Vec<f64>, ReadError> {
    let name = &seed.channel;
    let (quantity, why) = match (hints.recorded(), instrument.and_then(|known| known.quantity)) {
        (Some(asked), _) => (asked, "as asked"),
        (None, Some(Quantity::Acceleration)) => return Ok(values),
        (None, Some(other)) => (other, "its metadata say"),
        (None, None) => seed.other_quantity().unwrap_or((Quantity::Acceleration, "")),
    };
    let order = match quantity {
        Quantity::Acceleration => return Ok(values),
        Quantity::Velocity => 1,
        Quantity::Displacement => 2,
    };
    if hints.recorded().is_none() {
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
        "channel {name}: {quantity} differentiated {times} by central differences of fourth order"
    ));
    Ok((0..order).fold(values, |values, _| differentiated(&values, time_step)))
}
