//! A file as read: its channels in SI units, with all data of the header.

use std::fmt;

use crate::direction::{Direction, Orientation};
use crate::earthquake::Earthquake;
use crate::error::MotionError;
use crate::format::{self, Printed, Source};
use crate::ground_motion::GroundMotion;
use crate::history::History;
use crate::math;
use crate::site::Site;
use crate::units::AccelerationUnit;
use crate::utc::Utc;

/// Stage of processing before the record was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// As recorded; velocity and displacement drift when it is integrated.
    Raw,
    /// Filtered and baseline-corrected, by its publisher or later.
    Corrected,
    /// Not stated in the file.
    #[default]
    Unknown,
}

printed_as!(Stage, Raw = "raw", Corrected = "corrected", Unknown = "unknown");

/// Quantity of a peak or of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Acceleration (m/s²).
    Acceleration,
    /// Velocity (m/s).
    Velocity,
    /// Displacement (m).
    Displacement,
}

printed_as!(
    Quantity,
    Acceleration = "acceleration",
    Velocity = "velocity",
    Displacement = "displacement"
);

/// A peak stated in a header with the peak of the numbers it describes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedPeak {
    /// Its quantity.
    pub quantity: Quantity,
    /// Absolute value stated (SI).
    pub stated: f64,
    /// One unit of the last printed digit (SI).
    pub resolution: f64,
    /// Absolute peak of the file's own numbers for this quantity (SI).
    pub measured: f64,
}

impl StatedPeak {
    /// `true` if the two agree within one unit of the last printed digit or 0.1 %.
    pub fn agrees(&self) -> bool {
        (self.stated - self.measured).abs() <= (1.001 * self.resolution).max(1e-3 * self.stated)
    }
}

/// One component as read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// Name in the file, such as `360` or `N28W`.
    pub name: String,
    /// Direction; a downward channel has been reversed.
    pub direction: Direction,
    /// Time between samples (s).
    pub time_step: f64,
    /// Acceleration (m/s²).
    pub acceleration: Vec<f64>,
    /// Velocity at the first sample (m/s), stated by some corrected records; 0 otherwise.
    pub initial_velocity: f64,
    /// Instant of the first sample, if stated in the file.
    pub start: Option<Utc>,
    /// Station, sensor and place.
    pub site: Site,
    /// Peaks stated in the header.
    pub peaks: Vec<StatedPeak>,
}

impl Channel {
    /// Adds the peak acceleration that a header states in a unit of `factor` m/s², with the peak of the samples.
    pub(crate) fn state_peak(&mut self, stated: Option<Printed>, factor: f64) {
        let measured = math::peak(&self.acceleration);
        self.state(Quantity::Acceleration, stated, factor, measured);
    }

    /// Adds a stated peak, as [`Channel::state_peak`], of any quantity, with the peak `measured` in SI.
    pub(crate) fn state(
        &mut self,
        quantity: Quantity,
        stated: Option<Printed>,
        factor: f64,
        measured: f64,
    ) {
        if let Some(Printed { value, resolution }) = stated {
            let (stated, resolution) = (value.abs() * factor, resolution * factor);
            self.peaks.push(StatedPeak { quantity, stated, resolution, measured });
        }
    }

    /// Creates a channel without stated peaks, starting from rest.
    pub fn new(
        name: impl Into<String>,
        direction: Direction,
        time_step: f64,
        acceleration: Vec<f64>,
    ) -> Self {
        Self { name: name.into(), direction, time_step, acceleration, ..Self::default() }
    }

    /// Samples a synthetic motion as a channel, at steps of at most `time_step` (s).
    ///
    /// # Errors
    /// As [`History::sampled`].
    pub fn of_history(
        name: &str,
        direction: Direction,
        history: &History,
        time_step: f64,
    ) -> Result<Self, MotionError> {
        let sampled = history.sampled(time_step)?;
        let acceleration = sampled.acceleration().to_vec();
        let channel = Self::new(name, direction, sampled.time_step(), acceleration);
        Ok(Self { initial_velocity: sampled.velocity()[0], ..channel })
    }

    /// Returns the time from the first to the last sample (s).
    pub fn duration(&self) -> f64 {
        self.time_step * self.acceleration.len().saturating_sub(1) as f64
    }

    /// Returns the peak ground acceleration (m/s²).
    pub fn pga(&self) -> f64 {
        math::peak(&self.acceleration)
    }

    /// Returns the peak velocity (m/s) by plain integration from [`Channel::initial_velocity`]; of a raw record
    /// this is drift, not ground motion.
    pub fn pgv(&self) -> f64 {
        math::peak(&self.velocity())
    }

    /// Returns the peak displacement (m) by plain integration, trapezoids throughout.
    pub fn pgd(&self) -> f64 {
        math::peak(&crate::sampled::running_trapezoid(self.time_step, &self.velocity()))
    }

    /// Returns the reason why this cannot be a strong motion, by step, count or length.
    pub fn implausible(&self) -> Option<String> {
        let (step, count, length) = (self.time_step, self.acceleration.len(), self.duration());
        let what = if !(1e-4..=0.1).contains(&step) {
            format!("a step of {step} s, and strong motion has 0.0001 to 0.1 s")
        } else if count < 50 {
            format!("{count} samples, and no strong motion has fewer than 50")
        } else if length < 1.0 {
            format!("a length of {length} s, and no strong motion has less than 1 s")
        } else {
            return None;
        };
        Some(format!("channel {} has {what}", self.name))
    }

    pub(crate) fn velocity(&self) -> Vec<f64> {
        crate::sampled::integrate(self.time_step, &self.acceleration, self.initial_velocity).0
    }

    /// `true` if the channel is known to be vertical.
    pub fn is_vertical(&self) -> bool {
        self.direction.orientation == Some(Orientation::Vertical)
    }
}

/// Warning of a reader about something that it did not guess.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Line, counted from 1, if any.
    pub line: Option<usize>,
    /// The observation.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.message)
    }
}

/// A file as read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Name of the format, as in [`crate::FORMATS`]; `samples` if made from samples.
    pub format: &'static str,
    /// Name of the file.
    pub file: String,
    /// Event as stated in the file; empty if not stated.
    pub event: String,
    /// Magnitude and place of the event, as far as stated in the file.
    pub earthquake: Earthquake,
    /// Station as stated in the file; empty if not stated.
    pub station: String,
    /// Stage of processing.
    pub stage: Stage,
    /// Channels in file order.
    pub channels: Vec<Channel>,
    /// Warnings of the reader.
    pub warnings: Vec<Warning>,
    /// `true` if channels of different stations and sensors may be combined, at the caller's request; readers never
    /// set it.
    pub mixed: bool,
    /// Changes of the numbers by the reader beyond units, one sentence each.
    pub notes: Vec<String>,
}

impl Record {
    pub(crate) fn new(format: &'static str, file: &str, stage: Stage) -> Self {
        Self { format, file: file.to_owned(), stage, ..Self::default() }
    }

    /// Creates a record from samples in memory: channels by name, all of one step (s) and one unit.
    ///
    /// Names state directions as in files ([`Direction::parse`]): `360`, `N28W`, `H1`, `UP`; a downward channel is
    /// reversed.
    /// Its stage is unknown, so that the numbers are used unchanged; set [`Record::stage`] to [`Stage::Raw`] to
    /// have them processed by default.
    ///
    /// ```
    /// use barrelstack_motion::{AccelerationUnit, Record};
    /// let shake: Vec<f64> = (0..400).map(|at| 0.2 * (f64::from(at) * 0.1).sin()).collect();
    /// let record = Record::of_samples("table", &[("H1", &shake)], 0.01, AccelerationUnit::G)?;
    /// assert!((record.channels[0].pga() - 0.2 * 9.80665).abs() < 1e-3);
    /// # Ok::<(), barrelstack_motion::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// When the step is not positive, a channel has fewer than two samples, or a value is not an acceleration.
    pub fn of_samples(
        name: &str,
        channels: &[(&str, &[f64])],
        time_step: f64,
        unit: AccelerationUnit,
    ) -> Result<Self, MotionError> {
        MotionError::require_positive("time step (s)", time_step)?;
        let mut record = Self::new("samples", name, Stage::Unknown);
        for (channel, samples) in channels {
            if let Some(at) = samples.iter().position(|sample| !sample.is_finite()) {
                let what = format!("acceleration ({unit}) {} of channel {channel}", at + 1);
                return Err(MotionError::parameter(what, "a finite number", samples[at]));
            }
            let acceleration = samples.iter().map(|sample| sample * unit.factor()).collect();
            let direction = Direction::parse(channel);
            record.channels.push(Channel::new(*channel, direction, time_step, acceleration));
        }
        format::finish(&Source::new(name, &[]), &mut record).map_err(|error| {
            let what = format!("{name}: expected {}, found {}", error.expected, error.found);
            MotionError::mismatch(what, "correct the samples, their step or their unit")
        })?;
        Ok(record)
    }

    /// Samples a synthetic motion as a record, at steps of at most `time_step` (s): its horizontal component `H1`, and
    /// `UP` if it has a vertical one.
    ///
    /// Its notes are the motion's provenance, and its numbers are used unchanged.
    ///
    /// # Errors
    /// As [`History::sampled`].
    pub fn of_motion(motion: &GroundMotion, time_step: f64) -> Result<Self, MotionError> {
        let mut record = Self::new("synthetic", &motion.name, Stage::Corrected);
        record.event.clone_from(&motion.name);
        "synthetic".clone_into(&mut record.station);
        record.notes.clone_from(&motion.provenance);
        let across =
            Channel::of_history("H1", Direction::some_horizontal(), &motion.horizontal, time_step)?;
        record.channels.push(across);
        if let Some(vertical) = &motion.vertical {
            record.channels.push(Channel::of_history("UP", Direction::up(), vertical, time_step)?);
        }
        Ok(record)
    }

    /// Sets start and place of all channels; the station is filled in at the end of reading.
    pub(crate) fn place(&mut self, start: Option<Utc>, site: &Site) {
        for channel in &mut self.channels {
            channel.start = start;
            channel.site = site.clone();
        }
    }

    /// Warns of a stated start (on a 0-based line) that could not be parsed, without which channels are taken as
    /// simultaneous.
    pub(crate) fn warn_of_start(&mut self, line: usize, stated: &str, start: Option<Utc>) {
        if start.is_none() && !stated.trim().is_empty() {
            let stated = format::quoted(stated);
            self.warn(line + 1, format!("{stated} is no date and time of a first sample"));
        }
    }

    pub(crate) fn warn(&mut self, line: impl Into<Option<usize>>, message: impl Into<String>) {
        self.warnings.push(Warning { line: line.into(), message: message.into() });
    }
}
