//! `barrelstack demo`: a first run for newcomers.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::export::Folder;

use crate::args::{DemoArgs, ScenarioArgs};
use crate::comparison::Command;
use crate::printer;

/// Name of the scenario.
const NAME: &str = "demo-napa";

/// Changes of the scenario: the demo shows the stack in space, with fewer variants than a run, since a variant in space
/// takes several times as long as one in a plane.
const IN_SPACE: [&str; 2] = ["stack.view=spatial", "imperfections.variants=16"];

/// Runs the demo scenario and summarizes the result in a few sentences.
pub(crate) fn demo(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let path = |change: &str| change.split('=').next().unwrap_or_default().trim().to_owned();
    // A view that is given has the variants of a run.
    let chosen = args.set.iter().any(|given| path(given) == path(IN_SPACE[0]));
    let own = IN_SPACE
        .iter()
        .filter(|own| !chosen && args.set.iter().all(|given| path(given) != path(own)));
    let set: Vec<String> = own.map(|&own| own.to_owned()).chain(args.set.clone()).collect();
    let mut scenario = Scenario::builtin(NAME, &set)?;
    let selection = super::run::selected(&mut scenario, args.variants)?;
    let folder = Folder::prepare_again(&args.out)?;
    crate::interrupt::writes_to(folder.path());
    let typed = ScenarioArgs { scenario: NAME.to_owned(), set, record: None };
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
