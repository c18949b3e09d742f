//! `barrelstack run` of a three-dimensional stack: its files, its text, and its refusals.

use std::fs;

use crate::common::{barrelstack, stderr, stdout};
use serde_json::Value;

const SOLID: [&str; 6] = [
    "run",
    "demo-napa",
    "--set=stack.view=spatial",
    "--set=stack.levels=2",
    "--set=motion.scale.factor=2",
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
    // A header row, the columns of variants, and those of frames; each has a meaning.
    let columns = fs::read_to_string(out.join("columns.csv")).unwrap();
    assert_eq!(columns.lines().count(), 1 + 14 + 50, "{columns}");
    assert!(columns.lines().all(|line| !line.ends_with(',')), "{columns}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for view in ["Across the barrels", "Along the barrels", "From above"] {
        assert!(page.contains(view), "{view}");
    }
    // The written scenario reads back, to the same stack.
    let again =
        barrelstack(["run", &out.join("scenario.toml").display().to_string(), "--json", "-q"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let again: Value = serde_json::from_str(&stdout(&again)).unwrap();
    assert_eq!(again["provenance"]["scenario_hash"], summary["provenance"]["scenario_hash"]);
}

#[test]
fn what_space_does_not_know_is_refused_before_any_work() {
    for (more, message) in [
        (&["--with-engine=x", "--out=y"][..], "simulates planar scenarios, but not three"),
        (&["--set=stack.columns_along=3", "--set=stack.rack=four-barrel"], "stack.columns_along"),
    ] {
        let output = barrelstack([&SOLID[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
}

#[test]
fn a_comparison_in_space_has_the_numbers_of_the_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("both");
    let place = out.display().to_string();
    let (few, weak) = ("--variants=2", "--against=motion.scale.factor=0.1");
    let output = barrelstack(
        [&["compare"], &SOLID[1..], &[few, weak, "--json", "--out", &place, "-q"]].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let compared: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(compared["paired"][0]["view"], "spatial");
    for (at, more) in [(0, None), (1, Some("--set=motion.scale.factor=0.1"))] {
        // The last change counts.
        let solid = SOLID.iter().copied().filter(|word| more.is_none() || !word.contains("factor"));
        let all: Vec<&str> =
            solid.chain(more).chain([few, "--no-remedy", "--json", "-q"]).collect();
        let alone = barrelstack(all);
        let alone: Value = serde_json::from_str(&stdout(&alone)).unwrap();
        let side = &compared["runs"][at]["summary"];
        assert_eq!(side["ensemble"], alone["ensemble"]);
        assert_eq!(side["provenance"]["scenario_hash"], alone["provenance"]["scenario_hash"]);
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("player several") && page.contains("\"depth\""), "two stacks in depth");
    assert!(out.join("figures/top-displacements-along.svg").is_file());
}

#[test]
fn a_verified_run_in_space_keeps_its_verification_on_page_and_paper() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().display().to_string();
    let more = ["--variants=0", "--verify", "--pdf", "--json", "--out", &place, "-q"];
    let output = barrelstack([&SOLID[..], &more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary = fs::read_to_string(folder.path().join("summary.json")).unwrap();
    assert_eq!(summary, stdout(&output));
    let summary: Value = serde_json::from_str(&summary).unwrap();
    // Half the step, and four disturbed repeats.
    assert_eq!(summary["verification"]["repeats"].as_array().unwrap().len(), 5);
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains(">How far to trust this run</h2>"));
    assert!(fs::read(folder.path().join("report.pdf")).unwrap().starts_with(b"%PDF-"));
}

#[test]
fn every_part_of_a_rendering_is_there_in_space() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let common =
        ["--set=run.duration=0.4 s", "--variants=0", "--size=64", "--rate=10", "--dpi=40", "-q"];
    let strapped = ["--set=stack.strap.levels=2", "--set=stack.lid.levels=1", "--out", &place];
    let output = barrelstack([&["render"], &SOLID[1..5], &common, &strapped].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for file in [
        "report.md",
        "report.pdf",
        "animation/stack.gif",
        "animation/stack.png",
        "frames/frame-0001.png",
        "figures/sequence-along-the-barrels.png",
        "paraview/stack.pvd",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }
    // Straps are lines of their own; lids belong to their racks.
    let names = fs::read_to_string(out.join("paraview/bodies.csv")).unwrap();
    assert!(
        names.contains("R2-R1 left,device,0") || names.contains("B1.1-R1 left,device,0"),
        "{names}"
    );
}

#[test]
fn a_free_scene_in_space_leaves_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let output = barrelstack(["run", "rolling-ball", "--out", &place, "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("ends at 0.714 m/s"), "{}", stdout(&output));
    let mut names: Vec<String> = fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["columns.csv", "frames.csv", "report.html", "scenario.toml", "summary.json"]
    );
    let summary: Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["schema"], "space/1");
    assert_eq!(summary["outcome"]["kind"], "not-judged");
    let body = &summary["bodies"][0];
    assert_eq!((&body["name"], &body["kind"]), (&"ball".into(), &"body".into()));
    let number = |value: &Value| value.as_f64().unwrap();
    let speed = number(&body["velocity"][0]).hypot(number(&body["velocity"][1]));
    assert!((speed - 5.0 / 7.0).abs() < 1e-4, "{speed}");
    // A header row, and the columns of frames.
    let columns = fs::read_to_string(out.join("columns.csv")).unwrap();
    assert_eq!(columns.lines().count(), 1 + 15, "{columns}");
    assert!(columns.lines().all(|line| !line.ends_with(',')), "{columns}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for view in ["From the front", "From the side", "From above"] {
        assert!(page.contains(view), "{view}");
    }
    // The list of inputs mentions seats, whose meaning is that of stacks.
    let seat = "the place that holds a barrel in its rack, or a rack on the barrels below";
    let text = page.split("<script").next().unwrap().replace(seat, "");
    assert!(!text.contains("the barrels"), "there are none");
}

#[test]
fn check_says_what_stands_in_space() {
    let said = |arguments: &[&str]| {
        let output = barrelstack([&["check"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    assert!(said(&["rolling-ball"]).contains("1 free body"));
    let stack = said(&["demo-napa", "--set=stack.view=spatial"]);
    assert!(stack.contains("10 barrels, 5 racks") && stack.contains("at rest"), "{stack}");
}

#[test]
fn a_run_in_space_becomes_a_series_for_paraview() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("out").display().to_string();
    for scenario in [&["render", "rolling-ball"][..], &["render", "demo-napa", "--variants=0"]] {
        let more = ["--set=stack.view=spatial", "--set=stack.levels=2"];
        let more = if scenario[1] == "rolling-ball" { &[][..] } else { &more[..] };
        let common = ["--set=run.duration=1 s", "--rate=4", "--overwrite", "-q", "--out", &place];
        let output = barrelstack([scenario, more, &common].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        // Five files of bodies, one per time, a file of names, and the index.
        assert!(stdout(&output).contains("paraview: 7 files"), "{}", stdout(&output));
        let index = folder.path().join("out/paraview/stack.pvd");
        assert_eq!(fs::read_to_string(index).unwrap().matches("<DataSet").count(), 5);
    }
    let names = fs::read_to_string(folder.path().join("out/paraview/bodies.csv")).unwrap();
    assert!(names.contains("B2.1,barrel,2"), "{names}");
}

#[test]
fn what_a_free_scene_in_space_does_not_know_is_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("out").display().to_string();
    for (command, message) in [
        (&["run", "rolling-ball", "--variants=3"][..], "a free scene has no variants"),
        (&["run", "rolling-ball", "--with-engine=x", "--out", &place], "but not three-dimensional"),
    ] {
        let output = barrelstack(command);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
    // What works for three-dimensional stacks also works for free scenes.
    for command in [
        &["run", "rolling-ball", "--verify"][..],
        &["render", "rolling-ball", "--only=animation", "--size=64", "--out", &place],
        &[
            "compare",
            "rolling-ball",
            "--against=run.duration=0.5 s",
            "--overwrite",
            "--out",
            &place,
        ],
    ] {
        let output = barrelstack([command, &["-q"]].concat());
        assert_eq!(output.status.code(), Some(0), "{command:?}: {}", stderr(&output));
    }
}
