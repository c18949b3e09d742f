//! Invalid record files: each gets one error at its place with the remedy, and nothing is written.

use crate::common;
use std::fmt::Write as _;
use std::fs;

use crate::common::{barrelstack, refused};

/// Refuses a file as the record of the eight-barrel case, with all of the words in its error.
fn refuse(what: &str, name: &str, bytes: &[u8], words: &[&str]) {
    refuse_with(what, name, bytes, &[], words);
}

fn refuse_with(what: &str, name: &str, bytes: &[u8], set: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    let out = folder.path().join("out");
    fs::write(&file, bytes).unwrap();
    let mut arguments = vec!["run", "candia-6-barrels"];
    arguments.extend(["--record", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    for change in set {
        arguments.extend(["--set", change]);
    }
    let named: Vec<&str> = [name].iter().chain(words).copied().collect();
    refused(what, &barrelstack(&arguments), &out, &named);
}

/// A sound file of the PEER database: a header that states its numbers, and rows of five.
fn peer(points: usize) -> String {
    let mut text = String::from(
        "PEER NGA STRONG MOTION DATABASE RECORD\nTest, 1/1/2000, Station, 360\n\
         ACCELERATION TIME SERIES IN UNITS OF G\n",
    );
    let _ = writeln!(text, "NPTS= {points:6}, DT=   .0100 SEC");
    for index in 0..points {
        // Half-second squares: they begin with 0.1, and no filter makes them zero.
        let value = if index % 50 < 25 { 0.1 } else { -0.1 };
        let end = if index % 5 == 4 { "\n" } else { "" };
        let _ = write!(text, "{value:15.7E}{end}");
    }
    text.push('\n');
    text
}

/// The PEER file with a change.
fn changed(from: &str, to: &str) -> Vec<u8> {
    let text = peer(200);
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1).into_bytes()
}

#[test]
fn files_that_are_no_records() {
    refuse("empty", "empty.at2", b"", &["empty file", "again"]);
    refuse("blank", "blank.at2", b" \n\n \n", &["empty file"]);
    refuse("zeros", "zeros.at2", &[0; 4096], &["expected", "found"]);
    refuse("picture", "photo.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0", &["expected", "found"]);
    refuse("letter", "letter.txt", b"Dear sir,\nplease find attached\n", &["Dear sir", "columns"]);
    refuse(
        "web page",
        "record.at2",
        b"<!DOCTYPE html>\n<html><body>404</body></html>\n",
        &["found"],
    );
    refuse("archive", "records.zip", b"PK\x03\x04\x14\0\0\0\x08\0", &["archive"]);
    refuse("scenario", "mine.toml", b"schema = 1\n[stack]\nlevels = 4\n", &["schema = 1"]);
    let mut utf16 = vec![0xff, 0xfe];
    utf16.extend(peer(10).encode_utf16().flat_map(u16::to_le_bytes));
    refuse("UTF-16", "utf16.at2", &utf16, &["UTF-16", "UTF-8"]);
}

#[test]
fn records_of_something_else() {
    let of = |what: &str| changed("ACCELERATION TIME SERIES IN UNITS OF G", what);
    refuse(
        "velocity",
        "a.vt2",
        &of("VELOCITY TIME SERIES IN UNITS OF CM/S"),
        &["VELOCITY", ".AT2"],
    );
    refuse(
        "displacement",
        "a.dt2",
        &of("DISPLACEMENT TIME SERIES IN UNITS OF CM"),
        &["DISPLACEMENT"],
    );
    let spectra = "PEER NGA STRONG MOTION DATABASE RECORD\nTest, 1/1/2000, Station, 360\n\
                   RESPONSE SPECTRA, 5% DAMPING, PSA IN UNITS OF G\nPERIOD(SEC) PSA(G)\n\
                   0.010 0.123\n0.020 0.130\n0.050 0.155\n";
    refuse("spectra", "a.spec", spectra.as_bytes(), &["expected", "found"]);
}

#[test]
fn peer_files_that_are_damaged() {
    refuse("cut", "a.at2", &peer(200).as_bytes()[..900], &["200"]);
    refuse(
        "wrong count",
        "a.at2",
        &changed("NPTS=    200", "NPTS=    240"),
        &["line 4", "240", "200"],
    );
    refuse("no count", "a.at2", &changed("NPTS=    200", "NPTS=      x"), &["line 4", "NPTS"]);
    refuse("no step", "a.at2", &changed(".0100", "0.000"), &["step"]);
    refuse("minus step", "a.at2", &changed(".0100", "-.010"), &["step"]);
    refuse("endless count", "a.at2", &changed("   200", "9999999999999999999"), &["line 4"]);
    refuse("stars", "a.at2", &changed("  1.0000000E-1", "**************"), &["line 5", "*"]);
    refuse("nan", "a.at2", &changed("  1.0000000E-1", "           NaN"), &["line 5", "NaN"]);
    refuse("word", "a.at2", &changed("  1.0000000E-1", "        banana"), &["line 5", "banana"]);
    refuse("huge", "a.at2", &changed("1.0000000E-1", "1.00000E+300"), &["line 5", "1e300", "unit"]);
    refuse(
        "infinite",
        "a.at2",
        &changed("1.0000000E-1", "1.00000E+999"),
        &["line 5", "1.00000E+999"],
    );
    refuse("one value", "a.at2", peer(1).as_bytes(), &["2 samples"]);
    // Commas as decimal marks throughout the file, which make two numbers of each.
    let comma = peer(200).replace('.', ",").replacen(",0100", ".0100", 1);
    refuse("comma", "a.at2", comma.as_bytes(), &["line 4", "200", "400"]);
}

#[test]
fn columns_that_leave_something_out() {
    refuse("no unit", "a.csv", b"0.00 0.1\n0.01 0.2\n0.02 -0.3\n", &["unit", "motion.unit"]);
    let unit = &["motion.unit=1 g"][..];
    refuse_with("no step", "a.txt", b"0.1\n0.2\n-0.3\n0.1\n", unit, &["motion.time_step"]);
    refuse_with(
        "back",
        "a.csv",
        b"0.00 0.1\n0.01 0.2\n0.00 -0.3\n0.01 0.1\n",
        unit,
        &["names above the columns"],
    );
    refuse_with(
        "ragged",
        "a.csv",
        b"0.00 0.1\n0.01\n0.02 -0.3\n",
        unit,
        &["line 1", "rows with equally many numbers"],
    );
    refuse_with("text", "a.csv", b"0.00 0.1\n0.01 high\n0.02 -0.3\n", unit, &["line 2", "high"]);
    let still = b"0.00 0.0\n0.01 0.0\n0.02 0.0\n0.03 0.0\n";
    refuse_with("still", "a.csv", still, unit, &["a channel whose values vary"]);
}

#[test]
fn paths_that_are_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = folder.path().to_str().unwrap();
    let arguments = ["run", "candia-6-barrels", "--out", out.to_str().unwrap(), "--record"];
    let with = |path: &str| barrelstack(arguments.iter().copied().chain([path]));
    refused("folder", &with(place), &out, &[place, "a folder, not a file", "--record"]);
    let missing = folder.path().join("none.at2");
    let missing = missing.to_str().unwrap();
    refused("missing", &with(missing), &out, &[missing, "no such file", "--record"]);
    refused("empty name", &with(""), &out, &["--record"]);
}

/// Users of these commands wrote no study: what they named is an option, a folder, a file.
#[test]
fn records_of_pages_are_refused_by_the_option_that_names_them() {
    const FOLDER: [&str; 2] = ["protect", "--motions"];
    const FILES: [[&str; 2]; 2] = [["protect", "--record"], ["heights", "--record"]];
    let all = [FOLDER, FILES[0], FILES[1]];
    let unit = "time (s),a\n0,1\n0.01,2\n0.02,-3\n";
    let good = peer(200);
    for (files, words, commands) in [
        (&[("bad.csv", "")][..], "found an empty file", &all[..]),
        (&[("bad.csv", "To be added.\n")], "as first line", &all),
        (&[("bad.csv", unit)], "`barrelstack motion convert` with --unit", &all),
        (
            &[("a.at2", &good), ("a.txt", &good)],
            "the name \"a\"; give each motion its own name",
            &[FOLDER],
        ),
        (&[], "no file in the folder", &[FOLDER]),
        (&[], "there is no such file; correct the path", &FILES),
    ] {
        let place = tempfile::tempdir().unwrap();
        let (folder, out) = (place.path().join("records"), place.path().join("out"));
        fs::create_dir(&folder).unwrap();
        for (name, text) in files {
            fs::write(folder.join(name), text).unwrap();
        }
        for [command, option] in commands {
            let named = if *option == FOLDER[1] { folder.clone() } else { folder.join("bad.csv") };
            let (named, to) = (named.to_str().unwrap(), out.to_str().unwrap());
            let said = barrelstack([command, option, named, "--quiet", "--out", to]);
            assert_eq!(said.status.code(), Some(2), "{command} {option}");
            let said = common::stderr(&said);
            assert!(said.starts_with(&format!("error: {option}")), "{command}: {said}");
            assert!(said.contains(words), "{command} {option}: {said}");
            for no in ["study file", "of the study", "protection.toml", "transverse.toml"] {
                assert!(!said.contains(no), "{command} {option}: {said}");
            }
        }
    }
}

#[test]
fn a_file_outside_the_folder_of_a_scenario_is_not_quoted_unless_the_user_names_it() {
    let place = tempfile::tempdir().unwrap();
    let (secret, folder) = (place.path().join("secret.txt"), place.path().join("scenario"));
    fs::create_dir(&folder).unwrap();
    let (inside, out) = (folder.join("inside.txt"), folder.join("out"));
    let scenario = folder.join("mine.toml");
    for path in [&secret, &inside] {
        fs::write(path, "Dear sir,\nplease find attached\n").unwrap();
    }
    for (record, quoted) in [("../secret.txt", false), ("inside.txt", true)] {
        let text =
            format!("schema = 1\nextends = \"demo-napa\"\n[motion]\nrecord = \"{record}\"\n");
        fs::write(&scenario, text).unwrap();
        let said = barrelstack(["run", scenario.to_str().unwrap()]);
        refused(record, &said, &out, &[record, if quoted { "Dear sir" } else { "not shown" }]);
        assert_eq!(common::stderr(&said).contains("Dear sir"), quoted);
    }
    let named = ["run", "demo-napa", "--record", secret.to_str().unwrap()];
    refused("named", &barrelstack(named), &out, &["Dear sir"]);
}

/// Returns two columns of two seconds whose third time is late.
fn uneven() -> Vec<u8> {
    let mut text = String::from("0.00 0.1\n0.01 0.2\n0.05 -0.3\n");
    for index in 6..200 {
        let _ = writeln!(
            text,
            "{:.2} {}",
            0.01 * f64::from(index),
            if index % 50 < 25 { 0.1 } else { -0.1 }
        );
    }
    text.into_bytes()
}

#[test]
fn records_of_a_single_reading_are_read_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, set, words) in [
        ("a.at2", changed("NPTS=    200", "NPTS=    199"), "title=a", ["line 4", "199 values"]),
        ("a.csv", uneven(), "motion.unit=1 g", ["line 1", "unevenly spaced"]),
    ] {
        let file = folder.path().join(name);
        fs::write(&file, bytes).unwrap();
        let output = barrelstack([
            "check",
            "candia-6-barrels",
            "--record",
            file.to_str().unwrap(),
            "--set",
            set,
        ]);
        let text = common::stdout(&output);
        assert_eq!(output.status.code(), Some(0), "{}", common::stderr(&output));
        for word in [name].into_iter().chain(words) {
            assert!(text.contains(word), "{name}: no {word:?} in {text}");
        }
    }
}
