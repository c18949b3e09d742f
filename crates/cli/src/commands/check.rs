//! `barrelstack check`: validates a scenario and tests whether the stack stands before the motion.

use std::process::ExitCode;

use anyhow::{Context as _, bail};
use barrelstack::Scenario;
use barrelstack::check::Checked;
use barrelstack::ground::from_disk;
use barrelstack::scenario::catalog;
use barrelstack::stability::{StabilityRow, StabilityTable};
use barrelstack::variants;

use super::Loaded;
use crate::args::{CheckArgs, ScenarioArgs};
use crate::interrupt::Stopped;
use crate::printer;
use crate::progress::Progress;

/// Numbers of levels in the table of static stability.
const LEVELS: std::ops::RangeInclusive<u32> = 2..=7;

/// Reads the scenario, builds the stack, lets it settle, and prints the findings.
pub(crate) fn check(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let scenario = match super::load_any(&args.scenario)? {
        Loaded::Scenario(scenario) => scenario,
        Loaded::Cellar(cellar) => return super::cellar::check(args, &cellar),
    };
    if args.plan.is_some() {
        bail!("--plan draws the room of a cellar; leave --plan out for one stack");
    }
    if args.table {
        let table = table(&scenario, &args.scenario)?;
        if args.json {
            printer::document(&table)?;
        } else {
            printer::lines(table.lines())?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let placed = |error| super::placed(error, &scenario, &args.scenario);
    let planes = variants::planes(&scenario).map_err(|error| placed(error.into()))?;
    let one = if scenario.is_spatial() { barrelstack_space::check } else { barrelstack::check };
    let found: Result<Vec<_>, _> = planes.iter().map(|plane| one(&plane.scenario)).collect();
    let mut found = found.map_err(placed)?;
    // The findings of both planes have the same fingerprint: that of the scenario as given.
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

/// Tabulates the static stability of the stack of a scenario for every number of levels in [`LEVELS`], on its own rack
/// and on every other rack of the catalog.
fn table(scenario: &Scenario, args: &ScenarioArgs) -> anyhow::Result<StabilityTable> {
    let stack = scenario.stack().filter(|_| !scenario.is_spatial()).with_context(|| {
        "--table needs a stack in a plane: use a scenario with a stack, and set stack.view to \"both\", \"transverse\" or \
         \"longitudinal\""
    })?;
    let known = catalog::RACKS.iter().map(|known| &known.rack);
    let own = known.clone().find(|rack| **rack == stack.rack).map(|rack| rack.base);
    let others = known.filter(|rack| Some(rack.base) != own).map(|rack| Some(rack.base));
    let racks: Vec<Option<&str>> = std::iter::once(None).chain(others).collect();
    let stacks = racks.len() * LEVELS.count();
    let progress = Progress::new(true);
    let mut rows = Vec::new();
    for (done, (rack, levels)) in
        racks.iter().flat_map(|rack| LEVELS.map(move |levels| (*rack, levels))).enumerate()
    {
        if progress.counted(done as u64, stacks as u64, "stacks").is_break() {
            return Err(Stopped.into());
        }
        let mut args = args.clone();
        args.set.extend(rack.map(|rack| format!("stack.rack=\"{rack}\"")));
        args.set.push(format!("stack.levels={levels}"));
        let with = super::load(&args).and_then(|scenario| Ok(variants::planes(&scenario)?));
        let with =
            with.with_context(|| format!("{} with {levels} levels", rack.unwrap_or("the stack")))?;
        rows.extend(with.iter().filter_map(|plane| StabilityRow::of(&plane.scenario)));
    }
    Ok(StabilityTable { schema: "stability/1", title: scenario.title.clone(), rows })
}
