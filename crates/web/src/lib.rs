//! The engine for a page: a request in, a document out.
//!
//! A request is four bytes (the length of what follows, least first), a JSON object, and the bytes of the
//! records that it names, one after the other:
//!
//! ```text
//! { "ask": "summary", "scenario": "schema = 1 …", "name": "mine.toml", "set": ["stack.levels=5"],
//!   "records": [["site.at2", 81920]] }
//! ```
//!
//! What comes back is what the command writes of the same scenario, byte for byte but for the time on the clock:
//! nothing is opened, asked of the system, or sent.
//! In a page the door is [four functions and one import](https://webassembly.github.io/spec/core/), written by
//! hand, so that no glue is generated:
//!
//! | export | what it does |
//! |---|---|
//! | `room(length) -> address` | makes room for a request, which the page then writes there |
//! | `run() -> status` | does what is asked: 0 done, 1 refused, which the answer tells in words |
//! | `answer() -> address` | where the answer is, until the next call of `room` |
//! | `answer_length() -> length` | how many bytes it has |
//!
//! | import | what it does |
//! |---|---|
//! | `page.told(done, of) -> stop` | hears how far the work is, and stops it where it gives anything but 0 |
//!
//! A panic is a trap, and `answer` then has its text.
//!
//! The variants of a stack may be shared among several engines: each runs some of them ([`Ask::Variants`]), and one
//! says what all results so far say together ([`Ask::Verdict`]), with the bits of one that runs them all.

mod cases;
mod look;
#[cfg(target_family = "wasm")]
mod page;

use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::ControlFlow;

use barrelstack::scenario::{View, builtin};
use barrelstack::variants::{Answer, Asked, Plane, Spread, Told, answer, planes, run_some};
use barrelstack::variants::{together, words};
use barrelstack::{RunFailure, Scenario, export, report};
use barrelstack_report::{Fragment, badge, fragment};
use serde::{Deserialize, Serialize};

pub use cases::Case;

/// What a page may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ask {
    /// The scenarios that come with the program: a JSON list of pairs of name and text.
    Scenarios,
    /// The barrels and racks of the catalog, as JSON.
    Catalog,
    /// The stack as it is put up, and all that the scenario says, before anything is run, as JSON.
    Look,
    /// A variant in motion, by the first of the numbers, as JSON: 0 is the stack as it is stated.
    Show,
    /// What became of the variants of some numbers in each plane, as JSON.
    Variants,
    /// What results say together, as JSON: of numbers, the first of which is 0, with their results in each plane.
    Verdict,
    /// The summary of a run and its variants, as JSON.
    Summary,
    /// The report of the same, as a page.
    Report,
    /// All files that the command writes of the same, the report among them: in the form of a request, with
    /// their names and lengths as its head.
    Files,
}

/// What is asked.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// What for.
    pub ask: Ask,
    /// The text of the scenario.
    #[serde(default)]
    pub scenario: String,
    /// Its name in errors.
    #[serde(default)]
    pub name: String,
    /// What is set in it, such as `stack.levels=5`.
    #[serde(default)]
    pub set: Vec<String>,
    /// The records that are at hand: the path by which the scenario names it, and how many bytes it has.
    #[serde(default)]
    pub records: Vec<(String, usize)>,
    /// Numbers of variants.
    #[serde(default)]
    pub numbers: Vec<u32>,
    /// What became of them in each plane.
    #[serde(default)]
    pub cases: Vec<Vec<Case>>,
}

impl Request {
    /// A request for a scenario by its text, and nothing else.
    pub fn of(ask: Ask, scenario: &str) -> Self {
        Self {
            ask,
            scenario: scenario.to_owned(),
            name: String::new(),
            set: Vec::new(),
            records: Vec::new(),
            numbers: Vec::new(),
            cases: Vec::new(),
        }
    }

    /// The request in bytes, with those of its records in their order.
    pub fn to_bytes(&self, records: &[&[u8]]) -> Vec<u8> {
        // Only maps with keys that are not text could fail, and there is none.
        enveloped(&serde_json::to_vec(self).unwrap_or_default(), records)
    }
}

/// A head after its length, and what follows it.
fn enveloped(head: &[u8], rest: &[&[u8]]) -> Vec<u8> {
    let length = u32::try_from(head.len()).unwrap_or(u32::MAX);
    [&length.to_le_bytes(), head, &rest.concat()].concat()
}

/// Does what is asked, before an observer, who hears how much of how much is done and may stop the work: what
/// was seen until then is returned.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use barrelstack_web::{Ask, Request, answered};
///
/// let request = Request::of(Ask::Summary, "schema = 1\nextends = \"sliding-block\"");
/// let summary = answered(&request.to_bytes(&[]), &mut |_, _| ControlFlow::Continue(()))?;
/// assert!(summary.starts_with(b"{\n  \"schema\": \"summary/"));
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// In words, when the request cannot be read, the scenario is wrong, or it cannot be run.
pub fn answered(
    request: &[u8],
    observer: &mut (dyn FnMut(f64, f64) -> ControlFlow<()> + Send),
) -> Result<Vec<u8>, String> {
    let (request, records) = read(request)?;
    match request.ask {
        Ask::Scenarios => {
            let text = |name| Some((name, builtin::get(name)?));
            return json(&builtin::names().filter_map(text).collect::<Vec<_>>());
        }
        Ask::Catalog => return json(&look::Catalog::new()),
        Ask::Look
        | Ask::Show
        | Ask::Variants
        | Ask::Verdict
        | Ask::Summary
        | Ask::Report
        | Ask::Files => {}
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
    let mut answer = |asked| {
        let mut told = |told| match told {
            Told::Variants { done, of } => observer(done as f64, of as f64),
            Told::Run(progress) => observer(progress.time, progress.end_time),
        };
        answer(scenario, asked, &mut told).map_err(placed)
    };
    match request.ask {
        Ask::Look => json(&look::Looked::of(scenario, &planes()?).map_err(placed)?),
        Ask::Show => {
            let number = request.numbers.first().copied().unwrap_or(0);
            json(&Shown::of(&answer(Asked::Alone(number))?, number))
        }
        Ask::Variants => {
            let found = some(&planes()?, &request.numbers, observer)?;
            json(&found)
        }
        Ask::Verdict => json(&Verdict::of(&planes()?, request)?),
        Ask::Report => {
            let document = report::answer_document(&answer(Asked::Typical)?, None);
            Ok(barrelstack_report::html(&document).into_bytes())
        }
        Ask::Files => {
            let files = export::files(&answer(Asked::Typical)?, None).map_err(words_of)?;
            let head: Vec<_> = files.iter().map(|(name, bytes)| (name, bytes.len())).collect();
            let rest: Vec<&[u8]> = files.iter().map(|(_, bytes)| bytes.as_slice()).collect();
            Ok(enveloped(&json(&head)?, &rest))
        }
        Ask::Summary | Ask::Scenarios | Ask::Catalog => {
            Ok((answer(Asked::Typical)?.decides.summary.to_json() + "\n").into_bytes())
        }
    }
}

/// What became of some variants, in each plane.
fn some(
    planes: &[Plane],
    numbers: &[u32],
    observer: &mut (dyn FnMut(f64, f64) -> ControlFlow<()> + Send),
) -> Result<Vec<Vec<Case>>, String> {
    let observer = std::sync::Mutex::new(observer);
    let told = |done: usize, of: usize| match observer.lock() {
        Ok(mut observer) => observer(done as f64, of as f64),
        Err(_) => ControlFlow::Break(()),
    };
    let found = run_some(planes, numbers, &told).map_err(words_of)?;
    let found = found.ok_or("stopped")?;
    Ok(found.iter().map(|results| results.iter().map(Case::of).collect()).collect())
}

/// A variant in motion.
#[derive(Serialize)]
struct Shown<'a> {
    variant: u32,
    /// What happened, in sentences.
    sentences: Vec<String>,
    /// The outcome of each plane, that of the worse first.
    outcomes: Vec<&'a barrelstack::summary::OutcomeSummary>,
    warnings: &'a [String],
    stage: Fragment,
}

impl<'a> Shown<'a> {
    fn of(answer: &'a Answer, variant: u32) -> Self {
        let decides = &answer.decides;
        let shown = std::iter::once(decides).chain(&answer.other);
        Self {
            variant,
            sentences: report::sentences(&decides.run, &decides.summary),
            outcomes: shown.map(|shown| &shown.summary.outcome).collect(),
            warnings: &decides.run.warnings,
            stage: fragment(&[report::stage(answer)]),
        }
    }
}

/// What results say together.
#[derive(Serialize)]
struct Verdict {
    /// In one sentence.
    headline: String,
    /// Its sign and its word, as markup, and the class of its color.
    badge: String,
    tone: &'static str,
    /// In each plane.
    planes: Vec<Judged>,
}

/// What they say in one plane.
#[derive(Serialize)]
struct Judged {
    view: &'static str,
    /// Such as "across the barrels".
    words: &'static str,
    /// Such as "falls in 97 % of variants".
    fate: String,
    spread: Spread,
}

impl Verdict {
    fn of(planes: &[Plane], request: Request) -> Result<Self, String> {
        let Request { numbers, cases, .. } = request;
        let whole = cases.iter().all(|plane| plane.len() == numbers.len());
        if cases.len() != planes.len() || !whole || numbers.first() != Some(&0) {
            return Err(format!(
                "a verdict needs a result for each of its numbers, the first of which is 0, in each of {} planes",
                planes.len()
            ));
        }
        let results = cases.into_iter().map(|plane| plane.into_iter().map(Case::result).collect());
        let results: Result<Vec<_>, String> = results.collect();
        let found = together(planes, &numbers, results?);
        let spreads: Vec<(View, &Spread)> =
            found.iter().filter_map(|one| Some((one.view?, &one.spread))).collect();
        let tone = words::tone(&spreads);
        let judged = |&(view, spread): &(View, &Spread)| Judged {
            view: view.name(),
            words: view.words(),
            fate: words::fate(spread),
            spread: spread.clone(),
        };
        Ok(Self {
            headline: words::headline(&spreads),
            badge: badge(tone),
            tone: tone.class(),
            planes: spreads.iter().map(judged).collect(),
        })
    }
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, String> {
    serde_json::to_vec(value).map_err(words_of)
}

fn words_of(error: impl Display) -> String {
    error.to_string()
}

/// An error of a run with the place in the scenario that it is about.
fn placed(error: &RunFailure, scenario: &Scenario) -> String {
    match scenario.place_of(&error.fields()) {
        Some(place) => format!("{place}: {error}"),
        None => error.to_string(),
    }
}

/// A request with its records by their paths.
fn read(bytes: &[u8]) -> Result<(Request, BTreeMap<String, &[u8]>), String> {
    let cut = |what: &str| format!("the request ends within {what}");
    let (length, rest) = bytes.split_first_chunk::<4>().ok_or_else(|| cut("its length"))?;
    let length = usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let (head, mut rest) = rest.split_at_checked(length).ok_or_else(|| cut("its head"))?;
    let request: Request = serde_json::from_slice(head)
        .map_err(|error| format!("the head of the request: {error}"))?;
    let mut records = BTreeMap::new();
    for (path, length) in &request.records {
        let (record, after) = rest.split_at_checked(*length).ok_or_else(|| cut(path))?;
        records.insert(path.clone(), record);
        rest = after;
    }
    if !rest.is_empty() {
        return Err(format!("the request has {} bytes more than its records", rest.len()));
    }
    Ok((request, records))
}
