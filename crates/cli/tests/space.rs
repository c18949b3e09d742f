//! `barrelstack run` of a stack in space: its files, its words, and what it refuses.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod common;

use std::fs;

use common::{barrelstack, stderr, stdout};
use serde_json::Value;

const SOLID: [&str; 5] = [
    "run",
    "demo-napa",
    "--set=stack.view=spatial",
    "--set=stack.levels=2",
    "--set=run.duration=10 s",
];

#[test]
fn a_run_in_space_says_what_fell_and_whereto_and_leaves_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let output = barrelstack([&SOLID[..], &["--variants=2", "--out", &place, "-q"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    assert!(said.contains("variants"), "{said}");
    assert!(said.contains("along the barrels"), "{said}");
    let summary: Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["schema"], "space/1");
    assert_eq!(summary["ensemble"]["variants"], 2);
    let rows = fs::read_to_string(out.join("variants.csv")).unwrap();
    assert_eq!(rows.lines().count(), 4);
    let frames = fs::read_to_string(out.join("frames.csv")).unwrap();
    // Time, and seven numbers of seven bodies.
    assert!(frames.lines().all(|line| line.split(',').count() == 50));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for view in ["Across the barrels", "Along the barrels", "From above"] {
        assert!(page.contains(view), "{view}");
    }
    // What was written reads back, to the same stack.
    let again =
        barrelstack(["run", &out.join("scenario.toml").display().to_string(), "--json", "-q"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let again: Value = serde_json::from_str(&stdout(&again)).unwrap();
    assert_eq!(again["provenance"]["scenario_hash"], summary["provenance"]["scenario_hash"]);
}

#[test]
fn what_space_does_not_know_is_refused_before_any_work() {
    for (more, told) in [
        (&["--verify"][..], "--verify is known in a plane"),
        (&["--set=stack.rack=rack-on-rack"], "has posts"),
        (&["--set=stack.strap.levels=1"], "straps are known in a plane"),
        (&["--set=stack.columns_along=3", "--set=stack.rack=four-barrel"], "stack.columns_along"),
    ] {
        let output = barrelstack([&SOLID[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(told), "{told}: {}", stderr(&output));
    }
    // And what works in a plane says so.
    let output = barrelstack(["check", "demo-napa", "--set=stack.view=spatial"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("this works in a plane"), "{}", stderr(&output));
}
