//! Lists all values of an input file with their meanings and sources.

use crate::field::{Default, Field, Section};
use crate::quantity::Quantity;
use crate::reader::item_name;
use crate::tree::{Origin, Table, Value, parse_value};
use crate::writer::inline;

/// One value of an input file, with its meaning and source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Path as in an override, such as `interface.rack-ground.friction.coefficient`.
    pub path: String,
    /// Value, formatted as a string. Quantities are in SI units.
    pub value: String,
    /// Meaning of the field.
    pub help: &'static str,
    /// Source of the value.
    pub source: Source,
}

/// Source of a value. The table does not record whether a value was given or is a default. The source is therefore
/// inferred from the value and the default of its field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The value is written in the file, or in a file that it extends.
    Given,
    /// The value equals the default of the field.
    Default,
    /// The field has a derived default, which the string describes. The value is either this default, or was written
    /// in the file.
    Derived(&'static str),
}

impl Source {
    /// Describes the source in words.
    pub fn words(self) -> String {
        match self {
            Self::Given => "given".into(),
            Self::Default => "default".into(),
            Self::Derived(words) => format!("given or default ({})", words.replace('`', "")),
        }
    }
}

/// Lists every value of a table, in the order of the table. All defaults must be written out in the
/// table.
///
/// Items of lists are identified as in overrides: by their `name`, by the two names in their `between` field, or
/// else by their number from 1.
pub fn settings(table: &Table, section: &'static Section) -> Vec<Setting> {
    let mut settings = Vec::new();
    gather(&mut settings, table, section, "");
    settings
}

fn gather(list: &mut Vec<Setting>, table: &Table, section: &'static Section, path: &str) {
    for entry in &table.entries {
        let Some(field) = section.any_field(&entry.key) else { continue };
        let path =
            if path.is_empty() { entry.key.clone() } else { format!("{path}.{}", entry.key) };
        let inner = field.kind.section();
        match (&entry.node.value, inner) {
            (Value::Table(table), Some(inner)) => gather(list, table, inner, &path),
            (Value::Array(items), Some(inner)) => {
                for (at, item) in items.iter().enumerate() {
                    let Value::Table(table) = &item.value else { continue };
                    gather(list, table, inner, &format!("{path}.{}", item_name(item, at)));
                }
            }
            (value, _) => list.push(Setting {
                path,
                value: shown(value),
                help: field.help,
                source: source(field, value),
            }),
        }
    }
}

/// Formats a value without the quotes that it has in a file.
fn shown(value: &Value) -> String {
    if let Value::Text(text) = value { text.clone() } else { inline(value) }
}

fn source(field: &Field, value: &Value) -> Source {
    match field.default {
        Default::Value(default) if same(&parse_value(default, Origin::Default).value, value) => {
            Source::Default
        }
        Default::Derived(words) => Source::Derived(words),
        Default::Value(_) | Default::Required | Default::Nothing => Source::Given,
    }
}

/// Returns `true` if two values have the same meaning: quantities are compared in SI units, and an
/// integer equals a float with the same value.
fn same(a: &Value, b: &Value) -> bool {
    let number = |value: &Value| match value {
        Value::Integer(Some(value)) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        Value::Text(text) => Quantity::parse(text).ok().map(|quantity| quantity.value),
        Value::Integer(None) | Value::Flag(_) | Value::Date | Value::Array(_) | Value::Table(_) => {
            None
        }
    };
    match (number(a), number(b)) {
        // The conversion of a default to other units may change the last digit.
        (Some(a), Some(b)) => (a - b).abs() <= 1e-12 * a.abs().max(b.abs()),
        _ => shown(a) == shown(b),
    }
}
