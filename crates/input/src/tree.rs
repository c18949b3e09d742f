//! Parsed TOML in which every key and every value keeps its origin.

use std::borrow::Cow;
use std::ops::Range;
use std::path::PathBuf;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{InputError, Place, Problem};
use crate::writer;

/// The origin of a key or a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A byte range in a file.
    File {
        /// Index of the file in [`Sources`].
        file: usize,
        /// Offset of the first byte.
        start: usize,
        /// Offset of the byte after the range.
        end: usize,
    },
    /// A file as a whole, identified by its index in [`Sources`].
    Whole(usize),
    /// An override, identified by its index in [`Sources`].
    Override(usize),
    /// A default, which does not appear in any file.
    Default,
}

/// A value together with its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Origin of the value.
    pub origin: Origin,
    /// The value.
    pub value: Value,
}

/// A TOML value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A string.
    Text(String),
    /// An integer; `None` if it does not fit into 64 bits.
    Integer(Option<i64>),
    /// A number with a decimal point or an exponent.
    Float(f64),
    /// `true` or `false`.
    Flag(bool),
    /// A date or a time; no field accepts such a value.
    Date,
    /// A list.
    Array(Vec<Node>),
    /// A table.
    Table(Table),
}

impl Value {
    /// Describes the value for messages, such as `the number 3` or `a list`.
    pub fn describe(&self) -> String {
        match self {
            Self::Text(text) => format!("the text \"{}\"", crate::quantity::shorten(text)),
            Self::Integer(Some(value)) => format!("the number {value}"),
            Self::Integer(None) => "a number beyond 64 bits".to_owned(),
            Self::Float(value) => format!("the number {}", crate::quantity::plain(*value)),
            Self::Flag(value) => value.to_string(),
            Self::Date => "a date".to_owned(),
            Self::Array(_) => "a list".to_owned(),
            Self::Table(_) => "a table".to_owned(),
        }
    }
}

/// A key of a table together with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Origin of the key.
    pub origin: Origin,
    /// Value of the key.
    pub node: Node,
}

/// A table, with its keys in the order in which they are written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// The keys with their values.
    pub entries: Vec<Entry>,
}

impl Table {
    /// Returns the entry with the given key, or `None` if there is none.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// Returns a mutable reference to the entry with the given key, or `None` if there is none.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }

    /// Replaces the entry with the same key, or appends the entry.
    pub fn set(&mut self, entry: Entry) {
        match self.get_mut(&entry.key) {
            Some(old) => *old = entry,
            None => self.entries.push(entry),
        }
    }

    /// Removes the entry with the given key, if present.
    pub fn remove(&mut self, key: &str) {
        self.entries.retain(|entry| entry.key != key);
    }
}

/// A source file.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// File name that error messages show.
    pub name: String,
    /// Content of the file.
    pub text: String,
    /// Folder against which relative paths in the file are resolved.
    pub folder: PathBuf,
}

/// All input files and overrides, needed to locate errors.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// The files; an index into this list identifies a file.
    pub files: Vec<SourceFile>,
    /// The overrides, in the form `path=value`. For nested tables and lists, [`Sources::adopt`] adds only the path.
    pub overrides: Vec<String>,
}

impl Sources {
    /// Creates an error located at an origin.
    pub fn error(&self, origin: Origin, problem: Problem) -> InputError {
        InputError::new(problem, self.place(origin))
    }

    /// Returns the place of an origin, for error messages.
    pub fn place(&self, origin: Origin) -> Place {
        match origin {
            Origin::File { file, start, end } => {
                let source = &self.files[file];
                Place::in_text(&source.name, &source.text, start, end)
            }
            Origin::Whole(file) => Place::Whole { file: self.files[file].name.clone() },
            Origin::Override(index) => Place::Override { text: self.overrides[index].clone() },
            Origin::Default => Place::Unknown,
        }
    }

    /// Assigns an origin to every value of a table that a program has built and not parsed from text. Each value is
    /// recorded as an override, `path=value`; for a nested table or list, only the path is recorded. In the paths,
    /// items of lists are numbered from 1.
    pub fn adopt(&mut self, table: &mut Table) {
        self.adopt_below(table, "");
    }

    fn adopt_below(&mut self, table: &mut Table, above: &str) {
        for entry in &mut table.entries {
            let point = if above.is_empty() { "" } else { "." };
            let path = format!("{above}{point}{}", entry.key);
            self.adopt_node(&mut entry.node, &path);
            entry.origin = entry.node.origin;
        }
    }

    fn adopt_node(&mut self, node: &mut Node, path: &str) {
        let inner = matches!(node.value, Value::Table(_) | Value::Array(_));
        let text =
            if inner { path.to_owned() } else { format!("{path}={}", writer::inline(&node.value)) };
        node.origin = Origin::Override(self.overrides.len());
        self.overrides.push(text);
        match &mut node.value {
            Value::Table(table) => self.adopt_below(table, path),
            Value::Array(items) => {
                for (at, item) in items.iter_mut().enumerate() {
                    self.adopt_node(item, &format!("{path}.{}", at + 1));
                }
            }
            Value::Text(_) | Value::Integer(_) | Value::Float(_) | Value::Flag(_) | Value::Date => {
            }
        }
    }

    /// Parses the file with the given index.
    pub fn parse(&self, file: usize) -> Result<Table, InputError> {
        let text = &self.files[file].text;
        let origin = |span: Range<usize>| Origin::File { file, start: span.start, end: span.end };
        let document = DeTable::parse(text).map_err(|error| {
            let origin = error.span().map_or(Origin::Whole(file), origin);
            self.error(origin, Problem::Syntax { message: described(error.message()) })
        })?;
        Ok(convert_table(document.get_ref(), &origin))
    }
}

/// Returns the message of the parser, followed by advice.
fn described(message: &str) -> String {
    if message.contains("recurs") {
        "tables or arrays are nested too deeply; use fewer levels".to_owned()
    } else {
        message.replace('\n', ", ") + "; correct the text at this position"
    }
}

/// Parses the value of an override or a default as TOML. If `text` is not valid TOML, the value is `text` itself as a
/// string, without leading and trailing whitespace.
pub fn parse_value(text: &str, origin: Origin) -> Node {
    let trimmed = text.trim();
    DeValue::parse(trimmed).map_or_else(
        |_| Node { origin, value: Value::Text(trimmed.to_owned()) },
        |value| convert(&value, &|_| origin),
    )
}

/// Converts a parsed value; `origin` maps byte ranges to origins.
fn convert(value: &Spanned<DeValue<'_>>, origin: &dyn Fn(Range<usize>) -> Origin) -> Node {
    let span = value.span();
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => {
            Value::Integer(i64::from_str_radix(integer.as_str(), integer.radix()).ok())
        }
        // The parser has checked the syntax; a number that still cannot be parsed becomes NaN and
        // is later rejected.
        DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => {
            Value::Array(items.iter().map(|item| convert(item, origin)).collect())
        }
        DeValue::Table(table) => Value::Table(convert_table(table, origin)),
    };
    Node { origin: origin(span), value }
}

fn convert_table(table: &DeTable<'_>, origin: &dyn Fn(Range<usize>) -> Origin) -> Table {
    let mut written: Vec<_> = table.iter().collect();
    written.sort_by_key(|(key, _)| key.span().start);
    let entry = |(key, value): (&Spanned<_>, _)| Entry {
        key: Cow::to_string(key.get_ref()),
        origin: origin(key.span()),
        node: convert(value, origin),
    };
    Table { entries: written.into_iter().map(entry).collect() }
}
