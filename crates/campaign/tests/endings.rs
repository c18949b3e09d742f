//! Endings of cases: a study follows every case to its end, or all results state that it did not.

use crate::common;
use barrelstack_report::html;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack_campaign::decision::{Request, decide};
use barrelstack_campaign::study::{Collected, Endings, RunOptions, Study, StudyTable};

/// Returns four records that may not be bundled; if they are missing, reports that the test is skipped.
fn records() -> Option<String> {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions/peer");
    let files = [
        "RSN1503_CHICHI_TCU065-E.AT2",
        "RSN6_IMPVALL.I_I-ELC180.AT2",
        "RSN995_NORTHR_PEL360.AT2",
        "RSN1063_NORTHR_RRS228.AT2",
    ];
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(file)).collect();
    if let Some(missing) = paths.iter().find(|path| !path.is_file()) {
        common::skipped(&format!("{} is not there", missing.display()));
        return None;
    }
    let quoted: Vec<String> = paths.iter().map(|path| format!("{:?}", path.display())).collect();
    Some(quoted.join(", "))
}

/// Returns the built-in example study with four other records, and its results.
fn study(folder: &Path, run: &str) -> Option<(Study, Collected)> {
    let text = format!(
        "schema = 1\nseed = 3\n[base]\nextends = \"candia-8-barrels\"\n{run}\n\
         [[motion]]\nrecords = [{}]\n\
         [intensity]\nmeasure = \"pgv\"\nrange = {{ from = \"10 cm/s\", to = \"100 cm/s\", count = 10 }}\n\
         [design]\nkind = \"stripes\"\n",
        records()?
    );
    std::fs::create_dir_all(folder).unwrap();
    let file = folder.join("study.toml");
    std::fs::write(&file, text).unwrap();
    let study = Study::load(&file).unwrap();
    let options = RunOptions::default();
    let collected = study.run(&folder.join("out"), &options, &|_| ControlFlow::Continue(()));
    Some((study, collected.unwrap()))
}

fn endings_of(table: &StudyTable) -> Endings {
    let mut found = Endings::default();
    found.add(table);
    found
}

fn falls(collected: &Collected) -> Vec<Option<i64>> {
    collected.table.integers("barrels_fallen").unwrap().to_vec()
}

fn verdicts(collected: &Collected) -> Vec<Option<String>> {
    collected.table.texts("outcome").unwrap().to_vec()
}

#[test]
fn whole_motions_have_the_verdicts_of_two_minutes_and_a_cut_is_reported_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let Some((_, by_default)) = study(&at("default"), "") else { return };
    let whole = "[base.run]\nuntil = \"duration\"\nduration = \"120 s\"";
    let (_, long) = study(&at("long"), whole).unwrap();
    assert_eq!(verdicts(&by_default), verdicts(&long));
    assert_eq!(falls(&by_default), falls(&long));
    let endings = endings_of(&by_default.table);
    assert_eq!((endings.followed, endings.judged), (40, 40), "{endings:?}");
    let page = decide(&by_default, &Request::default()).unwrap();
    assert!(!page.warnings.iter().any(|said| said.contains("cut short")), "{:?}", page.warnings);
    assert!(page.losses.is_ok());

    let (short, cut) = study(&at("short"), "[base.run]\nduration = \"12 s\"").unwrap();
    let flipped =
        verdicts(&cut).iter().zip(verdicts(&long)).filter(|(cut, long)| *cut != long).count();
    assert!(flipped > 0, "a test of a cut that changes nothing tests nothing");
    let following = short.following().unwrap();
    assert_eq!(following.cut.len(), 4, "every record is longer than 12 s");
    let plan = following.words(4);
    assert!(plan.contains("while the ground still moves under 4 of 4 motions"), "{plan}");
    let endings = endings_of(&cut.table);
    assert!(endings.cut > 0 && endings.open > 0, "{endings:?}");
    let sentences = endings.sentences();
    assert!(
        sentences[0].contains("cut short by run.duration while the ground still moved"),
        "{sentences:?}"
    );
    let left = cut.table.numbers("motion_left").unwrap();
    assert_eq!(left.iter().flatten().filter(|left| **left > 0.0).count() as u64, endings.cut);
    let page = decide(&cut, &Request::default()).unwrap();
    assert!(page.losses.is_err(), "what falls after the cut is not known");
    assert!(page.warnings[0].contains("cut short"), "{:?}", page.warnings);
    assert!(!page.warnings.iter().any(|said| said.contains("typical of rocking")));
    let first = &page.document.verdict.sentences[0];
    assert!(first.contains("cut short while the ground still moved"), "{first}");
    assert!(html(&page.document).contains("No losses are given"));
}

#[test]
fn the_shipped_example_loses_what_it_loses_without_any_stop() {
    // A part of the motions of the built-in study, which has 240 cases: the least and the most at every level.
    let example = barrelstack_campaign::study::builtin("napa-four-levels").unwrap();
    let example = example.replace("count = 23", "count = 1");
    let until = "[base.run]\nuntil = \"duration\"\nduration = \"100 s\"\n";
    let without = example.replace("\n# The coefficient", &format!("{until}\n# The coefficient"));
    assert_ne!(example, without);
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, text: &str| {
        let study = Study::parse("example.toml", text).unwrap();
        let options = RunOptions::default();
        study.run(&folder.path().join(name), &options, &|_| ControlFlow::Continue(())).unwrap()
    };
    let (followed, long) = (run("followed", &example), run("long", &without));
    let rested = endings_of(&followed.table);
    assert!(rested.no_losses().is_none(), "{rested:?}");
    assert_eq!(verdicts(&followed), verdicts(&long));
    assert_eq!(falls(&followed), falls(&long));
}
