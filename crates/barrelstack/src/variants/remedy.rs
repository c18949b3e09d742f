//! What would have kept a stack up that falls: the smallest change among fewer levels and straps.
//!
//! A change suffices when enough of its variants stand in every plane, of at least as many as the verdict
//! has.
//! Nothing is guessed: one is dropped only when more have failed than may, so a few variants decide most of
//! them, and one that is said to suffice has run all.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

use barrelstack_fragility::wilson;
use barrelstack_report::described;

use super::spread::{LEVEL, collapsed, judged};
use super::{Answer, Plane, planes};
use crate::device::{Straps, Ties};
use crate::ensemble::{Audience, CaseResult, Prepared, simulate};
use crate::ground::{GroundError, from_disk};
use crate::pool;
use crate::run::CUT;
use crate::scenario::{Scenario, Scene, Setting, Source};

/// Share (%) of variants that must stand in every plane.
pub const ENOUGH: u32 = 95;

/// Pretensions (N) of straps that are tried; by hand a ratchet for webbing of 50 mm tightens to no more than
/// 5 kN, an assumption: some 500 daN stand on the labels of long-handled ratchets (their STF, EN 12195-2).
pub const PRETENSIONS: [f64; 5] = [1e3, 2e3, 3e3, 4e3, 5e3];

/// Variants of a change that are run first: those of one bundle of lanes.
const SCOUTS: u32 = 8;

/// Variants that a thread takes at once.
const BATCH: usize = 16;

described! {
    /// What would have kept the stack up, as far as it was looked for.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Remedy {
        /// Share of variants that has to stand in every plane.
        pub required_share: f64 as "1",
        /// As many levels as suffice; null where none of those tried does.
        pub height: Option<Tried>,
        /// The loosest straps that suffice; null where none of those tried does.
        pub straps: Option<Tried>,
        /// Every change that was tried, in this order.
        pub tried: Vec<Tried>,
        /// Whether all was tried; false where it was stopped.
        pub complete: bool,
        /// The command that sets what suffices beside the stack as it is; null where nothing does, or no command
        /// can say it.
        pub comparison: Option<String>,
    }

    /// One change of the stack.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Tried {
        /// What is changed.
        pub kind: &'static str ["height", "straps"],
        /// Levels of the stack.
        pub levels: u32,
        /// Pretension of the straps, which tie all levels; null for a change of height.
        pub pretension: Option<f64> as "N",
        /// The change as overrides of the scenario.
        pub changes: Vec<String>,
        /// Whether enough variants stand.
        pub suffices: bool,
        /// Variants that were run, in the plane in which most fail; no further ones were run once too many had
        /// failed.
        pub variants: u32,
        /// Those of them that collapse, or have no verdict.
        pub failed: u32,
        /// Wilson's interval of the share that fails, 95 %.
        pub interval: [f64; 2] as "1",
    }
}

/// Who hears from several threads how many runs of the change at hand are done, and may stop it.
type Observer<'a> = &'a (dyn Fn(usize) -> ControlFlow<()> + Sync);

/// Looks for the smallest change of height, and of straps, that would have kept a stack up which falls in more
/// variants than may fall.
///
/// An observer hears from several threads how many runs of the change at hand are done, and may stop it.
///
/// There is none to look for where the stack stands, has no variants, or its runs end before the motion.
///
/// # Errors
/// When a motion cannot be read.
pub fn remedy(
    answer: &Answer,
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Result<Option<Remedy>, GroundError> {
    let spreads = answer.decides.summary.spreads();
    let worst = spreads.iter().filter_map(|(_, spread)| spread.largest_share()).reduce(f64::max);
    if worst.is_none_or(enough) || answer.decides.run.interrupted {
        return Ok(None);
    }
    // Read once, not for every change.
    let scenario = &answer.scenario.with_records(&mut from_disk)?;
    let end = scenario.ground()?.end();
    if scenario.stack().is_none() || scenario.run.duration.is_some_and(|run| run + CUT < end) {
        return Ok(None);
    }
    let mut found = Remedy { required_share: f64::from(ENOUGH) / 100.0, ..Remedy::default() };
    let searched = search(scenario, observer, &mut found)?;
    found.complete = searched.is_continue();
    Ok(Some(found))
}

/// Whether few enough fall, by their share.
fn enough(share: f64) -> bool {
    100.0 * share <= f64::from(100 - ENOUGH)
}

fn search(
    scenario: &Scenario,
    observer: Observer<'_>,
    found: &mut Remedy,
) -> Result<ControlFlow<()>, GroundError> {
    let Some(stack) = scenario.stack() else { return Ok(ControlFlow::Continue(())) };
    for levels in (1..stack.levels).rev() {
        let Some(mut trial) = lower(scenario, levels).map(Trial::new).transpose()? else {
            continue;
        };
        let ran = trial.run(u32::MAX, observer);
        found.tried.push(trial.told());
        if ran.is_break() {
            return Ok(ran);
        }
        if trial.suffices() {
            found.height = Some(trial.told());
            break;
        }
    }
    let strapped: Vec<Change> =
        PRETENSIONS.iter().filter_map(|pretension| strapped(scenario, *pretension)).collect();
    let mut trials: Vec<Option<Trial>> = strapped.iter().map(|_| None).collect();
    let ran = loosest(&strapped, &mut trials, observer)?;
    found.tried.extend(trials.iter().flatten().map(Trial::told));
    found.straps = trials.iter().flatten().find(|trial| trial.suffices()).map(Trial::told);
    Ok(ran)
}

/// Tries straps from loose to tight until some suffice: from the loosest on whose first variants do not rule it
/// out, which is found by halving.
fn loosest(
    changes: &[Change],
    trials: &mut [Option<Trial>],
    observer: Observer<'_>,
) -> Result<ControlFlow<()>, GroundError> {
    let mut trial = |at: usize, until: u32| -> Result<(ControlFlow<()>, bool, bool), GroundError> {
        let trial = match &mut trials[at] {
            Some(trial) => trial,
            none => none.insert(Trial::new(changes[at].clone())?),
        };
        Ok((trial.run(until, observer), trial.failed(), trial.suffices()))
    };
    let (mut from, mut to) = (0, changes.len());
    while from < to {
        let middle = usize::midpoint(from, to);
        let (ran, failed, _) = trial(middle, SCOUTS)?;
        if ran.is_break() {
            return Ok(ran);
        }
        if failed { from = middle + 1 } else { to = middle }
    }
    for at in from..changes.len() {
        let (ran, _, suffices) = trial(at, u32::MAX)?;
        if ran.is_break() || suffices {
            return Ok(ran);
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// A change, and the scenario that it makes.
#[derive(Clone)]
struct Change {
    kind: &'static str,
    levels: u32,
    pretension: Option<f64>,
    changes: Vec<String>,
    scenario: Scenario,
}

/// The same with fewer levels, and straps on no more than those.
fn lower(scenario: &Scenario, levels: u32) -> Option<Change> {
    let mut scenario = scenario.clone();
    let Scene::Stack { stack, .. } = &mut scenario.scene else { return None };
    stack.levels = levels;
    stack.overrides.retain(|body| body.level <= levels);
    let mut changes = vec![format!("stack.levels={levels}")];
    let straps = &mut stack.devices.strap;
    if straps.levels > levels {
        straps.levels = levels;
        changes.push(format!("stack.strap.levels={levels}"));
    }
    if straps.levels == 1 && straps.ties == Ties::LevelsTogether {
        straps.ties = Ties::BarrelsToRacks;
        changes.push("stack.strap.ties=barrels-to-racks".to_owned());
    }
    Some(Change { kind: "height", levels, pretension: None, changes, scenario })
}

/// The same with all levels strapped together; none where its own straps are as tight, or would tear.
fn strapped(scenario: &Scenario, pretension: f64) -> Option<Change> {
    let mut scenario = scenario.clone();
    let Scene::Stack { stack, .. } = &mut scenario.scene else { return None };
    let levels = stack.levels;
    let straps = &mut stack.devices.strap;
    let ties = if levels == 1 { Ties::BarrelsToRacks } else { Ties::LevelsTogether };
    let whole = straps.levels == levels && straps.ties == ties;
    if (whole && straps.pretension >= pretension)
        || straps.strength.is_some_and(|most| most <= pretension)
    {
        return None;
    }
    *straps = Straps { levels, ties, slack: 0.0, pretension, ..*straps };
    let changes =
        vec![format!("stack.strap={{ {} }}", given(&scenario, "stack.strap.").join(", "))];
    Some(Change { kind: "straps", levels, pretension: Some(pretension), changes, scenario })
}

/// The fields of a table that are not as they would be by themselves.
fn given(scenario: &Scenario, table: &str) -> Vec<String> {
    let settings = scenario.settings();
    let own = settings.iter().filter(|one| one.source == Source::Given);
    let field = |one: &Setting| {
        let key = one.path.strip_prefix(table)?;
        let plain = one.value.parse::<f64>().is_ok();
        Some(if plain {
            format!("{key} = {}", one.value)
        } else {
            format!("{key} = \"{}\"", one.value)
        })
    };
    own.filter_map(field).collect()
}

/// A change that is being tried.
struct Trial {
    change: Change,
    planes: Vec<Plane>,
    /// The stack and its variants in every plane, ready to run.
    cases: Vec<Vec<Prepared>>,
    /// Variants of every plane that were run, and those that failed.
    counts: Vec<[AtomicU32; 2]>,
    /// Variants that are behind it.
    until: u32,
}

impl Trial {
    fn new(mut change: Change) -> Result<Self, GroundError> {
        // What follows a collapse says nothing about whether there is one.
        change.scenario.run.stop_after_collapse = Some(0.0);
        let planes = planes(&change.scenario)?;
        let cases = planes
            .iter()
            .map(|plane| plane.prepared(&plane.numbers()))
            .collect::<Result<_, _>>()?;
        let counts = planes.iter().map(|_| [AtomicU32::new(0), AtomicU32::new(0)]).collect();
        Ok(Self { change, planes, cases, counts, until: 0 })
    }

    /// Variants in a plane.
    fn count(&self) -> u32 {
        self.planes.iter().map(Plane::count).max().unwrap_or(0)
    }

    /// Whether so many failed in a plane that no others can make up for them.
    fn failed(&self) -> bool {
        self.counts
            .iter()
            .any(|[_, failed]| !may_fail(failed.load(Ordering::Relaxed), self.count()))
    }

    fn ran(&self) -> u32 {
        self.counts.iter().map(|[ran, _]| ran.load(Ordering::Relaxed)).min().unwrap_or(0)
    }

    fn suffices(&self) -> bool {
        self.count() > 0 && self.ran() == self.count() && !self.failed()
    }

    /// Runs variants until so many are behind it, or too many have failed.
    fn run(&mut self, until: u32, observer: Observer<'_>) -> ControlFlow<()> {
        let count = self.count();
        let order = order(count);
        let stages = [SCOUTS.min(count), count].map(|stage| stage.min(until.max(self.until)));
        for stage in stages {
            let numbers = order.get(self.until as usize..stage as usize).unwrap_or_default();
            if numbers.is_empty() || self.failed() {
                continue;
            }
            self.until = stage;
            self.stage(numbers, observer)?;
        }
        ControlFlow::Continue(())
    }

    fn stage(&self, numbers: &[u32], observer: Observer<'_>) -> ControlFlow<()> {
        let done = AtomicUsize::new(
            self.counts.iter().map(|[ran, _]| ran.load(Ordering::Relaxed) as usize).sum(),
        );
        let stopped = AtomicBool::new(false);
        let asked = || {
            if observer(done.load(Ordering::Relaxed)).is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
            stopped.load(Ordering::Relaxed) || self.failed()
        };
        let batches: Vec<(usize, &[u32])> = numbers
            .chunks(BATCH)
            .flat_map(|numbers| (0..self.planes.len()).map(move |plane| (plane, numbers)))
            .collect();
        let work = |(plane, numbers): &(usize, &[u32])| {
            if asked() {
                return;
            }
            let cases: Vec<Prepared> =
                numbers.iter().map(|number| self.cases[*plane][*number as usize].clone()).collect();
            let [ran, failed] = &self.counts[*plane];
            let mut tell = |result: &CaseResult| {
                if collapsed(result) || !judged(result) {
                    failed.fetch_add(1, Ordering::Relaxed);
                }
                ran.fetch_add(1, Ordering::Relaxed);
                done.fetch_add(1, Ordering::Relaxed);
            };
            // What was told counts, also of those that are then stopped.
            let _ = simulate(&cases, &mut Audience { tell: &mut tell, stop: &asked });
        };
        pool::map(&batches, work, &|_| ());
        if stopped.into_inner() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// What came of it, in the plane in which most failed.
    fn told(&self) -> Tried {
        let counts = self
            .counts
            .iter()
            .map(|counts| counts.each_ref().map(|one| one.load(Ordering::Relaxed)));
        let [variants, failed] =
            counts.max_by_key(|[ran, failed]| (*failed, *ran)).unwrap_or([0, 0]);
        let interval = wilson(failed, variants, LEVEL);
        let Change { kind, levels, pretension, changes, .. } = &self.change;
        Tried {
            kind,
            levels: *levels,
            pretension: *pretension,
            changes: changes.clone(),
            suffices: self.suffices(),
            variants,
            failed,
            interval: [interval.low, interval.high],
        }
    }
}

/// Whether so many of a number may fail.
fn may_fail(failed: u32, of: u32) -> bool {
    u64::from(failed) * 100 <= u64::from(of) * u64::from(100 - ENOUGH)
}

/// The numbers of all variants, some from everywhere first.
fn order(count: u32) -> Vec<u32> {
    let stride = count.div_ceil(SCOUTS).max(1);
    (0..stride).flat_map(|from| (1 + from..=count).step_by(stride as usize)).collect()
}
