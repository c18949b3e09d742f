//! The page of the hindcasts holds the numbers of its observations and of its cases.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

use std::fs;
use std::path::{Path, PathBuf};

use barrelstack_validation::field::{FieldCases, Kind, Likelihood, Statements, evaluate};

fn field() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/field")
}

fn observations() -> String {
    fs::read_to_string(field().join("observations.toml")).unwrap()
}

fn cases() -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = fs::read_dir(field().join("cases"))
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            (name, fs::read_to_string(path).unwrap())
        })
        .collect();
    all.sort();
    all
}

#[test]
fn the_page_its_tables_and_its_figure_come_from_the_observations_and_the_cases() {
    for (name, text) in evaluate(&observations(), &cases()).unwrap() {
        let kept = fs::read_to_string(field().join("..").join(&name)).unwrap();
        assert!(kept == text, "validation/{name} is out of date: `cargo xtask field --page`");
    }
}

#[test]
fn at_least_three_earthquakes_are_hindcast_and_every_statement_has_its_source() {
    let read = Statements::read("observations.toml", &observations()).unwrap();
    assert!(read.earthquake.iter().filter(|one| !one.studies.is_empty()).count() >= 3);
    for statement in read.statements() {
        assert!(!statement.source.is_empty() && !statement.statement.is_empty());
        assert_eq!(
            statement.kind == Kind::Unusable,
            statement.reason.is_some(),
            "{}",
            statement.id
        );
    }
    let (_, half) = read.find("half").unwrap();
    // 35 to 65 % are 95 %: 0.15 / 1.96.
    let Some(Likelihood::Near { value, error }) = half.likelihood() else { panic!("{half:?}") };
    assert!(value == 0.5 && (error - 0.07653).abs() < 1e-5, "{error}");
}

#[test]
fn every_study_has_its_cases_and_nearly_all_have_a_verdict() {
    let mut studies: Vec<String> = fs::read_dir(field().join("studies"))
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    studies.sort();
    let cases = cases();
    assert_eq!(studies, cases.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>());
    for (name, text) in &cases {
        let read = FieldCases::read(name, text).unwrap();
        assert!(read.unjudged * 50 <= read.cases.len(), "{name}: {} without", read.unjudged);
        assert!(read.cases.iter().all(|case| (2..=6).contains(&case.levels)));
    }
}

#[test]
fn a_statement_without_a_source_or_a_number_is_refused() {
    let text = observations();
    let silent = text.replacen("source = \"the same two articles\"", "source = \"\"", 1);
    let error = Statements::read("observations.toml", &silent).unwrap_err().to_string();
    assert!(error.contains("`room`: a statement needs a source"), "{error}");
    let vague = text.replacen("error = 0.05\n", "", 1);
    let error = Statements::read("observations.toml", &vague).unwrap_err().to_string();
    assert!(error.contains("`room`: a statement with a likelihood needs `levels`"), "{error}");
}
