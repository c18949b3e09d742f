//! Tables and fields of a study file.

mod motion;

use barrelstack_input::{named, table};

use crate::scenario::ROOT;
use crate::scenario::field::{Default, Field, Kind, Range, names};

pub(super) use motion::{Maker, Soil};

use motion::MOTIONS;

/// Version of the format of study files.
pub(super) const SCHEMA: i64 = 1;

/// Maximum number of cases, samples or realizations.
pub(super) const MOST: i64 = 10_000_000;

named! {
    /// Spacing of a range of values.
    pub(super) enum Spacing { Linear = "linear", Logarithmic = "log" }
}

named! {
    /// Kind of a distribution.
    pub(super) enum Form {
        Uniform = "uniform",
        LogUniform = "log-uniform",
        Normal = "normal",
        Lognormal = "lognormal",
        Discrete = "discrete",
    }
}

named! {
    /// Design of a study, which determines its cases.
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
    /// Values at equal steps or equal ratios; both ends are included.
    static RANGE = "range";
    /// First value.
    from = Kind::Value, Default::Required;
    /// Last value.
    to = Kind::Value, Default::Required;
    /// Number of values.
    count = Kind::Integer(2, 10_000), Default::Required;
    /// Equal steps, or equal ratios with "log".
    spacing = Kind::Choice(names::<Spacing>), Default::Value("\"linear\"");
}

const LEAST: Field = Field::new(
    "least",
    Kind::Value,
    Default::Nothing,
    "Smallest value, below which the distribution is truncated.",
);
const GREATEST: Field = Field::new(
    "greatest",
    Kind::Value,
    Default::Nothing,
    "Largest value, above which the distribution is truncated.",
);

table! {
    /// Distribution from which values are drawn.
    static DISTRIBUTION = "distribution";
    /// Kind of the distribution.
    kind = Kind::Choice(names::<Form>), Default::Required;
    by kind {
        /// All values between two limits are equally probable.
        "uniform" {
            /// Least value.
            from = Kind::Value, Default::Required;
            /// Greatest value.
            to = Kind::Value, Default::Required;
        }
        /// The logarithm of the value is uniformly distributed between two limits.
        "log-uniform" {
            /// Least value, above zero.
            from = Kind::Value, Default::Required;
            /// Greatest value.
            to = Kind::Value, Default::Required;
        }
        /// Normal (Gaussian) distribution.
        "normal" {
            /// Mean.
            mean = Kind::Value, Default::Required;
            /// Standard deviation, before any truncation.
            deviation = Kind::Value, Default::Required;
        } then [LEAST, GREATEST]
        /// The logarithm of the value is normally distributed.
        "lognormal" {
            /// Median, above zero.
            median = Kind::Value, Default::Required;
            /// Standard deviation of the natural logarithm, before any truncation.
            dispersion = Kind::Number(Range::up_to(5.0)), Default::Required;
        } then [LEAST, GREATEST]
        /// One of a list of values, each with its probability.
        "discrete" {
            /// List of the values.
            values = Kind::Values, Default::Required;
            /// Relative weight of each value.
            weights = Kind::Values, Default::Derived("all equal");
        }
    }
}

table! {
    /// A factor: a field of the scenario that the study varies. Its values are stated by exactly one of the fields
    /// `values`, `range` and `distribution`.
    static FACTOR = "factor";
    /// Path of the field, such as `interface.rack-ground.friction.coefficient`.
    field = Kind::Text, Default::Required;
    /// Paths of further fields that take the same value as `field`.
    also = Kind::Texts, Default::Nothing;
    /// Name of the column with the values of the factor.
    name = Kind::Text, Default::Derived("`field`");
    /// List of the values.
    values = Kind::Values, Default::Nothing;
    /// Evenly spaced values between two limits.
    range = Kind::Table(&RANGE), Default::Nothing;
    /// Distribution from which values are drawn.
    distribution = Kind::Table(&DISTRIBUTION), Default::Nothing;
    at most one of &["values", "range", "distribution"];
}

table! {
    /// A group of factors that are drawn with a correlation. Factors that share no group are independent of each other.
    static CORRELATION = "correlation";
    /// Names of the factors, each with a continuous distribution.
    factors = Kind::Texts, Default::Required;
    /// Correlation of any two of the factors, each expressed as a standard normal deviate (for lognormal factors, the
    /// correlation of their logarithms).
    coefficient = Kind::Number(Range::between(0.0, 0.95)), Default::Required;
}

table! {
    /// The intensity to which motions are scaled. All components of a motion are scaled by one factor.
    static INTENSITY = "intensity";
    /// Intensity measure of the horizontal component that shakes the stack: pga, pgv, pgd, arias, cav, sa(0.5), …
    measure = Kind::Text, Default::Value("\"pgv\"");
    /// List of the levels.
    levels = Kind::Values, Default::Nothing;
    /// Evenly spaced levels between two limits.
    range = Kind::Table(&RANGE), Default::Nothing;
    /// Distribution from which levels are drawn.
    distribution = Kind::Table(&DISTRIBUTION), Default::Nothing;
    at most one of &["levels", "range", "distribution"];
}

const COUNT: Field =
    Field::new("count", Kind::Integer(1, MOST), Default::Required, "Number of cases.");

table! {
    /// Design of the study, which determines its cases.
    static DESIGN = "design";
    /// Kind of the design.
    kind = Kind::Choice(names::<DesignKind>), Default::Required;
    /// Number of cases in a chunk, the unit of work that is run and stored as a whole; in an incremental
    /// dynamic analysis, number of hunts.
    chunk = Kind::Integer(1, 100_000),
        Default::Derived("64, doubled after every 512 chunks; 8 for three-dimensional stacks and for an \
            incremental dynamic analysis");
    by kind {
        /// Every combination of all values, levels and motions.
        "full-factorial" {}
        /// For every level and motion: one case with the base values, and one case for each other value of each factor,
        /// in which only that factor is changed.
        "one-at-a-time" {
            /// Probabilities of the quantiles that represent a distribution.
            quantiles = Kind::Values, Default::Value("[0.1, 0.9]");
            /// Number of stacks that are drawn at random for each motion. If it is above 0, every factor with a
            /// distribution has a random value in each stack, in place of the values at its quantiles; all changes and
            /// levels use the same stacks.
            draws = Kind::Integer(0, 10_000), Default::Value("0");
        }
        /// Latin hypercube: the range of every factor is divided into `count` equally probable parts, and one
        /// sample lies in each part.
        "latin-hypercube" with [COUNT] {}
        /// Points of a Sobol' sequence with a random shift; if `count` is increased, the earlier points
        /// remain.
        "sobol" with [COUNT] {}
        /// Blocks of Sobol' points for variance-based sensitivity. A block contains two samples and, for
        /// every varied quantity, a copy of the first sample in which that quantity is taken from the second.
        "saltelli" {
            /// Number of blocks, preferably a power of two. The number of cases in a block is the number of
            /// varied quantities plus two.
            count = Kind::Integer(2, MOST), Default::Required;
        }
        /// Independent random samples, until the interval of the collapse probability is narrow enough.
        "monte-carlo" {
            /// Half-width of the 95 % interval (Wilson) of the collapse probability at which sampling stops.
            half_width = Kind::Number(Range::between(1e-4, 0.5)), Default::Nothing;
            /// Maximum number of cases.
            most = Kind::Integer(1, MOST), Default::Required;
            /// Number of cases before the interval is tested for the first time.
            least = Kind::Integer(1, MOST), Default::Value("100");
        }
        /// Every motion at every level. All combinations of listed values are run; factors with a
        /// distribution are drawn for each case.
        "stripes" {}
        /// Incremental dynamic analysis: the level of each motion is raised in growing steps until the stack
        /// collapses. Then the gap just below collapse is narrowed, and the wider gaps below it are filled
        /// (hunt and fill, Vamvatsikos and Cornell 2004).
        "ida" {
            /// Lowest level, at which each hunt starts.
            first = Kind::Value, Default::Required;
            /// First step by which the level is raised.
            step = Kind::Value, Default::Required;
            /// Amount by which each step is larger than the step before it.
            growth = Kind::Value, Default::Derived("half of `step`");
            /// Narrowing stops when the gap between the highest level at which the stack stood and the lowest level at
            /// which it collapsed is at most this fraction of the former level.
            resolution = Kind::Number(Range::between(1e-3, 1.0)), Default::Value("0.1");
            /// Number of runs in each hunt.
            runs = Kind::Integer(3, 1000), Default::Value("12");
        }
    }
}

table! {
    /// A study: many runs of one scenario with varied values and motions.
    pub static STUDY = "study";
    /// Version of the format of study files.
    schema = Kind::Integer(1, SCHEMA), Default::Required;
    /// Title, in one line.
    title = Kind::Text, Default::Derived("name of the file");
    /// Seed of all random draws.
    seed = Kind::Integer(0, u32::MAX as i64), Default::Value("1");
    /// Scenario that is varied. All fields of a scenario are allowed; usually it contains `extends` and the
    /// fields that differ.
    base = Kind::Table(&ROOT), Default::Required;
    /// Varied quantities.
    factor = Kind::Tables(&FACTOR), Default::Nothing;
    /// Groups of factors that are correlated with each other.
    correlation = Kind::Tables(&CORRELATION), Default::Nothing;
    /// Ground motions.
    motion = Kind::Tables(&MOTIONS), Default::Derived("the motion of the base");
    /// Intensity to which motions are scaled.
    intensity = Kind::Table(&INTENSITY), Default::Nothing;
    /// Design of the study, which determines its cases.
    design = Kind::Table(&DESIGN), Default::Required;
}
