//! Text for people: names, labels, advice, and no paths of the machine.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{barrelstack, stderr, stdout};
use serde_json::Value;

/// Returns a record of a second in the format of the PEER database.
fn peer(folder: &Path, header: &str) -> String {
    let mut text = format!(
        "PEER STRONG MOTION DATABASE RECORD\n{header}\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS=  200, \
         DT= .01000 SEC\n"
    );
    for k in 0..200_i32 {
        let value = 0.02 * f64::from((k % 40) - 20).abs() - 0.2;
        let _ = write!(text, "  {value:.6E}");
        if k % 5 == 4 {
            text.push('\n');
        }
    }
    let file = folder.join("my-site.AT2");
    fs::write(&file, text).unwrap();
    file.display().to_string()
}

#[test]
fn records_are_called_as_people_call_them_and_pages_say_nothing_of_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().display().to_string();
    for (header, title, motion) in [
        (
            "NORTHRIDGE 01/17/94 1231, ARLETA, 360",
            "Northridge 1994",
            "Northridge 1994, Arleta, 360°",
        ),
        ("- 01/17/94 1231, , 360", "my-site.AT2", "my-site.AT2, 360°"),
    ] {
        let record = peer(folder.path(), header);
        let out = folder.path().join("out");
        let output = barrelstack([
            "run",
            "demo-napa",
            "--record",
            &record,
            "--set=stack.levels=2",
            "--set=run.duration=3 s",
            "--variants=2",
            "--no-remedy",
            "--overwrite",
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let said = stdout(&output);
        assert!(said.starts_with(&format!("Four barrels on two levels, {title}\n")), "{said}");
        assert!(
            said.contains(&format!("the ground motion is {motion} (horizontal only).")),
            "{said}"
        );
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(!page.contains(&place), "{}", page.split(&place).next().unwrap().len());
        assert!(page.contains("my-site.AT2"), "the file is named");
    }
}

#[test]
fn the_command_of_the_advice_makes_the_comparison_that_it_promises() {
    let brief = ["--set=motion.sine.cycles=4", "--set=run.stop_after_collapse=0.1 s"];
    let folder = tempfile::tempdir().unwrap();
    let output = barrelstack(
        ["run", "candia-8-barrels", "--set=stack.levels=3", "--variants=4", "--json", "--quiet"]
            .into_iter()
            .chain(brief),
    );
    let summary: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let remedy = &summary["remedy"];
    let command = remedy["comparison"].as_str().unwrap();
    let level = remedy["height"]["levels"].as_u64().unwrap();
    let out = folder.path().join("both");
    // Splits the command into words as a shell does.
    let split = std::process::Command::new("sh")
        .args(["-c", &format!("printf '%s\\n' {command}")])
        .output()
        .unwrap();
    let words = String::from_utf8(split.stdout).unwrap();
    let words: Vec<&str> = words.lines().skip(1).collect();
    let output =
        barrelstack(words.into_iter().chain(["--json", "--quiet", "--out", out.to_str().unwrap()]));
    assert_eq!(output.status.code(), Some(0), "{command}: {}", stderr(&output));
    let found: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let runs = found["runs"].as_array().unwrap();
    assert_eq!(runs[0]["summary"]["ensemble"], summary["ensemble"]);
    assert_eq!(runs[1]["summary"]["ensemble"]["collapsed"], remedy["height"]["failed"]);
    let name = runs[1]["name"].as_str().unwrap();
    let words = ["no", "one level", "two levels"][usize::try_from(level).unwrap()];
    assert!(name.starts_with(words), "{name}");
}

#[test]
fn a_label_takes_the_place_of_the_words_for_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let compare = |labels: &[&str]| {
        let own = [
            "compare",
            "candia-8-barrels",
            "--against=stack.levels=2",
            "--set=run.duration=1 s",
            "--variants=2",
            "--quiet",
            "--overwrite",
            "--out",
            folder.path().to_str().unwrap(),
        ];
        barrelstack(own.iter().chain(labels))
    };
    let plain = stdout(&compare(&[]));
    assert!(plain.contains("A, four levels: ") && plain.contains("B, two levels: "), "{plain}");
    let named = stdout(&compare(&["--label=as it is", "--label", "as planned"]));
    assert!(named.contains("A, as it is: ") && named.contains("B, as planned: "), "{named}");
    let many = compare(&["--label=a", "--label=b", "--label=c"]);
    assert_eq!(many.status.code(), Some(2));
    assert!(stderr(&many).contains("there are 3 names for 2 runs"), "{}", stderr(&many));
}
