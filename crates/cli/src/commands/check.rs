//! `barrelstack check`: is the scenario sound, and does the stack stand before it is shaken?

use std::process::ExitCode;

use crate::args::CheckArgs;
use crate::printer;

/// Reads, builds and settles, and prints what was found.
pub(crate) fn check(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    let found = barrelstack::check(&scenario)
        .map_err(|error| super::placed(error, &scenario, &args.scenario))?;
    if args.json {
        printer::document(&found)?;
    } else {
        printer::lines(found.lines())?;
    }
    Ok(ExitCode::SUCCESS)
}
