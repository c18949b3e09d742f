//! Literate cases: `tests/cases/*.md` hold prose, a scenario, and the expected result of the reader.
//!
//! Each `##` section of a file is a case. Its `toml` block is the scenario, its `override` block
//! has one override a line, and it ends with either an `error` block, the whole error, or a
//! `resolved` block, lines that the resolved text must contain.

use std::fs;
use std::path::PathBuf;

use barrelstack::scenario::Scenario;

struct Case {
    file: PathBuf,
    name: String,
    toml: String,
    overrides: Vec<String>,
    expected: Expected,
}

enum Expected {
    Error(String),
    Resolved(Vec<String>),
    Nothing,
}

fn cases() -> Vec<Case> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    files.sort();
    let mut cases = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        for section in text.split("\n## ").skip(1) {
            let name = section.lines().next().unwrap().to_owned();
            let block = |kind: &str| fenced(section, kind);
            let lines = |text: String| text.lines().map(str::to_owned).collect();
            let expected = match (block("error"), block("resolved")) {
                (Some(error), None) => Expected::Error(error),
                (None, Some(resolved)) => Expected::Resolved(lines(resolved)),
                (None, None) => Expected::Nothing,
                (Some(_), Some(_)) => panic!("{name}: an error and a resolved text"),
            };
            let toml = block("toml").unwrap_or_else(|| panic!("{name}: no toml block"));
            let overrides = block("override").map(lines).unwrap_or_default();
            cases.push(Case { file: file.clone(), name, toml, overrides, expected });
        }
    }
    cases
}

fn fenced(section: &str, kind: &str) -> Option<String> {
    let start = section.find(&format!("\n```{kind}\n"))? + kind.len() + 5;
    let end = section[start..].find("\n```").map_or(start, |at| start + at);
    // An empty block has its end right after its start.
    if section[start - 1..].starts_with("\n```") {
        return Some(String::new());
    }
    Some(section[start..end].to_owned())
}

fn outcome(case: &Case) -> Result<Scenario, String> {
    Scenario::parse("case.toml", &case.toml, &case.overrides).map_err(|error| error.to_string())
}

#[test]
fn every_case_ends_as_its_text_says() {
    let cases = cases();
    let mut failures = Vec::new();
    for case in &cases {
        let wrong = match (&case.expected, outcome(case)) {
            (Expected::Error(expected), Err(error)) if *expected == error => continue,
            (Expected::Error(_), Err(error)) => format!("another error:\n{error}"),
            (Expected::Error(_), Ok(_)) => "accepted".to_owned(),
            (Expected::Resolved(_), Err(error)) => format!("refused:\n{error}"),
            (Expected::Resolved(lines), Ok(scenario)) => {
                let text = scenario.to_resolved_toml();
                match lines.iter().find(|line| !text.lines().any(|known| known == line.as_str())) {
                    Some(line) => format!("`{line}` is not in\n{text}"),
                    None => continue,
                }
            }
            (Expected::Nothing, _) => "the case expects nothing".to_owned(),
        };
        failures.push(format!("{}, {}: {wrong}", case.file.display(), case.name));
    }
    assert!(
        failures.is_empty(),
        "{} of {}:\n\n{}",
        failures.len(),
        cases.len(),
        failures.join("\n\n")
    );
    assert!(cases.len() >= 60, "only {} cases were found", cases.len());
}

#[test]
fn every_error_is_one_sentence_with_a_place() {
    for case in cases() {
        let Err(error) = Scenario::parse("case.toml", &case.toml, &case.overrides) else {
            continue;
        };
        let sentence = error.sentence();
        let name = &case.name;
        assert!(!sentence.contains('\n'), "{name}: {sentence}");
        assert!(!sentence.ends_with('.'), "{name}: {sentence}");
        let placed = sentence.starts_with("case.toml")
            || sentence.starts_with("override `")
            || sentence.contains(".toml:");
        assert!(placed, "{name}: {sentence}");
        assert!(sentence.chars().count() < 400, "{name}: {sentence}");
    }
}

/// Writes the present errors into cases without an expectation; review them before committing.
#[test]
#[ignore = "changes files of the repository; run by hand after adding a case or changing a message"]
fn fill_in_errors() {
    for case in cases() {
        let Err(error) = outcome(&case) else { continue };
        let text = fs::read_to_string(&case.file).unwrap();
        let heading = format!("\n## {}\n", case.name);
        let start = text.find(&heading).unwrap();
        let end = text[start + 1..].find("\n## ").map_or(text.len(), |at| start + 1 + at);
        let section = &text[start..end];
        let block = format!("\n```error\n{error}\n```\n");
        let filled = match (&case.expected, section.find("\n```error\n")) {
            (Expected::Resolved(_), _) => continue,
            (_, Some(at)) => format!("{}{block}", &section[..at]),
            (_, None) => format!("{}\n{block}", section.trim_end()),
        };
        fs::write(&case.file, format!("{}{filled}{}", &text[..start], &text[end..])).unwrap();
    }
}
