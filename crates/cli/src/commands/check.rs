//! `barrelstack check`: is the scenario sound, and does the stack stand before it is shaken?

use std::process::ExitCode;

use barrelstack::variants;

use crate::args::CheckArgs;
use crate::printer;

/// Reads, builds and settles, and prints what was found.
pub(crate) fn check(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    let planes =
        variants::planes(&scenario).map_err(|error| super::placed(error.into(), &args.scenario))?;
    for plane in &planes {
        let found = barrelstack::check(&plane.scenario)
            .map_err(|error| super::placed(error, &args.scenario))?;
        if let (Some(view), true) = (plane.view(), planes.len() > 1) {
            printer::lines([format!("{}:", view.words())])?;
        }
        printer::lines(found.lines())?;
    }
    Ok(ExitCode::SUCCESS)
}
