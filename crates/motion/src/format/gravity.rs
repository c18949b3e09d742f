//! Detects and removes gravity, which accelerometers record at rest.

use crate::error::ReadError;
use crate::format::Source;
use crate::math::{STANDARD_GRAVITY, peak, take_mean};
use crate::record::{Channel, Quantity, Record};

/// Largest relative difference between the mean acceleration and gravity at which the mean is treated as gravity. The
/// tolerance covers calibration errors and the tilt of a single axis.
const TOLERANCE: f64 = 0.05;
/// Largest mean (m/s²) of a ground motion over a whole record; a larger mean is an offset.
const LARGEST_MEAN: f64 = 0.5 * STANDARD_GRAVITY;
/// Largest mean (m/s²) of a ground motion whose values all have the same sign.
const LARGEST_ONE_SIDED: f64 = 0.05 * STANDARD_GRAVITY;
/// Minimum duration (s) of a record whose mean is checked. Analytic pulses are shorter, so that their
/// mean is not checked.
const SHORTEST: f64 = 2.0;
/// If gravity is spread over several axes, the mean of an axis is subtracted only if its magnitude exceeds this value
/// (m/s²).
const SMALLEST_PART: f64 = 0.05;
/// Largest angle (degrees) between gravity and an axis that is considered vertical.
const LARGEST_TILT: f64 = 3.0;

/// Subtracts gravity from each channel that contains it, with a warning. Gravity may be spread over
/// several axes of a sensor.
///
/// # Errors
/// If a mean that is not gravity is too large for a ground motion.
pub(super) fn take_out(source: &Source<'_>, record: &mut Record) -> Result<(), ReadError> {
    let means: Vec<f64> = record.channels.iter().map(mean).collect();
    let sensor = |channel: &Channel| (channel.site.station.clone(), channel.site.sensor.clone());
    let is_gravity = |mean: f64| (mean.abs() / STANDARD_GRAVITY - 1.0).abs() <= TOLERANCE;
    let mut taken = vec![false; means.len()];
    for at in 0..means.len() {
        let of = sensor(&record.channels[at]);
        let axes: Vec<usize> =
            (0..means.len()).filter(|k| sensor(&record.channels[*k]) == of).collect();
        let length = axes.iter().map(|k| means[*k] * means[*k]).sum::<f64>().sqrt();
        let spread = axes.len() <= 3 && is_gravity(length) && means[at].abs() > SMALLEST_PART;
        taken[at] = is_gravity(means[at]) || spread;
        let largest = axes.iter().map(|k| means[*k].abs()).fold(0.0, f64::max);
        let aside = (length * length - largest * largest).max(0.0).sqrt();
        let tilt = crate::math::atan2(aside, largest).to_degrees();
        if spread && largest == means[at].abs() && tilt > LARGEST_TILT {
            record.warn(
                None,
                format!(
                    "the vertical is {tilt:.0} degrees off the nearest axis of the sensor: rotate the record into \
                     vertical and horizontal components before use"
                ),
            );
        }
    }
    for (at, mean) in means.into_iter().enumerate() {
        let channel = &mut record.channels[at];
        let name = channel.name.clone();
        if taken[at] {
            take_mean(&mut channel.acceleration);
            let peak = peak(&channel.acceleration);
            for stated in &mut channel.peaks {
                if stated.quantity == Quantity::Acceleration {
                    stated.measured = peak;
                }
            }
            record.warn(
                None,
                format!(
                    "channel {name}: its mean of {mean:.4} m/s2 is gravity, which an accelerometer records at rest; \
                     it was subtracted"
                ),
            );
            continue;
        }
        let one_sided = channel.acceleration.iter().all(|value| value * mean > 0.0);
        let limit = if one_sided { LARGEST_ONE_SIDED } else { LARGEST_MEAN };
        if mean.abs() > limit {
            return Err(source.damaged(
                (),
                format!("accelerations with a mean near 0 in channel {name}"),
                format!("a mean of {mean:.4} m/s2"),
                "check the unit; if the mean is gravity or an offset of the sensor, subtract it from the values",
            ));
        }
    }
    Ok(())
}

/// Returns the mean of a channel, or 0 for a channel that is too short.
fn mean(channel: &Channel) -> f64 {
    let values = &channel.acceleration;
    if channel.duration() < SHORTEST { 0.0 } else { crate::math::mean(values) }
}
