//! What can be typed.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

/// Does a stack of wine barrels survive an earthquake, how does it fail, what would save it?
#[derive(Debug, Parser)]
#[command(name = "barrelstack", version, propagate_version = true)]
pub(crate) struct Args {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scenario and say what happens.
    Run(RunArgs),
    /// Shake a five-level stack with the South Napa earthquake of 2014 and write a report.
    Demo(DemoArgs),
    /// Read a scenario, build the stack and let it settle, without shaking it.
    Check(CheckArgs),
    /// Run a scenario and write its figures, numbered pictures and a ParaView series.
    Render(crate::commands::render::RenderArgs),
    /// List the built-in scenarios, or print one.
    Scenarios(ScenariosArgs),
}

/// A scenario and what to change in it.
#[derive(Debug, clap::Args)]
pub(crate) struct ScenarioArgs {
    /// A scenario file (TOML), or the name of a built-in scenario.
    #[arg(default_value = "demo-napa", value_name = "SCENARIO")]
    pub(crate) scenario: String,
    /// Change a value, such as stack.levels=5 or "motion.scale.pgv=60 cm/s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    /// The file of the ground motion, in place of the scenario's.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
}

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
    /// Write summary, histories, envelopes and report into this folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace what an earlier run wrote into the folder.
    #[arg(long, requires = "out")]
    pub(crate) overwrite: bool,
    /// Print one JSON document in place of the summary for people.
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Arguments of `demo`.
#[derive(Debug, clap::Args)]
pub(crate) struct DemoArgs {
    /// Where to write; what an earlier demo wrote there is replaced.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-demo")]
    pub(crate) out: PathBuf,
    /// Change a value of the scenario, such as stack.levels=4; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
}

/// Arguments of `scenarios`.
#[derive(Debug, clap::Args)]
pub(crate) struct ScenariosArgs {
    /// What to do with them.
    #[command(subcommand)]
    pub(crate) action: Option<ScenariosAction>,
}

/// What to do with the built-in scenarios.
#[derive(Debug, Subcommand)]
pub(crate) enum ScenariosAction {
    /// List them.
    List,
    /// Print one, with its comments, as a starting point for your own.
    Show {
        /// Its name.
        name: String,
        /// Print it with every default written out instead.
        #[arg(long)]
        resolved: bool,
    },
    /// List every field of a scenario, with its default and what it means.
    Fields,
    /// Print the JSON schema for editors.
    Schema,
}
