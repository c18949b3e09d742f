//! Many cases at once: what became of each, and nothing else of it.
//!
//! Cases of one topology march side by side in the lanes of a vector register; a lane whose case has
//! ended takes the next one.
//! Every case comes to the same bits as it would alone, whatever runs beside it and however wide the
//! lanes are.

mod alone;
mod case;
mod crew;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use barrelstack_dynamics::Method;
use barrelstack_dynamics::lanes::Topology;

use crate::pool;
use crate::run::{RunFailure, Standing, check_length, end_time, method, stand};
use crate::scenario::Scenario;
use crate::watch::End;

pub use barrelstack_dynamics::lanes::Width;
pub use case::{CaseResult, Prepared};

/// Version of what an ensemble computes: raised whenever the same case may give other bits, so that
/// results of two versions are never put together.
pub const VERSION: u32 = 9;

/// Fewer cases than this of one topology go one after the other: a bundle costs as much as some three
/// single runs, however few of its lanes are used.
const FEWEST: usize = 3;

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
/// use barrelstack::ensemble::{Ensemble, Prepared};
/// use barrelstack::Scenario;
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
    /// The vector unit in which they march; the widest of the machine without. Results do not depend on it.
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
        let stopped = AtomicBool::new(false);
        let lanes = self.lanes.unwrap_or_else(Width::widest);
        let together = |cases: &&[Prepared]| {
            let mut tell = |result: &CaseResult| {
                if observer(result).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
            };
            let stop = || stopped.load(Ordering::Relaxed);
            simulate_in(lanes, cases, &mut Audience { tell: &mut tell, stop: &stop })
        };
        let batches: Vec<&[Prepared]> = self.cases.chunks(BATCH).collect();
        let done: Option<Vec<_>> = pool::map(&batches, together, &|_| ()).into_iter().collect();
        done.map(|results| results.concat())
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
    let mut results: Vec<Option<CaseResult>> = vec![None; cases.len()];
    let mut stacks: Vec<Stack> = Vec::new();
    let mut runs: Vec<Run<'_>> = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        if (audience.stop)() {
            return None;
        }
        match prepare(case, index, &mut stacks) {
            Ok(run) => runs.push(run),
            Err(reason) => {
                let result = CaseResult::failed(reason);
                (audience.tell)(&result);
                results[index] = Some(result);
            }
        }
    }
    for (method, group) in groups(&runs, &stacks) {
        let done = if method.is_adaptive() {
            alone::run(&group, &stacks, audience)
        } else {
            let width = if group.len() < FEWEST { Width::Scalar } else { width };
            crew::run(width, method, &group, &stacks, audience)
        }?;
        for (index, result) in done {
            results[index] = Some(result);
        }
    }
    results.into_iter().collect()
}

/// A stack at rest, shared by the cases that differ in their motion alone.
struct Stack {
    scenario: Arc<Scenario>,
    standing: Result<(Standing, Topology), String>,
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

/// Finds or builds the stack of a case and lets it come to rest; or says why it cannot.
fn prepare<'a>(
    case: &'a Prepared,
    index: usize,
    stacks: &mut Vec<Stack>,
) -> Result<Run<'a>, String> {
    let scenario = &case.scenario;
    let time_scale = scenario.run.similitude.sqrt();
    let end_time = end_time(scenario, &case.ground, time_scale).map_err(|e| e.to_string())?;
    let known = stacks.iter().rposition(|stack| Arc::ptr_eq(&stack.scenario, scenario));
    let stack = if let Some(stack) = known {
        stack
    } else {
        let standing = match stand(scenario, end_time) {
            // The fault of this motion: under a shorter one the stack may be run.
            Err(failure @ RunFailure::Duration(_)) => return Err(failure.to_string()),
            Err(failure) => Err(failure.to_string()),
            Ok(standing) => {
                let topology = Topology::of(&standing.assembly.model);
                Ok((standing, topology))
            }
        };
        stacks.push(Stack { scenario: Arc::clone(scenario), standing });
        stacks.len() - 1
    };
    let (standing, _) = stacks[stack].standing.as_ref().map_err(Clone::clone)?;
    check_length(end_time, standing.step).map_err(|failure| failure.to_string())?;
    Ok(Run { case, index, stack, end_time })
}

/// The runs that may march together, in the order of their cases.
fn groups<'a>(runs: &[Run<'a>], stacks: &[Stack]) -> Vec<(Method, Vec<Run<'a>>)> {
    let mut groups: Vec<(Method, &Topology, Vec<Run<'a>>)> = Vec::new();
    for run in runs {
        let Ok((_, topology)) = &stacks[run.stack].standing else { continue };
        let method = method(&run.case.scenario);
        match groups.iter_mut().find(|(m, t, _)| *m == method && *t == topology) {
            Some((_, _, group)) => group.push(*run),
            None => groups.push((method, topology, vec![*run])),
        }
    }
    groups.into_iter().map(|(method, _, group)| (method, group)).collect()
}
