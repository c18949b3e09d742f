//! `barrelstack aftershock`: whether what still stands after the motion of a cellar survives an aftershock.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use barrelstack_cellar::words;

use super::Loaded;
use crate::args::{RunArgs, ScenarioArgs, VariantArgs};
use crate::figures::PaperName;

/// Arguments of `aftershock`.
#[derive(Debug, clap::Args)]
pub(crate) struct AftershockArgs {
    /// A cellar: a file (TOML), the name of a built-in cellar, or - for standard input.
    scenario: String,
    /// Strength of the aftershock: factor of the motion of the cellar, or of the record.
    #[arg(long, value_name = "FACTOR", default_value_t = 0.5)]
    scale: f64,
    /// File of the aftershock, in place of the motion of the cellar.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Change a value, such as stack.levels=5 or "motion.scale.pgv=60 cm/s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    variants: VariantArgs,
    /// Write report, results by shock and plan into this folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Allow a folder that is not empty, and replace the files of an earlier run.
    #[arg(long, requires = "out")]
    overwrite: bool,
    /// Print one JSON document, that of `run`, in place of text.
    #[arg(long)]
    json: bool,
    /// Show no progress; warnings are still printed.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs a cellar through its motion and the aftershock; the first line answers the question.
pub(crate) fn aftershock(args: &AftershockArgs) -> anyhow::Result<ExitCode> {
    let scale = args.scale;
    if !(scale > 0.0 && scale <= 100.0) {
        bail!(
            "--scale {scale}: expected a factor above 0 and up to 100, such as 0.5 for half the strength"
        );
    }
    let scenario =
        ScenarioArgs { scenario: args.scenario.clone(), set: args.set.clone(), record: None };
    let cellar = match super::load_any(&scenario)? {
        Loaded::Cellar(cellar) => *cellar,
        Loaded::Scenario(_) => bail!(
            "{}: this is the scenario of one stack; write a cellar that extends it, with kind = \"cellar\", [room] and one [[block]], \
             and give that",
            args.scenario
        ),
    };
    let record = args.record.as_deref().map(|record| {
        std::path::absolute(record)
            .with_context(|| format!("cannot interpret the path {}", record.display()))
    });
    let record = record.transpose()?;
    let cellar = cellar.with_aftershock(scale, record.as_deref())?;
    let strength = match &args.record {
        Some(record) => format!("{} as an aftershock, scaled by {scale},", record.display()),
        None => format!("an aftershock of {scale} times its strength"),
    };
    let run = RunArgs {
        scenario,
        variants: args.variants,
        out: args.out.clone(),
        overwrite: args.overwrite,
        verify: false,
        no_remedy: true,
        pdf: false,
        paper: PaperName::A4,
        with_engine: None,
        state: None,
        plain: false,
        json: args.json,
        quiet: args.quiet,
    };
    super::cellar::run(&run, cellar, &|answer| words::aftershock(&answer.summary, &strength))
}
