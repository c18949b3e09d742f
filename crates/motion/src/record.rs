//! A ground-motion record as read from a file: channels in SI units, and all data of the header.

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

/// Processing of a record before it was published.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// Uncorrected. The velocity and the displacement drift when they are integrated from the acceleration.
    Raw,
    /// Filtered and baseline-corrected, by the publisher or later.
    Corrected,
    /// The file does not state the processing.
    #[default]
    Unknown,
}

printed_as!(Stage, Raw = "raw", Corrected = "corrected", Unknown = "unknown");

/// Physical quantity of a peak or of samples.
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

/// A peak stated in a header, with the actual peak of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedPeak {
    /// Quantity of the peak.
    pub quantity: Quantity,
    /// Absolute value stated in the header (SI).
    pub stated: f64,
    /// Value of one unit in the last printed digit of the stated peak (SI).
    pub resolution: f64,
    /// Absolute peak of the samples in the file (SI).
    pub measured: f64,
}

impl StatedPeak {
    /// Returns `true` if the two peaks agree within one unit of the last printed digit or within
    /// 0.1 %.
    pub fn agrees(&self) -> bool {
        (self.stated - self.measured).abs() <= (1.001 * self.resolution).max(1e-3 * self.stated)
    }
}

/// One component of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// Channel name in the file, such as `360` or `N28W`.
    pub name: String,
    /// Direction of positive values. The sign of a channel that was positive downward has been reversed.
    pub direction: Direction,
    /// Time between samples (s).
    pub time_step: f64,
    /// Acceleration at the samples (m/s²).
    pub acceleration: Vec<f64>,
    /// Velocity at the first sample (m/s), as stated by some corrected records; otherwise 0.
    pub initial_velocity: f64,
    /// Time of the first sample, if stated in the file.
    pub start: Option<Utc>,
    /// Station, sensor and coordinates.
    pub site: Site,
    /// Peaks stated in the header.
    pub peaks: Vec<StatedPeak>,
}

impl Channel {
    /// Adds a peak acceleration that the header states in units of `factor` m/s², together with the actual peak of the
    /// samples.
    pub(crate) fn state_peak(&mut self, stated: Option<Printed>, factor: f64) {
        let measured = math::peak(&self.acceleration);
        self.state(Quantity::Acceleration, stated, factor, measured);
    }

    /// Adds a stated peak of any quantity, as [`Channel::state_peak`] does; `measured` is the
    /// actual peak (SI).
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

    /// Creates a channel that starts from rest and has no stated peaks.
    pub fn new(
        name: impl Into<String>,
        direction: Direction,
        time_step: f64,
        acceleration: Vec<f64>,
    ) -> Self {
        Self { name: name.into(), direction, time_step, acceleration, ..Self::default() }
    }

    /// Creates a channel by sampling a synthetic motion at steps of at most `time_step` (s).
    ///
    /// # Errors
    /// The same as for [`History::sampled`].
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

    /// Returns the peak velocity (m/s), integrated from [`Channel::initial_velocity`] without
    /// filtering. For a raw record, this is mostly drift.
    pub fn pgv(&self) -> f64 {
        math::peak(&self.velocity())
    }

    /// Returns the peak displacement (m), integrated by the trapezoidal rule without filtering.
    pub fn pgd(&self) -> f64 {
        math::peak(&crate::sampled::running_trapezoid(self.time_step, &self.velocity()))
    }

    /// Returns the reason why the channel cannot be a strong-motion record: its time step, its number of
    /// samples or its duration, with advice. Returns `None` if all three are plausible.
    pub fn implausible(&self) -> Option<Implausible> {
        let (step, count, length) = (self.time_step, self.acceleration.len(), self.duration());
        let found = |what: String, advice| {
            Some(Implausible { what: format!("channel {} has {what}", self.name), advice })
        };
        if !(1e-4..=0.1).contains(&step) {
            let what = format!(
                "a step of {step} s, but strong-motion records have steps of 0.0001 to 0.1 s"
            );
            return found(what, "correct the time step or its unit");
        }
        if count < 50 {
            let samples = if count == 1 { "sample" } else { "samples" };
            let what = format!(
                "only {count} {samples} ({length:.3} s), but strong-motion records have at least 50 samples"
            );
            return found(what, WHOLE_RECORD);
        }
        if length < 1.0 {
            let what = format!(
                "a length of {length} s ({count} samples at a step of {step} s), but strong-motion records last at \
                 least 1 s"
            );
            return found(what, "correct the time step, or give the whole record");
        }
        None
    }

    pub(crate) fn velocity(&self) -> Vec<f64> {
        crate::sampled::integrate(self.time_step, &self.acceleration, self.initial_velocity).0
    }

    /// Returns `true` if the channel is known to be vertical.
    pub fn is_vertical(&self) -> bool {
        self.direction.orientation == Some(Orientation::Vertical)
    }
}

/// Advice about a record of a few samples.
const WHOLE_RECORD: &str = "the file is an excerpt or is truncated: give the whole record, or get the file again from \
                            its source";

/// Reason why a channel cannot be a strong-motion record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Implausible {
    /// The channel, and what is implausible about it.
    pub what: String,
    /// What the user can do.
    pub advice: &'static str,
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

/// A warning that a reader gives about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Line number, counted from 1; `None` if the warning concerns no single line.
    pub line: Option<usize>,
    /// Text of the warning.
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

/// A ground-motion record as read from a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Name of the format, as in [`crate::FORMATS`]; `samples` for a record created from samples in
    /// memory.
    pub format: &'static str,
    /// Name of the file.
    pub file: String,
    /// Event, as stated in the file; empty if not stated.
    pub event: String,
    /// Magnitude and location of the earthquake, as far as stated in the file.
    pub earthquake: Earthquake,
    /// Station, as stated in the file; empty if not stated.
    pub station: String,
    /// Processing before publication.
    pub stage: Stage,
    /// Channels, in file order.
    pub channels: Vec<Channel>,
    /// Warnings from the reader.
    pub warnings: Vec<Warning>,
    /// `true` if the caller allowed the combination of channels of different stations or sensors;
    /// never set by readers.
    pub mixed: bool,
    /// Changes made to the numbers by the reader, other than unit conversion, one sentence each.
    pub notes: Vec<String>,
}

impl Record {
    pub(crate) fn new(format: &'static str, file: &str, stage: Stage) -> Self {
        Self { format, file: file.to_owned(), stage, ..Self::default() }
    }

    /// Creates a record from samples in memory: named channels with a common step (s) and unit.
    ///
    /// As in files, names state directions ([`Direction::parse`]): `360`, `N28W`, `H1`, `UP`; the
    /// sign of a downward channel is reversed. The stage is unknown, so that the numbers are used unchanged;
    /// set [`Record::stage`] to [`Stage::Raw`] to have them processed by default.
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
    /// If the step is not positive, a channel has fewer than two samples, or a value is not a
    /// possible acceleration.
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

    /// Creates a record by sampling a synthetic motion at steps of at most `time_step` (s).
    ///
    /// The horizontal component is named `H1`, a vertical component `UP`. The notes are the
    /// provenance of the motion. The default processing leaves the numbers unchanged.
    ///
    /// # Errors
    /// The same as for [`History::sampled`].
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

    /// Sets the start and the site of all channels. If `site` states no station, the station of the record is filled in
    /// when reading ends.
    pub(crate) fn place(&mut self, start: Option<Utc>, site: &Site) {
        for channel in &mut self.channels {
            channel.start = start;
            channel.site = site.clone();
        }
    }

    /// Adds a warning if `stated` is not empty and `start` is `None`, that is, if the stated start
    /// could not be parsed. `line` is counted from 0. Channels without a start are assumed to be
    /// simultaneous.
    pub(crate) fn warn_of_start(&mut self, line: usize, stated: &str, start: Option<Utc>) {
        if start.is_none() && !stated.trim().is_empty() {
            let stated = format::quoted(stated);
            self.warn(
                line + 1,
                format!("{stated} is not a valid date and time of the first sample"),
            );
        }
    }

    pub(crate) fn warn(&mut self, line: impl Into<Option<usize>>, message: impl Into<String>) {
        self.warnings.push(Warning { line: line.into(), message: message.into() });
    }
}
