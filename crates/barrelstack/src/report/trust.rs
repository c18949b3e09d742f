//! Reliability of a run, from repeats with small changes.

use barrelstack_report::{Block, Cell, Table};

use crate::verify::{Repeat, Verification};

/// Builds the report section on the reliability of a run, from a comparison of the run with its repeats.
pub fn trust(found: &Verification) -> Vec<Block> {
    let mut blocks: Vec<Block> = found.sentences().into_iter().map(Block::Paragraph).collect();
    let table = Table::of(
        "Repeats of this run, each with one change. Falls are compared up to the time at which \
         the first repeat departs from the run.",
        &found.repeats,
        &[
            ("change", "", &|repeat| Cell::text(&repeat.change)),
            ("outcome", "", &|repeat| Cell::text(outcome(repeat))),
            ("first body", "", &|repeat| Cell::maybe(repeat.outcome.first.as_ref())),
            ("gives way", "s", &|repeat| Cell::number(repeat.outcome.time, 4)),
            ("departs from the run", "s", &|repeat| Cell::number(repeat.apart_at, 4)),
            ("falls differ by", "ms", &|repeat| {
                Cell::number(repeat.fall_difference.map(|seconds| 1e3 * seconds), 4)
            }),
        ],
    );
    if !table.rows.is_empty() {
        blocks.push(Block::Table(table));
    }
    let skipped: Vec<String> = found
        .skipped
        .iter()
        .map(|one| format!("Repeat without a result: {} ({}).", one.change, one.reason))
        .collect();
    if !skipped.is_empty() {
        blocks.push(Block::List(skipped));
    }
    blocks
}

fn outcome(repeat: &Repeat) -> String {
    let same = if repeat.same_outcome { "the same" } else { "another" };
    let by = repeat.outcome.mode.map(|mode| format!(" by {mode}")).unwrap_or_default();
    format!("{same}: {}{by}", repeat.outcome.kind)
}
