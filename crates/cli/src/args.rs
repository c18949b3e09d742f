//! Command-line arguments.

use std::path::PathBuf;
use std::str::FromStr;

use barrelstack_cellar::kept::Part;
use clap::{Parser, Subcommand};

use crate::language::LanguageArgs;
use crate::number::whole;

/// Text at the end of the help of the program.
const AFTER_HELP: &str = "\
Start with:
  barrelstack demo                                       a first run, and a report to open in a browser
  barrelstack scenarios show demo-napa > mine.toml       a commented scenario to change
  barrelstack run mine.toml --record my-site.AT2 --out mine

Results go to standard output, warnings and errors to standard error.

Exit status:
  0    there is a result, whether the stack stands or falls
  1    the computation failed, and there is no verdict
  2    there is no result: the request is wrong, or a file could not be read or written
  3    a motion misses its target spectrum, but was written as requested (motion match --accept-misfit)
  4    chunks of a study are missing, and its table contains the finished ones (study collect)
  130  stopped by Ctrl-C or SIGTERM: unfinished work has no verdict; what is finished is printed and written

With --json, a command without a result prints a document of the schema `error`; see barrelstack schema.";

/// Does a stack of wine barrels survive an earthquake, how does it fail, and what would save it?
#[derive(Debug, Parser)]
#[command(name = "barrelstack", version, propagate_version = true, after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Command to run.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Stop the program, as Ctrl-C would, at a point such as 2:runs:3: three runs of the second task are done; for
    /// tests.
    #[arg(long, global = true, hide = true, value_name = "POINT")]
    pub(crate) stop_at: Option<crate::interrupt::StopPoint>,
}

/// Command to run.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scenario and report what happens.
    Run(RunArgs),
    /// Shake a five-level stack with the South Napa earthquake of 2014 and write a report.
    Demo(DemoArgs),
    /// Find the safe height: how often stacks of two to six levels collapse, on one page.
    Heights(crate::commands::heights::HeightsArgs),
    /// Find the most cost-effective protection: fewer levels, other racks, devices, or pairs of these.
    Protect(crate::commands::protect::ProtectArgs),
    /// Compute the RockScore of a rack or a device: one number from a fixed protocol, on one sheet.
    Score(crate::commands::score::ScoreArgs),
    /// Read a scenario, build the stack and let it settle, without shaking it.
    Check(CheckArgs),
    /// Shake a cellar with its motion, then with an aftershock: do the standing stacks survive?
    Aftershock(crate::commands::aftershock::AftershockArgs),
    /// Run two or more scenarios and compare them on one page.
    Compare(crate::commands::compare::CompareArgs),
    /// Run every case of Candia et al. (2008), and compare its numbers with those of the program.
    Reproduce(ReproduceArgs),
    /// Read, inspect, change and make ground motions.
    Motion(Box<crate::commands::motion::MotionArgs>),
    /// Find contact parameters and their uncertainty from your own tests.
    Calibrate(crate::commands::calibrate::CalibrateArgs),
    /// Run a scenario and write its figures, the report as PDF, animations and a ParaView series.
    Render(crate::commands::render::RenderArgs),
    /// Run a scenario many times, with varied values and motions, and tabulate the results.
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

/// A scenario, and changes to be made to its values.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ScenarioArgs {
    /// A scenario file (TOML), the name of a built-in scenario, or - for standard input.
    #[arg(default_value = "demo-napa", value_name = "SCENARIO")]
    pub(crate) scenario: String,
    /// Change a value, such as stack.levels=5 or "motion.scale.pgv=60 cm/s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    /// File of the ground motion, in place of the motion that the scenario states.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
}

/// Number of variants to run in addition to the stack as stated, and the run to show.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct VariantArgs {
    /// Number of variants to run, in place of imperfections.variants; 0 runs only the stack, or the cellar, as stated.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(0_u32..=4096))]
    pub(crate) variants: Option<u32>,
    /// Number of the variant to show, in place of the most typical one; 0 shows the stack, or the cellar, as stated.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(0..=u32::MAX))]
    pub(crate) variant: Option<u32>,
}

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "one field per switch")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    /// Write summary, histories, envelopes and report into this folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Allow a folder that is not empty, and replace the files of an earlier run.
    #[arg(long, requires = "out")]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) tables: crate::tables::TableArgs,
    /// Repeat the run with half the time step, with more closely spaced contact nodes, and with disturbances of a
    /// nanometer; report until when the repeats agree with the run, and whether its outcome is robust.
    #[arg(long)]
    pub(crate) verify: bool,
    /// Do not search for changes that would have kept a fallen stack up; the search may take as
    /// long as the run.
    #[arg(long)]
    pub(crate) no_remedy: bool,
    /// Also write the report for printing, report.pdf, into the folder.
    #[arg(long, requires = "out")]
    pub(crate) pdf: bool,
    /// Paper size of report.pdf.
    #[arg(long, value_enum, value_name = "PAPER", default_value = "a4", requires = "pdf")]
    pub(crate) paper: crate::figures::PaperName,
    #[command(flatten)]
    pub(crate) language: LanguageArgs,
    /// Page that contains the program, such as barrelstack.html of a release. The page is embedded
    /// in report.html, so that a reader of the report can change the stack and run it again.
    #[arg(long, requires = "out", value_name = "FILE")]
    pub(crate) with_engine: Option<PathBuf>,
    /// Write the final places of all bodies of a cellar into this new file. Another cellar starts from these places if
    /// its start.file names the file.
    #[arg(long, value_name = "FILE")]
    pub(crate) state: Option<PathBuf>,
    /// Keep the result of every variant of a cellar in this folder. Variants whose results are already there are not
    /// run again, so that stopped work can be continued.
    #[arg(long, value_name = "DIR")]
    pub(crate) keep: Option<PathBuf>,
    /// Run only this part of the variants of a cellar, such as 3/8 for the third of eight parts, and keep their
    /// results. A later run without this option combines the results of all parts.
    #[arg(long, requires = "keep", value_name = "PART/PARTS", conflicts_with_all = ["out", "state", "json"])]
    pub(crate) part: Option<PartName>,
    /// Draw the stack in the summary with ASCII characters only.
    #[arg(long, conflicts_with = "json")]
    pub(crate) plain: bool,
    /// Print one JSON document in place of the summary.
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress; warnings are still printed.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// One of several parts of the variants of a cellar, such as 3/8 for the third of eight parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartName(pub(crate) Part);

impl FromStr for PartName {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let two = text
            .split_once('/')
            .and_then(|(part, of)| Some((part.parse().ok()?, of.parse().ok()?)));
        match two {
            Some((part, of)) if (1..=of).contains(&part) => Ok(Self(Part { part, of })),
            Some(_) | None => Err("expected a part and the number of parts, such as 3/8"),
        }
    }
}

/// Arguments of `demo`.
#[derive(Debug, clap::Args)]
pub(crate) struct DemoArgs {
    /// Folder to write to; only files of an earlier demo are replaced.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-demo")]
    pub(crate) out: PathBuf,
    /// Change a value of the scenario, such as stack.levels=4; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    #[command(flatten)]
    pub(crate) variants: VariantArgs,
    #[command(flatten)]
    pub(crate) language: LanguageArgs,
    /// Do not search for changes that would have kept the stack up; the search may take as long as
    /// the run.
    #[arg(long)]
    pub(crate) no_remedy: bool,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) scenario: ScenarioArgs,
    /// Tabulate the static stability of the stack with two to seven levels, on its own rack and on
    /// every rack of the catalog: settlement, longest period of sway, and tilt of the floor at
    /// which the stack falls.
    #[arg(long)]
    pub(crate) table: bool,
    /// Write the plan of a cellar as a picture (SVG) into this new file.
    #[arg(long, value_name = "FILE")]
    pub(crate) plan: Option<PathBuf>,
    /// Print one JSON document in place of text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `reproduce`.
#[derive(Debug, clap::Args)]
pub(crate) struct ReproduceArgs {
    /// The record of the paper, `RSN995_NORTHR_PEL360.AT2` of the PEER database. Without it, the bundled record shakes
    /// the six barrels, and results that depend on the ground motion are not compared.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
    /// Leave out the studies, which take most of the time: the influence of each input, and the effect of a change of
    /// the contact parameters by 10 %.
    #[arg(long)]
    pub(crate) no_studies: bool,
    #[command(flatten)]
    pub(crate) figures: crate::figures::FigureArgs,
    #[command(flatten)]
    pub(crate) language: LanguageArgs,
    /// Folder for the page (for screen and print) and its figures; files of an earlier page are
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
    /// List the built-in scenarios.
    List {
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Print a scenario with its comments, as a starting point for your own.
    Show {
        /// Name of the scenario.
        name: String,
        /// Print the scenario with all defaults instead.
        #[arg(long)]
        resolved: bool,
    },
    /// List every field of a scenario, with its default and its meaning.
    Fields {
        /// List only fields that contain this text in their name, their table or their meaning.
        filter: Option<String>,
    },
    /// Print the JSON schema of scenario files, for editors.
    Schema,
}
