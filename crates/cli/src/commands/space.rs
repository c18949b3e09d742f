//! A stack in space, from file to verdict: what `run` does where a scenario looks at its stack there.

use std::process::ExitCode;
use std::time::Instant;

use anyhow::bail;
use barrelstack::Scenario;
use barrelstack::export::Folder;
use barrelstack::outcome::Outcome;
use barrelstack::variants::Asked;
use barrelstack::watch::Ending;
use barrelstack_space::{Answer, export, variants, words};

use crate::args::RunArgs;
use crate::printer;
use crate::progress::Progress;

/// Runs and reports.
pub(super) fn run(
    args: &RunArgs,
    scenario: &Scenario,
    asked: Asked,
    folder: Option<&Folder>,
) -> anyhow::Result<ExitCode> {
    for (given, option) in [
        (args.verify, "--verify"),
        (args.pdf, "--pdf"),
        (args.with_engine.is_some(), "--with-engine"),
    ] {
        if given {
            bail!(
                "{option} is known in a plane, not yet in space: leave it out{}",
                in_a_plane(scenario)
            );
        }
    }
    let start = Instant::now();
    let progress = Progress::new(!args.quiet);
    let mut answer = variants::answer(scenario, asked, &mut |told| progress.told_of(told))
        .map_err(|error| super::placed(error, scenario, &args.scenario))?;
    drop(progress);
    answer.summary.run.wall_seconds = Some(start.elapsed().as_secs_f64());
    // The verdict is printed even where it cannot be written.
    let written = folder.map_or(Ok(()), |folder| {
        crate::interrupt::writes_to(folder.path());
        let files = export::files(&answer, &scenario.to_resolved_toml());
        folder.put(&files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())))
    });
    if args.json {
        printer::document(&answer.summary)?;
    } else {
        printer::lines(lines(&answer))?;
        if let (Some(folder), Ok(())) = (folder, &written) {
            printer::lines(["", &format!("report: {}", folder.report().display())])?;
        }
        answer.run.warnings.iter().for_each(|text| printer::warning(text));
    }
    written?;
    Ok(if matches!(answer.run.outcome, Outcome::Invalid { .. }) {
        ExitCode::FAILURE
    } else if answer.run.ending == Ending::Interrupted {
        ExitCode::from(130)
    } else {
        ExitCode::SUCCESS
    })
}

/// The way to a plane, behind what is not known in space.
fn in_a_plane(scenario: &Scenario) -> &'static str {
    if scenario.stack().is_some() { ", or set stack.view to \"both\"" } else { "" }
}

/// The answer for people.
fn lines(answer: &Answer) -> Vec<String> {
    let Answer { run, summary, .. } = answer;
    let mut lines = vec![summary.title.clone(), format!("  {}", words::headline(run, summary))];
    lines
        .extend(words::sentences(run, summary).into_iter().map(|sentence| format!("  {sentence}")));
    lines.push(String::new());
    let rows = words::rows(run, summary);
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0) + 2;
    lines.extend(rows.into_iter().map(|(name, value)| format!("  {name:width$}{value}")));
    lines
}
