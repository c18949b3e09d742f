//! The answer for a small room: the same numbers everywhere, whatever the number of cores.

use std::ops::ControlFlow;

use barrelstack::variants::RunChoice;
use barrelstack::variants::words::percent;
use barrelstack_cellar::report::document;
use barrelstack_cellar::{Answer, Cellar, Prepared, answer};
use barrelstack_report::{Block, Language, Table, described};
use serde_json::Value;

/// Two stacks of two levels, shaken for a short time.
const SMALL: [&str; 5] = [
    "stack.levels=2",
    "block.1.rows=1",
    "run.duration=6 s",
    "imperfections.variants=2",
    "motion.scale.factor=2.5",
];

fn small() -> Cellar {
    Cellar::builtin("demo-cellar", &SMALL.map(str::to_owned)).unwrap()
}

fn answered() -> Answer {
    answer(&small(), RunChoice::Typical, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn tables(blocks: &[Block]) -> Vec<&Table> {
    let mut all = Vec::new();
    for block in blocks {
        if let Block::Table(table) = block {
            all.push(table);
        }
    }
    all
}

#[test]
fn every_number_of_the_page_is_that_of_the_document() {
    let answer = answered();
    let json: Value = serde_json::from_str(&described::to_json(&answer.summary).unwrap()).unwrap();
    let page = document(&answer);
    assert_eq!(json["schema"], "cellar/1");
    assert_eq!(json["headline"], page.verdict.headline.as_str());
    assert_eq!(json["counted"], 2);
    // The record has three components; the sentence states the peaks of each.
    let sentences = page.verdict.sentences.join(" ");
    for key in ["motion", "other_component", "vertical_component"] {
        let component = &json[key];
        assert!(component["name"].is_string(), "{key}: {component}");
        let [pga, pgv] = ["pga", "pgv"].map(|key| component[key].as_f64().unwrap());
        let peaks = format!("up to {:.2} g and {:.0} cm/s", pga / 9.80665, 100.0 * pgv);
        assert!(sentences.contains(&peaks), "{key}: {peaks}: {sentences}");
    }
    let tables = tables(&page.blocks);
    let stacks = tables.iter().find(|table| table.columns[1].name == "falls").unwrap();
    let shown = stacks.to_csv();
    let rows: Vec<&str> = shown.lines().skip(1).collect();
    assert_eq!(rows.len(), json["stacks"].as_array().unwrap().len());
    for (row, stack) in rows.iter().zip(json["stacks"].as_array().unwrap()) {
        let share = |value: &Value| percent(value.as_f64().unwrap());
        let falls = &stack["falls"];
        let bounds = [0, 1].map(|end| share(&falls["interval"][end]));
        let begins = format!(
            "{},{} ({} to {}),{},{},",
            stack["name"].as_str().unwrap(),
            share(&falls["share"]),
            bounds[0],
            bounds[1],
            share(&stack["by_itself"]["share"]),
            share(&stack["knocked_over"]["share"]),
        );
        assert!(row.starts_with(&begins), "{row} | {begins}");
        let barrels = stack["barrels_fallen"].as_f64().unwrap();
        assert!(row.contains(&format!(",{barrels},")), "{row}");
    }
    // Counts agree with each other, and with the files.
    let all = json["stacks"].as_array().unwrap();
    let sum = |key: &str| -> f64 {
        all.iter().map(|one| one[key]["of_variants"].as_f64().unwrap()).sum()
    };
    assert_eq!(sum("falls"), sum("by_itself") + sum("knocked_over"));
    assert_eq!(sum("by_itself") / 2.0, json["room"]["by_themselves"].as_f64().unwrap());
    let files = answer.files(Language::English).unwrap();
    let text = |name: &str| {
        let file = files.iter().find(|(known, _)| known == name).unwrap();
        String::from_utf8(file.1.clone()).unwrap()
    };
    let written: Value = serde_json::from_str(&text("cellar.json")).unwrap();
    assert_eq!(written, json);
    assert!(text("report.html").contains(json["headline"].as_str().unwrap()));
    assert_eq!(text("stacks.csv").lines().count(), 1 + all.len());
    assert!(text("plan.svg").contains("<svg"));
    let again = Cellar::parse("again.toml", text("cellar.toml").as_bytes(), &[]).unwrap();
    assert_eq!(format!("{:016x}", again.fingerprint()), json["plan"]["cellar_hash"]);
}

#[test]
fn results_do_not_depend_on_threads_and_stacks_draw_their_own_imperfections() {
    let prepared = Prepared::new(&small()).unwrap();
    let go = &mut |_: &barrelstack_cellar::Advance| ControlFlow::Continue(());
    let alone = prepared.run(1, 1, go).unwrap();
    let cases = prepared.cases(&[0, 1], None, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(cases[1].as_ref().unwrap(), &prepared.case(1, &alone));
    let room = prepared.room(1).unwrap();
    let [one, two] = [0, 1].map(|at| room.stacks[at].scenario.stack().unwrap());
    assert_ne!(one.overrides, two.overrides);
    assert_eq!(one.interfaces, two.interfaces);
    assert_ne!(one.interfaces, prepared.cellar.stated().stack().unwrap().interfaces);
    // The same stack in another variant differs in both.
    let other = prepared.room(2).unwrap();
    let other = other.stacks[0].scenario.stack().unwrap();
    assert_ne!(one.overrides, other.overrides);
    assert_ne!(one.interfaces, other.interfaces);
    // Napa College, 24 August 2014: the record starts before the shaking does.
    assert!((0.5..20.0).contains(&prepared.onset), "{}", prepared.onset);
}

#[test]
fn a_stopped_answer_says_so() {
    let mut calls = 0;
    let stopped = answer(&small(), RunChoice::Typical, &mut |_| {
        calls += 1;
        ControlFlow::Break(())
    })
    .unwrap();
    assert!(stopped.is_stopped());
    assert!(calls > 0);
}
