//! `barrelstack study`: runs one scenario many times, on this machine or in chunks on several
//! machines.

mod answer;
mod emit;
mod export;
mod live;
mod report;

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context as _;
use barrelstack::ensemble::Width;
use barrelstack_campaign::study::{
    self, ChunkRun, Collected, Following, RunOptions, Study, StudyError,
};
use barrelstack_report::described;
use clap::Subcommand;

pub(crate) use answer::StudyResult;

use crate::interrupt::{Interrupt, Stopped, keeps};
use crate::lanes::LanesArgs;
use crate::language::LanguageArgs;
use crate::number::{counting, whole};
use crate::printer;
use crate::tables::TableArgs;

/// Text at the end of the help.
const AFTER_HELP: &str = "\
Start with:
  barrelstack study example > mine.toml           a commented study to change
  barrelstack study plan mine.toml                how many cases and chunks it has
  barrelstack study mine.toml --out mine          run it; run it again to continue after a stop
  barrelstack study fields                        all fields of a study file

Results are in the folder: table.csv and table.parquet, whose columns columns.csv explains, provenance.json, and
one Parquet file per chunk in shards.";

/// Exit status of `study collect` if chunks are missing.
const UNFINISHED: u8 = 4;

/// Files from which the tables for spreadsheet programs are made.
const TABLES: [&str; 3] = ["table.csv", "columns.csv", "provenance.json"];

/// Arguments of `study`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = AFTER_HELP,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub(crate) struct StudyArgs {
    #[command(subcommand)]
    action: Option<Action>,
    #[command(flatten)]
    run: RunArgs,
}

/// A study.
#[derive(Debug, clap::Args)]
struct Which {
    /// A study file (TOML), or the name of a built-in study.
    #[arg(value_name = "STUDY")]
    study: String,
}

/// Arguments of `study` and `study run`.
#[derive(Debug, clap::Args)]
struct RunArgs {
    /// A study file (TOML), or the name of a built-in study.
    #[arg(value_name = "STUDY", required = true)]
    study: Option<String>,
    /// Folder for the results: new, empty, or with results of the same study, which is then
    /// continued.
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
    /// Number of threads; by default, one per core. The results do not depend on this number.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = counting())]
    threads: Option<NonZero<usize>>,
    #[command(flatten)]
    lanes: LanesArgs,
    #[command(flatten)]
    tables: TableArgs,
    #[command(flatten)]
    language: LanguageArgs,
    /// Print one JSON document in place of the summary.
    #[arg(long)]
    json: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, clap::Args)]
struct ChunkArgs {
    #[command(flatten)]
    which: Which,
    /// Number of the chunk, counted from 0.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(0..=usize::MAX))]
    chunk: usize,
    /// Folder for the results, shared by all chunks.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    lanes: LanesArgs,
}

#[derive(Debug, clap::Args)]
struct FolderArgs {
    /// A folder that `barrelstack study` wrote.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Actions on a study.
#[derive(Debug, Subcommand)]
enum Action {
    /// Run the missing chunks and collect the table (the same as without `run`).
    Run(RunArgs),
    /// List the chunks, without running anything.
    Plan {
        #[command(flatten)]
        which: Which,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Run one chunk of cases and write its results (a shard); if the shard exists, nothing is done.
    RunChunk(ChunkArgs),
    /// Report the progress of a study.
    Status(FolderArgs),
    /// Write table.csv, table.parquet and provenance.json from the finished shards; exit with
    /// status 4 if chunks are missing.
    Collect {
        #[command(flatten)]
        of: FolderArgs,
        #[command(flatten)]
        tables: TableArgs,
    },
    /// Write the page: fragility, losses, sensitivities and, with a hazard curve, annual rates.
    Report(report::ReportArgs),
    /// Export fragility curves and losses for OpenQuake and Pelicun.
    Export(export::ExportArgs),
    /// Write job files that run all chunks with a scheduler.
    Emit(emit::EmitArgs),
    /// Print a built-in study with its comments, as a starting point.
    Example {
        /// Name of the study; by default the first.
        name: Option<String>,
        /// List the names of the built-in studies instead.
        #[arg(long)]
        list: bool,
    },
    /// List every field of a study file, with its default and its meaning.
    Fields,
    /// Print the JSON schema of study files, for editors.
    Schema,
}

/// Runs the given subcommand.
pub(crate) fn study(args: &StudyArgs) -> anyhow::Result<ExitCode> {
    match &args.action {
        None => return run(&args.run),
        Some(Action::Run(args)) => return run(args),
        Some(Action::Plan { which, json }) => plan(which, *json)?,
        Some(Action::RunChunk(args)) => return run_chunk(args),
        Some(Action::Status(args)) => status(args)?,
        Some(Action::Collect { of, tables }) => return collect(of, *tables),
        Some(Action::Report(args)) => report::report(args)?,
        Some(Action::Export(args)) => export::export(args)?,
        Some(Action::Emit(args)) => emit::emit(args)?,
        Some(Action::Example { name, list }) => example(name.as_deref(), *list)?,
        Some(Action::Fields) => printer::text(&study::reference())?,
        Some(Action::Schema) => {
            printer::lines([serde_json::to_string_pretty(&study::json_schema())?])?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Loads a study file, or a built-in study by name; an existing file takes precedence.
fn load(study: &str) -> Result<Study, StudyError> {
    let path = Path::new(study);
    if path.is_file() || study.contains(['.', '/', '\\']) {
        Study::load(path)
    } else {
        Study::built_in(study)
    }
}

fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    // The argument parser already requires a study and a folder.
    let (Some(study), Some(out)) = (&args.study, &args.out) else {
        anyhow::bail!("name a study and a folder: barrelstack study STUDY --out DIR");
    };
    let study = load(study)?;
    keeps(format!(
        "finished chunks are in {}: run the same command again to continue from there",
        out.display()
    ));
    let live = live::Live::new(!args.quiet, study.design.is_sample(), out);
    let options = RunOptions { threads: args.threads, lanes: args.lanes.lanes };
    let ran = study.run_all(out, &options, &|progress| live.at(progress));
    let (damaged, healed) = (live.damaged(), live.manifest_healed());
    drop(live);
    ran.map_err(stopped)?;
    warn_of_damaged(damaged, out);
    if healed {
        printer::warning(&format!(
            "{} was damaged and has been rewritten from the study",
            out.join("study.json").display()
        ));
    }
    let (answer, made) = collected(out)?;
    args.tables.write(out, &TABLES)?;
    let page = report::write_page(out, args.language)?;
    if args.json {
        printer::document(&StudyResult::of(&(&answer, &made)))?;
    } else {
        printer::lines(answer::lines(&answer, &made, out))?;
        printer::lines(page.map(|page| format!("page: {}", page.display())))?;
    }
    Ok(ExitCode::SUCCESS)
}

described! {
    /// Plan of a study.
    pub(crate) struct StudyPlan of plan: &(&Study, Following) {
        /// Name and version of the format of this document.
        schema: &'static str ["study-plan/1"] = "study-plan/1",
        /// Title of the study.
        title: String = plan.0.title.clone(),
        /// Name of the design, as in study files.
        design: &'static str = plan.0.design.name(),
        /// Fingerprint of the study.
        study_hash: String = format!("{:016x}", plan.0.hash()),
        /// Number of cases.
        cases: u64 = plan.0.cases(),
        /// `true` if there may be fewer cases, because the number depends on results.
        at_most: bool = plan.0.is_adaptive(),
        /// Number of motions.
        motions: usize = plan.0.motions(),
        /// End conditions of the cases.
        following: Following = plan.1.clone(),
        /// The chunks.
        chunks: Vec<PlannedChunk> = plan.0.plan().map(|chunk| PlannedChunk::of(&chunk)).collect(),
    }

    /// Cases that are computed together.
    pub(crate) struct PlannedChunk of chunk: &study::Chunk {
        /// Number of the chunk, counted from 0.
        chunk: usize = chunk.number,
        /// Number of cases in the chunk.
        cases: usize = chunk.cases,
        /// Number of the first case.
        first: u64 = chunk.first,
        /// Number of the last case.
        last: u64 = chunk.last,
    }

    /// Progress of a study.
    pub(crate) struct StudyStatus of status: &study::Status {
        /// Name and version of the format of this document.
        schema: &'static str ["study-status/1"] = "study-status/1",
        /// Provenance of the folder.
        provenance: study::Provenance = status.provenance.clone(),
        /// Outcomes of the finished cases.
        tally: answer::TallyRow = answer::TallyRow::of(&(status.tally, status.provenance.is_sample())),
        /// Numbers of the chunks that are still to be run.
        missing: Vec<usize> = status.missing.clone(),
    }
}

fn warn_of_damaged(shards: usize, out: &Path) {
    if shards == 0 {
        return;
    }
    printer::warning(&format!(
        "{} found in {}: the files are renamed with the extension .damaged, and their chunks run again",
        printer::counted(shards as u64, "damaged shard"),
        out.join("shards").display()
    ));
}

fn plan(which: &Which, json: bool) -> anyhow::Result<()> {
    let study = load(&which.study)?;
    let at_most = study.is_adaptive();
    let following = study.following()?;
    if json {
        return printer::document(&StudyPlan::of(&(&study, following)));
    }
    let (most, unit) = (if at_most { "at most " } else { "" }, study.chunk_unit());
    let mut lines = vec![
        study.title.clone(),
        format!(
            "  {} design, {most}{} in {}, {}",
            study.design.name(),
            printer::counted(study.cases(), "case"),
            printer::counted(study.chunk_count() as u64, "chunk"),
            printer::counted(study.motions() as u64, "motion")
        ),
        format!("  {}", following.words(study.motions())),
        String::new(),
        format!("  {:>8}  {unit:>8}  {:>10}  {:>10}", "chunk", "first", "last"),
    ];
    lines.extend(study.plan().map(|chunk| {
        format!(
            "  {:>8}  {:>8}  {:>10}  {:>10}",
            chunk.number, chunk.cases, chunk.first, chunk.last
        )
    }));
    printer::lines(lines)
}

fn run_chunk(args: &ChunkArgs) -> anyhow::Result<ExitCode> {
    let study = load(&args.which.study)?;
    keeps(format!("chunk {} must be run again", args.chunk));
    let interrupt = Interrupt::listen();
    let lanes = args.lanes.lanes.unwrap_or_else(Width::widest);
    let waiting = live::Waiting::new(&args.out);
    let stop = || {
        waiting.at(Some(args.chunk));
        interrupt.is_requested()
    };
    match study.run_chunk(&args.out, args.chunk, lanes, &stop) {
        Ok(ChunkRun::Before) => {
            printer::lines([format!("chunk {} is already finished", args.chunk)])?;
        }
        Ok(ran) => {
            warn_of_damaged(usize::from(ran == ChunkRun::Again), &args.out);
            printer::lines([format!("chunk {} is done", args.chunk)])?;
        }
        Err(error) => return Err(stopped(error)),
    }
    Ok(ExitCode::SUCCESS)
}

/// Converts the error of a study; the error of a canceled study becomes [`Stopped`].
fn stopped(error: StudyError) -> anyhow::Error {
    if let StudyError::Stopped = error { Stopped.into() } else { error.into() }
}

fn status(args: &FolderArgs) -> anyhow::Result<()> {
    let status = Collected::status(&args.folder)?;
    if args.json {
        return printer::document(&StudyStatus::of(&status));
    }
    printer::lines(answer::status(&status))
}

/// Reads the results and the provenance of the finished chunks in a folder, and writes the table.
fn collected(folder: &Path) -> Result<(answer::Answer, study::Provenance), StudyError> {
    let mut answer = answer::Answer::default();
    let made = study::collect(folder, &mut |_, rows| {
        answer.add(rows);
        Ok(())
    })?;
    Ok((answer, made))
}

/// Writes the table of the finished chunks, and fails if any are missing, so that later commands of
/// a script do not take an incomplete table for a complete one.
fn collect(args: &FolderArgs, tables: TableArgs) -> anyhow::Result<ExitCode> {
    let (answer, made) = collected(&args.folder)?;
    tables.write(&args.folder, &TABLES)?;
    if args.json {
        printer::document(&StudyResult::of(&(&answer, &made)))?;
    } else {
        printer::lines(answer::lines(&answer, &made, &args.folder))?;
    }
    if made.complete {
        return Ok(ExitCode::SUCCESS);
    }
    printer::warning(&format!(
        "the study is unfinished, with {} of {} chunks done: the table contains the finished chunks; `barrelstack study status {}` lists \
         the chunks to run",
        made.chunks_done,
        made.chunks,
        args.folder.display()
    ));
    Ok(ExitCode::from(UNFINISHED))
}

fn example(name: Option<&str>, list: bool) -> anyhow::Result<()> {
    if list {
        return printer::lines(study::builtin_names());
    }
    let name = match name {
        Some(name) => name,
        None => study::builtin_names().next().context("there is no built-in study")?,
    };
    if let Some(text) = study::builtin(name) {
        return printer::text(text);
    }
    // The error of the library lists the existing names.
    Study::built_in(name)?;
    Ok(())
}
