//! Output files of an answer in space.

use std::fmt::Write as _;

use barrelstack::export::dictionary;
use barrelstack_report::column::{column_name, to_csv};
use barrelstack_report::{csv_field, html, shortest};

use crate::columns;
use crate::report::document;
use crate::run::Run;
use crate::variants::Answer;

/// Returns the files of an answer with their names, the report last.
pub fn files(answer: &Answer, resolved: &str) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![
        ("summary.json", answer.summary.to_json() + "\n"),
        ("scenario.toml", resolved.to_owned()),
        ("variants.csv", to_csv(&columns::variants(&answer.cases))),
        ("frames.csv", frames_csv(&answer.run)),
        ("report.html", html(&document(answer))),
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

/// Writes all poses: time (s), and of every body its position (m) and the quaternion of its rotation.
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
