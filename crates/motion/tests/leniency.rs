//! Excess content in agency files is ignored with a warning; missing content is an error; uneven
//! times are not taken as even.

#![allow(clippy::format_collect, reason = "a test fails by unwrap; small tables are built as text")]

use std::fmt::Write as _;
use std::path::Path;

use barrelstack_motion::{ReadOptions, Record, STANDARD_GRAVITY, read};

fn bytes(file: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)).unwrap()
}

fn given(bytes: &[u8]) -> Record {
    read(bytes, "file", &ReadOptions::default()).unwrap()
}

fn warnings_of(record: &Record) -> String {
    record.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Checks that a file with an addition is read as the same numbers as without the addition.
fn same(file: &str, changed: &[u8], word: &str) {
    let (clean, record) = (given(&bytes(file)), given(changed));
    assert_eq!(clean.channels, record.channels, "{file}");
    assert!(warnings_of(&record).contains(word), "{file}: {}", warnings_of(&record));
}

#[test]
fn rows_and_padding_behind_the_stated_count_are_left_out() {
    for file in ["smc/corrected.smc", "smc/uncorrected.smc"] {
        let mut rows = bytes(file);
        rows.extend(b" 1.0000E+0 2.0000E+0 3.0000E+0 4.0000E+0\n 1.0000E+0\n");
        same(file, &rows, "5 numbers follow");
        let mut zeros = bytes(file);
        zeros.extend([0_u8; 512]);
        assert_eq!(given(&zeros).channels, given(&bytes(file)).channels);
        let mut both = bytes(file);
        both.extend(b" 1.0000E+0\n");
        both.extend([0_u8; 80]);
        both.extend(b"\n");
        same(file, &both, "1 numbers follow");
        let mut words = bytes(file);
        words.extend(b"end of file\n");
        same(file, &words, "from this line to the end");
        // A missing row remains an error.
        let text = String::from_utf8(bytes(file)).unwrap();
        let cut: Vec<&str> = text.lines().collect();
        let cut = cut[..cut.len() - 2].join("\n");
        let error = read(cut.as_bytes(), "cut", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("the file is truncated"), "{error}");
    }
}

#[test]
fn numbers_in_excess_on_the_last_line_are_left_out() {
    let file = "csmip-v2/example.V2";
    let text = String::from_utf8(bytes(file)).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    // The line before the first block of velocities is the last line of accelerations, and is
    // short.
    let last = lines.iter().position(|line| line.contains("veloc data")).unwrap() - 1;
    let mut more: Vec<String> = lines.iter().map(ToString::to_string).collect();
    more[last] += "   .000000";
    more.insert(last + 1, "   .000000   .000000".to_owned());
    same(file, more.join("\n").as_bytes(), "3 numbers follow the 103");
}

#[test]
fn formats_that_count_their_rows_leave_the_rest_out() {
    for (file, row, word) in [
        ("afad/example.txt", "0.1 0.2 0.3\n", "the last 7 are ignored"),
        ("esm/example.ACC.ASC", "0.1\n", "the last 7 are ignored"),
        ("peer/nga-west2.AT2", " .1\n", "the last 7 are ignored"),
    ] {
        let mut more = bytes(file);
        for _ in 0..7 {
            more.extend(row.as_bytes());
        }
        same(file, &more, word);
    }
}

/// Returns a USC volume 1 file of a wave in g/10 with the given times (s).
fn film(times: &[f64]) -> String {
    let text = String::from_utf8(bytes("usc/example.y0a")).unwrap();
    let mut head: Vec<String> = text.lines().take(27).map(str::to_owned).collect();
    let last = times.last().unwrap();
    head[10] = format!("NO. OF POINTS = {:6}      DURATION = {last:7.3} SEC", times.len());
    // The peak stated in the header belongs to another file.
    "UNITS ARE SEC AND G/10".clone_into(&mut head[11]);
    let mut out = head.join("\n");
    for (k, t) in times.iter().enumerate() {
        if k % 5 == 0 {
            out.push_str("\n ");
        }
        let _ = write!(out, "{t:7.3}{:7.3}", 3.0 * wave(*t));
    }
    out + "\n/&\n"
}

fn wave(t: f64) -> f64 {
    (std::f64::consts::TAU * 2.5 * t).sin()
}

#[test]
fn times_digitized_unevenly_are_interpolated_and_not_squeezed() {
    // Steps near 4 ms; as in digitized film, nine of ten are within a millisecond of the mean and
    // some are 13 ms.
    let mut times = vec![0.0];
    for k in 1..2000 {
        let step = if k % 40 == 7 { 0.013 } else { 0.004 };
        times.push(times[k - 1] + step);
    }
    let record = given(film(&times).as_bytes());
    let channel = &record.channels[0];
    let worst = channel
        .acceleration
        .iter()
        .enumerate()
        .map(|(k, a)| {
            let t = k as f64 * channel.time_step;
            (a / (0.1 * STANDARD_GRAVITY) - 3.0 * wave(t)).abs()
        })
        .fold(0.0, f64::max);
    // Tolerance for a wave of amplitude 3, from printed digits and chords across 13 ms; measured
    // 0.016. With an even step, the error was 3.
    assert!(worst < 0.02, "{worst}");
    let warnings = warnings_of(&record);
    assert!(warnings.contains("unevenly spaced times (0.0040 to 0.0130 s"), "{warnings}");
}

#[test]
fn times_that_were_cut_instead_of_rounded_are_still_even() {
    let times: Vec<f64> =
        (0..800).map(|k| (f64::from(k) / 240.0 * 1000.0).floor() / 1000.0).collect();
    let record = given(film(&times).as_bytes());
    assert_eq!(record.channels[0].time_step, 1.0 / 240.0);
    assert_eq!(record.channels[0].acceleration.len(), 800);
}

#[test]
fn a_blank_field_of_an_at2_file_does_not_shift_what_follows() {
    let clean = given(&bytes("peer/nga-west2.AT2"));
    let text = String::from_utf8(bytes("peer/nga-west2.AT2")).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[6].replace_range(30..45, &" ".repeat(15));
    let record = given(lines.join("\n").as_bytes());
    let (old, new) = (&clean.channels[0].acceleration, &record.channels[0].acceleration);
    assert_eq!(old.len(), new.len());
    for (k, (a, b)) in old.iter().zip(new).enumerate() {
        assert_eq!(*b, if k == 12 { 0.0 } else { *a }, "{k}");
    }
    assert!(
        warnings_of(&record).contains("line 7: column 31: a blank field"),
        "{}",
        warnings_of(&record)
    );
}

#[test]
fn steps_counts_and_lengths_that_no_strong_motion_has_are_reported() {
    let at2 = |step: &str, count: usize| {
        let mut text = format!(
            "A\nEVENT, STATION, 90\nACCELERATION IN UNITS OF G\nNPTS= {count}, DT= {step} SEC\n"
        );
        for k in 0..count {
            let _ = writeln!(text, "{:.4}", 0.1 * wave(0.013 * k as f64));
        }
        given(text.as_bytes())
    };
    assert_eq!(at2(".01", 200).channels[0].implausible(), None);
    for (step, count, word) in [
        ("5.0", 200, "a step of 5 s"),
        (".00001", 200_000, "a step of 0.00001 s"),
        (".02", 30, "30 samples"),
        (".005", 100, "a length of 0.495 s"),
    ] {
        let record = at2(step, count);
        assert!(warnings_of(&record).contains(word), "{}", warnings_of(&record));
    }
}

fn text(file: &str) -> String {
    String::from_utf8(bytes(file)).unwrap()
}

#[test]
fn layouts_of_other_programs_read_as_the_same_numbers() {
    let csmnc = text("csmnc/example.dat");
    let at = csmnc.find("0.000000 20.17").unwrap();
    let (header, values) = csmnc.split_at(at);
    let one_a_line: Vec<&str> = values.split_whitespace().collect();
    let changed = given(format!("{header}{}\n", one_a_line.join("\n")).as_bytes());
    assert_eq!(changed.channels, given(csmnc.as_bytes()).channels);

    let rows: String = (0..60).map(|k| format!("{:.4}\n", (0.3 * f64::from(k)).sin())).collect();
    let header = "Station: NOW\nNPTS: 60\nDT: 0.005\nunit: cm/s2\n";
    let record = given(format!("{header}{rows}").as_bytes());
    assert_eq!(record.channels[0].acceleration.len(), 60);
    assert!((record.channels[0].time_step - 0.005).abs() < 1e-12);

    let bbp = text("bbp/example.000");
    let stated = given(bbp.replacen("made", "cm/s/s", 1).as_bytes());
    let unit = "cm/s2".parse().ok();
    let with = read(bbp.as_bytes(), "file", &ReadOptions { unit, ..ReadOptions::default() });
    assert_eq!(stated.channels[0].acceleration, with.unwrap().channels[0].acceleration);
}

#[test]
fn reasons_name_what_is_wrong() {
    let reason = |text: &str| {
        read(text.as_bytes(), "file", &ReadOptions::default()).unwrap_err().to_string()
    };
    let rows = |time: &dyn Fn(u32) -> String| -> String {
        (0..60).map(|k| format!("{},{}.5\n", time(k), k % 7)).collect()
    };
    let second = |k: u32| format!("{}.{:02}", k / 100, k % 100);
    let table = |rows: &str| format!("time (s),acc (cm/s2)\n{rows}");
    let dated = table(&rows(&|k| format!("2020-01-01T00:00:0{}", second(k))));
    assert!(reason(&dated).contains("a date or a time of day"), "{}", reason(&dated));
    let plain = table(&rows(&second));
    let empty = plain.replace("0.09,2.5", "0.09,");
    assert!(reason(&empty).contains("empty"), "{}", reason(&empty));
    let comma = plain.replace("0.09,2.5", "0.09,1,002.5");
    assert!(reason(&comma).contains("comma"), "{}", reason(&comma));
    let geocsv = format!("# dataset: GeoCSV 2.0\n# delimiter: ,\n{plain}");
    assert!(reason(&geocsv).contains("GeoCSV (EarthScope)"), "{}", reason(&geocsv));
    let longer = format!("{}0.5 0.5 0.5 0.5 0.5\n", text("sac-text/example.sac"));
    assert!(reason(&longer).contains("lines were added"), "{}", reason(&longer));
}
