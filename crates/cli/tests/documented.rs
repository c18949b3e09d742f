//! Every command line of the documents works as it is written, from a fresh folder for each document.
//!
//! Lines that take minutes are shortened by options that the documents describe (`--variants 0`, `--no-remedy`), or begun
//! and stopped at their first step, which reads the command line and all inputs, prepares the folder and starts the work.
//! Lines of other programs (cargo, pip, python3, sh) are not run; what they name in this repository must be there.

#![cfg(unix)]
#![allow(clippy::print_stdout, reason = "the line that failed is the last one")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use common::{HEAD, STUDY, program, skipped, stderr};

/// How much of a line is run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    /// All of it.
    Whole,
    /// All of it with these options behind.
    With(&'static [&'static str]),
    /// Up to the first step of its work.
    Begun,
}

/// One run of the case as it is stated.
const ALONE: Part = Part::With(&["--variants=0", "--no-remedy"]);

/// How much of a line is run, by its first words and its options.
fn part(words: &[String]) -> Part {
    let has = |option: &str| words.iter().any(|word| word.starts_with(option));
    let in_space = words.iter().any(|word| word == "stack.view=spatial");
    match words[0].as_str() {
        "run" | "compare" if has("--variant") || has("--verify") || in_space => Part::Begun,
        "run" if words[1] == "ball.toml" => Part::Whole,
        "run" | "demo" => ALONE,
        "compare" => Part::With(&["--variants=0"]),
        "render" if words[1] == "ball.toml" => Part::Whole,
        "render" => Part::With(&["--variants=0", "--dpi=30", "--rate=1"]),
        "heights" | "protect" | "score" | "reproduce" => Part::Begun,
        "study" if words[1] == "mine.toml" => Part::Whole,
        "study" if words[1].starts_with("napa") || words[1].starts_with("demo-") => Part::Begun,
        "calibrate" if words[1] == "collapse" => Part::Begun,
        _ => Part::Whole,
    }
}

/// The command lines of a document in their order: those of fenced blocks that begin with a program of [`PROGRAMS`].
fn lines(text: &str) -> Vec<String> {
    const PROGRAMS: [&str; 6] = ["barrelstack ", "cargo ", "python3 ", "pip ", "sh ", "wait"];
    let (mut fenced, mut found, mut open) = (false, Vec::<String>::new(), false);
    for line in text.lines() {
        if line.starts_with("```") {
            (fenced, open) = (!fenced, false);
        } else if fenced && (open || PROGRAMS.iter().any(|program| line.starts_with(program))) {
            let (part, goes_on) =
                line.strip_suffix('\\').map_or((line, false), |part| (part, true));
            if open {
                found.last_mut().unwrap().push_str(part);
            } else {
                found.push(part.to_owned());
            }
            open = goes_on;
        }
    }
    found
}

/// The words of a line as a shell takes them apart, without its comment.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None::<char>);
    for c in line.chars() {
        match (quote, c) {
            (Some(mark), c) if c == mark => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                word.get_or_insert_default();
                quote = Some(c);
            }
            (None, ' ') => words.extend(word.take()),
            (None, '#') if word.is_none() => break,
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    assert_eq!(quote, None, "an open quote: {line}");
    words.extend(word);
    words
}

const HAZARD: &str = "pgv (cm/s),rate (1/year)\n5,0.1\n50,0.005\n200,0.0001\n";
const TILT: &str = "angle (deg)\n25\n26\n24\n25.5\n";
const VIDEO: &str =
    "mode,B4.2 fell (s),B4.1 fell (s),B1.1 fell (s),until (s)\nejection,1.5,2.5,stands,4\n";

/// What `docs/recipes.md` runs as `ball.toml`: its first block of TOML.
fn ball(text: &str) -> Option<&str> {
    text.split("```toml\n").nth(1)?.split("```").next()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Puts the files of a user into a folder: records, tests, scenarios and tables that the documents do not make.
fn furnish(folder: &Path) {
    let run = |arguments: &[&str]| {
        let made = program(arguments).current_dir(folder).output().unwrap();
        assert_eq!(made.status.code(), Some(0), "{arguments:?}: {}", stderr(&made));
        made.stdout
    };
    fs::create_dir(folder.join("records")).unwrap();
    for name in ["my-site.AT2", "RSN995_NORTHR_PEL360.AT2", "records/a.AT2", "records/b.AT2"] {
        run(&["motion", "convert", "napa-college-2014", "--component=h1", "-o", name]);
    }
    fs::copy(folder.join("my-site.AT2"), folder.join("my-site.V2")).unwrap();
    let scenario = run(&["scenarios", "show", "demo-napa"]);
    for name in ["mine.toml", "strapped.toml", "old.toml", "new.toml"] {
        let title = format!("title = \"{name}\"\n");
        let text = String::from_utf8(scenario.clone()).unwrap();
        let text: Vec<&str> = text.lines().filter(|line| !line.starts_with("title")).collect();
        let (before, rest) =
            text.split_at(text.iter().position(|line| *line == "schema = 1").unwrap());
        let text = [before.join("\n"), title, rest.join("\n")].join("\n");
        fs::write(folder.join(name), text).unwrap();
    }
    fs::write(folder.join("hazard.csv"), HAZARD).unwrap();
    fs::write(folder.join("tilt.csv"), TILT).unwrap();
    fs::write(folder.join("video.csv"), VIDEO).unwrap();
    fs::write(
        folder.join("barrelstack.html"),
        "<script type=\"text/plain\" id=\"engine\"></script>",
    )
    .unwrap();
}

/// What a line did.
enum Did {
    Ran,
    Begun,
    /// The program of others that it is for.
    Left(String),
}

/// Runs a line in a folder, as much of it as [`part`] says.
fn run(folder: &Path, line: &str) -> Did {
    let mut words = words(line);
    // The documents say that the two are the same.
    if words.starts_with(&["cargo", "run", "--release", "--"].map(str::to_owned)) {
        words.splice(..4, ["barrelstack".to_owned()]);
    }
    if words[0] != "barrelstack" {
        there(&words);
        return Did::Left(words[0].clone());
    }
    words.remove(0);
    if words.last().is_some_and(|word| word == "&") {
        words.pop();
    }
    let into = words.iter().position(|word| word == ">");
    let into = into.map(|at| words.drain(at..).nth(1).unwrap());
    let part = part(&words);
    let mut command = program(&words);
    match part {
        Part::Whole => {}
        Part::With(options) => _ = command.args(options),
        Part::Begun => _ = command.arg("--stop-at=1:s:0"),
    }
    let said = command.current_dir(folder).output().unwrap();
    let status = said.status.code();
    let expected = if part == Part::Begun { 130 } else { 0 };
    assert_eq!(status, Some(expected), "{line} ({part:?})\n{}", stderr(&said));
    if let Some(file) = into {
        fs::write(folder.join(&file), said.stdout).unwrap();
    }
    // Studies of minutes are followed here by a small one in their place, so that the lines after them have results.
    if words.starts_with(&["study".to_owned(), "example".to_owned()]) {
        fs::write(folder.join("mine.toml"), format!("{HEAD}{STUDY}")).unwrap();
    }
    if words.starts_with(&["study".to_owned(), "napa-four-levels".to_owned()]) {
        let out = words.iter().skip_while(|word| *word != "--out").nth(1).unwrap();
        fs::remove_dir_all(folder.join(out)).unwrap();
        fs::write(folder.join("levels.toml"), format!("{HEAD}{LEVELS}")).unwrap();
        let mut small = program(["study", "levels.toml", "--out", out]);
        let small = small.current_dir(folder).output().unwrap();
        assert_eq!(small.status.code(), Some(0), "{}", stderr(&small));
    }
    if part == Part::Begun { Did::Begun } else { Did::Ran }
}

/// A study with levels, behind [`HEAD`].
const LEVELS: &str = "\
duration = \"0.4 s\"
[[motion]]
name = \"pulse\"
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.3 s\" }
[intensity]
levels = [\"20 cm/s\", \"400 cm/s\"]
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
range = { from = 0.2, to = 0.6, count = 10 }
[design]
kind = \"stripes\"
";

/// What a line of another program names in this repository has to be there.
fn there(words: &[String]) {
    let root = root();
    let after = |option: &str| words.iter().skip_while(|word| *word != option).nth(1);
    if let (Some(package), Some(example)) = (after("-p"), after("--example")) {
        let folder = package.trim_start_matches("barrelstack-");
        let file = root.join(format!("crates/{folder}/examples/{example}.rs"));
        assert!(file.is_file(), "{words:?} names {}", file.display());
    }
    if words[..2] == ["cargo".to_owned(), "xtask".to_owned()] {
        let xtask = fs::read_to_string(root.join("xtask/src/main.rs")).unwrap();
        assert!(xtask.contains(&format!("[\"{}\"", words[2])), "{words:?} is no task");
    }
    if words[0] == "python3" && words[1].contains('/') {
        assert!(root.join(&words[1]).is_file(), "{words:?}");
    }
}

#[test]
fn every_command_line_of_the_documents_works_in_a_fresh_folder() {
    let root = root();
    let mut documents: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "crates/cli/CLUSTER.md"].map(Into::into).into();
    for folder in ["docs", "validation"] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "md") {
                documents.push(path);
            }
        }
    }
    documents.sort();
    let (mut ran, mut begun, mut left) = (0, 0, BTreeMap::<String, u32>::new());
    for document in documents {
        let text = fs::read_to_string(root.join(&document)).unwrap();
        let lines = lines(&text);
        if lines.is_empty() {
            continue;
        }
        let folder = tempfile::tempdir().unwrap();
        furnish(folder.path());
        if let Some(ball) = ball(&text) {
            fs::write(folder.path().join("ball.toml"), ball).unwrap();
        }
        for line in lines {
            println!("{}: {line}", document.display());
            match run(folder.path(), &line) {
                Did::Ran => ran += 1,
                Did::Begun => begun += 1,
                Did::Left(program) => *left.entry(program).or_default() += 1,
            }
        }
    }
    skipped(&format!(
        "{ran} documented lines ran, {begun} were begun and stopped; lines of other programs: {left:?}"
    ));
    assert!(ran > 20 && begun > 10, "{ran} ran, {begun} were begun");
}
