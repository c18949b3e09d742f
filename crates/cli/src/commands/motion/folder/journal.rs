//! Journal of finished records with one line per record, so that an interruption loses no work.

use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::io::{BufRead as _, BufReader, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context as _, bail};
use barrelstack::scenario::fnv1a;
use barrelstack_campaign::study::{ColumnSpec, Value, ValueKind};
use barrelstack_input::system;
use serde_json::json;

use crate::commands::motion::input;

/// Outcome of processing one record: its row of the table, if any, and the files that were refused.
#[derive(Debug)]
pub(super) struct JournalEntry {
    pub(super) record: String,
    /// Fingerprint of the contents of the record's files.
    pub(super) hash: u64,
    pub(super) row: Option<Vec<Option<Value>>>,
    /// Refused files, with reasons.
    pub(super) refused: Vec<(String, String)>,
}

/// The journal file. Only the positions of the lines are kept in memory, because the lines
/// themselves may take too much memory.
pub(super) struct Journal {
    path: PathBuf,
    specs: Vec<ColumnSpec>,
    inner: Mutex<Inner>,
}

struct Inner {
    file: File,
    /// Position (bytes) in the file at which the next line is written.
    length: u64,
    lines: BTreeMap<String, Line>,
}

impl Inner {
    fn append(&mut self, text: &str) -> anyhow::Result<()> {
        self.file.seek(SeekFrom::Start(self.length)).map_err(input::plain)?;
        if let Err(error) = self.file.write_all(text.as_bytes()) {
            // The disk may be full. If even truncating fails, the incomplete line counts as not
            // done.
            let _ = self.file.set_len(self.length);
            return Err(input::plain(error));
        }
        self.length += text.len() as u64;
        Ok(())
    }
}

/// Data of the journal about a record: the fingerprint of the files of the record, `true` if the record was measured,
/// and the position (bytes) of the last journal line about the record.
#[derive(Clone, Copy)]
struct Line {
    hash: u64,
    measured: bool,
    at: u64,
}

impl Journal {
    /// Opens the journal of a folder, or creates it.
    ///
    /// If the last line is incomplete, as left by a killed process, its record counts as unfinished.
    pub(super) fn open(out: &Path, settings: &str, specs: &[ColumnSpec]) -> anyhow::Result<Self> {
        let path = out.join("rows.jsonl");
        let cannot = |what: &str| format!("cannot {what} {}", path.display());
        let names: Vec<String> = specs.iter().map(ColumnSpec::heading).collect();
        let version = env!("CARGO_PKG_VERSION");
        let head = json!({ "barrelstack": version, "settings": settings, "columns": names });
        let file =
            system::open_to_change(&path).map_err(input::plain).with_context(|| cannot("write"))?;
        // On file systems without locks, another command that writes to the same folder is not detected.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let out = out.display();
            bail!("another command is working in {out}: wait for it, or give another folder");
        }
        let head = format!("{head}\n");
        let (mut at, mut lines) = (0, BTreeMap::new());
        let mut reader = BufReader::new(&file);
        let mut line = Vec::new();
        loop {
            line.clear();
            let read = reader.read_until(b'\n', &mut line).map_err(input::plain);
            let read = read.with_context(|| cannot("read"))? as u64;
            let found = serde_json::from_slice::<serde_json::Value>(&line).ok();
            // An incomplete first line, as left by a killed process, also belongs to this program.
            if at == 0 && !head.as_bytes().starts_with(&line) {
                let ours = found.as_ref().is_some_and(|first| first["settings"].is_string());
                let whose = if ours {
                    "the table of another command, of the same command with other options, or of another version"
                } else {
                    "a rows.jsonl of another program"
                };
                bail!(
                    "{} contains {whose}: give another folder, or remove rows.jsonl there",
                    out.display()
                );
            }
            if !line.ends_with(b"\n") {
                break;
            }
            if let Some(entry) = found.and_then(|found| JournalEntry::of(&found, specs)) {
                let measured = entry.row.is_some();
                lines.insert(entry.record, Line { hash: entry.hash, measured, at });
            }
            at += read;
        }
        file.set_len(at).map_err(input::plain).with_context(|| cannot("write"))?;
        let specs = specs.to_vec();
        let mut inner = Inner { file, length: at, lines };
        if at == 0 {
            inner.append(&head).with_context(|| cannot("write"))?;
        }
        Ok(Self { path, specs, inner: Mutex::new(inner) })
    }

    /// Returns `true` if a record is in the journal and was measured, `false` if the record was
    /// refused; `None` if the record is not in the journal, or if its files have changed.
    pub(super) fn known(&self, record: &str, hash: u64) -> Option<bool> {
        let inner = self.inner.lock().ok()?;
        inner.lines.get(record).filter(|line| line.hash == hash).map(|line| line.measured)
    }

    /// Adds a finished record.
    pub(super) fn note(&self, entry: &JournalEntry) -> anyhow::Result<()> {
        let text = format!("{}\n", entry.line());
        let Ok(mut inner) = self.inner.lock() else { bail!("another thread failed to write") };
        let line = Line { hash: entry.hash, measured: entry.row.is_some(), at: inner.length };
        inner.append(&text).with_context(|| format!("cannot write {}", self.path.display()))?;
        inner.lines.insert(entry.record.clone(), line);
        Ok(())
    }

    /// Reads the entry of a record.
    pub(super) fn entry(&self, record: &str) -> anyhow::Result<JournalEntry> {
        let damaged = || {
            format!(
                "{} was changed while the command was running: run the command again",
                self.path.display()
            )
        };
        let Ok(inner) = self.inner.lock() else { bail!(damaged()) };
        let line = inner.lines.get(record).with_context(damaged)?;
        let mut reader = BufReader::new(&inner.file);
        reader.seek(SeekFrom::Start(line.at)).map_err(input::plain).with_context(damaged)?;
        let mut text = Vec::new();
        reader.read_until(b'\n', &mut text).map_err(input::plain).with_context(damaged)?;
        let found = serde_json::from_slice(&text).ok();
        let entry = found.and_then(|found| JournalEntry::of(&found, &self.specs));
        entry.filter(|entry| entry.record == record).with_context(damaged)
    }
}

impl JournalEntry {
    fn line(&self) -> serde_json::Value {
        let value = |value: &Option<Value>| match value {
            None => serde_json::Value::Null,
            Some(Value::Integer(value)) => json!(value),
            Some(Value::Number(value)) => json!(value),
            Some(Value::Text(value)) => json!(value),
        };
        let row = self.row.as_ref().map(|row| row.iter().map(value).collect::<Vec<_>>());
        let mut line = json!({
            "record": self.record,
            "hash": format!("{:016x}", self.hash),
            "row": row,
            "refused": self.refused,
        });
        line["line"] = seal(&line).into();
        line
    }

    /// Parses a line. Returns `None` if its fingerprint does not match the rest of the line, or if its values do not
    /// match the columns.
    fn of(found: &serde_json::Value, specs: &[ColumnSpec]) -> Option<Self> {
        let mut bare = found.clone();
        let stated = bare.as_object_mut()?.remove("line")?;
        if stated.as_str() != Some(&seal(&bare)) {
            return None;
        }
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

/// Returns the fingerprint of a line, computed without the field of the fingerprint itself.
fn seal(line: &serde_json::Value) -> String {
    format!("{:016x}", fnv1a(line.to_string().as_bytes()))
}

/// Parses a value of the type of a column. Returns `Some(None)` for an empty cell, and `None` if the value has a
/// different type.
#[expect(clippy::option_option, reason = "a missing value is not the same as a wrong value")]
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
