//! `barrelstack schema`: JSON schemas of the documents that the commands print.

use std::process::ExitCode;

use anyhow::bail;
use barrelstack::Summary;
use barrelstack::compare::Comparison;
use barrelstack_calibration::CalibrationDocument;
use barrelstack_campaign::decision::DecisionDocument;
use barrelstack_campaign::heights::HeightsDocument;
use barrelstack_campaign::protect::ProtectDocument;
use barrelstack_campaign::score::ScoreDocument;
use barrelstack_cellar::comparison::CellarComparison;
use barrelstack_input::names::nearest;
use barrelstack_report::described;
use serde_json::Value;

use super::motion::MotionInfo;
use super::scenarios::ScenarioList;
use super::study::{StudyPlan, StudyResult, StudyStatus};
use crate::printer::{self, ErrorDocument};

/// Arguments of `schema`.
#[derive(Debug, clap::Args)]
pub(crate) struct SchemaArgs {
    /// Name of the document; if no name is given, all documents are listed.
    name: Option<String>,
    /// Print a table of key, unit and meaning in place of the JSON Schema.
    #[arg(long, requires = "name")]
    dictionary: bool,
}

/// A document, the command that prints the document, and the schema of the document.
struct Known {
    name: &'static str,
    of: &'static str,
    schema: fn() -> Value,
}

/// Declares the documents by name, type and command.
macro_rules! documents {
    ($($name:literal $type:ty: $of:literal;)*) => {
        const DOCUMENTS: &[Known] = &[$(Known {
            name: $name,
            of: $of,
            schema: || described::document::<$type>($name),
        }),*];
    };
}

documents! {
    "summary" Summary: "run --json, and summary.json of --out";
    "space" barrelstack_space::Summary: "run --json where stack.view is \"spatial\", and summary.json of --out";
    "cellar" barrelstack_cellar::summary::CellarSummary: "run --json of a cellar, and cellar.json of --out";
    "aftershocks" barrelstack_cellar::aftershocks::AftershockSummary: "aftershock --json with several strengths, and aftershocks.json of --out";
    "cellar-plan" barrelstack_cellar::plan::PlanSummary: "check --json of a cellar";
    "check" barrelstack::check::Checked: "check --json";
    "stability" barrelstack::stability::StabilityTable: "check --table --json";
    "cellar-comparison" CellarComparison: "compare --json of cellars, and comparison.json of --out";
    "comparison" Comparison: "compare --json";
    "heights" HeightsDocument: "heights --json, and heights.json of --out";
    "protect" ProtectDocument: "protect --json, and protect.json of --out";
    "rockscore" ScoreDocument: "score --json, and rockscore.json of --out";
    "scenarios" ScenarioList: "scenarios --json";
    "study-plan" StudyPlan: "study plan --json";
    "study-result" StudyResult: "study --json and study collect --json";
    "study-status" StudyStatus: "study status --json";
    "decision" DecisionDocument: "study report --json, and the file decision.json that --out writes";
    "calibration" CalibrationDocument: "calibrate --json";
    "motion-info" MotionInfo: "motion info --json";
    "error" ErrorDocument: "any command with --json that fails";
}

/// Prints the schema of one document, or lists all documents.
pub(crate) fn schema(args: &SchemaArgs) -> anyhow::Result<ExitCode> {
    let Some(name) = &args.name else {
        let lines = DOCUMENTS.iter().map(|known| format!("{:19}{}", known.name, known.of));
        printer::lines(lines)?;
        return Ok(ExitCode::SUCCESS);
    };
    // The name inside a document ends in its version.
    let wanted = name.split('/').next().unwrap_or(name);
    let Some(known) = DOCUMENTS.iter().find(|known| known.name == wanted) else {
        let names: Vec<&str> = DOCUMENTS.iter().map(|known| known.name).collect();
        let next = match nearest(wanted, &names) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("use one of these names: {}", names.join(", ")),
        };
        bail!("there is no document \"{name}\"; {next}");
    };
    let schema = (known.schema)();
    if args.dictionary {
        let rows = described::dictionary(&schema);
        let width = |column: usize| {
            rows.iter().map(|row: &[String; 3]| row[column].chars().count()).max().unwrap_or(0)
        };
        let (key, unit) = (width(0), width(1));
        let line = |row: &[String; 3]| format!("{:key$}  {:unit$}  {}", row[0], row[1], row[2]);
        printer::lines(rows.iter().map(line))?;
    } else {
        printer::document(&schema)?;
    }
    Ok(ExitCode::SUCCESS)
}
