//! Studies: one scenario run many times, with varied values and motions.
//!
//! ```text
//! STUDY.toml ─▶ Study ─ design ─▶ cases ─ plan ─▶ chunks ─ ensemble ─▶ one Parquet shard per chunk
//!                                                                    │ collect
//!                                                  StudyTable: one row per case ─▶ CSV, Parquet
//! ```
//!
//! A study is a deterministic list of chunks of cases, and each chunk is run as a whole. The rows of a chunk
//! are stored in a file, the shard. A shard gets its final name only when it is complete and on the disk, so
//! that every shard represents a finished chunk. An interrupted study resumes from its shards, on one machine or on
//! many. Random draws for a case depend on the seed of the study and on the identity of the case, not on the number of
//! cases.
//!
//! ```no_run
//! use std::ops::ControlFlow;
//! use std::path::Path;
//! use barrelstack_campaign::study::{RunOptions, Study};
//!
//! let study = Study::load(Path::new("STUDY.toml"))?;
//! let collected = study.run(Path::new("results"), &RunOptions::default(), &|_| ControlFlow::Continue(()))?;
//! println!("{}", collected.table.to_csv());
//! # Ok::<(), barrelstack_campaign::study::StudyError>(())
//! ```

mod builtin;
mod claim;
mod collect;
mod design;
mod distribution;
mod draft;
mod endings;
mod ensembles;
mod error;
mod execute;
mod fields;
mod file;
mod folder;
mod grow;
mod ida;
mod manifest;
mod motions;
mod plan;
mod prepare;
mod rows;
mod setting;
mod shard;
mod space;
mod stop;
mod table;

use crate::scenario::FileRef;
use crate::scenario::template::Template;

pub use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, Values};
pub use builtin::{get as builtin, names as builtin_names};
pub use claim::{Holder, holder};
pub use collect::{Collected, Status, collect, read_shards};
pub use design::Design;
pub use distribution::Distribution;
pub use draft::remove_drafts;
pub use endings::{Endings, Following};
pub use error::StudyError;
pub use execute::{ChunkRun, Progress, RunOptions};
pub use fields::STUDY;
pub use folder::{MotionSource, Provenance};
pub use grow::Common;
pub use ida::Hunt;
pub(crate) use manifest::manifest_of;
pub use plan::Chunk;
pub(crate) use setting::word;
pub use stop::{StopRule, Tally};
pub use table::StudyTable;

use design::Cases;
use motions::Motion;
use plan::{Chunks, Sizes};
use setting::Setting;

/// Study: the varied factors, the motions, and the design of the cases.
///
/// ```
/// use barrelstack_campaign::Study;
///
/// let study = Study::built_in("napa-four-levels")?;
/// assert_eq!(study.plan().map(|chunk| chunk.cases as u64).sum::<u64>(), study.cases());
/// # Ok::<(), barrelstack_campaign::study::StudyError>(())
/// ```
#[derive(Debug)]
pub struct Study {
    /// One-line title.
    pub title: String,
    /// Seed of all random draws.
    pub seed: u64,
    /// Design of the cases.
    pub design: Design,
    /// Text of the study file.
    text: String,
    template: Template,
    /// Files of the motion of the base scenario. Their contents are held in memory.
    held: Vec<FileRef>,
    factors: Vec<Factor>,
    correlations: Vec<Correlation>,
    motions: Vec<Motion>,
    intensity: Option<Intensity>,
    /// `true` if some cases are three-dimensional.
    in_space: bool,
    /// Levels of intensity that are combined with every motion and every set of factors; a single `None` if
    /// there are no levels.
    levels: Vec<Option<f64>>,
    /// Number of cases in each chunk; for an incremental dynamic analysis, number of hunts.
    chunk: Sizes,
    cases: Cases,
    chunks: Chunks,
    /// Fingerprint of the study file, the records and the version of the program.
    hash: u64,
}

/// Factor: one or several fields of the scenario that are varied together.
#[derive(Clone, Debug)]
struct Factor {
    /// Name of the column with the values of the factor.
    name: String,
    /// Paths of the fields that take the value of the factor.
    fields: Vec<String>,
    variation: Variation,
    /// Specification of the column of the factor.
    column: ColumnSpec,
    /// Value in the base scenario, if the base scenario states the field.
    base: Option<Value>,
    /// `true` if models for different values of the factor may have different bodies or contacts.
    structural: bool,
    /// `true` if at least one of the values causes the stack to be simulated in three dimensions.
    in_space: bool,
}

/// Group of factors whose values are drawn with a correlation.
#[derive(Clone, Debug, PartialEq)]
struct Correlation {
    /// Names of the factors.
    factors: Vec<String>,
    /// Correlation coefficient of any two of the factors, each transformed to a standard normal deviate.
    coefficient: f64,
}

impl Correlation {
    fn contains(&self, factor: &str) -> bool {
        self.factors.iter().any(|name| name == factor)
    }
}

/// How a factor is varied: by listed values or by a distribution.
#[derive(Clone, Debug)]
enum Variation {
    Values(Vec<Setting>),
    Distribution(Distribution),
}

impl Factor {
    /// Returns the listed values, which are combined with those of all other factors; `None` for a
    /// distribution.
    fn crossed(&self) -> Option<&[Setting]> {
        match &self.variation {
            Variation::Values(values) => Some(values),
            Variation::Distribution(_) => None,
        }
    }
}

/// Intensity measure, and the levels to which motions are scaled.
#[derive(Clone, Debug)]
struct Intensity {
    measure: barrelstack_motion::IntensityMeasure,
    levels: Levels,
}

/// Levels of an intensity measure, in SI units.
#[derive(Clone, Debug)]
enum Levels {
    List(Vec<f64>),
    Distribution(Distribution),
    /// The levels are found by an incremental dynamic analysis.
    Hunted,
}

/// Returns the schema (JSON Schema 2020-12) of a study file, which editors use for completion and validation.
pub fn json_schema() -> serde_json::Value {
    barrelstack_input::schema::of_file("barrelstack study", &STUDY)
}

/// Returns a reference manual in Markdown, with every table and field of a study file.
///
/// The fields of `[base]` are not listed, since they are those of a scenario file.
pub fn reference() -> String {
    let fields = barrelstack_input::reference::of_tables(
        &STUDY,
        &["scenario", "motion", "sine", "pulse", "scale"],
        "a scenario file has there",
    );
    format!("# Fields of a study file\n\n{fields}")
}

impl Study {
    /// Returns the fingerprint of the study. It depends on the study file, the scenarios that the file
    /// extends, the bytes of its records, and the version of the program.
    pub fn hash(&self) -> u64 {
        self.hash
    }

    /// Returns the number of cases; for an adaptive design, the maximum number.
    pub fn cases(&self) -> u64 {
        let runs = if let Design::Ida(hunt) = &self.design { hunt.runs } else { 1 };
        self.cases.count(self).saturating_mul(u64::from(runs))
    }

    /// `true` if the number of cases depends on the results of earlier cases.
    pub fn is_adaptive(&self) -> bool {
        match &self.design {
            Design::Ida(_) => true,
            Design::MonteCarlo { half_width, .. } => half_width.is_some(),
            Design::FullFactorial
            | Design::OneAtATime { .. }
            | Design::LatinHypercube { .. }
            | Design::Sobol { .. }
            | Design::Saltelli { .. }
            | Design::Stripes => false,
        }
    }

    /// Returns the unit in which chunks are counted: "cases", or "hunts" in an incremental dynamic analysis.
    pub fn chunk_unit(&self) -> &'static str {
        if matches!(self.design, Design::Ida(_)) { "hunts" } else { "cases" }
    }

    /// Returns the factors that are drawn from a distribution: for each, its column, its first field, the unit of its
    /// column, and the distribution.
    pub(crate) fn distributions(&self) -> impl Iterator<Item = (&str, &str, &str, &Distribution)> {
        self.factors.iter().filter_map(|factor| {
            let Variation::Distribution(distribution) = &factor.variation else { return None };
            let field = factor.fields.first()?;
            Some((&*factor.name, &**field, &*factor.column.unit, distribution))
        })
    }

    /// Returns the correlation coefficient of two factors, each transformed to a standard normal deviate. The factors
    /// are identified by the names of their columns. The coefficient is 0 if no group contains both factors.
    pub(crate) fn correlation(&self, factors: [&str; 2]) -> f64 {
        if factors[0] == factors[1] {
            return 1.0;
        }
        let both = |group: &&Correlation| factors.iter().all(|factor| group.contains(factor));
        self.correlations.iter().find(both).map_or(0.0, |group| group.coefficient)
    }

    /// Returns the number of motions.
    pub fn motions(&self) -> usize {
        self.motions.len()
    }
}
