//! `barrelstack scenarios`: what comes with the program, and what a scenario may say.

use std::process::ExitCode;

use barrelstack::Scenario;
use barrelstack::scenario::{builtin, reference, schema};

use crate::args::{ScenariosAction, ScenariosArgs};
use crate::printer;

/// Lists, shows, explains.
pub(crate) fn scenarios(args: &ScenariosArgs) -> anyhow::Result<ExitCode> {
    match &args.action {
        None | Some(ScenariosAction::List) => {
            let widest = builtin::names().map(str::len).max().unwrap_or(0);
            let lines: anyhow::Result<Vec<String>> = builtin::names()
                .map(|name| Ok(format!("{name:widest$}  {}", Scenario::builtin(name, &[])?.title)))
                .collect();
            printer::lines(lines?)?;
        }
        Some(ScenariosAction::Show { name, resolved: false }) => {
            // Loading it gives the error, with the nearest name, where there is none of this name.
            Scenario::builtin(name, &[])?;
            printer::text(builtin::get(name).unwrap_or_default())?;
        }
        Some(ScenariosAction::Show { name, resolved: true }) => {
            printer::text(&Scenario::builtin(name, &[])?.to_resolved_toml())?;
        }
        Some(ScenariosAction::Fields) => printer::text(&reference::markdown())?,
        Some(ScenariosAction::Schema) => {
            printer::lines([serde_json::to_string_pretty(&schema::json_schema())?])?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
