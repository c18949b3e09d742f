//! Compares the same stacks, motions and imperfections in the plane across the barrels, in the plane along them, and in
//! three dimensions, to show when a verdict of a plane is enough and on which side it errs.
//!
//! ```text
//! cargo run --release -p barrelstack-space --example evidence -- 200 shares.svg "four levels: stack.levels=4"
//! ```
//!
//! The first argument is the number of cases, the second the output file of the figure. Every further argument defines
//! a stack by its name and a change of `demo-napa`; several changes are joined by `+`. The example prints the rows of
//! the table in `validation/space.md` and draws their shares.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use std::collections::BTreeMap;
use std::error::Error;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use barrelstack::Scenario;
use barrelstack::ensemble::CaseResult;
use barrelstack::ground::other_component;
use barrelstack::outcome::Outcome;
use barrelstack::scenario::{MotionSpec, Scene, View};
use barrelstack::variants::{LEVEL, planes, run};
use barrelstack_fragility::{Interval, wilson};
use barrelstack_report::{Axis, Figure, Plot, Series, SeriesStyle};
use barrelstack_space::fate::Heading;
use barrelstack_space::variants::run_all;

/// Changes of `demo-napa` that all stacks share: all run to the same end time, or to three seconds after a collapse.
const COMMON: [&str; 3] =
    ["stack.view=spatial", "run.stop_after_collapse='3 s'", "run.duration='16 s'"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().unwrap_or_else(|| "200".to_owned());
    let figure = arguments.next().unwrap_or_else(|| "shares.svg".to_owned());
    let stacks: Vec<String> = arguments.collect();
    let mut shares = Vec::new();
    println!(
        "| stack | seen | fall | share, 95 % | first body (cases) | mode (cases) | first fall, median | barrels \
         fallen, median | debris across / along |\n|---|---|---|---|---|---|---|---|---|"
    );
    for stack in &stacks {
        let (name, changes) = stack.split_once(": ").ok_or("a stack is `name: change+change`")?;
        shares.extend(compare(name, changes, &count)?);
    }
    std::fs::write(&figure, drawn(&shares).to_svg())?;
    println!("the shares are drawn in {figure}");
    Ok(())
}

/// Share of the cases that fall, of a stack in a view: the name, the share, and its 95 % interval.
type Share = (String, f64, Interval);

fn compare(stack: &str, own: &str, count: &str) -> Result<[Share; 3], Box<dyn Error>> {
    let variants = format!("imperfections.variants={count}");
    let mut changes: Vec<String> = COMMON.iter().map(|&change| change.to_owned()).collect();
    changes.push(variants);
    changes.extend(own.split('+').map(str::to_owned));
    let scenario = Scenario::builtin("demo-napa", &changes)?;
    let start = Instant::now();
    let across = in_plane(&scenario, View::Transverse, scenario.motion.clone())?;
    let other = other_component(&scenario.motion)?.ok_or("the record has one component")?;
    let along = in_plane(&scenario, View::Longitudinal, other)?;
    let planar = start.elapsed().as_secs_f64();
    let told = AtomicUsize::new(usize::MAX);
    let go_on = |done: usize, of: usize| {
        if done.is_multiple_of(20) && told.swap(done, Relaxed) != done {
            eprintln!("{stack}: {done} of {of}");
        }
        ControlFlow::Continue(())
    };
    let space = run_all(&scenario, &go_on)?;
    let spatial = start.elapsed().as_secs_f64() - planar;
    let results: Vec<CaseResult> = space.iter().map(|case| case.result.clone()).collect();
    let of = |way: &dyn Fn(&Heading) -> bool| {
        space[1..].iter().flat_map(|case| &case.debris).filter(|one| way(one)).count()
    };
    let [aside, on] = [of(&|way| way.is_across()), of(&|way| !way.is_across())];
    let shares = [
        row(stack, "across", &across[1..], "all / 0"),
        row(stack, "along", &along[1..], "0 / all"),
        row(stack, "in space", &results[1..], &format!("{aside} / {on}")),
    ];
    // Cases without a verdict in any of the views are left out of the comparison.
    let judged: Vec<_> = across
        .iter()
        .zip(&along)
        .zip(&results)
        .skip(1)
        .filter(|((a, b), c)| judged(a) && judged(b) && judged(c))
        .collect();
    let either: Vec<bool> = judged.iter().map(|((a, b), _)| falls(a) || falls(b)).collect();
    let really: Vec<bool> = judged.iter().map(|(_, c)| falls(c)).collect();
    let unjudged = space.len() - 1 - judged.len();
    let both = |plane: bool, space: bool| {
        either.iter().zip(&really).filter(|(a, b)| (**a, **b) == (plane, space)).count()
    };
    let firsts = |to: Heading| space[1..].iter().filter(|case| case.first == Some(to)).count();
    println!(
        "\n{stack}: a plane falls in {} of {}; of all cases {} fall in both views, {} in a plane alone, {} in space \
         alone, {} in neither, {unjudged} without a verdict in one of them; first body in space: {} right, {} left, {} away, {} near; {planar:.0} s for the planes, \
         {spatial:.0} s for space\n",
        either.iter().filter(|falls| **falls).count(),
        either.len(),
        both(true, true),
        both(true, false),
        both(false, true),
        both(false, false),
        firsts(Heading::Right),
        firsts(Heading::Left),
        firsts(Heading::Away),
        firsts(Heading::Near),
    );
    Ok(shares)
}

/// Returns a figure with every share as a dot in the bar of its interval, one below the other.
fn drawn(shares: &[Share]) -> Figure {
    let names = shares.iter().map(|(name, ..)| name.clone()).collect();
    let of = |place: usize, label: &str, x: Vec<f64>, style: SeriesStyle| {
        let y = vec![Axis::row(place); x.len()];
        Series { style, ..Series::new(if place == 0 { label } else { "" }, x, y) }
    };
    let bar = SeriesStyle { bar: true, muted: true, ..SeriesStyle::default() };
    let dot = SeriesStyle { points: true, index: Some(0), ..SeriesStyle::default() };
    let series = shares.iter().enumerate().flat_map(|(place, (_, share, interval))| {
        [
            of(place, "interval of 95 %", vec![interval.low, interval.high], bar),
            of(place, "share of variants that fall", vec![*share], dot),
        ]
    });
    let x = Axis { range: Some([0.0, 1.0]), ..Axis::new("share of variants that fall", "") };
    let plot = Plot { x, y: Axis::named(names), series: series.collect(), ..Plot::default() };
    let caption =
        "The same stacks, motions and imperfections across the barrels, along them, and in space.";
    Figure::new("shares", caption, plot)
}

/// Returns the results of the variants of a stack in a plane, under one component of the motion.
fn in_plane(
    scenario: &Scenario,
    view: View,
    motion: MotionSpec,
) -> Result<Vec<CaseResult>, Box<dyn Error>> {
    let mut plane = scenario.clone();
    plane.motion = motion;
    if let Scene::Stack { stack, .. } = &mut plane.scene {
        *stack = stack.in_plane(view);
    }
    let found = run(&planes(&plane)?, &|_, _| ControlFlow::Continue(()))?
        .ok_or("the variants were interrupted")?;
    Ok(found.into_iter().next().map(|one| one.results).unwrap_or_default())
}

fn falls(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Collapse { .. }))
}

fn judged(result: &CaseResult) -> bool {
    matches!(result.outcome, Ok(Outcome::Collapse { .. } | Outcome::Stable))
}

fn row(stack: &str, seen: &str, results: &[CaseResult], debris: &str) -> Share {
    let number = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    let all = number(results.iter().filter(|one| judged(one)).count());
    let fallen = number(results.iter().filter(|one| falls(one)).count());
    let interval = wilson(fallen, all, LEVEL);
    let (mut bodies, mut modes) = (BTreeMap::<&str, usize>::new(), BTreeMap::<&str, usize>::new());
    for result in results {
        if let Ok(Outcome::Collapse { first, mode, .. }) = &result.outcome {
            *bodies.entry(first).or_default() += 1;
            *modes.entry(mode.name()).or_default() += 1;
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let count = |one: &CaseResult| one.falls.iter().filter(|(_, at)| at.is_some()).count() as f64;
    let fell = || results.iter().filter(|one| falls(one));
    let first = median(fell().filter_map(|one| one.first_fall).collect());
    let barrels = median(fell().map(count).collect());
    let shown = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
    };
    println!(
        "| {stack} | {seen} | {fallen} of {all} | {:.0} % ({:.0} to {:.0}) | {} | {} | {} s | {} | {debris} |",
        100.0 * f64::from(fallen) / f64::from(all.max(1)),
        100.0 * interval.low,
        100.0 * interval.high,
        most(bodies),
        most(modes),
        shown(first, 1),
        shown(barrels, 0),
    );
    (format!("{stack}: {seen}"), f64::from(fallen) / f64::from(all.max(1)), interval)
}

/// Returns the most frequent names with their counts.
fn most(counts: BTreeMap<&str, usize>) -> String {
    let mut all: Vec<(&str, usize)> = counts.into_iter().collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let told = all.iter().take(4).map(|(name, count)| format!("{name} {count}"));
    let others: usize = all.iter().skip(4).map(|(_, count)| count).sum();
    let others = (others > 0).then(|| format!("others {others}"));
    told.chain(others).collect::<Vec<_>>().join(", ")
}
