//! Many cases at once: what became of each, and nothing else of it.
//!
//! Cases of one topology run side by side in the lanes of a vector register; a lane whose case has
//! ended takes the next one.
//! Every case comes to the same bits as it would alone, whatever runs beside it and however wide the
//! lanes are.

mod batch;
mod case;
mod columns;
mod rows;
mod single;
mod trail;

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
pub use columns::{CASE_COLUMNS, CaseColumn, Get, table};
pub use rows::{Grounds, rows};
pub use trail::{RATE, Trail};

/// Version of what an ensemble computes: raised whenever the same case may give other bits, so that
/// results of two versions are never put together.
pub const VERSION: u32 = 13;

/// Cases that a thread takes at once: enough to fill lanes, few enough that all threads have some.
const BATCH: usize = 32;

/// Who hears of the cases of an ensemble, and may stop it.
pub struct Audience<'a> {
    /// Hears of each case that is done, in any order.
    pub tell: &'a mut dyn FnMut(&CaseResult),
    /// Is asked now and then whether to stop.
    pub stop: &'a dyn Fn() -> bool,
}

/// Cases that are run together, on all cores.
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
    /// The cases; those of one stack or one motion share it.
    pub cases: Vec<Prepared>,
    /// The vector unit in which they run; the widest of the machine without. Results do not depend on it.
    pub lanes: Option<Width>,
}

impl Ensemble {
    /// Runs all cases; what became of each, in their order.
    pub fn run(&self) -> Vec<CaseResult> {
        // Nobody stops it, so every case has its result.
        self.run_watched(&|_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// As [`Ensemble::run`], before an observer, who hears of every case that is done, in any order and
    /// from several threads, and may stop them all; then there are no results.
    pub fn run_watched(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
    ) -> Option<Vec<CaseResult>> {
        self.run_until(observer, &|| false)
    }

    /// As [`Ensemble::run_watched`], and asks many times a second whether to stop.
    pub fn run_until(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
        asked_to_stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Vec<CaseResult>> {
        self.run_as_far(observer, asked_to_stop).into_iter().collect()
    }

    /// As [`Ensemble::run_until`], and keeps what was done until it was stopped: none for each case that was not.
    ///
    /// Those that collapse end first, so what is done by then is no sample of all.
    pub fn run_as_far(
        &self,
        observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
        asked_to_stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<CaseResult>> {
        let stopped = AtomicBool::new(false);
        let lanes = self.lanes.unwrap_or_else(Width::widest);
        let together = |cases: &&[Prepared]| {
            let mut tell = |result: &CaseResult| {
                if observer(result).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
            };
            let stop = || stopped.load(Ordering::Relaxed) || asked_to_stop();
            simulate_as_far(lanes, cases, &mut Audience { tell: &mut tell, stop: &stop })
        };
        let batches: Vec<&[Prepared]> = self.cases.chunks(BATCH).collect();
        pool::map(&batches, together, &|_| ()).concat()
    }
}

/// Runs cases on one core and gives what became of each, in their order; none when asked to stop.
///
/// Which cases stand together changes nothing about any of them.
pub fn simulate(cases: &[Prepared], audience: &mut Audience<'_>) -> Option<Vec<CaseResult>> {
    simulate_in(Width::widest(), cases, audience)
}

/// As [`simulate`], in lanes of a width; a machine that does not have it takes one case after the other.
pub fn simulate_in(
    width: Width,
    cases: &[Prepared],
    audience: &mut Audience<'_>,
) -> Option<Vec<CaseResult>> {
    simulate_as_far(width, cases, audience).into_iter().collect()
}

/// As [`simulate_in`]: none for each case that was not done when it was asked to stop.
fn simulate_as_far(
    width: Width,
    cases: &[Prepared],
    audience: &mut Audience<'_>,
) -> Vec<Option<CaseResult>> {
    let mut results: Vec<Option<CaseResult>> = vec![None; cases.len()];
    let mut stacks: Vec<Stack<'_>> = Vec::new();
    let mut runs: Vec<Result<Run<'_>, String>> = Vec::new();
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
            Ok(refused) => (audience.tell)(result.insert(refused)),
            Err(run) => ready.push(run),
        }
    }
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
    /// The stack, or in words why there is none.
    fn found(&self) -> Result<&Standing, String> {
        self.standing.as_ref().map_err(ToString::to_string)
    }

    /// What becomes of every case on a stack that is not there to be shaken: it collapses where it falls under its own
    /// weight, and has no verdict where it cannot be built or does not come to rest.
    fn refusal(&self) -> Option<CaseResult> {
        let failure = self.standing.as_ref().err()?;
        Some(
            self.fallen_at_rest(failure).unwrap_or_else(|| CaseResult::failed(failure.to_string())),
        )
    }

    fn fallen_at_rest(&self, failure: &RunFailure) -> Option<CaseResult> {
        let RunFailure::Settle(restless) = failure else { return None };
        let levels = self.scenario.stack().filter(|_| restless.falls())?.levels;
        // As it was built, before it fell.
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

/// A case on its stack.
#[derive(Clone, Copy)]
struct Run<'a> {
    case: &'a Prepared,
    /// Which of the cases it is.
    index: usize,
    /// Which of the stacks it has.
    stack: usize,
    /// When it ends (s).
    end_time: f64,
}

impl Run<'_> {
    /// What ends it before its time is over.
    fn end(&self, standing: &Standing) -> End {
        End::new(&self.case.scenario, &standing.assembly, &self.case.ground)
    }
}

/// Finds or builds the stack of a case, or says why it cannot.
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
        // The fault of this motion: under a shorter one the stack may be run.
        if let Err(failure @ RunFailure::Duration(_)) = &built.standing {
            return Err(failure.to_string());
        }
        stacks.push(built);
    }
    let step = stacks[stack].found()?.step;
    check_length(end_time, step).map_err(|failure| failure.to_string())?;
    Ok(Run { case, index, stack, end_time })
}

/// The runs that may run together, in the order of their cases.
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
