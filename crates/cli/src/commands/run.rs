//! `barrelstack run`: one scenario, from file to verdict.

use std::process::ExitCode;
use std::time::Instant;

use barrelstack::export::{ExportError, Folder};
use barrelstack::outcome::Outcome;
use barrelstack::verify::{Verification, verify};
use barrelstack::{Run, RunFailure, Scenario, Summary};
use barrelstack_report::Characters;

use crate::args::RunArgs;
use crate::printer;
use crate::progress::Progress;

/// Runs and reports.
pub(crate) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    // The folder is looked at before the work is done, not after.
    let folder = args.out.as_deref().map(|out| Folder::prepare(out, args.overwrite)).transpose()?;
    let (run, summary) = watched(&scenario, !args.quiet)
        .map_err(|error| super::placed(error, &scenario, &args.scenario))?;
    let verification = args
        .verify
        .then(|| repeated(&run, !args.quiet))
        .transpose()
        .map_err(|error| super::placed(error, &scenario, &args.scenario))?;
    // The verdict is printed even where it cannot be written.
    let written = folder.as_ref().map_or(Ok::<(), ExportError>(()), |folder| {
        crate::interrupt::writes_to(folder.path());
        folder.write(&run, &summary, verification.as_ref())?;
        if args.pdf {
            folder.write_pdf(&run, &summary, verification.as_ref(), args.paper.into())?;
        }
        Ok(())
    });
    if args.json {
        printer::document(&Summary { verification, ..summary })?;
    } else {
        let characters = if args.plain { Characters::Ascii } else { Characters::Unicode };
        printer::summary(&run, &summary, &args.scenario.set, characters)?;
        if let Some(verification) = &verification {
            printer::verification(verification)?;
        }
        if let (Some(folder), Ok(())) = (&folder, &written) {
            let paper = if args.pdf { ", and report.pdf beside it" } else { "" };
            printer::lines(["", &format!("report: {}{paper}", folder.report().display())])?;
        }
        printer::warnings(&summary);
    }
    written?;
    Ok(status(&run))
}

/// Runs a scenario with a progress bar and Ctrl-C.
pub(super) fn watched(scenario: &Scenario, show: bool) -> Result<(Run, Summary), RunFailure> {
    let start = Instant::now();
    let progress = Progress::new(show);
    let run = scenario.run_watched(&mut |reached| progress.at(reached))?;
    let summary = Summary::of(&run, Some(start.elapsed().as_secs_f64()));
    Ok((run, summary))
}

/// Repeats a run with a progress bar and Ctrl-C.
fn repeated(run: &Run, show: bool) -> Result<Verification, RunFailure> {
    let progress = Progress::new(show);
    verify(run, &mut |reached| progress.at(reached))
}

/// The exit status of a run, as the help of the program lists them.
pub(super) fn status(run: &Run) -> ExitCode {
    if matches!(run.outcome, Outcome::Invalid { .. }) {
        ExitCode::FAILURE
    } else if run.interrupted {
        ExitCode::from(130)
    } else {
        ExitCode::SUCCESS
    }
}
