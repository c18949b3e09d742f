//! The fields of a study file.

mod motion;

use barrelstack_input::{named, table};

use crate::scenario::ROOT;
use crate::scenario::field::{Default, Field, Kind, Range, names};

pub(super) use motion::{Maker, Soil};

use motion::MOTIONS;

/// Version of the language of study files.
pub(super) const SCHEMA: i64 = 1;

/// Maximum number of cases, samples or realizations.
pub(super) const MOST: i64 = 10_000_000;

named! {
    /// Spacing of a range of values.
    pub(super) enum Spacing { Linear = "linear", Logarithmic = "log" }
}

named! {
    /// Form of a distribution.
    pub(super) enum Form {
        Uniform = "uniform",
        LogUniform = "log-uniform",
        Normal = "normal",
        Lognormal = "lognormal",
        Discrete = "discrete",
    }
}

named! {
    /// The design of a study: which cases it has.
    pub(super) enum DesignKind {
        FullFactorial = "full-factorial",
        OneAtATime = "one-at-a-time",
        LatinHypercube = "latin-hypercube",
        Sobol = "sobol",
        Saltelli = "saltelli",
        MonteCarlo = "monte-carlo",
        Stripes = "stripes",
        Ida = "ida",
    }
}

table! {
    /// Values at equal steps or equal ratios, both ends included.
    static RANGE = "range";
    /// First value.
    from = Kind::Value, Default::Required;
    /// Last value.
    to = Kind::Value, Default::Required;
    /// Number of values.
    count = Kind::Integer(2, 10_000), Default::Required;
    /// Equal steps, or with "log" equal ratios.
    spacing = Kind::Choice(names::<Spacing>), Default::Value("\"linear\"");
}

const LEAST: Field =
    Field::new("least", Kind::Value, Default::Nothing, "Cut off below this value (truncated).");
const GREATEST: Field =
    Field::new("greatest", Kind::Value, Default::Nothing, "Cut off above this value (truncated).");

table! {
    /// A distribution from which values are drawn.
    static DISTRIBUTION = "distribution";
    /// Form of the distribution.
    kind = Kind::Choice(names::<Form>), Default::Required;
    by kind {
        /// Every value between two is as likely.
        "uniform" {
            /// Least value.
            from = Kind::Value, Default::Required;
            /// Greatest value.
            to = Kind::Value, Default::Required;
        }
        /// The logarithm is uniform.
        "log-uniform" {
            /// Least value, above zero.
            from = Kind::Value, Default::Required;
            /// Greatest value.
            to = Kind::Value, Default::Required;
        }
        /// Normal (Gauss).
        "normal" {
            /// Mean.
            mean = Kind::Value, Default::Required;
            /// Standard deviation, before any cut.
            deviation = Kind::Value, Default::Required;
        } then [LEAST, GREATEST]
        /// The logarithm is normal.
        "lognormal" {
            /// Median, above zero.
            median = Kind::Value, Default::Required;
            /// Standard deviation of the natural logarithm, before any cut.
            dispersion = Kind::Number(Range::up_to(5.0)), Default::Required;
        } then [LEAST, GREATEST]
        /// One of a list.
        "discrete" {
            /// The values.
            values = Kind::Values, Default::Required;
            /// Relative weight of each value.
            weights = Kind::Values, Default::Derived("all alike");
        }
    }
}

table! {
    /// A field of the scenario that the study varies: one of `values`, `range` and `distribution`.
    static FACTOR = "factor";
    /// Path of the field, such as `interface.rack-ground.friction.coefficient`.
    field = Kind::Text, Default::Required;
    /// Paths of further fields that take the same value.
    also = Kind::Texts, Default::Nothing;
    /// Name of its column.
    name = Kind::Text, Default::Derived("`field`");
    /// The values.
    values = Kind::Values, Default::Nothing;
    /// Values between two.
    range = Kind::Table(&RANGE), Default::Nothing;
    /// Where values are drawn from.
    distribution = Kind::Table(&DISTRIBUTION), Default::Nothing;
    at most one of &["values", "range", "distribution"];
}

table! {
    /// The intensity to which motions are scaled, all components by one factor.
    static INTENSITY = "intensity";
    /// Measure of the horizontal component as shaken: pga, pgv, pgd, arias, cav, sa(0.5), …
    measure = Kind::Text, Default::Value("\"pgv\"");
    /// The levels.
    levels = Kind::Values, Default::Nothing;
    /// Levels between two.
    range = Kind::Table(&RANGE), Default::Nothing;
    /// Where levels are drawn from.
    distribution = Kind::Table(&DISTRIBUTION), Default::Nothing;
    at most one of &["levels", "range", "distribution"];
}

const COUNT: Field =
    Field::new("count", Kind::Integer(1, MOST), Default::Required, "Number of cases.");

table! {
    /// Which cases the study has.
    static DESIGN = "design";
    /// The design.
    kind = Kind::Choice(names::<DesignKind>), Default::Required;
    /// Cases of a chunk, the unit of work that is run and kept as a whole; of an incremental dynamic analysis, hunts.
    chunk = Kind::Integer(1, 100_000),
        Default::Derived("64, and twice as many after every 512 chunks; in space, and of an incremental dynamic analysis, 8");
    by kind {
        /// Every combination of all values, levels and motions.
        "full-factorial" {}
        /// The base, and every other value of one factor at a time, for every level and motion.
        "one-at-a-time" {
            /// Quantiles that stand for a distribution.
            quantiles = Kind::Values, Default::Value("[0.1, 0.9]");
            /// Stacks for each motion: with any, factors of a distribution are drawn for each of them, alike for all
            /// changes and levels, and no quantiles stand for them.
            draws = Kind::Integer(0, 10_000), Default::Value("0");
        }
        /// Samples with one in each of `count` equal shares of every factor.
        "latin-hypercube" with [COUNT] {}
        /// Points of Sobol', shifted at random; more of them leave the earlier ones as they are.
        "sobol" with [COUNT] {}
        /// Blocks of points of Sobol' for variance-based sensitivity: two samples and, for every varied quantity, one
        /// with it exchanged.
        "saltelli" {
            /// Number of blocks, each of two cases more than there are varied quantities; best a power of two.
            count = Kind::Integer(2, MOST), Default::Required;
        }
        /// Random samples until the probability of collapse is known well enough.
        "monte-carlo" {
            /// Half of the width of the 95 % interval (Wilson) of the collapse probability at which to stop.
            half_width = Kind::Number(Range::between(1e-4, 0.5)), Default::Nothing;
            /// Number of cases at which to stop in any case.
            most = Kind::Integer(1, MOST), Default::Required;
            /// Number of cases before the interval is looked at.
            least = Kind::Integer(1, MOST), Default::Value("100");
        }
        /// Every motion at every level; factors crossed where they have values, drawn where they have a distribution.
        "stripes" {}
        /// Incremental dynamic analysis: each motion is raised in growing steps until it fells the stack, then the gap
        /// before and the gaps below are filled (hunt and fill, Vamvatsikos and Cornell 2004).
        "ida" {
            /// Lowest level.
            first = Kind::Value, Default::Required;
            /// First step up.
            step = Kind::Value, Default::Required;
            /// By how much each step is longer than the one before.
            growth = Kind::Value, Default::Derived("half of `step`");
            /// Gap between standing and collapse, over the highest level that stood, at which it is narrow enough.
            resolution = Kind::Number(Range::between(1e-3, 1.0)), Default::Value("0.1");
            /// Runs of each hunt.
            runs = Kind::Integer(3, 1000), Default::Value("12");
        }
    }
}

table! {
    /// Many runs of one scenario: what is varied, what shakes it, and which cases are run.
    pub static STUDY = "study";
    /// Version of the language of study files.
    schema = Kind::Integer(1, SCHEMA), Default::Required;
    /// Title, in one line.
    title = Kind::Text, Default::Derived("name of the file");
    /// Seed of everything that is drawn.
    seed = Kind::Integer(0, u32::MAX as i64), Default::Value("1");
    /// The scenario that is varied, with all its fields; most often `extends` and what differs.
    base = Kind::Table(&ROOT), Default::Required;
    /// Varied quantities.
    factor = Kind::Tables(&FACTOR), Default::Nothing;
    /// Motions of the ground.
    motion = Kind::Tables(&MOTIONS), Default::Derived("the motion of the base");
    /// Intensity to which motions are scaled.
    intensity = Kind::Table(&INTENSITY), Default::Nothing;
    /// Which cases are run.
    design = Kind::Table(&DESIGN), Default::Required;
}
