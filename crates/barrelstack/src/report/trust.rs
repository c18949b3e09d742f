//! How far a run can be trusted, where repeats of it were made.

use barrelstack_report::{Block, Cell, Table};

use crate::verify::{Repeat, Verification};

/// The section of a verification.
pub(super) fn trust(found: &Verification) -> Vec<Block> {
    let mut blocks: Vec<Block> = found.sentences().into_iter().map(Block::Paragraph).collect();
    let mut table = Table::new(
        "Repeats of this run, each with one change. Falls are compared until the first repeat parts \
         from the run.",
        &[
            ("change", ""),
            ("outcome", ""),
            ("first body", ""),
            ("gives way", "s"),
            ("parts from the run", "s"),
            ("falls differ by", "ms"),
        ],
    );
    table.rows.extend(found.repeats.iter().map(row));
    if !table.rows.is_empty() {
        blocks.push(Block::Table(table));
    }
    let skipped: Vec<String> = found
        .skipped
        .iter()
        .map(|one| format!("Not repeated, {}: {}.", one.change, one.reason))
        .collect();
    if !skipped.is_empty() {
        blocks.push(Block::List(skipped));
    }
    blocks
}

fn row(repeat: &Repeat) -> Vec<Cell> {
    let optional = |value: Option<f64>| value.map_or(Cell::Missing, |v| Cell::Number(v, 4));
    let outcome = &repeat.outcome;
    let same = if repeat.same_outcome { "the same" } else { "another" };
    let what =
        outcome.mode.map_or(outcome.kind.to_owned(), |mode| format!("{} by {mode}", outcome.kind));
    vec![
        Cell::text(&repeat.change),
        Cell::text(format!("{same}: {what}")),
        outcome.first.as_ref().map_or(Cell::Missing, Cell::text),
        optional(outcome.time),
        optional(repeat.apart_at),
        optional(repeat.fall_difference.map(|seconds| 1e3 * seconds)),
    ]
}
