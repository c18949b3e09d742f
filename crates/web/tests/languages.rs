//! The page in Spanish: every text of the page and of the answers of the engine is translated, and
//! everything else is as in English.

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use barrelstack_report::{Language, Shell};
use barrelstack_web::{Case, Reading, Request, RequestKind, answered};
use serde_json::Value;

/// Members of answers that hold texts for the reader.
const TEXTS: [&str; 17] = [
    "badge",
    "channels",
    "devices",
    "fate",
    "headline",
    "help",
    "label",
    "markup",
    "name",
    "overlay",
    "sentences",
    "source",
    "text",
    "title",
    "warnings",
    "why",
    "words",
];

/// Start of the names of the bundled motion, which are the same in all languages.
const STATION: &str = "South Napa 2014, Napa College";

fn answer(request: &Request, language: Language, files: &[&[u8]]) -> Result<Vec<u8>, String> {
    let request = Request { language: language.code().to_owned(), ..request.clone() };
    answered(&request.to_bytes(files), &mut |_, _| ControlFlow::Continue(()))
}

/// Returns the document of an answer, which may be preceded by its length and followed by bytes.
fn document(answer: &[u8]) -> Value {
    if let Ok(whole) = serde_json::from_slice(answer) {
        return whole;
    }
    let (length, rest) = answer.split_first_chunk::<4>().expect("an answer with a length");
    serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).expect("a head of JSON")
}

/// Texts without a translation, and the number of texts that differ from English.
#[derive(Default)]
struct Found {
    missing: BTreeSet<String>,
    translated: usize,
}

impl Found {
    fn text(&mut self, english: &str) {
        let missing = Language::Spanish.untranslated(english);
        // Names of tables of the scenario, such as [stack], and of bodies are the same in all languages.
        let kept = |part: &String| part.starts_with('[') || part == "disc";
        self.missing.extend(missing.into_iter().filter(|part| !kept(part)));
    }

    /// Compares an answer in both languages: only texts differ.
    fn compare(&mut self, key: &str, english: &Value, spanish: &Value) {
        match (english, spanish) {
            (Value::Object(a), Value::Object(b)) => {
                assert!(a.keys().eq(b.keys()), "{key}");
                for (key, value) in a {
                    self.compare(key, value, &b[key]);
                }
            }
            (Value::Array(a), Value::Array(b)) => {
                assert_eq!(a.len(), b.len(), "{key}");
                a.iter().zip(b).for_each(|(a, b)| self.compare(key, a, b));
            }
            (Value::String(a), Value::String(b)) if key == "data" => {
                let parsed = |text: &str| serde_json::from_str(text).expect("JSON");
                self.compare("stage", &parsed(a), &parsed(b));
            }
            (Value::String(a), Value::String(b)) if TEXTS.contains(&key) => {
                if !["badge", "markup"].contains(&key) && !a.starts_with(STATION) {
                    self.text(a);
                }
                self.translated += usize::from(a != b);
            }
            _ => assert_eq!(english, spanish, "{key}"),
        }
    }

    /// Compares the answers of the engine in both languages.
    fn answers(&mut self, request: &Request, files: &[&[u8]]) {
        let both = [Language::English, Language::Spanish]
            .map(|language| document(&answer(request, language, files).expect("an answer")));
        self.compare("", &both[0], &both[1]);
    }

    /// Compares the messages of a refused request in both languages.
    fn refused(&mut self, request: &Request) {
        let [english, spanish] = [Language::English, Language::Spanish]
            .map(|language| answer(request, language, &[]).expect_err("a refusal"));
        assert_eq!(english.lines().count(), spanish.lines().count());
        for (english, spanish) in english.lines().zip(spanish.lines()) {
            let place = english.contains("-->") || english.contains('|');
            if let Some(keys) = english.strip_prefix("  = valid here: ") {
                assert_eq!(spanish, format!("  = válidos aquí: {keys}"));
            } else if !place {
                self.text(english.trim_start_matches([' ', '=']));
            }
            assert_eq!(english != spanish, !place, "{english}");
        }
    }

    fn end(self, least: usize) {
        let missing: Vec<String> = self.missing.into_iter().collect();
        assert!(
            missing.is_empty(),
            "{} texts have no entry in es.toml:\n{}",
            missing.len(),
            missing.join("\n")
        );
        assert!(self.translated >= least, "only {} texts differ", self.translated);
    }
}

fn request(kind: RequestKind, changes: &[&str]) -> Request {
    let set = changes.iter().map(|change| (*change).to_owned()).collect();
    let scenario = "schema = 1\nextends = \"demo-napa\"\n[imperfections]\nvariants = 2\n[run]\nduration = \"9 s\"\n";
    Request { set, ..Request::of(kind, scenario) }
}

#[test]
fn the_page_and_its_scripts_are_translated() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let names = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
    let names = names.map(|name| name.into_string().unwrap());
    let scripts: Vec<String> = names
        .filter(|name| Path::new(name).extension().is_some_and(|end| end == "js"))
        .map(|name| read(&name))
        .collect();
    let scripts: Vec<&str> = scripts.iter().map(String::as_str).collect();
    let body = read("page.html");
    let page = Shell {
        language: Language::Spanish,
        title: "barrelstack: wine barrels in earthquakes",
        style: "",
        body: &body,
        at_hand: &[],
        worker: "",
        scripts: &scripts,
        held: &[],
    };
    let html = page.html();
    assert!(html.contains("<html lang=\"es\">") && html.contains("id=\"language\""));
    let english = Shell { language: Language::English, ..page }.html();
    assert!(!english.contains("id=\"language\"") && english.contains(&body));
    let missing = page.untranslated(Language::Spanish);
    Found { missing: missing.into_iter().collect(), translated: 1 }.end(1);
}

#[test]
fn what_is_said_of_a_stack_is_translated() {
    let mut found = Found::default();
    for changes in [
        &[][..],
        &["stack.levels=2", "stack.chock.levels=1", "stack.view=transverse"],
        &["stack.strap.levels=5", "stack.levels=5", "stack.rack=rack-on-rack"],
        &["stack.tuned_mass.level=1"],
        &["stack.isolator.path=dish"],
    ] {
        found.answers(&request(RequestKind::Look, changes), &[]);
        found.answers(&request(RequestKind::Devices, changes), &[]);
    }
    let scenarios = answer(&Request::default(), Language::English, &[]).unwrap();
    let scenarios: Vec<(String, String)> = serde_json::from_slice(&scenarios).unwrap();
    for (_, text) in scenarios {
        let look = Request::of(RequestKind::Look, &text);
        // A scenario whose record is not bundled cannot be shown.
        if answer(&look, Language::English, &[]).is_ok() {
            found.answers(&look, &[]);
        }
    }
    found.end(1000);
}

#[test]
fn runs_and_verdicts_are_translated() {
    let mut found = Found::default();
    for changes in [
        &["stack.levels=2"][..],
        &["stack.levels=4", "motion.scale.factor=2.5"],
        &["stack.levels=3", "stack.view=longitudinal"],
        &["stack.levels=6", "stack.rack=rack-on-rack", "stack.strap.levels=6"],
    ] {
        found.answers(&request(RequestKind::Show, changes), &[]);
        let base = Request { numbers: vec![0, 1, 2], ..request(RequestKind::Variants, changes) };
        let cases = document(&answer(&base, Language::English, &[]).unwrap());
        let cases: Vec<Vec<Case>> = serde_json::from_value(cases).unwrap();
        found.answers(&Request { kind: RequestKind::Verdict, cases, ..base }, &[]);
    }
    found.end(60);
}

#[test]
fn what_is_said_of_files_is_translated() {
    let column: String =
        (0..1500).map(|at| (f64::from(at) / 12.0).sin().to_string() + "\n").collect();
    let files: [(&str, &[u8]); 4] = [
        ("R1.csv", column.as_bytes()),
        ("R2.txt", b"no numbers\n"),
        ("cellar.png", b"\x89PNG\r\n"),
        ("empty.txt", b""),
    ];
    let bytes: Vec<&[u8]> = files.iter().map(|(_, bytes)| *bytes).collect();
    let records = files.iter().map(|(name, bytes)| ((*name).to_owned(), bytes.len())).collect();
    let mut found = Found::default();
    let base = Request { records, ..Request::of(RequestKind::Records, "") };
    found.answers(&base, &bytes);
    let reading = Reading { unit: None, time_step: Some(0.01) };
    found.answers(&Request { reading: reading.clone(), ..base.clone() }, &bytes);
    let reading = Reading { unit: Some("g".into()), ..reading };
    found.answers(&Request { reading, ..base }, &bytes);
    found.end(5);
}

#[test]
fn refusals_of_records_are_translated() {
    let formats = include_str!("../../../docs/formats.md");
    let refusals = formats.lines().filter_map(|line| line.split("| refused: ").nth(1));
    let mut found = Found::default();
    for refusal in refusals {
        found.text(&format!("R1.csv, line 3: {}", refusal.trim_end_matches(" |")));
        found.translated += 1;
    }
    found.end(40);
}

#[test]
fn refusals_are_translated() {
    let mut found = Found::default();
    for changes in [
        "stack.levels=99",
        "stack.levels=\"many\"",
        "stack.levles=3",
        "stack.rack=shelf",
        "run.duration=-1 s",
        "motion.scale.factor=x",
        "motion.record=none.txt",
        "stack.view=sideways",
    ] {
        found.refused(&request(RequestKind::Look, &[changes]));
    }
    found.refused(&Request::of(RequestKind::Look, "schema = 1\nlevels = \n"));
    found.end(0);
}

#[test]
fn reports_and_files_are_in_the_language() {
    let base = request(RequestKind::Files, &["stack.levels=1", "stack.view=transverse"]);
    let [english, spanish] = [Language::English, Language::Spanish].map(|language| {
        String::from_utf8_lossy(&answer(&base, language, &[]).unwrap()).into_owned()
    });
    assert!(english.contains("<html lang=\"en\">") && !english.contains("<html lang=\"es\">"));
    assert!(spanish.contains("<html lang=\"es\">") && spanish.contains(">Advertencias<"));
    let base = Request { kind: RequestKind::Report, ..base };
    let report = String::from_utf8(answer(&base, Language::Spanish, &[]).unwrap()).unwrap();
    assert!(report.contains("<html lang=\"es\">"));
    let unknown = Request { language: "fr".into(), ..base };
    let refusal =
        answered(&unknown.to_bytes(&[]), &mut |_, _| ControlFlow::Continue(())).unwrap_err();
    assert!(refusal.contains("\"fr\""), "{refusal}");
}
