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
        ("[[block]]\nstacks = 3\nfirst = [\"4 m\", \"1 m\"]\n", ":5:", "beyond the right wall"),
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
            "is too close to the door",
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

/// Napa College as recorded, and then at half the strength.
const NAPA_TWICE: &str = "schema = 1\nextends = \"demo-cellar\"\n[[motion.sequence]]\nbundled = \"napa-college-2014\"\n\
                          component = \"horizontal-1\"\nvertical = \"UP\"\n[[motion.sequence]]\nbundled = \"napa-college-2014\"\n\
                          component = \"horizontal-1\"\nvertical = \"UP\"\nscale = { factor = 0.5 }\n";

#[test]
fn the_second_shock_from_the_state_after_the_first_has_the_bits_of_the_sequence() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    fs::write(at("twice.toml"), NAPA_TWICE).unwrap();
    let second = "schema = 1\nextends = \"demo-cellar\"\n[start]\nfile = \"first.csv\"\n[motion]\nscale = { factor = 0.5 }\n";
    fs::write(at("second.toml"), second).unwrap();
    let run = |scenario: &str, state: &str| -> Value {
        // One stack, which falls in the first shock.
        let small = [
            "--variants=0",
            "--set=block.1.rows=1",
            "--set=block.1.stacks=1",
            "--set=stack.levels=3",
            "--set=interface.rack-ground.friction.coefficient=0.2",
            "--json",
            "-q",
            "--state",
        ];
        let output = barrelstack([&["run", scenario][..], &small, &[state]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).unwrap()
    };
    let twice = run(&at("twice.toml"), &at("twice.csv"));
    let first = run("demo-cellar", &at("first.csv"));
    let second = run(&at("second.toml"), &at("second.csv"));
    let state = |name: &str| fs::read_to_string(at(name)).unwrap();
    // Numbers are written in full, so equal texts are equal bits.
    assert!(state("first.csv") != state("second.csv"));
    assert_eq!(state("twice.csv"), state("second.csv"));
    // The room is at rest between the shocks, and the results of a shock are those of its run.
    let shocks = twice["shocks"].as_array().unwrap();
    for (shock, alone) in shocks.iter().zip([&first, &second]) {
        assert_eq!(shock["still_moving"]["of_variants"], 0, "{shock}");
        for count in ["by_themselves", "knocked_over", "barrels_fallen"] {
            assert_eq!(shock["shown"][count], alone["shown"][count], "{count}: {shock}");
        }
        assert_eq!(shock["shown"]["end_time"], alone["shown"]["end_time"]);
    }
    let fallen = |one: &Value| -> u64 {
        ["by_themselves", "knocked_over"]
            .iter()
            .map(|key| one["shown"][key].as_u64().unwrap())
            .sum()
    };
    assert_eq!(fallen(&first), 1);
    assert_eq!(second["shown"]["fallen_before"], 1);
    // Nothing is overwritten, and a stack alone has no such file.
    let again = barrelstack(["run", "demo-cellar", "--state", &at("first.csv")]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("another name after --state"), "{}", stderr(&again));
    let alone = barrelstack(["run", "demo-napa", "--state", &at("alone.csv")]);
    assert!(stderr(&alone).contains("--state: only the run of a cellar"), "{}", stderr(&alone));
}

#[test]
fn a_state_that_was_changed_by_hand_is_refused_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let name = folder.path().join("mine.toml").display().to_string();
    fs::write(&name, "schema = 1\nextends = \"demo-cellar\"\n[start]\nfile = \"survey.csv\"\n")
        .unwrap();
    let head = "stack,body,x (m),y (m),z (m),qw,qx,qy,qz\n";
    for (text, words) in [
        ("", "the file is empty"),
        ("stack,body\n", "no column of shifts"),
        ("body,dx (m)\n", "no column `stack`"),
        ("stack,dx\n1-1,0\n", "unknown column \"dx\": did you mean `dx (m)`?"),
        ("stack,dx (m)\n1-1,far\n", "survey.csv:2: column \"dx (m)\": expected a number"),
        ("stack,dx (m)\n1-1,inf\n", "expected a number"),
        (
            "stack,dx (m)\n1-1,0.1\n1-1,0.1\n",
            "survey.csv:3: a second row for stack \"1-1\", after the row in line 2",
        ),
        ("stack,dx (m)\n\n9-1,0.1\n", "survey.csv:3: column \"stack\": there is no stack \"9-1\""),
        (
            "stack,body,dx (m)\n1-1,B9.9,0.1\n",
            "survey.csv:2: column \"body\": stack \"1-1\" has no body",
        ),
        ("stack,dx (m)\n1-1\n", "survey.csv:2: expected 2 cells, one for each column"),
        (&format!("{head}1-1,B1.1,0,0,0,2,0,0,0\n"), "survey.csv:2: columns qw, qx, qy, qz"),
        (&format!("{head}1-1,B1.1,0,0,0,1,0,0,0\n"), "there is no pose of body"),
        (&format!("{head}1-1,B1.1,0,0,0,1,0,0,0\n1-1,B1.1,0,0,0,1,0,0,0\n"), "has two poses"),
        ("stack,body,x (m),dx (m)\n", "a file of poses has the columns"),
    ] {
        fs::write(folder.path().join("survey.csv"), text).unwrap();
        let output = barrelstack(["check", &name]);
        assert_eq!(output.status.code(), Some(2), "{text}");
        let said = stderr(&output);
        assert!(said.contains(&format!("{name}:4:")) && said.contains(words), "{text}: {said}");
    }
    // The overlap is found when the stacks are built.
    fs::write(folder.path().join("survey.csv"), "stack,body,dx (m)\n1-1,,0.02\n1-1,B1.1,0.05\n")
        .unwrap();
    let output = barrelstack(["run", &name, "--variants=0", "-q"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains(":4:") && said.contains("line 3 of the file") && said.contains("overlap"),
        "{said}"
    );
}

#[test]
fn the_residual_margin_is_a_list_of_strengths_and_an_order_of_inspection() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let output = barrelstack([
        "aftershock",
        "demo-cellar",
        "--scale=0.5,0.25",
        "--variants=2",
        "-q",
        "--set=stack.levels=2",
        "--set=block.1.rows=1",
        "--set=run.duration=5 s",
        "--out",
        &place,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    let read = fs::read(out.join("aftershocks.json")).unwrap();
    let summary: Value = serde_json::from_slice(&read).unwrap();
    let factors: Vec<f64> = summary["aftershocks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["factor"].as_f64().unwrap())
        .collect();
    assert_eq!(factors, [0.25, 0.5]);
    assert!(said.contains(summary["headline"].as_str().unwrap()), "{said}");
    assert!(
        said.contains("an aftershock of 0.25 times the strength of the main shock")
            && said.contains("one of 0.5"),
        "{said}"
    );
    for name in ["report.html", "aftershocks.csv", "inspection.csv"] {
        assert!(out.join(name).is_file(), "{name}");
    }
}

#[test]
fn an_aftershock_is_answered_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let small = [
        "--variants=2",
        "-q",
        "--set=stack.levels=2",
        "--set=block.1.rows=1",
        "--set=run.duration=6 s",
    ];
    let place = out.display().to_string();
    let strong = ["--set=motion.scale.factor=2.5", "--scale=0.4", "--out", &place];
    let output = barrelstack([&["aftershock", "demo-cellar"][..], &small, &strong].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    let summary: Value =
        serde_json::from_slice(&fs::read(out.join("cellar.json")).unwrap()).unwrap();
    let first = said.lines().next().unwrap();
    let begins = format!(
        "Of 2 stacks, {:.1} stand after the main shock",
        summary["shocks"][1]["stood"].as_f64().unwrap()
    );
    assert!(first.starts_with(&begins) || first.starts_with("No stack stands"), "{first}");
    let pga = |shock: usize| summary["shocks"][shock]["motion"]["pga"].as_f64().unwrap();
    assert!((pga(1) / pga(0) - 0.4).abs() < 1e-9);
    assert!(out.join("shocks.csv").is_file());
    for (arguments, words) in [
        (
            &["aftershock", "demo-cellar", "--scale=-1"][..],
            "'-1' for '--scale <FACTOR>': expected a factor above 0",
        ),
        (&["aftershock", "demo-cellar", "--scale=nan"], "expected a factor above 0"),
        (&["aftershock", "demo-cellar", "--scale=0.5,0.5"], "0.5 is given twice"),
        (
            &["aftershock", "demo-cellar", "--scale=0.5,0.7", "--variant=1"],
            "--variant selects the run that is shown",
        ),
        (&["aftershock", "demo-napa"], "kind = \"cellar\""),
        (&["aftershock", "demo-cellar", "--record=nowhere.AT2", "-q"], "nowhere.AT2"),
    ] {
        let output = barrelstack(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
}
