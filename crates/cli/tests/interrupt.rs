//! Ctrl-C and SIGTERM: every command ends within a second, keeps what it has, and says so.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod common;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use common::{HEAD, barrelstack, names, program};

/// Work of hours.
const LONG: [&str; 3] =
    ["--set=run.duration=3600 s", "--set=run.until=duration", "--set=stack.levels=2"];

/// How long a command may take to end; measured 0.1 to 0.9 s on a machine that does other things, too.
const AT_MOST: Duration = Duration::from_millis(1500);

/// Starts a command, signals it, and gives its words on standard error.
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
    // Standard input stays open, so that what reads it waits on.
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

/// All files below a folder.
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
fn every_command_ends_within_a_second_and_says_what_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let study = format!(
        "{HEAD}duration = \"2000 s\"\nuntil = \"duration\"\n[base.motion.pulse]\nkind = \"one-sine\"\n\
                         amplitude = \"0.1 g\"\nperiod = \"0.3 s\"\n\
                         [[factor]]\nfield = \"motion.pulse.amplitude\"\nvalues = [\"0.1 g\", \"0.2 g\"]\n\
                         [design]\nkind = \"full-factorial\"\nchunk = 1\n"
    );
    fs::write(at.join("study.toml"), study).unwrap();
    fs::write(at.join("seen.csv"), "mode,until (s)\nstands,8\n").unwrap();
    let rows: Vec<String> =
        (0..400).map(|row| format!("{:.1},{}\n", 0.1 * f64::from(row), row % 3)).collect();
    let response = format!("time (s),B1.1 displacement x (mm)\n{}", rows.concat());
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
        vec!["calibrate", "collapse", "candia-8-barrels", "seen.csv", "--simulations=100000"],
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
    // What was computed until then is there.
    assert!(names(&at.join("run")).unwrap().contains(&"report.html".to_owned()));
    assert!(names(&at.join("demo")).unwrap().contains(&"report.html".to_owned()));
    // What would be half is not.
    assert_eq!(names(&at.join("compared")), None);
    assert!(!at.join("matched.txt").exists());
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
