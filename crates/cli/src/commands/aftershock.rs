//! `barrelstack aftershock`: whether the stacks that still stand after the motion of a cellar survive an aftershock.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context as _, bail};
use barrelstack::export::Folder;
use barrelstack_cellar::{Cellar, aftershocks, words};

use super::Loaded;
use crate::args::{RunArgs, ScenarioArgs, VariantArgs};
use crate::figures::PaperName;
use crate::language::LanguageArgs;
use crate::number::real;
use crate::printer;
use crate::progress::Progress;

/// Arguments of `aftershock`.
#[derive(Debug, clap::Args)]
pub(crate) struct AftershockArgs {
    /// A cellar: a file (TOML), the name of a built-in cellar, or - for standard input.
    scenario: String,
    /// Strength of the aftershock: factor by which the motion of the cellar, or the record, is multiplied. With several
    /// factors, such as 0.25,0.5,0.75, each aftershock follows the same main shock.
    #[arg(
        long, value_name = "FACTOR", value_delimiter = ',', default_values_t = [0.5], allow_negative_numbers = true,
        value_parser = real(
            "a factor above 0 and up to 100, such as 0.5 for half the strength",
            |number| number > 0.0 && number <= 100.0
        )
    )]
    scale: Vec<f64>,
    /// File of the ground motion of the aftershock, in place of the motion of the cellar.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Change a value, such as stack.levels=5 or "motion.scale.pgv=60 cm/s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    variants: VariantArgs,
    /// Write the report, the plan and the results of each shock to this folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Allow a folder that is not empty, and replace the files of an earlier run.
    #[arg(long, requires = "out")]
    overwrite: bool,
    #[command(flatten)]
    tables: crate::tables::TableArgs,
    #[command(flatten)]
    language: LanguageArgs,
    /// Print one JSON document in place of text; with a single factor, the same document as `run`.
    #[arg(long)]
    json: bool,
    /// Show no progress; warnings are still printed.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs a cellar through its motion and the aftershock. The first printed line states whether the stacks that survive
/// the motion also survive the aftershock.
pub(crate) fn aftershock(args: &AftershockArgs) -> anyhow::Result<ExitCode> {
    let mut strengths = args.scale.clone();
    strengths.sort_by(f64::total_cmp);
    let same = strengths.windows(2).find(|two| two[0] == two[1]);
    if let Some(twice) = same.and_then(<[f64]>::first) {
        bail!("--scale: {twice} is given twice; give it once");
    }
    let scenario =
        ScenarioArgs { scenario: args.scenario.clone(), set: args.set.clone(), record: None };
    let cellar = match super::load_any(&scenario)? {
        Loaded::Cellar(cellar) => *cellar,
        Loaded::Scenario(_) => bail!(
            "{}: this is the scenario of one stack, but an aftershock shakes a cellar; give a cellar such as demo-cellar, \
             or write a cellar file that extends this scenario, with kind = \"cellar\", [room] and at least one [[block]]",
            args.scenario
        ),
    };
    let record = args.record.as_deref().map(|record| {
        std::path::absolute(record)
            .with_context(|| format!("cannot interpret the path {}", record.display()))
    });
    let record = record.transpose()?;
    let [scale] = strengths[..] else {
        return residual(args, &scenario, cellar, &strengths, record.as_deref());
    };
    let cellar = cellar.with_aftershock(scale, record.as_deref())?;
    let strength = match &args.record {
        Some(record) => format!("the aftershock {} scaled by {scale}", record.display()),
        None => format!("an aftershock of {scale} times the strength of the main shock"),
    };
    let run = RunArgs {
        scenario,
        variants: args.variants,
        out: args.out.clone(),
        overwrite: args.overwrite,
        tables: args.tables,
        verify: false,
        no_remedy: true,
        pdf: false,
        paper: PaperName::A4,
        language: args.language,
        with_engine: None,
        state: None,
        keep: None,
        part: None,
        plain: false,
        json: args.json,
        quiet: args.quiet,
    };
    super::cellar::run(&run, cellar, &|answer| words::aftershock(&answer.summary, &strength))
}

/// Runs a cellar through its motion and aftershocks of several strengths, each after the same main shock.
fn residual(
    args: &AftershockArgs,
    scenario: &ScenarioArgs,
    cellar: Cellar,
    strengths: &[f64],
    record: Option<&Path>,
) -> anyhow::Result<ExitCode> {
    if args.variants.variant.is_some() {
        bail!(
            "--variant selects the run that is shown, but with several strengths no run is shown; omit --variant"
        );
    }
    let (cellar, _) = super::cellar::selected(cellar, args.variants)?;
    args.tables.need(args.out.is_some())?;
    let folder = args.out.as_deref().map(|out| Folder::prepare(out, args.overwrite)).transpose()?;
    let start = Instant::now();
    let progress = Progress::new(!args.quiet);
    let summary = aftershocks::aftershocks(&cellar, strengths, record, &mut |reached| {
        progress.advance(reached)
    });
    drop(progress);
    let mut summary = summary.map_err(|error| super::cellar::placed(error, &cellar, scenario))?;
    summary.wall_seconds = Some(start.elapsed().as_secs_f64());
    crate::interrupt::finished();
    // The verdict is printed even if the files cannot be written.
    let written = folder.as_ref().map_or(Ok::<(), anyhow::Error>(()), |folder| {
        crate::interrupt::writes_to(folder.path());
        let files =
            aftershocks::files(&summary, args.language.of()).context("cannot write the summary")?;
        Ok(folder.write_files(&args.tables.of(files)?)?)
    });
    if args.json {
        printer::document(&summary)?;
    } else {
        let mut lines = vec![summary.title.clone(), format!("  {}", summary.headline)];
        lines.extend(aftershocks::sentences(&summary).into_iter().map(|text| format!("  {text}")));
        printer::lines(lines)?;
        if let (Some(folder), Ok(())) = (&folder, &written) {
            printer::lines(["", &format!("report: {}", folder.report().display())])?;
        }
        summary.warnings.iter().for_each(|warning| printer::warning(warning));
    }
    written?;
    Ok(super::status(summary.counted == 0 && summary.unfinished.is_none()))
}
