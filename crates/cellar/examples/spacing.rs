//! Two rows of five stacks at several spacings under South Napa: which stacks fall by themselves, and which are knocked
//! over. Prints the page `validation/cellar-spacing.md`.
//!
//! ```sh
//! cargo run --release -p barrelstack-cellar --example spacing -- 32 > validation/cellar-spacing.md
//! ```
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "the page is the output")]

use std::ops::ControlFlow;

use barrelstack::variants::words::percent;
use barrelstack::variants::{LEVEL, RunChoice};
use barrelstack_cellar::summary::{CellarSummary, Mean};
use barrelstack_cellar::{Cellar, answer};
use barrelstack_fragility::wilson;

/// Free distances (m) between neighbors, in the rows and between them.
const SPACINGS: [f64; 3] = [0.05, 0.3, 1.0];

/// Time (s) after which the runs of a room end.
const END: f64 = 15.0;

/// Returns the room of two rows of five stacks, or of a single stack, which is followed until nothing moves.
fn room(rows: u32, stacks: u32, spacing: f64, variants: u32) -> String {
    let end =
        if rows * stacks == 1 { String::new() } else { format!("[run]\nduration = \"{END} s\"\n") };
    format!(
        r#"schema = 1
kind = "cellar"
extends = "demo-napa"
title = "{rows} rows of {stacks} stacks, {spacing} m apart"
[room]
length = "20 m"
width = "14 m"
walls = false
[[block]]
rows = {rows}
stacks = {stacks}
rows_together = 2
first = ["4 m", "5 m"]
spacing = "{spacing} m"
between_rows = "{spacing} m"
[record]
frame_rate = "1 Hz"
{end}[imperfections]
variants = {variants}
"#
    )
}

fn run(text: &str) -> Result<CellarSummary, Box<dyn std::error::Error>> {
    let cellar = Cellar::parse("spacing.toml", text.as_bytes(), &[])?;
    let mut done = 0;
    let found = answer(&cellar, RunChoice::Typical, &mut |reached| {
        if let barrelstack::variants::Advance::Variants { done: now, of } = reached
            && now > done
        {
            done = now;
            eprintln!("{}: {now} of {of}", cellar.title);
        }
        ControlFlow::Continue(())
    })?;
    Ok(found.summary)
}

/// Returns a share with its interval.
fn share(of: &Mean) -> String {
    let [low, high] = of.interval.map(percent);
    format!("{} ({low} to {high})", percent(of.mean))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let variants: u32 = std::env::args().nth(1).map_or(Ok(32), |text| text.parse())?;
    println!("# At which spacing do stacks no longer knock each other over?\n");
    println!(
        "Two rows of five stacks of the built-in scenario `demo-napa` (ten barrels on five levels, two-barrel racks) \
         are computed in three dimensions, without walls, under all three components of the record of Napa College \
         2014. The distance between neighboring stacks is the same within a row and between the rows. Each spacing \
         is computed with {variants} variants. In a variant, every stack has its own imperfections, and all stacks \
         share the unknown constants. A stack counts as knocked over if a body of another stack touched it before its \
         first loss of a seat. Shares are fractions of all stacks; their 95 % intervals are computed from the scatter \
         between the variants, since the stacks of a room share their constants and their motion.\n"
    );
    println!(
        "`cargo run --release -p barrelstack-cellar --example spacing -- {variants}` computes this page.\n"
    );
    println!(
        "| spacing | fall by themselves | knocked over | fall in total | fallen stacks per stack that falls by \
         itself | barrels fallen (median) |"
    );
    println!("|---|---|---|---|---|---|");
    let mut in_all = Vec::new();
    let mut line = |name: &str, summary: &CellarSummary| {
        let stacks = summary.plan.stacks as f64;
        let (own, other) = (summary.room.by_themselves, summary.room.knocked_over);
        println!(
            "| {name} | {} | {} | {} | {} | {:.0} of {} |",
            share(&summary.room.share_by_themselves),
            share(&summary.room.share_knocked_over),
            percent((own + other) / stacks),
            summary.room.spread.map_or("–".to_owned(), |spread| format!("{spread:.2}")),
            summary.room.barrels_fallen.p50,
            summary.plan.barrels,
        );
        in_all.push((own + other) / stacks);
    };
    let alone = run(&room(1, 1, 1.0, variants))?;
    line("a stack alone", &alone);
    let last = alone.stacks.iter().filter_map(|stack| stack.falls_at.as_ref()).map(|at| at.most);
    let last = last.reduce(f64::max);
    let mut free = None;
    for spacing in SPACINGS {
        let summary = run(&room(2, 5, spacing, variants))?;
        line(&format!("{spacing} m"), &summary);
        let knocked: u32 = summary.stacks.iter().map(|stack| stack.knocked_over.of_variants).sum();
        if knocked == 0 && free.is_none() {
            let runs = summary.counted * u32::try_from(summary.stacks.len())?;
            free = Some((spacing, runs));
        } else if knocked > 0 {
            free = None;
        }
    }
    println!();
    let [low, high] = [f64::min, f64::max].map(|of| in_all.iter().copied().fold(in_all[0], of));
    if high - low < 0.05 {
        println!(
            "Whether stacks stand alone or at any of these spacings, {} to {} of them fall. Under this motion, the \
             spacing decides whether a stack falls by itself or is knocked over, but not whether it falls.\n",
            percent(low),
            percent(high)
        );
    }
    if let Some(last) = last {
        println!(
            "The runs of a room end after {END} s. The stack alone is simulated until nothing moves. In all variants in \
             which it falls, it loses its first seat within the first {last:.1} s.\n"
        );
    }
    match free {
        Some((spacing, runs)) => {
            let high = wilson(0, runs, LEVEL).high;
            println!(
                "From a spacing of {spacing} m on, none of {runs} stacks is knocked over, so that at most {} of such \
                 stacks are (upper end of the 95 % interval, if stacks were independent).",
                percent(high)
            );
        }
        None => println!(
            "At each of these spacings some stacks are knocked over, even at {} m.",
            SPACINGS[SPACINGS.len() - 1]
        ),
    }
    Ok(())
}
