//! Results of a cellar over all its variants, as one document with the same numbers as the printed results.

use std::collections::{BTreeMap, BTreeSet};

use barrelstack::breakage::cost;
use barrelstack::ground::MotionSummary;
use barrelstack::run::CUT;
use barrelstack::summary::Unfinished;
use barrelstack::variants::{LEVEL, Range};
use barrelstack_fragility::wilson;
use barrelstack_report::described;

use crate::plan::PlanSummary;
use crate::result::RoomRun;
use crate::sample::{Case, Prepared, StackCase};

described! {
    /// Results of a cellar. Lengths are in m. Times are in s and start with the shaking, when the horizontal
    /// acceleration of the ground first exceeds 0.02 g. A value is null where an event did not happen.
    #[derive(Clone, Debug)]
    pub struct CellarSummary {
        /// Name and version of the format of this document.
        pub schema: &'static str ["cellar/1"],
        /// Title of the cellar.
        pub title: String,
        /// Result in one sentence.
        pub headline: String,
        /// The plan before the shaking.
        pub plan: PlanSummary,
        /// Number of variants that the statistics count; 1 if only the room as stated was run.
        pub counted: u32,
        /// Numbers of the variants whose computation failed; they are not counted.
        pub broken: Vec<u32>,
        /// Number of finished runs; null if the work was not stopped early.
        pub unfinished: Option<Unfinished>,
        /// Results of the whole room.
        pub room: RoomAnswer,
        /// Results of the rows.
        pub rows: Vec<RowAnswer>,
        /// The stacks, row by row.
        pub stacks: Vec<StackAnswer>,
        /// The aisles.
        pub aisles: Vec<AisleAnswer>,
        /// The places where people work.
        pub places: Vec<PlaceAnswer>,
        /// Walls and columns.
        pub obstacles: Vec<ObstacleAnswer>,
        /// Names of the stacks in the order in which to inspect them after the shaking: sorted by the median of their
        /// movement in the variants in which they stand, the largest first. Stacks that always fall are not listed.
        pub inspection: Vec<String>,
        /// The shocks of a sequence, in order; empty for a single shock, or if no run is counted. For a sequence, all
        /// other values are those of all shocks together: times continue from shock to shock, without the quiet time
        /// between them.
        pub shocks: Vec<ShockAnswer>,
        /// The run that is shown.
        pub shown: ShownRoom,
        /// Component along x of the ground motion of the first shock.
        pub motion: Option<MotionSummary>,
        /// Component of the ground motion along y; null where the motion has only one horizontal component.
        pub other_component: Option<MotionSummary>,
        /// Vertical component of the ground motion; null where the motion has none.
        pub vertical_component: Option<VerticalMotion>,
        /// Time at which the shaking starts, in the record.
        pub onset: f64 as "s",
        /// Warnings, one sentence each.
        pub warnings: Vec<String>,
        /// Name of the program.
        pub program: &'static str,
        /// Version of the program.
        pub version: &'static str,
        /// Sentences on the source of the motion, on its processing, and on bodies that do not start as built.
        pub provenance: Vec<String>,
        /// Wall-clock time of the computation; null if not measured.
        pub wall_seconds: Option<f64> as "s",
    }

    /// The vertical component of a ground motion.
    #[derive(Clone, Debug, PartialEq)]
    pub struct VerticalMotion {
        /// Name of the motion.
        pub name: String,
        /// Peak acceleration.
        pub pga: f64 as "m/s2",
        /// Peak velocity.
        pub pgv: f64 as "m/s",
    }

    /// Number of variants in which an event happens, with the share of these variants and the 95 % interval of the
    /// probability of the event (Wilson 1927).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Count {
        /// Number of variants in which the event happens.
        pub of_variants: u32,
        /// Share of the counted variants in which the event happens; null if no variant is counted.
        pub share: Option<f64> as "1",
        /// Bounds of the 95 % interval.
        pub interval: [f64; 2] as "1",
    }

    /// Results of the whole room.
    #[derive(Clone, Debug)]
    pub struct RoomAnswer {
        /// Variants in which at least one stack falls.
        pub some_fall: Count,
        /// Mean number of stacks that fall by themselves.
        pub by_themselves: f64 as "1",
        /// Mean number of stacks that are knocked over, that is, touched by a body of another stack before they lose a
        /// seat.
        pub knocked_over: f64 as "1",
        /// Share of the stacks standing before the run that fall by themselves, over all variants; its interval
        /// treats each room as one observation.
        pub share_by_themselves: Mean,
        /// Share of the stacks standing before the run that are knocked over, over all variants; its interval treats
        /// each room as one observation.
        pub share_knocked_over: Mean,
        /// How far a collapse spreads: number of stacks that fall, divided by the number that fall by themselves;
        /// null if none falls by itself.
        pub spread: Option<f64> as "1",
        /// Distribution of the number of stacks that fall.
        pub stacks_fallen: Range as "1",
        /// Distribution of the number of barrels that fall.
        pub barrels_fallen: Range as "1",
        /// Expected number of barrels that burst, under a low, a central and a high assumption on the share of barrels
        /// that burst at a given height of fall.
        pub burst: [f64; 3] as "1",
        /// Expected loss of wine, under the three assumptions of `burst`.
        pub wine_lost: [f64; 3] as "m3",
        /// Cost of the barrels that burst and of their wine, at the lower and at the upper estimate of the prices. The
        /// number of barrels that burst is that of the central assumption.
        pub cost: [f64; 2] as "US$",
        /// Largest force on a wall or column in any variant; null if there are no walls or columns.
        pub peak_force: Option<f64> as "N",
    }

    /// A mean over the variants, with its 95 % interval from the scatter between them.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Mean {
        /// The mean.
        pub mean: f64 as "1",
        /// Bounds of the 95 % interval, between 0 and 1.
        pub interval: [f64; 2] as "1",
    }

    /// A row of stacks.
    #[derive(Clone, Debug)]
    pub struct RowAnswer {
        /// Number of the row.
        pub row: u32,
        /// Number of stacks in the row.
        pub stacks: u32,
        /// Variants in which the first stack to fall is in this row.
        pub starts: Count,
        /// Mean number of stacks of the row that fall by themselves.
        pub by_themselves: f64 as "1",
        /// Mean number of stacks of the row that are knocked over.
        pub knocked_over: f64 as "1",
    }

    /// A stack.
    #[derive(Clone, Debug)]
    pub struct StackAnswer {
        /// Name: row and number in the row.
        pub name: String,
        /// Number of the row.
        pub row: u32,
        /// Number of the stack in the row.
        pub number: u32,
        /// Position of the middle of the stack.
        pub at: [f64; 2] as "m",
        /// Variants in which the stack falls.
        pub falls: Count,
        /// Variants in which the stack falls by itself.
        pub by_itself: Count,
        /// Variants in which the stack is knocked over.
        pub knocked_over: Count,
        /// Distribution of the time at which the stack first loses a seat.
        pub falls_at: Option<Range> as "s",
        /// Name of the other stack that is most often the first to touch this stack; null if none touches it.
        pub touched_by: Option<String>,
        /// Distribution of the time of the first contact with another stack.
        pub touched_at: Option<Range> as "s",
        /// Distribution of the impulse that other stacks exert on the stack until it loses a seat, or over the whole
        /// run if it stands.
        pub impulse: Option<Range> as "N s",
        /// Mean number of barrels that fall from the stack.
        pub barrels_fallen: f64 as "1",
        /// Expected volume of wine that the stack loses, under the central assumption about how many fallen barrels
        /// burst.
        pub wine_lost: f64 as "m3",
        /// Distribution of the largest horizontal displacement of a body of the stack at the end of the run, over the
        /// variants in which the stack stands.
        pub moved: Option<Range> as "m",
    }

    /// An aisle.
    #[derive(Clone, Debug)]
    pub struct AisleAnswer {
        /// Name of the aisle.
        pub name: String,
        /// Variants in which a barrel enters the aisle.
        pub entered: Count,
        /// Distribution of the time at which the first barrel enters the aisle.
        pub first_barrel: Option<Range> as "s",
        /// Variants in which, at the end of the run, no path 0.6 m wide leads through the aisle.
        pub blocked: Count,
        /// Distribution of the time from which the aisle stays blocked.
        pub blocked_at: Option<Range> as "s",
        /// Share of the aisle's area that is covered at the end of the run: distribution over the variants.
        pub covered: Range as "1",
        /// Distribution of the largest speed of a barrel in the aisle.
        pub fastest: Option<Range> as "m/s",
    }

    /// A place where people work.
    #[derive(Clone, Debug)]
    pub struct PlaceAnswer {
        /// Name of the place.
        pub name: String,
        /// Variants in which, at the end of the run, a path 0.6 m wide leads from the place to a door; null if there
        /// are no doors.
        pub leads_out: Option<Count>,
    }

    /// A wall or column.
    #[derive(Clone, Debug)]
    pub struct ObstacleAnswer {
        /// Name of the wall or column.
        pub name: String,
        /// Variants in which a body strikes the wall or column.
        pub struck: Count,
        /// Distribution of the largest force on the wall or column, over the variants in which a body strikes it.
        pub peak: Option<Range> as "N",
        /// Distribution of the impulse on the wall or column during the whole run, over the variants in which a body
        /// strikes it. Bodies that lean on the wall or column contribute to the impulse.
        pub impulse: Option<Range> as "N s",
    }

    /// A shock of a sequence. Stacks that had fallen before it do not fall again.
    #[derive(Clone, Debug)]
    pub struct ShockAnswer {
        /// Number of the shock, from 1.
        pub shock: u32,
        /// Ground motion.
        pub motion: Option<MotionSummary>,
        /// Time at which the shaking starts, in the record of the shock.
        pub onset: f64 as "s",
        /// Mean number of stacks that stand before the shock.
        pub stood: f64 as "1",
        /// Number of variants in which at least one stack stands before the shock.
        pub stood_in: u32,
        /// Variants in which all stacks that stand before the shock survive it, out of `stood_in`.
        pub all_survive: Count,
        /// Share of the stacks standing before the shock that survive it, over the variants in which at least one
        /// stands; its interval treats each room as one observation. Null if no stack stands in any variant.
        pub share_survive: Option<Mean>,
        /// Mean number of stacks that fall by themselves.
        pub by_themselves: f64 as "1",
        /// Mean number of stacks that are knocked over.
        pub knocked_over: f64 as "1",
        /// Distribution of the number of barrels that fall in the shock.
        pub barrels_fallen: Range as "1",
        /// For each aisle, the variants in which it is blocked after the shock.
        pub blocked: Vec<Count>,
        /// Variants in which a body still moves when the shock ends. In the next shock, this body starts at rest from
        /// the place that it has reached.
        pub still_moving: Count,
        /// The stacks, in the order of the plan.
        pub stacks: Vec<ShockStack>,
        /// The run that is shown; null if it did not reach the shock.
        pub shown: Option<ShownShock>,
    }

    /// A stack in a shock.
    #[derive(Clone, Debug)]
    pub struct ShockStack {
        /// Name of the stack.
        pub name: String,
        /// Variants in which the stack stands before the shock.
        pub stood: Count,
        /// Variants in which the stack falls by itself.
        pub by_itself: Count,
        /// Variants in which the stack is knocked over.
        pub knocked_over: Count,
        /// Mean number of barrels that fall from the stack.
        pub barrels_fallen: f64 as "1",
    }

    /// A shock in the run that is shown.
    #[derive(Clone, Debug)]
    pub struct ShownShock {
        /// Number of stacks that stand before the shock.
        pub stood: u32,
        /// Number of stacks that fall by themselves.
        pub by_themselves: u32,
        /// Number of stacks that are knocked over.
        pub knocked_over: u32,
        /// Number of barrels that fall.
        pub barrels_fallen: usize,
        /// Number of stacks in which a body still moves when the shock ends.
        pub still_moving: usize,
        /// End of the run, as a time in the record of the shock. A run ends when all bodies have come to rest or its
        /// duration has elapsed, unless it is stopped earlier.
        pub end_time: f64 as "s",
        /// Time from the end of the run to the end of the ground motion of the shock, if stacks still move when the run
        /// ends. 0 if the run covers this ground motion, or if all stacks are at rest when it ends.
        pub cut: f64 as "s",
    }

    /// The run that is shown.
    #[derive(Clone, Debug)]
    pub struct ShownRoom {
        /// Number of the variant; 0 is the room as stated.
        pub variant: u32,
        /// True if this run is the most typical of the counted runs.
        pub typical: bool,
        /// End of the run, as a time in the record. A run ends when all bodies have come to rest or its duration has
        /// elapsed, unless it is stopped earlier.
        pub end_time: f64 as "s",
        /// Time from the end of the run to the end of the ground motion, if stacks still move when the run ends; in a
        /// sequence of shocks, the longest such time. 0 if the run covers the ground motion, or if all stacks are at
        /// rest when it ends.
        pub cut: f64 as "s",
        /// Row of the first stack that falls.
        pub starts: Option<u32>,
        /// Number of stacks that had fallen before the run.
        pub fallen_before: u32,
        /// Number of stacks that fall by themselves.
        pub by_themselves: u32,
        /// Number of stacks that are knocked over.
        pub knocked_over: u32,
        /// Number of barrels that fall.
        pub barrels_fallen: u32,
        /// The stacks, in the order of the plan.
        pub stacks: Vec<ShownStack>,
        /// For each aisle, the time from which it stays blocked; null for an aisle that is passable at the end of the
        /// run.
        pub blocked_at: Vec<Option<f64>> as "s",
    }

    /// A stack in the run that is shown.
    #[derive(Clone, Debug)]
    pub struct ShownStack {
        /// Name of the stack.
        pub name: String,
        /// What happens to the stack.
        pub fate: &'static str ["stands", "falls-by-itself", "knocked-over", "fallen-before"],
        /// Time of the first loss of a seat of the stack.
        pub falls_at: Option<f64> as "s",
        /// Time of the first contact with another stack.
        pub touched_at: Option<f64> as "s",
        /// Name of the other stack.
        pub touched_by: Option<String>,
        /// Names of the two bodies in the first contact: first the body of this stack, then the body of the other
        /// stack.
        pub bodies: Option<[String; 2]>,
        /// Impulse that other stacks exert on the stack until it loses a seat, or over the whole run if it stands; null
        /// if it lost a seat before it was touched.
        pub impulse: Option<f64> as "N s",
        /// Number of barrels that fell from the stack.
        pub barrels_fallen: usize,
        /// Largest horizontal displacement at the end of the run, over the bodies that did not fall.
        pub moved: f64 as "m",
    }
}

impl Count {
    /// Counts the cases for which `is` returns `true`.
    pub fn of<'a>(cases: &[&'a Case], is: impl Fn(&'a Case) -> bool) -> Self {
        let of_variants =
            u32::try_from(cases.iter().filter(|case| is(case)).count()).unwrap_or(u32::MAX);
        let all = u32::try_from(cases.len()).unwrap_or(u32::MAX);
        let interval = wilson(of_variants, all, LEVEL);
        Self {
            of_variants,
            share: (all > 0).then(|| f64::from(of_variants) / f64::from(all)),
            interval: [interval.low, interval.high],
        }
    }
}

impl Mean {
    /// Returns the mean of shares with its 95 % interval. Without shares, the mean is 0 and the interval is 0 to 1.
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        if values.is_empty() {
            return Self { mean: 0.0, interval: [0.0, 1.0] };
        }
        let weighted: Vec<(f64, f64)> = values.iter().map(|value| (*value, 1.0)).collect();
        let interval = barrelstack_fragility::grouped_mean(&weighted, LEVEL);
        let mean = values.iter().sum::<f64>() / n;
        Self { mean, interval: [interval.low.max(0.0), interval.high.min(1.0)] }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Summarizes the distribution of values; all its numbers are zero if there are no values.
fn range(values: impl Iterator<Item = f64>) -> Range {
    let zero = Range { p05: 0.0, p50: 0.0, p95: 0.0, least: 0.0, most: 0.0 };
    Range::of(values).unwrap_or(zero)
}

/// Returns two numbers of stacks in a case: those that fall by themselves, and those that are knocked over.
pub fn fallen(case: &Case) -> [u32; 2] {
    let count = |is: &dyn Fn(&StackCase) -> bool| {
        u32::try_from(case.stacks.iter().filter(|stack| is(stack)).count()).unwrap_or(u32::MAX)
    };
    [count(&StackCase::by_itself), count(&|stack| stack.knocked)]
}

/// Returns the index of the stack that falls first in a case; `None` if no stack falls.
fn first(case: &Case) -> Option<usize> {
    let times = case.stacks.iter().enumerate();
    let times = times.filter_map(|(at, stack)| Some((stack.fell_at?, at)));
    times.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at)| at)
}

/// Returns the cases on which the statistics are based: the valid variants or, if there are no variants, the room as
/// stated in its file, if its case is valid.
pub fn counted(cases: &[Case]) -> Vec<&Case> {
    let varied = cases.iter().any(|case| case.variant > 0);
    cases.iter().filter(|case| case.valid && (case.variant > 0 || !varied)).collect()
}

/// Returns the number of the most typical variant; `None` if no case enters the statistics.
///
/// For each variant, three counts are compared with their medians over all variants: stacks that fall by themselves,
/// stacks that are knocked over, and barrels that fall. The most typical variant has the smallest sum of absolute
/// deviations from the medians, where a barrel has 0.05 times the weight of a stack.
pub fn typical(cases: &[Case]) -> Option<u32> {
    let counted = counted(cases);
    let numbers = |case: &Case| {
        let [own, knocked] = fallen(case).map(f64::from);
        [own, knocked, 0.05 * barrels(case) as f64]
    };
    let medians = [0, 1, 2].map(|which| range(counted.iter().map(|case| numbers(case)[which])).p50);
    let far = |case: &Case| -> f64 {
        numbers(case).iter().zip(medians).map(|(value, median)| (value - median).abs()).sum()
    };
    counted.iter().min_by(|a, b| far(a).total_cmp(&far(b))).map(|case| case.variant)
}

/// Summarizes the cases of a cellar, and the run that is shown; `shown` holds this run and its case.
pub fn of(prepared: &Prepared, cases: &[Case], shown: (&Case, &RoomRun)) -> CellarSummary {
    let all = counted(cases);
    let plan = &prepared.plan;
    let share = |of: usize| {
        let standing = all.iter().filter(|case| stood(case) > 0);
        let shares = standing.map(|case| f64::from(fallen(case)[of]) / f64::from(stood(case)));
        Mean::of(&shares.collect::<Vec<_>>())
    };
    let [own, knocked] =
        [0, 1].map(|which| mean(all.iter().map(|case| f64::from(fallen(case)[which]))));
    let three = |of: &dyn Fn(&StackCase) -> [f64; 3]| {
        [0, 1, 2].map(|which| {
            mean(all.iter().map(|case| case.stacks.iter().map(|stack| of(stack)[which]).sum()))
        })
    };
    let [burst, wine_lost] = [three(&|stack| stack.burst), three(&|stack| stack.wine)];
    let peaks = all.iter().flat_map(|case| case.obstacles.iter().map(|one| one.peak));
    let room = RoomAnswer {
        some_fall: Count::of(&all, |case| first(case).is_some()),
        by_themselves: own,
        knocked_over: knocked,
        share_by_themselves: share(0),
        share_knocked_over: share(1),
        spread: (own > 0.0).then(|| (own + knocked) / own),
        stacks_fallen: range(all.iter().map(|case| fallen(case).into_iter().map(f64::from).sum())),
        barrels_fallen: range(all.iter().map(|case| barrels(case) as f64)),
        burst,
        wine_lost,
        cost: cost(burst[1], wine_lost[1]),
        peak_force: peaks.reduce(f64::max),
    };
    let (case, run) = shown;
    let of_cases = cases.iter().flat_map(|case| &case.warnings);
    let warnings = grouped(run.warnings.iter().chain(of_cases));
    let motion = prepared.ground.first.motion.as_ref();
    let other = prepared.ground.second.as_ref().and_then(|ground| ground.motion.as_ref());
    let vertical = motion.and_then(|motion| Some((&motion.name, motion.vertical.as_ref()?)));
    let mut summary = CellarSummary {
        schema: "cellar/1",
        title: prepared.cellar.title.clone(),
        headline: String::new(),
        plan: plan.summary.clone(),
        counted: u32::try_from(all.len()).unwrap_or(u32::MAX),
        broken: cases.iter().filter(|case| !case.valid).map(|case| case.variant).collect(),
        unfinished: None,
        room,
        rows: rows(prepared, &all),
        stacks: stacks(prepared, &all),
        aisles: aisles(prepared, &all),
        places: places(prepared, &all),
        obstacles: obstacles(run, &all),
        inspection: Vec::new(),
        shocks: shocks(prepared, &all, case),
        shown: shown_room(prepared, case, run),
        motion: motion.map(MotionSummary::of),
        other_component: other.map(MotionSummary::of),
        vertical_component: vertical.map(|(name, history)| VerticalMotion {
            name: name.clone(),
            pga: history.pga(),
            pgv: history.pgv(),
        }),
        onset: prepared.onset,
        warnings,
        program: "barrelstack",
        version: env!("CARGO_PKG_VERSION"),
        provenance: provenance(prepared),
        wall_seconds: None,
    };
    summary.inspection = inspection(&summary.stacks);
    summary.shown.typical = typical(cases) == Some(case.variant);
    summary.headline = if case.valid {
        crate::words::headline(&summary)
    } else {
        "The computation of the run that is shown failed, so it has no result.".to_owned()
    };
    summary
}

/// Returns sentences on the sources of the motions of all shocks, each sentence once, and on the source of the initial
/// poses of bodies.
pub(crate) fn provenance(prepared: &Prepared) -> Vec<String> {
    let mut all = prepared.ground.provenance();
    for step in prepared.later.iter().flat_map(|later| later.ground.provenance()) {
        if !all.contains(&step) {
            all.push(step);
        }
    }
    let start = &prepared.cellar.start;
    all.extend(
        start.file.as_ref().map(|file| format!("Bodies start from the file {}.", file.path)),
    );
    match start.shifts.len() {
        0 => {}
        1 => all.push("One body or stack is shifted before the run.".to_owned()),
        many => all.push(format!("{many} shifts of bodies or stacks are applied before the run.")),
    }
    all
}

/// Returns the results of the shocks of a sequence.
pub(crate) fn shocks(prepared: &Prepared, all: &[&Case], shown: &Case) -> Vec<ShockAnswer> {
    if prepared.later.is_empty() || all.is_empty() {
        return Vec::new();
    }
    let later = prepared.later.iter().map(|later| (&later.ground, later.onset));
    let grounds = std::iter::once((&prepared.ground, prepared.onset)).chain(later);
    let one = |(at, (ground, onset)): (usize, (&barrelstack_space::Ground, f64))| {
        let own: Vec<&Case> = all.iter().filter_map(|case| case.shocks.get(at)).collect();
        let total = |of: &dyn Fn(&Case) -> f64| mean(own.iter().map(|case| of(case)));
        let standing: Vec<&Case> = own.iter().copied().filter(|case| stood(case) > 0).collect();
        let survive = standing.iter().map(|case| {
            let [own, knocked] = fallen(case).map(f64::from);
            1.0 - (own + knocked) / f64::from(stood(case))
        });
        let survive: Vec<f64> = survive.collect();
        let aisles = 0..prepared.cellar.aisles.len();
        let stack = |(at, standing): (usize, &crate::scenario::Standing)| ShockStack {
            name: standing.name.clone(),
            stood: Count::of(&own, |case| !case.stacks[at].fallen_before),
            by_itself: Count::of(&own, |case| case.stacks[at].by_itself()),
            knocked_over: Count::of(&own, |case| case.stacks[at].knocked),
            barrels_fallen: mean(own.iter().map(|case| case.stacks[at].barrels as f64)),
        };
        ShockAnswer {
            shock: u32::try_from(at + 1).unwrap_or(u32::MAX),
            motion: ground.first.motion.as_ref().map(MotionSummary::of),
            onset,
            stood: total(&|case| f64::from(stood(case))),
            stood_in: u32::try_from(standing.len()).unwrap_or(u32::MAX),
            all_survive: Count::of(&standing, |case| fallen(case) == [0, 0]),
            share_survive: (!survive.is_empty()).then(|| Mean::of(&survive)),
            by_themselves: total(&|case| f64::from(fallen(case)[0])),
            knocked_over: total(&|case| f64::from(fallen(case)[1])),
            barrels_fallen: range(own.iter().map(|case| barrels(case) as f64)),
            blocked: aisles
                .map(|aisle| Count::of(&own, |case| case.aisles[aisle].blocked_at.is_some()))
                .collect(),
            still_moving: Count::of(&own, |case| case.still_moving > 0),
            stacks: prepared.plan.stacks.iter().enumerate().map(stack).collect(),
            shown: shown.shocks.get(at).map(|case| {
                let [by_themselves, knocked_over] = fallen(case);
                ShownShock {
                    stood: stood(case),
                    by_themselves,
                    knocked_over,
                    barrels_fallen: barrels(case),
                    still_moving: case.still_moving,
                    end_time: case.end_time,
                    cut: cut(ground, case),
                }
            }),
        }
    };
    grounds.enumerate().map(one).collect()
}

/// Returns the time (s) by which the ground motion outlasts a run, if stacks still move when the run ends; otherwise
/// zero.
fn cut(ground: &barrelstack_space::Ground, case: &Case) -> f64 {
    let left = ground.end() - case.end_time;
    if case.cut_short && left > CUT { left } else { 0.0 }
}

/// Returns the number of barrels that fall in a case.
pub(crate) fn barrels(case: &Case) -> usize {
    case.stacks.iter().map(|stack| stack.barrels).sum()
}

/// Returns the number of stacks that stand before the run of a case.
fn stood(case: &Case) -> u32 {
    u32::try_from(case.stacks.iter().filter(|stack| !stack.fallen_before).count())
        .unwrap_or(u32::MAX)
}

/// Returns each warning once, preceded by the name of the stack that it concerns, or by the number of stacks if it
/// concerns several.
pub(crate) fn grouped<'a>(
    warnings: impl Iterator<Item = &'a (Option<String>, String)>,
) -> Vec<String> {
    let mut all: Vec<(&str, BTreeSet<&str>)> = Vec::new();
    for (stack, text) in warnings {
        let at = all.iter().position(|(known, _)| known == text).unwrap_or_else(|| {
            all.push((text, BTreeSet::new()));
            all.len() - 1
        });
        all[at].1.extend(stack.as_deref());
    }
    let sentence = |(text, stacks): &(&str, BTreeSet<&str>)| match stacks.len() {
        0 => (*text).to_owned(),
        1 => format!("{}: {text}", stacks.iter().copied().collect::<String>()),
        many => format!("{many} stacks: {text}"),
    };
    all.iter().map(sentence).collect()
}

fn rows(prepared: &Prepared, all: &[&Case]) -> Vec<RowAnswer> {
    let stacks = &prepared.plan.stacks;
    let last = stacks.last().map_or(0, |last| last.row);
    let row = |row: u32| {
        let own: Vec<usize> = (0..stacks.len()).filter(|at| stacks[*at].row == row).collect();
        let many = |is: &dyn Fn(&StackCase) -> bool| {
            mean(
                all.iter()
                    .map(|case| own.iter().filter(|at| is(&case.stacks[**at])).count() as f64),
            )
        };
        RowAnswer {
            row,
            stacks: u32::try_from(own.len()).unwrap_or(u32::MAX),
            starts: Count::of(all, |case| first(case).is_some_and(|at| stacks[at].row == row)),
            by_themselves: many(&StackCase::by_itself),
            knocked_over: many(&|stack| stack.knocked),
        }
    };
    (1..=last).map(row).collect()
}

fn stacks(prepared: &Prepared, all: &[&Case]) -> Vec<StackAnswer> {
    let plan = &prepared.plan;
    let one = |(at, standing): (usize, &crate::scenario::Standing)| {
        let own = || all.iter().map(|case| &case.stacks[at]);
        let mut touched = BTreeMap::<usize, u32>::new();
        for (_, by, _) in own().filter_map(|stack| stack.touched) {
            *touched.entry(by).or_default() += 1;
        }
        // If several stacks have the same count, the first of them is chosen.
        let most = touched.iter().max_by(|a, b| a.1.cmp(b.1).then(b.0.cmp(a.0)));
        let [lower, upper] = plan.footprints[at].bounds();
        StackAnswer {
            name: standing.name.clone(),
            row: standing.row,
            number: standing.number,
            at: [0, 1].map(|axis| (5e3 * (lower[axis] + upper[axis])).round() / 1e4),
            falls: Count::of(all, |case| case.stacks[at].fell_at.is_some()),
            by_itself: Count::of(all, |case| case.stacks[at].by_itself()),
            knocked_over: Count::of(all, |case| case.stacks[at].knocked),
            falls_at: Range::of(own().filter_map(|one| Some(one.fell_at? - prepared.onset))),
            touched_by: most.map(|(by, _)| plan.stacks[*by].name.clone()),
            touched_at: Range::of(own().filter_map(|one| Some(one.touched?.0 - prepared.onset))),
            impulse: Range::of(own().filter_map(|one| Some(one.touched?.2))),
            barrels_fallen: mean(own().map(|one| one.barrels as f64)),
            wine_lost: mean(own().map(|one| one.wine[1])),
            moved: Range::of(
                own()
                    .filter(|one| one.fell_at.is_none() && !one.fallen_before)
                    .map(|one| one.moved),
            ),
        }
    };
    plan.stacks.iter().enumerate().map(one).collect()
}

fn aisles(prepared: &Prepared, all: &[&Case]) -> Vec<AisleAnswer> {
    let one = |(at, aisle): (usize, &crate::scenario::Aisle)| {
        let own = || all.iter().map(|case| &case.aisles[at]);
        AisleAnswer {
            name: aisle.name.clone(),
            entered: Count::of(all, |case| case.aisles[at].first.is_some()),
            first_barrel: Range::of(own().filter_map(|one| one.first)),
            blocked: Count::of(all, |case| case.aisles[at].blocked_at.is_some()),
            blocked_at: Range::of(own().filter_map(|one| one.blocked_at)),
            covered: range(own().map(|one| one.covered)),
            fastest: Range::of(own().filter_map(|one| one.fastest)),
        }
    };
    prepared.cellar.aisles.iter().enumerate().map(one).collect()
}

fn places(prepared: &Prepared, all: &[&Case]) -> Vec<PlaceAnswer> {
    let doors = !prepared.cellar.doors.is_empty();
    let one = |(at, place): (usize, &crate::scenario::Place)| PlaceAnswer {
        name: place.name.clone(),
        leads_out: doors.then(|| Count::of(all, |case| case.paths_to_doors[at] == Some(true))),
    };
    prepared.cellar.places.iter().enumerate().map(one).collect()
}

fn obstacles(run: &RoomRun, all: &[&Case]) -> Vec<ObstacleAnswer> {
    let one = |(at, end): (usize, &crate::result::ObstacleEnd)| {
        let struck = || all.iter().map(|case| &case.obstacles[at]).filter(|one| one.struck);
        ObstacleAnswer {
            name: end.name.clone(),
            struck: Count::of(all, |case| case.obstacles[at].struck),
            peak: Range::of(struck().map(|one| one.peak)),
            impulse: Range::of(struck().map(|one| one.impulse)),
        }
    };
    run.obstacles.iter().enumerate().map(one).collect()
}

fn inspection(stacks: &[StackAnswer]) -> Vec<String> {
    let mut standing: Vec<(f64, &str)> =
        stacks.iter().filter_map(|one| Some((one.moved?.p50, one.name.as_str()))).collect();
    standing.sort_by(|a, b| b.0.total_cmp(&a.0));
    standing.into_iter().map(|(_, name)| name.to_owned()).collect()
}

fn shown_room(prepared: &Prepared, case: &Case, run: &RoomRun) -> ShownRoom {
    let plan = &prepared.plan;
    let [by_themselves, knocked_over] = fallen(case);
    let stack = |(stack, standing): (&StackCase, &crate::scenario::Standing)| ShownStack {
        name: standing.name.clone(),
        fate: match (stack.fell_at, stack.knocked) {
            (None, _) if stack.fallen_before => "fallen-before",
            (None, _) => "stands",
            (Some(_), false) => "falls-by-itself",
            (Some(_), true) => "knocked-over",
        },
        falls_at: stack.fell_at.map(|time| time - prepared.onset),
        touched_at: stack.touched.map(|(time, ..)| time - prepared.onset),
        touched_by: stack.touched.map(|(_, by, _)| plan.stacks[by].name.clone()),
        bodies: stack.touching.clone(),
        impulse: stack
            .touched
            .filter(|(time, ..)| stack.fell_at.is_none_or(|fell| fell >= *time))
            .map(|(.., impulse)| impulse),
        barrels_fallen: stack.barrels,
        moved: stack.moved,
    };
    ShownRoom {
        variant: case.variant,
        typical: false,
        end_time: run.end_time,
        cut: if case.shocks.is_empty() {
            cut(&prepared.ground, case)
        } else {
            let later = prepared.later.iter().map(|later| &later.ground);
            let grounds = std::iter::once(&prepared.ground).chain(later);
            grounds.zip(&case.shocks).map(|(ground, case)| cut(ground, case)).fold(0.0, f64::max)
        },
        starts: first(case).map(|at| plan.stacks[at].row),
        fallen_before: u32::try_from(plan.stacks.len()).unwrap_or(u32::MAX) - stood(case),
        by_themselves,
        knocked_over,
        barrels_fallen: u32::try_from(barrels(case)).unwrap_or(u32::MAX),
        stacks: case.stacks.iter().zip(&plan.stacks).map(stack).collect(),
        blocked_at: case.aisles.iter().map(|aisle| aisle.blocked_at).collect(),
    }
}
