//! Specification of the ground motion of a scenario: its source and its scaling.

use barrelstack_input::{FileRef, named};
use barrelstack_motion::IntensityMeasure;

mod fields;
mod text;

pub use fields::{MOTION, PULSE, SCALE, SHOCK, SINE, record_names};
pub use text::{read, read_shock, rest, write, write_sequence};

/// The source of the samples of a record.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordSource {
    /// A file.
    File(FileRef),
    /// A bundled record, by name.
    Bundled(String),
}

/// The vertical component.
#[derive(Debug, Clone, PartialEq)]
pub enum Vertical {
    /// Horizontal motion only.
    None,
    /// Another component of the same record, by name or azimuth.
    Component(String),
    /// A separate file.
    File(FileRef),
}

named! {
    /// Signal processing of a record.
    pub enum Processing {
        /// The default processing of the motion library.
        Default = "default",
        /// No processing: samples are used as they are.
        None = "none",
    }
}

/// A recorded motion.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordMotion {
    /// Source of the samples.
    pub source: RecordSource,
    /// Horizontal component: a name, an azimuth, `horizontal-1` or `horizontal-2`; `None` for the first.
    pub component: Option<String>,
    /// Vertical component.
    pub vertical: Vertical,
    /// Time step (s) for files that do not state their time step.
    pub time_step: Option<f64>,
    /// Acceleration (m/s²) of one file unit, for files that do not state their unit.
    pub unit: Option<f64>,
    /// Sensitivity (counts per m/s²) for files that contain counts.
    pub sensitivity: Option<f64>,
    /// Signal processing.
    pub processing: Processing,
    /// Advice on obtaining the file, for users who do not have it.
    pub obtain: Option<String>,
}

impl RecordMotion {
    /// Creates the specification of the first horizontal component of a record, with default processing.
    pub fn of(source: RecordSource) -> Self {
        Self {
            source,
            component: None,
            vertical: Vertical::None,
            time_step: None,
            unit: None,
            sensitivity: None,
            processing: Processing::Default,
            obtain: None,
        }
    }
}

/// Amplitude of a motion: the peak of the displacement, velocity or acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amplitude {
    /// Peak displacement (m).
    Displacement(f64),
    /// Peak velocity (m/s).
    Velocity(f64),
    /// Peak acceleration (m/s²).
    Acceleration(f64),
}

named! {
    /// Direction of an analytic motion.
    pub enum Direction {
        /// Along `x`.
        Horizontal = "horizontal",
        /// Along `z`.
        Vertical = "vertical",
    }
}

/// A harmonic motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sine {
    /// Amplitude.
    pub amplitude: Amplitude,
    /// Period (s).
    pub period: f64,
    /// Number of cycles, including ramps.
    pub cycles: f64,
    /// Number of cycles over which the amplitude grows from zero at the start; it falls to zero over the same number
    /// of cycles at the end.
    pub ramp_cycles: f64,
    /// Direction of the ground motion.
    pub direction: Direction,
}

/// Form of a pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PulseKind {
    /// Acceleration in the form of the second derivative of a Gaussian.
    Ricker,
    /// Acceleration in the form of half a cycle of a sine.
    HalfSine,
    /// Acceleration in the form of one full cycle of a sine.
    OneSine,
    /// Acceleration in the form of one full cycle of a cosine.
    OneCosine,
    /// Constant acceleration.
    Rectangular,
    /// Harmonic wave with a Gaussian envelope.
    Gabor {
        /// Width of the envelope, as a number of cycles.
        gamma: f64,
        /// Phase (rad).
        phase: f64,
    },
    /// Cycloidal pulse of type A (Jacobsen and Ayre): the ground moves forward and ends displaced.
    CycloidA,
    /// Cycloidal pulse of type B: the ground moves forward and returns to its initial position.
    CycloidB,
    /// Cycloidal pulse of type C: several cycles that start and end at rest.
    CycloidC {
        /// Number of cycles.
        cycles: u32,
    },
    /// Velocity pulse of Mavroeidis and Papageorgiou (2003).
    MavroeidisPapageorgiou {
        /// Parameter γ, which determines the oscillatory character of the pulse; greater than 1.
        gamma: f64,
        /// Phase (rad).
        phase: f64,
    },
}

/// A pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Form of the pulse.
    pub kind: PulseKind,
    /// Peak acceleration or peak velocity; never a displacement.
    pub amplitude: Amplitude,
    /// Period (s).
    pub period: f64,
    /// Time at which the pulse starts (s).
    pub start: f64,
    /// Direction of the ground motion.
    pub direction: Direction,
}

/// The source of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionSource {
    /// The ground stays at rest.
    None,
    /// A recorded motion.
    Record(RecordMotion),
    /// A harmonic motion.
    Sine(Sine),
    /// A pulse.
    Pulse(Pulse),
}

/// Scaling of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// The motion is multiplied by a factor; 1 leaves it as it is.
    Factor(f64),
    /// The motion is scaled to this peak horizontal acceleration (m/s²).
    Pga(f64),
    /// The motion is scaled to this peak horizontal velocity (m/s).
    Pgv(f64),
    /// The motion is scaled so that an intensity measure reaches a value. The measure must grow with the amplitude.
    Measure {
        /// The measure.
        measure: IntensityMeasure,
        /// Target value of the measure (SI units).
        value: f64,
        /// Components from which the measure is computed.
        of: MeasuredOn,
    },
}

named! {
    /// For a motion that is scaled to an intensity measure: the components from which this measure is computed.
    pub enum MeasuredOn {
        /// The horizontal component that drives the stack.
        Component = "component",
        /// Median of the measure over all horizontal directions, from both horizontal components of the record.
        RotD50 = "rotd50",
        /// Maximum of the measure over all horizontal directions, from both horizontal components of the record.
        RotD100 = "rotd100",
        /// Geometric mean of the measures of both horizontal components of the record.
        GeometricMean = "geomean",
    }
}

/// The ground motion of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionSpec {
    /// Source of the motion.
    pub source: MotionSource,
    /// Scaling of the motion, by the same factor for all components.
    pub scale: Scale,
    /// Length scale `λ` of Froude similitude, applied to the motion alone: times are multiplied by `√λ`, accelerations
    /// are unchanged.
    pub similitude: f64,
}

impl MotionSpec {
    /// Returns the files of the motion: the file of the record, then the separate file of the vertical component. A
    /// bundled record has no file.
    pub fn files_mut(&mut self) -> impl Iterator<Item = &mut FileRef> {
        let record = match &mut self.source {
            MotionSource::Record(record) => Some(record),
            MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_) => None,
        };
        record.into_iter().flat_map(|RecordMotion { source, vertical, .. }| {
            let source = match source {
                RecordSource::File(file) => Some(file),
                RecordSource::Bundled(_) => None,
            };
            let vertical = match vertical {
                Vertical::File(file) => Some(file),
                Vertical::None | Vertical::Component(_) => None,
            };
            source.into_iter().chain(vertical)
        })
    }

    /// Returns the loaded files of the motion: the name of each, without folders, and the
    /// fingerprint of its content.
    pub fn fingerprints(&self) -> Vec<(String, String)> {
        let mut same = self.clone();
        let held = same.files_mut().filter(|file| file.is_held());
        let print = |file: &mut FileRef| {
            let name = file.resolve().file_name().map(|name| name.to_string_lossy().into_owned());
            (name.unwrap_or_default(), file.by_content().path)
        };
        held.map(print).collect()
    }

    /// Returns the motion with every loaded file identified by its content instead of its path.
    #[must_use]
    pub fn by_content(&self) -> Self {
        let mut same = self.clone();
        for file in same.files_mut() {
            *file = file.by_content();
        }
        same
    }
}
