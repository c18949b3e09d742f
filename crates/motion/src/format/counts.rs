//! Converts the samples of channels with SEED codes to accelerations. The samples are counts or
//! have a stated unit.

use super::source::Source;
use super::{Hints, seed};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::instrument::SeedName;
use crate::record::{Channel, Quantity, Record};
use crate::site::Site;
use crate::units::MotionUnit;
use crate::utc::Utc;

/// The samples of one channel, before their conversion to accelerations.
pub(super) struct Samples {
    pub(super) codes: SeedName,
    pub(super) start: Option<Utc>,
    /// Time step (s).
    pub(super) time_step: f64,
    pub(super) values: Vec<f64>,
    /// Unit stated in the file.
    pub(super) unit: Unit,
    /// Direction of the channel, if the file states it in addition to the channel code.
    pub(super) direction: Option<Direction>,
}

/// Unit of samples, as stated in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// Digitizer counts.
    Counts,
    /// A unit of motion.
    Motion(MotionUnit),
}

impl Unit {
    /// Parses a unit such as `M/S**2`, `nm/s` or `COUNTS`; `None` if unknown.
    pub(super) fn of(word: &str) -> Option<Self> {
        let plain = word.trim().to_ascii_lowercase();
        if ["count", "counts", "ct", "cts", ""].contains(&plain.as_str()) {
            return Some(Self::Counts);
        }
        MotionUnit::parse(&plain).map(Self::Motion)
    }
}

/// Converts a channel to m/s².
///
/// Counts are divided by the sensitivity given by the caller or by metadata; samples with a unit
/// are converted. Velocities and displacements are differentiated if the caller requests it.
/// `format` is the name of the format in messages.
pub(super) fn channel(
    source: &Source<'_>,
    record: &mut Record,
    hints: &Hints<'_>,
    format: &str,
    samples: Samples,
) -> Result<Channel, ReadError> {
    let Samples { codes, start, time_step, values, unit, direction } = samples;
    let name = codes.channel.clone();
    // The sensitivity in the metadata applies to counts; samples with a stated unit do not need it.
    let known = (unit == Unit::Counts).then(|| hints.instrument(&codes, start)).flatten();
    let factor = match unit {
        Unit::Counts => {
            let sensitivity = known.map(|known| known.sensitivity).or_else(|| hints.sensitivity());
            let sensitivity = sensitivity.ok_or_else(|| {
                source.error(
                    (),
                    Refusal::Missing(Given::Sensitivity),
                    format!("a sensitivity for channel {name} ({format} holds counts)"),
                    hints.no_instrument(&codes, start),
                    "state the counts per m/s2 from the station's StationXML (InstrumentSensitivity)",
                )
            })?;
            record.notes.push(format!(
                "channel {name}: counts divided by {sensitivity} counts per m/s2, as given"
            ));
            1.0 / sensitivity
        }
        Unit::Motion(MotionUnit { quantity, factor }) => {
            // A quantity stated in the file takes precedence over the channel code.
            if quantity != Quantity::Acceleration && hints.recorded().is_none() {
                return Err(source.error(
                    (),
                    Refusal::OtherInstrument,
                    "a channel of accelerations",
                    format!("{name}, whose unit is a unit of {quantity}"),
                    "give the accelerations of the same station, or state that this channel is \
                     to be differentiated",
                ));
            }
            factor
        }
    };
    let values: Vec<f64> = values.iter().map(|value| value * factor).collect();
    let accelerations =
        matches!(unit, Unit::Motion(MotionUnit { quantity: Quantity::Acceleration, .. }));
    let values = if accelerations {
        values
    } else {
        seed::as_acceleration(source, record, hints, &codes, known, time_step, values)?
    };
    let direction = known
        .and_then(|known| known.direction)
        .or(direction)
        .unwrap_or_else(|| Direction::parse(&name));
    let station = [codes.network.as_str(), codes.station.as_str()];
    let station = station.into_iter().filter(|code| !code.is_empty()).collect::<Vec<_>>().join(".");
    let mut channel = Channel::new(name, direction, time_step, values);
    channel.start = start;
    channel.site = Site { station, sensor: codes.location, ..Site::default() };
    if let Some(known) = known {
        known.complete(&mut channel.site);
    }
    Ok(channel)
}

/// Returns the distinct station codes of all channels.
pub(super) fn stations(record: &Record) -> String {
    let mut all: Vec<&str> = record.channels.iter().map(|c| c.site.station.as_str()).collect();
    all.dedup();
    all.join(", ")
}
