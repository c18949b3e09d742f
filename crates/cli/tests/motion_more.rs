//! Scaling to both horizontals, joining of parts, other dampings, and scenarios with counts.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use common::{barrelstack, stderr, stdout};
use serde_json::Value;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn told(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// What `motion` says where it refuses.
fn refused(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    stderr(&output)
}

/// Two components and a vertical that shake for eight seconds.
fn record(folder: &Path) -> std::path::PathBuf {
    let mut rows = String::from("# acceleration (m/s2)\ntime (s),90,0,UP\n");
    for k in 0..1600 {
        let t = 0.005 * f64::from(k);
        let (a, b) = ((9.0 * t).sin() * (-0.3 * t).exp(), (5.0 * t + 0.4).sin() * (-0.4 * t).exp());
        writeln!(rows, "{t:.3},{:.6},{:.6},{:.6}", 2.0 * a, 1.5 * b, 0.5 * a * b).unwrap();
    }
    let file = folder.join("two.csv");
    fs::write(&file, rows).unwrap();
    file
}

#[test]
fn both_horizontals_reach_their_goal_with_one_factor_for_all() {
    let folder = tempfile::tempdir().unwrap();
    let file = record(folder.path());
    for of in ["rotd50", "rotd100", "geomean"] {
        let out = folder.path().join(format!("{of}.txt"));
        let said =
            told(&["scale", text(&file), "--to", "sa(0.5)=0.6 g", "--of", of, "-o", text(&out)]);
        assert!(said.contains(of), "{said}");
        let document: Value =
            serde_json::from_str(&told(&["info", "--json", "--all-measures", text(&out)])).unwrap();
        let record = &document["records"][0];
        let g = 9.806_65;
        let reached = if of == "geomean" {
            let sa = |k: usize| {
                record["channels"][k]["measures"]["sa(0.5,0.05)"]["value"].as_f64().unwrap()
            };
            (sa(0) * sa(1)).sqrt()
        } else {
            let rows = record["over_all_directions"].as_array().unwrap();
            let row = rows.iter().find(|row| row["measure"] == "sa(0.5,0.05)").unwrap();
            row[of].as_f64().unwrap()
        };
        assert!((reached / (0.6 * g) - 1.0).abs() < 1e-9, "{of}: {reached}"); // measured 1e-15
        let pga = |k: usize| record["channels"][k]["measures"]["pga"]["value"].as_f64().unwrap();
        let before: Value = serde_json::from_str(&told(&["info", "--json", text(&file)])).unwrap();
        let old = |k: usize| {
            before["records"][0]["channels"][k]["measures"]["pga"]["value"].as_f64().unwrap()
        };
        assert!((pga(2) / old(2) / (pga(0) / old(0)) - 1.0).abs() < 1e-12);
    }
    let single = folder.path().join("one.txt");
    told(&["convert", text(&file), "--component", "90", "-o", text(&single)]);
    let out = folder.path().join("no.txt");
    let arguments =
        ["scale", text(&single), "--to", "pgv=1 m/s", "--of", "rotd50", "-o", text(&out)];
    let error = refused(&arguments);
    assert!(error.contains("two horizontal components"), "{error}");
}

#[test]
fn the_index_of_fajfar_can_be_scaled_to() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (record(folder.path()), folder.path().join("out.txt"));
    told(&["scale", text(&file), "--to", "fajfar=0.9", "-o", text(&out)]);
    let said = told(&["info", "--all-measures", text(&out)]);
    let row = said.lines().find(|line| line.contains("Fajfar")).unwrap();
    assert!(row.contains("0.9000"), "{row}");
}

#[test]
fn plain_parts_of_one_record_are_joined_where_they_repeat() {
    let folder = tempfile::tempdir().unwrap();
    let value = |k: usize| {
        let t = 0.01 * f64::from(u32::try_from(k).unwrap());
        (7.0 * t).sin() + 0.6 * (3.1 * t * t.sqrt()).cos()
    };
    let write = |name: &str, from: usize, to: usize, offset: f64| {
        let file = folder.path().join(name);
        let rows: String =
            (from..to).fold(String::new(), |text, k| text + &format!("{:.6}\n", value(k) + offset));
        fs::write(&file, rows).unwrap();
        file
    };
    let (one, two) = (write("part1.txt", 0, 1500, 0.0), write("part2.txt", 1200, 3000, 0.05));
    let whole = folder.path().join("whole.txt");
    let given = ["--unit", "m/s2", "--time-step", "0.01 s"];
    let said = told(
        &[&["convert", "--join", text(&one), text(&two)], &given[..], &["-o", text(&whole)]]
            .concat(),
    );
    assert!(said.contains("joined where its first 3.00 s repeat"), "{said}");
    let numbers: Vec<f64> = fs::read_to_string(&whole)
        .unwrap()
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.parse().unwrap())
        .collect();
    assert_eq!(numbers.len(), 3000);
    for (k, number) in numbers.iter().enumerate() {
        assert!((number - value(k)).abs() < 2e-6, "{k}: {number}"); // measured 6e-7
    }
}

#[test]
fn a_code_without_a_damping_correction_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (record(folder.path()), folder.path().join("out.txt"));
    let to = "nzs1170:z=0.3,site=C,damping=0.1";
    let error = refused(&["match", text(&file), "--to", to, "-o", text(&out)]);
    assert!(error.contains("for 5 % of damping"), "{error}");
}
