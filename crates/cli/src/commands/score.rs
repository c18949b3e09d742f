//! `barrelstack score`: the RockScore of a rack or a device, on one sheet.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use barrelstack_campaign::score::{Protocol, ScoreError, Sheet, score};

use super::page::{PageArgs, of_option};
use crate::args::ScenarioArgs;
use crate::printer;

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub(crate) struct ScoreArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Folder for the sheet and its studies; run the command again to continue after a stop.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-score")]
    out: PathBuf,
    #[command(flatten)]
    page: PageArgs,
}

/// Runs the protocol, writes the sheet, and prints it.
pub(crate) fn run(args: &ScoreArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    if args.scenario.record.is_some() {
        bail!(
            "--record: a score uses only the motions of its protocol, which are the same for all racks; \
             leave it out"
        );
    }
    let (options, progress) = args.page.begin(&args.out)?;
    let protocol = Protocol::rockscore();
    let report = |done, of| progress.counted(done, of, "runs");
    let result = score(&scenario, &protocol, &args.out, &options, &report);
    drop(progress);
    let sheet = match result {
        Err(ScoreError::Study(error)) => return Err(of_option(error, "", &args.out)),
        Err(ScoreError::Stack(failure)) => {
            return Err(super::placed(failure, &scenario, &args.scenario));
        }
        other => other?,
    };
    let file = (args.out.as_path(), "rockscore.json");
    args.page.end(
        file,
        &sheet.document,
        &sheet.to_document(),
        lines(&sheet),
        &sheet.document.warnings,
    )
}

/// Returns the table as text.
fn lines(sheet: &Sheet) -> Vec<String> {
    let mut lines = printer::verdict(&sheet.document.verdict);
    let velocities = &sheet.protocol.velocities;
    let cells = |of: &dyn Fn(f64) -> String| {
        let cells: Vec<String> = velocities.iter().map(|at| format!("{:>7}", of(*at))).collect();
        cells.concat()
    };
    lines.push(String::new());
    let heads = cells(&|velocity| format!("{:.0}", 100.0 * velocity));
    lines.push(format!("  {:36}{:24}{heads}", "% collapsed at cm/s", "shaken"));
    for row in &sheet.rows {
        let share = |velocity| {
            let stripe = row.at(velocity);
            stripe.map_or_else(String::new, |stripe| format!("{:.0}", 100.0 * stripe.fraction()))
        };
        lines.push(format!("  {:36}{:24}{}", row.state.name, row.direction.words(), cells(&share)));
    }
    lines
}
