//! The documents name only what is there.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Words in back quotes or link targets that look like paths of this repository.
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
    for name in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "GLOSSARY.md", "CHANGELOG.md"] {
        let text = std::fs::read_to_string(root().join(name)).unwrap();
        for path in paths_named_in(&text) {
            assert!(root().join(&path).exists(), "{name} names {path}, which is not there");
            checked += 1;
        }
    }
    assert!(checked > 40, "only {checked} paths found: has the way of naming them changed?");
}
