//! Many runs on all cores, with results in the order of the jobs.

use barrelstack::pool;
use barrelstack::run::Run;
use barrelstack::scenario::Scenario;
use barrelstack::summary::Summary;

use super::ReproduceError;

/// One run to do.
pub(super) struct Job {
    /// What it is, for errors.
    pub(super) label: String,
    /// What is run.
    pub(super) scenario: Scenario,
    /// Whether frames, histories and envelopes are wanted, or the summary alone.
    pub(super) keep: bool,
}

/// One run done.
pub(super) struct Done {
    /// Its summary.
    pub(super) summary: Summary,
    /// All of it, where it was wanted.
    pub(super) run: Option<Box<Run>>,
}

/// Runs all jobs on all cores, the first first; `tell` hears how many are done, of how many.
pub(super) fn run_all(
    jobs: &[Job],
    tell: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Done>, ReproduceError> {
    pool::map(jobs, run_one, &|done| tell(done, jobs.len())).into_iter().collect()
}

fn run_one(job: &Job) -> Result<Done, ReproduceError> {
    let run = job.scenario.run().map_err(|source| ReproduceError::Run {
        case: job.label.clone(),
        source: Box::new(source),
    })?;
    let summary = Summary::of(&run, None);
    Ok(Done { summary, run: job.keep.then(|| Box::new(run)) })
}
