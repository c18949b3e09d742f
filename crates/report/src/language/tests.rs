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

#[test]
fn one_event_has_one_name() {
    let sources = SPANISH.lines().filter_map(catalog::entry).map(|(source, _)| source);
    let other: Vec<&str> = sources.filter(|source| source.contains("loss of seat")).collect();
    assert!(other.is_empty(), "should be \"loss of a seat\": {other:#?}");
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
        "largest until the first loss of a seat",
        "at rest",
        "amplification 2.1",
        "line load: 20 kN/m",
        "no line load",
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
fn sentences_about_variants_and_changes_are_translated() {
    let translator = Translator::new(Language::Spanish.catalog().unwrap());
    for (english, spanish) in [
        (
            "A stack of one level would have stood in all 16 variants. A stack of two to four levels, or straps \
             tightened to 3 or 5 kN, would not have been enough.",
            "Una pila de un nivel habría permanecido en pie en las 16 variantes. Una pila de dos a cuatro niveles, o \
             amarres tensados a 3 o 5 kN, no habrían bastado.",
        ),
        (
            "A stack of two or three levels without these straps would not have been enough.",
            "Una pila de dos o tres niveles sin estos amarres no habría bastado.",
        ),
        (
            "A stack of four levels would not have been enough.",
            "Una pila de cuatro niveles no habría bastado.",
        ),
        (
            "On average over the friction, stiffness and damping of the seats, which are uncertain, at most 10 % of \
             stacks with one level would fall (95 % confidence). Depending on the true values of these constants, 0 to \
             14 % of stacks with one level would fall (95 % range).",
            "En promedio sobre el roce, la rigidez y el amortiguamiento de los apoyos, que son inciertos, caería a lo \
             más el 10 % de las pilas con un nivel (confianza del 95 %). Según los valores verdaderos de estas constantes, \
             caería del 0 al 14 % de las pilas con un nivel (rango del 95 %).",
        ),
        (
            "The stiffness of seats changes this share most: 96 % fall at 1.1 MN/m, 59 % fall at 8.0 MN/m.",
            "La rigidez de los apoyos es lo que más cambia esta proporción: cae el 96 % con 1.1 MN/m, cae el 59 % con \
             8.0 MN/m.",
        ),
        (
            "Straps tightened to 1, 3 or 5 kN would not have been enough.",
            "Amarres tensados a 1, 3 o 5 kN no habrían bastado.",
        ),
        (
            "On average, this measurement narrows the range from 81 to 63 percentage points.",
            "En promedio, esta medición estrecha el rango de 81 a 63 puntos porcentuales.",
        ),
        (
            "In all 15 variants that fall, the first body to lose its seat leaves it along the barrels.",
            "En las 15 variantes que caen, el primer cuerpo que pierde su apoyo lo deja a lo largo de las barricas.",
        ),
        (
            "In 12 of the 15 variants that fall, the first body to lose its seat leaves it across the barrels.",
            "En 12 de las 15 variantes que caen, el primer cuerpo que pierde su apoyo lo deja en la dirección \
             transversal a las barricas.",
        ),
        (
            "98 % of the barrels that fall within 2 s of the first loss of a seat end up displaced mainly along the \
             barrels.",
            "El 98 % de las barricas que caen dentro de 2 s desde la primera pérdida de un apoyo queda desplazado \
             principalmente a lo largo de las barricas.",
        ),
        (
            "All barrels that fall within 2 s of the first loss of a seat end up displaced mainly across the barrels.",
            "Todas las barricas que caen dentro de 2 s desde la primera pérdida de un apoyo quedan desplazadas \
             principalmente en la dirección transversal a las barricas.",
        ),
        (
            "Of the barrels that fall, about equal numbers end up displaced mainly across and mainly along the \
             barrels.",
            "De las barricas que caen, un número parecido queda desplazado principalmente en la dirección \
             transversal a las barricas y principalmente a lo largo de ellas.",
        ),
        (
            "Along the barrels, all 5 variants that fall do so under their own weight, before they are shaken.",
            "A lo largo de las barricas, las 5 variantes que caen lo hacen por su propio peso, antes de ser sacudidas.",
        ),
        (
            "The one variant that falls does so under its own weight, before it is shaken.",
            "La única variante que cae lo hace por su propio peso, antes de ser sacudida.",
        ),
    ] {
        let found = translator.translated(english);
        assert_eq!((found.text.as_str(), found.missing.as_slice()), (spanish, &[][..]));
    }
}

#[test]
fn a_text_is_compared_with_few_templates() {
    let catalog = Language::Spanish.catalog().unwrap();
    let text = "Shaken along the barrels, 53 of 64 variants fall (83 %, 95 % interval 72 to 90 %).";
    let compared = catalog.candidates(text).len();
    // Measured: 93 of some 2,000 templates.
    assert!(compared < 150, "{compared}");
}
