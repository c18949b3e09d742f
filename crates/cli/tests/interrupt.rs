//! Ctrl-C and SIGTERM: every command stops, gives no verdict on unfinished work, keeps finished work, and reports it.

#![cfg(unix)]

use crate::common;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{HEAD, barrelstack, names, program};

/// Work of hours.
const LONG: [&str; 3] =
    ["--set=run.duration=3600 s", "--set=run.until=duration", "--set=stack.levels=2"];

/// Time limit for a command to end, on a busy machine; measured 0.1 to 2 s, the work is of hours.
const AT_MOST: Duration = Duration::from_secs(40);

/// Starts a command, sends it a signal, and returns its standard error.
fn stopped(signal: &str, arguments: &[&str], folder: &Path) -> String {
    let what = format!("{signal} {arguments:?}");
    let mut child = program(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(700));
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success(), "{what}: it had ended before");
    // Standard input stays open, so that a reader of it keeps waiting.
    let input = child.stdin.take();
    let start = Instant::now();
    let output = child.wait_with_output().unwrap();
    drop(input);
    let took = start.elapsed();
    let words = common::stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{what}: {words}");
    assert!(took < AT_MOST, "{what}: {took:?}");
    assert!(words.contains("stopped"), "{what}: {words}");
    assert!(!words.contains("panicked") && !words.contains("error"), "{what}: {words}");
    words
}

/// Returns all files below a folder.
fn files(folder: &Path) -> Vec<String> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            all.push(path.display().to_string());
        }
    }
    all
}

#[test]
fn every_command_ends_and_says_what_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let study = format!(
        "{HEAD}duration = \"2000 s\"\nuntil = \"duration\"\n[base.motion.pulse]\nkind = \"one-sine\"\n\
                         amplitude = \"0.1 g\"\nperiod = \"0.3 s\"\n\
                         [[factor]]\nfield = \"motion.pulse.amplitude\"\nvalues = [\"0.1 g\", \"0.2 g\"]\n\
                         [design]\nkind = \"full-factorial\"\nchunk = 1\n"
    );
    fs::write(at.join("study.toml"), study).unwrap();
    fs::write(at.join("observed.csv"), "mode,until (s)\nstands,8\n").unwrap();
    let rows: Vec<String> =
        (0..400).map(|row| format!("{:.1},{}\n", 0.1 * f64::from(row), row % 3)).collect();
    let response = format!("time (s),B1.1_displacement_x (mm)\n{}", rows.concat());
    fs::write(at.join("response.csv"), response).unwrap();
    let made = ["motion", "synth", "clough-penzien", "--duration=400 s", "-o", "long.txt"];
    let made = program(made).current_dir(at).output().unwrap();
    assert!(made.status.success(), "{}", common::stderr(&made));

    let runs = |first: &'static [&'static str]| [first, &LONG].concat();
    let commands: Vec<Vec<&str>> = vec![
        runs(&["run", "demo-napa", "--out=run"]),
        runs(&["demo", "--out=demo"]),
        runs(&["compare", "demo-napa", "--against=run.gravity=9.8 m/s^2", "--out=compared"]),
        runs(&["render", "demo-napa", "--out=rendered"]),
        vec!["run", "-"],
        vec!["heights", "--out=heights"],
        vec!["protect", "--out=protect"],
        vec!["score", "--out=score"],
        vec!["reproduce", "--out=reproduced"],
        vec!["study", "study.toml", "--out=study"],
        vec!["study", "run-chunk", "study.toml", "--chunk=0", "--out=chunk"],
        vec!["calibrate", "collapse", "candia-8-barrels", "observed.csv", "--simulations=100000"],
        vec!["calibrate", "response", "candia-8-barrels", "response.csv"],
        vec![
            "motion",
            "match",
            "long.txt",
            "--to=ec8:ag=0.3,site=B",
            "--shortest=0.05 s",
            "-o",
            "matched.txt",
        ],
    ];
    for (number, arguments) in commands.iter().enumerate() {
        let signal = if number % 2 == 0 { "-INT" } else { "-TERM" };
        stopped(signal, arguments, at);
        let unfinished =
            |file: &String| Path::new(file).extension().is_some_and(|end| end == "part");
        let half: Vec<String> = files(at).into_iter().filter(unfinished).collect();
        assert_eq!(half, Vec::<String>::new(), "{arguments:?}");
    }
    // Results computed until then are there.
    assert!(names(&at.join("run")).unwrap().contains(&"report.html".to_owned()));
    assert!(names(&at.join("demo")).unwrap().contains(&"report.html".to_owned()));
    assert!(names(&at.join("compared")).unwrap().contains(&"report.html".to_owned()));
    // Incomplete files are not.
    assert!(!at.join("matched.txt").exists());
}

#[test]
fn a_table_of_stability_shows_its_progress_and_stops() {
    let folder = tempfile::tempdir().unwrap();
    stops_at("1:stacks:2", &["check", "demo-napa", "--table"], folder.path(), false);
}

#[test]
fn a_study_that_was_stopped_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let study = format!(
        "{HEAD}duration = \"20 s\"\n[base.motion.pulse]\nkind = \"one-sine\"\n\
                         amplitude = \"0.1 g\"\nperiod = \"0.3 s\"\n\
                         [[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\n\
                         range = {{ from = 0.3, to = 0.6, count = 64 }}\n\
                         [design]\nkind = \"full-factorial\"\nchunk = 1\n"
    );
    fs::write(folder.path().join("study.toml"), study).unwrap();
    let words = stopped("-TERM", &["study", "study.toml", "--out=study"], folder.path());
    assert!(words.contains("run the same command again"), "{words}");
    let out = folder.path().join("study");
    let status = barrelstack(["study", "status", out.to_str().unwrap(), "--json"]);
    let status: serde_json::Value = serde_json::from_str(&common::stdout(&status)).unwrap();
    assert!(!status["missing"].as_array().unwrap().is_empty());
}

/// Two levels of barrels, which stand, for a few seconds: short work with variants.
const SHORT: [&str; 4] = ["run", "demo-napa", "--set=stack.levels=2", "--set=run.duration=4 s"];

/// Words that occur in verdicts only.
const VERDICTS: [&str; 7] = [
    "This stack",
    "the stack stands",
    "Stands.",
    "Falls.",
    "Not safe.",
    "Too few variants",
    "gives way after",
];

/// Runs a command that stops itself at a place of its work; returns standard output, which must not contain a verdict
/// unless `finished`.
fn stops_at(place: &str, arguments: &[&str], folder: &Path, finished: bool) -> String {
    let what = format!("{arguments:?} at {place}");
    let output = program(arguments)
        .args(["--stop-at", place])
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let (said, words) = (common::stdout(&output), common::stderr(&output));
    assert_eq!(output.status.code(), Some(130), "{what}: {said}{words}");
    let mut pages = vec![said.clone()];
    for file in files(folder) {
        if Path::new(&file).extension().is_some_and(|end| end == "html" || end == "md") {
            pages.push(fs::read_to_string(file).unwrap());
        }
    }
    for (page, verdict) in pages.iter().flat_map(|page| VERDICTS.map(|verdict| (page, verdict))) {
        assert!(finished || !page.contains(verdict), "{what} says \"{verdict}\": {page}");
    }
    said
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn stopped_variants_are_kept_and_make_no_verdict() {
    for (plane, of) in [("both", 14), ("transverse", 7)] {
        let folder = tempfile::tempdir().unwrap();
        let view = format!("--set=stack.view={plane}");
        let arguments = [&SHORT[..], &[&view, "--variants=6", "--out=out", "--json"]].concat();
        let summary = json(&stops_at("1:runs:2", &arguments, folder.path(), false));
        assert_eq!(summary["outcome"]["kind"], "interrupted");
        assert_eq!(summary["unfinished"]["of"], of);
        let done = summary["unfinished"]["done"].as_u64().unwrap();
        assert!((2..of).contains(&done), "{done} of {of}");
        for verdict in ["ensemble", "remedy"] {
            assert!(summary[verdict].is_null(), "{verdict}");
        }
        assert!(summary["outcome"]["barrels_fallen"].is_null());
        // Finished cases have a row, and no others.
        let rows = fs::read_to_string(folder.path().join("out/variants.csv")).unwrap();
        assert_eq!(rows.lines().count() as u64, 1 + done, "{rows}");
        assert!(!rows.contains("interrupted"), "{rows}");
        assert!(folder.path().join("out/report.html").exists());
    }
}

#[test]
fn a_stopped_run_has_no_outcome_in_print() {
    let folder = tempfile::tempdir().unwrap();
    let said = stops_at(
        "1:seconds:1",
        &[&SHORT[..], &["--variants=0", "--set=stack.view=transverse"]].concat(),
        folder.path(),
        false,
    );
    assert!(said.contains("there is no verdict"), "{said}");
    assert!(said.contains("none: stopped before its end"), "{said}");
    let said =
        stops_at("1:runs:2", &[&SHORT[..], &["--variants=6"]].concat(), folder.path(), false);
    assert!(said.contains("of 14 runs"), "{said}");
}

#[test]
fn a_stack_that_had_collapsed_when_it_was_stopped_has_no_outcome_either() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["run", "candia-8-barrels", "--variants=0", "--out=out", "--json"];
    let summary = json(&stops_at("1:seconds:7", &arguments, folder.path(), false));
    let outcome = &summary["outcome"];
    assert_eq!(outcome["kind"], "interrupted");
    for field in ["mode", "time", "first", "first_fall", "barrels_fallen"] {
        assert!(outcome[field].is_null(), "{field}: {outcome}");
    }
    // Observations until then are reported with the bodies.
    let left = |body: &serde_json::Value| body["left_seat_at"].is_f64();
    assert!(summary["bodies"].as_array().unwrap().iter().any(left));
}

#[test]
fn the_verdict_is_kept_where_the_search_behind_it_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let weak = ["run", "demo-napa", "--set=stack.view=longitudinal", "--variants=8"];
    let brief = ["--set=run.stop_after_collapse=0.1 s", "--out=out", "--json"];
    let said = stops_at("2:changed stacks:1", &[&weak[..], &brief].concat(), folder.path(), true);
    let summary = json(&said);
    assert_eq!(summary["outcome"]["kind"], "collapse");
    assert_eq!(summary["ensemble"]["variants"], 8);
    assert_eq!(summary["remedy"]["complete"], false);
    assert!(folder.path().join("out/report.html").exists());
}

#[test]
fn of_a_stopped_comparison_the_finished_run_is_kept_and_nothing_is_compared() {
    let folder = tempfile::tempdir().unwrap();
    let compare = ["compare", "demo-napa", "--set=run.duration=4 s", "--set=stack.view=transverse"];
    let runs = ["--set=stack.levels=3", "--against=stack.levels=2", "--variants=6"];
    let both = [&compare[..], &runs].concat();
    // In the first run nothing is finished.
    let first = [&both[..], &["--out=first", "--json"]].concat();
    let document = json(&stops_at("1:runs:2", &first, folder.path(), false));
    assert_eq!(document["unfinished"].as_array().unwrap().len(), 2);
    assert_eq!(document["runs"][0]["summary"]["outcome"]["kind"], "interrupted");
    // In the second the first is.
    for place in ["2:runs:1", "2:seconds:2"] {
        let out = format!("--out={}", place.replace(':', "-"));
        let arguments = [&both[..], &[&out, "--json"]].concat();
        let document = json(&stops_at(place, &arguments, folder.path(), true));
        assert_eq!(document["runs"].as_array().unwrap().len(), 1, "{document}");
        assert_eq!(document["runs"][0]["summary"]["ensemble"]["variants"], 6);
        assert_eq!(document["unfinished"].as_array().unwrap().len(), 1);
        assert_ne!(document["runs"][0]["name"], document["unfinished"][0]);
        assert!(folder.path().join(&out[6..]).join("report.html").exists());
    }
    let said = stops_at("2:runs:1", &[&both[..], &["--out=print"]].concat(), folder.path(), true);
    assert!(!said.contains("Stands:") && !said.contains("stand:"), "{said}");
}

#[test]
fn of_stopped_layouts_the_finished_ones_are_kept_and_there_is_no_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let room = ["compare", "demo-cellar", "--set=stack.levels=1", "--set=run.duration=1 s"];
    let layouts = ["--variants=1", "--against=block.1.spacing=1 m", "--out=out", "--json"];
    let both = [&room[..], &layouts].concat();
    let first = json(&stops_at("1:runs:1", &both, folder.path(), false));
    assert!(first["error"].as_str().unwrap().contains("stopped"), "{first}");
    let document = json(&stops_at("2:runs:1", &both, folder.path(), true));
    assert_eq!(document["headline"], "Stopped after 1 of 2 layouts: there is no verdict.");
    assert_eq!(document["unfinished"].as_array().unwrap().len(), 1);
    assert!(document["paired"].as_array().unwrap().is_empty());
    assert!(folder.path().join("out/report.html").exists());
}

#[test]
fn what_is_stopped_in_space_has_no_outcome_and_keeps_its_variants() {
    let folder = tempfile::tempdir().unwrap();
    let space = [&SHORT[..], &["--set=stack.view=spatial", "--json"]].concat();
    let alone = [&space[..], &["--variants=0", "--out=alone"]].concat();
    let summary = json(&stops_at("1:seconds:0.5", &alone, folder.path(), false));
    assert_eq!(summary["outcome"]["kind"], "interrupted");
    assert!(folder.path().join("alone/report.html").exists());
    let varied = [&space[..], &["--variants=4", "--out=varied"]].concat();
    let summary = json(&stops_at("1:runs:1", &varied, folder.path(), false));
    assert!(summary["ensemble"].is_null() && summary["directions"].is_null());
    let done = summary["unfinished"]["done"].as_u64().unwrap();
    let rows = fs::read_to_string(folder.path().join("varied/variants.csv")).unwrap();
    assert_eq!(
        (summary["unfinished"]["of"].as_u64(), rows.lines().count() as u64),
        (Some(5), 1 + done)
    );
}

#[test]
fn repeats_that_are_stopped_are_no_success() {
    let folder = tempfile::tempdir().unwrap();
    let verify = ["run", "rocking-block", "--verify", "--set=run.duration=1 s", "--json"];
    let summary = json(&stops_at("3:seconds:0.5", &verify, folder.path(), true));
    assert_eq!(summary["outcome"]["kind"], "not-judged");
    assert!(!summary["verification"]["skipped"].as_array().unwrap().is_empty());
}

#[test]
fn of_a_stopped_reproduction_the_finished_cases_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    // Not all cases are done.
    let said = stops_at("1:runs:1", &["reproduce", "--out=first"], folder.path(), true);
    let cases = said.lines().filter(|line| line.contains(": ")).count();
    assert!((1..7).contains(&cases), "{said}");
    assert!(!said.contains("published results agree"), "{said}");
    assert!(!folder.path().join("first/index.html").exists());
}
