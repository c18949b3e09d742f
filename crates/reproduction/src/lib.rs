//! The paper of Candia, de la Llera and Almazán (2008), case by case: published against ours.
//!
//! All cases stand on one geometry, the catalog's rack `candia-2008`; nothing is fitted case by case.
//! Where a number of ours differs, studies vary what the paper leaves open and show what moves it.

// Results have the same bits on every machine, so transcendental functions are those of `libm`.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod cases;
mod compare;
mod ensemble;
mod figures;
mod neighborhood;
mod numbering;
mod page;
mod pool;
mod racks;
mod results;
mod rows;
mod study;
mod tornado;
mod vary;

use std::ops::ControlFlow;
use std::path::Path;

use barrelstack::ground::GroundError;
use barrelstack::run::RunFailure;
use barrelstack::scenario::ScenarioError;
use barrelstack_report::Document;

pub use cases::{Motion, recognize};
pub use compare::{Comparison, Verdict, percent};

/// The paper's results beside ours.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// One row for every number and every finding that the paper states.
    pub comparisons: Vec<Comparison>,
    /// What shook the six barrels.
    pub motion: Motion,
    /// The page.
    pub document: Document,
}

/// Why there is no reproduction.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A built-in case cannot be read with its changes.
    #[error(transparent)]
    Scenario(Box<ScenarioError>),
    /// The record cannot be used.
    #[error(transparent)]
    Record(Box<GroundError>),
    /// A case does not run.
    #[error("{case}: {source}")]
    Run {
        /// The case.
        case: String,
        /// Why.
        source: Box<RunFailure>,
    },
    /// A case gave nothing back.
    #[error("{case}: the run was lost")]
    Lost {
        /// The case.
        case: String,
    },
    /// It was told to stop: half of the table would say nothing.
    #[error("the runs were stopped")]
    Stopped,
}

impl From<ScenarioError> for ReproduceError {
    fn from(error: ScenarioError) -> Self {
        Self::Scenario(Box::new(error))
    }
}

impl From<GroundError> for ReproduceError {
    fn from(error: GroundError) -> Self {
        Self::Record(Box::new(error))
    }
}

/// Runs every case of the paper, and the studies around them, on all cores.
///
/// `record` is the file of the Hollywood Storage record, north-south, which cannot be passed on with
/// the program.
/// Without it the six barrels are shaken by the bundled record of South Napa, and nothing that hangs on
/// the motion is compared.
/// `studies` asks for the studies too: what moves each case, and contact parameters 10 % off; they are
/// most of the work.
/// `tell` hears how many runs are done, of how many, from several threads, and may stop them.
///
/// The result depends on the program, the platform and the record alone.
///
/// # Errors
/// When the record cannot be read, or a case cannot be built.
pub fn reproduce(
    record: Option<&Path>,
    studies: bool,
    tell: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Reproduction, ReproduceError> {
    let cases = cases::Cases::new(record)?;
    let plan = results::Plan::new(&cases, studies);
    let done = pool::run_all(&plan.jobs, tell)?;
    let results = plan.read(cases.motion, done)?;
    let comparisons = rows::all(&results);
    let document = page::document(&results, &comparisons);
    Ok(Reproduction { comparisons, motion: results.motion, document })
}

/// The comparisons alone, as one Markdown table.
pub fn table(found: &Reproduction) -> String {
    compare::table(&found.comparisons)
}
