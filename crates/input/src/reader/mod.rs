//! Reads a table field by field, according to its definition.

use std::cell::RefCell;

use crate::error::{InputError, Problem};
use crate::field::{Default, Field, Kind, Section, Variant};
pub use crate::names::nearest;
use crate::quantity::shorten;
use crate::tree::{Entry, Node, Origin, Sources, Table, Value};

mod values;

type Result<T> = std::result::Result<T, InputError>;

/// Reader of one table. Unknown and mutually exclusive keys are rejected when the reader is
/// created.
pub struct Reader<'a> {
    sources: &'a Sources,
    section: &'static Section,
    variant: Option<&'static Variant>,
    /// Dotted path of the table from the root; empty at the root.
    path: String,
    table: Option<&'a Table>,
    origin: Origin,
    read: RefCell<Vec<&'static str>>,
}

impl<'a> Reader<'a> {
    /// Opens a table for reading. If `table` is `None`, the table is absent and all its fields have
    /// their defaults. `origin` is the place that error messages state for the table.
    pub fn open(
        sources: &'a Sources,
        section: &'static Section,
        path: String,
        table: Option<&'a Table>,
        origin: Origin,
    ) -> Result<Self> {
        let read = RefCell::new(Vec::new());
        let mut reader = Self { sources, section, variant: None, path, table, origin, read };
        if let Some(variants) = &section.variants {
            let name = reader.catalog_name(variants.tag)?;
            reader.variant = variants.list.iter().find(|variant| variant.name == name);
        }
        reader.check_keys()?;
        reader.check_exclusive()?;
        Ok(reader)
    }

    fn check_keys(&self) -> Result<()> {
        let Some(table) = self.table else { return Ok(()) };
        let valid: Vec<&str> =
            self.section.fields_of(self.variant).map(|field| field.name).collect();
        let unknown = |entry: &&Entry| !valid.contains(&entry.key.as_str());
        if let Some(entry) = table.entries.iter().find(unknown) {
            let key = entry.key.as_str();
            let problem = match (&self.section.variants, self.variant) {
                (Some(variants), Some(variant)) if self.section.any_field(key).is_some() => {
                    let owners: Vec<String> = variants
                        .list
                        .iter()
                        .filter(|v| v.fields.iter().any(|field| field.name == key))
                        .map(|v| format!("\"{}\"", v.name))
                        .collect();
                    Problem::ForeignKey {
                        key: key.to_owned(),
                        section: self.label(),
                        tag: variants.tag.to_owned(),
                        variant: variant.name.to_owned(),
                        owners: either(&owners),
                        valid: owned(&valid),
                    }
                }
                _ => Problem::UnknownKey {
                    key: shorten(key),
                    section: self.label(),
                    nearest: nearest(key, &valid),
                    valid: owned(&valid),
                },
            };
            return Err(self.sources.error(entry.origin, problem));
        }
        Ok(())
    }

    fn check_exclusive(&self) -> Result<()> {
        let Some(table) = self.table else { return Ok(()) };
        for group in self.section.exclusive {
            let mut given = table.entries.iter().filter(|e| group.contains(&e.key.as_str()));
            if let (Some(first), Some(second)) = (given.next(), given.next()) {
                let problem = Problem::Exclusive {
                    section: self.label(),
                    first: first.key.clone(),
                    second: second.key.clone(),
                };
                return Err(self.sources.error(second.origin, problem));
            }
        }
        Ok(())
    }

    /// Consumes the reader. With debug assertions, checks that every defined field has been read.
    pub fn finish(self) {
        let read = self.read.borrow();
        for field in self.section.fields_of(self.variant) {
            debug_assert!(
                read.contains(&field.name),
                "field `{}` of {} is defined but never read",
                field.name,
                self.label()
            );
        }
    }

    /// Returns `true` if a field is given.
    pub fn has(&self, name: &str) -> bool {
        self.entry(name).is_some()
    }

    /// Returns `true` if a field is absent and its default is [`Default::Nothing`] or [`Default::Derived`].
    pub fn leaves_out(&self, name: &'static str) -> bool {
        !self.has(name)
            && matches!(self.field(name).default, Default::Nothing | Default::Derived(_))
    }

    /// Returns the name of the selected variant.
    pub fn chosen(&self) -> Result<&'static str> {
        let tag = self.section.variants.as_ref().map_or("", |variants| variants.tag);
        self.variant.map(|variant| variant.name).ok_or_else(|| self.missing(tag))
    }

    /// Returns the name of the table in messages, such as `[run]`.
    pub fn label(&self) -> String {
        if self.path.is_empty() {
            format!("the {}", self.section.name)
        } else {
            format!("[{}]", self.path)
        }
    }

    /// Returns the full path of a field, such as `run.step`.
    pub fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// Creates an error about a field, located at its value if the field is given, else at the
    /// table.
    pub fn error(&self, name: &str, problem: Problem) -> InputError {
        let origin = self.entry(name).map_or(self.origin, |node| node.origin);
        self.sources.error(origin, problem)
    }

    /// Creates an error located at an origin.
    pub fn error_at(&self, origin: Origin, problem: Problem) -> InputError {
        self.sources.error(origin, problem)
    }

    /// Creates an error about values that are valid by themselves but inconsistent with each other.
    pub fn inconsistent(&self, name: &str, message: String) -> InputError {
        self.error(name, Problem::Inconsistent { message })
    }

    /// Creates an error about the table as a whole.
    pub fn section_error(&self, problem: Problem) -> InputError {
        self.sources.error(self.origin, problem)
    }

    /// Creates an error stating that one of several fields is required, but none is given.
    pub fn one_of(&self, names: &[&str]) -> InputError {
        let choices: Vec<String> = names.iter().map(|name| self.example_of(name)).collect();
        let problem = Problem::OneOf { section: self.label(), choices: choices.join(", ") };
        self.sources.error(self.origin, problem)
    }

    fn example_of(&self, name: &str) -> String {
        self.section.any_field(name).map_or_else(String::new, Field::example)
    }

    /// Creates an error about a missing field.
    pub fn missing(&self, name: &str) -> InputError {
        let example = self.example_of(name);
        let problem = Problem::Missing { field: name.to_owned(), section: self.label(), example };
        self.sources.error(self.origin, problem)
    }

    /// Creates an error about a missing field whose kind depends on other fields. `kind` supplies
    /// the example value.
    pub fn missing_as(&self, name: &str, kind: Kind) -> InputError {
        let example = format!("`{name} = {}`", kind.example());
        let problem = Problem::Missing { field: name.to_owned(), section: self.label(), example };
        self.sources.error(self.origin, problem)
    }

    /// Returns the kind of value that a field accepts, and marks the field as read.
    pub fn kind_of(&self, name: &'static str) -> Kind {
        self.field(name).kind
    }

    fn entry(&self, name: &str) -> Option<&'a Node> {
        self.table.and_then(|table| table.get(name)).map(|entry| &entry.node)
    }

    /// Returns the definition of a field and marks the field as read. Panics if the field is not
    /// defined, which is a bug in this library.
    fn field(&self, name: &'static str) -> &'static Field {
        self.read.borrow_mut().push(name);
        let found = self.section.fields_of(self.variant).find(|field| field.name == name);
        found
            .unwrap_or_else(|| panic!("field `{name}` of {} is read but not defined", self.label()))
    }

    /// Opens a nested table. If the table is absent, all its fields have their defaults.
    pub fn section(&self, name: &'static str) -> Result<Self> {
        let field = self.field(name);
        let (Kind::Table(section) | Kind::ChoiceOrTable(_, _, section)) = field.kind else {
            self.defined_otherwise(name);
        };
        let path = self.path_of(name);
        match self.entry(name) {
            Some(node) => {
                let Value::Table(table) = &node.value else {
                    return Err(self.wrong_type(name, field.kind, node));
                };
                Self::open(self.sources, section, path, Some(table), node.origin)
            }
            None if matches!(field.default, Default::Required) => Err(self.missing(name)),
            None => Self::open(self.sources, section, path, None, self.origin),
        }
    }

    /// Marks a field as read, because another reader reads it.
    pub fn skip(&self, name: &'static str) {
        self.field(name);
    }

    /// Returns a required nested table without reading its fields, so that another reader can read them.
    pub fn table(&self, name: &'static str) -> Result<&'a Table> {
        let field = self.field(name);
        let Some(node) = self.entry(name) else { return Err(self.missing(name)) };
        let Value::Table(table) = &node.value else {
            return Err(self.wrong_type(name, field.kind, node));
        };
        Ok(table)
    }

    /// Returns the origin of a field, or of the table if the field is absent.
    pub fn origin_of(&self, name: &str) -> Origin {
        self.entry(name).map_or(self.origin, |node| node.origin)
    }

    /// Opens a nested table, if present.
    pub fn optional_section(&self, name: &'static str) -> Result<Option<Self>> {
        if self.has(name) {
            self.section(name).map(Some)
        } else {
            self.field(name);
            Ok(None)
        }
    }

    /// Opens each table of a list of tables.
    pub fn sections(&self, name: &'static str) -> Result<Vec<Self>> {
        let field = self.field(name);
        let Kind::Tables(section) = field.kind else { self.defined_otherwise(name) };
        let Some(node) = self.entry(name) else { return Ok(Vec::new()) };
        let Value::Array(items) = &node.value else {
            return Err(self.wrong_type(name, field.kind, node));
        };
        let mut readers = Vec::new();
        for (index, item) in items.iter().enumerate() {
            let path = self.path_of(&format!("{name}.{}", item_name(item, index)));
            let Value::Table(table) = &item.value else {
                return Err(self.wrong_type(name, field.kind, item));
            };
            readers.push(Self::open(self.sources, section, path, Some(table), item.origin)?);
        }
        Ok(readers)
    }

    /// Panics because a field is read as a kind that differs from its definition, which is a bug in this library.
    fn defined_otherwise(&self, name: &str) -> ! {
        panic!(
            "field `{name}` of {} is read as a kind that differs from its definition",
            self.label()
        )
    }
}

/// Returns the name of a list item in paths: the value of its `name` field; else the two names in its
/// `between` field, joined by a hyphen; else its number, counted from 1.
pub fn item_name(item: &Node, index: usize) -> String {
    let number = (index + 1).to_string();
    let Value::Table(table) = &item.value else { return number };
    if let Some(Value::Text(name)) = table.get("name").map(|entry| &entry.node.value) {
        return name.clone();
    }
    if let Some(Value::Array(pair)) = table.get("between").map(|entry| &entry.node.value)
        && let [Node { value: Value::Text(a), .. }, Node { value: Value::Text(b), .. }] =
            pair.as_slice()
    {
        return format!("{a}-{b}");
    }
    number
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Joins words with commas, and the last two words with "or".
fn either(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} or {last}", others.join(", ")),
    }
}
