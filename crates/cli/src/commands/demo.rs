//! `barrelstack demo`: a first run for newcomers.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::export::Folder;

use crate::args::{DemoArgs, ScenarioArgs};
use crate::comparison::Command;
use crate::printer;

/// Name of the scenario.
const NAME: &str = "demo-napa";

/// Runs the demo scenario and summarizes the result in a few sentences.
pub(crate) fn demo(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let mut scenario = Scenario::builtin(NAME, &args.set)?;
    let selection = super::run::selected(&mut scenario, args.variants)?;
    let folder = Folder::prepare_again(&args.out)?;
    crate::interrupt::writes_to(folder.path());
    let typed = ScenarioArgs { scenario: NAME.to_owned(), set: args.set.clone(), record: None };
    let placed = |error| super::placed(error, &scenario, &typed);
    let mut answer = super::run::answered(&scenario, selection, true).map_err(placed)?;
    if !args.no_remedy {
        let command = Command::of(&typed, args.variants);
        super::run::remedied(&mut answer, &command, true).map_err(placed)?;
    }
    crate::interrupt::finished();
    // The verdict is printed even if the files cannot be written.
    let written = answer.files(args.language.of()).and_then(|files| folder.write_files(&files));
    printer::lines(answer.sentences())?;
    printer::lines(printer::side_by_side(&answer.summary()))?;
    printer::warnings(&answer);
    written?;
    let report = folder.report();
    printer::lines(["", &format!("Open {} in a browser to watch it.", report.display())])?;
    Ok(super::run::status(&answer))
}
