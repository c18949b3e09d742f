//! Results of a cellar: of all its variants, and of the one run that reports show in detail.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;

use barrelstack::Progress;
use barrelstack::summary::Unfinished;
use barrelstack::variants::{Advance, RunChoice};

use crate::kept::{Kept, Part};
use crate::result::RoomRun;
use crate::sample::{Case, CellarFailure, Prepared};
use crate::scenario::Cellar;
use crate::summary::{self, CellarSummary};
use crate::words;

/// Results of a cellar.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The cellar with its plan.
    pub prepared: Prepared,
    /// Results of the variants, in the order of their numbers. Variant 0 is the room as stated in its file. Interrupted
    /// runs are left out.
    pub cases: Vec<Case>,
    /// Result of the run that reports show in detail.
    pub case: Case,
    /// The run that reports show in detail, with its recorded frames.
    pub shown: RoomRun,
    /// Summary of all variants and of the run that is shown.
    pub summary: CellarSummary,
}

/// Runs all variants of a cellar on all cores, and then the run that `choice` selects for display.
///
/// Results do not depend on the number of cores. The observer receives the progress and may stop the work; the results
/// until then are returned.
///
/// # Errors
/// If the plan has a problem, or a stack cannot be built or does not stand under its own weight.
pub fn answer(
    cellar: &Cellar,
    choice: RunChoice,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, CellarFailure> {
    answer_with(cellar, choice, None, observer)
}

/// Works like [`answer`], and keeps the results of the variants in a folder: variants whose results are already there
/// are not run again, and new results are added as soon as they are finished.
///
/// # Errors
/// As for [`answer`]; also if a file of the folder belongs to another cellar, or cannot be written.
pub fn answer_with(
    cellar: &Cellar,
    choice: RunChoice,
    folder: Option<&Path>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, CellarFailure> {
    let prepared = Prepared::new(cellar)?;
    let kept = folder.map(|folder| Kept::open(folder, &prepared)).transpose()?;
    let numbers: Vec<u32> = match choice {
        RunChoice::Alone(_) => Vec::new(),
        RunChoice::Typical | RunChoice::Number(_) if prepared.count() == 0 => Vec::new(),
        RunChoice::Typical | RunChoice::Number(_) => (0..=prepared.count()).collect(),
    };
    let report = shared(observer);
    let of = numbers.len();
    let variants = |done| report(Advance::Variants { done, of });
    let found = prepared.cases(&numbers, kept.as_ref(), &variants)?;
    let mut cases: Vec<Case> = found.into_iter().flatten().collect();
    let done = cases.len();
    let number = match choice {
        RunChoice::Number(number) | RunChoice::Alone(number) => number,
        RunChoice::Typical => summary::typical(&cases).unwrap_or(0),
    };
    let shown = prepared.run(number, 0, &mut |now| {
        report(Advance::Run(Progress { time: now.time, end_time: now.end_time }))
    })?;
    // If the case was finished before, its result is used even if the run that repeats it for display is stopped.
    let finished = cases.iter().find(|case| case.variant == number).cloned();
    let case = finished.unwrap_or_else(|| prepared.case(number, &shown));
    // A case whose run is only repeated for display is not counted again.
    if cases.is_empty() && !shown.interrupted {
        cases.push(case.clone());
    }
    let mut summary = summary::of(&prepared, &cases, (&case, &shown));
    let (done, of) = if of == 0 { (usize::from(!shown.interrupted), 1) } else { (done, of) };
    summary.unfinished = (done < of).then_some(Unfinished { done, of });
    if let Some(unfinished) = &summary.unfinished {
        summary.headline = words::stopped(unfinished, shown.end_time);
    }
    summary.warnings.extend(summary.unfinished.as_ref().map(Unfinished::warning));
    Ok(Answer { prepared, cases, case, shown, summary })
}

/// Runs one part of the variants of a cellar, and keeps their results in a folder.
///
/// Returns three counts: variants of this part with a result in the folder, variants of this part whose computation
/// failed (their results are not kept), and all variants of this part.
///
/// # Errors
/// As for [`answer_with`].
pub fn run_part(
    cellar: &Cellar,
    part: Part,
    folder: &Path,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<[usize; 3], CellarFailure> {
    let prepared = Prepared::new(cellar)?;
    let kept = Kept::open(folder, &prepared)?;
    let numbers: Vec<u32> = (0..=prepared.count()).filter(|number| part.has(*number)).collect();
    let of = numbers.len();
    let report = shared(observer);
    let variants = |done| report(Advance::Variants { done, of });
    let found = prepared.cases(&numbers, Some(&kept), &variants)?;
    let valid = |valid| found.iter().flatten().filter(|case| case.valid == valid).count();
    Ok([valid(true), valid(false), of])
}

/// Wraps an observer so that several threads may call it.
pub(crate) fn shared(
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> impl Fn(Advance) -> ControlFlow<()> + Sync + '_ {
    let observer = Mutex::new(observer);
    move |reached| match observer.lock() {
        Ok(mut observer) => observer(reached),
        // Another thread has panicked; this work is no longer needed.
        Err(_) => ControlFlow::Break(()),
    }
}

impl Answer {
    /// Returns `true` if any part of the work was interrupted.
    pub fn is_stopped(&self) -> bool {
        self.shown.interrupted || self.summary.unfinished.is_some()
    }

    /// Returns `true` if the computation of the shown run failed.
    pub fn is_invalid(&self) -> bool {
        !self.case.valid
    }
}
