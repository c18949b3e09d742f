//! Reproduction of the paper of Candia, de la Llera and Almazán (2008): its results compared with ours, case by case.
//!
//! All cases use one geometry, the catalog's rack `candia-2008`, and no parameter is fitted to a single case.
//! To explain differences, studies vary the quantities that the paper does not state, and show their effects.

// Results must be bit-identical on every machine, so transcendental functions are those of `libm`.
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
mod stress;
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
pub use compare::{Agreement, Comparison, percent};

/// The comparison of the paper's results with ours.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// One row for every number and every qualitative finding of the paper.
    pub comparisons: Vec<Comparison>,
    /// The ground motion of the six barrels.
    pub motion: Motion,
    /// The report.
    pub document: Document,
    /// `true` if the studies were stopped; the report then contains no studies.
    pub stopped: bool,
}

/// Reasons why the reproduction fails.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// The scenario of a case cannot be read.
    #[error(transparent)]
    Scenario(Box<ScenarioError>),
    /// The record cannot be used.
    #[error(transparent)]
    Record(Box<GroundError>),
    /// A case cannot be run.
    #[error("{case}: {source}")]
    Run {
        /// The case.
        case: String,
        /// Reason.
        source: Box<RunFailure>,
    },
    /// The run of a case returned no result.
    #[error("{case}: the run returned no result")]
    Lost {
        /// The case.
        case: String,
    },
    /// Stopped before all cases of the paper were completed, so there is no table.
    #[error("the runs were stopped")]
    Stopped {
        /// The name and the result of each completed case.
        done: Vec<(String, String)>,
    },
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

/// Runs all cases of the paper, and sensitivity studies of these cases, on all cores.
///
/// `record` is the file of the Hollywood Storage record, north-south, which cannot be distributed
/// with the program. Without this file, the six barrels are shaken by the bundled record of South
/// Napa, and results that depend on the motion are not compared.
///
/// If `studies` is `true`, sensitivity studies follow, which take most of the time. They change one quantity at a time,
/// change the contact parameters by 10 %, or replace the rack.
///
/// `progress` is called from several threads, with the number of completed runs and the total number of runs. It stops
/// the work by returning [`ControlFlow::Break`]. If all cases of the paper are completed by then, the result is
/// returned without studies.
///
/// The result depends only on the program, the platform and the record.
///
/// # Errors
/// If the record cannot be read, a case cannot be built or run, or the work is stopped before all cases are completed.
pub fn reproduce(
    record: Option<&Path>,
    studies: bool,
    progress: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Reproduction, ReproduceError> {
    let cases = cases::PaperCases::new(record)?;
    let mut plan = results::Plan::new(&cases, studies);
    let mut done = pool::run_all(&plan.jobs, progress)?;
    let stopped = done.iter().any(Option::is_none);
    if stopped {
        plan.leave_out_studies();
        done.truncate(plan.jobs.len());
    }
    if done.iter().any(Option::is_none) {
        let labels = plan.jobs.iter().map(|job| job.label.clone());
        let finished = labels.zip(done).filter_map(|(label, done)| Some((label, done?.headline)));
        return Err(ReproduceError::Stopped { done: finished.collect() });
    }
    let results = plan.read(cases.motion, done.into_iter().flatten().collect())?;
    let comparisons = rows::all(&results);
    let document = page::document(&results, &comparisons, stopped);
    Ok(Reproduction { comparisons, motion: results.motion, document, stopped })
}

/// Formats the comparisons as one Markdown table.
pub fn table(found: &Reproduction) -> String {
    compare::table(&found.comparisons)
}

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
