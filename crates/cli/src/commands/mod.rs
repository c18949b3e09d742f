//! One file for every subcommand.

mod check;
mod demo;
pub(crate) mod render;
mod run;
mod scenarios;

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use barrelstack::Scenario;

use crate::args::{Args, Command, ScenarioArgs};

/// Does what was typed.
pub(crate) fn dispatch(args: Args) -> anyhow::Result<ExitCode> {
    match args.command {
        Command::Run(args) => run::run(&args),
        Command::Demo(args) => demo::demo(&args),
        Command::Check(args) => check::check(&args),
        Command::Render(args) => render::render(&args),
        Command::Scenarios(args) => scenarios::scenarios(&args),
    }
}

/// Loads a scenario file, or a built-in scenario, with its changes.
///
/// A name that is a file is a file; a name without a dot or a separator is a built-in scenario.
fn load(args: &ScenarioArgs) -> anyhow::Result<Scenario> {
    let mut overrides = args.set.clone();
    if let Some(record) = &args.record {
        let path = std::path::absolute(record)
            .with_context(|| format!("cannot make sense of the path {}", record.display()))?;
        let quoted = serde_json::to_string(&path.display().to_string())?;
        overrides.push(format!("motion.record={quoted}"));
    }
    let path = Path::new(&args.scenario);
    let looks_like_a_file = args.scenario.contains(['.', '/', '\\']);
    let scenario = if path.exists() || looks_like_a_file {
        Scenario::load(path, &overrides)
    } else {
        Scenario::builtin(&args.scenario, &overrides)
    };
    Ok(scenario?)
}
