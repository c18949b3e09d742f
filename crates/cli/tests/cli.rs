//! The command for people and scripts: printed output, written files, exit status.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

use crate::common::{barrelstack, names, program, refused, stderr, stdout};
use serde_json::Value;

/// A run with a few variants that takes a fraction of a second.
const SHORT: [&str; 4] = [
    "run",
    "candia-8-barrels",
    "--set=run.stop_after_collapse=0.1 s",
    "--set=imperfections.variants=4",
];

/// All files of a run.
const FILES: [&str; 10] = [
    "columns.csv",
    "envelopes.csv",
    "forces.csv",
    "frames.csv",
    "histories.csv",
    "histories.npz",
    "report.html",
    "scenario.toml",
    "summary.json",
    "variants.csv",
];

/// One run without variants.
const ONE: &str = "--set=imperfections.variants=0";

/// The weaker plane of the demo.
const ALONG: &str = "--set=stack.view=longitudinal";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Returns the lines of a summary without the wall-clock time.
fn timeless(text: &str) -> Vec<String> {
    let lines = text.lines().filter(|line| !line.contains("wall_seconds"));
    lines.map(str::to_owned).collect()
}

#[test]
fn an_option_that_is_no_number_is_refused_in_plain_words() {
    for (arguments, said) in [
        (
            ["protect", "--budget=lots"],
            "'lots' for '--budget <NUMBER>': expected an amount in US$ of 0 or more",
        ),
        (["heights", "--seed=a"], "'a' for '--seed <NUMBER>': expected a whole number from 0 to"),
        (
            ["run", "--variants="],
            "'' for '--variants <NUMBER>': expected a whole number from 0 to 4096\n",
        ),
        // Another name of the option is understood.
        (
            ["heights", "--levels=many"],
            "'many' for '--highest <LEVELS>': expected a whole number from 2 to 6\n",
        ),
    ] {
        let output = barrelstack(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = stderr(&output);
        assert!(text.contains(said), "{text}");
        assert!(!text.contains("literal") && !text.contains("digit"), "{text}");
    }
}

#[test]
fn a_page_states_its_date_and_commit_and_a_wrong_date_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |date: &str| {
        let mut command = program(["run", "sliding-block", "--quiet", "--overwrite", "--out"]);
        command.arg(&out).env("SOURCE_DATE_EPOCH", date).output().unwrap()
    };
    assert!(run("1408875644").status.success());
    let page = fs::read_to_string(out.join("report.html")).unwrap().replace('\u{a0}', " ");
    assert!(page.contains("<dd>2014-08-24 (UTC)</dd>"), "no date");
    assert!(page.contains(", commit 0123456789ab</dd>"), "no commit");
    for (wrong, found) in [("yesterday", "\"yesterday\""), ("7258118400", "before the year 2200")] {
        let refused = run(wrong);
        assert_eq!(refused.status.code(), Some(2));
        let said = stderr(&refused);
        assert!(said.contains("SOURCE_DATE_EPOCH") && said.contains(found), "{said}");
    }
}

/// A scenario and a cellar from a pipe, which can be read only once, and the files that they extend.
#[cfg(unix)]
#[test]
fn a_file_is_read_from_a_pipe_of_the_shell() {
    let folder = tempfile::tempdir().unwrap();
    let base = folder.path().join("base.toml");
    fs::write(&base, "schema = 1\nextends = \"sliding-block\"\n").unwrap();
    for (extends, words) in [
        ("sliding-block", "sliding block"),
        (base.to_str().unwrap(), "sliding block"),
        ("demo-cellar", "4 stacks in 2 rows: 40 barrels"),
    ] {
        let mut child = program(["check", "/dev/stdin"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let text = format!("schema = 1\nextends = \"{extends}\"\n");
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{extends}: {}", stderr(&output));
        let said = stdout(&output);
        assert!(said.to_lowercase().contains(words), "{extends}: {said}");
    }
}

#[test]
fn the_summary_says_what_happened_in_words_and_rows() {
    let output = barrelstack(SHORT);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stderr(&output), "");
    let first: Vec<&str> = text.lines().take(3).collect();
    assert_eq!(first[0], "Eight barrels on four levels, 4-inch sine");
    assert!(first[1].starts_with("  ") && first[1].ends_with('.'), "{}", first[1]);
    let second = "  In the run that is shown, the barrels of level 4 are thrown off the stack with their rack, R4.";
    assert_eq!(first[2], second);
    assert!(text.contains("\n  changed                 run.stop_after_collapse=0.1 s\n"), "{text}");
    assert!(text.contains("\n  outcome                 collapse by ejection at "), "{text}");
    let rows = text.lines().skip_while(|line| !line.is_empty()).skip(1);
    for row in rows.take_while(|line| !line.is_empty()) {
        // Names fill 24 characters after the margin of 2, so all values are aligned.
        let at: Vec<char> = row.chars().collect();
        assert!(row.starts_with("  ") && at[25] == ' ' && at[26] != ' ', "{row:?}");
    }
}

#[test]
fn a_former_key_gives_the_same_run_with_a_warning() {
    let with = |change: &str| {
        let change = format!("--set={change}");
        barrelstack(SHORT.into_iter().chain([change.as_str(), "--json", "--quiet"]))
    };
    let (former, present) = (with("imperfections.kind=hair"), with("unknowns.drawn=false"));
    let (mut former, present) = (json(&stdout(&former)), json(&stdout(&present)));
    let warning = "override `imperfections.kind=hair`: `imperfections.kind` is an old name, and a later version will \
    reject it: write `unknowns.drawn = false` instead";
    assert_eq!(former["warnings"].as_array_mut().unwrap().remove(0), warning);
    for key in ["warnings", "ensemble", "outcome", "bodies"] {
        assert!(!present[key].is_null(), "{key}");
        assert_eq!(former[key], present[key], "{key}");
    }
    let hash = |summary: &Value| summary["provenance"]["scenario_hash"].clone();
    assert!(hash(&present).is_string() && hash(&former) == hash(&present));
    assert_eq!(present["ensemble"]["kind"], "imperfections");
    // The terminal prints the warning, too.
    let set = "--set=imperfections.damping=0.2";
    let error = stderr(&barrelstack(SHORT.into_iter().chain([set])));
    assert!(error.contains("write `unknowns.damping` instead"), "{error}");
}

#[test]
fn json_is_one_document_and_the_same_twice() {
    let arguments = || SHORT.into_iter().chain(["--json"]);
    let (first, second) = (barrelstack(arguments()), barrelstack(arguments()));
    assert_eq!(stderr(&first), "");
    let summary = json(&stdout(&first));
    assert_eq!(summary["outcome"]["mode"], "ejection");
    assert_eq!(summary["bodies"].as_array().unwrap().len(), 12);
    assert!(summary["run"]["wall_seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(timeless(&stdout(&first)), timeless(&stdout(&second)));
}

#[test]
fn a_folder_gets_all_files_and_the_same_summary() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a/b");
    let arguments = SHORT.into_iter().chain(["--json", "--out", out.to_str().unwrap()]);
    let output = barrelstack(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(names(&out).unwrap(), FILES);
    assert_eq!(fs::read_to_string(out.join("summary.json")).unwrap(), stdout(&output));
    // The written scenario can be run again, with the same result.
    let scenario = out.join("scenario.toml");
    let again = barrelstack(["run", scenario.to_str().unwrap(), "--json"]);
    assert_eq!(timeless(&stdout(&again)), timeless(&stdout(&output)));
}

#[test]
fn an_occupied_folder_is_left_alone_by_default() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    fs::write(folder.path().join("letter.txt"), "mine").unwrap();
    let refusal = barrelstack(SHORT.into_iter().chain(["--out", out]));
    refused("occupied", &refusal, Path::new("/nowhere"), &[out, "letter.txt", "--overwrite"]);
    assert_eq!(names(folder.path()).unwrap(), ["letter.txt"]);

    fs::write(folder.path().join("summary.json"), "old").unwrap();
    let output = barrelstack(SHORT.into_iter().chain(["--out", out, "--overwrite"]));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(names(folder.path()).unwrap().len(), FILES.len() + 1);
    assert_eq!(fs::read_to_string(folder.path().join("letter.txt")).unwrap(), "mine");
    assert!(fs::read_to_string(folder.path().join("summary.json")).unwrap().starts_with("{\n"));
}

#[test]
fn a_demo_replaces_what_a_demo_wrote_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("demo");
    let demo = || {
        let quick = ["demo", "--set=stack.levels=1", "--set=run.duration=0.05 s", "--out"];
        barrelstack(quick.into_iter().chain([out.to_str().unwrap()]))
    };
    for _ in 0..2 {
        let output = demo();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        // The page is there before the search for changes.
        assert!(stderr(&output).contains("report.html shows the result so far"));
    }
    // Changed by its owner some time later.
    let mine = fs::File::options().append(true).open(out.join("scenario.toml")).unwrap();
    (&mine).write_all(b"# mine\n").unwrap();
    mine.set_modified(std::time::SystemTime::now() + std::time::Duration::from_secs(60)).unwrap();
    let output = demo();
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    assert!(stderr(&output).contains("scenario.toml in "), "{}", stderr(&output));
    assert!(fs::read_to_string(out.join("scenario.toml")).unwrap().ends_with("# mine\n"));
}

#[test]
fn a_verdict_that_cannot_be_written_is_printed_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    // The folder exists before the run; the obstacle concerns one file only.
    fs::create_dir_all(out.join("report.html/in the way")).unwrap();
    let arguments =
        SHORT.into_iter().chain(["--json", "--overwrite", "--out", out.to_str().unwrap()]);
    let output = barrelstack(arguments);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(json(&stdout(&output))["outcome"]["kind"], "collapse");
    assert!(stderr(&output).starts_with("error: cannot write "), "{}", stderr(&output));
}

#[test]
fn a_file_in_the_place_of_the_folder_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "mine").unwrap();
    for out in [file.clone(), file.join("below")] {
        let arguments = ["run", "demo-napa", "--out", out.to_str().unwrap()];
        refused("file", &barrelstack(arguments), &out, &[file.to_str().unwrap(), "not a folder"]);
    }
    assert_eq!(fs::read_to_string(file).unwrap(), "mine");
}

#[test]
fn a_scenario_can_come_from_standard_input() {
    let shown = barrelstack(["scenarios", "show", "candia-8-barrels-half-scale"]);
    let mut child = program(["run", "-", "--json", "--set=run.stop_after_collapse=0.1 s"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(&shown.stdout).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(json(&stdout(&output))["run"]["similitude"], 0.5);
    let empty = barrelstack(["check", "-"]);
    refused("empty input", &empty, Path::new("/nowhere"), &["standard input", "empty"]);
}

#[test]
fn a_name_that_is_nothing_is_answered_with_the_nearest() {
    let out = Path::new("/nowhere");
    let near = barrelstack(["run", "candia-8-barels"]);
    refused(
        "near",
        &near,
        out,
        &["no file \"candia-8-barels\"", "did you mean `candia-8-barrels`?"],
    );
    // The words of the name may be in another order.
    for (typed, meant) in [("napa-demo", "demo-napa"), ("barrels-8-candia", "candia-8-barrels")] {
        let other = barrelstack(["run", typed]);
        refused("order", &other, out, &[&format!("did you mean `{meant}`?")]);
    }
    let document = barrelstack(["schema", "info-motion"]);
    refused("document", &document, out, &["no document", "did you mean `motion-info`?"]);
    let rack = barrelstack(["heights", "--rack=barrel-two", "--out=nowhere"]);
    refused("rack", &rack, out, &["no rack `barrel-two`", "did you mean `two-barrel`?"]);
    let far = barrelstack(["run", "something"]);
    refused("far", &far, out, &["no file \"something\"", "`barrelstack scenarios`"]);
    refused("file", &barrelstack(["check", "none.toml"]), out, &["none.toml", "no such file"]);
}

#[test]
fn the_record_that_cannot_be_passed_on_has_instructions() {
    let words = ["candia-6-barrels", "PEER NGA-West2", "PEL360", "--record FILE"];
    let folder = tempfile::tempdir().unwrap();
    let output = program(["run", "candia-6-barrels"]).current_dir(folder.path()).output().unwrap();
    refused("record", &output, Path::new("/nowhere"), &words);
}

#[test]
fn changes_that_cannot_be_made_are_shown_as_typed() {
    let out = Path::new("/nowhere");
    let with = |set: &str| barrelstack(["run", "demo-napa", "--set", set]);
    refused("typo", &with("stack.levles=3"), out, &["stack.levles=3", "`levels`"]);
    refused("no value", &with("stack.levels"), out, &["stack.levels", "="]);
    refused("unit", &with("stack.barrel.mass=275"), out, &["stack.barrel.mass=275", "kg"]);
}

#[test]
fn a_stack_that_stands_and_a_run_cut_short_say_so() {
    let output = barrelstack([
        "run",
        "demo-napa",
        ALONG,
        ONE,
        "--set=stack.levels=1",
        "--set=run.duration=1 s",
    ]);
    assert_eq!(output.status.code(), Some(0));
    let stands = "  Shaken along the barrels, the stack stands until the run ends at 1.0 s, 34.0 s before the end of \
                  the motion.\n";
    assert!(stdout(&output).contains(stands), "{}", stdout(&output));
    let warning = stderr(&output);
    assert!(
        warning.starts_with("warning: the run ends at 1.0 s, before the motion ends at "),
        "{warning}"
    );
    assert_eq!(warning.lines().count(), 1);
    // In JSON the same warning is part of the document, and standard error is silent.
    let arguments = [
        "run",
        "demo-napa",
        ALONG,
        ONE,
        "--set=stack.levels=1",
        "--set=run.duration=1 s",
        "--json",
    ];
    let output = barrelstack(arguments);
    assert_eq!(stderr(&output), "");
    assert_eq!(json(&stdout(&output))["warnings"].as_array().unwrap().len(), 1);
}

#[test]
fn a_run_that_broke_down_is_no_verdict_and_has_a_status_of_its_own() {
    // A time step near the critical one, with dampers that are too strong for it. The stack does not settle first,
    // because settling would already reveal this.
    let broken = [
        "--set=run.settle=false",
        "--set=run.step=0.6 ms",
        "--set=interface.barrel-rack.damping=\"3000 N s/cm\"",
    ];
    let output = barrelstack(["run", "candia-8-barrels", ONE].into_iter().chain(broken));
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("The computation failed, so the run permits no conclusion about the stack."),
        "{text}"
    );
    assert!(text.contains("outcome                 invalid\n"), "{text}");
    assert!(!text.contains("fall"), "{text}");
    let json_run = ["run", "candia-8-barrels", ONE, "--json"].into_iter().chain(broken);
    let summary = json(&stdout(&barrelstack(json_run)));
    assert_eq!(summary["outcome"]["kind"], "invalid");
    assert!(summary["outcome"]["reason"].as_str().unwrap().contains("energy balance"), "{summary}");
    assert_eq!(summary["outcome"]["mode"], Value::Null);
}

#[test]
fn a_free_scene_is_not_judged() {
    let text = stdout(&barrelstack(["run", "sliding-block"]));
    assert!(text.contains("outcome                 not judged: "), "{text}");
    assert!(!text.contains("judge a stack by many runs"), "{text}");
}

#[test]
fn variants_are_listed_counted_and_shown_by_their_number() {
    let text = stdout(&barrelstack(SHORT));
    let headline = "  Falls. Shaken across the barrels, all 4 variants fall (95 % confidence: at least 51 %). The \
                    first seat is lost between ";
    assert!(text.contains("; no barrel falls within 0.1 s of that loss.\n"), "{text}");
    assert!(text.contains(headline), "{text}");
    assert!(text.contains("variants                4 of 4 collapse, 95 % interval "), "{text}");
    let summary = |more: &[&str]| {
        let all = SHORT.into_iter().chain(["--json"]).chain(more.iter().copied());
        json(&stdout(&barrelstack(all)))
    };
    let typical = summary(&[]);
    let ensemble = &typical["ensemble"];
    assert_eq!((&ensemble["variants"], &ensemble["collapsed"]), (&json("4"), &json("4")));
    let modes = ensemble["modes"].as_object().unwrap().values();
    assert_eq!(modes.map(|count| count.as_u64().unwrap()).sum::<u64>(), 4, "{ensemble}");
    assert_eq!(typical["variant"], ensemble["typical"]);
    let third = summary(&["--variant=3"]);
    assert_eq!((&third["variant"], &third["ensemble"]), (&json("3"), ensemble));
    let alone = summary(&["--variants=0"]);
    assert_eq!((&alone["variant"], &alone["ensemble"]), (&json("0"), &Value::Null));
    let beyond = barrelstack(SHORT.into_iter().chain(["--variant=5"]));
    refused("beyond", &beyond, Path::new("/nowhere"), &["--variant 5", "1 to 4", "--variants 5"]);
    let free = barrelstack(["run", "sliding-block", "--variants=3"]);
    refused("free", &free, Path::new("/nowhere"), &["--variants", "free scene"]);
}

#[test]
fn both_planes_are_printed_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("both");
    let brief = ["--set=stack.levels=1", "--set=run.duration=1 s", "--variants=3"];
    let all = ["run", "demo-napa", "--out", out.to_str().unwrap()].into_iter().chain(brief);
    let output = barrelstack(all);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.contains("\n  across the barrels\n") && text.contains("\n  along the barrels\n"),
        "{text}"
    );
    let names = names(&out).unwrap();
    for name in ["longitudinal-histories.csv", "transverse-frames.csv", "variants.csv"] {
        assert!(names.iter().any(|one| one == name), "{name}: {names:?}");
    }
    let rows = fs::read_to_string(out.join("variants.csv")).unwrap();
    assert_eq!(rows.lines().count(), 1 + 2 * 4, "{rows}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Results of all variants") && page.contains("player several"));
    let summary = json(&fs::read_to_string(out.join("summary.json")).unwrap());
    let views = [&summary["view"], &summary["other_plane"]["view"]];
    assert_ne!(views[0], views[1], "{views:?}");
}

#[test]
fn a_rack_that_walks_takes_the_levels_above_with_it() {
    let stop = "--set=run.stop_after_collapse=0 s";
    let text = stdout(&barrelstack(["run", "candia-8-barrels-longitudinal", ONE, stop]));
    let walk = "Rack R2 slides along the barrels below until it leaves them, and takes levels 2 to 4 \
                with it.";
    assert!(text.contains(walk), "{text}");
}

#[test]
fn check_says_what_stands_there() {
    let output = barrelstack(["check", "demo-napa"]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0));
    // Across the barrels, then along them one rack deep.
    let planes = [
        "across the barrels:\n",
        "10 barrels, 5 racks\n",
        "along the barrels:\n",
        "5 barrels, 5 racks\n",
    ];
    let at = planes.map(|part| text.find(part).unwrap_or_else(|| panic!("{part}: {text}")));
    assert!(at.is_sorted(), "{text}");
    assert!(text.ends_with("the scenario is sound\n"), "{text}");
}

#[test]
fn every_listed_scenario_can_be_shown_checked_and_resolved() {
    let list = stdout(&barrelstack(["scenarios"]));
    // Thirteen scenarios and three cellars.
    assert_eq!(list.lines().count(), 16);
    for line in list.lines() {
        let (name, title) = line.split_once("  ").unwrap();
        let shown = stdout(&barrelstack(["scenarios", "show", name]));
        assert!(shown.contains(title.trim()), "{name}");
        let resolved = barrelstack(["scenarios", "show", name, "--resolved"]);
        assert_eq!(resolved.status.code(), Some(0), "{name}: {}", stderr(&resolved));
        if !name.starts_with("candia-6") {
            let check = barrelstack(["check", name]);
            assert_eq!(check.status.code(), Some(0), "{name}: {}", stderr(&check));
        }
    }
    let fields = stdout(&barrelstack(["scenarios", "fields"]));
    // Which pair to set: seats, or impacts.
    for (pair, kind) in [
        ("rack-ground", "Seat"),
        ("barrel-rack", "Seat"),
        ("rack-rack", "Seat"),
        ("barrel-barrel", "Impact"),
        ("barrel-ground", "Impact"),
        ("fallen-barrel-rack", "Impact"),
        ("fallen-rack-ground", "Impact"),
        ("fallen-rack-rack", "Impact"),
    ] {
        let row = format!("| `{pair}` | a table | none | {kind}: ");
        assert!(fields.contains(&row), "no {row:?}");
    }
    assert!(fields.contains("candia-2008"));
    let schema = json(&stdout(&barrelstack(["scenarios", "schema"])));
    assert!(schema["$defs"]["rack"].to_string().contains("candia-2008"), "{schema}");
}

#[test]
fn the_demo_writes_its_report_and_may_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    for _ in 0..2 {
        let output = program(["demo", "--set=run.duration=1 s", "--variants=4"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let report = Path::new("barrelstack-demo").join("report.html");
        let said = stdout(&output);
        assert!(
            said.starts_with("Not decided, because the runs end at 1.0 s, before the motion ends.")
        );
        // The demo is three-dimensional unless a view is given.
        assert!(
            said.contains("None of 4 variants") && !said.contains("across the barrels"),
            "{said}"
        );
        let open = format!("\n\nOpen {} in a browser to watch it.\n", report.display());
        assert!(stdout(&output).ends_with(&open), "{}", stdout(&output));
        assert!(folder.path().join(report).is_file());
    }
}

#[test]
fn help_names_the_exit_statuses_and_every_command() {
    let help = stdout(&barrelstack(["--help"]));
    for word in ["run", "demo", "check", "scenarios", "Exit status", "130"] {
        assert!(help.contains(word), "{word}");
    }
    let longest = help.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(longest <= 110, "{longest}");
    let nothing = barrelstack([] as [&str; 0]);
    assert_eq!(nothing.status.code(), Some(2));
    assert_eq!(stdout(&nothing), "");
}

#[test]
fn a_score_takes_no_record() {
    let said = barrelstack(["score", "demo-napa", "--record", "mine.AT2"]);
    assert_eq!(said.status.code(), Some(2));
    assert!(stderr(&said).contains("--record") && stderr(&said).contains("leave --record out"));
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::Read as _;
    use std::process::Command;
    use std::time::Duration;

    #[test]
    fn a_reader_that_goes_away_is_no_error() {
        let mut child =
            program(SHORT).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let status = child.wait().unwrap();
        let mut message = String::new();
        child.stderr.take().unwrap().read_to_string(&mut message).unwrap();
        assert_eq!((status.code(), message.as_str()), (Some(0), ""));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_result_that_cannot_be_printed_is_an_error() {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = program(SHORT).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).starts_with("error: cannot write to standard output: "));
    }

    #[test]
    fn ctrl_c_keeps_what_was_computed() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        // An hour in steps of 4 µs takes minutes, and is interrupted before.
        let child = program(["run", "sliding-block", "--set=run.duration=3600 s"])
            .args(["--set=run.step=4 us", "--json", "--out", out.to_str().unwrap()])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_secs(1));
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        let summary = json(&stdout(&output));
        assert_eq!(summary["run"]["interrupted"], true);
        assert_eq!(summary["outcome"]["kind"], "interrupted");
        let reached = summary["run"]["end_time"].as_f64().unwrap();
        assert!(reached > 0.0 && reached < 3600.0, "{reached}");
        let warning = summary["warnings"][0].as_str().unwrap();
        assert!(warning.starts_with("the run was stopped at "), "{warning}");
        assert_eq!(names(&out).unwrap(), FILES);
    }
}
