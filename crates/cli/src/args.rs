//! Command-line arguments.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

/// End of the first page of help.
const AFTER_HELP: &str = "\
Start with:
  barrelstack demo                                       a first run, and a report to open in a browser
  barrelstack scenarios show demo-napa > mine.toml       a commented scenario to change
  barrelstack run mine.toml --record my-site.AT2 --out mine

Results go to standard output, warnings and errors to standard error.

Exit status:
  0    there is a result, whatever became of the stack
  1    the numbers broke down, and there is no verdict
  2    there is none: a mistake in the request, or a file that could not be read or written
  3    a motion was matched only nearly, and written as requested (motion match --accept-misfit)
  4    chunks of a study are missing, and its table holds those that are there (study collect)
  130  stopped by Ctrl-C or SIGTERM: unfinished work has no verdict; what is finished is printed and written

With --json what has no result prints one document as well, of the schema `error`; see barrelstack schema.";

/// Does a stack of wine barrels survive an earthquake, how does it fail, what would save it?
#[derive(Debug, Parser)]
#[command(name = "barrelstack", version, propagate_version = true, after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Command to run.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Stop as by Ctrl-C at a place of the work, WORK:THINGS:DONE; for tests.
    #[arg(long, global = true, hide = true, value_name = "PLACE")]
    pub(crate) stop_at: Option<crate::interrupt::Place>,
}

/// Command to run.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scenario and say what happens.
    Run(RunArgs),
    /// Shake a five-level stack with the South Napa earthquake of 2014 and write a report.
    Demo(DemoArgs),
    /// Safe height: collapse of stacks of two to six levels, on one page.
    Heights(crate::commands::heights::HeightsArgs),
    /// Best protection of a stack for its cost: levels, racks, devices, pairs of these.
    Protect(crate::commands::protect::ProtectArgs),
    /// The RockScore of a rack or a device: one number from a fixed protocol, on one sheet.
    Score(crate::commands::score::ScoreArgs),
    /// Read a scenario, build the stack and let it settle, without shaking it.
    Check(CheckArgs),
    /// Run two or more scenarios and set them side by side in one page.
    Compare(crate::commands::compare::CompareArgs),
    /// Run every case of the paper behind the model and set its numbers beside ours.
    Reproduce(ReproduceArgs),
    /// Read, look at, change and make ground motions.
    Motion(Box<crate::commands::motion::MotionArgs>),
    /// Find contact parameters, with their uncertainty, from your own tests.
    Calibrate(crate::commands::calibrate::CalibrateArgs),
    /// Run a scenario and write its figures, the report as PDF, animations and a ParaView series.
    Render(crate::commands::render::RenderArgs),
    /// Run a scenario many times, with other values and other motions, into one table.
    Study(crate::commands::study::StudyArgs),
    /// List the built-in scenarios, or print one.
    Scenarios(ScenariosArgs),
    /// List the documents that --json prints, or print the JSON Schema of one.
    Schema(crate::commands::schema::SchemaArgs),
    /// Print completions for a shell.
    Completions(crate::commands::shell::CompletionsArgs),
    /// Write manual pages.
    Man(crate::commands::shell::ManArgs),
}

/// A scenario and what to change in it.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ScenarioArgs {
    /// A scenario file (TOML), the name of a built-in scenario, or - for standard input.
    #[arg(default_value = "demo-napa", value_name = "SCENARIO")]
    pub(crate) scenario: String,
    /// Change a value, such as stack.levels=5 or "motion.scale.pgv=60 cm/s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    /// The file of the ground motion, in place of the scenario's.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
}

/// Number of variants run beside the case as stated, and the run that is shown.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct VariantArgs {
    /// Variants of the stack to run beside it, in place of imperfections.variants; 0 for one run.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(0..=4096))]
    pub(crate) variants: Option<u32>,
    /// The variant to show, in place of the most typical; 0 for the stack as it is stated.
    #[arg(long, value_name = "NUMBER")]
    pub(crate) variant: Option<u32>,
}

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "one for every switch")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    /// Write summary, histories, envelopes and report into this folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Let the folder hold files, and replace those of an earlier run.
    #[arg(long, requires = "out")]
    pub(crate) overwrite: bool,
    /// Repeat the run with half the step, finer nodes and disturbances of a nanometer, and say how
    /// long it is predictable and whether its outcome is robust.
    #[arg(long)]
    pub(crate) verify: bool,
    /// Do not look for what would have kept a stack up that falls, which may take as long again.
    #[arg(long)]
    pub(crate) no_remedy: bool,
    /// Write the report on paper too, report.pdf in the same folder.
    #[arg(long, requires = "out")]
    pub(crate) pdf: bool,
    /// Paper of report.pdf.
    #[arg(long, value_enum, value_name = "PAPER", default_value = "a4", requires = "pdf")]
    pub(crate) paper: crate::figures::PaperName,
    /// The page that holds the program, such as barrelstack.html of a release, to put into report.html, so that
    /// whoever opens that can change the stack and shake it again.
    #[arg(long, requires = "out", value_name = "FILE")]
    pub(crate) with_engine: Option<PathBuf>,
    /// Draw the stack in the summary with the characters of every keyboard.
    #[arg(long, conflicts_with = "json")]
    pub(crate) plain: bool,
    /// Print one JSON document in place of the summary.
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress; warnings are still printed.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Arguments of `demo`.
#[derive(Debug, clap::Args)]
pub(crate) struct DemoArgs {
    /// Where to write; what an earlier demo wrote there is replaced, and nothing else.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-demo")]
    pub(crate) out: PathBuf,
    /// Change a value of the scenario, such as stack.levels=4; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    /// Do not look for what would have kept the stack up, which may take as long again.
    #[arg(long)]
    pub(crate) no_remedy: bool,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
    /// Print how firmly the stack stands with two to seven levels on its own rack and on every rack of the catalog: how far
    /// it sinks, its longest period of sway, and the tilt of the floor at which it falls.
    #[arg(long)]
    pub(crate) table: bool,
    /// Print one JSON document in place of the lines.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `reproduce`.
#[derive(Debug, clap::Args)]
pub(crate) struct ReproduceArgs {
    /// The paper's record, `RSN995_NORTHR_PEL360.AT2` of the PEER database; without it the bundled
    /// record shakes the six barrels and nothing that depends on the motion is compared.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
    /// Leave out the studies, which are most of the work: what moves each case, and contact parameters
    /// 10 % off.
    #[arg(long)]
    pub(crate) no_studies: bool,
    #[command(flatten)]
    pub(crate) figures: crate::figures::FigureArgs,
    /// Where to write the page, on screen and on paper, and its figures; files of an earlier page are
    /// replaced.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-reproduce")]
    pub(crate) out: PathBuf,
}

/// Arguments of `scenarios`.
#[derive(Debug, clap::Args)]
pub(crate) struct ScenariosArgs {
    /// Action on the scenarios.
    #[command(subcommand)]
    pub(crate) action: Option<ScenariosAction>,
    /// Print the list as one JSON document.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Actions on the built-in scenarios.
#[derive(Debug, Subcommand)]
pub(crate) enum ScenariosAction {
    /// List them.
    List {
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Print one, with its comments, as a starting point for your own.
    Show {
        /// Its name.
        name: String,
        /// Print it with every default written out instead.
        #[arg(long)]
        resolved: bool,
    },
    /// List every field of a scenario, with its default and what it means.
    Fields {
        /// Only those that have this in their name, their table or their meaning.
        filter: Option<String>,
    },
    /// Print the JSON schema for editors.
    Schema,
}
