//! Runs jobs on all cores and returns their results in the order of the jobs.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use barrelstack::pool;
use barrelstack::report::sentences;
use barrelstack::run::Run;
use barrelstack::scenario::Scenario;
use barrelstack::summary::Summary;

use super::ReproduceError;

/// A scenario to run, and what to keep of the run.
pub(super) struct Job {
    /// Label of the job in error messages.
    pub(super) label: String,
    /// The scenario.
    pub(super) scenario: Scenario,
    /// `true` to keep frames, histories and envelopes, `false` for the summary only.
    pub(super) keep: bool,
}

impl Job {
    /// Creates a job that keeps only the summary.
    pub(super) fn brief(label: String, scenario: Scenario) -> Self {
        Self { label, scenario, keep: false }
    }
}

/// A completed run.
pub(super) struct Done {
    /// Summary of the run.
    pub(super) summary: Summary,
    /// The whole run; `None` if [`Job::keep`] is `false`.
    pub(super) run: Option<Box<Run>>,
    /// Result of the run, in one sentence.
    pub(super) headline: String,
}

/// Runs all jobs on all cores and returns their results in order.
///
/// `progress` is called repeatedly with the number of completed jobs and the total number of jobs. It stops the work by
/// returning [`ControlFlow::Break`]; jobs that are not completed by then are `None`.
pub(super) fn run_all(
    jobs: &[Job],
    progress: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Vec<Option<Done>>, ReproduceError> {
    let done = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let check = || {
        if progress(done.load(Ordering::Relaxed), jobs.len()).is_break() {
            stopped.store(true, Ordering::Relaxed);
        }
        if stopped.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let finished = |now| {
        done.fetch_max(now, Ordering::Relaxed);
        let _: ControlFlow<()> = check();
    };
    pool::map(jobs, |job| run_one(job, &check), &finished).into_iter().collect()
}

fn run_one(job: &Job, check: &dyn Fn() -> ControlFlow<()>) -> Result<Option<Done>, ReproduceError> {
    if check().is_break() {
        return Ok(None);
    }
    let run = job.scenario.run_watched(&mut |_| check()).map_err(|source| ReproduceError::Run {
        case: job.label.clone(),
        source: Box::new(source),
    })?;
    if run.interrupted {
        return Ok(None);
    }
    let summary = Summary::of(&run, None);
    let headline = sentences(&run, &summary).swap_remove(0);
    Ok(Some(Done { summary, run: job.keep.then(|| Box::new(run)), headline }))
}
