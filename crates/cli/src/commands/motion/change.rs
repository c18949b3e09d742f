//! `barrelstack motion convert`, and what every command that writes a motion prints.

use barrelstack_motion::Record;

use super::info;
use super::input::{Choice, Input};
use super::measures::{self, USUAL};
use super::output::{Output, Target};
use crate::printer;

/// Arguments of `convert`.
#[derive(Debug, clap::Args)]
pub(super) struct ConvertArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    output: Output,
}

/// Reads, chooses, writes.
pub(super) fn convert(args: &ConvertArgs) -> anyhow::Result<()> {
    let target = args.output.prepare()?;
    let read = args.input.read()?;
    let chosen = args.choice.take(&read)?;
    let columns: Vec<_> = chosen.channels.iter().map(|c| (c.name.clone(), c)).collect();
    let table = measures::table(&columns, &USUAL.iter().collect::<Vec<_>>())?;
    finish(&target, &read, &chosen, table.lines())
}

/// Writes a motion, then prints what was done to it, its measures and where it is.
///
/// Nothing is printed that was not written.
pub(super) fn finish(
    target: &Target,
    read: &Record,
    made: &Record,
    measures: Vec<String>,
) -> anyhow::Result<()> {
    let losses = target.write(made)?;
    let mut lines: Vec<String> = made.notes.clone();
    lines.push(String::new());
    lines.extend(measures);
    lines.push(String::new());
    lines.push(target.sentence());
    printer::lines(lines)?;
    // A motion that was processed here is raw no more.
    info::warn(&Record { stage: made.stage, ..read.clone() });
    for loss in losses {
        printer::warning(&loss);
    }
    Ok(())
}
