//! One file per subcommand.

pub(crate) mod aftershock;
pub(crate) mod calibrate;
mod cellar;
mod check;
pub(crate) mod compare;
mod demo;
pub(crate) mod heights;
mod layouts;
pub(crate) mod motion;
mod page;
pub(crate) mod protect;
pub(crate) mod render;
mod reproduce;
mod run;
mod scenarios;
pub(crate) mod schema;
pub(crate) mod score;
pub(crate) mod shell;
pub(crate) mod study;

use std::io::Read as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use barrelstack::ground::GroundError;
use barrelstack::scenario::{Problem, ScenarioError, builtin, bytes_of};
use barrelstack::{RunFailure, Scenario};
use barrelstack_cellar::Cellar;
use barrelstack_cellar::scenario::built_in;

use crate::args::{Args, Command, ScenarioArgs};

/// Maximum size (bytes) of a scenario read from standard input.
const INPUT_LIMIT: u64 = 16 << 20;

/// Runs the given subcommand.
pub(crate) fn dispatch(args: Args) -> anyhow::Result<ExitCode> {
    match args.command {
        Command::Run(args) => run::run(&args),
        Command::Demo(args) => demo::demo(&args),
        Command::Heights(args) => heights::run(&args),
        Command::Protect(args) => protect::run(&args),
        Command::Score(args) => score::run(&args),
        Command::Calibrate(args) => calibrate::calibrate(&args),
        Command::Aftershock(args) => aftershock::aftershock(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Check(args) => check::check(&args),
        Command::Reproduce(args) => reproduce::reproduce(&args),
        Command::Motion(args) => motion::motion(&args),
        Command::Render(args) => render::render(&args),
        Command::Study(args) => study::study(&args),
        Command::Scenarios(args) => scenarios::scenarios(&args),
        Command::Schema(args) => schema::schema(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    }
}

/// The scenario or cellar that a command names: from a file, from standard input, or built in.
enum Loaded {
    Scenario(Box<Scenario>),
    Cellar(Box<Cellar>),
}

/// Loads the scenario of a command that does not read cellars.
fn load(args: &ScenarioArgs) -> anyhow::Result<Scenario> {
    match load_any(args)? {
        Loaded::Scenario(scenario) => Ok(*scenario),
        Loaded::Cellar(_) => anyhow::bail!(
            "{}: this is a cellar, which only `barrelstack check`, `run`, `aftershock` and `compare` accept; give the \
             scenario of one stack",
            args.scenario
        ),
    }
}

/// Loads a scenario or a cellar from a file, from standard input (`-`) or by a built-in name, and applies the changes.
///
/// An existing file takes precedence. If no such file exists, a name without a dot or a path
/// separator refers to a built-in scenario.
fn load_any(args: &ScenarioArgs) -> anyhow::Result<Loaded> {
    let mut overrides = args.set.clone();
    if let Some(record) = &args.record {
        let path = std::path::absolute(record)
            .with_context(|| format!("cannot interpret the path {}", record.display()))?;
        let quoted = serde_json::to_string(&path.display().to_string())?;
        overrides.push(format!("motion.record={quoted}"));
    }
    let cellar = |cellar: Result<Cellar, ScenarioError>| -> anyhow::Result<Loaded> {
        Ok(Loaded::Cellar(Box::new(cellar?)))
    };
    if args.scenario == "-" {
        let mut bytes = Vec::new();
        let input = std::io::stdin().lock();
        input
            .take(INPUT_LIMIT)
            .read_to_end(&mut bytes)
            .context("cannot read the scenario from standard input")?;
        if Cellar::is_stated(None, &bytes) {
            return cellar(Cellar::parse("standard input", &bytes, &overrides));
        }
        let scenario = Scenario::parse_bytes("standard input", &bytes, &overrides)?;
        return Ok(Loaded::Scenario(Box::new(scenario)));
    }
    let path = Path::new(&args.scenario);
    let looks_like_a_file = args.scenario.contains(['.', '/', '\\']);
    if path.is_file() || looks_like_a_file {
        // The file is read once, because a pipe is empty afterwards.
        let bytes = bytes_of(path)?;
        if Cellar::is_stated(Some(path), &bytes) {
            return cellar(Cellar::parse_file(path, &bytes, &overrides));
        }
        let scenario = Scenario::parse_file(path, &bytes, &overrides)?;
        return Ok(Loaded::Scenario(Box::new(scenario)));
    }
    if builtin::get(&args.scenario).is_some() {
        let scenario = Scenario::builtin(&args.scenario, &overrides)?;
        return Ok(Loaded::Scenario(Box::new(scenario)));
    }
    match Cellar::builtin(&args.scenario, &overrides) {
        // The name may be a mistyped file name, but the library considers only names of built-in scenarios.
        Err(error) if built_in(&args.scenario).is_none() => Err(no_such(&args.scenario, &error)),
        found => cellar(found),
    }
}

/// Returns the error for a name that is neither a file nor a built-in scenario, with a hint about the
/// most similar name.
fn no_such(name: &str, error: &ScenarioError) -> anyhow::Error {
    let next = if let Problem::UnknownName { nearest: Some(nearest), .. } = error.problem() {
        format!("did you mean `{nearest}`?")
    } else {
        "`barrelstack scenarios` lists the built-in scenarios".to_owned()
    };
    anyhow::anyhow!("there is no file {name:?} and no built-in scenario of that name; {next}")
}

/// Returns the exit status of a run, as listed in the help: failure if the run is `broken`, which means that the
/// computation failed and there is no verdict. The status of interrupted work is set in `main`.
fn status(broken: bool) -> ExitCode {
    if broken { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Adds the position in the scenario, or the name of the scenario, to the error of a run. An error in a record that is
/// given on the command line has no position in the scenario.
fn placed(error: RunFailure, scenario: &Scenario, args: &ScenarioArgs) -> anyhow::Error {
    if args.record.is_some()
        && let RunFailure::Ground(error) = error
    {
        return if let GroundError::Unreadable { path, reason, .. } = error {
            let path = path.display();
            anyhow::anyhow!("cannot read {path}: {reason}; correct the path after --record")
        } else {
            error.into()
        };
    }
    match scenario.place_of(&error.fields()) {
        Some(place) => anyhow::Error::from(error).context(place),
        None => anyhow::Error::from(error).context(args.scenario.clone()),
    }
}
