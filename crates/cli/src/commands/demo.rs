//! `barrelstack demo`: the first thing a newcomer sees.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::export::Folder;
use barrelstack::variants::Shown;

use crate::args::DemoArgs;
use crate::printer;

/// Runs the demo scenario and says in a few sentences what happened.
pub(crate) fn demo(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let mut scenario = Scenario::builtin("demo-napa", &args.set)?;
    let asked = super::run::asked(&mut scenario, args.variants)?;
    let folder = Folder::prepare(&args.out, true)?;
    let answer = super::run::answered(&scenario, asked, true)?;
    folder.write(&answer, None)?;
    let Shown { run, summary, .. } = &answer.decides;
    printer::lines(barrelstack::report::sentences(run, summary))?;
    let report = folder.report();
    printer::lines(["", &format!("Open {} in a browser to watch it.", report.display())])?;
    printer::warnings(&answer);
    Ok(super::run::status(&answer))
}
