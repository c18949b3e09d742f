//! Sentences of the report page of a run that state what a number or a picture refers to.

use std::ops::ControlFlow;

use barrelstack::report::{answer_document, balanced, document};
use barrelstack::summary::EnergyBalance;
use barrelstack::variants::{RunChoice, answer};
use barrelstack::{Scenario, Summary};
use barrelstack_report::described::document as schema_of;
use barrelstack_report::{Document, Language, html, markdown};

/// Returns the built-in scenario with changes.
fn demo(changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
    Scenario::builtin("demo-napa", &changes).unwrap()
}

/// Returns the page of a single run of 0.1 s.
fn page_of_one(changes: &[&str]) -> Document {
    let run = demo(&[&["run.duration=0.1 s"], changes].concat()).run().unwrap();
    document(&run, &Summary::of(&run, None))
}

fn text(document: &Document) -> String {
    // Numbers and their units do not break on the page.
    markdown(document, "figures").text.replace('\u{a0}', " ")
}

#[test]
fn a_page_of_both_planes_states_the_run_that_it_shows_and_both_planes() {
    let scenario = demo(&["stack.levels=2", "run.duration=1 s", "imperfections.variants=2"]);
    let answer =
        answer(&scenario, RunChoice::Number(2), &mut |_| ControlFlow::Continue(())).unwrap();
    let page = answer_document(&answer);
    let shown = &page.verdict.shown;
    let run = "The run that is shown is that of variant 2";
    let fates = ": across the barrels, the stack stands until the runs end at 1.0 s; along the barrels, the stack stands \
                 until the runs end at 1.0 s.";
    assert!(shown.starts_with(run) && shown.ends_with(fates), "{shown}");
    // The sentence is above the pictures, in both formats and both languages.
    let place = |text: &str, what: &str| text.find(what).unwrap_or_else(|| panic!("no {what}"));
    let written = html(&page);
    assert!(place(&written, run) < place(&written, "<figure"));
    assert!(place(&text(&page), run) < place(&text(&page), "!["));
    let spanish = page.in_language(Language::Spanish).verdict.shown;
    assert!(spanish.contains("variante 2") && !spanish.contains("stands"), "{spanish}");
    assert_eq!(page.untranslated(Language::Spanish), Vec::<String>::new());

    let value = |name: &str| page.provenance.iter().find(|(own, _)| own == name);
    assert_eq!(value("view").unwrap().1, "across the barrels and along the barrels");
    for name in ["integration", "energy balance"] {
        assert!(value(name).is_none(), "{name}");
        for plane in ["across the barrels", "along the barrels"] {
            assert!(value(&format!("{name} {plane}")).is_some(), "{name} {plane}");
        }
    }
    for sentence in [
        "Largest forces at every interface, in the run that is shown",
        "Force on the upper body of each pair in the run that is shown",
        "Demands on the stack in the run that is shown",
        "The times of the first loss of a seat are those of all variants that collapse while they are shaken.",
        "The times of the first fall are only those of variants in which a barrel falls",
        "stress amplification of a bottom barrel, ratio of largest stresses",
        "stress amplification of a bottom barrel, ratio of average stresses",
        "Either ratio may be the larger one.",
    ] {
        assert!(text(&page).contains(sentence), "{sentence}");
    }
}

#[test]
fn a_plane_along_the_barrels_is_stated_to_be_a_slice_one_barrel_wide() {
    let slice = |barrels: u32| {
        format!(
            "This plane is a slice one barrel wide: where a rack carries {barrels} barrels side by side, the forces are \
             those of one of them, with its share of the racks."
        )
    };
    let along = text(&page_of_one(&["stack.view=longitudinal", "stack.columns=1"]));
    assert!(along.contains(&slice(2)), "{along}");
    let any = "slice one barrel wide";
    assert!(!text(&page_of_one(&["stack.view=transverse"])).contains(any));
    // The slice is the whole rack if the rack carries one barrel.
    let narrow = ["stack.view=longitudinal", "stack.columns=1", "stack.rack.barrels=1"];
    assert!(!text(&page_of_one(&narrow)).contains(any));
}

#[test]
fn the_page_and_the_json_describe_the_energy_exchanged_alike() {
    let run = demo(&["run.duration=0.1 s", "stack.view=transverse"]).run().unwrap();
    let balance = EnergyBalance::of(&run.energy.unwrap());
    let sentence = balanced(&balance);
    let (_, exchanged) = sentence.split_once("exchanged. ").unwrap();
    let schema = schema_of::<EnergyBalance>("energy").to_string();
    assert!(schema.contains(exchanged), "{exchanged}\n{schema}");
}
