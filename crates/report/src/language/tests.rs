use std::collections::{BTreeMap, HashSet};

use super::{Language, Translator, catalog, flipped, is_phrase, is_prose, markup, sentences};
use crate::document::{FINE, SCOPE, SIGNATURE};
use crate::{Tone, glossary, trial};

const SPANISH: &str = include_str!("../../assets/languages/es.toml");

fn translator(entries: &'static str) -> Translator {
    Translator::new(Box::leak(Box::new(catalog::Catalog::of(entries))))
}

const SMALL: &str = r#"
# a comment
"{1} of {2} variants fall." = "Caen {1} de {2} variantes."
"along the barrels" = "a lo largo de las barricas"
"Shaken {1}, {2} stands." = "Sacudida {1}, {2} permanece en pie."
"the stack" = "la pila"
"{1} barrels" = "{1} barricas"
"rack" = "rack"
"ice" = "hielo"
"It says \"no\"." = "Dice \"no\"."
"#;

#[test]
fn placeholders_may_change_their_order_and_hold_phrases_of_their_own() {
    let es = translator(SMALL);
    assert_eq!(es.text("3 of 64 variants fall."), "Caen 3 de 64 variantes.");
    assert_eq!(
        es.text("Shaken along the barrels, the stack stands. 3 of 64 variants fall."),
        "Sacudida a lo largo de las barricas, la pila permanece en pie. Caen 3 de 64 variantes."
    );
    assert_eq!(es.text("It says \"no\"."), "Dice \"no\".");
}

#[test]
fn letter_case_punctuation_and_lists_need_no_entries() {
    let es = translator(SMALL);
    assert_eq!(es.text("Along the barrels"), "A lo largo de las barricas");
    assert_eq!(es.text("(along the barrels)"), "(a lo largo de las barricas)");
    assert_eq!(es.text("the stack, 12 barrels and ice"), "la pila, 12 barricas e hielo");
}

#[test]
fn a_text_without_an_entry_stays_and_is_reported() {
    let es = translator(SMALL);
    let found = es.translated("Shaken along the barrels, the cat stands. Nothing else.");
    assert_eq!(
        found.text,
        "Sacudida a lo largo de las barricas, the cat permanece en pie. Nothing else."
    );
    assert_eq!(found.missing, ["the cat", "Nothing else."]);
    let quoted = es.translated("Shaken \"with the cat\", \"the stack\" stands.");
    assert_eq!(quoted.text, "Sacudida \"with the cat\", \"la pila\" permanece en pie.");
    assert!(quoted.missing.is_empty());
    let names = format!("R3, South Napa 2014, 0.35 g, motion.scale=2, {}out", "--");
    assert!(es.translated(&names).missing.is_empty());
}

#[test]
fn sentences_end_before_capitals_and_numbers() {
    assert_eq!(sentences("One. Two! 3 is more? Yes"), ["One.", "Two!", "3 is more?", "Yes"]);
    assert_eq!(sentences("see e.g. the rack"), ["see e.g. the rack"]);
    assert_eq!(sentences("by A.P. John. It moves E. Now"), ["by A.P. John.", "It moves E.", "Now"]);
    assert_eq!(flipped("Stack"), Some("stack".to_owned()));
    assert_eq!(flipped("PGA"), None);
    assert!(is_prose("it falls") && !is_prose("PGV 12 cm/s") && !is_prose("stack.levels"));
}

#[test]
fn markup_is_translated_between_tags_and_in_labels() {
    let markup = r#"<button aria-label="Play"><svg viewBox="0 0 1 1"/></button> <h2>Warnings</h2>"#;
    let spanish = Language::Spanish.markup(markup);
    assert!(!spanish.contains("Play") && spanish.contains("<h2>Advertencias</h2>"), "{spanish}");
    assert!(spanish.contains("</button> <h2>") && spanish.contains("viewBox"), "{spanish}");
    assert_eq!(Language::English.markup(markup), markup);
    let kept = r#"<a translate="no" title="Play">Warnings</a>"#;
    assert_eq!(Language::Spanish.markup(kept), kept);
}

/// Returns the placeholders and the numbers in a template.
fn values(text: &str) -> Vec<String> {
    let mut found: Vec<String> = text
        .split(|c: char| !(c.is_ascii_digit() || "{}.".contains(c)))
        .map(|part| part.trim_matches('.').to_owned())
        .filter(|part| part.contains(|c: char| c.is_ascii_digit()))
        .collect();
    found.sort();
    found.dedup();
    found
}

#[test]
fn every_line_of_the_catalog_is_an_entry_with_equal_placeholders_and_numbers() {
    let mut known = BTreeMap::new();
    let mut wrong = Vec::new();
    for (at, line) in SPANISH.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let Some((source, target)) = catalog::entry(line) else {
            wrong.push(format!("line {}: not an entry: {line}", at + 1));
            continue;
        };
        if let Some(before) = known.insert(source, at + 1) {
            wrong.push(format!("line {}: as line {before}: {line}", at + 1));
        }
        if values(source) != values(target) {
            wrong.push(format!("line {}: different values: {line}", at + 1));
        }
        if source.contains("}{") || target.is_empty() {
            wrong.push(format!("line {}: cannot be read: {line}", at + 1));
        }
    }
    assert!(known.len() > 500, "{} entries", known.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns strings that pages contain in addition to those of a document.
fn frame() -> Vec<String> {
    let fixed = [
        "Skip to the content",
        "Verdict in words",
        "Warnings",
        "Sections",
        "Provenance",
        "Appendix",
        "Table",
        "Figure",
        "Events",
        "To compare the stack with and without the change:",
        "1 warning",
        "2 warnings",
        "7 more events",
        "see the appendix.",
        "of",
        "data",
        "what",
        "value",
        "time",
        "event",
        "made on",
        "commit",
        "program",
        "start",
        "end",
        "largest until the first loss of seat",
        "at rest",
        "amplification 2.1",
        "normal stress: 20 kPa",
        "no stress",
        "up to 20, 40, 60, 80, 100 %",
        "aisle",
        "door",
        "wall or column",
        "stack",
        "falls by itself",
        "is knocked over",
        "had fallen before",
        "wrongly placed",
        "falls",
        "fall",
        "has no verdict",
        "have no verdict",
        "stands",
        "stand",
        "filled",
        "gray",
        "rings",
        "variants",
        "uplift",
        "slip",
        "gives way",
        "note",
        FINE,
        SCOPE,
        glossary::TITLE,
    ];
    let tones = [Tone::Stands, Tone::Falls, Tone::Invalid, Tone::Neutral].map(Tone::word);
    fixed.into_iter().chain(SIGNATURE).chain(tones).map(str::to_owned).collect()
}

#[test]
fn the_frame_of_pages_is_translated() {
    let translator = Translator::new(Language::Spanish.catalog().unwrap());
    let mut texts = frame();
    for markup in [
        trial::OPENER,
        include_str!("../../assets/player.html"),
        include_str!("../../assets/stage.html"),
    ] {
        let all = markup::texts_of_markup(markup).into_iter();
        texts.extend(all.filter(|text| !text.contains('{')));
    }
    for script in crate::page::all_scripts() {
        texts.extend(markup::texts_of_script(script).map(str::to_owned));
    }
    assert!(texts.len() > 120, "{}", texts.len());
    let same = |text: &&String| is_phrase(text) && translator.text(text) == **text;
    let kept = texts.iter().filter(same).filter(|text| translator.catalog.entry(text).is_none());
    let missing: HashSet<String> = texts
        .iter()
        .flat_map(|text| translator.translated(text).missing)
        .chain(kept.cloned())
        .collect();
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn a_text_is_compared_with_few_templates() {
    let catalog = Language::Spanish.catalog().unwrap();
    let text = "Shaken along the barrels, 53 of 64 variants fall (83 %, 95 % interval 72 to 90 %).";
    let compared = catalog.candidates(text).len();
    // Measured: 93 of some 2,000 templates.
    assert!(compared < 150, "{compared}");
}
