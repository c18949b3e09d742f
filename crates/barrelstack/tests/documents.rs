//! Documents name only existing paths, and libraries no options of the command.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns words in back quotes or link targets that look like paths of this repository.
fn paths_named_in(text: &str) -> Vec<String> {
    let quoted = text.split('`').skip(1).step_by(2);
    let linked = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    quoted
        .chain(linked)
        .filter(|word| {
            let known = ["crates/", "xtask", "validation/", "scenarios/"];
            let extension = Path::new(word).extension();
            let document = extension.is_some_and(|e| e == "md") && !word.contains(' ');
            known.iter().any(|start| word.starts_with(start)) || document
        })
        .filter(|word| !word.contains([' ', '<', '*']))
        .map(|word| word.split('#').next().unwrap_or(word).to_owned())
        .collect()
}

#[test]
fn every_path_that_a_document_names_exists() {
    let mut checked = 0;
    for name in [
        "README.md",
        "ARCHITECTURE.md",
        "DESIGN.md",
        "CONTRIBUTING.md",
        "GLOSSARY.md",
        "CHANGELOG.md",
    ] {
        let text = std::fs::read_to_string(root().join(name)).unwrap();
        for path in paths_named_in(&text) {
            assert!(root().join(&path).exists(), "{name} names {path}, which is not there");
            checked += 1;
        }
    }
    assert!(checked > 40, "only {checked} paths found: has the way of naming them changed?");
}

#[test]
fn the_words_that_pages_explain_are_those_of_the_glossary() {
    let text = std::fs::read_to_string(root().join("GLOSSARY.md")).unwrap();
    let section = text.split("## Words of the pages").nth(1).unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| ")).skip(1);
    let explained = barrelstack::report::WORDS;
    let own = explained.iter().map(|one| format!("| {} | {} |", one.word, one.meaning));
    assert_eq!(rows.collect::<Vec<_>>(), own.collect::<Vec<_>>());
}

/// Collects every Rust file of a folder and of those in it, with its text.
fn texts_of(folder: &Path, texts: &mut Vec<(PathBuf, String)>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            texts_of(&path, texts);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            texts.push((path, text));
        }
    }
}

/// Collects lines of code of a crate, with their files, without comments.
fn code_of(folder: &Path, lines: &mut Vec<(PathBuf, String)>) {
    let mut texts = Vec::new();
    texts_of(folder, &mut texts);
    for (path, text) in texts {
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        lines.extend(code.map(|line| (path.clone(), line.to_owned())));
    }
}

#[test]
fn libraries_name_no_option_and_no_subcommand_of_the_command() {
    let mut lines = Vec::new();
    for entry in std::fs::read_dir(root().join("crates")).unwrap() {
        let path = entry.unwrap().path();
        // The command has these words; the validation is a command too.
        if !path.ends_with("cli") && !path.ends_with("validation") {
            code_of(&path.join("src"), &mut lines);
        }
    }
    assert!(lines.len() > 20_000, "only {} lines found", lines.len());
    let option = |line: &str| {
        [" --", "(--", "`--"].iter().any(|start| {
            let mut rest = line.split(start).skip(1);
            rest.any(|word| word.starts_with(|c: char| c.is_ascii_lowercase()))
        })
    };
    for (path, line) in lines {
        let named = option(&line) || line.contains("`barrelstack ");
        assert!(!named, "{}: {}", path.display(), line.trim());
    }
}
