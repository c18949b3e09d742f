//! `barrelstack scenarios`: the built-in scenarios, and the fields of a scenario.

use std::process::ExitCode;

use anyhow::bail;
use barrelstack::Scenario;
use barrelstack::scenario::{builtin, reference, schema};
use barrelstack_cellar::{Cellar, scenario as cellars};
use barrelstack_report::described;

use crate::args::{ScenariosAction, ScenariosArgs};
use crate::printer;

/// Lists the scenarios, prints one, or explains the fields.
pub(crate) fn scenarios(args: &ScenariosArgs) -> anyhow::Result<ExitCode> {
    match &args.action {
        None => list(args.json)?,
        Some(ScenariosAction::List { json }) => list(*json || args.json)?,
        Some(_) if args.json => {
            bail!("--json applies only to the list of scenarios; leave --json out")
        }
        Some(ScenariosAction::Show { name, resolved }) => printer::text(&shown(name, *resolved)?)?,
        Some(ScenariosAction::Fields { filter: None }) => printer::text(&reference::markdown())?,
        Some(ScenariosAction::Fields { filter: Some(filter) }) => {
            printer::lines(filtered(&reference::markdown(), filter)?)?;
        }
        Some(ScenariosAction::Schema) => {
            printer::lines([serde_json::to_string_pretty(&schema::json_schema())?])?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the text of a built-in scenario or cellar, as written or with all defaults.
fn shown(name: &str, resolved: bool) -> anyhow::Result<String> {
    Ok(match builtin::get(name) {
        Some(text) if !resolved => text.to_owned(),
        Some(_) => Scenario::builtin(name, &[])?.to_resolved_toml(),
        None => {
            // If there is no such name, the error states the nearest one.
            let cellar = Cellar::builtin(name, &[])?;
            let written = cellars::built_in(name).filter(|_| !resolved);
            written.map_or_else(|| cellar.to_resolved_toml(), str::to_owned)
        }
    })
}

described! {
    /// The built-in scenarios.
    pub(crate) struct ScenarioList {
        /// Name and version of the format of this document.
        schema: &'static str ["scenarios/1"],
        /// The built-in scenarios.
        scenarios: Vec<Listed>,
    }

    /// A built-in scenario.
    pub(crate) struct Listed {
        /// Name of the scenario.
        name: &'static str,
        /// Title of the scenario.
        title: String,
    }
}

fn list(json: bool) -> anyhow::Result<()> {
    let cellars = cellars::names_built_in()
        .map(|name| Ok(Listed { name, title: Cellar::builtin(name, &[])?.title }));
    let scenarios = builtin::names()
        .map(|name| Ok(Listed { name, title: Scenario::builtin(name, &[])?.title }))
        .chain(cellars)
        .collect::<anyhow::Result<Vec<_>>>()?;
    if json {
        return printer::document(&ScenarioList { schema: "scenarios/1", scenarios });
    }
    let widest = scenarios.iter().map(|one| one.name.len()).max().unwrap_or(0);
    printer::lines(scenarios.iter().map(|one| format!("{:widest$}  {}", one.name, one.title)))
}

/// Returns the rows of the reference that contain the text `filter`, below the headings of their
/// tables.
fn filtered(reference: &str, filter: &str) -> anyhow::Result<Vec<String>> {
    let wanted = filter.to_lowercase();
    let (mut lines, mut head, mut named) = (Vec::new(), Vec::new(), false);
    for line in reference.lines() {
        let holds = line.to_lowercase().contains(&wanted);
        if line.starts_with("## ") {
            (head, named) = (vec![line], holds);
        } else if line.starts_with("With ")
            || line.starts_with("| field")
            || line.starts_with("|--")
        {
            head.push(line);
        } else if line.starts_with("| ") && (holds || named) {
            let separated = if lines.is_empty() || head.is_empty() { None } else { Some("") };
            lines.extend(separated.into_iter().chain(head.drain(..)).map(str::to_owned));
            lines.push(line.to_owned());
        }
    }
    if lines.is_empty() {
        bail!(
            "no field has \"{filter}\" in its name, its table or its description; leave the filter out to list all \
             fields"
        );
    }
    Ok(lines)
}
