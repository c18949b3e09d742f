//! `barrelstack score`: the RockScore of a rack or a device, on one sheet.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use barrelstack_campaign::score::{Protocol, ScoreError, Sheet, score};
use barrelstack_campaign::study::{RunOptions, StudyError};

use crate::args::ScenarioArgs;
use crate::commands::heights::page;
use crate::interrupt::{Stopped, keeps};
use crate::lanes::LanesArgs;
use crate::printer;
use crate::progress::Progress;
use crate::store::{store, writable};

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub(crate) struct ScoreArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Where to write the sheet and the studies behind it; run again to go on after a stop.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-score")]
    out: PathBuf,
    #[command(flatten)]
    lanes: LanesArgs,
    /// Print one JSON document in place of the table.
    #[arg(long)]
    json: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the protocol, writes the sheet, prints it.
pub(crate) fn run(args: &ScoreArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    writable(&args.out)?;
    keeps(format!(
        "what was run is kept in {}, the same command goes on from there",
        args.out.display()
    ));
    let progress = Progress::new(!args.quiet);
    let options = RunOptions { lanes: args.lanes.lanes, ..RunOptions::default() };
    let protocol = Protocol::rockscore();
    let tell = |done, of| progress.counted(done, of, "runs");
    let result = score(&scenario, &protocol, &args.out, &options, &tell);
    drop(progress);
    let sheet = match result {
        Err(ScoreError::Study(StudyError::Stopped)) => return Err(Stopped.into()),
        Err(ScoreError::Stack(failure)) => {
            return Err(super::placed(failure, &scenario, &args.scenario));
        }
        other => other?,
    };
    // The answer is printed even where it cannot be written.
    let written = write(&args.out, &sheet);
    if args.json {
        printer::document(&sheet.to_document())?;
    } else {
        print(&sheet)?;
        printer::lines(["", &format!("page: {}", args.out.join("index.html").display())])?;
    }
    sheet.document.warnings.iter().for_each(|warning| printer::warning(warning));
    written?;
    Ok(ExitCode::SUCCESS)
}

fn write(out: &Path, sheet: &Sheet) -> anyhow::Result<()> {
    let json = serde_json::to_string_pretty(&sheet.to_document())? + "\n";
    page(out, &sheet.html(), &sheet.markdown("figures"))?;
    store(&out.join("rockscore.json"), json.as_bytes())
}

fn print(sheet: &Sheet) -> anyhow::Result<()> {
    let verdict = &sheet.document.verdict;
    let mut lines = vec![verdict.headline.clone()];
    lines.extend(verdict.sentences.iter().map(|sentence| format!("  {sentence}")));
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
        lines.push(format!("  {:36}{:24}{}", row.state.name, row.view.words(), cells(&share)));
    }
    printer::lines(lines)
}
