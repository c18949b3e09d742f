//! A WebAssembly module, the engine of a page: handles a request and returns a document.
//!
//! A request consists of four bytes (the length of the following object, little-endian), a JSON
//! object, and the bytes of the records, one after the other:
//!
//! ```text
//! { "ask": "summary", "scenario": "schema = 1 …", "name": "mine.toml", "set": ["stack.levels=5"],
//!   "records": [["site.at2", 81920]] }
//! ```
//!
//! The answer equals the output of the command-line program for the same scenario, byte for byte,
//! except for computation times. The engine opens no files, makes no system calls, and sends nothing. The
//! interface to a page is [four functions and one
//! import](https://webassembly.github.io/spec/core/), written by hand, so that no glue code is
//! generated:
//!
//! | export | purpose |
//! |---|---|
//! | `room(length) -> address` | allocates `length` bytes, to which the page then writes the request |
//! | `run() -> status` | handles the request; 0 on success, 1 if refused (the answer then states the reason) |
//! | `answer() -> address` | address of the answer, until the next call of `room` |
//! | `answer_length() -> length` | length of the answer in bytes |
//!
//! | import | purpose |
//! |---|---|
//! | `page.progress(done, of) -> stop` | progress callback; any result but 0 stops the work |
//!
//! A panic ends in a trap, after which `answer` returns the message of the panic.
//!
//! The variants of a stack may be divided among several engines: each engine runs some of them
//! ([`RequestKind::Variants`]), and one engine combines all results obtained so far
//! ([`RequestKind::Verdict`]). The combined results are bit-identical to those of a single engine
//! that runs all variants.
//!
//! A request states the language of its answer. The module contains translations of the English messages only if it is
//! built with the feature `languages`, which makes it larger.

mod cases;
mod devices;
mod look;
#[cfg(target_family = "wasm")]
mod page;
mod records;
mod trails;
mod verdict;

use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::ControlFlow;

use barrelstack::scenario::builtin;
use barrelstack::variants::{
    Advance, Answer, Plane, RunChoice, answer, answer_of, planes, run_some,
};
use barrelstack::{RunFailure, Scenario, export, report};
use barrelstack_report::{Fragment, Language, fragment};
use serde::{Deserialize, Serialize};

pub use cases::Case;
pub use records::Reading;
use verdict::Verdict;

/// The kind of a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RequestKind {
    /// The bundled scenarios, except the three-dimensional ones, as a JSON list of pairs of name and text.
    #[default]
    Scenarios,
    /// The barrels and racks of the catalog, as JSON.
    Catalog,
    /// The assembled stack and all settings of the scenario before a run, as JSON.
    Look,
    /// The devices on the stack, and the applicable settings of other devices, each with its changes to the scenario,
    /// as JSON.
    Devices,
    /// The given record files, grouped into motions, and the files that contain no motion, as JSON;
    /// then the bytes of motions that are combined from several files. The request needs no
    /// scenario.
    Records,
    /// The animation of a variant and its result, as JSON. The first entry of `numbers` selects the variant; 0 is the
    /// nominal case.
    Show,
    /// The results of the variants `numbers` in each plane, as JSON; then the paths of their barrels (the trails) as
    /// bytes, for a report.
    Variants,
    /// The verdict on given results, as JSON. In the request, `numbers` lists the variants, starting
    /// with 0 (the nominal case), and `cases` contains their results in each plane.
    Verdict,
    /// The summary of a run and its variants, as JSON; it is the same in all languages.
    Summary,
    /// The report of a run and its variants, as an HTML page.
    Report,
    /// All files that the command-line program writes for a run and its variants, including the
    /// report, encoded like a request: the JSON lists the names and lengths of the files, and their
    /// bytes follow. If the results of all variants are given, no variant is run again.
    Files,
}

/// A request.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// Kind of the request.
    #[serde(rename = "ask")]
    pub kind: RequestKind,
    /// Code of the language of the answer, such as "es"; English if empty.
    #[serde(default)]
    pub language: String,
    /// The text of the scenario.
    #[serde(default)]
    pub scenario: String,
    /// Name of the scenario, for error messages.
    #[serde(default)]
    pub name: String,
    /// Overrides, such as `stack.levels=5`.
    #[serde(default)]
    pub set: Vec<String>,
    /// The records provided: the path by which the scenario refers to each, and its length in bytes.
    #[serde(default)]
    pub records: Vec<(String, usize)>,
    /// Numbers of the variants to which the request refers; 0 is the nominal case.
    #[serde(default)]
    pub numbers: Vec<u32>,
    /// For each plane, the results of the variants `numbers`.
    #[serde(default)]
    pub cases: Vec<Vec<Case>>,
    /// Length in bytes of the paths of the barrels (the trails), which follow the records.
    #[serde(default)]
    pub trails: usize,
    /// Information that the record files lack.
    #[serde(default)]
    pub reading: Reading,
}

impl Request {
    /// Creates a request for a scenario given as text.
    pub fn of(kind: RequestKind, scenario: &str) -> Self {
        Self { kind, scenario: scenario.to_owned(), ..Self::default() }
    }

    /// Encodes the request, followed by its records in order.
    pub fn to_bytes(&self, records: &[&[u8]]) -> Vec<u8> {
        // Serialization fails only for maps with keys that are not strings, and there are none.
        enveloped(&serde_json::to_vec(self).unwrap_or_default(), records)
    }
}

/// Concatenates the length of `head` (four bytes, little-endian), `head`, and the byte strings in `rest`.
fn enveloped(head: &[u8], rest: &[&[u8]]) -> Vec<u8> {
    let length = u32::try_from(head.len()).unwrap_or(u32::MAX);
    [&length.to_le_bytes(), head, &rest.concat()].concat()
}

/// Handles a request and returns the answer.
///
/// `observer(done, of)` receives the progress and may stop the work; the results obtained so far
/// are then returned.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use barrelstack_web::{RequestKind, Request, answered};
///
/// let request = Request::of(RequestKind::Summary, "schema = 1\nextends = \"sliding-block\"");
/// let summary = answered(&request.to_bytes(&[]), &mut |_, _| ControlFlow::Continue(()))?;
/// assert!(summary.starts_with(b"{\n  \"schema\": \"summary/"));
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// A message if the request cannot be read, or if the scenario is invalid or cannot be run.
pub fn answered(
    request: &[u8],
    observer: &mut (dyn FnMut(f64, f64) -> ControlFlow<()> + Send),
) -> Result<Vec<u8>, String> {
    let opened = read(request)?;
    let language = match opened.request.language.as_str() {
        "" => Language::English,
        code => code.parse().map_err(words_of)?,
    };
    answered_in(language, opened, observer).map_err(|refusal| refused(&refusal, language))
}

/// Text in an error message that precedes the list of valid keys or names.
const VALID: &str = "valid here: ";

/// Translates a message line by line. Positions in files, quoted lines of the scenario (which follow a `|`), and lists
/// of valid keys are not translated.
fn refused(message: &str, language: Language) -> String {
    let line = |line: &str| {
        let start = line.find(|c: char| c.is_alphabetic() || c == '`').unwrap_or(line.len());
        let (mark, words) = line.split_at(start);
        if mark.contains(['|', '>']) {
            return line.to_owned();
        }
        match words.strip_prefix(VALID) {
            Some(keys) => format!("{mark}{}{keys}", language.text(VALID)),
            None => format!("{mark}{}", language.text(words)),
        }
    };
    message.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

fn answered_in(
    language: Language,
    opened: Opened<'_>,
    observer: &mut (dyn FnMut(f64, f64) -> ControlFlow<()> + Send),
) -> Result<Vec<u8>, String> {
    let Opened { request, records, trails } = opened;
    if request.kind == RequestKind::Scenarios {
        let text = |name| Some((name, builtin::get(name)?));
        // The page supports only planar scenarios.
        let in_a_plane =
            |name: &&str| Scenario::builtin(name, &[]).is_ok_and(|scenario| !scenario.is_spatial());
        return json(&builtin::names().filter(in_a_plane).filter_map(text).collect::<Vec<_>>());
    } else if request.kind == RequestKind::Catalog {
        return json(&look::Catalog::new());
    } else if request.kind == RequestKind::Records {
        let (found, bytes) = records::of(&records, &request.reading, language)?;
        let bytes: Vec<&[u8]> = bytes.iter().map(Vec::as_slice).collect();
        return Ok(enveloped(&json(&found)?, &bytes));
    }
    let name = if request.name.is_empty() { "scenario" } else { &request.name };
    let scenario = Scenario::parse(name, &request.scenario, &request.set).map_err(words_of)?;
    let with_records = scenario.with_records(&mut |path| {
        let bytes = path.to_str().and_then(|path| records.get(path));
        bytes.map(|bytes| bytes.to_vec()).ok_or_else(|| "there is no such file".to_owned())
    });
    let placed = |error| placed(&error, &scenario);
    let scenario = &with_records.map_err(|error| placed(error.into()))?;
    let planes = || planes(scenario).map_err(|error| placed(error.into()));
    let mut progress = |advance| match advance {
        Advance::Variants { done, of } => observer(done as f64, of as f64),
        Advance::First { .. } => ControlFlow::Continue(()),
        Advance::Run(run) => observer(run.time, run.end_time),
    };
    match request.kind {
        RequestKind::Devices => json(&devices::Devices::of(scenario, language)),
        RequestKind::Look => {
            json(&look::Looked::of(scenario, &planes()?, language).map_err(placed)?)
        }
        RequestKind::Show => {
            let number = request.numbers.first().copied().unwrap_or(0);
            let shown =
                answer(scenario, RunChoice::Alone(number), &mut progress).map_err(placed)?;
            json(&Shown::of(&shown, number, language))
        }
        RequestKind::Variants => some(&planes()?, &request.numbers, observer),
        RequestKind::Verdict => json(&Verdict::of(&planes()?, request, language)?),
        RequestKind::Report => {
            let found = answer(scenario, RunChoice::Typical, &mut progress).map_err(placed)?;
            let document = report::answer_document(&found).in_language(language);
            Ok(barrelstack_report::html(&document).into_bytes())
        }
        RequestKind::Files => {
            let found = if request.numbers.is_empty() {
                answer(scenario, RunChoice::Typical, &mut progress)
            } else {
                let results = verdict::results(&planes()?, request, trails)?;
                answer_of(scenario, results, &mut progress)
            };
            let files = export::files(&found.map_err(placed)?, language).map_err(words_of)?;
            let head: Vec<_> = files.iter().map(|(name, bytes)| (name, bytes.len())).collect();
            let rest: Vec<&[u8]> = files.iter().map(|(_, bytes)| bytes.as_slice()).collect();
            Ok(enveloped(&json(&head)?, &rest))
        }
        RequestKind::Summary
        | RequestKind::Scenarios
        | RequestKind::Catalog
        | RequestKind::Records => {
            let found = answer(scenario, RunChoice::Typical, &mut progress).map_err(placed)?;
            Ok((found.decides.summary.to_json() + "\n").into_bytes())
        }
    }
}

/// Runs some of the variants in each plane; returns their results, and the paths of their barrels as bytes.
fn some(
    planes: &[Plane],
    numbers: &[u32],
    observer: &mut (dyn FnMut(f64, f64) -> ControlFlow<()> + Send),
) -> Result<Vec<u8>, String> {
    let observer = std::sync::Mutex::new(observer);
    let progress = |done: usize, of: usize| match observer.lock() {
        Ok(mut observer) => observer(done as f64, of as f64),
        Err(_) => ControlFlow::Break(()),
    };
    let found = run_some(planes, numbers, &progress).map_err(words_of)?;
    let found = found.ok_or("stopped")?;
    let cases: Vec<Vec<Case>> =
        found.iter().map(|results| results.iter().map(Case::of).collect()).collect();
    let trails = (0..).zip(&found).flat_map(|(plane, results)| {
        let numbered = numbers.iter().zip(results);
        numbered.map(move |(number, result)| ((plane, *number), &result.trail))
    });
    Ok(enveloped(&json(&cases)?, &[&trails::written(trails)]))
}

/// The animation of a variant, with its result.
#[derive(Serialize)]
struct Shown<'a> {
    variant: u32,
    /// The result in sentences.
    sentences: Vec<String>,
    /// Outcome in each plane, the governing plane first.
    outcomes: Vec<&'a barrelstack::summary::OutcomeSummary>,
    warnings: Vec<String>,
    stage: Fragment,
}

impl<'a> Shown<'a> {
    fn of(answer: &'a Answer, variant: u32, language: Language) -> Self {
        let decides = &answer.decides;
        let shown = std::iter::once(decides).chain(&answer.other);
        Self {
            variant,
            sentences: translated(&report::sentences(&decides.run, &decides.summary), language),
            outcomes: shown.map(|shown| &shown.summary.outcome).collect(),
            warnings: translated(&decides.run.warnings, language),
            stage: fragment(&[report::stage(answer)], language),
        }
    }
}

fn translated(texts: &[String], language: Language) -> Vec<String> {
    texts.iter().map(|text| language.text(text)).collect()
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, String> {
    serde_json::to_vec(value).map_err(words_of)
}

fn words_of(error: impl Display) -> String {
    error.to_string()
}

/// Formats an error from a run. The position of the error in the scenario precedes the message, if it is known.
fn placed(error: &RunFailure, scenario: &Scenario) -> String {
    match scenario.place_of(&error.fields()) {
        Some(place) => format!("{place}: {error}"),
        None => error.to_string(),
    }
}

/// A decoded request with its attached data.
struct Opened<'a> {
    request: Request,
    /// The bytes of each record, by path.
    records: BTreeMap<String, &'a [u8]>,
    trails: &'a [u8],
}

fn read(bytes: &[u8]) -> Result<Opened<'_>, String> {
    let cut = |what: &str| format!("the request ends within {what}");
    let (length, rest) = bytes.split_first_chunk::<4>().ok_or_else(|| cut("its length"))?;
    let length = usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let (head, mut rest) = rest.split_at_checked(length).ok_or_else(|| cut("its header"))?;
    let request: Request = serde_json::from_slice(head)
        .map_err(|error| format!("cannot read the head of the request: {error}"))?;
    let mut records = BTreeMap::new();
    for (path, length) in &request.records {
        let (record, after) = rest.split_at_checked(*length).ok_or_else(|| cut(path))?;
        records.insert(path.clone(), record);
        rest = after;
    }
    let (trails, rest) = rest.split_at_checked(request.trails).ok_or_else(|| cut("its trails"))?;
    if !rest.is_empty() {
        return Err(format!("the request has {} bytes more than its header states", rest.len()));
    }
    Ok(Opened { request, records, trails })
}
