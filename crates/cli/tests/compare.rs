//! `compare`, and `run --verify` with a folder: printed output and written files.

use std::fs;
use std::path::Path;

use crate::common::{barrelstack, names, refused, stderr, stdout};
use serde_json::Value;

const SHORT: &str = "--set=run.stop_after_collapse=0.1 s";

/// Few variants, to save time.
const FEW: &str = "--variants=4";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn two_runs_become_one_page_and_a_few_lines() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("both");
    let output = barrelstack([
        "compare",
        "candia-8-barrels",
        "--against=interface.rack-ground.friction.coefficient=0.1",
        SHORT,
        FEW,
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("interface.rack-ground.friction.coefficient   0.5  |  0.1\n"), "{text}");
    assert!(text.contains("\nreport: "), "{text}");
    assert_eq!(names(&out).unwrap(), ["figures", "report.html", "report.md"]);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains(">Differences<") && page.contains("player several"));
    // Every figure that the text names exists.
    let markdown = fs::read_to_string(out.join("report.md")).unwrap();
    let links: Vec<&str> = markdown.split("](figures/").skip(1).collect();
    assert!(links.len() > 8, "{markdown}");
    for link in links {
        let name = link.split(')').next().unwrap();
        assert!(out.join("figures").join(name).is_file(), "{name}");
    }
    // A second comparison does not silently replace the first.
    let again =
        ["compare", "demo-napa", "--against=stack.levels=4", "--out", out.to_str().unwrap()];
    refused("occupied", &barrelstack(again), Path::new("/nowhere"), &["--overwrite"]);
}

#[test]
fn as_json_a_comparison_is_one_document() {
    let folder = tempfile::tempdir().unwrap();
    let output = barrelstack([
        "compare",
        "candia-8-barrels",
        "candia-8-barrels-half-scale",
        SHORT,
        FEW,
        "--json",
        "--out",
        folder.path().to_str().unwrap(),
    ]);
    let document = json(&stdout(&output));
    assert_eq!(document["runs"].as_array().unwrap().len(), 2);
    assert_eq!(document["runs"][1]["summary"]["outcome"]["kind"], "collapse");
    let paths: Vec<&str> = document["differences"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["path"].as_str().unwrap())
        .collect();
    assert_eq!(paths, ["run.similitude"]);
}

#[test]
fn what_cannot_be_compared_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("none");
    for (arguments, words) in [
        (vec!["demo-napa"], ["found 1", "--against PATH=VALUE"]),
        (vec!["demo-napa", "demo-napa"], ["demo-napa and demo-napa", "the same run"]),
        (vec!["demo-napa", "--against=stack.levels=5"], ["stack.levels = 5", "the same run"]),
        (vec!["demo-napa", "demo-nappa"], ["demo-nappa", "did you mean `demo-napa`"]),
        (vec!["demo-napa", "--against=stack.levles=4"], ["stack.levles", "did you mean `levels`"]),
    ] {
        let all = ["compare"].into_iter().chain(arguments).chain(["--out", out.to_str().unwrap()]);
        refused("not compared", &barrelstack(all), &out, &words);
        assert!(!out.exists());
    }
}

#[test]
fn a_verified_run_keeps_its_verification_in_summary_and_report() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let output =
        barrelstack(["run", "candia-8-barrels", SHORT, FEW, "--verify", "--json", "--out", out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary = fs::read_to_string(folder.path().join("summary.json")).unwrap();
    assert_eq!(summary, stdout(&output));
    let repeats = json(&summary)["verification"]["repeats"].as_array().unwrap().len();
    assert!(repeats >= 5, "{repeats}");
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains(">How far to trust this run</h2>"));
    assert_eq!(page.matches(">disturbed by 1\u{a0}nm, ").count(), 4);
    // Without it there is no such section.
    let other = tempfile::tempdir().unwrap();
    barrelstack(["run", "candia-8-barrels", SHORT, FEW, "--out", other.path().to_str().unwrap()]);
    let plain = fs::read_to_string(other.path().join("report.html")).unwrap();
    assert!(!plain.contains("How far to trust this run"));
    assert!(
        json(&fs::read_to_string(other.path().join("summary.json")).unwrap())["verification"]
            .is_null()
    );
}

/// Two stacks of two levels in a room, shaken for a short time.
const ROOM: [&str; 7] = [
    "compare",
    "demo-cellar",
    "--set=stack.levels=2",
    "--set=block.1.rows=1",
    "--set=run.duration=6 s",
    "--set=motion.scale.factor=2.5",
    "-q",
];

#[test]
fn two_layouts_of_a_room_are_compared_variant_by_variant() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("both").display().to_string();
    let more = ["--variants=2", "--against=block.1.spacing=\"1 m\"", "--out", &out];
    let output = barrelstack([&ROOM[..], &more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = json(&fs::read_to_string(folder.path().join("both/comparison.json")).unwrap());
    let said = stdout(&output);
    assert!(said.starts_with("Spacing 1 m instead of 0.3 m: "), "{said}");
    assert_eq!(said.lines().next(), found["headline"].as_str());
    assert!(said.contains("\n  layout ") && said.contains("\nreport: "), "{said}");
    assert_eq!(found["paired"][0]["variants"], 2);
    let all = ["comparison.json", "figures", "layouts.csv", "report.html", "report.md"];
    assert_eq!(names(&folder.path().join("both")).unwrap(), all);
    let page = fs::read_to_string(folder.path().join("both/report.html")).unwrap();
    assert!(page.contains(">Loss against capacity<") && page.contains(">Differences<"));
    // The numbers are those of the runs.
    let run = ["run", "--variants=2", "--json", "--set=block.1.spacing=1 m"];
    let run = stdout(&barrelstack([&run[..], &ROOM[1..]].concat()));
    let (run, second) = (json(&run), &found["layouts"][1]);
    assert_eq!(second["cellar_hash"], run["plan"]["cellar_hash"]);
    assert_eq!(second["by_themselves"]["mean"], run["room"]["by_themselves"]);
    assert_eq!(second["wine_lost"], run["room"]["wine_lost"][1]);
    assert_eq!(second["aisles"], run["aisles"]);
}

#[test]
fn usual_changes_of_a_room_are_ranked_and_those_that_do_not_fit_have_their_reason() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("usual").display().to_string();
    // One level has nothing to strap, to stop or to spare.
    let more = ["--set=stack.levels=1", "--variants=0", "--usual", "--json", "--out", &out];
    let room: Vec<&str> = ROOM.into_iter().filter(|one| !one.contains("levels")).collect();
    let output = barrelstack([&room[..], &more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = json(&stdout(&output));
    let names = |key: &str| -> Vec<String> {
        let all = found[key].as_array().unwrap();
        all.iter().map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(names("layouts"), ["as it is", "spacing 1 m", "every stack turned by 90°"]);
    assert_eq!(names("left_out").len(), 3);
    for one in found["left_out"].as_array().unwrap() {
        assert!(one["reason"].as_str().unwrap().contains("one level"), "{one}");
    }
    assert_eq!(found["order"].as_array().unwrap().len(), 3);
}

#[test]
fn layouts_that_cannot_be_compared_are_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("none");
    for (arguments, words) in [
        (vec!["demo-cellar"], ["found 1", "--against PATH=VALUE"]),
        (vec!["demo-cellar", "demo-cellar"], ["demo-cellar and demo-cellar", "the same run"]),
        (
            vec!["demo-napa", "demo-cellar"],
            ["demo-cellar: this is a cellar, and demo-napa is not", "stacks with stacks"],
        ),
        (
            vec!["demo-cellar", "--against=stack.levles=4"],
            ["stack.levles", "did you mean `levels`"],
        ),
        (
            vec!["demo-cellar", "--against=block.1.spacing=3 m"],
            ["beyond the right wall", "enlarge the room"],
        ),
        (
            vec!["demo-cellar", "--usual", "--label=a", "--label=b"],
            ["--label", "2 names for 1 run"],
        ),
        (vec!["demo-napa", "--usual"], ["--usual", "give a cellar"]),
        (
            vec!["demo-cellar", "--usual", "--record=nowhere.AT2"],
            ["nowhere.AT2", "correct the path after --record"],
        ),
    ] {
        let all = ["compare"].into_iter().chain(arguments).chain(["--out", out.to_str().unwrap()]);
        refused("not compared", &barrelstack(all), &out, &words);
        assert!(!out.exists());
    }
}
