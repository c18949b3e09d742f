//! Former keys of scenarios.
//!
//! Uncertain constants were formerly set in `[imperfections]`. Their former keys are still read, with a warning that
//! names the current key.

use super::error::{Problem, ScenarioError};
use super::tree::{Entry, Node, Origin, Sources, Table, Value};

/// Table that formerly held the keys in [`MOVED`].
const FORMER: &str = "imperfections";

/// Table that now holds the keys in [`MOVED`].
const PRESENT: &str = "unknowns";

/// Keys that moved from the table [`FORMER`] to the table [`PRESENT`] without a change of name.
const MOVED: [&str; 6] = [
    "friction",
    "friction_barrel_rack",
    "friction_ground",
    "stiffness",
    "impact_stiffness",
    "damping",
];

/// Former key that selected which kinds of differences are drawn.
const KIND: &str = "kind";

/// Values of the key [`KIND`], each with the equivalent values of `imperfections.drawn` and `unknowns.drawn`.
const KINDS: [(&str, [bool; 2]); 3] =
    [("hair", [true, false]), ("ignorance", [false, true]), ("both", [true, true])];

/// Replaces former keys by current keys, and returns a warning for each former key.
///
/// If a former key and the current key are set in different layers, the key in the upper layer applies: overrides take
/// precedence over the file, and the file over the files that it extends.
///
/// # Errors
/// If one file contains a former key together with the current one, or gives `kind` an unknown value.
pub(super) fn renew(table: &mut Table, sources: &Sources) -> Result<Vec<String>, ScenarioError> {
    let Some(Entry { node: Node { value: Value::Table(former), .. }, .. }) = table.get_mut(FORMER)
    else {
        return Ok(Vec::new());
    };
    let is_former = |entry: &Entry| entry.key == KIND || MOVED.contains(&entry.key.as_str());
    let found: Vec<Entry> =
        former.entries.iter().filter(|entry| is_former(entry)).cloned().collect();
    former.entries.retain(|entry| !is_former(entry));
    let mut warnings = Vec::new();
    for entry in found {
        let place = sources.place(entry.origin);
        let key = entry.key.clone();
        let advice = if key == KIND {
            let drawn = kinds(&entry, sources)?;
            for (section, drawn) in [FORMER, PRESENT].into_iter().zip(drawn) {
                let node = Node { value: Value::Flag(drawn), ..entry.node };
                put(table, section, Entry { key: "drawn".to_owned(), node, ..entry }, sources)?;
            }
            let off = [FORMER, PRESENT].into_iter().zip(drawn).find(|(_, drawn)| !drawn);
            off.map_or_else(
                || "omit this key".to_owned(),
                |(section, _)| format!("write `{section}.drawn = false`"),
            )
        } else {
            put(table, PRESENT, entry, sources)?;
            format!("write `{PRESENT}.{key}`")
        };
        warnings.push(format!(
            "{place}: `{FORMER}.{key}` is an old name, and a later version will reject it: {advice} instead"
        ));
    }
    Ok(warnings)
}

/// Returns the values of `imperfections.drawn` and `unknowns.drawn` that are equivalent to the value of an entry with
/// the key [`KIND`].
///
/// # Errors
/// If the value is none of those in [`KINDS`].
fn kinds(entry: &Entry, sources: &Sources) -> Result<[bool; 2], ScenarioError> {
    let known = KINDS.iter().find(|(name, _)| entry.node.value == Value::Text((*name).to_owned()));
    known.map(|(_, drawn)| *drawn).ok_or_else(|| {
        let message = format!(
            "`{FORMER}.{KIND}` is {}; this key of earlier versions accepts only \"both\", \"hair\" and \"ignorance\": \
             replace it by `{FORMER}.drawn` and `{PRESENT}.drawn`, which are true or false",
            entry.node.value.describe()
        );
        sources.error(entry.node.origin, Problem::Inconsistent { message })
    })
}

/// Adds an entry to a table of the scenario, unless a layer above the layer of the entry sets the same key.
///
/// # Errors
/// If the layer of the entry itself sets the same key.
fn put(
    table: &mut Table,
    section: &str,
    entry: Entry,
    sources: &Sources,
) -> Result<(), ScenarioError> {
    if table.get(section).is_none() {
        let node = Node { origin: entry.origin, value: Value::Table(Table::default()) };
        table.set(Entry { key: section.to_owned(), origin: entry.origin, node });
    }
    let Some(Entry { node: Node { value: Value::Table(inner), .. }, .. }) = table.get_mut(section)
    else {
        // The reader reports that this is not a table.
        return Ok(());
    };
    match inner.get(&entry.key).map(|known| layer(known.origin)) {
        Some(known) if known == layer(entry.origin) => {
            let message = format!(
                "`{section}.{}`, which replaces this key, is stated too; leave one of the two out",
                entry.key
            );
            Err(sources.error(entry.origin, Problem::Inconsistent { message }))
        }
        Some(known) if known > layer(entry.origin) => Ok(()),
        Some(_) | None => {
            inner.set(entry);
            Ok(())
        }
    }
}

/// Returns the layer of an origin as a sort key: the lowest layer comes first.
fn layer(origin: Origin) -> (u8, usize) {
    match origin {
        Origin::Default => (0, 0),
        Origin::File { file, .. } | Origin::Whole(file) => (1, usize::MAX - file),
        Origin::Override(index) => (2, index),
    }
}
