//! Tables for spreadsheet programs: workbooks hold what the CSV files hold, and decimal commas change only the notation.

use std::fs::{self, read_to_string};
use std::path::Path;

use calamine::{Data, Reader as _, Xlsx, open_workbook};

use crate::common::{HEAD, STUDY, program, stderr};

/// Runs the command in a folder.
fn run(folder: &Path, arguments: &[&str]) {
    let output = program(arguments).current_dir(folder).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
}

/// Cells of a table; a quoted cell has no line breaks.
fn cells(csv: &str, separator: char) -> Vec<Vec<String>> {
    let row = |line: &str| {
        let (mut row, mut quoted) = (vec![String::new()], false);
        let mut letters = line.chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '"' if quoted && letters.next_if_eq(&'"').is_some() => {
                    row.last_mut().unwrap().push('"');
                }
                '"' => quoted = !quoted,
                _ if letter == separator && !quoted => row.push(String::new()),
                _ => row.last_mut().unwrap().push(letter),
            }
        }
        row
    };
    csv.lines().map(row).collect()
}

/// Compares every sheet of a workbook with the CSV file of its name, and returns the sheet of the provenance as text.
fn compared(folder: &Path) -> String {
    let mut book: Xlsx<_> = open_workbook(folder.join("tables.xlsx")).unwrap();
    let mut about = String::new();
    let mut numbers = 0;
    for (name, sheet) in book.worksheets() {
        if name == "provenance" {
            let rows: Vec<_> = sheet.rows().map(|row| format!("{}: {}", row[0], row[1])).collect();
            about = rows.join("\n");
            continue;
        }
        let csv = read_to_string(folder.join(format!("{name}.csv"))).unwrap();
        assert_eq!(sheet.height(), csv.lines().count(), "{name}");
        for (row, cells) in sheet.rows().zip(cells(&csv, ',')) {
            assert_eq!(row.len(), cells.len(), "{name}");
            for (found, expected) in row.iter().zip(&cells) {
                if let Data::Float(value) = found {
                    numbers += 1;
                    assert_eq!(
                        value.to_bits(),
                        expected.parse::<f64>().unwrap().to_bits(),
                        "{name}: {expected}"
                    );
                } else {
                    assert_eq!(found.to_string(), *expected, "{name}");
                }
            }
        }
    }
    assert!(numbers > 10, "{numbers} numbers");
    about
}

#[test]
fn the_workbook_of_a_run_holds_its_tables_with_their_numbers() {
    let place = tempfile::tempdir().unwrap();
    let of = [
        "run",
        "candia-8-barrels",
        "--set=run.duration=1 s",
        "--variants=2",
        "--no-remedy",
        "--quiet",
    ];
    run(place.path(), &[&of[..], &["--xlsx", "--out", "a"]].concat());
    let folder = place.path().join("a");
    let about = compared(&folder);
    for part in ["written by: barrelstack 0.1.0", "scenario_hash: "] {
        assert!(about.contains(part), "{part} is not in {about}");
    }
    let book: Xlsx<_> = open_workbook(folder.join("tables.xlsx")).unwrap();
    let names = ["variants", "histories", "forces", "envelopes", "frames", "columns", "provenance"];
    assert_eq!(book.sheet_names(), names);
    // Equal results give equal files.
    run(place.path(), &[&of[..], &["--xlsx", "--out", "b"]].concat());
    assert_eq!(
        fs::read(folder.join("tables.xlsx")).unwrap(),
        fs::read(place.path().join("b/tables.xlsx")).unwrap()
    );
    run(place.path(), &[&of[..], &["--decimal-comma", "--out", "c"]].concat());
    let [points, commas] =
        ["a", "c"].map(|of| read_to_string(place.path().join(of).join("histories.csv")).unwrap());
    assert!(commas.starts_with("time (s);"), "{commas:.100}");
    let back = cells(&commas, ';').into_iter().map(|row| row.join(",").split(',').count());
    assert!(back.max() > Some(cells(&points, ',')[0].len()), "there are decimal commas");
    let same: Vec<Vec<String>> = cells(&commas, ';')
        .into_iter()
        .map(|row| row.into_iter().map(|cell| cell.replace(',', ".")).collect())
        .collect();
    assert_eq!(same, cells(&points, ','));
}

#[test]
fn studies_and_records_have_workbooks() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("s.toml"), format!("{HEAD}{STUDY}")).unwrap();
    run(place.path(), &["study", "s.toml", "--xlsx", "--quiet", "--out", "study"]);
    let about = compared(&place.path().join("study"));
    assert!(about.contains("study_hash: "), "{about}");
    fs::remove_file(place.path().join("study/tables.xlsx")).unwrap();
    run(place.path(), &["study", "collect", "study", "--xlsx"]);
    compared(&place.path().join("study"));
    fs::create_dir(place.path().join("records")).unwrap();
    for name in ["records/a.txt", "records/b.txt"] {
        run(place.path(), &["motion", "synth", "clough-penzien", "--duration=5 s", "-o", name]);
    }
    run(place.path(), &["motion", "info", "records", "--xlsx", "--quiet", "--out", "measures"]);
    compared(&place.path().join("measures"));
    run(place.path(), &["motion", "spectrum", "records/a.txt", "-o", "a.xlsx"]);
    run(place.path(), &["motion", "spectrum", "records/a.txt", "-o", "a.csv"]);
    let mut book: Xlsx<_> = open_workbook(place.path().join("a.xlsx")).unwrap();
    let sheet = book.worksheet_range("a").unwrap();
    let csv = cells(&read_to_string(place.path().join("a.csv")).unwrap(), ',');
    assert_eq!(sheet.height(), csv.len());
    assert_eq!(sheet.get((5, 2)).unwrap().to_string().parse::<f64>(), csv[5][2].parse::<f64>());
    // In a set of records, all three tables are written once, in the requested notation.
    let select = [
        "motion",
        "select",
        "records",
        "--target=ec8:ag=0.3,site=B",
        "--spectrum=h1",
        "--scale=0.01..1000",
    ];
    run(
        place.path(),
        &[&select[..], &["--count=2", "--quiet", "--decimal-comma", "--xlsx", "--out", "set"]]
            .concat(),
    );
    let [set, records] = ["selection", "records"]
        .map(|name| read_to_string(place.path().join(format!("set/{name}.csv"))).unwrap());
    assert!(set.starts_with("record;files;event;factor;"), "{set}");
    let [heading, row] = [0, 1].map(|line| cells(&records, ';').swap_remove(line));
    assert_eq!(heading.len(), row.len());
    assert!(
        row.iter()
            .any(|cell| cell.replace(',', ".").parse::<f64>().is_ok_and(|x| x.fract() != 0.0)),
        "{row:?}"
    );
    let book: Xlsx<_> = open_workbook(place.path().join("set/tables.xlsx")).unwrap();
    assert_eq!(book.sheet_names(), ["selection", "records", "refused", "provenance"]);
}
