//! Variants of a three-dimensional stack. They are sampled and evaluated like the variants of a plane model; in
//! addition, the directions of falls are recorded.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use barrelstack::assemble::PartKind;
use barrelstack::demand::{Demands, Span};
use barrelstack::ensemble::{CaseResult, Share, Stage};
use barrelstack::ground::GroundError;
use barrelstack::outcome::Outcome;
use barrelstack::run::CUT;
use barrelstack::summary::Unfinished;
use barrelstack::variants::words::headline_in_space;
use barrelstack::variants::{
    self, Advance, AsItIs, Judged, Observer, Plane, Remedy, RunChoice, RunCounter, Spread, Trial,
    planes, remedy_by, verdict,
};
use barrelstack::watch::Ending;
use barrelstack::{RunFailure, Scenario, pool};
use barrelstack_dynamics::Vec3;
use barrelstack_dynamics::lanes::LANES;

use crate::fate::Heading;
use crate::ground::Ground;
use crate::lanes;
use crate::run::{Run, affordable, run_on};
use crate::simulation::Prepared;
use crate::stack::Stack;
use crate::summary::{self, Summary};

/// Result of one variant of a three-dimensional stack.
#[derive(Clone, Debug)]
pub struct Case {
    /// The same results as for a case of a plane model, but without the paths of the barrels.
    pub result: CaseResult,
    /// Direction in which the first body left its seat, if any body did.
    pub first: Option<Heading>,
    /// For each fallen barrel, the direction from its position at rest to its final position.
    pub debris: Vec<Heading>,
}

/// Result of a three-dimensional scenario.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The scenario as stated, with the files of its ground-motion records loaded.
    pub scenario: Scenario,
    /// The run that is shown in detail: that of the scenario as stated, or of one of its variants.
    pub run: Run,
    /// Summary of the run, with the statistics of all variants.
    pub summary: Summary,
    /// Results of the scenario as stated and of its variants, including interrupted cases; empty if no variants were
    /// run.
    pub cases: Vec<Case>,
}

impl Case {
    /// Extracts the result of a case from its run.
    pub fn of(run: &Run) -> Self {
        let sound = !matches!(run.outcome, Outcome::Invalid { .. });
        let barrels: Vec<usize> = run.stack.of_kind(PartKind::Barrel).collect();
        let fall = |body: &usize| (run.stack.parts[*body].name.clone(), run.fates[*body].fell_at);
        let left = run.ground.end() - run.end_time;
        let displacement = |body: &usize| {
            let moved = run.fates[*body].moved;
            (moved.x * moved.x + moved.y * moved.y).sqrt()
        };
        let common = CaseResult {
            outcome: Ok(run.outcome.clone()),
            barrels: barrels.len(),
            wine: barrels.iter().map(|body| run.stack.parts[*body].wine).sum(),
            ending: Some(run.ending),
            cut: Some(if run.ending == Ending::Rest || left <= CUT { 0.0 } else { left }),
            end_time: Some(run.end_time),
            steps: Some(run.work.steps),
            energy_residual_ratio: run.energy.map(|energy| energy.residual_ratio()),
            warnings: run.warnings.clone(),
            ..CaseResult::failed(String::new())
        };
        if !sound {
            return Self { result: common, first: None, debris: Vec::new() };
        }
        let named = run.seats.named(&run.stack);
        let result = CaseResult {
            first_fall: run.first_fall,
            falls: barrels.iter().map(fall).collect(),
            fall_heights: run.fallen().map(|body| run.fates[body].drop).collect(),
            fall_wine: run.fallen().map(|body| run.stack.parts[body].wine).collect(),
            fall_forces: run.fallen().map(|body| run.fates[body].fall_force).collect(),
            demands: demands(run, Span::UntilLoss),
            demands_whole_run: demands(run, Span::WholeRun),
            joints: named.map(|(name, joint)| (name, joint.clone())).collect(),
            residual_displacement: Some(barrels.iter().map(displacement).fold(0.0, f64::max)),
            ..common
        };
        Self { result, first: run.heading, debris: run.debris().collect() }
    }

    /// Creates the result of a case that was not finished.
    fn interrupted() -> Self {
        Self { result: CaseResult::interrupted(), first: None, debris: Vec::new() }
    }

    /// Creates the result of a scenario that could not be run: a collapse if the stack falls under its own weight, and
    /// otherwise no verdict.
    pub fn refused(scenario: &Scenario, failure: &RunFailure) -> Self {
        let result = fallen_at_rest(scenario, failure)
            .unwrap_or_else(|| CaseResult::failed(failure.to_string()));
        Self { result, first: None, debris: Vec::new() }
    }

    /// Returns the direction in which the first body left its seat, if any body did, and the directions of the fallen
    /// barrels; `None` for a case that is neither stable nor a collapse.
    pub fn headings(&self) -> Option<(Option<Heading>, &[Heading])> {
        let judged = matches!(self.result.outcome, Ok(Outcome::Stable | Outcome::Collapse { .. }));
        judged.then_some((self.first, self.debris.as_slice()))
    }
}

fn fallen_at_rest(scenario: &Scenario, failure: &RunFailure) -> Option<CaseResult> {
    let RunFailure::Settle(restless) = failure else { return None };
    let levels = scenario.stack().filter(|_| restless.falls())?.levels;
    // A result needs a stack: the stack as built, before it fell.
    let stack = Stack::of(scenario).ok()?;
    let name = restless.error.body.as_str();
    let first = stack.parts.iter().find(|part| part.name == name);
    let barrel = |body: usize| {
        let part = &stack.parts[body];
        let center = stack.model.bodies()[body].pose.position.z;
        (part.name.clone(), part.level, (center - part.size).max(0.0), part.wine)
    };
    let barrels: Vec<_> = stack.of_kind(PartKind::Barrel).map(barrel).collect();
    let from_level = first.map_or(1, |part| part.level.max(1));
    Some(CaseResult::fallen_at_rest((name, from_level), levels, &barrels, failure.to_string()))
}

/// Returns the demands in a span of a run. Displacements are horizontal and may have any direction.
pub fn demands(run: &Run, span: Span) -> Demands {
    let Run { stack, fates, seats, .. } = run;
    let most = |kind: PartKind, on: &dyn Fn(u32) -> bool, value: &dyn Fn(usize) -> Option<f64>| {
        let bodies = stack.of_kind(kind).filter(|body| on(stack.parts[*body].level));
        bodies.filter_map(value).reduce(f64::max)
    };
    let (barrel, rack) = (PartKind::Barrel, PartKind::Rack);
    let (bottom, any) = (|level: u32| level == 1, |_: u32| true);
    let length = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
    let motion = |body: usize| match span {
        Span::UntilLoss => fates[body].until_loss,
        Span::WholeRun => fates[body].whole_run,
    };
    let drift = |body: usize| Some(motion(body).displacement / stack.height);
    let slip = |body: usize| Some(motion(body).slip);
    let collapsed = |body: usize| {
        let Vec3 { x, y, .. } = fates[body].moved_at_collapse;
        Some(length([x, y]))
    };
    let load = |body: usize| {
        let load = seats.joints.stave_load(body, &|id| stack.parts[id].kind, span);
        Some(load? / stack.stave_capacity)
    };
    Demands {
        top_drift_ratio: most(barrel, &|level| level == stack.levels, &drift),
        stress_amplification: most(barrel, &bottom, &|body| seats.amplification(body, span)),
        mean_stress_amplification: most(barrel, &bottom, &|body| {
            seats.mean_amplification(body, span)
        }),
        stave_utilization: most(barrel, &any, &load),
        base_slip_peak: most(rack, &bottom, &slip),
        base_slip_at_collapse: most(rack, &bottom, &collapsed),
        base_slip_residual: most(rack, &bottom, &|body| Some(length(fates[body].residual_slip))),
        rack_walk_peak: most(rack, &|level| level > 1, &slip),
        rack_tilt_peak: most(rack, &any, &|body| Some(motion(body).tilt)),
    }
}

/// Runs the scenario as stated and all its variants on all cores.
///
/// The observer receives the number of finished cases and their total, and may stop the work. Unfinished cases are
/// returned as interrupted.
///
/// The result of the scenario as stated is followed by the results of the variants, in the order of their numbers.
/// Unlike in a plane model, no variant exchanges the horizontal components: all variants keep the azimuth of the
/// scenario.
///
/// # Errors
/// If the motion cannot be read, or the stack as stated cannot be built or does not stand.
pub fn run_all(
    scenario: &Scenario,
    observer: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Vec<Case>, RunFailure> {
    let plane = plane(scenario)?;
    let ground = checked(&plane)?;
    let numbers = plane.numbers();
    Ok(run_some(&plane, &ground, &numbers, &|done| observer(done, numbers.len())))
}

/// Returns the ground motion, after checking that the motion can be read, that the stack can be built, and that memory
/// suffices, so that errors are found before variants are run.
fn checked(plane: &Plane) -> Result<Ground, RunFailure> {
    let ground = Ground::of(&plane.scenario)?;
    affordable(&plane.scenario, &Stack::of(&plane.scenario)?, &ground)?;
    Ok(ground)
}

/// Returns the same results as [`run_all`]. In addition, reports a first verdict, based on the first variants alone, to
/// the observer, as for plane models.
fn run_with_first_verdict(
    plane: &Plane,
    report: &(dyn Fn(Advance) -> ControlFlow<()> + Sync),
) -> Result<Vec<Case>, RunFailure> {
    let ground = checked(plane)?;
    let run = |numbers: &[u32], counter: RunCounter<'_>| {
        Ok::<_, RunFailure>(run_some(plane, &ground, numbers, counter))
    };
    let first_headline = |cases: &Vec<Case>| {
        let results: Vec<CaseResult> = cases.iter().map(|case| case.result.clone()).collect();
        let finished = !results.iter().any(CaseResult::is_interrupted);
        let spread = finished.then(|| Spread::of(plane, &results))??;
        Some(headline_in_space(&spread))
    };
    let (mut cases, more) =
        variants::run_with_first_verdict((&plane.numbers(), 1), &run, &first_headline, report)?;
    cases.extend(more.into_iter().flatten());
    Ok(cases)
}

/// Runs the variants with the given numbers on all cores. The observer receives the number of finished variants, and
/// may stop the work.
fn run_some(
    plane: &Plane,
    ground: &Ground,
    numbers: &[u32],
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Vec<Case> {
    run_each(numbers, &|number| (plane.trial(*number), ground.clone()), observer)
}

/// Runs one case for each item, on all cores; `build` creates the case from the item. The observer receives the number
/// of finished cases, and may stop the work. Unfinished cases are returned as interrupted.
///
/// Cases with the same topology run side by side in the lanes of a vector register. The results are bit-identical to
/// those of separate runs.
pub fn run_each<T: Sync>(
    items: &[T],
    build: &(dyn Fn(&T) -> (Scenario, Ground) + Sync),
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Vec<Case> {
    run_all_of(true, items, build, observer)
}

/// Runs cases as [`run_each`] does, but each core runs one case after the other.
pub fn run_each_alone<T: Sync>(
    items: &[T],
    build: &(dyn Fn(&T) -> (Scenario, Ground) + Sync),
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Vec<Case> {
    run_all_of(false, items, build, observer)
}

/// Runs cases on all cores, in lanes if `in_lanes` is `true`.
fn run_all_of<T: Sync>(
    in_lanes: bool,
    items: &[T],
    build: &(dyn Fn(&T) -> (Scenario, Ground) + Sync),
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Vec<Case> {
    let (done, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let report = |done: usize| {
        if observer(done).is_break() {
            stopped.store(true, Ordering::Relaxed);
        }
    };
    let stop = || {
        report(done.load(Ordering::Relaxed));
        stopped.load(Ordering::Relaxed)
    };
    let work = |chunk: &&[T]| {
        let mut cases: Vec<Case> = chunk.iter().map(|_| Case::interrupted()).collect();
        let mut finished = |at: usize, case: Case| {
            cases[at] = case;
            report(done.fetch_add(1, Ordering::Relaxed) + 1);
        };
        run_chunk(in_lanes, chunk, build, &mut finished, &stop);
        cases
    };
    let size = items.len().div_ceil(pool::cores()).clamp(1, BATCH);
    // A few cases beyond full lanes run faster one after the other.
    let size = if size > LANES { size - size % LANES } else { size };
    let chunks: Vec<&[T]> = items.chunks(size).collect();
    pool::map(&chunks, work, &|_| ()).concat()
}

/// Largest number of cases that a thread takes at once; with this number, its lanes are full for most of the time.
const BATCH: usize = 32;

/// Runs cases on one core. If `in_lanes` is `true`, the cases that can advance together run in lanes; all others run
/// one after the other.
fn run_chunk<T>(
    in_lanes: bool,
    items: &[T],
    build: &(dyn Fn(&T) -> (Scenario, Ground) + Sync),
    finished: &mut dyn FnMut(usize, Case),
    stop: &dyn Fn() -> bool,
) {
    let mut ready = Vec::new();
    let mut stage = Stage::settling();
    for (at, item) in items.iter().enumerate() {
        if stop() {
            return;
        }
        let (scenario, ground) = build(item);
        match Prepared::new(&scenario, ground) {
            Ok(prepared) => ready.push((at, prepared)),
            Err(failure) => finished(at, Case::refused(&scenario, &failure)),
        }
    }
    stage.shake(items.len());
    for (at, prepared) in lanes::run(in_lanes, ready, finished, stop) {
        let fixed = &prepared.fixed;
        let mut share = Share::new(fixed.settings.end_time, fixed.ground.end());
        let run = prepared.start().run_watched(&mut |progress| {
            share.reached(progress.time);
            if stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if run.ending == Ending::Interrupted {
            return;
        }
        share.end(run.end_time);
        finished(at, Case::of(&run));
    }
}

/// Trial of a possible remedy: a changed three-dimensional stack with its variants and its ground motion.
struct InSpace {
    plane: Plane,
    ground: Ground,
    /// Number of finished runs.
    done: usize,
}

impl Trial for InSpace {
    fn run(&mut self, block: &[u32], observer: RunCounter<'_>) -> Judged {
        let numbers: Vec<u32> = block.iter().map(|index| index + 1).collect();
        let before = self.done;
        let cases = run_some(&self.plane, &self.ground, &numbers, &|done| observer(before + done));
        self.done += cases.len();
        if cases.iter().any(|case| case.result.outcome == Ok(Outcome::Interrupted)) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(vec![cases.iter().map(|case| verdict(&case.result)).collect()])
    }
}

/// Searches for the smallest change that would have kept the stack up, with the same rules and statistics as for plane
/// models.
///
/// Returns `None` if the stack stands or has no variants, or if its runs end before the motion does.
///
/// # Errors
/// If the motion cannot be read.
pub fn remedy(answer: &Answer, observer: Observer<'_>) -> Result<Option<Remedy>, GroundError> {
    if answer.summary.unfinished.is_some() || answer.run.ending == Ending::Interrupted {
        return Ok(None);
    }
    let prepare = |scenario: &Scenario| -> Result<Box<dyn Trial>, GroundError> {
        let plane = plane(scenario)?;
        let ground = Ground::of(&plane.scenario)?;
        Ok(Box::new(InSpace { plane, ground, done: 0 }))
    };
    let results = answer.cases.iter().skip(1).map(|case| &case.result).collect();
    let as_it_is =
        AsItIs { spreads: answer.summary.ensemble.iter().collect(), results: vec![results] };
    remedy_by(&answer.scenario, &as_it_is, (&prepare, FIRST), observer)
}

/// Number of variants in the first block of a change in the search for a remedy. This number is too small to fill the
/// lanes of a vector register. However, a few runs usually suffice to reject a change, and take less time one after the
/// other than a whole bundle of runs.
const FIRST: usize = 2;

/// Loads the ground-motion records of a three-dimensional scenario, and returns the scenario with its variants.
fn plane(scenario: &Scenario) -> Result<Plane, GroundError> {
    let mut all = planes(scenario)?;
    Ok(all.swap_remove(0))
}

/// Runs all variants of a three-dimensional scenario, and then the run that is shown in detail (see `choice`).
///
/// The observer may stop the work; the results until then are returned.
///
/// # Errors
/// The same as for [`run_all`], and if the stack of the selected run cannot be built or does not stand.
pub fn answer(
    scenario: &Scenario,
    choice: RunChoice,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, RunFailure> {
    answered(scenario, choice, None, observer)
}

/// Returns the same result as [`answer`]. If the scenario as stated and all its variants were already run, `known`
/// contains their results, and only the run that is shown in detail is repeated.
pub(crate) fn answered(
    scenario: &Scenario,
    choice: RunChoice,
    known: Option<Vec<Case>>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Answer, RunFailure> {
    let scenario = &scenario.with_event()?;
    let plane = plane(scenario)?;
    let observer = Mutex::new(observer);
    let report = |reached: Advance| match observer.lock() {
        Ok(mut observer) => observer(reached),
        // Another thread has panicked; this work is no longer needed.
        Err(_) => ControlFlow::Break(()),
    };
    let varied = !matches!(choice, RunChoice::Alone(_)) && plane.count() > 0;
    let cases = match known {
        Some(cases) if varied => cases,
        _ if varied => run_with_first_verdict(&plane, &report)?,
        _ => Vec::new(),
    };
    let results: Vec<CaseResult> = cases.iter().map(|case| case.result.clone()).collect();
    let done = results.iter().filter(|one| !one.is_interrupted()).count();
    let unfinished = (done < results.len()).then_some(Unfinished { done, of: results.len() });
    let whole = !cases.is_empty() && unfinished.is_none();
    let spread = whole.then(|| Spread::of(&plane, &results)).flatten();
    let number = match (choice, &spread) {
        (RunChoice::Number(number) | RunChoice::Alone(number), _) => number,
        (RunChoice::Typical, Some(spread))
            if results.first().is_some_and(|one| one.outcome.is_ok()) =>
        {
            spread.typical
        }
        (RunChoice::Typical, _) => 0,
    };
    let variant = plane.variant(number);
    let ground = Ground::of(&plane.scenario)?;
    let mut run = run_on(&variant, ground, &mut |now| report(Advance::Run(now)))?;
    run.warnings.extend(unfinished.as_ref().map(Unfinished::warning));
    let mut summary = summary::of(&run, &plane.scenario);
    summary.unfinished = unfinished;
    summary.variant = number;
    summary.directions =
        spread.as_ref().map(|_| summary::directions(cases.get(1..).unwrap_or_default()));
    summary.ensemble = spread;
    Ok(Answer { scenario: plane.scenario, run, summary, cases })
}
