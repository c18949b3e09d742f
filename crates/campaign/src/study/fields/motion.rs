//! The fields of `[[motion]]` in a study file.

use crate::scenario::Dimension;
use crate::scenario::field::{
    Default, Field, Kind, Named, Range, Section, Variant, Variants, names,
};
use crate::scenario::motion::{MOTION, PULSE, SCALE, SINE, record_names};

use super::MOST;

/// How a synthetic motion is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum Maker {
    Boore,
    CloughPenzien,
    NearFault,
}

impl Named for Maker {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("boore", Self::Boore),
        ("clough-penzien", Self::CloughPenzien),
        ("near-fault", Self::NearFault),
    ];
}

/// Soils of Der Kiureghian and Neuenhofer (1992).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum Soil {
    Firm,
    Medium,
    Soft,
}

impl Named for Soil {
    const NAMES: &'static [(&'static str, Self)] =
        &[("firm", Self::Firm), ("medium", Self::Medium), ("soft", Self::Soft)];
}

const SOURCE: [Field; 4] = [
    Field::new(
        "magnitude",
        Kind::Number(Range::between(1.0, 9.5)),
        Default::Required,
        "Moment magnitude.",
    ),
    Field::new(
        "distance",
        Kind::Quantity(&[Dimension::LENGTH], Range::up_to(1e7)),
        Default::Required,
        "Distance from source to site.",
    ),
    Field::new(
        "stress",
        Kind::Quantity(&[Dimension::STIFFNESS_PER_LENGTH], Range::up_to(1e12)),
        Default::Value("\"7 MPa\""),
        "Stress parameter.",
    ),
    Field::new(
        "kappa",
        Kind::Quantity(&[Dimension::TIME], Range::between(0.0, 1.0)),
        Default::Value("\"0.04 s\""),
        "High-frequency attenuation at the site.",
    ),
];

const TIME: Kind = Kind::Quantity(&[Dimension::TIME], Range::up_to(3600.0));

static SYNTHETIC: Section = Section {
    name: "synthetic",
    help: "Motions made from random numbers of stated seeds.",
    fields: &[
        Field::new("kind", Kind::Choice(names::<Maker>), Default::Required, "How they are made."),
        Field::new("count", Kind::Integer(1, MOST), Default::Required, "How many realizations."),
        Field::new(
            "seed",
            Kind::Integer(0, u32::MAX as i64),
            Default::Derived("that of the study"),
            "Seed of the set; each realization has its own, made of this one and its number.",
        ),
        Field::new(
            "time_step",
            Kind::Quantity(&[Dimension::TIME], Range { least: 1e-4, above: false, greatest: 0.1 }),
            Default::Value("\"0.005 s\""),
            "Step of the samples.",
        ),
    ],
    variants: Some(Variants {
        tag: "kind",
        list: &[
            Variant {
                name: "boore",
                help: "Stochastic method for a point source (Boore 2003).",
                fields: &SOURCE,
            },
            Variant {
                name: "clough-penzien",
                help: "Filtered white noise under an envelope (Clough and Penzien).",
                fields: &[
                    Field::new(
                        "soil",
                        Kind::Choice(names::<Soil>),
                        Default::Value("\"medium\""),
                        "Soil.",
                    ),
                    Field::new(
                        "rms",
                        Kind::Quantity(&[Dimension::ACCELERATION], Range::up_to(1e3)),
                        Default::Value("\"0.1 g\""),
                        "Root mean square of the acceleration at full strength.",
                    ),
                    Field::new("duration", TIME, Default::Value("\"20 s\""), "Length."),
                    Field::new(
                        "rise",
                        TIME,
                        Default::Value("\"2 s\""),
                        "End of the rise to full strength.",
                    ),
                    Field::new(
                        "decay_start",
                        TIME,
                        Default::Value("\"10 s\""),
                        "Start of the decay.",
                    ),
                    Field::new(
                        "decay",
                        TIME,
                        Default::Value("\"2.5 s\""),
                        "Time in which the motion then falls to 1/e.",
                    ),
                ],
            },
            Variant {
                name: "near-fault",
                help: "A velocity pulse of Mavroeidis and Papageorgiou on top of a stochastic motion.",
                fields: &[
                    SOURCE[0],
                    SOURCE[1],
                    SOURCE[2],
                    SOURCE[3],
                    Field::new(
                        "pulse_velocity",
                        Kind::Quantity(&[Dimension::VELOCITY], Range::up_to(100.0)),
                        Default::Required,
                        "Velocity amplitude of the pulse.",
                    ),
                    Field::new("pulse_period", TIME, Default::Required, "Period of the pulse."),
                    Field::new(
                        "gamma",
                        Kind::Number(Range { least: 1.0, above: true, greatest: 100.0 }),
                        Default::Value("2.0"),
                        "Width of the pulse, above 1; sets its number of cycles.",
                    ),
                    Field::new(
                        "phase",
                        Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
                        Default::Value("\"0 rad\""),
                        "Phase of the pulse.",
                    ),
                    Field::new("start", TIME, Default::Value("\"2 s\""), "Start of the pulse."),
                    Field::new(
                        "crossover",
                        Kind::Number(Range::up_to(100.0)),
                        Default::Value("1.0"),
                        "The rest holds frequencies above this many times the pulse's.",
                    ),
                ],
            },
        ],
    }),
    exclusive: &[],
};

pub(super) static MOTIONS: Section = Section {
    name: "motions",
    help: "Motions that shake the stack: one of `records`, `folder`, `bundled`, `sine`, `pulse` and `synthetic`.",
    fields: &[
        Field::new(
            "name",
            Kind::Text,
            Default::Derived("the name of the file, or how it is made"),
            "Name in the table; of several motions, what their names start with.",
        ),
        Field::new(
            "records",
            Kind::Texts,
            Default::Nothing,
            "Files of recorded motions, relative to the study file.",
        ),
        Field::new(
            "folder",
            Kind::Text,
            Default::Nothing,
            "Folder of recorded motions, relative to the study file; its files in the order of their names.",
        ),
        Field::new(
            "pattern",
            Kind::Text,
            Default::Value("\"*\""),
            "Which files of the folder, such as `*.AT2`: `*` stands for any letters, `?` for one.",
        ),
        Field::new(
            "bundled",
            Kind::Choice(record_names),
            Default::Nothing,
            "Record shipped with the program.",
        ),
        Field::new("sine", Kind::Table(&SINE), Default::Nothing, "A harmonic motion."),
        Field::new("pulse", Kind::Table(&PULSE), Default::Nothing, "A pulse."),
        Field::new("synthetic", Kind::Table(&SYNTHETIC), Default::Nothing, "Motions made."),
        Field::new(
            "components",
            Kind::Texts,
            Default::Derived("the one of `each`, or the first horizontal component"),
            "Horizontal components of records, each a motion of its own.",
        ),
        Field::new(
            "each",
            Kind::Table(&MOTION),
            Default::Nothing,
            "How every record is read: the fields of [motion] but its source and scale.",
        ),
        Field::new(
            "scale",
            Kind::Table(&SCALE),
            Default::Nothing,
            "Scaling, where there is no [intensity].",
        ),
    ],
    variants: None,
    exclusive: &[
        &["records", "folder", "bundled", "sine", "pulse", "synthetic"],
        &["sine", "pulse", "synthetic", "components"],
        &["sine", "pulse", "synthetic", "each"],
        &["records", "bundled", "sine", "pulse", "synthetic", "pattern"],
    ],
};
