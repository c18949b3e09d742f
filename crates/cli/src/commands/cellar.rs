//! `barrelstack check` and `barrelstack run` for a cellar: the plan of the room, and the result of all variants.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context as _, bail};
use barrelstack::export::Folder;
use barrelstack::variants::RunChoice;
use barrelstack_cellar::kept::Part;
use barrelstack_cellar::{
    Answer, Cellar, CellarFailure, Plan, Prepared, RoomFailure, report, words,
};
use barrelstack_report::{Characters, Figure};

use crate::args::{CheckArgs, PartName, RunArgs, ScenarioArgs, VariantArgs};
use crate::printer;
use crate::progress::Progress;

/// Prints the plan of a cellar, and the problems found in the plan.
pub(crate) fn check(args: &CheckArgs, cellar: &Cellar) -> anyhow::Result<ExitCode> {
    if args.table {
        bail!("--table is for a single stack; leave --table out for a cellar");
    }
    let plan = Plan::of(cellar).map_err(|error| placed(error.into(), cellar, &args.scenario))?;
    if let Some(path) = &args.plan {
        let picture = Figure::new("plan", plan.summary.title.clone(), plan.picture(cellar));
        is_new(path, "--plan")?;
        crate::store::store(path, picture.to_svg().as_bytes())?;
    }
    if args.json {
        printer::document(&plan.summary)?;
    } else {
        let mut lines = vec![plan.summary.title.clone()];
        lines.extend(plan.picture(cellar).lines(Characters::Unicode));
        lines.extend(plan.summary.sentences());
        lines.extend(plan.summary.findings.iter().map(|finding| format!("Note: {finding}.")));
        printer::lines(lines)?;
    }
    let mut problems = plan.problems.into_iter().map(|(error, _)| error);
    let Some(first) = problems.next() else {
        if !cellar.start.is_as_built() {
            let started = Prepared::new(cellar).and_then(|prepared| prepared.check_start());
            started.map_err(|error| placed(error, cellar, &args.scenario))?;
        }
        if !args.json {
            stands(cellar, &args.scenario)?;
        }
        return Ok(ExitCode::SUCCESS);
    };
    // The first problem is the error of the command; the others are printed before it.
    problems.for_each(|error| printer::note(&format!("error: {}", error.sentence())));
    Err(first.into())
}

/// Lets a stack of each number of levels settle without the motion, and prints its state at rest.
fn stands(cellar: &Cellar, args: &ScenarioArgs) -> anyhow::Result<()> {
    for model in &cellar.models {
        let found =
            barrelstack_space::check(model).map_err(|error| placed(error.into(), cellar, args))?;
        let heading = match model.stack() {
            Some(stack) if cellar.models.len() > 1 => {
                format!("a stack of {} levels:", stack.levels)
            }
            _ => "each stack:".to_owned(),
        };
        printer::lines([heading])?;
        printer::lines(found.lines())?;
    }
    Ok(())
}

/// Returns an error if a file exists. The error suggests a different value of `option`.
fn is_new(path: &Path, option: &str) -> anyhow::Result<()> {
    // A dangling link exists, too.
    if path.symlink_metadata().is_ok() {
        bail!("{} exists; give another name after {option}", path.display());
    }
    Ok(())
}

/// Runs a cellar, then prints and writes the result.
///
/// If the result is printed as text, the sentence that `first` returns is printed before it; `None` for no sentence.
pub(super) fn run(
    args: &RunArgs,
    cellar: Cellar,
    first: &dyn Fn(&Answer) -> Option<String>,
) -> anyhow::Result<ExitCode> {
    for (given, option, reason) in [
        (
            args.with_engine.is_some(),
            "--with-engine",
            "the program inside that HTML file simulates only single stacks",
        ),
        (args.verify, "--verify", "only the run of a single stack can be repeated as a check"),
    ] {
        if given {
            bail!("{option}: {reason}; leave {option} out for a cellar");
        }
    }
    let (cellar, choice) = selected(cellar, args.variants)?;
    if let (Some(PartName(part)), Some(keep)) = (args.part, &args.keep) {
        args.tables.need(false)?;
        return run_part(args, &cellar, part, keep);
    }
    args.tables.need(args.out.is_some())?;
    let folder = args.out.as_deref().map(|out| Folder::prepare(out, args.overwrite)).transpose()?;
    if let Some(path) = &args.state {
        is_new(path, "--state")?;
    }
    let start = Instant::now();
    let progress = Progress::new(!args.quiet);
    let answer =
        barrelstack_cellar::answer_with(&cellar, choice, args.keep.as_deref(), &mut |reached| {
            progress.advance(reached)
        });
    drop(progress);
    let mut answer = answer.map_err(|error| placed(error, &cellar, &args.scenario))?;
    answer.summary.wall_seconds = Some(start.elapsed().as_secs_f64());
    crate::interrupt::finished();
    // The verdict is printed even if the files cannot be written.
    let written = folder.as_ref().map_or(Ok::<(), anyhow::Error>(()), |folder| {
        crate::interrupt::writes_to(folder.path());
        let files = answer.files(args.language.of()).context("cannot write the summary")?;
        folder.write_files(&args.tables.of(files)?)?;
        if args.pdf {
            let document = args.language.page(&report::document(&answer));
            folder.write_pdf(&document, args.paper.into())?;
        }
        Ok(())
    });
    let written = written.and_then(|()| match &args.state {
        Some(path) if !answer.is_stopped() && !answer.is_invalid() => {
            crate::store::store(path, answer.state().as_bytes())
        }
        Some(path) => {
            let reason = if answer.is_stopped() { "was stopped" } else { "has no valid result" };
            printer::warning(&format!(
                "{} is not written: the run that is shown {reason}",
                path.display()
            ));
            Ok(())
        }
        None => Ok(()),
    });
    if args.json {
        printer::document(&answer.summary)?;
    } else {
        printer::lines(first(&answer))?;
        let characters = if args.plain { Characters::Ascii } else { Characters::Unicode };
        printed(&answer, characters)?;
        if let (Some(folder), Ok(())) = (&folder, &written) {
            let paper = if args.pdf { ", and report.pdf beside it" } else { "" };
            printer::lines(["", &format!("report: {}{paper}", folder.report().display())])?;
        }
        answer.summary.warnings.iter().for_each(|warning| printer::warning(warning));
    }
    written?;
    Ok(super::status(answer.is_invalid()))
}

/// Runs one part of the variants of a cellar, and stores their results in the folder `keep`.
fn run_part(args: &RunArgs, cellar: &Cellar, part: Part, keep: &Path) -> anyhow::Result<ExitCode> {
    let progress = Progress::new(!args.quiet);
    let found =
        barrelstack_cellar::run_part(cellar, part, keep, &mut |reached| progress.advance(reached));
    drop(progress);
    let [done, failed, of] = found.map_err(|error| placed(error, cellar, &args.scenario))?;
    crate::interrupt::finished();
    let Part { part, of: parts } = part;
    printer::lines([format!(
        "part {part} of {parts}: {done} of {of} variants are in {}; when all parts are done, run the same command \
         without --part to combine them",
        keep.display()
    )])?;
    if failed > 0 {
        printer::warning(&format!(
            "{failed} of the {of} variants failed, and their results are not kept: the command that combines the parts \
             runs these variants again, and omits a variant that fails again"
        ));
    }
    Ok(ExitCode::SUCCESS)
}

fn printed(answer: &Answer, characters: Characters) -> anyhow::Result<()> {
    let summary = &answer.summary;
    let mut lines = vec![summary.title.clone(), format!("  {}", summary.headline)];
    lines.extend(words::sentences(summary).into_iter().map(|sentence| format!("  {sentence}")));
    lines.push(String::new());
    lines.extend(report::picture(answer).lines(characters));
    printer::lines(lines)
}

/// Returns the cellar with the requested number of variants, and the run to show.
pub(super) fn selected(cellar: Cellar, args: VariantArgs) -> anyhow::Result<(Cellar, RunChoice)> {
    let stated = cellar.stated().imperfections().map_or(0, |imperfections| imperfections.variants);
    let count = args.variants.unwrap_or(stated);
    let cellar = cellar.with_variants(count);
    match args.variant {
        Some(number) if number > count => bail!(
            "--variant {number}: variants are numbered from 1 to {count}, and 0 is the room as stated; add --variants \
             {number} to run {number} variants"
        ),
        Some(number) => Ok((cellar, RunChoice::Number(number))),
        None => Ok((cellar, RunChoice::Typical)),
    }
}

/// Adds to an error the place where its cause is stated in the cellar; if there is no such place, the name of
/// the cellar.
pub(super) fn placed(error: CellarFailure, cellar: &Cellar, args: &ScenarioArgs) -> anyhow::Error {
    match error {
        CellarFailure::Plan(error) => error.into(),
        CellarFailure::Stack(failure) => super::placed(failure, cellar.stated(), args),
        CellarFailure::Room(RoomFailure::Stack { name, failure }) => {
            super::placed(*failure, cellar.stated(), args).context(format!("stack {name}"))
        }
        CellarFailure::Kept { .. } => error.into(),
        CellarFailure::Room(error) => anyhow::Error::from(error).context(args.scenario.clone()),
    }
}
