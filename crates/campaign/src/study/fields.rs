//! The fields of a study file.

mod motion;

use crate::scenario::ROOT;
use crate::scenario::field::{
    Default, Field, Kind, Named, Range, Section, Variant, Variants, names,
};

pub(super) use motion::{Maker, Soil};

use motion::MOTIONS;

/// Version of the language of study files.
pub(super) const SCHEMA: i64 = 1;

/// Most cases, samples or realizations that may be asked for at once.
pub(super) const MOST: i64 = 10_000_000;

/// Spacing of a range of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spacing {
    Linear,
    Logarithmic,
}

impl Named for Spacing {
    const NAMES: &'static [(&'static str, Self)] =
        &[("linear", Self::Linear), ("log", Self::Logarithmic)];
}

/// Form of a distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Uniform,
    LogUniform,
    Normal,
    Lognormal,
    Discrete,
}

impl Named for Form {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("uniform", Self::Uniform),
        ("log-uniform", Self::LogUniform),
        ("normal", Self::Normal),
        ("lognormal", Self::Lognormal),
        ("discrete", Self::Discrete),
    ];
}

/// The design of a study: which cases it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DesignKind {
    FullFactorial,
    OneAtATime,
    LatinHypercube,
    Sobol,
    Saltelli,
    MonteCarlo,
    Stripes,
    Ida,
}

impl Named for DesignKind {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("full-factorial", Self::FullFactorial),
        ("one-at-a-time", Self::OneAtATime),
        ("latin-hypercube", Self::LatinHypercube),
        ("sobol", Self::Sobol),
        ("saltelli", Self::Saltelli),
        ("monte-carlo", Self::MonteCarlo),
        ("stripes", Self::Stripes),
        ("ida", Self::Ida),
    ];
}

static RANGE: Section = Section {
    name: "range",
    help: "Values at equal steps or equal ratios, both ends included.",
    fields: &[
        Field::new("from", Kind::Value, Default::Required, "First value."),
        Field::new("to", Kind::Value, Default::Required, "Last value."),
        Field::new("count", Kind::Integer(2, 10_000), Default::Required, "Number of values."),
        Field::new(
            "spacing",
            Kind::Choice(names::<Spacing>),
            Default::Value("\"linear\""),
            "Equal steps, or with \"log\" equal ratios.",
        ),
    ],
    variants: None,
    exclusive: &[],
};

const LEAST: Field =
    Field::new("least", Kind::Value, Default::Nothing, "Cut off below this value (truncated).");
const GREATEST: Field =
    Field::new("greatest", Kind::Value, Default::Nothing, "Cut off above this value (truncated).");

static DISTRIBUTION: Section = Section {
    name: "distribution",
    help: "A distribution from which values are drawn.",
    fields: &[Field::new(
        "kind",
        Kind::Choice(names::<Form>),
        Default::Required,
        "Form of the distribution.",
    )],
    variants: Some(Variants {
        tag: "kind",
        list: &[
            Variant {
                name: "uniform",
                help: "Every value between two is as likely.",
                fields: &[
                    Field::new("from", Kind::Value, Default::Required, "Least value."),
                    Field::new("to", Kind::Value, Default::Required, "Greatest value."),
                ],
            },
            Variant {
                name: "log-uniform",
                help: "The logarithm is uniform.",
                fields: &[
                    Field::new("from", Kind::Value, Default::Required, "Least value, above zero."),
                    Field::new("to", Kind::Value, Default::Required, "Greatest value."),
                ],
            },
            Variant {
                name: "normal",
                help: "Normal (Gauss).",
                fields: &[
                    Field::new("mean", Kind::Value, Default::Required, "Mean."),
                    Field::new(
                        "deviation",
                        Kind::Value,
                        Default::Required,
                        "Standard deviation, before any cut.",
                    ),
                    LEAST,
                    GREATEST,
                ],
            },
            Variant {
                name: "lognormal",
                help: "The logarithm is normal.",
                fields: &[
                    Field::new("median", Kind::Value, Default::Required, "Median, above zero."),
                    Field::new(
                        "dispersion",
                        Kind::Number(Range::up_to(5.0)),
                        Default::Required,
                        "Standard deviation of the natural logarithm, before any cut.",
                    ),
                    LEAST,
                    GREATEST,
                ],
            },
            Variant {
                name: "discrete",
                help: "One of a list.",
                fields: &[
                    Field::new("values", Kind::Values, Default::Required, "The values."),
                    Field::new(
                        "weights",
                        Kind::Values,
                        Default::Derived("all alike"),
                        "How likely each is, relative to the others.",
                    ),
                ],
            },
        ],
    }),
    exclusive: &[],
};

static FACTOR: Section = Section {
    name: "factor",
    help: "A field of the scenario that the study varies: one of `values`, `range` and `distribution`.",
    fields: &[
        Field::new(
            "field",
            Kind::Text,
            Default::Required,
            "Path of the field, such as `interface.rack-ground.friction.coefficient`.",
        ),
        Field::new(
            "also",
            Kind::Texts,
            Default::Nothing,
            "Paths of further fields that take the same value.",
        ),
        Field::new("name", Kind::Text, Default::Derived("`field`"), "Name of its column."),
        Field::new("values", Kind::Values, Default::Nothing, "The values."),
        Field::new("range", Kind::Table(&RANGE), Default::Nothing, "Values between two."),
        Field::new(
            "distribution",
            Kind::Table(&DISTRIBUTION),
            Default::Nothing,
            "Where values are drawn from.",
        ),
    ],
    variants: None,
    exclusive: &[&["values", "range", "distribution"]],
};

static INTENSITY: Section = Section {
    name: "intensity",
    help: "The intensity to which motions are scaled, all components by one factor.",
    fields: &[
        Field::new(
            "measure",
            Kind::Text,
            Default::Value("\"pgv\""),
            "Measure of the horizontal component as shaken: pga, pgv, pgd, arias, cav, sa(0.5), …",
        ),
        Field::new("levels", Kind::Values, Default::Nothing, "The levels."),
        Field::new("range", Kind::Table(&RANGE), Default::Nothing, "Levels between two."),
        Field::new(
            "distribution",
            Kind::Table(&DISTRIBUTION),
            Default::Nothing,
            "Where levels are drawn from.",
        ),
    ],
    variants: None,
    exclusive: &[&["levels", "range", "distribution"]],
};

const COUNT: Field =
    Field::new("count", Kind::Integer(1, MOST), Default::Required, "Number of cases.");

static DESIGN: Section = Section {
    name: "design",
    help: "Which cases the study has.",
    fields: &[
        Field::new("kind", Kind::Choice(names::<DesignKind>), Default::Required, "The design."),
        Field::new(
            "chunk",
            Kind::Integer(1, 100_000),
            Default::Derived(
                "64, and twice as many after every 512 chunks; in space, and of an incremental dynamic analysis, 8",
            ),
            "Cases of a chunk, the unit of work that is run and kept as a whole; of an incremental dynamic analysis, \
             hunts.",
        ),
    ],
    variants: Some(Variants {
        tag: "kind",
        list: &[
            Variant {
                name: "full-factorial",
                help: "Every combination of all values, levels and motions.",
                fields: &[],
            },
            Variant {
                name: "one-at-a-time",
                help: "The base, and every other value of one factor at a time, for every level and motion.",
                fields: &[
                    Field::new(
                        "quantiles",
                        Kind::Values,
                        Default::Value("[0.1, 0.9]"),
                        "Quantiles that stand for a distribution.",
                    ),
                    Field::new(
                        "draws",
                        Kind::Integer(0, 10_000),
                        Default::Value("0"),
                        "Stacks for each motion: with any, factors of a distribution are drawn for each of them, alike for all changes and levels, and no quantiles stand for them.",
                    ),
                ],
            },
            Variant {
                name: "latin-hypercube",
                help: "Samples with one in each of `count` equal shares of every factor.",
                fields: &[COUNT],
            },
            Variant {
                name: "sobol",
                help: "Points of Sobol', shifted at random; more of them leave the earlier ones as they are.",
                fields: &[COUNT],
            },
            Variant {
                name: "saltelli",
                help: "Blocks of points of Sobol' for variance-based sensitivity: two samples and, for every varied quantity, one with it exchanged.",
                fields: &[Field::new(
                    "count",
                    Kind::Integer(2, MOST),
                    Default::Required,
                    "Number of blocks, each of two cases more than there are varied quantities; best a power of two.",
                )],
            },
            Variant {
                name: "monte-carlo",
                help: "Random samples until the probability of collapse is known well enough.",
                fields: &[
                    Field::new(
                        "half_width",
                        Kind::Number(Range::between(1e-4, 0.5)),
                        Default::Nothing,
                        "Half of the width of the 95 % interval (Wilson) of the collapse probability at which to stop.",
                    ),
                    Field::new(
                        "most",
                        Kind::Integer(1, MOST),
                        Default::Required,
                        "Number of cases at which to stop in any case.",
                    ),
                    Field::new(
                        "least",
                        Kind::Integer(1, MOST),
                        Default::Value("100"),
                        "Number of cases before the interval is looked at.",
                    ),
                ],
            },
            Variant {
                name: "stripes",
                help: "Every motion at every level; factors crossed where they have values, drawn where they have a \
                       distribution.",
                fields: &[],
            },
            Variant {
                name: "ida",
                help: "Incremental dynamic analysis: each motion is raised in growing steps until it fells the stack, \
                       then the gap before and the gaps below are filled (hunt and fill, Vamvatsikos and Cornell \
                       2004).",
                fields: &[
                    Field::new("first", Kind::Value, Default::Required, "Lowest level."),
                    Field::new("step", Kind::Value, Default::Required, "First step up."),
                    Field::new(
                        "growth",
                        Kind::Value,
                        Default::Derived("half of `step`"),
                        "By how much each step is longer than the one before.",
                    ),
                    Field::new(
                        "resolution",
                        Kind::Number(Range::between(1e-3, 1.0)),
                        Default::Value("0.1"),
                        "Gap between standing and collapse, over the highest level that stood, at which it is narrow \
                         enough.",
                    ),
                    Field::new(
                        "runs",
                        Kind::Integer(3, 1000),
                        Default::Value("12"),
                        "Runs of each hunt.",
                    ),
                ],
            },
        ],
    }),
    exclusive: &[],
};

/// The top of a study file.
pub static STUDY: Section = Section {
    name: "study",
    help: "Many runs of one scenario: what is varied, what shakes it, and which cases are run.",
    fields: &[
        Field::new(
            "schema",
            Kind::Integer(1, SCHEMA),
            Default::Required,
            "Version of the language of study files.",
        ),
        Field::new(
            "title",
            Kind::Text,
            Default::Derived("name of the file"),
            "One line for people.",
        ),
        Field::new(
            "seed",
            Kind::Integer(0, u32::MAX as i64),
            Default::Value("1"),
            "Seed of everything that is drawn.",
        ),
        Field::new(
            "base",
            Kind::Table(&ROOT),
            Default::Required,
            "The scenario that is varied, with all its fields; most often `extends` and what differs.",
        ),
        Field::new("factor", Kind::Tables(&FACTOR), Default::Nothing, "What is varied."),
        Field::new(
            "motion",
            Kind::Tables(&MOTIONS),
            Default::Derived("the motion of the base"),
            "What shakes it.",
        ),
        Field::new(
            "intensity",
            Kind::Table(&INTENSITY),
            Default::Nothing,
            "How strongly it is shaken.",
        ),
        Field::new("design", Kind::Table(&DESIGN), Default::Required, "Which cases are run."),
    ],
    variants: None,
    exclusive: &[],
};
