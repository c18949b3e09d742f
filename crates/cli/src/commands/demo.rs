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
    let set = in_space(&args.set);
    let mut scenario = Scenario::builtin(NAME, &set)?;
    let selection = super::run::selected(&mut scenario, args.variants)?;
    let folder = Folder::prepare_again(&args.out)?;
    crate::interrupt::writes_to(folder.path());
    let typed = ScenarioArgs { scenario: NAME.to_owned(), set, record: None };
    let placed = |error| super::placed(error, &scenario, &typed);
    let mut answer = super::run::answered(&scenario, selection, true).map_err(placed)?;
    if !args.no_remedy && !answer.is_stopped() {
        // The search takes several times as long as the runs, so a page without its result is written first.
        printer::note(&answer.headline());
        answer.files(args.language.of()).and_then(|files| folder.write_files(&files))?;
        let shows = format!("{} shows the result so far", folder.report().display());
        printer::note(&format!(
            "{shows}; if the stack falls, the program now searches for changes that would keep it up"
        ));
        crate::interrupt::keeps(shows);
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

/// Returns the given changes, preceded by the changes of the demo.
///
/// Unless a given change sets `stack.view`, the demo is three-dimensional. It then has fewer variants than other runs,
/// unless a given change sets their number, because a three-dimensional variant takes several times as long as one in
/// a plane.
fn in_space(given: &[String]) -> Vec<String> {
    let states =
        |path: &str| given.iter().any(|one| one.split('=').next().map(str::trim) == Some(path));
    let mut set = Vec::new();
    if !states("stack.view") {
        set.push("stack.view=spatial".to_owned());
        if !states("imperfections.variants") {
            set.push("imperfections.variants=16".to_owned());
        }
    }
    set.extend_from_slice(given);
    set
}

#[cfg(test)]
mod tests {
    use super::in_space;

    #[test]
    fn a_given_view_or_number_of_variants_replaces_that_of_the_demo() {
        let set =
            |given: &[&str]| in_space(&given.iter().map(|&one| one.to_owned()).collect::<Vec<_>>());
        assert_eq!(set(&[]), ["stack.view=spatial", "imperfections.variants=16"]);
        assert_eq!(set(&["stack.view = both"]), ["stack.view = both"]);
        let few = "imperfections.variants=4";
        assert_eq!(set(&[few, "stack.levels=3"]), ["stack.view=spatial", few, "stack.levels=3"]);
    }
}
