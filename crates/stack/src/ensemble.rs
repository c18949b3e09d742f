//! Ensembles: many cases that run together and keep only their results.
//!
//! Cases of the same topology run side by side in the lanes of a vector register; a lane whose case has ended takes the
//! next case. The result of every case is bit-identical to the result of running the case alone, whatever cases run
//! beside it and however many lanes there are.

mod batch;
mod case;
mod columns;
mod rows;
mod single;
mod trail;
mod work;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use barrelstack_dynamics::Method;
use barrelstack_dynamics::lanes::Topology;

use crate::assemble::{Part, PartKind, assemble};
use crate::pool;
use crate::run::{RunFailure, check_length, end_time, method};

use crate::stand::{FEWEST, Stack, Standing, stand_all};
use crate::watch::End;

pub use barrelstack_dynamics::lanes::Width;
pub use case::{CaseResult, Prepared};
pub use columns::{CASE_COLUMNS, CaseColumn, Get, meaning, table, variants};
pub use rows::{Grounds, rows};
pub use trail::{RATE, Trail};
pub use work::{Share, Stage, Work};

/// Version of the results of an ensemble.
///
/// The version is raised with every change of the program that may change any bit of any result, so that results of
/// different versions are never combined.
pub const VERSION: u32 = 13;

/// Largest number of cases that a thread takes at once: enough to fill its lanes, few enough to leave work for all
/// threads.
const BATCH: usize = 32;

/// Progress callback and cancellation of an ensemble.
pub struct Audience<'a> {
    /// Called for each finished case, in any order.
    pub on_case: &'a mut dyn FnMut(&CaseResult),
    /// Polled during the run; returns `true` to stop it.
    pub stop: &'a dyn Fn() -> bool,
}

/// A set of cases that run together on all cores.
///
/// ```
/// use barrelstack_stack::ensemble::{Ensemble, Prepared};
/// use barrelstack_stack::Scenario;
///
/// let mut cases = Vec::new();
/// for friction in [0.2, 0.4, 0.6] {
///     let change = format!("interface.block-ground.friction.coefficient={friction}");
///     cases.push(Prepared::new(Scenario::builtin("sliding-block", &[change])?)?);
/// }
/// let results = Ensemble { cases, ..Ensemble::default() }.run();
/// assert!(results.iter().all(|result| result.outcome.is_ok()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Ensemble {
    /// The cases; cases with the same stack or motion share the data of that stack or motion.
    pub cases: Vec<Prepared>,
    /// Vector unit to use; `None` for the widest that the machine has. Results do not depend on this choice.
    pub lanes: Option<Width>,
}

impl Ensemble {
    /// Runs all cases and returns their results in the order of the cases.
    pub fn run(&self) -> Vec<CaseResult> {
        // The run is never stopped, so every case has a result.
        self.run_watched(&|_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// Runs all cases with an observer that may stop the ensemble; returns `None` if the ensemble was stopped.
    ///
    /// The observer is called for every finished case, in any order and from several threads.
    pub fn run_watched(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
    ) -> Option<Vec<CaseResult>> {
        self.run_until(observer, &|| false)
    }

    /// Runs like [`Ensemble::run_watched`], and stops as soon as `asked_to_stop` returns `true`.
    ///
    /// `asked_to_stop` is polled many times a second.
    pub fn run_until(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
        asked_to_stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Vec<CaseResult>> {
        self.run_as_far(observer, asked_to_stop).into_iter().collect()
    }

    /// Runs like [`Ensemble::run_until`], but keeps the results of a stopped run: `None` for each unfinished case.
    ///
    /// Cases with a collapse end earlier, so the finished cases are a biased sample.
    pub fn run_as_far(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
        asked_to_stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<CaseResult>> {
        let stopped = AtomicBool::new(false);
        let lanes = self.lanes.unwrap_or_else(Width::widest);
        let together = |cases: &&[Prepared]| {
            let mut report = |result: &CaseResult| {
                if observer(result).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
            };
            let stop = || stopped.load(Ordering::Relaxed) || asked_to_stop();
            simulate_as_far(lanes, cases, &mut Audience { on_case: &mut report, stop: &stop })
        };
        let size = self.cases.len().div_ceil(pool::cores()).clamp(FEWEST, BATCH);
        let batches: Vec<&[Prepared]> = self.cases.chunks(size).collect();
        pool::map(&batches, together, &|_| ()).concat()
    }
}

/// Runs cases on one core and returns their results in order; `None` if stopped.
///
/// Results do not depend on how cases are grouped into calls.
pub fn simulate(cases: &[Prepared], audience: &mut Audience<'_>) -> Option<Vec<CaseResult>> {
    simulate_in(Width::widest(), cases, audience)
}

/// Runs like [`simulate`] in lanes of a given width; a machine without such lanes runs one case after the other.
pub fn simulate_in(
    width: Width,
    cases: &[Prepared],
    audience: &mut Audience<'_>,
) -> Option<Vec<CaseResult>> {
    simulate_as_far(width, cases, audience).into_iter().collect()
}

/// Runs like [`simulate_in`], but keeps the results of a stopped run: `None` for each unfinished case.
fn simulate_as_far(
    width: Width,
    cases: &[Prepared],
    audience: &mut Audience<'_>,
) -> Vec<Option<CaseResult>> {
    let mut results: Vec<Option<CaseResult>> = vec![None; cases.len()];
    let mut stacks: Vec<Stack<'_>> = Vec::new();
    let mut runs: Vec<Result<Run<'_>, String>> = Vec::new();
    let mut stage = Stage::settling();
    for (index, case) in cases.iter().enumerate() {
        if (audience.stop)() {
            return results;
        }
        runs.push(prepare(case, index, &mut stacks));
    }
    if stand_all(width, &mut stacks, audience.stop).is_none() {
        return results;
    }
    let mut ready = Vec::new();
    for (run, result) in runs.into_iter().zip(&mut results) {
        let refused = match run {
            Ok(run) => stacks[run.stack].refusal().ok_or(run),
            Err(reason) => Ok(CaseResult::failed(reason)),
        };
        match refused {
            Ok(refused) => (audience.on_case)(result.insert(refused)),
            Err(run) => ready.push(run),
        }
    }
    stage.shake(cases.len());
    for (method, group) in groups(&ready, &stacks) {
        if (audience.stop)() {
            break;
        }
        let done = if method.is_adaptive() {
            single::run(&group, &stacks, audience)
        } else {
            let width = if group.len() < FEWEST { Width::Scalar } else { width };
            batch::run(width, method, &group, &stacks, audience)
        };
        for (index, result) in done {
            results[index] = Some(result);
        }
    }
    results
}

impl Stack<'_> {
    /// Returns the stack as it stands before the shaking, or the reason why it cannot be shaken.
    fn found(&self) -> Result<&Standing, String> {
        self.standing.as_ref().map_err(ToString::to_string)
    }

    /// Returns the result that all cases of a stack have if the stack cannot be shaken; `None` if it can be shaken.
    ///
    /// If the stack falls under its own weight, the result is a collapse. If the stack cannot be built or does not come
    /// to rest, the result has no verdict.
    fn refusal(&self) -> Option<CaseResult> {
        let failure = self.standing.as_ref().err()?;
        Some(
            self.fallen_at_rest(failure).unwrap_or_else(|| CaseResult::failed(failure.to_string())),
        )
    }

    fn fallen_at_rest(&self, failure: &RunFailure) -> Option<CaseResult> {
        let RunFailure::Settle(restless) = failure else { return None };
        let levels = self.scenario.stack().filter(|_| restless.falls())?.levels;
        // The stack as built, before it fell.
        let assembly = assemble(self.scenario).ok()?;
        let level = |part: &Part| part.level.unwrap_or(1);
        let first = assembly.parts.iter().find(|part| part.name == restless.error.body);
        let height = |body: usize| {
            let center = assembly.model.bodies()[body].pose.position.z;
            (center - assembly.parts[body].size).max(0.0)
        };
        let barrels: Vec<(String, u32, f64, f64)> = assembly
            .of_kind(PartKind::Barrel)
            .map(|body| {
                let part = &assembly.parts[body];
                (part.name.clone(), level(part), height(body), part.wine)
            })
            .collect();
        let first = (restless.error.body.as_str(), first.map_or(1, level));
        Some(CaseResult::fallen_at_rest(first, levels, &barrels, failure.to_string()))
    }
}

/// A case that is ready to run, and the index of its stack.
#[derive(Clone, Copy)]
struct Run<'a> {
    case: &'a Prepared,
    /// Index of the case.
    index: usize,
    /// Index of the stack of the case.
    stack: usize,
    /// Latest time (s) at which the run ends.
    end_time: f64,
}

impl Run<'_> {
    /// Returns the criteria that may end the run before `end_time`.
    fn end(&self, standing: &Standing) -> End {
        End::new(&self.case.scenario, &standing.assembly, &self.case.ground)
    }
}

/// Finds or builds the stack of a case.
fn prepare<'a>(
    case: &'a Prepared,
    index: usize,
    stacks: &mut Vec<Stack<'a>>,
) -> Result<Run<'a>, String> {
    let scenario = &case.scenario;
    let time_scale = scenario.run.similitude.sqrt();
    let end_time =
        end_time(scenario, case.ground.motion_end(), time_scale).map_err(|e| e.to_string())?;
    let known = stacks.iter().rposition(|stack| stack.is_of(scenario));
    let stack = known.unwrap_or(stacks.len());
    if known.is_none() {
        let built = Stack::built(scenario, end_time);
        // This error concerns the duration of the motion, and the same stack may run under a shorter motion.
        if let Err(failure @ RunFailure::Duration(_)) = &built.standing {
            return Err(failure.to_string());
        }
        stacks.push(built);
    }
    let step = stacks[stack].found()?.step;
    check_length(end_time, step).map_err(|failure| failure.to_string())?;
    Ok(Run { case, index, stack, end_time })
}

/// Groups the runs that can share a batch, in the order of their cases.
fn groups<'a>(runs: &[Run<'a>], stacks: &[Stack<'_>]) -> Vec<(Method, Vec<Run<'a>>)> {
    let topology = |stack: &Stack<'_>| Some(Topology::of(&stack.found().ok()?.assembly.model));
    let topologies: Vec<_> = stacks.iter().map(topology).collect();
    let mut groups: Vec<(Method, usize, Vec<Run<'a>>)> = Vec::new();
    for run in runs {
        let method = method(&run.case.scenario);
        let alike = |stack: usize| topologies[stack] == topologies[run.stack];
        match groups.iter_mut().find(|(m, stack, _)| *m == method && alike(*stack)) {
            Some((_, _, group)) => group.push(*run),
            None => groups.push((method, run.stack, vec![*run])),
        }
    }
    groups.into_iter().map(|(method, _, group)| (method, group)).collect()
}
