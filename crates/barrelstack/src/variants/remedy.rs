//! Remedy of a stack that falls: the smallest sufficient change among fewer levels and straps.
//!
//! A change suffices when enough of its variants stand in every plane, of as many as the verdict has; these are the
//! same variants by their numbers.
//! The order and the statistics of the search are in `remedy/search.rs`; this module runs it.

mod search;

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

use barrelstack_report::described;

use self::search::{Counts, Plan};
use super::{Answer, Plane, Spread, fails, planes};
use crate::device::{Straps, Ties};
use crate::ensemble::{Audience, CaseResult, Prepared, simulate};
use crate::ground::{GroundError, from_disk};
use crate::pool;
use crate::run::CUT;
use crate::scenario::{Scenario, Scene, Setting, Source};

pub use self::search::{ENOUGH, Failed};

/// Pretensions (N) of straps that are tried; a manual ratchet for webbing of 50 mm reaches no more than 5 kN,
/// an assumption: labels of long-handled ratchets state about 500 daN (their STF, EN 12195-2).
pub const PRETENSIONS: [f64; 5] = [1e3, 2e3, 3e3, 4e3, 5e3];

/// Variants that a thread takes at once: those of one bundle of lanes.
const BATCH: usize = 8;

described! {
    /// Changes that would have kept the stack up, as far as they were searched.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Remedy {
        /// Share of variants that has to stand in every plane.
        pub required_share: f64 as "1",
        /// As many levels as suffice; null where none of those tried does.
        pub height: Option<Tried>,
        /// The loosest straps that suffice; null where none of those tried does.
        pub straps: Option<Tried>,
        /// Changes that may have been tried, each in every plane: intervals hold for all of them together.
        pub candidates: u32,
        /// Every change that was tried, changes of height first.
        pub tried: Vec<Tried>,
        /// True if all changes were tried; false if the search was stopped.
        pub complete: bool,
        /// The command that sets what suffices beside the stack as it is; null where nothing does, or no command
        /// can say it.
        pub comparison: Option<String>,
    }

    /// One change of the stack.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Tried {
        /// Kind of the change.
        pub kind: &'static str ["height", "straps"],
        /// Levels of the stack.
        pub levels: u32,
        /// Pretension of the straps, which tie all levels; null for a change of height.
        pub pretension: Option<f64> as "N",
        /// The change as overrides of the scenario.
        pub changes: Vec<String>,
        /// True if enough variants stand.
        pub suffices: bool,
        /// Variants that were counted: all of them, or the first so many by their numbers where these have rejected it.
        pub variants: u32,
        /// Number of them that collapse, or have no verdict, in the plane in which most do.
        pub failed: u32,
        /// The share that fails; null where the change was rejected, or the search stopped, before all variants were
        /// counted.
        pub share: Option<f64> as "1",
        /// Interval of that share which holds for all changes and planes of the search together with 95 % (Clopper and
        /// Pearson, Bonferroni); null as the share.
        pub interval: Option<[f64; 2]> as "1",
    }
}

/// Progress callback: called from several threads with the count of finished runs of the change at hand; may cancel.
pub type Observer<'a> = &'a (dyn Fn(usize) -> ControlFlow<()> + Sync);

/// The variants of a changed stack, ready to run for their verdicts.
pub trait Trial {
    /// Runs a block of variants, counted from zero, in every plane: returns the number that fails in each, or breaks
    /// when the observer cancels.
    fn run(&mut self, block: Range<u32>, observer: Observer<'_>) -> Failed;
}

/// Prepares the variants of a changed stack.
type Prepare<'a> = dyn Fn(&Scenario) -> Result<Box<dyn Trial>, GroundError> + 'a;

/// Searches the smallest change of height, and of straps, that brings the failure rate of a stack below the limit.
///
/// `observer` is called from several threads with the count of finished runs of the change at hand, and may cancel.
///
/// `None` where the stack stands, has no variants, or its runs end before the motion.
///
/// # Errors
/// When a motion cannot be read.
pub fn remedy(answer: &Answer, observer: Observer<'_>) -> Result<Option<Remedy>, GroundError> {
    if answer.is_stopped() {
        return Ok(None);
    }
    let spreads = answer.decides.summary.spreads();
    let prepare = |scenario: &Scenario| -> Result<Box<dyn Trial>, GroundError> {
        Ok(Box::new(InPlanes::new(scenario)?))
    };
    remedy_by(&answer.scenario, spreads.iter().map(|(_, spread)| *spread), &prepare, observer)
}

/// Searches a remedy as [`remedy`], with variants that are run elsewhere; `spreads` are those of the stack as it is.
///
/// # Errors
/// As [`remedy`].
pub fn remedy_by<'a>(
    scenario: &Scenario,
    spreads: impl Iterator<Item = &'a Spread>,
    prepare: &Prepare<'_>,
    observer: Observer<'_>,
) -> Result<Option<Remedy>, GroundError> {
    if spreads.filter_map(Spread::largest_share).reduce(f64::max).is_none_or(enough) {
        return Ok(None);
    }
    // Read once, not for every change.
    let scenario = &scenario.with_records(&mut from_disk)?;
    let end = scenario.ground()?.end();
    if scenario.stack().is_none() || scenario.run.duration.is_some_and(|run| run + CUT < end) {
        return Ok(None);
    }
    let mut found = Remedy { required_share: f64::from(ENOUGH) / 100.0, ..Remedy::default() };
    look(scenario, prepare, observer, &mut found)?;
    Ok(Some(found))
}

/// `true` if the share that fails is low enough.
fn enough(share: f64) -> bool {
    100.0 * share <= f64::from(100 - ENOUGH)
}

/// Tries the changes of a scenario.
fn look(
    scenario: &Scenario,
    prepare: &Prepare<'_>,
    observer: Observer<'_>,
    found: &mut Remedy,
) -> Result<(), GroundError> {
    let Some(stack) = scenario.stack() else { return Ok(()) };
    let mut changes: Vec<Change> =
        (1..stack.levels).rev().filter_map(|levels| lower(scenario, levels)).collect();
    let heights = changes.len();
    changes.extend(PRETENSIONS.iter().filter_map(|pretension| strapped(scenario, *pretension)));
    let planes = planes(scenario)?;
    let plan = Plan {
        heights,
        straps: changes.len() - heights,
        variants: planes.iter().map(Plane::count).max().unwrap_or(0),
        planes: planes.len(),
    };
    let mut trials: Vec<Option<Box<dyn Trial>>> = changes.iter().map(|_| None).collect();
    let mut run = |change: usize, block: Range<u32>| {
        let trial = match &mut trials[change] {
            Some(trial) => trial,
            none => {
                let mut scenario = changes[change].scenario.clone();
                // The course after a collapse does not matter here.
                scenario.run.stop_after_collapse = Some(0.0);
                none.insert(prepare(&scenario)?)
            }
        };
        Ok(trial.run(block, observer))
    };
    let search::Found { counts, complete } = search::search::<GroundError>(&plan, &mut run)?;
    let tried: Vec<Option<Tried>> = changes
        .iter()
        .zip(&counts)
        .map(|(change, counts)| Some(change.summarize(counts.as_ref()?, &plan)))
        .collect();
    let (lower, strapped) = tried.split_at(heights);
    let first = |of: &[Option<Tried>]| of.iter().flatten().find(|tried| tried.suffices).cloned();
    (found.height, found.straps) = (first(lower), first(strapped));
    found.tried = tried.into_iter().flatten().collect();
    found.candidates = u32::try_from(plan.changes()).unwrap_or(u32::MAX);
    found.complete = complete;
    Ok(())
}

/// A change, with its scenario.
struct Change {
    kind: &'static str,
    levels: u32,
    pretension: Option<f64>,
    changes: Vec<String>,
    scenario: Scenario,
}

/// Returns the scenario with fewer levels, and straps on no more than those.
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

/// Returns the scenario with all levels strapped together; `None` if its own straps are as tight, or would tear.
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

/// Returns the fields of a table that differ from their defaults.
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

impl Change {
    /// Summarizes its counts.
    fn summarize(&self, counts: &Counts, plan: &Plan) -> Tried {
        let Self { kind, levels, pretension, changes, .. } = self;
        let whole = counts.whole(plan);
        Tried {
            kind,
            levels: *levels,
            pretension: *pretension,
            changes: changes.clone(),
            suffices: counts.suffices(plan),
            variants: counts.ran,
            failed: counts.failed,
            share: whole.then(|| f64::from(counts.failed) / f64::from(counts.ran)),
            interval: counts.interval(plan).map(|interval| [interval.low, interval.high]),
        }
    }
}

/// Variants in planes, which run side by side.
struct InPlanes {
    /// The stack and its variants in every plane; the nominal case comes first.
    cases: Vec<Vec<Prepared>>,
    /// Number of finished runs.
    done: AtomicUsize,
}

impl InPlanes {
    fn new(scenario: &Scenario) -> Result<Self, GroundError> {
        let planes = planes(scenario)?;
        let cases = planes
            .iter()
            .map(|plane| plane.prepared(&plane.numbers()))
            .collect::<Result<_, _>>()?;
        Ok(Self { cases, done: AtomicUsize::new(0) })
    }
}

impl Trial for InPlanes {
    fn run(&mut self, block: Range<u32>, observer: Observer<'_>) -> Failed {
        let stopped = AtomicBool::new(false);
        let canceled = || {
            if observer(self.done.load(Ordering::Relaxed)).is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
            stopped.load(Ordering::Relaxed)
        };
        let failed: Vec<AtomicU32> = self.cases.iter().map(|_| AtomicU32::new(0)).collect();
        let places = block.start as usize + 1..block.end as usize + 1;
        let batches: Vec<(usize, &[Prepared])> = self
            .cases
            .iter()
            .enumerate()
            .flat_map(|(plane, cases)| {
                let block = cases.get(places.clone()).unwrap_or_default();
                block.chunks(BATCH).map(move |batch| (plane, batch))
            })
            .collect();
        let work = |(plane, cases): &(usize, &[Prepared])| {
            let mut on_case = |result: &CaseResult| {
                if fails(result) {
                    failed[*plane].fetch_add(1, Ordering::Relaxed);
                }
                self.done.fetch_add(1, Ordering::Relaxed);
            };
            // If it is canceled, no variant of the block counts.
            let _ = simulate(cases, &mut Audience { on_case: &mut on_case, stop: &canceled });
        };
        pool::map(&batches, work, &|_| ());
        if stopped.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(failed.into_iter().map(AtomicU32::into_inner).collect())
    }
}
