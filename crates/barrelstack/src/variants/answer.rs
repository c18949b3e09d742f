//! The answer to a scenario: statistics of its variants, and the run to show.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::remedy::RunCounter;
use super::typical::typical;
use super::{Plane, Spread, Variants, planes, run_as_far, together, words};
use crate::check::check;
use crate::compare::Comparable;
use crate::ensemble::CaseResult;
use crate::ground::{GroundError, from_disk};
use crate::pool;
use crate::report::headline;
use crate::run::{Progress, Run, RunFailure};
use crate::scenario::{Scenario, View};
use crate::summary::{Summary, Unfinished};

/// Progress of the computation of an [`Answer`].
#[derive(Clone, Debug, PartialEq)]
pub enum Advance {
    /// Progress of the variants.
    Variants {
        /// Number of finished cases. The variants are counted, and also the nominal case if it is run. For a stack in
        /// two planes, each of them counts as two cases, one per plane.
        done: usize,
        /// Number of all cases, finished or not, counted like `done`.
        of: usize,
    },
    /// Verdict of the variants with the lowest numbers, reported before the others are run.
    First {
        /// Number of variants in the first verdict, in each plane.
        variants: u32,
        /// First verdict in one sentence.
        headline: String,
    },
    /// Combined progress of the runs that are to be shown.
    Run(Progress),
}

/// Selection of the run to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunChoice {
    /// The most typical run: the medoid of the nominal case and of all variants.
    Typical,
    /// The variant with this number; 0 is the nominal case.
    Number(u32),
    /// The variant with this number; no other variants are run.
    Alone(u32),
}

/// Results of a scenario, in one plane or in both.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The scenario.
    pub scenario: Scenario,
    /// Results in the governing plane; with two planes, the plane in which more variants collapse.
    pub decides: Shown,
    /// Results in the other plane, if the scenario has both planes.
    pub other: Option<Shown>,
}

impl Answer {
    /// Returns `true` if any part of the work was interrupted.
    pub fn is_stopped(&self) -> bool {
        let mut planes = std::iter::once(&self.decides).chain(&self.other);
        planes.any(|shown| shown.run.interrupted || shown.summary.unfinished.is_some())
    }

    /// Returns, as text, the verdict on all variants if they were run, otherwise the verdict on the single run.
    pub fn headline(&self) -> String {
        headline(&self.decides.run, &self.decides.summary)
    }
}

impl Answer {
    /// Returns the results of all planes, the governing plane first.
    pub(crate) fn shown(&self) -> impl Iterator<Item = &Shown> {
        std::iter::once(&self.decides).chain(&self.other)
    }

    /// Runs the variant `number`, and returns this answer with that variant as the shown run.
    ///
    /// The observer receives the progress and may cancel.
    ///
    /// # Errors
    /// If that variant cannot be run.
    pub(crate) fn showing(
        &self,
        number: u32,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure> {
        let of = |view: Option<View>| {
            let shown = self.shown().find(|shown| shown.run.assembly.view == view)?;
            Some(shown.variants.as_ref()?.results.clone())
        };
        let results = planes(&self.scenario)?.iter().map(|plane| of(plane.view())).collect();
        answered(&self.scenario, RunChoice::Number(number), results, observer)
    }
}

/// Returns the number of the variant that is the most typical one over all answers and planes (the medoid); `None` if
/// an answer has no variants.
///
/// Only variants that run under the same horizontal component of the motion in all answers are eligible. If the nominal
/// cases already differ in this component, all variants are eligible.
pub(crate) fn common_number<A: Comparable>(answers: &[&A]) -> Result<Option<u32>, GroundError> {
    let all: Option<Vec<Vec<CaseResult>>> =
        answers.iter().flat_map(|answer| answer.results()).collect();
    let Some(all) = all else { return Ok(None) };
    let mut found: Vec<Vec<Plane>> = Vec::new();
    for answer in answers {
        found.push(planes(answer.scenario())?);
    }
    // For a variant number and a plane, the component of the motion in every scenario that has this
    // plane.
    let components = |number: u32, view: Option<View>| {
        let planes = found.iter().flatten().filter(move |plane| plane.view() == view);
        planes.map(move |plane| plane.component(number).map(str::to_owned))
    };
    let same = |number: u32| {
        [Some(View::Transverse), Some(View::Longitudinal), None].iter().all(|view| {
            let mut all = components(number, *view);
            all.next().is_none_or(|first| all.all(|other| other == first))
        })
    };
    // If the answers differ in the component of the motion, all numbers are eligible.
    let differ = !same(0);
    let allowed = |at: usize| differ || u32::try_from(at).is_ok_and(same);
    let all: Vec<&[CaseResult]> = all.iter().map(Vec::as_slice).collect();
    Ok(Some(typical(&all, &allowed)))
}

/// Results of one plane of an answer.
#[derive(Clone, Debug)]
pub struct Shown {
    /// The run that is shown.
    pub run: Run,
    /// Summary of the run, with the statistics of all variants; the summary of the governing plane
    /// includes the summary of the other plane.
    pub summary: Summary,
    /// Results of all variants; `None` if there are none, or if they were interrupted.
    pub variants: Option<Variants>,
    /// If the variants were interrupted, the results of the nominal case and of the variants, by
    /// number; unfinished cases have the outcome `Interrupted`.
    pub stopped: Option<Vec<CaseResult>>,
}

/// Runs all variants of a scenario; then runs the case to be shown, with all recordings. Stacks are run in one plane or
/// in both, as the scenario states.
///
/// The observer receives the progress and may cancel; a canceled answer has the results obtained so far.
///
/// # Errors
/// As for [`Scenario::run`].
pub fn answer(
    scenario: &Scenario,
    choice: RunChoice,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, RunFailure> {
    answered(scenario, choice, None, observer)
}

/// Builds an [`answer`] that shows the most typical run, from results of variants that were run elsewhere.
///
/// `results` has, for each plane, the results of the nominal case and of all variants by number, as
/// [`run_some`](super::run_some) returns them.
///
/// # Errors
/// As for [`answer`].
pub fn answer_of(
    scenario: &Scenario,
    results: Vec<Vec<CaseResult>>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, RunFailure> {
    answered(scenario, RunChoice::Typical, Some(results), observer)
}

fn answered(
    scenario: &Scenario,
    choice: RunChoice,
    known: Option<Vec<Vec<CaseResult>>>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, RunFailure> {
    let scenario = &scenario.with_event()?.with_records(&mut from_disk)?;
    let planes = planes(scenario)?;
    let observer = Mutex::new(observer);
    let report = |reached: Advance| match observer.lock() {
        Ok(mut observer) => observer(reached),
        // Another thread has panicked: cancel.
        Err(_) => ControlFlow::Break(()),
    };
    let alone = matches!(choice, RunChoice::Alone(_));
    let varied = !alone && planes.iter().any(|plane| plane.count() > 0);
    // Fail early: check that the nominal case can be run, and that memory suffices, before running variants.
    for plane in planes.iter().filter(|_| varied) {
        check(&plane.scenario)?;
    }
    let numbers = || planes.first().map(Plane::numbers).unwrap_or_default();
    let results = match known {
        Some(results) if varied => results,
        _ if varied => run_planes(&planes, &numbers(), &report)?,
        _ => Vec::new(),
    };
    let of = results.iter().flatten().count();
    let open = results.iter().flatten().filter(|one| one.is_interrupted()).count();
    let counts = Unfinished { done: of - open, of };
    let unfinished = Some(counts).filter(|counts| counts.done < counts.of);
    let all: Vec<(Option<Variants>, Option<Vec<CaseResult>>)> = if unfinished.is_some() {
        results.into_iter().map(|some| (None, Some(some))).collect()
    } else if varied {
        let found = together(&planes, &numbers(), results);
        found.into_iter().map(|found| (Some(found), None)).collect()
    } else {
        planes.iter().map(|_| (None, None)).collect()
    };
    let tasks: Vec<(&Plane, u32)> = planes
        .iter()
        .zip(&all)
        .map(|(plane, (variants, _))| (plane, number(choice, variants.as_ref())))
        .collect();
    let mut shown = Vec::new();
    let runs = run_selected(scenario, &tasks, &report)?;
    for (((plane, number), run), (variants, stopped)) in tasks.iter().zip(runs).zip(all) {
        let mut run = run;
        run.warnings.extend(plane.warning(planes.len()));
        run.warnings.extend(unfinished.as_ref().map(Unfinished::warning));
        let mut summary = Summary::of(&run, None);
        summary.variant = *number;
        summary.unfinished = unfinished;
        summary.ensemble = variants.as_ref().map(|variants| variants.spread.clone());
        shown.push(Shown { run, summary, variants, stopped });
    }
    // If both planes are equally severe, the first governs: the plane across the barrels.
    let worst = (1..shown.len())
        .fold(0, |worst, at| if weight(&shown[at]) > weight(&shown[worst]) { at } else { worst });
    let mut decides = shown.remove(worst);
    let other = shown.pop();
    decides.summary.other_plane = other.as_ref().map(|other| Box::new(other.summary.clone()));
    Ok(Answer { scenario: scenario.clone(), decides, other })
}

/// Number of variants after which a first verdict is reported, if at least as many variants follow.
const FIRST: u32 = 8;

/// Function that runs the cases with the given numbers, and reports the number of finished cases.
pub type RunCases<'a, R, E> = dyn Fn(&[u32], RunCounter<'_>) -> Result<R, E> + 'a;

/// Runs the nominal case and the variants with the lowest numbers, reports their verdict, and then runs all other
/// variants. Returns two results: those of the first part (the cases on which the verdict is based), and those of the
/// second part (all other variants).
///
/// If the second part would have fewer variants than the first part, all cases are run at once: the results of the
/// second part are then `None`, and no first verdict is reported.
///
/// The first part consists of the variants with the lowest numbers, not of the variants that finish first. The latter
/// would be a biased sample, because runs that collapse end early.
///
/// `numbers` starts with the nominal case. `run` runs every case in the given number of planes. `headline` returns the
/// verdict on the results of the first part, or `None` if a case of the first part is unfinished.
///
/// # Errors
/// Returns the errors of `run`.
pub fn run_with_first_verdict<R, E>(
    (numbers, planes): (&[u32], usize),
    run: &RunCases<'_, R, E>,
    headline: &dyn Fn(&R) -> Option<String>,
    report: &(dyn Fn(Advance) -> ControlFlow<()> + Sync),
) -> Result<(R, Option<R>), E> {
    let of = planes * numbers.len();
    let early = FIRST as usize;
    let at = if numbers.len() > 2 * early { early + 1 } else { numbers.len() };
    let (first, others) = numbers.split_at(at);
    let finished = AtomicUsize::new(0);
    let results = run(first, &|done| {
        finished.fetch_max(done, Ordering::Relaxed);
        report(Advance::Variants { done, of })
    })?;
    if others.is_empty() {
        return Ok((results, None));
    }
    if let Some(headline) = headline(&results) {
        // A request to stop is handled by the next variant.
        let _ = report(Advance::First { variants: FIRST, headline });
    }
    let before = finished.into_inner();
    let more = run(others, &|done| report(Advance::Variants { done: before + done, of }))?;
    Ok((results, Some(more)))
}

/// Runs all cases of each plane, with a first verdict as in [`run_with_first_verdict`]. If the computation is canceled,
/// the unfinished cases have the outcome `Interrupted`.
fn run_planes(
    planes: &[Plane],
    numbers: &[u32],
    report: &(dyn Fn(Advance) -> ControlFlow<()> + Sync),
) -> Result<Vec<Vec<CaseResult>>, GroundError> {
    let run = |numbers: &[u32], counter: RunCounter<'_>| {
        run_as_far(planes, numbers, &|done, _| counter(done))
    };
    let first_headline = |results: &Vec<Vec<CaseResult>>| {
        if results.iter().flatten().any(CaseResult::is_interrupted) {
            return None;
        }
        let of_planes = planes.iter().zip(results);
        let spreads: Vec<(View, Spread)> = of_planes
            .filter_map(|(plane, results)| Some((plane.view()?, Spread::of(plane, results)?)))
            .collect();
        let of_views: Vec<(View, &Spread)> =
            spreads.iter().map(|(view, spread)| (*view, spread)).collect();
        Some(words::headline(&of_views))
    };
    let (mut results, more) =
        run_with_first_verdict((numbers, planes.len()), &run, &first_headline, report)?;
    for (results, more) in results.iter_mut().zip(more.into_iter().flatten()) {
        results.extend(more);
    }
    Ok(results)
}

/// Returns the number of the run to show. If the nominal case cannot be run, the nominal case is
/// selected, so that the reason is reported.
fn number(choice: RunChoice, variants: Option<&Variants>) -> u32 {
    let stated = variants.and_then(|variants| variants.results.first());
    match (choice, variants) {
        (RunChoice::Number(number) | RunChoice::Alone(number), _) => number,
        (RunChoice::Typical, Some(variants)) if stated.is_some_and(|one| one.outcome.is_ok()) => {
            variants.spread.typical
        }
        (RunChoice::Typical, _) => 0,
    }
}

/// Runs, in parallel, the variant with the given number in each plane.
fn run_selected(
    scenario: &Scenario,
    tasks: &[(&Plane, u32)],
    report: &(dyn Fn(Advance) -> ControlFlow<()> + Sync),
) -> Result<Vec<Run>, RunFailure> {
    let scenarios: Vec<Scenario> =
        tasks.iter().map(|(plane, number)| plane.variant(*number)).collect();
    // Each run states the scenario as given, with both planes.
    let stated = |_, run| Run { stated: Box::new(scenario.clone()), ..run };
    let run = |scenario: &Scenario, observer: Watching<'_>| scenario.run_watched(observer);
    run_together(&scenarios, 0.0, &mut |now| report(Advance::Run(now)), &run, &stated)
}

/// Observer of a run: receives the progress and may cancel.
type Watching<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

/// Calls `run` for each scenario, on all cores, and maps each result with `finish`, which also receives the index of
/// the scenario.
///
/// The observer receives the combined progress; a run that has not begun is expected to end at
/// `end_time` (s).
pub(crate) fn run_together<R, T: Send>(
    scenarios: &[Scenario],
    end_time: f64,
    observer: &mut (dyn FnMut(Progress) -> ControlFlow<()> + Send),
    run: &(dyn Fn(&Scenario, Watching<'_>) -> Result<R, RunFailure> + Sync),
    finish: &(dyn Fn(usize, R) -> T + Sync),
) -> Result<Vec<T>, RunFailure> {
    let reached = Mutex::new((vec![Progress { time: 0.0, end_time }; scenarios.len()], observer));
    let tasks: Vec<(usize, &Scenario)> = scenarios.iter().enumerate().collect();
    let work = |(at, scenario): &(usize, &Scenario)| {
        let done = run(scenario, &mut |now| {
            // Another run has panicked: cancel.
            let Ok(mut reached) = reached.lock() else { return ControlFlow::Break(()) };
            let (all, observer) = &mut *reached;
            all[*at] = now;
            let sum = |of: fn(&Progress) -> f64| all.iter().map(of).sum();
            observer(Progress { time: sum(|one| one.time), end_time: sum(|one| one.end_time) })
        })?;
        Ok(finish(*at, done))
    };
    pool::map(&tasks, work, &|_| ()).into_iter().collect()
}

/// Returns the severity of a plane, which is compared lexicographically: the share of variants that collapse (1 for a
/// single run that collapses), then the share of barrels that fall (the median over the variants).
fn weight(shown: &Shown) -> (f64, f64) {
    let outcome = &shown.summary.outcome;
    let barrels = outcome.barrels.max(1) as f64;
    let spread: Option<&Spread> = shown.summary.ensemble.as_ref();
    let alone = if outcome.mode.is_some() { 1.0 } else { 0.0 };
    let share = spread.and_then(Spread::largest_share).unwrap_or(alone);
    let median = spread.and_then(|spread| spread.barrels_fallen).map(|fallen| fallen.p50);
    (share, median.unwrap_or(outcome.barrels_fallen.unwrap_or(0) as f64) / barrels)
}
