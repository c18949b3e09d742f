//! The ground motion of a scenario: read or generated, scaled, and ready to drive a model.

mod failure;
mod formula;
mod planes;
mod record;

use barrelstack_dynamics::{Drive, Planar, Vec2};
use barrelstack_motion::{
    Channel, Component, GroundMotion, Horizontals, IntensityMeasure, MotionError, Processing,
    Record, Stage,
};

use crate::motion::{
    MeasuredOn, MotionSource, MotionSpec, Processing as ProcessingSpec, RecordMotion, Scale,
    Vertical,
};

use record::{OTHER_VERTICAL, read, read_file, read_options};

pub use failure::GroundError;
pub use planes::{other_component, turn_to_other};
pub use record::{RECORD_LIMIT, from_disk, held};

/// The ground motion of a run.
///
/// ```
/// use barrelstack_motion::{GroundMotion, Pulse};
/// use barrelstack_shaking::ground::Ground;
///
/// let pulse = Pulse::Ricker { acceleration: 3.0, period: 0.8 };
/// let ground = Ground::from(GroundMotion::from_pulse("ricker", pulse)?);
/// assert!(ground.end() > 0.8 && ground.calm_from(0.1) <= ground.end());
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Ground {
    /// The motion; `None` for ground at rest.
    pub motion: Option<GroundMotion>,
    /// Warnings from reading the motion, one sentence each.
    pub warnings: Vec<String>,
}

impl Ground {
    /// Scales the amplitude and the time axis of the motion as the scenario specifies.
    fn rescale(&mut self, spec: &MotionSpec, similitude: f64) -> Result<(), MotionError> {
        if let Some(motion) = self.motion.take() {
            self.motion = Some(scaled(motion, spec, similitude)?);
        }
        Ok(())
    }

    /// Returns the motion scaled by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let motion = self.motion.as_ref().map(|motion| motion.scaled(factor));
        Self { motion, warnings: self.warnings.clone() }
    }

    /// Returns the time (s) after which no acceleration exceeds a limit (m/s²).
    pub fn calm_from(&self, limit: f64) -> f64 {
        self.motion.as_ref().map_or(0.0, |motion| motion.calm_from(limit))
    }

    /// Returns the time (s) at which the motion ends; `None` without a motion.
    pub fn motion_end(&self) -> Option<f64> {
        self.motion.as_ref().map(|motion| motion.duration)
    }

    /// Returns the time (s) after which the ground is still: the end of the motion, or zero if there is no motion.
    pub fn end(&self) -> f64 {
        self.motion_end().unwrap_or(0.0)
    }
}

impl From<GroundMotion> for Ground {
    fn from(motion: GroundMotion) -> Self {
        Self { motion: Some(motion), warnings: Vec::new() }
    }
}

impl Drive<Planar> for Ground {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let Some(motion) = &self.motion else { return Default::default() };
        let x = motion.horizontal.at(time);
        let z = motion.vertical.as_ref().map(|v| v.at(time)).unwrap_or_default();
        (Vec2::new(x.displacement, z.displacement), Vec2::new(x.velocity, z.velocity))
    }
}

/// Reads or generates a motion according to its specification, for a stack built at the length scale `similitude`.
///
/// # Errors
/// If a record cannot be read, lacks a requested component, or cannot be scaled as specified.
pub fn of_spec(spec: &MotionSpec, similitude: f64) -> Result<Ground, GroundError> {
    let mut ground = match &spec.source {
        MotionSource::None => return Ok(Ground::default()),
        MotionSource::Record(record) => shaken_by(&read(record)?, record, spec.scale)?,
        MotionSource::Sine(sine) => formula::harmonic(sine)?.into(),
        MotionSource::Pulse(pulse) => formula::pulsed(pulse)?.into(),
    };
    ground.rescale(spec, similitude)?;
    Ok(ground)
}

/// Processes and scales a loaded record as `spec` and `motion` specify, for a stack built at the length scale
/// `similitude`. The source that `motion` names is ignored.
///
/// # Errors
/// If the record lacks a requested component, or cannot be scaled as specified.
pub fn of_record(
    record: &Record,
    spec: &RecordMotion,
    motion: &MotionSpec,
    similitude: f64,
) -> Result<Ground, GroundError> {
    let mut ground = shaken_by(record, spec, motion.scale)?;
    let spec = MotionSpec { source: MotionSource::Record(spec.clone()), ..motion.clone() };
    ground.rescale(&spec, similitude)?;
    Ok(ground)
}

/// Scales the amplitude and the time axis of a motion as the scenario specifies, for a stack built at the length scale
/// `run_scale`.
///
/// # Errors
/// If the motion cannot be scaled as specified.
pub fn scaled(
    mut motion: GroundMotion,
    spec: &MotionSpec,
    run_scale: f64,
) -> Result<GroundMotion, MotionError> {
    match spec.scale {
        Scale::Factor(1.0) => {}
        Scale::Factor(factor) => motion = motion.scaled(factor),
        Scale::Pga(target) => motion = motion.scale_to(IntensityMeasure::Pga, target)?,
        Scale::Pgv(target) => motion = motion.scale_to(IntensityMeasure::Pgv, target)?,
        Scale::Measure { measure, value, of } => match (horizontals(of), &spec.source) {
            (None, _) => motion = motion.scale_to(measure, value)?,
            // A record has already been scaled by `scaled_by_both`, where both horizontals were available.
            (Some(_), MotionSource::Record(_)) => {}
            (Some(over), MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_)) => {
                return Err(MotionError::NotScalable {
                    measure: format!("{measure} ({over} of both horizontal components)"),
                    reason: "only a record has two horizontal components".to_owned(),
                });
            }
        },
    }
    for length in [spec.similitude, run_scale] {
        if length != 1.0 {
            motion = motion.froude(length);
        }
    }
    Ok(motion)
}

/// Returns the name of the event from which the record of the scenario comes; `None` if no file states the name.
///
/// # Errors
/// If the record cannot be read.
pub fn event(spec: &MotionSpec) -> Result<Option<String>, GroundError> {
    match &spec.source {
        MotionSource::Record(record) => Ok(read(record)?.event_name()),
        MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_) => Ok(None),
    }
}

/// Returns the requested components of a record, processed according to the scenario. They are also scaled if `scale`
/// specifies a measure of both horizontal components.
fn shaken_by(record: &Record, spec: &RecordMotion, scale: Scale) -> Result<Ground, GroundError> {
    require_strong_motion(record)?;
    let mut warnings: Vec<String> =
        record.warnings.iter().map(|w| format!("{}: {w}", record.file)).collect();
    let horizontal = component_of(record, spec.component.as_deref())?;
    let processing = processing_of(spec, record);
    let motion = match &spec.vertical {
        Vertical::None => record.ground_motion(&horizontal, None, &processing)?,
        Vertical::Component(name) => {
            let vertical = component_of(record, Some(name))?;
            match record.component(&vertical) {
                Ok(_) => record.ground_motion(&horizontal, Some(&vertical), &processing)?,
                // A user may replace the record of the scenario by a file without a vertical component.
                Err(_) if !record.channels.iter().any(Channel::is_vertical) => {
                    let file = &record.file;
                    let warning = format!(
                        "{file} has no vertical component; the ground shakes only horizontally"
                    );
                    warnings.push(warning);
                    record.ground_motion(&horizontal, None, &processing)?
                }
                Err(error) => return Err(GroundError::Vertical { error }),
            }
        }
        Vertical::File(file) => {
            let options = read_options(spec)?;
            let other = read_file(file, &options, OTHER_VERTICAL)?;
            require_strong_motion(&other)?;
            warnings.extend(other.warnings.iter().map(|w| format!("{}: {w}", other.file)));
            let (record, other, notes) = on_one_clock(record, &horizontal, other)?;
            warnings.extend(notes);
            let theirs = processing_of(spec, &other);
            let vertical = other.ground_motion(&Component::Number(1), None, &theirs)?;
            let motion = record.ground_motion(&Component::Number(1), None, &processing)?;
            let GroundMotion { name, horizontal, mut provenance, .. } = motion;
            provenance.extend(vertical.provenance);
            let both = GroundMotion::new(name, horizontal, Some(vertical.horizontal));
            GroundMotion { provenance, ..both }
        }
    };
    let mut motion = scaled_by_both(motion, record, &processing, scale)?;
    motion.name = record.name_of(&record.component(&horizontal)?);
    Ok(Ground { motion: Some(motion), warnings })
}

/// Aligns a horizontal component in time with the first channel of the separate file that contains the vertical
/// component, if both files state their start times. Returns the two records, each with this channel only, and a
/// warning if their headers suggest that they do not belong together.
fn on_one_clock(
    record: &Record,
    horizontal: &Component,
    mut other: Record,
) -> Result<(Record, Record, Vec<String>), MotionError> {
    let notes = record.unlike(&other).map(|what| format!("combined although {what}"));
    let mut both = record.clone();
    both.channels = vec![record.component(horizontal)?];
    both.channels.extend(std::mem::take(&mut other.channels).into_iter().take(1));
    both.notes.clear();
    both.align()?;
    let vertical = both.channels.split_off(1);
    let second = Record { channels: vertical, ..other };
    let mut first = Record { channels: both.channels, ..record.clone() };
    first.notes.extend(both.notes);
    Ok((first, second, notes.into_iter().collect()))
}

/// Rejects a record that is not a plausible ground motion, for example because its step of 5 ms is written as 5 s, or
/// because it has only three values.
fn require_strong_motion(record: &Record) -> Result<(), MotionError> {
    match record.channels.iter().find_map(Channel::implausible) {
        None => Ok(()),
        Some(found) => {
            Err(MotionError::mismatch(format!("{}: {}", record.file, found.what), found.advice))
        }
    }
}

/// Returns how a scaling combines both horizontal components; `None` if the scaling uses one component.
fn horizontals(of: MeasuredOn) -> Option<Horizontals> {
    match of {
        MeasuredOn::Component => None,
        MeasuredOn::RotD50 => Some(Horizontals::RotD50),
        MeasuredOn::RotD100 => Some(Horizontals::RotD100),
        MeasuredOn::GeometricMean => Some(Horizontals::GeometricMean),
    }
}

/// Scales the motion so that a measure of both horizontal components of its record reaches the specified value.
///
/// The components are processed like the motion. If `scale` does not specify a measure of both components, the motion
/// is returned unchanged.
fn scaled_by_both(
    motion: GroundMotion,
    record: &Record,
    processing: &Processing,
    scale: Scale,
) -> Result<GroundMotion, MotionError> {
    let Scale::Measure { measure, value, of } = scale else { return Ok(motion) };
    let Some(over) = horizontals(of) else { return Ok(motion) };
    let (first, second) = record.horizontals(processing)?;
    let factor = over.scale_factor(measure, &first, &second, value)?;
    let mut scaled = motion.scaled(factor);
    scaled.provenance.push(format!(
        "this factor scales {measure} ({over} of both horizontal components) to {value} {}",
        measure.unit()
    ));
    Ok(scaled)
}

/// Returns the requested processing; by default, [`Processing::compact`] for a raw record, and no processing for any
/// other record.
///
/// [`Processing::compact`] removes the pads that high-pass filtering adds. They are about half a minute of rest before
/// the first arrival, which a settled stack does not need. Velocity and displacement are then
/// corrected so that they end at zero.
fn processing_of(spec: &RecordMotion, record: &Record) -> Processing {
    match (spec.processing, record.stage) {
        (ProcessingSpec::Default, Stage::Raw) => Processing::compact(),
        (ProcessingSpec::None, _) | (_, Stage::Corrected | Stage::Unknown) => Processing::none(),
    }
}

/// Parses the name of a component: the name of a channel or, if no channel has this name, an azimuth in degrees.
fn component_of(record: &Record, name: Option<&str>) -> Result<Component, MotionError> {
    let Some(name) = name else {
        let horizontal = record.channels.iter().any(|channel| !channel.is_vertical());
        return Ok(if horizontal { Component::Horizontal1 } else { Component::Number(1) });
    };
    let by_name = Component::Name(name.to_owned());
    if record.component(&by_name).is_ok() {
        return Ok(by_name);
    }
    match name.trim().parse::<f64>() {
        Ok(azimuth) if azimuth.is_finite() => Ok(Component::Azimuth(azimuth)),
        _ if name.eq_ignore_ascii_case("up") => Ok(Component::Vertical),
        _ => name.parse(),
    }
}
