//! Rows of three-dimensional stacks: single runs, and many cases side by side.

use std::ops::ControlFlow;
use std::time::Instant;

use barrelstack::Scenario;
use barrelstack::outcome::Outcome;
use barrelstack::variants::{Plane, planes};
use barrelstack_space::variants::{Case, run_each};
use barrelstack_space::{Ground, run};

use crate::{Failure, time};

/// Changes to the demo after which its stack stands: four levels, and a motion scaled by one half.
const STANDING: [&str; 4] =
    ["stack.view=spatial", "stack.levels=4", "motion.scale.factor=0.5", "run.duration='10 s'"];

/// Number of cases of the stack that stands. If a register has eight lanes, each lane of two cores runs two cases.
pub(crate) const CASES: u32 = 32;

/// Measured time of some cases on all cores.
pub(crate) struct Many {
    /// Simulated time (s) of all cases.
    pub(crate) simulated: f64,
    /// Processor time (s) of all cores.
    pub(crate) spent: f64,
    /// Time (s) by the clock.
    pub(crate) clock: f64,
    /// Number of cases in which the stack collapses.
    pub(crate) collapsed: usize,
}

/// Returns the scenario of a stack of eight barrels that stands.
pub(crate) fn standing() -> Result<Scenario, Failure> {
    scenario(&STANDING)
}

fn scenario(changes: &[&str]) -> Result<Scenario, Failure> {
    let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
    Ok(Scenario::builtin("demo-napa", &changes)?)
}

/// Returns the ratio of the simulated time to the processor time of one run of the stack that stands,
/// with all recordings.
pub(crate) fn single() -> Result<f64, Failure> {
    let scenario = standing()?;
    let found = run::run(&scenario)?;
    if found.outcome != Outcome::Stable {
        return Err("the three-dimensional stack that should stand collapses".into());
    }
    Ok(found.end_time / time::least_of(3, || drop(run::run(&scenario))))
}

/// Runs variants of the stack that stands on all cores, in lanes.
pub(crate) fn lanes() -> Result<Many, Failure> {
    many(&standing()?, CASES)
}

/// Builds and settles the same variants as [`lanes`], and runs each for only 1 ms.
pub(crate) fn settling() -> Result<Many, Failure> {
    let [view, levels, scale, _] = STANDING;
    many(&scenario(&[view, levels, scale, "run.duration='1 ms'"])?, CASES)
}

/// Runs three-dimensional variants of the demo on all cores, each only until its verdict is known.
pub(crate) fn demo(cases: u32) -> Result<Many, Failure> {
    many(&scenario(&["stack.view=spatial"])?, cases)
}

fn many(scenario: &Scenario, cases: u32) -> Result<Many, Failure> {
    let plane: Plane = planes(scenario)?.into_iter().next().ok_or("a scenario has a plane")?;
    let ground = Ground::of(&plane.scenario)?;
    let numbers: Vec<u32> = (1..=cases).collect();
    let build = |number: &u32| (plane.trial(*number), ground.clone());
    let (before, start) = (time::of_process(), Instant::now());
    let found = run_each(&numbers, &build, &|_| ControlFlow::Continue(()));
    let clock = start.elapsed().as_secs_f64();
    let spent = time::of_process().zip(before).map_or(clock, |(now, before)| now - before);
    let collapsed = |case: &&Case| matches!(case.result.outcome, Ok(Outcome::Collapse { .. }));
    Ok(Many {
        simulated: found.iter().filter_map(|case| case.result.end_time).sum(),
        spent,
        clock,
        collapsed: found.iter().filter(collapsed).count(),
    })
}
