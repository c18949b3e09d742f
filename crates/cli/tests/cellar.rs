//! `barrelstack check` and `barrelstack run` of a cellar: the plan, the answer, the files, and refusals.

use std::fs;

use crate::common::{barrelstack, refused, stderr, stdout};
use serde_json::Value;

#[test]
fn the_plan_is_drawn_before_anything_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.svg");
    let place = plan.display().to_string();
    let output = barrelstack(["check", "demo-cellar", "--plan", &place]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    for words in [
        "┌──",
        "▒ stack",
        "4 stacks in 2 rows: 40 barrels",
        "0.46 m from the left wall",
        "the scenario is sound",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(fs::read_to_string(&plan).unwrap().contains("tasting table"));
    // Nothing is overwritten.
    let again = barrelstack(["check", "demo-cellar", "--plan", &place]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("give another name after --plan"), "{}", stderr(&again));
    #[cfg(unix)]
    {
        let (link, behind) = (folder.path().join("link.svg"), folder.path().join("behind.svg"));
        std::os::unix::fs::symlink(&behind, &link).unwrap();
        let output = barrelstack(["check", "demo-cellar", "--plan", &link.display().to_string()]);
        refused("dangling link", &output, &behind, &["give another name after --plan"]);
    }
}

#[test]
fn a_mistyped_cellar_is_answered_with_the_nearest() {
    for arguments in
        [&["check", "demo-celar"][..], &["run", "demo-celar"], &["scenarios", "show", "demo-celar"]]
    {
        let output = barrelstack(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = stderr(&output);
        assert!(said.contains("did you mean `demo-cellar`"), "{arguments:?}: {said}");
        assert!(!said.contains("`kind`"), "{said}");
    }
}

#[test]
fn a_run_states_what_falls_and_leaves_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let small = [
        "--set=stack.levels=2",
        "--set=block.1.rows=1",
        "--set=run.duration=6 s",
        "--set=motion.scale.factor=2.5",
    ];
    let output = barrelstack(
        [&["run", "demo-cellar", "--variants=2", "-q", "--out", &place][..], &small].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary: Value =
        serde_json::from_slice(&fs::read(out.join("cellar.json")).unwrap()).unwrap();
    let said = stdout(&output);
    assert!(said.contains(summary["headline"].as_str().unwrap()), "{said}");
    assert!(said.contains("2 variants") || said.contains("of 2"), "{said}");
    for file in ["report.html", "stacks.csv", "plan.svg", "cellar.toml"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let again = barrelstack(["check", &out.join("cellar.toml").display().to_string(), "--json"]);
    let again: Value = serde_json::from_str(&stdout(&again)).unwrap();
    assert_eq!(again["cellar_hash"], summary["plan"]["cellar_hash"]);
}

#[test]
fn a_wrong_cellar_is_one_error_at_its_place_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let name = file.display().to_string();
    for (text, place, words) in [
        (
            "[[block]]\nrows = 500\nstacks = 500\nfirst = [\"1 m\", \"1 m\"]\n",
            ":4:",
            "more than 10000 barrels",
        ),
        ("[[block]]\nstacks = 3\nfirst = [\"4 m\", \"1 m\"]\n", ":5:", "into the right wall"),
        (
            "[[aisle]]\nname = \"a\"\nfrom = [\"2 m\", \"2 m\"]\nto = [\"1 m\", \"1 m\"]\n",
            ":6:",
            "needs larger coordinates",
        ),
        (
            "[[block]]\nfirst = [\"1 m\", \"1 m\"]\n[[block]]\nfirst = [\"1.2 m\", \"1 m\"]\n",
            ":6:",
            "overlap",
        ),
        (
            "[[door]]\nname = \"d\"\nside = \"left\"\nposition = \"1 m\"\n",
            ":6:",
            "stands in the door",
        ),
        ("[room]\nlenght = \"5 m\"\n", ":4:", "did you mean `length`"),
    ] {
        fs::write(&file, format!("schema = 1\nextends = \"demo-cellar\"\n{text}")).unwrap();
        let out = folder.path().join("out");
        let output = barrelstack(["run", &name, "--out", &out.display().to_string(), "-q"]);
        refused(text, &output, &out, &[&format!("{name}{place}"), words]);
        let output = barrelstack(["check", &name]);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(stderr(&output).contains(words), "{text}: {}", stderr(&output));
    }
}

#[test]
fn commands_for_one_stack_refuse_a_cellar() {
    for (arguments, words) in [
        (&["compare", "demo-cellar", "demo-napa"][..], "this is a cellar"),
        (&["run", "demo-cellar", "--verify"], "--verify"),
        (&["check", "demo-cellar", "--table"], "--table"),
        (&["check", "demo-napa", "--plan=x.svg"], "--plan draws the room of a cellar"),
    ] {
        let output = barrelstack(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
}
