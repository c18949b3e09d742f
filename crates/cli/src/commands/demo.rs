//! `barrelstack demo`: the first thing a newcomer sees.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::export::Folder;

use crate::args::DemoArgs;
use crate::printer;

/// Runs the demo scenario and says in three sentences what happened.
pub(crate) fn demo(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let scenario = Scenario::builtin("demo-napa", &args.set)?;
    let folder = Folder::prepare(&args.out, true)?;
    let (run, summary) = super::run::watched(&scenario, true)?;
    folder.write(&run, &summary)?;
    for sentence in barrelstack::report::sentences(&run, &summary) {
        printer::line(&sentence);
    }
    printer::line(&format!("\nOpen {} in a browser to watch it.", folder.report().display()));
    Ok(if run.interrupted { ExitCode::from(130) } else { ExitCode::SUCCESS })
}
