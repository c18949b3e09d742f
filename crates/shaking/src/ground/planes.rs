//! Selects the second horizontal component of a record: the first component shakes a stack in one vertical plane, and
//! the second component shakes it in the perpendicular vertical plane.

use super::record::read;
use super::{GroundError, component_of, of_spec};
use crate::motion::{MotionSource, MotionSpec, RecordMotion, Scale};

/// Returns the specification of a motion in which the other horizontal component of the record replaces the component
/// of `spec`; the scale factor is unchanged. Returns `None` if there is no such component.
///
/// # Errors
/// If the record cannot be read, or cannot be scaled as specified.
pub fn other_component(spec: &MotionSpec) -> Result<Option<MotionSpec>, GroundError> {
    let MotionSource::Record(record) = &spec.source else { return Ok(None) };
    let Some(component) = other(record)? else { return Ok(None) };
    let factor = match spec.scale {
        Scale::Factor(factor) => factor,
        Scale::Pga(_) | Scale::Pgv(_) | Scale::Measure { .. } => {
            let plain = MotionSpec { scale: Scale::Factor(1.0), ..spec.clone() };
            let peak = |spec| -> Result<f64, GroundError> {
                Ok(of_spec(spec, 1.0)?.motion.map_or(0.0, |motion| motion.pga()))
            };
            peak(spec)? / peak(&plain)?
        }
    };
    let record = RecordMotion { component: Some(component), ..record.clone() };
    let (source, scale) = (MotionSource::Record(record), Scale::Factor(factor));
    Ok(Some(MotionSpec { source, scale, ..spec.clone() }))
}

/// Returns the clockwise angle (degrees, 0 to 360, viewed from above) from the component of a motion to the other
/// horizontal component; `None` if the directions of the components are unknown.
///
/// # Errors
/// If the record cannot be read, or lacks the requested component.
pub fn turn_to_other(spec: &MotionSpec) -> Result<Option<f64>, GroundError> {
    let MotionSource::Record(record) = &spec.source else { return Ok(None) };
    let Some(other) = other(record)? else { return Ok(None) };
    let channels = read(record)?;
    let azimuth = |name| -> Result<Option<f64>, GroundError> {
        Ok(channels.component(&component_of(&channels, name)?)?.direction.azimuth)
    };
    let (own, other) = (azimuth(record.component.as_deref())?, azimuth(Some(&other))?);
    // Azimuths increase clockwise.
    Ok(own.zip(other).map(|(own, other)| (other - own).rem_euclid(360.0)))
}

/// Returns the name of the other horizontal component; `None` if there is none.
///
/// If the component of `spec` is a channel of the record, the result is the first other channel that is not vertical.
/// If the component is computed from two channels by rotation, the result is the perpendicular direction.
fn other(spec: &RecordMotion) -> Result<Option<String>, GroundError> {
    let record = read(spec)?;
    let own = record.component(&component_of(&record, spec.component.as_deref())?)?;
    let Some(at) = record.channels.iter().position(|channel| *channel == own) else {
        let across = own.direction.azimuth.map(|azimuth| (azimuth + 90.0).rem_euclid(360.0));
        return Ok(across.map(|azimuth| format!("az:{azimuth}")));
    };
    // Channels are named by number, since their names may repeat.
    let mut others = record.channels.iter().enumerate().filter(|(other, _)| *other != at);
    let other = others.find(|(_, channel)| !channel.is_vertical());
    Ok(other.filter(|_| !own.is_vertical()).map(|(other, _)| format!("#{}", other + 1)))
}
