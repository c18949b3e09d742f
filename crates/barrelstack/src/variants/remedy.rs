//! Remedies for a stack that falls: the smallest reduction of height, and the loosest straps, that
//! suffice.
//!
//! A change suffices if enough variants of the changed stack stand in every plane. The variants of the changed stack
//! have the same numbers as the variants of the original stack. The module `search` defines the order and the
//! statistics of the search; this module runs the search.

mod search;

use std::fmt;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use barrelstack_dynamics::lanes::LANES;
use barrelstack_fragility::{interval_of, share_less};
use barrelstack_report::described;

use self::search::{Counts, Plan};
use super::advice::name_of;
use super::spread::loss;
use super::{Answer, LEVEL, Plane, Spread, decides, planes, verdict};
use crate::device::{Straps, Ties};
use crate::ensemble::{Audience, CaseResult, Prepared, simulate};
use crate::ground::{GroundError, from_disk};
use crate::pool;
use crate::run::CUT;
use crate::scenario::{Scenario, Scene, Setting, Source};

pub use self::search::{ENOUGH, Judged, Verdicts};

/// Strap pretensions (N) that the search can try.
///
/// A manual ratchet for 50 mm webbing is assumed to reach at most 5 kN: labels of long-handled
/// ratchets state about 500 daN (STF, standard tension force, EN 12195-2).
pub const PRETENSIONS: [f64; 5] = [1e3, 2e3, 3e3, 4e3, 5e3];

described! {
    /// Changes that were tried on a stack that collapses, and the changes with which the stack stands.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Remedy {
        /// Share of variants that must stand in every plane.
        pub required_share: f64 as "1",
        /// The largest number of levels that suffices; null if none of the numbers that were tried suffices.
        pub height: Option<Tried>,
        /// The loosest straps that suffice; null if none of the pretensions that were tried suffices.
        pub straps: Option<Tried>,
        /// Share of the random draws of the uncertain constants in which the lower stack (field `height`) fails less
        /// often than the strapped stack (field `straps`). A draw in which both stacks fail equally often counts as one
        /// half. Null if `height` or `straps` is null, or if the `range` of one of them is null.
        pub height_before_straps: Option<f64> as "1",
        /// Number of changes that the search may try. A change counts once, even if it is tried in two planes. The
        /// intervals of all these changes in all planes hold simultaneously with 95 % confidence.
        pub candidates: u32,
        /// Number of variants that are run with a change, unless the change is rejected earlier.
        pub variants: u32,
        /// Every change that was tried; changes of height come first.
        pub tried: Vec<Tried>,
        /// True if the search is complete; false if the search was stopped.
        pub complete: bool,
        /// Command that compares the stack as it is with the sufficient changes; null if no change
        /// suffices, or if no command can express the changes.
        pub comparison: Option<String>,
    }

    /// A change that was tried on the stack.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Tried {
        /// Kind of the change.
        pub kind: &'static str ["height", "straps"],
        /// Number of levels of the changed stack.
        pub levels: u32,
        /// Pretension of the straps, which tie all levels together; null for a change of height.
        pub pretension: Option<f64> as "N",
        /// The change as overrides of the scenario.
        pub changes: Vec<String>,
        /// True if enough variants stand with the change; false if too many variants fail. Null if the variants that
        /// were run do not decide this. The other variants are not run if straps with a smaller pretension suffice, or
        /// if the search is stopped.
        pub suffices: Option<bool>,
        /// Number of variants counted. Not all variants are counted if the change was rejected early, or if `suffices`
        /// is null. Variants that are likely to fall are run first.
        pub variants: u32,
        /// Number of counted variants that collapse or have no verdict, in the plane with the
        /// largest such number.
        pub failed: u32,
        /// Share of variants that fail; null if not all variants were counted.
        pub share: Option<f64> as "1",
        /// Interval of the share of variants that fail (Clopper and Pearson, with Bonferroni's
        /// correction); the intervals of all changes and planes of the search hold simultaneously
        /// with 95 % confidence. Null if the share is null.
        pub interval: Option<[f64; 2]> as "1",
        /// Range of the share of stacks that fail, in the plane in which more stacks fail: it contains 95 % of the
        /// shares if the uncertain constants of the seats are drawn from their distributions, sampling error included.
        /// Null if `share` is null, if there are fewer than 16 variants, if one of them has no verdict, or if they
        /// differ only in positions and masses.
        pub range: Option<[f64; 2]> as "1",
        /// Share of the draws of the uncertain constants in which fewer stacks fail with the change than without it; a
        /// draw with equal shares counts as one half. The same draws are used for all changes. Null if `range` is null,
        /// or if the unchanged stack has no such range.
        pub better_than_as_it_is: Option<f64> as "1",
    }
}

impl Tried {
    /// Returns `true` if the change is known to suffice.
    pub fn is_enough(&self) -> bool {
        self.suffices == Some(true)
    }

    /// Returns `true` if the change is known not to suffice.
    pub fn is_rejected(&self) -> bool {
        self.suffices == Some(false)
    }
}

/// Progress of a search: the change that is being tried, and how far the search is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt<'a> {
    /// Name of the changed stack, such as "a stack of three levels".
    pub stack: &'a str,
    /// Number of the change, in the order in which changes are first tried; the first is 1.
    pub number: usize,
    /// Number of changes that may be tried; the search ends earlier if it has found sufficient changes.
    pub candidates: usize,
    /// Number of finished runs of the changed stack.
    pub done: usize,
    /// Number of runs if all variants of the changed stack are run; fewer are run if the change is rejected early.
    pub of: usize,
    /// Noun for the runs: "variants" or, if every variant is run in several planes, "runs".
    pub things: &'static str,
}

impl Attempt<'_> {
    /// Describes what is counted, such as "variants of a stack of one level (change 3 of up to 9)".
    pub fn counted(&self) -> String {
        format!("{} of {} {}", self.things, self.stack, self.place())
    }

    /// Returns the place of the change in the search, such as "(change 3 of up to 9)".
    fn place(&self) -> String {
        format!("(change {} of up to {})", self.number, self.candidates)
    }
}

/// Describes the progress, such as "testing a stack of one level: 5 of 16 variants (change 3 of up to 9)".
impl fmt::Display for Attempt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stack, done, of, things, .. } = self;
        write!(f, "testing {stack}: {done} of {of} {things} {}", self.place())
    }
}

/// Progress callback: receives the progress of the search, from several threads; may cancel.
pub type Observer<'a> = &'a (dyn Fn(Attempt<'_>) -> ControlFlow<()> + Sync);

/// Progress callback of one change: receives the number of its finished runs, from several threads; may cancel.
pub type RunCounter<'a> = &'a (dyn Fn(usize) -> ControlFlow<()> + Sync);

/// Variants of a changed stack, prepared to be run in blocks.
pub trait Trial: Send {
    /// Runs the variants whose indices are in `block`, in every plane; index 0 is the variant with the number 1.
    ///
    /// Returns the verdicts in each plane, in the order of the block, or `Break` if the observer cancels. The observer
    /// receives the number of finished runs of all blocks so far.
    fn run(&mut self, block: &[u32], observer: RunCounter<'_>) -> Judged;
}

/// Function that prepares the variants of a changed stack.
type Prepare<'a> = dyn Fn(&Scenario) -> Result<Box<dyn Trial>, GroundError> + Sync + 'a;

/// Searches for the largest number of levels, and for the loosest straps, with which at least
/// [`ENOUGH`] percent of the variants of a stack stand in every plane.
///
/// `observer` receives the progress of the search, from several threads, and may cancel. Returns `None` if the stack
/// stands, has no variants, or is run for less than the whole motion.
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
    let of = |plane: &Plane| {
        let shown = answer.shown().find(|shown| shown.run.assembly.view == plane.view())?;
        Some(shown.variants.as_ref()?.results.get(1..)?.iter().collect())
    };
    let results = planes(&answer.scenario)?.iter().map_while(of).collect();
    let as_it_is = AsItIs { spreads: spreads.iter().map(|(_, spread)| *spread).collect(), results };
    remedy_by(&answer.scenario, &as_it_is, (&prepare, LANES), observer)
}

/// Statistics and results of the stack without changes.
#[derive(Clone, Debug)]
pub struct AsItIs<'a> {
    /// Statistics of the variants in each plane.
    pub spreads: Vec<&'a Spread>,
    /// Results of the variants in each plane, in the order of their numbers.
    pub results: Vec<Vec<&'a CaseResult>>,
}

impl AsItIs<'_> {
    fn verdicts(&self) -> Verdicts {
        self.results.iter().map(|all| all.iter().map(|one| verdict(one)).collect()).collect()
    }

    /// Returns the indices of the given number of variants, in the order of their first loss of a seat in any plane,
    /// the earliest first.
    fn order(&self, variants: usize) -> Vec<u32> {
        let lost = |variant: &u32| {
            let results = self.results.iter().filter_map(|all| all.get(*variant as usize));
            results.filter_map(|one| loss(one)).fold(f64::INFINITY, f64::min)
        };
        let mut order: Vec<u32> = (0..u32::try_from(variants).unwrap_or(u32::MAX)).collect();
        order.sort_by(|one, other| lost(one).total_cmp(&lost(other)));
        order
    }
}

/// Searches for a remedy like [`remedy`], with runs prepared by `prepare`. The first block of a change has `first`
/// variants, or more if so few variants cannot reject a change.
///
/// # Errors
/// As [`remedy`].
pub fn remedy_by(
    scenario: &Scenario,
    as_it_is: &AsItIs<'_>,
    (prepare, first): (&Prepare<'_>, usize),
    observer: Observer<'_>,
) -> Result<Option<Remedy>, GroundError> {
    let spreads = as_it_is.spreads.iter().copied();
    if spreads.filter_map(Spread::largest_share).reduce(f64::max).is_none_or(enough) {
        return Ok(None);
    }
    // The records are read once rather than for every change.
    let scenario = &scenario.with_records(&mut from_disk)?;
    let end = scenario.ground()?.end();
    if scenario.stack().is_none() || scenario.run.duration.is_some_and(|run| run + CUT < end) {
        return Ok(None);
    }
    let mut found = Remedy { required_share: f64::from(ENOUGH) / 100.0, ..Remedy::default() };
    look(scenario, as_it_is, (prepare, first, observer), &mut found)?;
    Ok(Some(found))
}

/// `true` if the share of variants that fail is at most `100 − ENOUGH` percent.
fn enough(share: f64) -> bool {
    100.0 * share <= f64::from(100 - ENOUGH)
}

/// Tries all changes of a scenario, and stores the results in `found`.
fn look(
    scenario: &Scenario,
    as_it_is: &AsItIs<'_>,
    (prepare, first, observer): (&Prepare<'_>, usize, Observer<'_>),
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
        order: as_it_is.order(planes.iter().map(Plane::count).max().unwrap_or(0) as usize),
        first: u32::try_from(first).unwrap_or(u32::MAX),
        planes: planes.len(),
    };
    let started: Vec<Mutex<Option<Started>>> = changes.iter().map(|_| Mutex::new(None)).collect();
    let count = AtomicUsize::new(0);
    let run = |change: usize, block: &[u32]| {
        // A trial is used by one thread at a time; a poisoned lock is that of a thread that has panicked.
        let Ok(mut started) = started[change].lock() else { return Ok(ControlFlow::Break(())) };
        let Started { trial, number, stack } = match &mut *started {
            Some(started) => started,
            none => {
                let number = count.fetch_add(1, Ordering::Relaxed) + 1;
                none.insert(changes[change].start(prepare, number)?)
            }
        };
        let attempt = Attempt { stack, number: *number, ..plan.attempt() };
        Ok(trial.run(block, &|done| observer(Attempt { done, ..attempt })))
    };
    let search::Found { counts, complete } = search::search::<GroundError>(&plan, &run)?;
    let mut tried: Vec<Option<Tried>> = changes
        .iter()
        .zip(&counts)
        .map(|(change, counts)| Some(change.summarize(counts.as_ref()?, &plan)))
        .collect();
    let draws: Vec<Option<Vec<f64>>> = counts
        .iter()
        .map(|counts| counts.as_ref().and_then(|counts| counts.verdicts(&plan)))
        .map(|verdicts| decides::draws(&planes, &verdicts?))
        .collect();
    let before = decides::draws(&planes, &as_it_is.verdicts());
    for (tried, draws) in tried.iter_mut().zip(&draws) {
        let Some((tried, draws)) = tried.as_mut().zip(draws.as_ref()) else { continue };
        tried.range = Some(range(draws));
        tried.better_than_as_it_is = before.as_ref().map(|before| share_less(draws, before));
    }
    let suffices = |of: Range<usize>| {
        of.into_iter().find(|at| tried[*at].as_ref().is_some_and(Tried::is_enough))
    };
    let both = suffices(0..heights).zip(suffices(heights..tried.len()));
    let both = both.and_then(|(height, straps)| draws[height].as_ref().zip(draws[straps].as_ref()));
    found.height_before_straps = both.map(|(height, straps)| share_less(height, straps));
    let (lower, strapped) = tried.split_at(heights);
    let first = |of: &[Option<Tried>]| of.iter().flatten().find(|tried| tried.is_enough()).cloned();
    (found.height, found.straps) = (first(lower), first(strapped));
    found.tried = tried.into_iter().flatten().collect();
    found.candidates = u32::try_from(plan.changes()).unwrap_or(u32::MAX);
    found.variants = plan.variants();
    found.complete = complete;
    Ok(())
}

/// Returns the range that contains 95 % of the draws of a share, rounded outward to hundredths.
fn range(draws: &[f64]) -> [f64; 2] {
    let found = interval_of(draws, LEVEL);
    [(100.0 * found.low).floor() / 100.0, (100.0 * found.high).ceil() / 100.0]
}

/// A change whose trial has started.
struct Started {
    trial: Box<dyn Trial>,
    /// Number of the change, in the order in which changes are first tried.
    number: usize,
    /// Name of the changed stack.
    stack: String,
}

/// A change of the stack, with the changed scenario.
struct Change {
    kind: &'static str,
    levels: u32,
    pretension: Option<f64>,
    changes: Vec<String>,
    scenario: Scenario,
}

/// Returns the change to fewer levels; straps on levels that no longer exist are removed. `None` for
/// a scene without a stack.
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

/// Returns the change that straps all levels together at a pretension (N).
///
/// Returns `None` for a scene without a stack, if the stack already has straps that are at least as tight, or if the
/// straps would tear.
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

/// Returns the overrides of scenario fields, such as `stack.levels=2`, that lower a stack to the given number of levels
/// and remove straps on levels that no longer exist. `None` for a scene without a stack.
pub fn lowered(scenario: &Scenario, levels: u32) -> Option<Vec<String>> {
    Some(lower(scenario, levels)?.changes)
}

/// Returns the overrides of scenario fields that strap all levels of a stack together at a pretension (N).
///
/// Returns `None` for a scene without a stack, if the stack already has straps that are at least as tight, or if the
/// straps would tear.
pub fn strapped_together(scenario: &Scenario, pretension: f64) -> Option<Vec<String>> {
    Some(strapped(scenario, pretension)?.changes)
}

/// Returns the fields of a table that have the source [`Source::Given`], each as a TOML assignment `key = value`.
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
    /// Prepares the variants of the changed stack. `number` is the number of the change, in the order in which changes
    /// are first tried.
    fn start(&self, prepare: &Prepare<'_>, number: usize) -> Result<Started, GroundError> {
        let mut scenario = self.scenario.clone();
        // The motion after a collapse does not matter here.
        scenario.run.stop_after_collapse = Some(0.0);
        let stack = format!("a stack of {}", name_of(self.levels, self.pretension));
        Ok(Started { trial: prepare(&scenario)?, number, stack })
    }

    /// Summarizes the counts of the change.
    fn summarize(&self, counts: &Counts, plan: &Plan) -> Tried {
        let Self { kind, levels, pretension, changes, .. } = self;
        let whole = counts.whole(plan);
        Tried {
            kind,
            levels: *levels,
            pretension: *pretension,
            changes: changes.clone(),
            suffices: counts.verdict(plan),
            variants: counts.ran,
            failed: counts.failed,
            share: whole.then(|| f64::from(counts.failed) / f64::from(counts.ran)),
            interval: counts.interval(plan).map(|interval| [interval.low, interval.high]),
            range: None,
            better_than_as_it_is: None,
        }
    }
}

/// The variants of a stack in every plane, to be run on all cores.
struct InPlanes {
    /// For each plane, the nominal case, followed by its variants.
    cases: Vec<Vec<Prepared>>,
    /// Number of finished runs.
    done: AtomicUsize,
}

impl InPlanes {
    fn new(scenario: &Scenario) -> Result<Self, GroundError> {
        let planes = planes(scenario)?;
        let mut cases = planes
            .iter()
            .map(|plane| plane.prepared(&plane.numbers()))
            .collect::<Result<Vec<_>, _>>()?;
        // Only the verdicts are used.
        for case in cases.iter_mut().flatten() {
            case.records_stresses = false;
        }
        Ok(Self { cases, done: AtomicUsize::new(0) })
    }
}

impl Trial for InPlanes {
    fn run(&mut self, block: &[u32], observer: RunCounter<'_>) -> Judged {
        let stopped = AtomicBool::new(false);
        let canceled = || {
            if observer(self.done.load(Ordering::Relaxed)).is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
            stopped.load(Ordering::Relaxed)
        };
        let batches: Vec<(usize, Vec<Prepared>)> = self
            .cases
            .iter()
            .enumerate()
            .flat_map(|(plane, cases)| {
                let case = |variant: &u32| cases.get(*variant as usize + 1).cloned();
                let batch = move |batch: &[u32]| (plane, batch.iter().filter_map(case).collect());
                block.chunks(LANES).map(batch)
            })
            .collect();
        let work = |(_, cases): &(usize, Vec<Prepared>)| {
            let mut on_case = |_: &CaseResult| {
                self.done.fetch_add(1, Ordering::Relaxed);
            };
            let results = simulate(cases, &mut Audience { on_case: &mut on_case, stop: &canceled });
            results.iter().flatten().map(verdict).collect::<Vec<_>>()
        };
        let found = pool::map(&batches, work, &|_| ());
        // If the run was canceled, no variant of the block counts.
        if stopped.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        let mut verdicts = vec![Vec::new(); self.cases.len()];
        for ((plane, _), more) in batches.iter().zip(found) {
            verdicts[*plane].extend(more);
        }
        ControlFlow::Continue(verdicts)
    }
}
