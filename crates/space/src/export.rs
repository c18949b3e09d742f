//! Output files for the result of a three-dimensional scenario.

use std::fmt::Write as _;

use barrelstack::export::{ExportError, dictionary};
use barrelstack::render::{RenderFolder, Rendered, Rendering};
use barrelstack_report::column::column_name;
use barrelstack_report::{Language, csv_field, html, paraview_of_solids, shortest};

use crate::columns;
use crate::drawing::{Sight, scene};
use crate::fate::Heading;
use crate::mesh::solids;
use crate::report::document;
use crate::run::Run;
use crate::variants::Answer;

/// Returns the names and contents of the output files for a result. The report is written in the given language.
pub fn files(answer: &Answer, resolved: &str, language: Language) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![
        ("summary.json", answer.summary.to_json() + "\n"),
        ("scenario.toml", resolved.to_owned()),
        ("variants.csv", variants_csv(answer)),
        ("frames.csv", frames_csv(&answer.run)),
        ("report.html", html(&document(answer).in_language(language))),
    ];
    if answer.run.stack.is_free() {
        // A free scene has no variants.
        files.retain(|(name, _)| *name != "variants.csv");
    }
    let mut files: Vec<_> =
        files.into_iter().map(|(name, text)| (name.to_owned(), text.into_bytes())).collect();
    files.push(dictionary(&files, &columns::meaning));
    files
}

/// Writes the selected renderings of the run that is shown in detail. The animation and the frames are drawn in the
/// view in which the first body leaves its seat. If no body leaves its seat, they are drawn in the view across the
/// barrels.
///
/// # Errors
/// If a file cannot be written.
pub fn render(
    answer: &Answer,
    folder: &RenderFolder,
    how: &Rendering,
) -> Result<Vec<Rendered>, ExportError> {
    let along = answer.run.heading.is_some_and(|heading| !heading.is_across());
    let scene = scene(&answer.run, if along { Sight::Along } else { Sight::Across });
    folder.write_by(|| document(answer), &scene, how, &mut |_, put| {
        let solids = solids(&answer.run, how.between.unwrap_or([0.0, f64::INFINITY]));
        paraview_of_solids(&solids, how.rate, put)
    })
}

/// Returns the table of all poses: time (s), and the position (m) and rotation (a quaternion) of every body.
fn frames_csv(run: &Run) -> String {
    let mut text = String::from("time (s)");
    for part in &run.stack.parts {
        for column in ["x (m)", "y (m)", "z (m)", "qw", "qx", "qy", "qz"] {
            let _ =
                write!(text, ",{}", csv_field(&format!("{}_{column}", column_name(&part.name))));
        }
    }
    text.push('\n');
    for (time, poses) in run.frames.times.iter().zip(&run.frames.poses) {
        text.push_str(&shortest(*time));
        for value in poses.iter().flatten() {
            text.push(',');
            text.push_str(&shortest(*value));
        }
        text.push('\n');
    }
    text
}

/// Returns the table of variants, with one row for each variant; variant 0 is the scenario as stated.
fn variants_csv(answer: &Answer) -> String {
    let mut text = String::from(
        "variant,outcome,mode,first_loss (s),first_body,heading,first_fall (s),barrels_fallen,debris_right,debris_left,\
         debris_away,debris_near,energy_residual_ratio,error\n",
    );
    for (number, case) in answer.cases.iter().enumerate() {
        use barrelstack::outcome::Outcome;
        let result = &case.result;
        let (kind, mode, time, first, reason) = match &result.outcome {
            // An interrupted case has no row.
            Ok(Outcome::Interrupted) => continue,
            Ok(Outcome::Collapse { mode, time, first, .. }) => {
                ("collapse", mode.name(), Some(*time), first.as_str(), "")
            }
            Ok(Outcome::Invalid { reason }) => ("invalid", "", None, "", reason.as_str()),
            Ok(outcome) => (outcome.kind(), "", None, "", ""),
            Err(reason) => ("error", "", None, "", reason.as_str()),
        };
        let number_or_none = |value: Option<f64>| value.map(shortest).unwrap_or_default();
        let debris = |heading: Heading| case.debris.iter().filter(|one| **one == heading).count();
        let _ = writeln!(
            text,
            "{number},{kind},{mode},{},{},{},{},{},{},{},{},{},{},{}",
            number_or_none(time),
            csv_field(first),
            case.first.map_or("", Heading::name),
            number_or_none(result.first_fall),
            result.falls.iter().filter(|(_, at)| at.is_some()).count(),
            debris(Heading::Right),
            debris(Heading::Left),
            debris(Heading::Away),
            debris(Heading::Near),
            number_or_none(result.energy_residual_ratio),
            csv_field(reason)
        );
    }
    text
}
