//! `barrelstack run`: one scenario, from file to verdict.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{anyhow, bail};
use barrelstack::compare::Comparable as _;
use barrelstack::export::Folder;
use barrelstack::scenario::Scene;
use barrelstack::variants::RunChoice;
use barrelstack::{RunFailure, Scenario};
use barrelstack_input::system;
use barrelstack_report::Characters;
use barrelstack_space::AnyAnswer;

use super::Loaded;
use crate::args::{RunArgs, VariantArgs};
use crate::comparison::Command;
use crate::printer;
use crate::progress::Progress;

/// Maximum size (bytes) of the HTML page that is embedded in the report. The page contains the version of the program
/// that runs in the browser.
const PAGE_LIMIT: usize = 64 << 20;

/// Runs the scenario and prints and writes the result.
pub(crate) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let mut scenario = match super::load_any(&args.scenario)? {
        Loaded::Scenario(scenario) => scenario,
        Loaded::Cellar(cellar) => return super::cellar::run(args, *cellar, &|_| None),
    };
    if args.keep.is_some() {
        bail!(
            "--keep applies only to the variants of a cellar; leave --keep out for a single stack"
        );
    }
    if args.state.is_some() {
        bail!(
            "--state: only the run of a cellar can be continued; leave --state out for one stack"
        );
    }
    let selection = selected(&mut scenario, args.variants)?;
    args.tables.need(args.out.is_some())?;
    // The folder is checked before the computation starts.
    let folder = args.out.as_deref().map(|out| Folder::prepare(out, args.overwrite)).transpose()?;
    if scenario.is_spatial() && args.with_engine.is_some() {
        bail!(
            "--with-engine: the program inside that HTML file simulates planar scenarios, but not three-dimensional ones; \
             leave this option out{}",
            if scenario.stack().is_some() { ", or set stack.view to \"both\"" } else { "" }
        );
    }
    let engine = args.with_engine.as_deref().map(engine).transpose()?;
    let placed = |error| super::placed(error, &scenario, &args.scenario);
    let mut answer = answered(&scenario, selection, !args.quiet).map_err(placed)?;
    if !args.no_remedy {
        let command = Command::of(&args.scenario, args.variants);
        remedied(&mut answer, &command, !args.quiet).map_err(placed)?;
    }
    if args.verify {
        let progress = Progress::new(!args.quiet);
        answer.verify(&mut |reached| progress.at(reached)).map_err(placed)?;
    }
    crate::interrupt::finished();
    // The verdict is printed even if the files cannot be written.
    let written = folder.as_ref().map_or(Ok::<(), anyhow::Error>(()), |folder| {
        crate::interrupt::writes_to(folder.path());
        folder.write_files(&args.tables.of(answer.files(args.language.of())?)?)?;
        let document = || args.language.page(&answer.document());
        if let Some(engine) = &engine {
            folder.write_with_engine(&document(), answer.scenario(), engine)?;
        }
        if args.pdf {
            folder.write_pdf(&document(), args.paper.into())?;
        }
        Ok(())
    });
    if args.json {
        printer::document(&answer.summary())?;
    } else {
        let characters = if args.plain { Characters::Ascii } else { Characters::Unicode };
        printer::answer(&answer, &args.scenario.set, characters)?;
        if let Some(verification) = answer.verification() {
            printer::verification(verification)?;
        }
        if let (Some(folder), Ok(())) = (&folder, &written) {
            let paper = if args.pdf { ", and report.pdf beside it" } else { "" };
            printer::lines(["", &format!("report: {}{paper}", folder.report().display())])?;
        }
        printer::warnings(&answer);
    }
    written?;
    Ok(status(&answer))
}

/// Reads the HTML page that is embedded in the report; an error if the page does not contain the version of the
/// program that runs in the browser.
fn engine(path: &Path) -> anyhow::Result<String> {
    let page = system::read(path, PAGE_LIMIT)
        .and_then(|bytes| String::from_utf8(bytes).map_err(|_| "it is not text".to_owned()))
        .map_err(|reason| {
            anyhow!(
                "cannot read {}: {reason}; correct the path after --with-engine",
                path.display()
            )
        })?;
    if !page.contains("<script type=\"text/plain\" id=\"engine\">") {
        bail!(
            "{} does not contain the program: use the barrelstack.html of a release, or make one with `cargo xtask \
             web`",
            path.display()
        );
    }
    Ok(page)
}

/// Returns the run to show, and sets the number of variants as requested.
pub(super) fn selected(scenario: &mut Scenario, args: VariantArgs) -> anyhow::Result<RunChoice> {
    let count = match &mut scenario.scene {
        Scene::Stack { imperfections, .. } => {
            imperfections.variants = args.variants.unwrap_or(imperfections.variants);
            imperfections.variants
        }
        Scene::Free(_) | Scene::Spatial(_)
            if args.variants.is_some_and(|variants| variants > 0) =>
        {
            bail!("--variants: a free scene has no variants, because it states no imperfections");
        }
        Scene::Free(_) | Scene::Spatial(_) => 0,
    };
    match args.variant {
        Some(number) if number > count => bail!(
            "--variant {number}: variants are numbered from 1 to {count}, and 0 is the stack as stated; add --variants \
             {number} to run {number} variants"
        ),
        Some(number) => Ok(RunChoice::Number(number)),
        None => Ok(RunChoice::Typical),
    }
}

/// Runs a scenario and its variants with a progress bar; Ctrl-C stops the work.
pub(super) fn answered(
    scenario: &Scenario,
    selection: RunChoice,
    show: bool,
) -> Result<AnyAnswer, RunFailure> {
    let start = Instant::now();
    let progress = Progress::new(show);
    let mut answer = AnyAnswer::of(scenario, selection, &mut |reached| progress.advance(reached))?;
    answer.set_wall_seconds(start.elapsed().as_secs_f64());
    Ok(answer)
}

/// Searches for the smallest change that keeps the stack up (the remedy), with a progress bar; Ctrl-C stops the search.
pub(super) fn remedied(
    answer: &mut AnyAnswer,
    command: &Command<'_>,
    show: bool,
) -> Result<(), RunFailure> {
    let progress = Progress::new(show);
    let mut found = answer.remedy(&|attempt| progress.tried(attempt))?;
    if let Some(found) = &mut found {
        found.comparison = command.against(found);
    }
    answer.set_remedy(found);
    Ok(())
}

/// Returns the exit status of a run: failure if the computation failed, otherwise success.
pub(super) fn status(answer: &AnyAnswer) -> ExitCode {
    super::status(answer.is_invalid())
}
