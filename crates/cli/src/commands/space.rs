//! Stacks and free scenes in space: the commands `run` and `render`.

use std::process::ExitCode;
use std::time::Instant;

use anyhow::bail;
use barrelstack::export::Folder;
use barrelstack::outcome::Outcome;
use barrelstack::render::{Part, RenderFolder};
use barrelstack::variants::{Remedy, RunChoice};
use barrelstack::{RunFailure, Scenario};
use barrelstack_report::paraview_of_solids;
use barrelstack_space::mesh::solids;
use barrelstack_space::{Answer, export, variants, words};

use super::render::RenderArgs;
use crate::args::RunArgs;
use crate::printer;
use crate::progress::Progress;

/// Runs the scenario and prints and writes the result.
pub(super) fn run(
    args: &RunArgs,
    scenario: &Scenario,
    selection: RunChoice,
    folder: Option<&Folder>,
) -> anyhow::Result<ExitCode> {
    for (given, option) in [
        (args.verify, "--verify"),
        (args.pdf, "--pdf"),
        (args.with_engine.is_some(), "--with-engine"),
    ] {
        if given {
            bail!(
                "{option} is available for planar models, but not in space: leave it out{}",
                in_a_plane(scenario)
            );
        }
    }
    let placed = |error| super::placed(error, scenario, &args.scenario);
    let mut answer = answered(scenario, selection, !args.quiet).map_err(placed)?;
    if !args.no_remedy {
        let progress = Progress::new(!args.quiet);
        let found = variants::remedy(&answer, &|done| {
            progress.searched(done as u64, "runs of changed stacks")
        });
        answer.summary.remedy = found.map_err(|error| placed(error.into()))?;
    }
    crate::interrupt::finished();
    // The verdict is printed even if the files cannot be written.
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
    Ok(status(&answer))
}

/// Runs the scenario and writes the ParaView series.
pub(super) fn render(
    args: &RenderArgs,
    scenario: &Scenario,
    selection: RunChoice,
) -> anyhow::Result<ExitCode> {
    if let Some(part) = args.lacking_in_space() {
        bail!(
            "--only {}: runs in space have only the ParaView series, and `run --out` writes their page; use --only \
             paraview{}",
            part.name(),
            in_a_plane(scenario)
        );
    }
    let between = args.between()?.unwrap_or([0.0, f64::INFINITY]);
    let folder = RenderFolder::prepare(&args.out, &[Part::Paraview], args.overwrite)?;
    crate::interrupt::writes_to(&args.out.join(Part::Paraview.place()));
    crate::interrupt::writes_to(&args.out);
    let answer = answered(scenario, selection, !args.quiet)
        .map_err(|error| super::placed(error, scenario, &args.scenario))?;
    let end = answer.run.end_time;
    if between[0] > end {
        bail!("the run ends at {end:.2} s, so there is nothing to render after {} s", between[0]);
    }
    let solids = solids(&answer.run, between);
    let written = folder.write_paraview(|put| paraview_of_solids(&solids, args.rate, put))?;
    printer::lines([format!("{}: {} files", written.place.display(), written.files)])?;
    answer.run.warnings.iter().for_each(|text| printer::warning(text));
    Ok(status(&answer))
}

/// Runs a scenario and its variants with a progress bar; Ctrl-C stops the work.
fn answered(scenario: &Scenario, selection: RunChoice, show: bool) -> Result<Answer, RunFailure> {
    let start = Instant::now();
    let progress = Progress::new(show);
    let mut answer =
        variants::answer(scenario, selection, &mut |reached| progress.advance(reached))?;
    answer.summary.run.wall_seconds = Some(start.elapsed().as_secs_f64());
    Ok(answer)
}

/// Returns the exit status of a run, as listed in the help.
fn status(answer: &Answer) -> ExitCode {
    super::status(matches!(answer.run.outcome, Outcome::Invalid { .. }))
}

/// Returns a hint about the planar analysis, to be appended to a refusal in space.
fn in_a_plane(scenario: &Scenario) -> &'static str {
    if scenario.stack().is_some() { ", or set stack.view to \"both\"" } else { "" }
}

/// Returns the answer as text.
fn lines(answer: &Answer) -> Vec<String> {
    let Answer { run, summary, .. } = answer;
    let mut lines = vec![summary.title.clone(), format!("  {}", words::headline(run, summary))];
    let advice = summary.remedy.as_ref().map(Remedy::sentence);
    let sentences = advice.into_iter().chain(words::sentences(run, summary));
    lines.extend(sentences.map(|sentence| format!("  {sentence}")));
    lines.push(String::new());
    let rows = words::rows(run, summary);
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0) + 2;
    lines.extend(rows.into_iter().map(|(name, value)| format!("  {name:width$}{value}")));
    lines
}
