//! Scaling to both horizontals, joining of parts, other dampings, and scenarios with counts.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{barrelstack, stderr, stdout};
use serde_json::Value;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn printed(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// Returns the error of `motion`.
fn refused(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    stderr(&output)
}

/// Returns two components and a vertical that shake for eight seconds.
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
            printed(&["scale", text(&file), "--to", "sa(0.5)=0.6 g", "--of", of, "-o", text(&out)]);
        assert!(said.contains(of), "{said}");
        let document: Value =
            serde_json::from_str(&printed(&["info", "--json", "--all-measures", text(&out)]))
                .unwrap();
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
        let before: Value =
            serde_json::from_str(&printed(&["info", "--json", text(&file)])).unwrap();
        let old = |k: usize| {
            before["records"][0]["channels"][k]["measures"]["pga"]["value"].as_f64().unwrap()
        };
        assert!((pga(2) / old(2) / (pga(0) / old(0)) - 1.0).abs() < 1e-12); // measured 0
    }
    let single = folder.path().join("one.txt");
    printed(&["convert", text(&file), "--component", "90", "-o", text(&single)]);
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
    printed(&["scale", text(&file), "--to", "fajfar=0.9", "-o", text(&out)]);
    let said = printed(&["info", "--all-measures", text(&out)]);
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
    let said = printed(
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
    assert!(error.contains("applies to 5 % damping only"), "{error}");
}

#[test]
fn horizontals_are_turned_to_a_fault_and_to_the_fastest_direction() {
    let folder = tempfile::tempdir().unwrap();
    // The ground moves along azimuth 40 only.
    let mut rows = String::from("# acceleration (m/s2)\ntime (s),0,90,UP\n");
    let (sine, cosine) = 40.0_f64.to_radians().sin_cos();
    for k in 0..1600 {
        let t = 0.005 * f64::from(k);
        let a = 2.0 * (9.0 * t).sin() * (-0.3 * t).exp();
        writeln!(rows, "{t:.3},{:.9},{:.9},{:.9}", cosine * a, sine * a, 0.1 * a).unwrap();
    }
    let file = folder.path().join("along-40.csv");
    fs::write(&file, rows).unwrap();
    let turned = |axes: &str| -> Vec<(String, f64, f64)> {
        let out = folder.path().join(format!("{}.txt", axes.replace(':', "-")));
        let all = ["process", text(&file), "--chain", "none", "--rotate", axes, "-o", text(&out)];
        assert!(printed(&all).contains("rotated to"), "{axes}");
        let printed = printed(&["info", "--json", text(&out)]);
        let document: Value = serde_json::from_str(&printed).unwrap();
        let channel = |channel: &Value| {
            let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
            let name = channel["name"].as_str().unwrap().to_owned();
            (name, number(&channel["azimuth"]), number(&channel["measures"]["pga"]["value"]))
        };
        document["records"][0]["channels"].as_array().unwrap().iter().map(channel).collect()
    };
    // The maximum of the wave, 2 sin(9 t) exp(-0.3 t), is 1.898 m/s2; measured 1.89898.
    let near = |value: f64, expected: f64| (value - expected).abs() < 2e-3;
    for (axes, along, across) in [("strike:40", 1, 0), ("strike:400", 1, 0), ("strike:130", 0, 1)] {
        let channels = turned(axes);
        assert_eq!(channels.len(), 3, "{axes}");
        assert_eq!((channels[0].0.as_str(), channels[1].0.as_str()), ("FN", "FP"));
        // The sign of a direction is that of the strike.
        assert_eq!(channels[along].1 % 180.0, 40.0, "{axes}: {channels:?}");
        assert!(near(channels[along].2, 1.898), "{axes}: {channels:?}");
        assert!(channels[across].2 < 1e-8, "{axes}: {channels:?}"); // measured 7e-10
    }
    let fastest = turned("vmax");
    assert_eq!((fastest[0].0.as_str(), fastest[1].0.as_str()), ("VMAX", "VMAX-90"));
    // Directions are evaluated at whole degrees, and the true direction is one of them.
    assert_eq!(fastest[0].1 % 180.0, 40.0, "{fastest:?}");
    assert!(near(fastest[0].2, 1.898) && fastest[1].2 < 1e-8, "{fastest:?}"); // measured 7e-10

    let out = folder.path().join("out.txt");
    let says = |axes: &str, file: &Path| {
        refused(&["process", text(file), "--rotate", axes, "-o", text(&out)])
    };
    for axes in ["strike", "strike:", "strike:nan", "strike:north", "122", "VMAX2"] {
        assert!(says(axes, &file).contains("expected `vmax`, or a strike"), "{axes}");
    }
    for (head, found) in [("time (s),90", "\"90\""), ("time (s),H1,H2", "\"H1\", \"H2\"")] {
        let lone = folder.path().join("lone.csv");
        let mut rows = format!("# acceleration (m/s2)\n{head}\n");
        for k in 0..200 {
            let a = (0.1 * f64::from(k)).sin();
            let more = if head.ends_with("H2") { ",0.5" } else { "" };
            writeln!(rows, "{:.2},{a:.5}{more}", 0.01 * f64::from(k)).unwrap();
        }
        fs::write(&lone, rows).unwrap();
        let said = says("vmax", &lone);
        assert!(said.contains("two horizontals of known azimuth"), "{found}: {said}");
    }
    assert!(!out.exists());
}

#[test]
fn components_of_two_stations_are_combined_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, station: &str, azimuth: u32, phase: f64| {
        let mut rows = format!(
            "# barrelstack motion 1\n# station: {station}\n# stage: corrected\n# unit: m/s2\n\
             # time_step: 0.01\n# channels: {azimuth} az={azimuth}\n"
        );
        for k in 0..800 {
            let t = 0.01 * f64::from(k);
            writeln!(rows, "{:e}", (7.0 * t + phase).sin() * (-0.4 * t).exp()).unwrap();
        }
        let path = folder.path().join(name);
        fs::write(&path, rows).unwrap();
        path
    };
    let (here, there) = (file("a.txt", "Here", 0, 0.0), file("b.txt", "There", 90, 1.0));
    let beside = file("c.txt", "Here", 90, 1.0);
    let spectrum = |other: &Path, more: &[&str]| {
        [&["spectrum", text(&here), text(other), "--rotd"][..], more]
            .concat()
            .into_iter()
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    let as_words = |all: &[String]| all.iter().map(String::as_str).collect::<Vec<_>>().join(" ");
    let say = |all: &[String]| printed(&all.iter().map(String::as_str).collect::<Vec<_>>());
    let same = say(&spectrum(&beside, &[]));
    let all = spectrum(&there, &[]);
    let said = refused(&all.iter().map(String::as_str).collect::<Vec<_>>());
    for words in ["station \"Here\" and station \"There\"", "or add --allow-mixed"] {
        assert!(said.contains(words), "{}: {said}", as_words(&all));
    }
    // The same numbers, since the motions are the same.
    let rows = |text: &str| -> Vec<String> {
        let digit = |line: &&str| line.trim_start().starts_with(|c: char| c.is_ascii_digit());
        text.lines().filter(digit).map(str::to_owned).collect()
    };
    let mixed = say(&spectrum(&there, &["--allow-mixed"]));
    assert!(!rows(&same).is_empty());
    assert_eq!(rows(&mixed), rows(&same));
    // Equal directions do not form a pair, even with --allow-mixed.
    let twin = file("d.txt", "There", 0, 1.0);
    let all = spectrum(&twin, &["--allow-mixed"]);
    let said = refused(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.contains("not perpendicular") || said.contains("two horizontal"), "{said}");
}

#[test]
fn matching_and_processing_are_drawn_beside_what_they_start_from() {
    let folder = tempfile::tempdir().unwrap();
    let first = record(folder.path());
    let page = folder.path().join("match.html");
    let out = folder.path().join("matched.txt");
    printed(&[
        "match",
        "napa-college-2014",
        "--to",
        "ec8:ag=0.3,site=B",
        "-o",
        text(&out),
        "--figure",
        text(&page),
    ]);
    let written = fs::read_to_string(&page).unwrap();
    for wanted in
        ["follows ec8:ag=0.3,site=B within 5", "target, ", " before and ", " after.", "period (s)"]
    {
        assert!(written.contains(wanted), "{wanted}");
    }
    // Both horizontals together, by their response over all directions.
    let both = folder.path().join("both.html");
    let out = folder.path().join("both.txt");
    let to = ["match", "napa-college-2014", "--to=asce7:sds=0.6,sd1=0.4", "--tolerance=10 %"];
    let over = ["--of=rotd100", "-o", text(&out), "--figure", text(&both)];
    printed(&[&to[..], &over].concat());
    let written = fs::read_to_string(&both).unwrap();
    for wanted in
        ["(rotd100) follows asce7:sds=0.6,sd1=0.4 within 10", "RotD100", "matched together"]
    {
        assert!(written.contains(wanted), "{wanted}");
    }
    let page = folder.path().join("process.html");
    let out = folder.path().join("processed.txt");
    let arguments = ["--high-pass", "0.1 Hz", "-o", text(&out), "--figure", text(&page)];
    printed(&[&["process", text(&first)], &arguments[..]].concat());
    let written = fs::read_to_string(&page).unwrap();
    assert!(written.contains("before and after processing") && written.contains("high-pass"));
    // The page is checked before the work, as the motion is.
    let again =
        barrelstack(["motion", "process", text(&first), "-o", "x.txt", "--figure", text(&page)]);
    assert!(stderr(&again).contains("exists already"), "{}", stderr(&again));
}

#[test]
fn a_damaged_stationxml_beside_a_record_is_named_with_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../motion/tests/data");
    let file = folder.path().join("made.mseed");
    fs::copy(data.join("miniseed/steim2.mseed"), &file).unwrap();
    let alone = refused(&["info", text(&file)]);
    assert!(alone.contains("expected a sensitivity"), "{alone}");
    // A catalog of events does not concern it.
    fs::write(folder.path().join("event.xml"), "<q:quakeml xmlns:q=\"q\"></q:quakeml>").unwrap();
    assert_eq!(refused(&["info", text(&file)]), alone);
    fs::write(folder.path().join("made.xml"), "<FDSNStationXML><Network code=\"XX\">").unwrap();
    let said = refused(&["info", text(&file)]);
    assert!(
        said.contains("made.xml") && said.contains("no other file in the same folder"),
        "{said}"
    );
    assert!(said.contains("expected a sensitivity"), "{said}");
}
