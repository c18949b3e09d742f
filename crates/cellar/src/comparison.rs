//! Layouts of cellars side by side: their losses and capacities, and what changes from one layout to another, variant
//! by variant.

mod page;
mod usual;
pub mod words;

use std::collections::{BTreeMap, BTreeSet};

use barrelstack::breakage::cost;
use barrelstack::compare::{self, CompareError, Difference, differing};
use barrelstack::variants::{LEVEL, Range};
use barrelstack_fragility::{grouped_mean, mean_difference};
use barrelstack_report::{FloorPlan, described};

use crate::answer::Answer;
use crate::report::picture;
use crate::sample::Case;
use crate::scenario::Cellar;
use crate::summary::{AisleAnswer, CellarSummary, Count, barrels, counted, fallen};
use crate::words::missing;

pub use page::{csv, document, files, table};
pub use usual::{Usual, usual};

/// Largest number of layouts in a comparison; each takes as long as the run of one room.
pub const MOST: usize = 20;

/// A layout with its results.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Name, short enough for a row of a table.
    pub name: String,
    /// The cellar.
    pub cellar: Cellar,
    /// Summary of all variants.
    pub summary: CellarSummary,
    /// Results of the room as stated and of its variants.
    pub cases: Vec<Case>,
    /// Plan of the room, with the places where fallen barrels come to rest.
    pub picture: FloorPlan,
}

impl Layout {
    /// Creates a layout from the parts of an answer that a comparison shows; frames are left out.
    pub fn of(name: String, answer: &Answer) -> Self {
        Self {
            name,
            cellar: answer.prepared.cellar.clone(),
            summary: answer.summary.clone(),
            cases: answer.cases.clone(),
            picture: picture(answer),
        }
    }
}

described! {
    /// Layouts of cellars side by side. Losses are those of the whole run. A value is null where an event did not
    /// happen, or where too few variants were run.
    #[derive(Clone, Debug)]
    pub struct CellarComparison {
        /// Name and version of the format of this document.
        pub schema: &'static str ["cellar-comparison/1"],
        /// Difference between the layouts, in one sentence.
        pub headline: String,
        /// The layouts that were run, in order; the first is the one to which the others are compared.
        pub layouts: Vec<LayoutAnswer>,
        /// The first layout compared with every other, variant by variant.
        pub paired: Vec<LayoutPair>,
        /// Names of the layouts, sorted by the share of barrels that fall, the smallest first; layouts without a valid
        /// variant are left out.
        pub order: Vec<String>,
        /// Requested changes that were not run, because the changed stacks would not fit into the room, or because the
        /// change does not apply to the cellar.
        pub left_out: Vec<LeftOut>,
        /// Names of the layouts that were stopped early or never started; they are not compared.
        pub unfinished: Vec<String>,
        /// The inputs that differ between the layouts.
        pub differences: Vec<Difference>,
        /// Warnings, one sentence each, with the name of the layout.
        pub warnings: Vec<String>,
        /// Name of the program.
        pub program: &'static str,
        /// Version of the program.
        pub version: &'static str,
    }

    /// A layout.
    #[derive(Clone, Debug)]
    pub struct LayoutAnswer {
        /// Name of the layout.
        pub name: String,
        /// Title of the cellar.
        pub title: String,
        /// Hash of the cellar with every default written out.
        pub cellar_hash: String,
        /// Number of barrels that the room holds.
        pub capacity: u64,
        /// Number of stacks.
        pub stacks: usize,
        /// Number of variants that the statistics count; 1 if only the room as stated was run.
        pub counted: u32,
        /// Numbers of the variants whose computation failed; they are not counted.
        pub broken: Vec<u32>,
        /// Number of stacks that fall by themselves.
        pub by_themselves: Estimate as "1",
        /// Number of stacks that are knocked over.
        pub knocked_over: Estimate as "1",
        /// How far a collapse spreads: number of stacks that fall, divided by the number that fall by themselves;
        /// null if none falls by itself.
        pub spread: Option<f64> as "1",
        /// Number of barrels that fall.
        pub barrels_fallen: Estimate as "1",
        /// Number of barrels that fall, divided by the capacity.
        pub share_lost: Estimate as "1",
        /// Expected loss of wine, under the central assumption about how many fallen barrels burst.
        pub wine_lost: f64 as "m3",
        /// Cost of the barrels that burst and of their wine, at the lower and at the upper estimate of the prices. The
        /// number of barrels that burst is that of the central assumption.
        pub cost: [f64; 2] as "US$",
        /// The aisles.
        pub aisles: Vec<AisleAnswer>,
        /// Variants in which at least one aisle is blocked at the end of the run; null if there are no aisles.
        pub some_blocked: Option<Count>,
        /// Distribution of the time from the start of the shaking until the first barrel enters any aisle.
        pub first_barrel: Option<Range> as "s",
        /// Largest force on a wall or column in any variant; null if there are no walls or columns.
        pub peak_force: Option<f64> as "N",
        /// Time from the end of the run that is shown to the end of the ground motion, if stacks still move when the
        /// run ends; in a sequence of shocks, the longest such time. Null if the run covers the ground motion, or if
        /// all stacks are at rest when it ends.
        pub cut: Option<f64> as "s",
    }

    /// A mean over the variants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Estimate {
        /// The mean.
        pub mean: f64 as "that of the field",
        /// Bounds of its 95 % interval, from the scatter between the variants; null if there are fewer than two
        /// variants.
        pub interval: Option<[f64; 2]> as "that of the field",
    }

    /// Comparison of two layouts, variant by variant.
    #[derive(Clone, Debug, PartialEq)]
    pub struct LayoutPair {
        /// Name of the first layout.
        pub first: String,
        /// Name of the second layout.
        pub second: String,
        /// Number of pairs: variants with a valid result in both layouts.
        pub variants: u32,
        /// Numbers of the variants that lack a valid result in at least one of the two layouts.
        pub left_out: Vec<u32>,
        /// True if both layouts have the same motion.
        pub same_motion: bool,
        /// True if the random draws of a variant are the same in both layouts for stacks of the same name.
        pub same_draws: bool,
        /// Number of stacks that fall by themselves.
        pub by_themselves: Change as "1",
        /// Number of stacks that are knocked over.
        pub knocked_over: Change as "1",
        /// Number of barrels that fall.
        pub barrels_fallen: Change as "1",
        /// Number of barrels that fall, divided by the capacity.
        pub share_lost: Change as "1",
        /// Expected loss of wine, under the central assumption about how many fallen barrels burst. This assumption is
        /// less certain than the number of barrels, so no interval is given.
        pub wine_lost: Change as "m3",
        /// Cost of the barrels that burst and of their wine, at the lower estimate of the prices. The number of barrels
        /// that burst is that of the central assumption; no interval is given.
        pub cost_low: Change as "US$",
        /// Cost of the barrels that burst and of their wine, at the upper estimate of the prices. The number of barrels
        /// that burst is that of the central assumption; no interval is given.
        pub cost_high: Change as "US$",
    }

    /// Change of one quantity from the first layout to the second, as means over the pairs of variants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Change {
        /// Mean in the first layout.
        pub first: f64 as "that of the field",
        /// Mean in the second layout.
        pub second: f64 as "that of the field",
        /// Mean in the second layout minus mean in the first.
        pub difference: f64 as "that of the field",
        /// Bounds of the 95 % interval of the mean difference, computed from the scatter of the differences of the
        /// pairs. The confidence level of 95 % applies to the intervals of all layouts jointly. Null for fewer than
        /// two pairs.
        pub interval: Option<[f64; 2]> as "that of the field",
    }

    /// A change for which no run was made.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct LeftOut {
        /// Name of the change.
        pub name: String,
        /// Reason why no run with this change was made.
        pub reason: String,
    }
}

/// Checks a comparison before any work is done.
///
/// # Errors
/// If there are too few or too many layouts, or two are equal.
pub fn check(layouts: &[(String, Cellar)]) -> Result<(), CompareError> {
    let print = |(name, cellar): &(String, Cellar)| (name.clone(), cellar.fingerprint());
    compare::check_distinct(&layouts.iter().map(print).collect::<Vec<_>>(), MOST)
}

/// Names layouts by their differences, such as "spacing 1 m" or "four levels"; if there are more differences than a
/// name can state, the given names are kept.
pub fn labels(layouts: &[(String, Cellar)]) -> Vec<String> {
    let mut differences = differences(layouts.iter().map(|(_, cellar)| cellar));
    let of_room = |one: &Difference| {
        ["room.", "column.", "door.", "aisle.", "place.", "block.", "start."]
            .into_iter()
            .any(|table| one.path.starts_with(table))
    };
    if !differences.iter().any(of_room) {
        let stacks: Vec<_> =
            layouts.iter().map(|(name, cellar)| (name.clone(), cellar.stated().clone())).collect();
        return compare::labels(&stacks);
    }
    // The only block of a room needs no name.
    if layouts.iter().all(|(_, cellar)| cellar.blocks.len() == 1) {
        for one in &mut differences {
            if let Some(field) =
                one.path.strip_prefix("block.").and_then(|path| path.split_once('.'))
            {
                one.path = field.1.to_owned();
            }
        }
    }
    let names: Vec<String> = layouts.iter().map(|(name, _)| name.clone()).collect();
    compare::labels_by(&names, &differences)
}

/// Compares layouts. `unfinished` holds the names of the layouts whose run was stopped early or never started, and
/// `left_out` the changes that were not run.
pub fn compared(
    layouts: &[Layout],
    unfinished: Vec<String>,
    left_out: Vec<LeftOut>,
) -> CellarComparison {
    let answers: Vec<LayoutAnswer> = layouts.iter().map(answer).collect();
    let others = layouts.get(1..).unwrap_or_default();
    let paired = others.iter().map(|other| pair(&layouts[0], other, others.len()));
    let mut order: Vec<&LayoutAnswer> = answers.iter().filter(|one| one.counted > 0).collect();
    order.sort_by(|a, b| a.share_lost.mean.total_cmp(&b.share_lost.mean));
    let warnings = |layout: &Layout| {
        let name = layout.name.clone();
        layout.summary.warnings.clone().into_iter().map(move |text| format!("{name}: {text}"))
    };
    let mut found = CellarComparison {
        schema: "cellar-comparison/1",
        headline: String::new(),
        order: order.into_iter().map(|one| one.name.clone()).collect(),
        paired: paired.collect(),
        left_out,
        unfinished,
        differences: differences(layouts.iter().map(|layout| &layout.cellar)),
        warnings: layouts.iter().flat_map(warnings).collect(),
        program: "barrelstack",
        version: env!("CARGO_PKG_VERSION"),
        layouts: answers,
    };
    found.headline = words::headline(&found);
    found
}

impl CellarComparison {
    /// Returns the layouts in the order of the tables: sorted by the share of barrels that fall, followed by the
    /// layouts without a valid variant. Each layout is paired with its comparison to the first layout; `None` for the
    /// first layout itself.
    pub fn ranked(&self) -> Vec<(&LayoutAnswer, Option<&LayoutPair>)> {
        let rank = |one: &LayoutAnswer| self.order.iter().position(|name| *name == one.name);
        let mut all: Vec<_> = self.layouts.iter().enumerate().collect();
        all.sort_by_key(|(_, one)| rank(one).unwrap_or(usize::MAX));
        let pair = |at: usize| at.checked_sub(1).and_then(|at| self.paired.get(at));
        all.into_iter().map(|(at, one)| (one, pair(at))).collect()
    }
}

/// Returns the inputs that differ between cellars, in the order of [`Cellar::settings`].
fn differences<'a>(cellars: impl Iterator<Item = &'a Cellar>) -> Vec<Difference> {
    differing(&cellars.map(Cellar::settings).collect::<Vec<_>>())
}

/// Loss of a room in one variant: numbers of stacks that fall by themselves and that are knocked over, number and
/// share of the barrels that fall, loss of wine (m³), and lower and upper cost (US$).
#[derive(Clone, Copy)]
struct Loss {
    by_themselves: f64,
    knocked_over: f64,
    barrels: f64,
    share: f64,
    wine: f64,
    cost: [f64; 2],
}

impl Loss {
    fn of(case: &Case, summary: &CellarSummary) -> Self {
        let [by_themselves, knocked_over] = fallen(case).map(f64::from);
        let barrels = barrels(case) as f64;
        let central = |of: fn(&crate::sample::StackCase) -> f64| case.stacks.iter().map(of).sum();
        let (burst, wine) = (central(|stack| stack.burst[1]), central(|stack| stack.wine[1]));
        Self {
            by_themselves,
            knocked_over,
            barrels,
            share: barrels / summary.plan.barrels.max(1) as f64,
            wine,
            cost: cost(burst, wine),
        }
    }
}

/// Returns the losses of a layout by variant number. Variants that are not counted in its statistics are left out.
fn losses(layout: &Layout) -> BTreeMap<u32, Loss> {
    let of = |case: &&Case| (case.variant, Loss::of(case, &layout.summary));
    counted(&layout.cases).iter().map(of).collect()
}

fn answer(layout: &Layout) -> LayoutAnswer {
    let CellarSummary { plan, room, aisles, .. } = &layout.summary;
    let all = losses(layout);
    let estimate = |of: fn(&Loss) -> f64, most: f64| Estimate::of(all.values().map(of), most);
    let (stacks, capacity) = (plan.stacks as f64, plan.barrels as f64);
    let cases = counted(&layout.cases);
    let first = |case: &&Case| case.aisles.iter().filter_map(|aisle| aisle.first).reduce(f64::min);
    LayoutAnswer {
        name: layout.name.clone(),
        title: layout.summary.title.clone(),
        cellar_hash: plan.cellar_hash.clone(),
        capacity: plan.barrels,
        stacks: plan.stacks,
        counted: layout.summary.counted,
        broken: layout.summary.broken.clone(),
        by_themselves: estimate(|loss| loss.by_themselves, stacks),
        knocked_over: estimate(|loss| loss.knocked_over, stacks),
        spread: room.spread,
        barrels_fallen: estimate(|loss| loss.barrels, capacity),
        share_lost: estimate(|loss| loss.share, 1.0),
        wine_lost: room.wine_lost[1],
        cost: room.cost,
        aisles: aisles.clone(),
        some_blocked: (!aisles.is_empty()).then(|| {
            Count::of(&cases, |case| case.aisles.iter().any(|aisle| aisle.blocked_at.is_some()))
        }),
        first_barrel: Range::of(cases.iter().filter_map(first)),
        peak_force: room.peak_force,
        cut: missing(&layout.summary),
    }
}

impl Estimate {
    /// Returns the mean of values that lie between 0 and `most`, with its confidence interval. There is no interval if
    /// there are fewer than two values.
    fn of(values: impl Iterator<Item = f64>, most: f64) -> Self {
        let most = most.max(f64::MIN_POSITIVE);
        let shares: Vec<(f64, f64)> = values.map(|value| (value / most, 1.0)).collect();
        let sum: f64 = shares.iter().map(|(share, _)| share).sum();
        let interval = (shares.len() > 1).then(|| {
            let interval = grouped_mean(&shares, LEVEL);
            [most * interval.low, most * interval.high]
        });
        Self { mean: most * sum / shares.len().max(1) as f64, interval }
    }
}

impl Change {
    /// Compares two layouts by pairs of values, of which the first belongs to the first layout. Returns the two mean
    /// values, the mean of the differences (second value minus first value), and the confidence interval of this mean.
    ///
    /// All values lie between 0 and `most`. There is no interval if `most` is `None`, or if there are fewer than two
    /// pairs. The confidence level applies jointly to `tries` intervals, one for each layout that is compared with the
    /// first.
    fn of(pairs: &[[f64; 2]], most: Option<f64>, tries: usize) -> Self {
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| {
            pairs.iter().map(of).sum::<f64>() / pairs.len().max(1) as f64
        };
        let differences: Vec<f64> = pairs.iter().map(|[first, second]| second - first).collect();
        let interval = most.and_then(|most| mean_difference(&differences, most, LEVEL, tries));
        Self {
            first: mean(&|pair| pair[0]),
            second: mean(&|pair| pair[1]),
            difference: mean(&|[first, second]| second - first),
            interval: interval.map(|interval| [interval.low, interval.high]),
        }
    }
}

/// Compares two layouts variant by variant; `others` is the number of layouts that are compared with the first.
fn pair(first: &Layout, second: &Layout, others: usize) -> LayoutPair {
    let [own, its] = [first, second].map(losses);
    let common: Vec<[&Loss; 2]> =
        own.iter().filter_map(|(number, loss)| Some([loss, its.get(number)?])).collect();
    let change = |of: fn(&Loss) -> f64, most: Option<f64>| {
        let pairs: Vec<[f64; 2]> = common.iter().map(|pair| pair.map(of)).collect();
        Change::of(&pairs, most, others)
    };
    let larger = |of: fn(&CellarSummary) -> f64| Some(of(&first.summary).max(of(&second.summary)));
    let stacks = larger(|summary| summary.plan.stacks as f64);
    let differences = differences([&first.cellar, &second.cellar].into_iter());
    let same = |tables: &[&str], but: &[&str]| {
        !differences.iter().any(|one| {
            tables.iter().any(|table| one.path.starts_with(table))
                && !but.contains(&one.path.as_str())
        })
    };
    LayoutPair {
        first: first.name.clone(),
        second: second.name.clone(),
        variants: u32::try_from(common.len()).unwrap_or(u32::MAX),
        left_out: left_out([first, second], [&own, &its]),
        same_motion: same(&["motion."], &[]),
        same_draws: same(&["imperfections.", "unknowns."], &["imperfections.variants"]),
        by_themselves: change(|loss| loss.by_themselves, stacks),
        knocked_over: change(|loss| loss.knocked_over, stacks),
        barrels_fallen: change(|loss| loss.barrels, larger(|summary| summary.plan.barrels as f64)),
        share_lost: change(|loss| loss.share, Some(1.0)),
        wine_lost: change(|loss| loss.wine, None),
        cost_low: change(|loss| loss.cost[0], None),
        cost_high: change(|loss| loss.cost[1], None),
    }
}

/// Returns the numbers of the variants that are left out of the comparison of two layouts, because one or both of the
/// layouts do not count them in their statistics. The room as stated is treated as a variant only in a layout without other
/// variants.
fn left_out(layouts: [&Layout; 2], losses: [&BTreeMap<u32, Loss>; 2]) -> Vec<u32> {
    let of = |layout: &Layout| -> BTreeSet<u32> {
        let varied = layout.cases.iter().any(|case| case.variant > 0);
        let all = layout.cases.iter().map(|case| case.variant);
        all.filter(|number| *number > 0 || !varied).collect()
    };
    let [first, second] = layouts.map(of);
    let both = |number: &u32| losses.iter().all(|one| one.contains_key(number));
    first.union(&second).copied().filter(|number| !both(number)).collect()
}
