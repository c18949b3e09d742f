//! The ground motion of a scenario: read or made, scaled, and ready to drive.

mod failure;
mod formula;
mod planes;

use std::path::{Path, PathBuf};

use barrelstack_dynamics::{Drive, Planar, Vec2};
use barrelstack_motion::{
    AccelerationUnit, Channel, Component, Given, GroundMotion, Horizontals, IntensityMeasure,
    MotionError, Processing, ReadFailure, ReadOptions, Record, Refusal,
};

use barrelstack_report::described;

use crate::scenario::{
    FileRef, MeasuredOn, MotionSource, MotionSpec, Processing as ProcessingSpec, RecordMotion,
    RecordSource, Scale, Scenario, Vertical,
};
use crate::system;

pub use failure::GroundError;
pub use planes::other_component;

described! {
    /// What shook it.
    #[derive(Clone, Debug)]
    pub struct MotionSummary of motion: &GroundMotion {
        /// Its name.
        pub name: String = motion.name.clone(),
        /// Peak horizontal acceleration (m/s²).
        pub pga: f64 as "m/s2" = motion.pga(),
        /// Peak horizontal velocity (m/s).
        pub pgv: f64 as "m/s" = motion.pgv(),
        /// Peak horizontal displacement (m).
        pub pgd: f64 as "m" = motion.pgd(),
        /// Whether there is a vertical component.
        pub vertical: bool = motion.vertical.is_some(),
        /// When the shaking ends.
        pub duration: f64 as "s" = motion.duration,
    }
}

/// What moves the ground of a run.
///
/// ```
/// use barrelstack_stack::Scenario;
///
/// let ground = Scenario::builtin("demo-napa", &[])?.ground()?;
/// let motion = ground.motion.as_ref().expect("a record moves");
/// assert!(motion.vertical.is_some() && ground.end() == motion.duration);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Ground {
    /// The motion; none for ground at rest.
    pub motion: Option<GroundMotion>,
    /// What the readers noticed, one sentence each.
    pub warnings: Vec<String>,
}

impl Ground {
    /// Scales and stretches its motion as a scenario says.
    fn rescale(&mut self, spec: &MotionSpec, similitude: f64) -> Result<(), MotionError> {
        if let Some(motion) = self.motion.take() {
            self.motion = Some(scaled(motion, spec, similitude)?);
        }
        Ok(())
    }

    /// From when on (s) none of its accelerations exceeds a limit (m/s²).
    pub fn calm_from(&self, limit: f64) -> f64 {
        self.motion.as_ref().map_or(0.0, |motion| motion.calm_from(limit))
    }

    /// When (s) it is still: the end of its motion.
    pub fn end(&self) -> f64 {
        self.motion.as_ref().map_or(0.0, |motion| motion.duration)
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

/// Largest record (bytes) that is read; the longest strong-motion files have a tenth of it.
pub const RECORD_LIMIT: usize = 256 << 20;

impl Scenario {
    /// Reads or makes its motion, scaled as it says.
    ///
    /// # Errors
    /// When a record cannot be read, lacks the component asked for, or cannot be scaled.
    pub fn ground(&self) -> Result<Ground, GroundError> {
        of_spec(&self.motion, self.run.similitude)
    }

    /// The ground under a record at hand, in place of its own motion.
    ///
    /// Components, processing and scale are those that the scenario states; where its own motion is no
    /// record, the first horizontal component with the default processing.
    ///
    /// ```
    /// use barrelstack_stack::Scenario;
    ///
    /// let record = barrelstack_motion::bundled("napa-college-2014").expect("a bundled record");
    /// let scenario =
    ///     Scenario::builtin("candia-8-barrels", &["motion.scale.pgv=60 cm/s".to_owned()])?;
    /// let motion = scenario.ground_of(&record)?.motion.expect("a record moves");
    /// assert!((motion.pgv() - 0.6).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the record lacks a component asked for, or cannot be scaled.
    pub fn ground_of(&self, record: &Record) -> Result<Ground, GroundError> {
        let spec = self.recorded(RecordSource::Bundled(record.file.clone()));
        let mut ground = shaken_by(record, &spec, self.motion.scale)?;
        let spec = MotionSpec { source: MotionSource::Record(spec), ..self.motion.clone() };
        ground.rescale(&spec, self.run.similitude)?;
        Ok(ground)
    }

    /// The scenario with the records of its motion at hand, which `fetch` has given by their paths, so that
    /// whatever is made of it opens no file; what is at hand already is not fetched.
    ///
    /// [`from_disk`] is how a run fetches by itself.
    /// What `fetch` says where it has nothing is what the system would say, such as "there is no such file".
    ///
    /// ```
    /// use barrelstack_stack::Scenario;
    ///
    /// let scenario = Scenario::builtin("candia-6-barrels", &["run.duration=2 s".to_owned()])?;
    /// let record = barrelstack_motion::bundled("napa-college-2014").expect("a bundled record");
    /// let bytes = barrelstack_motion::write::text(&record)?.into_bytes();
    /// let scenario = scenario.with_records(&mut |_| Ok(bytes.clone()))?;
    /// assert!(scenario.run()?.ground.motion.is_some());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When `fetch` has none.
    pub fn with_records(
        &self,
        fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Self, GroundError> {
        let mut held = self.clone();
        if let MotionSource::Record(record) = &mut held.motion.source {
            let obtain = how_to_obtain(record);
            if let RecordSource::File(file) = &mut record.source {
                hold(file, &obtain, fetch)?;
            }
            if let Vertical::File(file) = &mut record.vertical {
                hold(file, OTHER_VERTICAL, fetch)?;
            }
        }
        Ok(held)
    }

    /// The scenario shaken by a record at hand, in place of its own motion; components, processing and scale
    /// are those that it states.
    ///
    /// # Errors
    /// When the record has no channel, or channels of different steps.
    pub fn with_record(&self, record: &Record) -> Result<Self, MotionError> {
        Ok(self.with_record_file(&held(record)?))
    }

    /// As [`Scenario::with_record`], by a file that is at hand ([`held`]), so that many scenarios share one.
    #[must_use]
    pub fn with_record_file(&self, file: &FileRef) -> Self {
        let mut scenario = self.clone();
        let source = RecordSource::File(file.clone());
        scenario.motion.source = MotionSource::Record(self.recorded(source));
        scenario.retitle();
        scenario
    }

    /// What it states of its record, of another one; where it has none, the first horizontal component with the
    /// default processing.
    fn recorded(&self, source: RecordSource) -> RecordMotion {
        match &self.motion.source {
            MotionSource::Record(own) => RecordMotion { source, ..own.clone() },
            MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_) => {
                RecordMotion::of(source)
            }
        }
    }
}

/// A record as a file that is at hand.
///
/// # Errors
/// When the record has no channel, or channels of different steps.
pub fn held(record: &Record) -> Result<FileRef, MotionError> {
    let mut file = FileRef::new(&record.file, PathBuf::new());
    file.hold(barrelstack_motion::write::npz(record)?);
    Ok(file)
}

/// The bytes of a file of the system, as [`Scenario::with_records`] takes them.
///
/// # Errors
/// In words, when it cannot be read, or has more than any record.
pub fn from_disk(path: &Path) -> Result<Vec<u8>, String> {
    system::read(path, RECORD_LIMIT)
}

/// Has a file at hand from now on.
fn hold(
    file: &mut FileRef,
    obtain: &str,
    fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
) -> Result<(), GroundError> {
    if !file.is_held() {
        let path = file.resolve();
        file.hold(fetch(&path).map_err(|reason| unreadable(path, reason, obtain))?);
    }
    Ok(())
}

fn unreadable(path: PathBuf, reason: String, obtain: &str) -> GroundError {
    GroundError::Unreadable { path, reason, obtain: obtain.to_owned() }
}

/// How to come by the file of a record, as a sentence that goes on from why it cannot be read.
fn how_to_obtain(record: &RecordMotion) -> String {
    record.obtain.as_ref().map_or_else(|| "; correct the path".to_owned(), |how| format!("; {how}"))
}

/// The same for the file of a vertical component.
const OTHER_VERTICAL: &str = "; correct motion.vertical";

/// Reads or makes a motion, scaled as it says, for a stack of a length scale.
///
/// # Errors
/// As [`Scenario::ground`].
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

/// A motion scaled and stretched as a scenario says, for a stack of a length scale.
///
/// # Errors
/// When it cannot be scaled so.
pub fn scaled(
    mut motion: GroundMotion,
    spec: &MotionSpec,
    run_scale: f64,
) -> Result<GroundMotion, MotionError> {
    match spec.scale {
        Scale::Factor(factor) => {
            if factor != 1.0 {
                motion = motion.scaled(factor);
            }
        }
        Scale::Pga(target) => motion = motion.scale_to(IntensityMeasure::Pga, target)?,
        Scale::Pgv(target) => motion = motion.scale_to(IntensityMeasure::Pgv, target)?,
        Scale::Measure { measure, value, of } => match (horizontals(of), &spec.source) {
            (None, _) => motion = motion.scale_to(measure, value)?,
            // Scaled where it was read, with both horizontals at hand.
            (Some(_), MotionSource::Record(_)) => {}
            (Some(over), MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_)) => {
                return Err(MotionError::NotScalable {
                    measure: format!("{measure}, {over} of both horizontals,"),
                    reason: "only a record has two".to_owned(),
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

/// The event of the record that shakes a scenario, as people say it; none where no file says.
pub(crate) fn event(spec: &MotionSpec) -> Result<Option<String>, GroundError> {
    match &spec.source {
        MotionSource::Record(record) => Ok(read(record)?.event_name()),
        MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_) => Ok(None),
    }
}

/// What the readers of files should know that a scenario states.
fn read_options(spec: &RecordMotion) -> Result<ReadOptions, GroundError> {
    Ok(ReadOptions {
        unit: spec.unit.map(unit).transpose()?,
        time_step: spec.time_step,
        sensitivity: spec.sensitivity,
        ..ReadOptions::default()
    })
}

fn read(spec: &RecordMotion) -> Result<Record, GroundError> {
    let options = read_options(spec)?;
    match &spec.source {
        RecordSource::Bundled(name) => {
            barrelstack_motion::bundled(name).ok_or_else(|| GroundError::UnknownBundled {
                name: name.clone(),
                known: barrelstack_motion::BUNDLED.join(", "),
            })
        }
        RecordSource::File(file) => read_file(file, &options, &how_to_obtain(spec)),
    }
}

/// The components that a scenario asks for of a record, processed as it says.
fn shaken_by(record: &Record, spec: &RecordMotion, scale: Scale) -> Result<Ground, GroundError> {
    require_strong_motion(record)?;
    let mut warnings: Vec<String> =
        record.warnings.iter().map(|w| format!("{}: {w}", record.file)).collect();
    let horizontal = component_of(record, spec.component.as_deref())?;
    let processing = match spec.processing {
        ProcessingSpec::None => Processing::none(),
        ProcessingSpec::Default => default_processing(record),
    };
    let motion = match &spec.vertical {
        Vertical::None => record.ground_motion(&horizontal, None, &processing)?,
        Vertical::Component(name) => {
            let vertical = component_of(record, Some(name))?;
            match record.component(&vertical) {
                Ok(_) => record.ground_motion(&horizontal, Some(&vertical), &processing)?,
                // A file of one's own, in place of the scenario's.
                Err(_) if !record.channels.iter().any(Channel::is_vertical) => {
                    let file = &record.file;
                    let told = format!("{file} has no vertical component: it shakes sideways only");
                    warnings.push(told);
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
            let (record, other, told) = on_one_clock(record, &horizontal, other)?;
            warnings.extend(told);
            let theirs = match spec.processing {
                ProcessingSpec::None => Processing::none(),
                ProcessingSpec::Default => default_processing(&other),
            };
            let vertical = other.ground_motion(&Component::Number(1), None, &theirs)?;
            let mut motion = record.ground_motion(&Component::Number(1), None, &processing)?;
            motion.provenance.extend(vertical.provenance);
            let provenance = motion.provenance;
            let mut joined =
                GroundMotion::new(motion.name, motion.horizontal, Some(vertical.horizontal));
            joined.provenance = provenance;
            joined
        }
    };
    let mut motion = scaled_by_both(motion, record, &processing, scale)?;
    motion.name = record.name_of(&record.component(&horizontal)?);
    Ok(Ground { motion: Some(motion), warnings })
}

/// A horizontal component and the first channel of the file that was named for the vertical, beginning
/// together where both tell when they begin; and what should be known about taking them together.
fn on_one_clock(
    record: &Record,
    horizontal: &Component,
    mut other: Record,
) -> Result<(Record, Record, Vec<String>), MotionError> {
    let told = record.unlike(&other).map(|what| format!("taken together although {what}"));
    let mut both = record.clone();
    both.channels = vec![record.component(horizontal)?];
    both.channels.extend(std::mem::take(&mut other.channels).into_iter().take(1));
    both.notes.clear();
    both.align()?;
    let vertical = both.channels.split_off(1);
    let second = Record { channels: vertical, ..other };
    let mut first = Record { channels: both.channels, ..record.clone() };
    first.notes.extend(both.notes);
    Ok((first, second, told.into_iter().collect()))
}

/// Refuses what no ground can have done: a step of 5 ms written as 5 s, a file of three values.
fn require_strong_motion(record: &Record) -> Result<(), MotionError> {
    match record.channels.iter().find_map(Channel::implausible) {
        None => Ok(()),
        Some(what) => Err(MotionError::Mismatch {
            what: format!("{}: {what}", record.file),
            remedy: "correct the step or the unit, or give another record".to_owned(),
        }),
    }
}

/// The measure of both horizontals that a scaling is about; none if it is about one component.
fn horizontals(of: MeasuredOn) -> Option<Horizontals> {
    match of {
        MeasuredOn::Component => None,
        MeasuredOn::RotD50 => Some(Horizontals::RotD50),
        MeasuredOn::RotD100 => Some(Horizontals::RotD100),
        MeasuredOn::GeometricMean => Some(Horizontals::GeometricMean),
    }
}

/// The motion scaled by what both horizontals of its record measure, processed alike.
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
        "that factor brings {measure}, {over} of both horizontals, to {value} {}",
        measure.unit()
    ));
    Ok(scaled)
}

/// The default processing of a record's stage, its pads cut off again.
///
/// Pads hold half a minute of stillness before the first arrival, which a stack at rest does not need;
/// what cutting them leaves at the ends is closed.
fn default_processing(record: &Record) -> Processing {
    let full = Processing::for_stage(record.stage);
    if full.is_none() { full } else { Processing::compact() }
}

fn read_file(file: &FileRef, options: &ReadOptions, obtain: &str) -> Result<Record, GroundError> {
    let path = file.resolve();
    let bytes =
        file.read(RECORD_LIMIT).map_err(|reason| unreadable(path.clone(), reason, obtain))?;
    let record = barrelstack_motion::read(&bytes, &path.display().to_string(), options);
    // A page says which file it was, and not where it lies.
    let named = |record: Record| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        Record { file: name.unwrap_or_else(|| record.file.clone()), ..record }
    };
    record.map(named).map_err(|error| {
        let mut failure: ReadFailure = (*error).clone();
        // The reader knows what is missing, the scenario where to state it.
        if let Refusal::Missing(given) = failure.refusal {
            failure.remedy += match given {
                Given::UnitOrSensitivity => {
                    " in the scenario, as motion.unit = \"1 g\" or motion.sensitivity = 427819"
                }
                Given::Unit => " in the scenario, for example motion.unit = \"1 g\"",
                Given::Step => " in the scenario, for example motion.time_step = \"0.01 s\"",
                Given::Sensitivity => " in the scenario, for example motion.sensitivity = 427819",
            };
        }
        GroundError::Read(failure.into())
    })
}

fn unit(meters_per_second_squared: f64) -> Result<AccelerationUnit, GroundError> {
    [
        AccelerationUnit::G,
        AccelerationUnit::TenthG,
        AccelerationUnit::MetersPerSecondSquared,
        AccelerationUnit::Gal,
        AccelerationUnit::MillimetersPerSecondSquared,
    ]
    .into_iter()
    .find(|unit| (unit.factor() / meters_per_second_squared - 1.0).abs() < 1e-6)
    .ok_or(GroundError::Unit { unit: meters_per_second_squared })
}

/// A component as people name it: the channel's own name first, then an azimuth in degrees.
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
