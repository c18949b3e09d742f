//! What was done already, one line a record, so that a stop loses nothing.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;

use anyhow::{Context as _, bail};
use barrelstack_campaign::study::{ColumnSpec, Value, ValueKind};
use serde_json::json;

use crate::commands::motion::input;
use crate::commands::motion::output::store;

/// One record: its row, or none, and the files that were refused.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) record: String,
    /// Fingerprint of the bytes of its files.
    pub(super) hash: u64,
    pub(super) row: Option<Vec<Option<Value>>>,
    /// File and reason.
    pub(super) refused: Vec<(String, String)>,
}

/// The file of what was done.
pub(super) struct Journal {
    known: BTreeMap<String, Entry>,
    file: Mutex<File>,
}

impl Journal {
    /// Opens the journal of a folder, or begins one.
    ///
    /// A line that is cut, as a kill leaves it, counts as not done.
    pub(super) fn open(out: &Path, settings: &str, specs: &[ColumnSpec]) -> anyhow::Result<Self> {
        let path = out.join("rows.jsonl");
        let names: Vec<String> = specs.iter().map(ColumnSpec::heading).collect();
        let version = env!("CARGO_PKG_VERSION");
        let head = json!({ "barrelstack": version, "settings": settings, "columns": names });
        let mut known = BTreeMap::new();
        let mut text = format!("{head}\n");
        if path.exists() {
            let bytes = input::bytes(&path)?;
            let whole = String::from_utf8_lossy(&bytes);
            let mut lines = whole.lines();
            let first = lines.next().and_then(|line| serde_json::from_str(line).ok());
            if first.as_ref().is_some_and(|first: &serde_json::Value| *first != head) {
                bail!(
                    "{} holds the table of another command ({}): name another folder, or remove \
                     rows.jsonl there",
                    out.display(),
                    first.map_or(String::new(), |first| first["settings"].to_string())
                );
            }
            for line in lines {
                if let Some(entry) = Entry::read(line, specs) {
                    text.push_str(line);
                    text.push('\n');
                    known.insert(entry.record.clone(), entry);
                }
            }
        }
        store(&path, text.as_bytes())?;
        let file = File::options()
            .append(true)
            .open(&path)
            .map_err(input::plain)
            .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { known, file: Mutex::new(file) })
    }

    /// What was found for a record, if its files are still the same.
    pub(super) fn known(&self, record: &str, hash: u64) -> Option<Entry> {
        self.known.get(record).filter(|entry| entry.hash == hash).cloned()
    }

    /// Notes a record as done.
    pub(super) fn note(&self, entry: &Entry) -> anyhow::Result<()> {
        let line = format!("{}\n", entry.line());
        let Ok(mut file) = self.file.lock() else { bail!("another thread failed to write") };
        file.write_all(line.as_bytes()).map_err(input::plain).context("cannot write rows.jsonl")
    }
}

impl Entry {
    fn line(&self) -> serde_json::Value {
        let value = |value: &Option<Value>| match value {
            None => serde_json::Value::Null,
            Some(Value::Integer(value)) => json!(value),
            Some(Value::Number(value)) => json!(value),
            Some(Value::Text(value)) => json!(value),
        };
        let row = self.row.as_ref().map(|row| row.iter().map(value).collect::<Vec<_>>());
        json!({
            "record": self.record,
            "hash": format!("{:016x}", self.hash),
            "row": row,
            "refused": self.refused,
        })
    }

    fn read(line: &str, specs: &[ColumnSpec]) -> Option<Self> {
        let found: serde_json::Value = serde_json::from_str(line).ok()?;
        let row = if found["row"].is_null() {
            None
        } else {
            let values = found["row"].as_array().filter(|values| values.len() == specs.len())?;
            let pairs = values.iter().zip(specs);
            Some(pairs.map(|(value, spec)| cell(value, spec.kind)).collect::<Option<_>>()?)
        };
        Some(Self {
            record: found["record"].as_str()?.to_owned(),
            hash: u64::from_str_radix(found["hash"].as_str()?, 16).ok()?,
            row,
            refused: serde_json::from_value(found["refused"].clone()).ok()?,
        })
    }
}

/// A value of a column's kind; the outer None where it is of another.
#[expect(clippy::option_option, reason = "no value and a wrong value are two things")]
fn cell(value: &serde_json::Value, kind: ValueKind) -> Option<Option<Value>> {
    if value.is_null() {
        return Some(None);
    }
    Some(Some(match kind {
        ValueKind::Integer => Value::Integer(value.as_i64()?),
        ValueKind::Number => Value::Number(value.as_f64()?),
        ValueKind::Text => Value::Text(value.as_str()?.to_owned()),
    }))
}
