//! Many runs on all cores, with results in the order of the jobs.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::ReproduceError;
use crate::run::{Run, run};
use crate::scenario::Scenario;
use crate::summary::Summary;

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

/// Runs all jobs; `tell` hears how many are done, of how many.
///
/// Threads take the jobs in their order, so the long ones belong first.
/// Which thread runs a job changes nothing about its result.
pub(super) fn run_all(
    jobs: &[Job],
    tell: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Done>, ReproduceError> {
    let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let slots: Vec<Mutex<Option<Result<Done, ReproduceError>>>> =
        jobs.iter().map(|_| Mutex::new(None)).collect();
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(at) else { break };
            let done = run_one(job);
            if let Ok(mut slot) = slots[at].lock() {
                *slot = Some(done);
            }
            tell(finished.fetch_add(1, Ordering::Relaxed) + 1, jobs.len());
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get).min(jobs.len());
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    slots
        .into_iter()
        .zip(jobs)
        .map(|(slot, job)| {
            // Every slot was filled: a thread that panics takes the scope, and so this call, with it.
            let filled = slot.into_inner().ok().flatten();
            filled.unwrap_or_else(|| Err(ReproduceError::Lost { case: job.label.clone() }))
        })
        .collect()
}

fn run_one(job: &Job) -> Result<Done, ReproduceError> {
    let run = run(&job.scenario, &mut |_| ControlFlow::Continue(())).map_err(|source| {
        ReproduceError::Run { case: job.label.clone(), source: Box::new(source) }
    })?;
    let summary = Summary::of(&run, None);
    Ok(Done { summary, run: job.keep.then(|| Box::new(run)) })
}
