//! The ground motion: where it comes from and how it is scaled.

use std::path::PathBuf;

use super::catalog;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// A file named by a scenario.
#[derive(Debug, Clone)]
pub struct FileRef {
    /// The path as written.
    pub path: String,
    /// Folder of the file that wrote it; empty for the current folder.
    pub folder: PathBuf,
}

impl FileRef {
    /// The path to open.
    pub fn resolve(&self) -> PathBuf {
        self.folder.join(&self.path)
    }
}

/// Two references are equal when they were written alike, so that a scenario keeps its identity when its folder
/// moves.
impl PartialEq for FileRef {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

/// Where the samples of a record are.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordSource {
    /// A file.
    File(FileRef),
    /// A record shipped with the program, by name.
    Bundled(String),
}

/// The vertical component.
#[derive(Debug, Clone, PartialEq)]
pub enum Vertical {
    /// Horizontal motion only.
    None,
    /// Another component of the same record, by name or azimuth.
    Component(String),
    /// A file of its own.
    File(FileRef),
}

/// Signal processing of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Processing {
    /// Samples as they are.
    None,
    /// The default processing of the motion library.
    Default,
}

/// A recorded motion.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordMotion {
    /// Where the samples are.
    pub source: RecordSource,
    /// Horizontal component: a name, an azimuth, `horizontal-1` or `horizontal-2`; `None` for the first.
    pub component: Option<String>,
    /// Vertical component.
    pub vertical: Vertical,
    /// Time step for files that state none (s).
    pub time_step: Option<f64>,
    /// Acceleration of one file unit for files that state none (m/s²).
    pub unit: Option<f64>,
    /// Processing.
    pub processing: Processing,
    /// Where to get the file, in words, for those who do not have it.
    pub obtain: Option<String>,
}

/// What an amplitude measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amplitude {
    /// Peak displacement (m).
    Displacement(f64),
    /// Peak velocity (m/s).
    Velocity(f64),
    /// Peak acceleration (m/s²).
    Acceleration(f64),
}

/// Direction of an analytic motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Along `x`.
    Horizontal,
    /// Along `z`.
    Vertical,
}

/// A harmonic motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sine {
    /// Amplitude.
    pub amplitude: Amplitude,
    /// Period (s).
    pub period: f64,
    /// Number of cycles, ramps included.
    pub cycles: f64,
    /// Cycles over which the amplitude grows from zero, and again falls to zero.
    pub ramp_cycles: f64,
    /// Phase (rad).
    pub phase: f64,
    /// Direction.
    pub direction: Direction,
}

/// Form of a pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PulseKind {
    /// Second derivative of a Gaussian in acceleration.
    Ricker,
    /// Half a sine of acceleration.
    HalfSine,
    /// One sine of acceleration.
    OneSine,
    /// One cosine of acceleration.
    OneCosine,
    /// Constant acceleration.
    Rectangular,
    /// Harmonic under a Gaussian envelope.
    Gabor {
        /// Width of the envelope in cycles.
        gamma: f64,
        /// Phase (rad).
        phase: f64,
    },
    /// Cycloid A of Jacobsen and Ayre: one forward displacement.
    CycloidA,
    /// Cycloid B: forward and back.
    CycloidB,
    /// Cycloid C with a number of cycles.
    CycloidC {
        /// Number of cycles.
        cycles: u32,
    },
    /// Velocity pulse of Mavroeidis and Papageorgiou (2003).
    MavroeidisPapageorgiou {
        /// Oscillatory character, greater than 1.
        gamma: f64,
        /// Phase (rad).
        phase: f64,
    },
}

/// A pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Form.
    pub kind: PulseKind,
    /// Amplitude; never a displacement.
    pub amplitude: Amplitude,
    /// Period (s).
    pub period: f64,
    /// Time at which the pulse starts (s).
    pub start: f64,
    /// Direction.
    pub direction: Direction,
}

/// Where a motion comes from.
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
    /// Multiplied by a factor; 1 leaves the motion as it is.
    Factor(f64),
    /// To this peak horizontal acceleration (m/s²).
    Pga(f64),
    /// To this peak horizontal velocity (m/s).
    Pgv(f64),
}

/// The ground motion of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionSpec {
    /// Where the motion comes from.
    pub source: MotionSource,
    /// Scaling, of all components by the same factor.
    pub scale: Scale,
    /// Length scale `λ` of Froude similitude applied to the motion alone: time by `√λ`, accelerations unchanged.
    pub similitude: f64,
}

impl RecordMotion {
    /// Checks that the files of the record exist.
    ///
    /// # Errors
    ///
    /// A sentence that names the missing file, says where to get it when the scenario knows, and how to name another.
    pub fn check_files(&self) -> Result<(), String> {
        let mut files: Vec<(&str, &FileRef)> = Vec::new();
        if let RecordSource::File(file) = &self.source {
            files.push(("motion.record", file));
        }
        if let Vertical::File(file) = &self.vertical {
            files.push(("motion.vertical_record", file));
        }
        for (field, file) in files {
            let path = file.resolve();
            if !path.is_file() {
                let obtain = self.obtain.as_ref().map_or_else(String::new, |o| format!("; {o}"));
                return Err(format!(
                    "there is no record `{}`{obtain}; put the file there, or name another with \
                     `--set {field}=PATH`",
                    path.display()
                ));
            }
        }
        Ok(())
    }
}

impl Named for Processing {
    const NAMES: &'static [(&'static str, Self)] =
        &[("default", Self::Default), ("none", Self::None)];
}

impl Named for Direction {
    const NAMES: &'static [(&'static str, Self)] =
        &[("horizontal", Self::Horizontal), ("vertical", Self::Vertical)];
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PulseName {
    Ricker,
    HalfSine,
    OneSine,
    OneCosine,
    Rectangular,
    Gabor,
    CycloidA,
    CycloidB,
    CycloidC,
    MavroeidisPapageorgiou,
}

impl Named for PulseName {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("ricker", Self::Ricker),
        ("half-sine", Self::HalfSine),
        ("one-sine", Self::OneSine),
        ("one-cosine", Self::OneCosine),
        ("rectangular", Self::Rectangular),
        ("gabor", Self::Gabor),
        ("cycloid-a", Self::CycloidA),
        ("cycloid-b", Self::CycloidB),
        ("cycloid-c", Self::CycloidC),
        ("mavroeidis-papageorgiou", Self::MavroeidisPapageorgiou),
    ];
}

/// Periods from a microsecond to an hour.
const PERIOD: Kind =
    Kind::Quantity(&[Dimension::TIME], Range { least: 1e-6, above: false, greatest: 3600.0 });
const FREQUENCY: Kind = Kind::Quantity(
    &[Dimension::FREQUENCY],
    Range { least: 1.0 / 3600.0, above: false, greatest: 1e6 },
);
const LONGEST: f64 = 3600.0;

const PERIOD_FIELD: Field = Field::new(
    "period",
    PERIOD,
    Default::Derived("1 / `frequency`"),
    "Period; or give the frequency.",
);
const FREQUENCY_FIELD: Field = Field::new(
    "frequency",
    FREQUENCY,
    Default::Derived("1 / `period`"),
    "Frequency in place of the period.",
);
const DIRECTION_FIELD: Field = Field::new(
    "direction",
    Kind::Choice(names::<Direction>),
    Default::Value("\"horizontal\""),
    "Direction of the motion.",
);
const PHASE_FIELD: Field = Field::new(
    "phase",
    Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
    Default::Value("\"0 rad\""),
    "Phase.",
);

/// A harmonic motion.
pub static SINE: Section = Section {
    help: "A harmonic motion.",
    fields: &[
        Field::new(
            "amplitude",
            Kind::Quantity(
                &[Dimension::LENGTH, Dimension::VELOCITY, Dimension::ACCELERATION],
                Range::POSITIVE,
            ),
            Default::Required,
            "Amplitude of displacement, velocity or acceleration, as its unit tells.",
        ),
        PERIOD_FIELD,
        FREQUENCY_FIELD,
        Field::new(
            "cycles",
            Kind::Number(Range::up_to(1e6)),
            Default::Derived("`duration` / `period`"),
            "Number of cycles, ramps included; or give the duration.",
        ),
        Field::new(
            "duration",
            Kind::Quantity(&[Dimension::TIME], Range::up_to(LONGEST)),
            Default::Derived("`cycles` times `period`"),
            "Duration in place of the cycles.",
        ),
        Field::new(
            "ramp_cycles",
            Kind::Number(Range::between(0.0, 1e6)),
            Default::Value("0.0"),
            "Cycles over which the amplitude grows from zero, and again falls to zero.",
        ),
        PHASE_FIELD,
        DIRECTION_FIELD,
    ],
    variants: None,
    exclusive: &[&["period", "frequency"], &["cycles", "duration"]],
};

/// A pulse.
pub static PULSE: Section = Section {
    help: "A pulse.",
    fields: &[
        Field::new(
            "kind",
            Kind::Choice(names::<PulseName>),
            Default::Required,
            "Form of the pulse.",
        ),
        Field::new(
            "amplitude",
            Kind::Quantity(&[Dimension::ACCELERATION, Dimension::VELOCITY], Range::POSITIVE),
            Default::Required,
            "Peak acceleration or peak velocity, as its unit tells.",
        ),
        PERIOD_FIELD,
        FREQUENCY_FIELD,
        Field::new(
            "start",
            Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST)),
            Default::Value("\"0 s\""),
            "Time at which the pulse starts.",
        ),
        DIRECTION_FIELD,
    ],
    variants: Some(Variants {
        tag: "kind",
        list: &[
            Variant {
                name: "ricker",
                help: "Second derivative of a Gaussian, in acceleration.",
                fields: &[],
            },
            Variant { name: "half-sine", help: "Half a sine of acceleration.", fields: &[] },
            Variant { name: "one-sine", help: "One sine of acceleration.", fields: &[] },
            Variant { name: "one-cosine", help: "One cosine of acceleration.", fields: &[] },
            Variant { name: "rectangular", help: "Constant acceleration.", fields: &[] },
            Variant {
                name: "gabor",
                help: "Harmonic under a Gaussian envelope.",
                fields: &[
                    Field::new(
                        "gamma",
                        Kind::Number(Range::up_to(100.0)),
                        Default::Required,
                        "Width of the envelope in cycles.",
                    ),
                    PHASE_FIELD,
                ],
            },
            Variant { name: "cycloid-a", help: "One forward displacement.", fields: &[] },
            Variant { name: "cycloid-b", help: "Forward and back.", fields: &[] },
            Variant {
                name: "cycloid-c",
                help: "Several cycles that start and end at rest.",
                fields: &[Field::new(
                    "cycles",
                    Kind::Integer(1, 100),
                    Default::Value("1"),
                    "Number of cycles.",
                )],
            },
            Variant {
                name: "mavroeidis-papageorgiou",
                help: "Velocity pulse of near-fault records.",
                fields: &[
                    Field::new(
                        "gamma",
                        Kind::Number(Range { least: 1.0, above: true, greatest: 100.0 }),
                        Default::Required,
                        "Oscillatory character, greater than 1.",
                    ),
                    PHASE_FIELD,
                ],
            },
        ],
    }),
    exclusive: &[&["period", "frequency"]],
};

/// Scaling.
pub static SCALE: Section = Section {
    help: "Scaling of all components by one factor; one of the fields.",
    fields: &[
        Field::new(
            "factor",
            Kind::Number(Range { least: -1e6, above: false, greatest: 1e6 }),
            Default::Nothing,
            "Factor; a negative one turns the motion around.",
        ),
        Field::new(
            "pga",
            Kind::Quantity(&[Dimension::ACCELERATION], Range::up_to(1e4)),
            Default::Nothing,
            "Peak horizontal acceleration to reach.",
        ),
        Field::new(
            "pgv",
            Kind::Quantity(&[Dimension::VELOCITY], Range::up_to(1e3)),
            Default::Nothing,
            "Peak horizontal velocity to reach.",
        ),
    ],
    variants: None,
    exclusive: &[&["factor", "pga", "pgv"]],
};

const SOURCES: &[&str] = &["record", "bundled", "sine", "pulse", "none"];

/// The ground motion.
pub static MOTION: Section = Section {
    help: "The ground motion: one of `record`, `bundled`, `sine`, `pulse` and `none`.",
    fields: &[
        Field::new(
            "record",
            Kind::Text,
            Default::Nothing,
            "File of a recorded motion, relative to the scenario file.",
        ),
        Field::new(
            "bundled",
            Kind::Choice(catalog::record_names),
            Default::Nothing,
            "Record shipped with the program.",
        ),
        Field::new("sine", Kind::Table(&SINE), Default::Nothing, "A harmonic motion."),
        Field::new("pulse", Kind::Table(&PULSE), Default::Nothing, "A pulse."),
        Field::new("none", Kind::Flag, Default::Nothing, "True for a ground at rest."),
        Field::new(
            "component",
            Kind::Label,
            Default::Derived("the first horizontal component"),
            "Horizontal component: a name, an azimuth, `horizontal-1` or `horizontal-2`.",
        ),
        Field::new(
            "vertical",
            Kind::TextOrFalse,
            Default::Nothing,
            "Vertical component of the same record, or false.",
        ),
        Field::new(
            "vertical_record",
            Kind::Text,
            Default::Nothing,
            "File of the vertical motion, relative to the scenario file.",
        ),
        Field::new(
            "time_step",
            Kind::Quantity(&[Dimension::TIME], Range { least: 1e-6, above: false, greatest: 10.0 }),
            Default::Derived("that of the file"),
            "Time step, only for a file that states none.",
        ),
        Field::new(
            "unit",
            Kind::Unit(Dimension::ACCELERATION),
            Default::Derived("that of the file"),
            "Unit of acceleration, only for a file that states none.",
        ),
        Field::new(
            "processing",
            Kind::Choice(names::<Processing>),
            Default::Value("\"default\""),
            "Signal processing of the record.",
        ),
        Field::new(
            "obtain",
            Kind::Text,
            Default::Nothing,
            "Where to get the record, told to those who do not have it.",
        ),
        Field::new(
            "scale",
            Kind::Table(&SCALE),
            Default::Derived("factor 1"),
            "Scaling of the motion.",
        ),
        Field::new(
            "similitude",
            Kind::Number(Range { least: 1e-3, above: false, greatest: 1e3 }),
            Default::Value("1.0"),
            "Length scale of Froude similitude applied to the motion alone.",
        ),
    ],
    variants: None,
    exclusive: &[
        &["record", "bundled", "sine", "pulse", "none"],
        &["sine", "pulse", "none", "component"],
        &["sine", "pulse", "none", "vertical"],
        &["sine", "pulse", "none", "vertical_record"],
        &["sine", "pulse", "none", "processing"],
        &["bundled", "sine", "pulse", "none", "time_step"],
        &["bundled", "sine", "pulse", "none", "unit"],
        &["bundled", "sine", "pulse", "none", "obtain"],
        &["vertical", "vertical_record"],
        &["none", "scale"],
    ],
};

/// A ground at rest.
pub(super) fn rest() -> MotionSpec {
    MotionSpec { source: MotionSource::None, scale: Scale::Factor(1.0), similitude: 1.0 }
}

/// Reads the ground motion.
pub(super) fn read(reader: Reader<'_>) -> Result<MotionSpec, ScenarioError> {
    let record = reader.file("record")?.map(RecordSource::File);
    let bundled = reader.optional_catalog_name("bundled")?.map(RecordSource::Bundled);
    let details = read_record_details(&reader)?;
    let sine = reader.optional_section("sine")?.map(read_sine).transpose()?;
    let pulse = reader.optional_section("pulse")?.map(read_pulse).transpose()?;
    let none = reader.optional_flag("none")?;
    if none == Some(false) {
        let message = format!("`{}` is either true or left out", reader.path_of("none"));
        return Err(reader.inconsistent("none", message));
    }
    let source = if let Some(source) = record.or(bundled) {
        MotionSource::Record(RecordMotion { source, ..details })
    } else if let Some(sine) = sine {
        MotionSource::Sine(sine)
    } else if let Some(pulse) = pulse {
        MotionSource::Pulse(pulse)
    } else if none.is_some() {
        MotionSource::None
    } else {
        return Err(reader.one_of(SOURCES));
    };
    let scale = match reader.optional_section("scale")? {
        Some(scale) => read_scale(scale)?,
        None => Scale::Factor(1.0),
    };
    let similitude = reader.number("similitude")?;
    reader.finish();
    Ok(MotionSpec { source, scale, similitude })
}

/// Reads all fields of a record but its source, which the caller puts in.
fn read_record_details(reader: &Reader<'_>) -> Result<RecordMotion, ScenarioError> {
    let component = reader.optional_text("component")?;
    let vertical_component = reader.optional_text("vertical")?.map(Vertical::Component);
    let vertical_file = reader.file("vertical_record")?.map(Vertical::File);
    Ok(RecordMotion {
        source: RecordSource::Bundled(String::new()),
        component,
        vertical: vertical_component.or(vertical_file).unwrap_or(Vertical::None),
        time_step: reader.optional_quantity("time_step")?,
        unit: reader.optional_quantity("unit")?,
        processing: reader.choice("processing")?,
        obtain: reader.optional_text("obtain")?,
    })
}

fn read_scale(reader: Reader<'_>) -> Result<Scale, ScenarioError> {
    let factor = reader.optional_number("factor")?;
    if factor == Some(0.0) {
        let message = format!(
            "`{}` of 0 leaves no motion; for a ground at rest write `none = true` in [motion]",
            reader.path_of("factor")
        );
        return Err(reader.inconsistent("factor", message));
    }
    let pga = reader.optional_quantity("pga")?;
    let pgv = reader.optional_quantity("pgv")?;
    let scale = factor
        .map(Scale::Factor)
        .or(pga.map(Scale::Pga))
        .or(pgv.map(Scale::Pgv))
        .ok_or_else(|| reader.one_of(&["factor", "pga", "pgv"]))?;
    reader.finish();
    Ok(scale)
}

fn read_amplitude(reader: &Reader<'_>) -> Result<Amplitude, ScenarioError> {
    let quantity = reader
        .optional_quantity_with_dimension("amplitude")?
        .ok_or_else(|| reader.missing("amplitude"))?;
    Ok(if quantity.dimension == Dimension::LENGTH {
        Amplitude::Displacement(quantity.value)
    } else if quantity.dimension == Dimension::VELOCITY {
        Amplitude::Velocity(quantity.value)
    } else {
        Amplitude::Acceleration(quantity.value)
    })
}

fn read_period(reader: &Reader<'_>) -> Result<f64, ScenarioError> {
    let period = reader.optional_quantity("period")?;
    let frequency = reader.optional_quantity("frequency")?;
    period
        .or(frequency.map(|frequency| 1.0 / frequency))
        .ok_or_else(|| reader.one_of(&["period", "frequency"]))
}

fn read_sine(reader: Reader<'_>) -> Result<Sine, ScenarioError> {
    let period = read_period(&reader)?;
    let cycles = reader.optional_number("cycles")?;
    let duration = reader.optional_quantity("duration")?;
    let cycles = cycles
        .or(duration.map(|duration| duration / period))
        .ok_or_else(|| reader.one_of(&["cycles", "duration"]))?;
    if cycles * period > LONGEST {
        let message =
            format!("{cycles} cycles of {period} s last longer than {LONGEST} s; take fewer");
        return Err(reader.inconsistent("cycles", message));
    }
    let ramp_cycles = reader.number("ramp_cycles")?;
    if 2.0 * ramp_cycles > cycles {
        let message = format!(
            "`{}` of {ramp_cycles} at both ends does not fit in {cycles} cycles",
            reader.path_of("ramp_cycles")
        );
        return Err(reader.inconsistent("ramp_cycles", message));
    }
    let sine = Sine {
        amplitude: read_amplitude(&reader)?,
        period,
        cycles,
        ramp_cycles,
        phase: reader.quantity("phase")?,
        direction: reader.choice("direction")?,
    };
    reader.finish();
    Ok(sine)
}

fn read_pulse(reader: Reader<'_>) -> Result<Pulse, ScenarioError> {
    let kind = match reader.choice::<PulseName>("kind")? {
        PulseName::Ricker => PulseKind::Ricker,
        PulseName::HalfSine => PulseKind::HalfSine,
        PulseName::OneSine => PulseKind::OneSine,
        PulseName::OneCosine => PulseKind::OneCosine,
        PulseName::Rectangular => PulseKind::Rectangular,
        PulseName::Gabor => {
            PulseKind::Gabor { gamma: reader.number("gamma")?, phase: reader.quantity("phase")? }
        }
        PulseName::CycloidA => PulseKind::CycloidA,
        PulseName::CycloidB => PulseKind::CycloidB,
        PulseName::CycloidC => PulseKind::CycloidC { cycles: reader.integer("cycles")? },
        PulseName::MavroeidisPapageorgiou => PulseKind::MavroeidisPapageorgiou {
            gamma: reader.number("gamma")?,
            phase: reader.quantity("phase")?,
        },
    };
    let pulse = Pulse {
        kind,
        amplitude: read_amplitude(&reader)?,
        period: read_period(&reader)?,
        start: reader.quantity("start")?,
        direction: reader.choice("direction")?,
    };
    reader.finish();
    Ok(pulse)
}

/// Writes the ground motion.
pub(super) fn write(motion: &MotionSpec) -> Table {
    let mut writer = Writer::new(&MOTION);
    match &motion.source {
        MotionSource::None => writer.flag("none", true),
        MotionSource::Record(record) => write_record(&mut writer, record),
        MotionSource::Sine(sine) => writer.table("sine", write_sine(sine)),
        MotionSource::Pulse(pulse) => writer.table("pulse", write_pulse(pulse)),
    }
    if matches!(motion.source, MotionSource::None) {
        writer.omit(&["scale"]);
    } else {
        writer.table("scale", write_scale(motion.scale));
    }
    writer.number("similitude", motion.similitude);
    writer.omit(SOURCES);
    writer.omit(&[
        "component",
        "vertical",
        "vertical_record",
        "time_step",
        "unit",
        "processing",
        "obtain",
    ]);
    writer.finish()
}

fn write_record(writer: &mut Writer, record: &RecordMotion) {
    match &record.source {
        RecordSource::File(file) => writer.text("record", &file.path),
        RecordSource::Bundled(name) => writer.text("bundled", name),
    }
    writer.optional_text("component", record.component.as_deref());
    match &record.vertical {
        Vertical::None => {}
        Vertical::Component(name) => writer.text("vertical", name),
        Vertical::File(file) => writer.text("vertical_record", &file.path),
    }
    writer.optional_quantity("time_step", record.time_step);
    writer.optional_quantity("unit", record.unit);
    writer.choice("processing", record.processing);
    writer.optional_text("obtain", record.obtain.as_deref());
}

fn write_scale(scale: Scale) -> Table {
    let mut writer = Writer::new(&SCALE);
    match scale {
        Scale::Factor(factor) => writer.number("factor", factor),
        Scale::Pga(pga) => writer.quantity("pga", pga),
        Scale::Pgv(pgv) => writer.quantity("pgv", pgv),
    }
    writer.omit(&["factor", "pga", "pgv"]);
    writer.finish()
}

fn write_amplitude(writer: &mut Writer, amplitude: Amplitude) {
    let (value, dimension) = match amplitude {
        Amplitude::Displacement(value) => (value, Dimension::LENGTH),
        Amplitude::Velocity(value) => (value, Dimension::VELOCITY),
        Amplitude::Acceleration(value) => (value, Dimension::ACCELERATION),
    };
    writer.quantity_in("amplitude", value, dimension);
}

fn write_sine(sine: &Sine) -> Table {
    let mut writer = Writer::new(&SINE);
    write_amplitude(&mut writer, sine.amplitude);
    writer.quantity("period", sine.period);
    writer.number("cycles", sine.cycles);
    writer.number("ramp_cycles", sine.ramp_cycles);
    writer.quantity("phase", sine.phase);
    writer.choice("direction", sine.direction);
    writer.omit(&["frequency", "duration"]);
    writer.finish()
}

fn write_pulse(pulse: &Pulse) -> Table {
    let name = match pulse.kind {
        PulseKind::Ricker => PulseName::Ricker,
        PulseKind::HalfSine => PulseName::HalfSine,
        PulseKind::OneSine => PulseName::OneSine,
        PulseKind::OneCosine => PulseName::OneCosine,
        PulseKind::Rectangular => PulseName::Rectangular,
        PulseKind::Gabor { .. } => PulseName::Gabor,
        PulseKind::CycloidA => PulseName::CycloidA,
        PulseKind::CycloidB => PulseName::CycloidB,
        PulseKind::CycloidC { .. } => PulseName::CycloidC,
        PulseKind::MavroeidisPapageorgiou { .. } => PulseName::MavroeidisPapageorgiou,
    };
    let mut writer = Writer::variant(&PULSE, name);
    match pulse.kind {
        PulseKind::Gabor { gamma, phase } | PulseKind::MavroeidisPapageorgiou { gamma, phase } => {
            writer.number("gamma", gamma);
            writer.quantity("phase", phase);
        }
        PulseKind::CycloidC { cycles } => writer.integer("cycles", cycles),
        PulseKind::Ricker
        | PulseKind::HalfSine
        | PulseKind::OneSine
        | PulseKind::OneCosine
        | PulseKind::Rectangular
        | PulseKind::CycloidA
        | PulseKind::CycloidB => {}
    }
    write_amplitude(&mut writer, pulse.amplitude);
    writer.quantity("period", pulse.period);
    writer.quantity("start", pulse.start);
    writer.choice("direction", pulse.direction);
    writer.omit(&["frequency"]);
    writer.finish()
}
