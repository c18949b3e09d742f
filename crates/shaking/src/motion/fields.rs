//! The fields of `[motion]`.

use std::mem::discriminant;

use barrelstack_input::Dimension;
use barrelstack_input::field::{
    Default, Field, Kind, Named, Range, Section, Variant, Variants, names,
};

use super::{Direction, MeasuredOn, Processing, PulseKind};

impl Named for Processing {
    const NAMES: &'static [(&'static str, Self)] =
        &[("default", Self::Default), ("none", Self::None)];
}

impl Named for Direction {
    const NAMES: &'static [(&'static str, Self)] =
        &[("horizontal", Self::Horizontal), ("vertical", Self::Vertical)];
}

impl Named for MeasuredOn {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("component", Self::Component),
        ("rotd50", Self::RotD50),
        ("rotd100", Self::RotD100),
        ("geomean", Self::GeometricMean),
    ];
}

impl Named for PulseKind {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("ricker", Self::Ricker),
        ("half-sine", Self::HalfSine),
        ("one-sine", Self::OneSine),
        ("one-cosine", Self::OneCosine),
        ("rectangular", Self::Rectangular),
        ("gabor", Self::Gabor { gamma: 0.0, phase: 0.0 }),
        ("cycloid-a", Self::CycloidA),
        ("cycloid-b", Self::CycloidB),
        ("cycloid-c", Self::CycloidC { cycles: 0 }),
        ("mavroeidis-papageorgiou", Self::MavroeidisPapageorgiou { gamma: 0.0, phase: 0.0 }),
    ];

    /// The name of the form, whatever its parameters, which are fields of their own.
    fn name(self) -> &'static str {
        let same = |form: &Self| discriminant(form) == discriminant(&self);
        Self::NAMES.iter().find(|(_, form)| same(form)).map_or("", |(name, _)| name)
    }
}

/// Names of the records shipped with the program.
pub fn record_names() -> Vec<&'static str> {
    barrelstack_motion::BUNDLED.to_vec()
}

/// A field that may be left out.
const fn optional(name: &'static str, kind: Kind, help: &'static str) -> Field {
    Field::new(name, kind, Default::Nothing, help)
}

/// Periods from a microsecond to an hour.
const PERIOD: Kind =
    Kind::Quantity(&[Dimension::TIME], Range { least: 1e-6, above: false, greatest: 3600.0 });
const FREQUENCY: Kind = Kind::Quantity(
    &[Dimension::FREQUENCY],
    Range { least: 1.0 / 3600.0, above: false, greatest: 1e6 },
);
pub(super) const LONGEST: f64 = 3600.0;

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
    name: "sine",
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
        DIRECTION_FIELD,
    ],
    variants: None,
    exclusive: &[&["period", "frequency"], &["cycles", "duration"]],
};

/// A pulse.
pub static PULSE: Section = Section {
    name: "pulse",
    help: "A pulse.",
    fields: &[
        Field::new(
            "kind",
            Kind::Choice(names::<PulseKind>),
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
    name: "scale",
    help: "Scaling of all components by one factor; one of the fields.",
    fields: &[
        optional(
            "factor",
            Kind::Number(Range { least: -1e6, above: false, greatest: 1e6 }),
            "Factor; a negative one turns the motion around.",
        ),
        optional(
            "pga",
            Kind::Quantity(&[Dimension::ACCELERATION], Range::up_to(1e4)),
            "Peak horizontal acceleration to reach.",
        ),
        optional(
            "pgv",
            Kind::Quantity(&[Dimension::VELOCITY], Range::up_to(1e3)),
            "Peak horizontal velocity to reach.",
        ),
        optional(
            "measure",
            Kind::Text,
            "Any other measure that grows with the motion, whose `value` shall be reached: `pgd`, \
             `arias`, `cav`, `cav-std`, `rms`, `housner`, `asi`, `vsi`, `fiv3(1.0)`, `sa(1.0)` (period \
             in seconds, damping 5 %) or `sa(1.0,0.02)`.",
        ),
        optional(
            "value",
            Kind::Quantity(
                &[Dimension::ACCELERATION, Dimension::VELOCITY, Dimension::LENGTH],
                Range::up_to(1e4),
            ),
            "Value of `measure` to reach.",
        ),
        Field::new(
            "of",
            Kind::Choice(names::<MeasuredOn>),
            Default::Value("\"component\""),
            "What `measure` is taken of: the component that drives the stack, or both horizontals of \
             the record.",
        ),
    ],
    variants: None,
    exclusive: &[
        &["factor", "pga", "pgv", "measure"],
        &["factor", "pga", "pgv", "value"],
        &["factor", "pga", "pgv", "of"],
    ],
};

pub(super) const SOURCES: &[&str] = &["record", "bundled", "sine", "pulse", "none"];

/// The ground motion.
pub static MOTION: Section = Section {
    name: "motion",
    help: "The ground motion: one of `record`, `bundled`, `sine`, `pulse` and `none`.",
    fields: &[
        optional("record", Kind::Text, "File of a recorded motion, relative to the scenario file."),
        optional("bundled", Kind::Choice(record_names), "Record shipped with the program."),
        optional("sine", Kind::Table(&SINE), "A harmonic motion."),
        optional("pulse", Kind::Table(&PULSE), "A pulse."),
        optional("none", Kind::Flag, "True for a ground at rest."),
        Field::new(
            "component",
            Kind::Label,
            Default::Derived("the first horizontal component"),
            "Horizontal component: a name, an azimuth, `horizontal-1` or `horizontal-2`.",
        ),
        optional("vertical", Kind::TextOrFalse, "Vertical component of the same record, or false."),
        optional(
            "vertical_record",
            Kind::Text,
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
        optional(
            "sensitivity",
            Kind::Number(Range::up_to(1e15)),
            "Counts to one m/s², only for a file that holds counts (miniSEED, SAC).",
        ),
        Field::new(
            "processing",
            Kind::Choice(names::<Processing>),
            Default::Value("\"default\""),
            "Signal processing of the record.",
        ),
        optional(
            "obtain",
            Kind::Text,
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
        &["bundled", "sine", "pulse", "none", "sensitivity"],
        &["bundled", "sine", "pulse", "none", "obtain"],
        &["vertical", "vertical_record"],
        &["none", "scale"],
    ],
};
