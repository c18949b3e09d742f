//! Writes a table field by field, according to its definition.

use std::fmt::Write as _;

use crate::dimension::Dimension;
use crate::field::{Field, Kind, Named, Section, Variant};
use crate::quantity::{Quantity, plain};
use crate::tree::{Entry, Node, Origin, Table, Value};

/// Writer of one table, the counterpart of [`Reader`](crate::reader::Reader).
pub struct Writer {
    section: &'static Section,
    variant: Option<&'static Variant>,
    table: Table,
    written: Vec<&'static str>,
}

impl Writer {
    /// Creates a writer for a table without variants.
    pub fn new(section: &'static Section) -> Self {
        debug_assert!(section.variants.is_none(), "the variant must be named");
        Self { section, variant: None, table: Table::default(), written: Vec::new() }
    }

    /// Creates a writer for a variant of a table and writes the tag field, which selects the
    /// variant.
    pub fn variant<T: Named>(section: &'static Section, tag: T) -> Self {
        Self::chosen(section, tag.name())
    }

    /// Creates a writer for the variant with the given name and writes the tag field.
    pub fn chosen(section: &'static Section, name: &'static str) -> Self {
        let variants = section.variants.as_ref();
        let variant = variants.and_then(|v| v.list.iter().find(|v| v.name == name));
        debug_assert!(variant.is_some(), "the section has no variant \"{name}\"");
        let mut writer = Self { section, variant, table: Table::default(), written: Vec::new() };
        if let Some(variants) = variants {
            writer.put(variants.tag, Value::Text(name.to_owned()));
        }
        writer
    }

    /// Returns the table. With debug assertions, checks that every defined field has been written
    /// or omitted.
    pub fn finish(self) -> Table {
        for field in self.section.fields_of(self.variant) {
            debug_assert!(self.written.contains(&field.name), "`{}` was forgotten", field.name);
        }
        self.table
    }

    fn field(&mut self, name: &'static str) -> &'static Field {
        self.written.push(name);
        let found = self.section.fields_of(self.variant).find(|field| field.name == name);
        found.unwrap_or_else(|| panic!("field `{name}` is written but not defined"))
    }

    /// Returns the kind of value that a field accepts, and marks the field as written.
    pub fn kind_of(&mut self, name: &'static str) -> Kind {
        self.field(name).kind
    }

    fn put(&mut self, name: &'static str, value: Value) {
        self.field(name);
        let node = Node { origin: Origin::Default, value };
        self.table.entries.push(Entry { key: name.to_owned(), origin: Origin::Default, node });
    }

    /// Marks fields as intentionally omitted, because they have no value or other fields replace them.
    pub fn omit(&mut self, names: &[&'static str]) {
        self.written.extend(names);
    }

    /// Writes a quantity, in the SI unit of the field's first dimension.
    pub fn quantity(&mut self, name: &'static str, value: f64) {
        let kind = self.field(name).kind;
        let dimension = if let Kind::Quantity(dimensions, _) | Kind::WordOr(_, dimensions, _) = kind
        {
            dimensions[0]
        } else if let Kind::Unit(dimension) = kind {
            dimension
        } else {
            panic!("field `{name}` is not a quantity")
        };
        self.quantity_in(name, value, dimension);
    }

    /// Writes a quantity, in the SI unit of the given dimension.
    pub fn quantity_in(&mut self, name: &'static str, value: f64, dimension: Dimension) {
        self.put(name, Value::Text(Quantity { value, dimension }.to_string()));
    }

    /// Writes a value by calling `write`; omits the field if the value is `None`.
    pub fn optional<T>(
        &mut self,
        name: &'static str,
        value: Option<T>,
        write: impl FnOnce(&mut Self, &'static str, T),
    ) {
        match value {
            Some(value) => write(self, name, value),
            None => self.omit(&[name]),
        }
    }

    /// Writes a quantity; omits the field if the quantity is `None`.
    pub fn optional_quantity(&mut self, name: &'static str, value: Option<f64>) {
        self.optional(name, value, Self::quantity);
    }

    /// Writes a quantity, or the word given in [`Kind::WordOr`] if the quantity is `None`.
    pub fn word_or_quantity(&mut self, name: &'static str, value: Option<f64>) {
        match (value, self.field(name).kind) {
            (Some(value), _) => self.quantity(name, value),
            (None, Kind::WordOr(word, ..)) => self.text(name, word),
            (None, _) => panic!("field `{name}` has no word"),
        }
    }

    /// Writes a plain number.
    pub fn number(&mut self, name: &'static str, value: f64) {
        self.put(name, Value::Float(value));
    }

    /// Writes an integer.
    pub fn integer(&mut self, name: &'static str, value: u32) {
        self.put(name, Value::Integer(Some(i64::from(value))));
    }

    /// Writes `true` or `false`.
    pub fn flag(&mut self, name: &'static str, value: bool) {
        self.put(name, Value::Flag(value));
    }

    /// Writes a string.
    pub fn text(&mut self, name: &'static str, value: &str) {
        self.put(name, Value::Text(value.to_owned()));
    }

    /// Writes a string; omits the field if the string is `None`.
    pub fn optional_text(&mut self, name: &'static str, value: Option<&str>) {
        self.optional(name, value, Self::text);
    }

    /// Writes the name of a value of type `T`.
    pub fn choice<T: Named>(&mut self, name: &'static str, value: T) {
        self.text(name, value.name());
    }

    /// Writes a list of two strings.
    pub fn pair(&mut self, name: &'static str, value: &[String; 2]) {
        self.put(name, Value::Array(value.iter().map(|v| node(Value::Text(v.clone()))).collect()));
    }

    /// Writes a point as a list of two quantities.
    pub fn point(&mut self, name: &'static str, value: [f64; 2]) {
        self.list(name, value);
    }

    /// Writes a list of three quantities.
    pub fn triple(&mut self, name: &'static str, value: [f64; 3]) {
        self.list(name, value);
    }

    fn list<const N: usize>(&mut self, name: &'static str, value: [f64; N]) {
        let (Kind::Point(dimension) | Kind::Triple(dimension)) = self.field(name).kind else {
            panic!("field `{name}` is not a list of quantities")
        };
        self.put(name, point(value, dimension));
    }

    /// Writes a list of points.
    pub fn points(&mut self, name: &'static str, values: &[[f64; 2]]) {
        let Kind::Points(dimension) = self.field(name).kind else {
            panic!("field `{name}` is not a list of points")
        };
        self.put(name, Value::Array(values.iter().map(|v| node(point(*v, dimension))).collect()));
    }

    /// Writes a nested table.
    pub fn table(&mut self, name: &'static str, table: Table) {
        self.put(name, Value::Table(table));
    }

    /// Writes a list of tables; an empty list is omitted.
    pub fn tables(&mut self, name: &'static str, tables: Vec<Table>) {
        if tables.is_empty() {
            self.omit(&[name]);
        } else {
            let tables = tables.into_iter().map(|table| node(Value::Table(table)));
            self.put(name, Value::Array(tables.collect()));
        }
    }
}

fn node(value: Value) -> Node {
    Node { origin: Origin::Default, value }
}

fn point<const N: usize>(value: [f64; N], dimension: Dimension) -> Value {
    let text = |value| node(Value::Text(Quantity { value, dimension }.to_string()));
    Value::Array(value.map(text).into())
}

/// Formats a table as TOML: first the values, then the nested tables, each group in the order of
/// the table.
pub fn to_toml(table: &Table) -> String {
    let mut text = String::new();
    write_table(&mut text, table, "");
    text
}

fn is_table(value: &Value) -> bool {
    matches!(value, Value::Table(_)) || tables_of(value).is_some()
}

/// Returns the items of a list of tables, or `None` if the value is not such a list.
fn tables_of(value: &Value) -> Option<Vec<&Table>> {
    let Value::Array(items) = value else { return None };
    items
        .iter()
        .map(|item| if let Value::Table(table) = &item.value { Some(table) } else { None })
        .collect()
}

/// Writes a table. Writing to a `String` cannot fail, so the results of `writeln!` are ignored.
fn write_table(text: &mut String, table: &Table, path: &str) {
    for entry in table.entries.iter().filter(|entry| !is_table(&entry.node.value)) {
        let _ = writeln!(text, "{} = {}", entry.key, inline(&entry.node.value));
    }
    for entry in &table.entries {
        let path =
            if path.is_empty() { entry.key.clone() } else { format!("{path}.{}", entry.key) };
        if let Value::Table(table) = &entry.node.value {
            // A table that contains only tables needs no header.
            let bare = !table.entries.is_empty()
                && table.entries.iter().all(|entry| is_table(&entry.node.value));
            if !bare {
                let _ = writeln!(text, "\n[{path}]");
            }
            write_table(text, table, &path);
        }
        for table in tables_of(&entry.node.value).into_iter().flatten() {
            let _ = writeln!(text, "\n[[{path}]]");
            write_table(text, table, &path);
        }
    }
}

/// Formats a value as TOML on one line.
pub fn inline(value: &Value) -> String {
    match value {
        Value::Text(text) => quote(text),
        Value::Integer(value) => value.unwrap_or_default().to_string(),
        Value::Float(value) => {
            let text = plain(*value);
            // TOML distinguishes a float from an integer by the decimal point or the exponent.
            if text.contains(['.', 'e']) { text } else { format!("{text}.0") }
        }
        Value::Flag(value) => value.to_string(),
        Value::Date => String::new(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| inline(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entries: Vec<String> = table
                .entries
                .iter()
                .map(|entry| format!("{} = {}", entry.key, inline(&entry.node.value)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

fn quote(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
