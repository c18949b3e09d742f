//! The motion commands: printed output, written files, refusals.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{barrelstack, names, refused, skipped, stderr, stdout};
use serde_json::Value;

/// Runs `motion`, which must succeed, and returns standard output.
fn motion(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    let (printed, warned) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {warned}");
    assert!(!printed.is_empty(), "{arguments:?}");
    printed
}

/// Returns the channels of a file from `info --json`.
fn channels(file: &Path) -> Vec<Value> {
    let printed = motion(&["info", "--json", text(file)]);
    let document: Value = serde_json::from_str(&printed).unwrap();
    document["records"][0]["channels"].as_array().unwrap().clone()
}

fn measure(channel: &Value, name: &str) -> f64 {
    channel["measures"][name]["value"].as_f64().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn close(a: f64, b: f64, share: f64) -> bool {
    (a - b).abs() <= share * b.abs()
}

/// Returns the rows of numbers of a file in the program's own form.
fn rows(file: &Path) -> Vec<String> {
    let whole = fs::read_to_string(file).unwrap();
    whole.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
}

/// Returns a folder with `napa.txt`, the bundled record after processing, cut to its strong part.
fn napa() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("napa.txt");
    motion(&["process", "napa-college-2014", "-o", text(&file)]);
    (folder, file)
}

#[test]
fn info_shows_what_the_header_states_beside_what_the_numbers_give() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("small.at2");
    let header = "PEER STRONG MOTION DATABASE RECORD\nEVENT, STATION, 090\n\
                  ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .5000 SEC\n";
    fs::write(&file, format!("{header} .0 .2 -.3 .0\n")).unwrap();
    let printed = motion(&["info", text(&file)]);
    for words in ["PEER AT2", "EVENT", "STATION", "azimuth 90°", "PGA", "0.3000", "cm/s"] {
        assert!(printed.contains(words), "no {words:?} in {printed}");
    }
    let channel = &channels(&file)[0];
    assert!(close(measure(channel, "pga"), 0.3 * 9.806_65, 1e-12));
    // Trapezoids of 0, 0.2, -0.3, 0 g at 0.5 s: the velocity peaks at 0.05 g s.
    assert!(close(measure(channel, "pgv"), 0.05 * 9.806_65, 1e-12));
    assert!(close(channel["duration"].as_f64().unwrap(), 1.5, 1e-12));
}

#[test]
fn every_number_of_the_table_has_a_unit() {
    let printed = motion(&["info", "napa-college-2014", "--all-measures"]);
    let table = printed.lines().skip_while(|line| !line.trim_start().starts_with("measure"));
    let rows: Vec<&str> = table.skip(1).take_while(|line| !line.is_empty()).collect();
    assert_eq!(rows.len(), 21, "{printed}");
    let units = ["g", "cm/s", "cm", "s", "m/s", "m/s^0.75"];
    for row in rows {
        // Two blanks or more separate columns, one separates the words of a name.
        let unit = row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).nth(1).unwrap();
        assert!(units.contains(&unit), "{row}");
    }
    for words in ["RotD50", "velocity pulse", "of the squared velocity"] {
        assert!(printed.contains(words), "no {words:?} in {printed}");
    }
}

#[test]
fn raw_records_are_distinguished() {
    let output = barrelstack(["motion", "info", "napa-college-2014"]);
    assert!(stderr(&output).contains("a raw record"), "{}", stderr(&output));
    let printed = stdout(&output);
    for words in
        ["`run` removes", "high-pass corner at 0.1 Hz", "--corners auto", "motion.processing=none"]
    {
        assert!(printed.contains(words), "no {words:?} in {printed}");
    }
    let (_folder, file) = napa();
    let output = barrelstack(["motion", "info", text(&file)]);
    assert_eq!(stderr(&output), "");
    assert!(!stdout(&output).contains("`run`"), "{}", stdout(&output));
}

#[test]
fn a_part_of_a_record_says_how_to_join_the_parts() {
    let folder = tempfile::tempdir().unwrap();
    let part = folder.path().join("parte1.v1");
    let example = "../motion/tests/data/renadic/example.v1";
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(example), &part).unwrap();
    let said = stderr(&barrelstack(["motion", "info", text(&part)]));
    for words in ["such as parte2.v1", "motion convert FIRST SECOND --join", "--record"] {
        assert!(said.contains(words), "no {words:?} in {said}");
    }
}

#[test]
fn every_form_reads_back() {
    let (folder, first) = napa();
    let before = channels(&first);
    for name in ["copy.txt", "copy.csv"] {
        let file = folder.path().join(name);
        motion(&["convert", text(&first), "-o", text(&file)]);
        let after = channels(&file);
        assert_eq!(after.len(), 3);
        for (old, new) in before.iter().zip(&after) {
            assert_eq!(measure(old, "pga"), measure(new, "pga"), "{name}");
            assert!(close(measure(new, "pgv"), measure(old, "pgv"), 1e-9), "{name}");
        }
    }
    assert_eq!(rows(&folder.path().join("copy.txt")), rows(&first));
    let at2 = folder.path().join("copy.at2");
    motion(&["convert", text(&first), "--component", "h1", "-o", text(&at2)]);
    let channel = &channels(&at2)[0];
    // Eight digits are written: measured 6e-9.
    assert!(close(measure(channel, "pga"), measure(&before[0], "pga"), 5e-8));
    assert_eq!(channel["azimuth"], before[0]["azimuth"]);
    let header = fs::read_to_string(&at2).unwrap();
    assert!(header.lines().next().unwrap().contains("high-pass"), "the processing is stated");
}

#[test]
fn an_archive_holds_the_numbers_of_the_text() {
    let (folder, first) = napa();
    let file = folder.path().join("copy.npz");
    motion(&["convert", text(&first), "-o", text(&file)]);
    let bytes = fs::read(&file).unwrap();
    let find = |word: &[u8], from: usize| {
        from + bytes[from..].windows(word.len()).position(|part| part == word).unwrap()
    };
    for array in ["time", "Up_acceleration", "Up_velocity", "Up_displacement"] {
        let name = find(format!("{array}.npy").as_bytes(), 0);
        let magic = find(b"\x93NUMPY", name);
        let length = usize::from(u16::from_le_bytes([bytes[magic + 8], bytes[magic + 9]]));
        assert_eq!((10 + length) % 64, 0, "{array}");
        let header = std::str::from_utf8(&bytes[magic + 10..magic + 10 + length]).unwrap();
        assert!(header.contains(&format!("({},)", rows(&first).len())), "{array}: {header}");
        if array == "Up_acceleration" {
            for (k, row) in rows(&first).iter().enumerate() {
                let at = magic + 10 + length + 8 * k;
                let value = f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
                let last = row.split(' ').next_back().unwrap().parse::<f64>().unwrap();
                assert_eq!(value.to_bits(), last.to_bits(), "row {k}");
            }
        }
    }
}

#[test]
fn one_factor_scales_all_components() {
    let (folder, first) = napa();
    let file = folder.path().join("strong.txt");
    let printed = motion(&["scale", text(&first), "--to", "pgv=60 cm/s", "-o", text(&file)]);
    assert!(printed.contains("one factor for all components"), "{printed}");
    let (before, after) = (channels(&first), channels(&file));
    assert!(close(measure(&after[0], "pgv"), 0.6, 1e-12));
    let factor = measure(&after[0], "pga") / measure(&before[0], "pga");
    for (old, new) in before.iter().zip(&after) {
        assert!(close(measure(new, "pga"), factor * measure(old, "pga"), 1e-12));
        // The square of the factor; measured 1e-15.
        assert!(close(measure(new, "arias"), factor * factor * measure(old, "arias"), 1e-12));
    }
}

#[test]
fn a_raw_record_is_scaled_by_its_motion_and_not_by_its_drift() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("strong.txt");
    let scaled = ["scale", "napa-college-2014", "--to", "pgd=20 cm", "--overwrite", "-o"];
    let printed = motion(&[&scaled[..], &[text(&file)]].concat());
    assert!(printed.contains("high-pass"), "{printed}");
    assert!(close(measure(&channels(&file)[0], "pgd"), 0.2, 1e-12));
    let processed = measure(&channels(&file)[0], "pga");
    motion(&[&scaled[..], &[text(&file), "--processing", "none"]].concat());
    // The drift is half a meter, so that the factor to 20 cm is far too small.
    assert!(measure(&channels(&file)[0], "pga") < 0.5 * processed);
}

#[test]
fn a_model_of_a_quarter_of_the_length_shakes_in_half_the_time() {
    let (folder, first) = napa();
    let file = folder.path().join("model.txt");
    motion(&["scale", text(&first), "--froude", "0.25", "-o", text(&file)]);
    for (old, new) in channels(&first).iter().zip(&channels(&file)) {
        assert_eq!(measure(new, "pga"), measure(old, "pga"));
        assert!(close(measure(new, "pgv"), 0.5 * measure(old, "pgv"), 1e-12));
        assert!(close(measure(new, "pgd"), 0.25 * measure(old, "pgd"), 1e-12));
    }
}

#[test]
fn components_are_chosen_by_azimuth() {
    let (folder, first) = napa();
    let file = folder.path().join("turned.txt");
    motion(&["convert", text(&first), "--component", "180", "-o", text(&file)]);
    let turned = &channels(&file)[0];
    let north = channels(&first).into_iter().find(|c| c["azimuth"] == 0.0).unwrap();
    assert_eq!(turned["azimuth"], 180.0);
    // The component is multiplied by the cosine of 180°; measured 2e-16.
    assert!(close(measure(turned, "pga"), measure(&north, "pga"), 1e-14));
}

#[test]
fn parts_of_a_record_are_joined_where_they_overlap() {
    let (folder, first) = napa();
    let whole = fs::read_to_string(&first).unwrap();
    let (head, body): (Vec<&str>, Vec<&str>) = whole.lines().partition(|l| l.starts_with('#'));
    let part = |name: &str, rows: &[&str]| {
        let file = folder.path().join(name);
        fs::write(&file, [&head, rows].concat().join("\n")).unwrap();
        file
    };
    let (one, two) = (part("one.txt", &body[..4000]), part("two.txt", &body[3000..]));
    let joined = folder.path().join("joined.txt");
    let printed = motion(&["convert", "--join", text(&one), text(&two), "-o", text(&joined)]);
    assert!(printed.contains("repeat the end of the previous part"), "{printed}");
    assert_eq!(rows(&joined).len(), body.len());
    for (old, new) in channels(&first).iter().zip(&channels(&joined)) {
        assert!(close(measure(new, "arias"), measure(old, "arias"), 1e-12));
    }
}

#[test]
fn a_matched_motion_follows_its_target() {
    let (folder, first) = napa();
    let table = folder.path().join("target.csv");
    // ASCE 7 with S_DS = 1 g and S_D1 = 0.6 g at its corners and between.
    fs::write(&table, "period (s),Sa (g)\n0.05,0.65\n0.12,1\n0.6,1\n3,0.2\n").unwrap();
    for (k, to) in ["asce7:sds=1.0,sd1=0.6", text(&table)].into_iter().enumerate() {
        let file = folder.path().join(format!("matched-{k}.txt"));
        let printed = motion(&["match", text(&first), "--to", to, "-o", text(&file)]);
        assert!(printed.contains("misfit at most"), "{printed}");
        let spectrum = folder.path().join(format!("spectrum-{k}.csv"));
        let periods = "0.2,0.4,0.6,1.0,2.0";
        motion(&[
            "spectrum",
            text(&file),
            "--component",
            "h1",
            "--periods",
            periods,
            "-o",
            text(&spectrum),
        ]);
        for row in fs::read_to_string(&spectrum).unwrap().lines().skip(1) {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            let goal = 9.806_65 * (0.6 / cells[1]).min(1.0);
            // Within the tolerance of 5 %.
            assert!(close(cells[2], goal, 0.05), "{to}: {row}");
        }
    }
}

#[test]
fn a_seed_makes_the_same_motion_every_time() {
    let folder = tempfile::tempdir().unwrap();
    let boore = |name: &str, seed: &str| {
        let file = folder.path().join(name);
        let given = ["--magnitude", "6", "--distance", "15 km", "--seed", seed];
        let printed = motion(&[&["synth", "boore"], &given[..], &["-o", text(&file)]].concat());
        assert!(printed.contains(&format!("seed {seed}")), "{printed}");
        fs::read(&file).unwrap()
    };
    let one = boore("one.txt", "1");
    assert_eq!(one, boore("again.txt", "1"));
    assert_ne!(one, boore("other.txt", "2"));
}

#[test]
fn every_kind_of_synthesis_makes_what_was_requested() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("made.txt");
    let pulses = [
        "sine",
        "half-sine",
        "one-sine",
        "one-cosine",
        "ricker",
        "gabor",
        "cycloid-a",
        "cycloid-b",
        "cycloid-c",
        "mavroeidis-papageorgiou",
    ];
    for kind in pulses {
        motion(&[
            "synth",
            kind,
            "--peak",
            "50 cm/s",
            "--period",
            "1 s",
            "-o",
            text(&file),
            "--overwrite",
        ]);
        // Sampling at a 400th of the period misses the peak by 1e-5 at most.
        assert!(close(measure(&channels(&file)[0], "pgv"), 0.5, 1e-4), "{kind}");
    }
    motion(&["synth", "clough-penzien", "-o", text(&file), "--overwrite", "--vertical"]);
    assert_eq!(channels(&file)[0]["vertical"], true);
    motion(&[
        "synth",
        "near-fault",
        "--magnitude",
        "6.5",
        "--distance",
        "10 km",
        "--pulse-velocity",
        "80 cm/s",
        "--pulse-period",
        "1.5 s",
        "-o",
        text(&file),
        "--overwrite",
    ]);
    assert!(measure(&channels(&file)[0], "pgv") > 0.7);
}

#[test]
fn a_written_motion_drives_a_stack() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["x.at2", "x.csv", "x.txt"] {
        let file = folder.path().join(name);
        let pulse = ["--peak", "60 cm/s", "--period", "0.8 s"];
        motion(&[&["synth", "ricker"], &pulse[..], &["-o", text(&file)]].concat());
        let output = barrelstack([
            "run",
            "demo-napa",
            "--variants=2",
            "--record",
            text(&file),
            "--set",
            "motion.vertical=false",
            "--set",
            "run.duration=1 s",
            "--quiet",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stdout(&output).contains("0.56 g and 60 cm/s"), "{}", stdout(&output));
    }
}

#[test]
fn figures_come_with_their_numbers() {
    let (folder, first) = napa();
    let pictures = folder.path().join("pictures");
    let printed = motion(&["plot", text(&first), "-o", text(&pictures)]);
    assert_eq!(
        printed.lines().filter(|line| line.starts_with("written: ")).count(),
        7,
        "{printed}"
    );
    let kinds = [
        "acceleration",
        "arias",
        "displacement",
        "fourier-spectrum",
        "panels",
        "response-spectrum",
        "velocity",
    ];
    let wanted: Vec<String> = kinds
        .iter()
        .flat_map(|kind| ["csv", "pdf", "png", "svg"].map(|ending| format!("{kind}.{ending}")))
        .collect();
    assert_eq!(names(&pictures).unwrap(), wanted);
    for kind in kinds {
        let svg = fs::read_to_string(pictures.join(kind).with_extension("svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{kind}");
        let csv = fs::read_to_string(pictures.join(kind).with_extension("csv")).unwrap();
        assert!(csv.lines().count() > 100, "{kind}");
    }
    for (ending, start) in [("png", &b"\x89PNG"[..]), ("pdf", b"%PDF-")] {
        let picture = folder.path().join(format!("spectrum.{ending}"));
        motion(&["plot", text(&first), "-o", text(&picture), "--figure", "response"]);
        assert!(fs::read(&picture).unwrap().starts_with(start), "{ending}");
        assert!(picture.with_extension("csv").is_file());
        let again = barrelstack(["motion", "plot", text(&first), "-o", text(&picture)]);
        assert!(stderr(&again).contains("exists already"), "{}", stderr(&again));
        fs::remove_file(picture.with_extension("csv")).unwrap();
    }
    let one = folder.path().join("one.svg");
    let torn = barrelstack(["motion", "plot", text(&first), "-o", text(&one), "--format", "png"]);
    refused("a file and a format", &torn, &one, &["one.svg", "--format applies to a folder"]);
    motion(&["plot", text(&first), "-o", text(&one), "--figure", "velocity", "--component", "h1"]);
    assert!(fs::read_to_string(&one).unwrap().contains("velocity (cm/s)"));
    let again = barrelstack(["motion", "plot", text(&first), "-o", text(&pictures)]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--overwrite"), "{}", stderr(&again));
}

#[test]
fn what_is_there_is_not_replaced_unasked() {
    let (folder, first) = napa();
    let file = folder.path().join("kept.txt");
    fs::write(&file, "mine").unwrap();
    let output = barrelstack(["motion", "convert", text(&first), "-o", text(&file)]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("exists already"), "{}", stderr(&output));
    assert_eq!(fs::read(&file).unwrap(), b"mine");
    motion(&["convert", text(&first), "-o", text(&file), "--overwrite"]);
    assert_eq!(rows(&file), rows(&first));
    // Neither run leaves a temporary file.
    assert_eq!(names(folder.path()).unwrap(), ["kept.txt", "napa.txt"]);
}

#[test]
fn a_file_of_no_format_is_refused_with_the_command_that_lists_the_formats() {
    let folder = tempfile::tempdir().unwrap();
    let prose = folder.path().join("prose.txt");
    fs::write(&prose, "This folder holds records.\n").unwrap();
    for arguments in [
        vec!["motion", "info", text(&prose)],
        vec!["run", "demo-napa", "--set=motion.vertical=false", "--record", text(&prose)],
    ] {
        let said = stderr(&barrelstack(&arguments));
        assert!(said.contains("in a known format, such as PEER AT2"), "{said}");
        assert!(said.contains("`barrelstack motion --help` lists all formats"), "{said}");
        assert!(!said.contains("csmip-v2, bhrc"), "{said}");
    }
    let help = stdout(&barrelstack(["motion", "--help"]));
    for format in barrelstack_motion::FORMATS {
        assert!(help.contains(format.name) && help.contains(format.title), "{}", format.name);
    }
}

#[test]
fn a_record_of_a_few_samples_is_refused_as_an_excerpt() {
    let folder = tempfile::tempdir().unwrap();
    let few = folder.path().join("few.at2");
    let rows = "0.1 0.2 -0.1 0.0 0.1 -0.2 0.1 0.0 0.1 0.2 0.0\n";
    let head = "A\nEVENT, STATION, 90\nACCELERATION IN UNITS OF G\nNPTS= 11, DT= .01 SEC\n";
    fs::write(&few, format!("{head}{rows}")).unwrap();
    let said = stderr(&barrelstack([
        "run",
        "demo-napa",
        "--set=motion.vertical=false",
        "--record",
        text(&few),
    ]));
    for word in ["only 11 samples (0.100 s)", "at least 50 samples", "give the whole record"] {
        assert!(said.contains(word), "{said}");
    }
    assert!(!said.contains("unit"), "{said}");
}

#[test]
fn mistakes_are_one_error_and_nothing_is_written() {
    let (folder, first) = napa();
    let first = text(&first);
    let columns = folder.path().join("columns.txt");
    fs::write(&columns, "0.1\n0.2\n-0.1\n").unwrap();
    let columns = text(&columns);
    let timed = folder.path().join("timed.txt");
    fs::write(&timed, "0.00 0.1\n0.01 0.2\n0.02 -0.1\n0.03 0.0\n").unwrap();
    let timed = text(&timed);
    let unstated = folder.path().join("unstated.txt");
    let header = "# barrelstack motion 1\n# time_step: 0.01\n# channels: E\n";
    fs::write(&unstated, format!("{header}0.1\n0.2\n-0.1\n")).unwrap();
    let unstated = text(&unstated);
    let table = folder.path().join("table.csv");
    fs::write(&table, "0.1,1\n0.2,1\n").unwrap();
    let table = text(&table);
    let cases: &[(&[&str], &[&str])] = &[
        (&["convert", "missing.at2"], &["missing.at2", "there is no such file"]),
        (&["convert", columns], &["time step", "--time-step"]),
        (&["convert", timed], &["unit", "--unit"]),
        (&["convert", unstated, "--unit", "g"], &["line 3", "\"# unit: ...\"", "add the line"]),
        (
            &["convert", columns, "--time-step", "0 s", "--unit", "g"],
            &["above 0", "give a positive number"],
        ),
        (&["convert", timed, "--unit", "furlong"], &["--unit", "furlong", "cm/s2"]),
        (&["convert", columns, "--time-step", "0.01"], &["--time-step", "no unit", "0.01 s"]),
        (&["convert", first, "--component", "west"], &["west", "\"Up\""]),
        (&["convert", first, "--component", "h1", "--component", "90"], &["already selected"]),
        (&["convert", "--join", first, timed, "--unit", "g"], &["no channel E"]),
        (&["scale", first], &["--to", "--factor", "--froude"]),
        (&["scale", first, "--to", "pgv=60"], &["pgv", "no unit", "60 cm/s"]),
        (&["scale", first, "--to", "pgv=60 cm"], &["pgv", "a length", "a velocity"]),
        (&["scale", first, "--to", "pgv=-60 cm/s"], &["-60 cm/s", "above 0"]),
        (&["scale", first, "--to", "speed=60 cm/s"], &["speed", "pga"]),
        (&["scale", first, "--to", "d5-95=9 s"], &["d5-95", "does not change"]),
        (&["scale", first, "--factor", "0"], &["--factor", "other than 0"]),
        (&["scale", first, "--froude", "-1"], &["--froude", "above 0", "-1"]),
        (&["process", first, "--high-pass", "0.1"], &["--high-pass", "no unit", "0.1 Hz"]),
        (&["process", first, "--high-pass", "200 Hz"], &["high-pass", "Nyquist", "100 Hz"]),
        (
            &["process", first, "--low-pass", "1e-9 Hz"],
            &["channel E: low-pass", "of the duration, 0.02", "give a value in this range"],
        ),
        (&["process", first, "--chain", "none"], &["no processing step is given"]),
        (&["match", first, "--to", "asce8:a=1"], &["asce8", "nzs1170"]),
        (&["match", first, "--to", "asce7:sds=1"], &["sd1 is missing"]),
        (&["match", first, "--to", "ec8:ag=0.3,site=F"], &["site", "\"F\""]),
        (&["match", first, "--to", "nch433:zone=4,soil=A"], &["zone", "\"4\""]),
        (&["match", first, "--to", "ac156:sds=1,x=2"], &["no parameter x"]),
        (&["match", first, "--to", table], &["table.csv, line 1", "period (s), Sa (g)"]),
        (&["synth", "ricker", "--peak", "3", "--period", "1 s"], &["--peak", "no unit", "3 g"]),
        (&["synth", "ricker", "--peak", "3 g", "--period", "0 s"], &["period", "above 0"]),
        (&["synth", "boore", "--magnitude", "12", "--distance", "9 km"], &["magnitude", "9.5"]),
    ];
    for (arguments, words) in cases {
        let out = folder.path().join("out").with_extension("txt");
        let output = barrelstack([&["motion"], *arguments, &["-o", text(&out)]].concat());
        refused(&arguments.join(" "), &output, &out, words);
        assert!(!out.exists());
    }
    for (name, words) in [("out.xyz", ".at2, .csv, .npz or .txt"), ("none/out.txt", "no folder")] {
        let out = folder.path().join(name);
        let output = barrelstack(["motion", "convert", first, "-o", text(&out)]);
        refused(name, &output, &out, &[words]);
    }
    let at2 = folder.path().join("three.at2");
    let output = barrelstack(["motion", "convert", first, "-o", text(&at2)]);
    refused("three components", &output, &at2, &["an AT2 file has one component", "--component"]);
}

/// Returns options for files that lack information, from the README of the folder.
fn stated(file: &str) -> &'static [&'static str] {
    match file {
        "columns/ChiChi.txt" => &["--unit", "g"],
        "slammer/EQdata.txt" => &[],
        _ if file.starts_with("slammer/") => &["--unit", "g", "--time-step", "0.02 s"],
        _ if file.starts_with("sac/") => &["--unit", "g"],
        _ if file.starts_with("mseed/") => &["--sensitivity", "427819"],
        _ => &[],
    }
}

#[test]
fn every_real_file_is_shown_or_refused() {
    // Files without an acceleration history.
    const REFUSED: [&str; 6] = [
        "README.md",
        "asdf/nc72282711_workspace.h5",
        "mseed/BK.CMB.xml",
        "peer/RSN995_NORTHR_PEL360.DT2",
        "peer/RSN995_NORTHR_PEL360.VT2",
        "slammer/EQdata.txt",
    ];
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions");
    if !folder.is_dir() {
        skipped(&format!("{} is not there", folder.display()));
        return;
    }
    let mut files = 0;
    let mut open = vec![folder.clone()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let name = text(path.strip_prefix(&folder).unwrap()).replace('\\', "/");
            let arguments = [&["motion", "info", text(&path)], stated(&name)].concat();
            let output = barrelstack(&arguments);
            if REFUSED.contains(&name.as_str()) {
                refused(&name, &output, Path::new("none"), &[]);
                continue;
            }
            let printed = stdout(&output);
            assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
            for words in ["PGA", "PGV", "PGD", "duration D5-95", "stage"] {
                assert!(printed.contains(words), "{name}: no {words:?} in {printed}");
            }
            files += 1;
        }
    }
    // The number of files in the folder's README, without those refused.
    assert!(files >= 30, "{files} files");
}
