//! `barrelstack check`: validates a scenario and tests that the stack stands before it is shaken.

use std::process::ExitCode;

use barrelstack::check::Checked;
use barrelstack::ground::from_disk;
use barrelstack::variants;

use crate::args::CheckArgs;
use crate::printer;

/// Reads, builds and settles, and prints the findings.
pub(crate) fn check(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let scenario = super::load(&args.scenario)?;
    let placed = |error| super::placed(error, &scenario, &args.scenario);
    let planes = variants::planes(&scenario).map_err(|error| placed(error.into()))?;
    let one = if scenario.is_spatial() { barrelstack_space::check } else { barrelstack::check };
    let found: Result<Vec<_>, _> = planes.iter().map(|plane| one(&plane.scenario)).collect();
    let mut found = found.map_err(placed)?;
    // As a run states it: that of the scenario as it was given, which both planes share.
    let given = scenario.with_records(&mut from_disk).map_err(|error| placed(error.into()))?;
    for one in &mut found {
        one.scenario_hash = format!("{:016x}", given.fingerprint());
    }
    if args.json {
        let other = found.split_off(1).pop();
        let document = found.pop().map(|one| Checked { other_plane: other.map(Box::new), ..one });
        printer::document(&document)?;
        return Ok(ExitCode::SUCCESS);
    }
    for (plane, found) in planes.iter().zip(&found) {
        if let (Some(view), true) = (plane.view(), planes.len() > 1) {
            printer::lines([format!("{}:", view.words())])?;
        }
        printer::lines(found.lines())?;
    }
    Ok(ExitCode::SUCCESS)
}
