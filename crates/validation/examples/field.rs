//! Runs the hindcasts of real earthquakes and writes `validation/field.md` with its tables and its figure.
//!
//! ```text
//! cargo xtask field --records DIR
//! ```
//!
//! Without `--records` only the record that comes with the program is run; the cases of the other earthquakes stay as
//! they are, and the program lists them.
//! A study that was interrupted continues from where it stopped (`target/field`).
//! `--page` runs nothing and writes the page from the cases that are there; `--only TEXT` runs the studies whose name
//! contains the text.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use std::cell::RefCell;
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack_campaign::study::{RunOptions, Study, StudyTable};
use barrelstack_validation::field::{COLUMNS, evaluate};

fn main() -> Result<(), Box<dyn Error>> {
    let (mut records, mut only, mut page) = (None, String::new(), false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--records" => records = Some(PathBuf::from(arguments.next().ok_or("--records DIR")?)),
            "--only" => only = arguments.next().ok_or("--only TEXT")?,
            "--page" => page = true,
            other => return Err(format!("there is no option `{other}`").into()),
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let field = root.join("validation/field");
    let mut skipped = Vec::new();
    for (name, text) in files(&field.join("studies"), "toml")? {
        if page || !name.contains(&only) {
            continue;
        }
        match run(&name, &text, records.as_deref(), &root.join("target/field").join(&name))? {
            Ok(table) => {
                let csv = cases(&table);
                fs::write(field.join(format!("cases/{name}.csv")), csv)?;
                println!("{name}: {} cases", table.rows());
            }
            Err(record) => skipped.push(format!("{name}: {record}")),
        }
    }
    if !skipped.is_empty() {
        println!(
            "skipped without their records, whose folder `--records DIR` states; the cases of these hindcasts are \
             those of an earlier run:\n  {}",
            skipped.join("\n  ")
        );
    }
    let observations = fs::read_to_string(field.join("observations.toml"))?;
    let written = evaluate(&observations, &files(&field.join("cases"), "csv")?)?;
    for (name, text) in written {
        fs::write(root.join("validation").join(&name), text)?;
        println!("validation/{name}");
    }
    Ok(())
}

/// Returns the names, without their ending, and the texts of the files of a folder, in the order of their names.
fn files(folder: &Path, ending: &str) -> Result<Vec<(String, String)>, Box<dyn Error>> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    paths.retain(|path| path.extension().is_some_and(|found| found == ending));
    paths.sort();
    let read = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, fs::read_to_string(path)?))
    };
    paths.iter().map(read).collect()
}

/// Runs a study in a folder; a study whose record is not there gives the path of the record.
fn run(
    name: &str,
    text: &str,
    records: Option<&Path>,
    folder: &Path,
) -> Result<Result<StudyTable, String>, Box<dyn Error>> {
    let missing = RefCell::new(None);
    let study = Study::parse_with(&format!("{name}.toml"), text, &mut |path| {
        let read = records.map_or_else(
            || Err("no folder of records".to_owned()),
            |folder| fs::read(folder.join(path)).map_err(|error| error.to_string()),
        );
        if read.is_err() {
            *missing.borrow_mut() = Some(path.display().to_string());
        }
        read
    });
    if let Some(record) = missing.into_inner() {
        return Ok(Err(record));
    }
    let collected = study?.run(folder, &RunOptions::default(), &|_| ControlFlow::Continue(()))?;
    Ok(Ok(collected.table))
}

/// Returns the columns of cases that the page uses.
fn cases(table: &StudyTable) -> String {
    let number = |name: &str, row: usize, factor: f64| {
        let value = table.numbers(name).and_then(|column| column[row]);
        value.map_or_else(String::new, |value| format!("{}", rounded(value * factor)))
    };
    let integer = |name: &str, row: usize| {
        let value = table.integers(name).and_then(|column| column[row]);
        value.map_or_else(String::new, |value| value.to_string())
    };
    let text = |name: &str, row: usize| {
        table.texts(name).and_then(|column| column[row].clone()).unwrap_or_default()
    };
    let mut lines = vec![COLUMNS.join(",")];
    for row in 0..table.rows() {
        let cells = [
            integer("levels", row),
            number("azimuth", row, 180.0 / std::f64::consts::PI),
            number("friction barrel-rack", row, 1.0),
            number("friction rack-ground", row, 1.0),
            number("stiffness of a seat", row, 1e-6),
            text("record", row),
            number("scale_factor", row, 1.0),
            number("pgv", row, 1.0),
            text("outcome", row),
            text("mode", row),
            number("first_loss", row, 1.0),
            integer("barrels", row),
            integer("barrels_fallen", row),
            text("heading", row),
        ];
        lines.push(cells.join(","));
    }
    lines.join("\n") + "\n"
}

/// Rounds to four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
