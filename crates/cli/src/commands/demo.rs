//! `barrelstack demo`: the first thing a newcomer sees.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::export::Folder;

use crate::args::DemoArgs;
use crate::printer;

/// Runs the demo scenario and says in a few sentences what happened.
pub(crate) fn demo(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let scenario = Scenario::builtin("demo-napa", &args.set)?;
    let folder = Folder::prepare(&args.out, true)?;
    let (run, summary) = super::run::watched(&scenario, true)?;
    folder.write(&run, &summary, None)?;
    printer::lines(barrelstack::report::sentences(&run, &summary))?;
    let report = folder.report();
    printer::lines(["", &format!("Open {} in a browser to watch it.", report.display())])?;
    printer::warnings(&summary);
    Ok(super::run::status(&run))
}
