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

#[cfg(target_family = "wasm")]
mod page;

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use barrelstack::scenario::builtin;
use barrelstack::variants::{Asked, Told, answer};
use barrelstack::{Scenario, report};
use serde::{Deserialize, Serialize};

/// What a page may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ask {
    /// The scenarios that come with the program: a JSON list of pairs of name and text.
    Scenarios,
    /// The summary of a run and its variants, as JSON.
    Summary,
    /// The report of the same, as a page.
    Report,
}

/// What is asked.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
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
}

impl Request {
    /// The request in bytes, with those of its records in their order.
    pub fn to_bytes(&self, records: &[&[u8]]) -> Vec<u8> {
        // Only maps with keys that are not text could fail, and there is none.
        let head = serde_json::to_vec(self).unwrap_or_default();
        let length = u32::try_from(head.len()).unwrap_or(u32::MAX);
        [&length.to_le_bytes(), head.as_slice(), &records.concat()].concat()
    }
}

/// Does what is asked, before an observer, who hears how much of how much is done and may stop the work: what
/// was seen until then is returned.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use barrelstack_web::{Ask, Request, answered};
///
/// let request = Request {
///     ask: Ask::Summary,
///     scenario: "schema = 1\nextends = \"sliding-block\"".to_owned(),
///     name: "mine.toml".to_owned(),
///     set: Vec::new(),
///     records: Vec::new(),
/// };
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
    if request.ask == Ask::Scenarios {
        let all: Vec<_> =
            builtin::names().filter_map(|name| Some((name, builtin::get(name)?))).collect();
        return serde_json::to_vec(&all).map_err(|error| error.to_string());
    }
    let name = if request.name.is_empty() { "scenario" } else { &request.name };
    let scenario = Scenario::parse(name, &request.scenario, &request.set)
        .map_err(|error| error.to_string())?;
    let scenario = scenario
        .with_records(&mut |path| {
            let bytes = path.to_str().and_then(|path| records.get(path));
            bytes.map(|bytes| bytes.to_vec()).ok_or_else(|| "there is no such file".to_owned())
        })
        .map_err(|error| error.to_string())?;
    let found = answer(&scenario, Asked::Typical, &mut |told| match told {
        Told::Variants { done, of } => observer(done as f64, of as f64),
        Told::Run(progress) => observer(progress.time, progress.end_time),
    })
    .map_err(|error| error.to_string())?;
    Ok(match request.ask {
        Ask::Report => {
            barrelstack_report::html(&report::answer_document(&found, None)).into_bytes()
        }
        Ask::Summary | Ask::Scenarios => (found.decides.summary.to_json() + "\n").into_bytes(),
    })
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
