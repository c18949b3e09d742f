//! `barrelstack compare`: two or more runs side by side, of stacks or of cellars.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use barrelstack::Scenario;
use barrelstack::compare::{self, Comparison, Difference, differences};
use barrelstack::export::Folder;
use barrelstack::outcome::Outcome;
use barrelstack::variants::RunChoice;
use barrelstack_report::listed;
use barrelstack_space::AnyAnswer;

use super::Loaded;
use crate::args::{ScenarioArgs, VariantArgs};
use crate::interrupt::{Interrupt, Stopped};
use crate::language::LanguageArgs;
use crate::number::whole;
use crate::printer;

/// Examples at the end of the help of `compare`.
const EXAMPLES: &str = "\
Examples:
  barrelstack compare demo-napa --against stack.levels=4
  barrelstack compare mine.toml --against interface.rack-ground.friction.coefficient=0.1
  barrelstack compare strapped.toml loose.toml --record my-site.AT2 --out comparison
  barrelstack compare demo-cellar --against 'block.1.spacing=1 m'
  barrelstack compare demo-cellar --usual";

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
#[expect(clippy::struct_excessive_bools, reason = "one field per switch")]
pub(crate) struct CompareArgs {
    /// Scenario files (TOML) or names of built-in scenarios; or files or names of cellars.
    #[arg(value_name = "SCENARIO", required = true)]
    scenarios: Vec<String>,
    /// Add a run of the first scenario in which this value is changed; may be repeated.
    #[arg(long, value_name = "PATH=VALUE")]
    against: Vec<String>,
    /// Add runs of the first cellar with the usual changes, as far as they can be made: wider spacing, all levels
    /// strapped together, stops under every rack, one level less, every stack turned by 90°.
    #[arg(long)]
    pub(super) usual: bool,
    /// Change a value in all runs, such as run.duration="20 s"; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// File of the ground motion of all runs, in place of the motions that the scenarios state.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Number of variants of each stack or cellar to run, in place of imperfections.variants; 0 runs only the stacks or
    /// cellars as stated.
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = whole(0_u32..=4096))]
    pub(super) variants: Option<u32>,
    /// Name of the first run, in place of a description of its differences; repeat this option for the second run, and
    /// so on.
    #[arg(long, value_name = "WORDS")]
    pub(super) label: Vec<String>,
    /// Folder for report.html, report.md and figures/, for cellars also layouts.csv and
    /// comparison.json; must be new or empty.
    #[arg(long, value_name = "DIR", default_value = "barrelstack-compare")]
    pub(super) out: PathBuf,
    /// Allow a folder that is not empty, and replace the files of an earlier comparison.
    #[arg(long)]
    pub(super) overwrite: bool,
    #[command(flatten)]
    pub(super) tables: crate::tables::TableArgs,
    #[command(flatten)]
    pub(super) language: LanguageArgs,
    /// Print one JSON document in place of the sentences.
    #[arg(long)]
    pub(super) json: bool,
    /// Show no progress.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Runs all scenarios and writes the comparison.
pub(crate) fn compare(args: &CompareArgs) -> anyhow::Result<ExitCode> {
    let requested = requested(args);
    if requested.iter().filter(|(_, one)| one.scenario == "-").count() > 1 {
        bail!(
            "standard input can be read for one run only: write the scenario to a file and give its name"
        );
    }
    let (mut scenarios, mut cellars) = (Vec::new(), Vec::new());
    for (name, one) in &requested {
        match super::load_any(one)? {
            Loaded::Scenario(scenario) => scenarios.push((name.clone(), *scenario)),
            Loaded::Cellar(cellar) => cellars.push((name.clone(), *cellar)),
        }
    }
    match (scenarios.first(), cellars.first()) {
        (Some((stack, _)), Some((cellar, _))) => bail!(
            "{cellar}: this is a cellar, and {stack} is not: compare cellars with cellars, or stacks with stacks"
        ),
        (None, _) => super::layouts::compare(args, &requested, cellars),
        (Some(_), None) if args.usual => {
            bail!(
                "--usual adds runs of a cellar with changed layouts, but no cellar is given; leave --usual out, or \
                 give a cellar"
            )
        }
        (Some(_), None) if args.tables.need(false).is_err() => {
            bail!(
                "--xlsx and --decimal-comma apply to tables, which only a comparison of cellars has; leave both \
                 options out"
            )
        }
        (Some(_), None) => stacks(args, &requested, scenarios),
    }
}

/// Replaces the names of the first runs by the given names.
pub(super) fn name(names: &mut Vec<String>, given: &[String]) -> anyhow::Result<()> {
    if given.len() > names.len() {
        bail!(
            "--label: there are {} names for {} runs; give at most one name for each run",
            given.len(),
            names.len()
        );
    }
    names.splice(..given.len(), given.iter().cloned());
    Ok(())
}

/// Runs all stacks and writes the comparison.
///
/// `requested` holds the arguments of each scenario; error messages refer to them.
fn stacks(
    args: &CompareArgs,
    requested: &[(String, ScenarioArgs)],
    mut scenarios: Vec<(String, Scenario)>,
) -> anyhow::Result<ExitCode> {
    for (_, scenario) in &mut scenarios {
        let variants = VariantArgs { variants: args.variants, variant: None };
        super::run::selected(scenario, variants)?;
    }
    compare::check(&scenarios)?;
    let mut names = compare::labels(&scenarios);
    name(&mut names, &args.label)?;
    for ((name, _), label) in scenarios.iter_mut().zip(names) {
        *name = label;
    }
    let folder = Folder::prepare(&args.out, args.overwrite)?;
    let mut answers = Vec::new();
    for ((name, scenario), (_, one)) in scenarios.iter().zip(requested) {
        let answer = super::run::answered(scenario, RunChoice::Typical, !args.quiet)
            .map_err(|error| super::placed(error, scenario, one))?;
        let stopped = answer.is_stopped();
        if stopped && !answers.is_empty() {
            break;
        }
        answers.push((name.clone(), answer));
        if stopped {
            break;
        }
    }
    crate::interrupt::finished();
    let whole = answers.iter().filter(|(_, answer)| !answer.is_stopped()).count();
    let unfinished: Vec<String> =
        scenarios.iter().skip(whole).map(|(name, _)| name.clone()).collect();
    if answers.len() < 2 {
        return alone(args, &folder, answers, unfinished);
    }
    if !unfinished.is_empty() {
        let (done, all) = (answers.len(), scenarios.len());
        printer::note(&format!("stopped; {done} of {all} runs are compared"));
    }
    // The following runs make all sides show the same variant. If they are stopped, the runs shown so far are kept.
    let interrupt = Interrupt::listen();
    let answers = compare::aligned(answers, &mut |_| interrupt.flow())?;
    let sides = compare::sides(answers);
    let document = compare::document(&sides);
    crate::interrupt::writes_to(folder.path());
    // The verdict is printed even if the files cannot be written.
    let written = folder.write_page(&args.language.page(&document));
    let differing = differences(sides.iter().map(|side| &side.stated));
    if args.json {
        printer::document(&Comparison::of(&sides, unfinished))?;
    } else {
        let mut lines = printer::verdict(&document.verdict);
        lines.extend(table(&differing));
        lines.extend([String::new(), format!("report: {}", folder.report().display())]);
        printer::lines(lines)?;
    }
    for side in &sides {
        for text in side.summary.warnings() {
            printer::warning(&format!("{}: {text}", side.name));
        }
    }
    written?;
    let broken = sides.iter().any(|side| matches!(side.outcome, Outcome::Invalid { .. }));
    Ok(super::status(broken))
}

/// Writes the report of the first run, if the comparison was stopped before a second run was finished. The first run
/// may be unfinished, too.
fn alone(
    args: &CompareArgs,
    folder: &Folder,
    answers: Vec<(String, AnyAnswer)>,
    unfinished: Vec<String>,
) -> anyhow::Result<ExitCode> {
    let Some((name, answer)) = answers.first() else { return Err(Stopped.into()) };
    crate::interrupt::writes_to(folder.path());
    let written = answer.files(args.language.of()).and_then(|files| folder.write_files(&files));
    printer::note(&format!(
        "stopped before the end of {}: nothing is compared",
        listed(unfinished.iter().map(|name| format!("\"{name}\"")))
    ));
    if args.json {
        printer::document(&Comparison::of(&compare::sides(answers), unfinished))?;
    } else {
        let mut lines = vec![format!("{name}: {}", answer.headline())];
        if written.is_ok() {
            lines.extend([String::new(), format!("report: {}", folder.report().display())]);
        }
        printer::lines(lines)?;
        printer::warnings(answer);
    }
    written?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the requested runs, with a short name for each.
fn requested(args: &CompareArgs) -> Vec<(String, ScenarioArgs)> {
    let with = |scenario: &String, more: Option<&String>| ScenarioArgs {
        scenario: scenario.clone(),
        // The change of a single run replaces the change of all runs to the same path.
        set: args
            .set
            .iter()
            .filter(|set| more.is_none_or(|m| path(m) != path(set)))
            .chain(more)
            .cloned()
            .collect(),
        record: args.record.clone(),
    };
    let files = args.scenarios.iter().map(|name| (short(name), with(name, None)));
    let changed = args.scenarios.iter().take(1).flat_map(|first| {
        args.against.iter().map(|change| (spaced(change), with(first, Some(change))))
    });
    files.chain(changed).collect()
}

/// Returns the name of a file without folders and extension.
fn short(name: &str) -> String {
    let stem = Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    stem.unwrap_or_else(|| name.to_owned())
}

/// Returns the path in a change such as `path=value`.
fn path(change: &str) -> &str {
    change.split_once('=').map_or(change, |(path, _)| path).trim()
}

/// Formats a change with spaces, such as `stack.levels = 4`.
fn spaced(change: &str) -> String {
    change.split_once('=').map_or_else(
        || change.to_owned(),
        |(path, value)| format!("{} = {}", path.trim(), value.trim()),
    )
}

/// Lists the differences, each with the input and its value in every run.
fn table(differing: &[Difference]) -> Vec<String> {
    let mut lines = vec![String::new()];
    for one in differing {
        let values: Vec<&str> =
            one.values.iter().map(|value| value.as_deref().unwrap_or("–")).collect();
        lines.push(format!("  {:<44} {}", one.path, values.join("  |  ")));
    }
    lines
}
