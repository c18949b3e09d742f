//! `barrelstack run`: one scenario, from file to verdict.

use std::process::ExitCode;
use std::time::Instant;

use barrelstack::export::Folder;
use barrelstack::{Run, Scenario, Summary};

use crate::args::RunArgs;
use crate::printer;
use crate::progress::Progress;

/// Runs and reports.
pub(crate) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    // The folder is looked at before the work is done, not after.
    let folder = args.out.as_deref().map(|out| Folder::prepare(out, args.overwrite)).transpose()?;
    let (run, summary) = watched(&scenario, !args.quiet && !args.json)?;
    if let Some(folder) = &folder {
        folder.write(&run, &summary)?;
    }
    if args.json {
        printer::line(&summary.to_json());
    } else {
        printer::summary(&run, &summary);
        if let Some(folder) = &folder {
            printer::line(&format!("\nreport: {}", folder.report().display()));
        }
    }
    Ok(if run.interrupted { ExitCode::from(130) } else { ExitCode::SUCCESS })
}

/// Runs a scenario with a progress bar and Ctrl-C.
pub(super) fn watched(scenario: &Scenario, show: bool) -> anyhow::Result<(Run, Summary)> {
    let start = Instant::now();
    let mut progress = Progress::new(show);
    let run = barrelstack::run(scenario, &mut |time| progress.at(time))?;
    progress.done();
    let summary = Summary::of(&run, Some(start.elapsed().as_secs_f64()));
    Ok((run, summary))
}
