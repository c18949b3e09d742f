//! Pages in another language: every text is translated, and every number stays.
//!
//! With `BARRELSTACK_MISSING` set to a folder, the texts without an entry are written there, one file for each kind of
//! page.

use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;

use barrelstack::Scenario;
use barrelstack::compare;
use barrelstack::variants::{Advance, RunChoice};
use barrelstack_campaign::heights::{self, heights};
use barrelstack_campaign::protect::{self, Shaking, protect};
use barrelstack_campaign::score::{Protocol, score};
use barrelstack_campaign::study::RunOptions;
use barrelstack_cellar::Cellar;
use barrelstack_cellar::aftershocks;
use barrelstack_cellar::comparison::{self, Layout};
use barrelstack_report::{Document, Language, Paper, document_pdf, html, markdown};
use barrelstack_space::AnyAnswer;
use tempfile::tempdir;

use crate::common::barrelstack;

fn go(_: Advance) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin(name, &changes).unwrap()
}

/// Returns the report of a run, with remedies if the stack falls, and with repeated runs on request.
fn report(name: &str, changes: &[&str], verify: bool) -> Document {
    let scenario = scenario(name, changes);
    let mut answer = AnyAnswer::of(&scenario, RunChoice::Typical, &mut go).unwrap();
    let mut remedy = answer.remedy(&|_| ControlFlow::Continue(())).unwrap();
    if let Some(remedy) = &mut remedy {
        remedy.comparison = Some("barrelstack compare demo-napa".to_owned());
    }
    answer.set_remedy(remedy);
    if verify {
        answer.verify(&mut |_| ControlFlow::Continue(())).unwrap();
    }
    answer.document()
}

/// Returns the numbers of a text, in increasing order of their digits.
fn numbers(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let mut all: Vec<String> = parts
        .map(|part| part.trim_matches('.').to_owned())
        .filter(|part| !part.is_empty())
        .collect();
    all.sort();
    all
}

/// Words of input files and names given in them, which are the same in every language.
const KEPT: [&str; 26] = [
    "auto",
    "barrels-to-racks",
    "circle",
    "coulomb",
    "disc",
    "false",
    "four-barrel",
    "free",
    "full-fluid",
    "full-frozen",
    "nodes",
    "pgv",
    "rack-on-rack",
    "rails",
    "rest",
    "rolling",
    "single-bar",
    "speed-gap",
    "standard",
    "tasting table",
    "true",
    "two-barrel",
    "two-barrel-feet",
    "two-barrel-inclined",
    "velocity-verlet",
    "wrap",
];

/// `true` if a text is a line of an input file, to be copied as it is.
fn is_input(text: &str) -> bool {
    text.starts_with(['#', '[']) || text.contains(" = ") || text.contains("beside it")
}

/// Checks a kind of page: all texts are translated, with the numbers of the original.
fn complete(kind: &str, documents: &[Document]) {
    let mut missing: Vec<String> = documents
        .iter()
        .flat_map(|document| document.untranslated(Language::Spanish))
        .filter(|text| !KEPT.contains(&text.as_str()) && !is_input(text))
        .collect();
    missing.sort();
    missing.dedup();
    if let Some(folder) = std::env::var_os("BARRELSTACK_MISSING") {
        let lines: String = missing.iter().flat_map(|text| [text, "\n"]).collect();
        fs::write(PathBuf::from(folder).join(format!("{kind}.txt")), lines).unwrap();
    }
    for document in documents {
        let spanish = document.in_language(Language::Spanish);
        let (before, after) = (document.texts(), spanish.texts());
        assert_eq!(before.len(), after.len());
        assert!(before.len() > 20, "{} texts", before.len());
        for (english, spanish) in before.iter().zip(&after) {
            assert_eq!(numbers(english), numbers(spanish), "{english}\n{spanish}");
        }
        let page = html(&spanish);
        assert!(page.contains("<html lang=\"es\">") && page.contains("Saltar al contenido"));
        assert!(!markdown(&spanish, "figures").text.contains("**Figure "));
        assert!(document_pdf(&spanish, Paper::A4).len() > 1000);
        assert!(html(document) == html(&document.in_language(Language::English)));
    }
    assert!(
        missing.is_empty(),
        "{} texts of {kind} pages have no entry in es.toml:\n{}",
        missing.len(),
        missing.join("\n")
    );
}

#[test]
fn reports_of_runs_are_translated() {
    let few = "imperfections.variants=3";
    let runs = [
        ("demo-napa", vec!["stack.view=transverse", few, "stack.levels=3"], false),
        ("demo-napa", vec!["motion.scale.factor=2", few, "stack.levels=3"], false),
        ("candia-8-barrels", vec![few], true),
        ("candia-8-barrels-longitudinal", vec![few], false),
        ("rolling-disc", vec![], false),
    ];
    let documents: Vec<Document> =
        runs.iter().map(|(name, changes, verify)| report(name, changes, *verify)).collect();
    complete("run", &documents);
}

#[test]
fn reports_of_runs_in_space_are_translated() {
    let short =
        ["stack.view=spatial", "run.duration=9 s", "stack.levels=2", "imperfections.variants=3"];
    let strong = [&short[..], &["motion.scale.factor=2.5"]].concat();
    complete("space", &[report("demo-napa", &short, false), report("demo-napa", &strong, false)]);
}

#[test]
fn comparisons_are_translated() {
    let few = ["imperfections.variants=3", "stack.levels=3"];
    let answers = [("as it is", "1"), ("2.5×", "2.5")].map(|(name, factor)| {
        let factor = format!("motion.scale.factor={factor}");
        let scenario = scenario("demo-napa", &[&few[..], &[factor.as_str()]].concat());
        (name.to_owned(), AnyAnswer::of(&scenario, RunChoice::Typical, &mut go).unwrap())
    });
    let sides = compare::sides(compare::aligned(answers.into(), &mut go).unwrap());
    complete("compare", &[compare::document(&sides)]);
}

#[test]
fn pages_of_safe_heights_are_translated() {
    let folder = tempdir().unwrap();
    let request = heights::Request { synthetic: 0, highest: 3, ..heights::Request::default() };
    let found =
        heights(&request, folder.path(), &RunOptions::default(), &|_, _| ControlFlow::Continue(()));
    complete("heights", &[found.unwrap().document]);
}

#[test]
fn rankings_of_protections_are_translated() {
    let folder = tempdir().unwrap();
    let request = protect::Request {
        scenario: scenario("candia-8-barrels", &["stack.levels=2", "motion.scale.factor=1"]),
        shaking: Shaking::Levels(vec![0.6]),
        records: Vec::new(),
        folder: None,
        motions: 4,
        rounds: 2,
        budget: Some(130.0),
        seed: 3,
    };
    let found =
        protect(&request, folder.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()));
    complete("protect", &[found.unwrap().document]);
}

#[test]
fn scores_are_translated() {
    let protocol = Protocol {
        levels: 2,
        velocities: vec![0.9, 2.4],
        periods: vec![1.2],
        synthetic: 0,
        ..Protocol::rockscore()
    };
    let chocked = scenario("demo-napa", &["stack.chock.levels=1"]);
    let folder = tempdir().unwrap();
    let go = |_, _| ControlFlow::Continue(());
    let sheet = score(&chocked, &protocol, folder.path(), &RunOptions::default(), &go).unwrap();
    complete("score", &[sheet.document]);
}

/// Returns a small cellar.
fn cellar(changes: &[&str]) -> Cellar {
    let small = [
        "stack.levels=2",
        "block.1.rows=1",
        "run.duration=6 s",
        "imperfections.variants=2",
        "motion.scale.factor=2.5",
    ];
    let all = small.iter().chain(changes).map(|change| (*change).to_owned());
    Cellar::builtin("demo-cellar", &all.collect::<Vec<_>>()).unwrap()
}

#[test]
fn pages_of_cellars_are_translated() {
    let names = ["spacing 0.3 m", "spacing 1 m"];
    let answers = [&[][..], &["block.1.spacing=1 m"]].map(|changes| {
        barrelstack_cellar::answer(&cellar(changes), RunChoice::Typical, &mut |_| {
            ControlFlow::Continue(())
        })
        .unwrap()
    });
    complete("cellar", &answers.each_ref().map(barrelstack_cellar::report::document));
    let layouts: Vec<Layout> = names
        .into_iter()
        .zip(&answers)
        .map(|(name, answer)| Layout::of(name.to_owned(), answer))
        .collect();
    let found = comparison::compared(&layouts, Vec::new(), Vec::new());
    complete("cellar-comparison", &[comparison::document(&layouts, &found)]);
}

#[test]
fn pages_of_aftershocks_are_translated() {
    let found = aftershocks::aftershocks(&cellar(&[]), &[0.5, 1.0], None, &mut |_| {
        ControlFlow::Continue(())
    });
    complete("aftershock", &[aftershocks::document(&found.unwrap())]);
}

#[test]
fn the_reproduction_is_translated() {
    let found = barrelstack_reproduction::reproduce(None, false, &|_, _| ControlFlow::Continue(()));
    complete("reproduce", &[found.unwrap().document]);
}

#[test]
fn calibrations_are_translated() {
    use barrelstack_calibration::{Table, drop, friction, stiffness};
    let heights = "drop height (cm),rebound height (cm)\n10,4\n12,4.9\n14,5.5\n16,6.6\n18,7.1\n";
    let tilt = "angle (deg)\n24.1\n25.3\n23.6\n";
    let press = "penetration (mm),force (kN)\n0.4,0.01\n0.9,1.0\n1.4,1.97\n1.9,2.9\n2.4,3.9\n";
    let table = |name: &str, text: &str| Table::parse(name, text).unwrap();
    let found = [
        drop::drop(&table("bounce.csv", heights), None, "barrel-rack").unwrap(),
        friction::friction(&table("tilt.csv", tilt), "rack-ground").unwrap(),
        stiffness::stiffness(&table("press.csv", press), 2, "barrel-rack").unwrap(),
    ];
    complete("calibrate", &found.map(|found| found.document()));
}

#[test]
fn the_option_selects_the_language_of_files_and_not_of_the_terminal() {
    let folder = tempdir().unwrap();
    let run = |out: &str, language: &[&str]| {
        let path = folder.path().join(out);
        let place = path.to_str().unwrap().to_owned();
        let common = ["run", "candia-8-barrels", "--variants=0", "--quiet", "--no-remedy", "--out"];
        let args = [&common[..], &[place.as_str()], language].concat();
        let said = barrelstack(&args);
        assert!(said.status.success());
        let said = String::from_utf8(said.stdout).unwrap().replace(&place, "");
        let said: Vec<String> =
            said.lines().filter(|line| !line.contains(" elapsed")).map(str::to_owned).collect();
        (said, fs::read_to_string(path.join("report.html")).unwrap())
    };
    let (english, page) = run("en", &[]);
    let (spanish, translated) = run("es", &["--language", "es"]);
    assert_eq!(english, spanish);
    assert!(page.contains("<html lang=\"en\">") && !page.contains("id=\"language\""));
    assert!(translated.contains("<html lang=\"es\">") && translated.contains("id=\"language\""));
    assert!(!translated.contains(">Warnings<") && !translated.contains(">Provenance<"));
    let refused = barrelstack(["run", "--language", "fr"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("possible values: en, es"), "{said}");
}
