//! Reads one table of a scenario field by field, as its definition says.

use std::cell::RefCell;

use super::dimension::Dimension;
use super::error::{Problem, ScenarioError};
use super::field::{Default, Field, Kind, Named, Range, Section, Variant};
use super::motion::FileRef;
use super::quantity::{Quantity, QuantityError, plain, shorten};
use super::tree::{Node, Origin, Sources, Table, Value, parse_value};

type Result<T> = std::result::Result<T, ScenarioError>;

/// One table of a scenario, checked for unknown and conflicting keys.
pub(super) struct Reader<'a> {
    sources: &'a Sources,
    section: &'static Section,
    variant: Option<&'static Variant>,
    /// Dotted path from the root; empty at the root.
    path: String,
    table: Option<&'a Table>,
    origin: Origin,
    seen: RefCell<Vec<&'static str>>,
}

impl<'a> Reader<'a> {
    /// Opens a table, or the place where it would be.
    pub(super) fn open(
        sources: &'a Sources,
        section: &'static Section,
        path: String,
        table: Option<&'a Table>,
        origin: Origin,
    ) -> Result<Self> {
        let seen = RefCell::new(Vec::new());
        let mut reader = Self { sources, section, variant: None, path, table, origin, seen };
        if let Some(variants) = &section.variants {
            let name = reader.any_text(variants.tag)?;
            reader.variant = variants.list.iter().find(|variant| variant.name == name);
        }
        reader.check_keys()?;
        reader.check_exclusive()?;
        Ok(reader)
    }

    fn check_keys(&self) -> Result<()> {
        let Some(table) = self.table else { return Ok(()) };
        for entry in &table.entries {
            let key = entry.key.as_str();
            if self.section.fields_of(self.variant).any(|field| field.name == key) {
                continue;
            }
            let valid: Vec<&str> =
                self.section.fields_of(self.variant).map(|field| field.name).collect();
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
                        owners: owners.join(" and "),
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

    /// Ends the reading: in builds with assertions, every defined field must have been read.
    pub(super) fn finish(self) {
        let seen = self.seen.borrow();
        for field in self.section.fields_of(self.variant) {
            debug_assert!(
                seen.contains(&field.name),
                "field `{}` of {} is defined but never read",
                field.name,
                self.label()
            );
        }
    }

    /// Whether a field is given.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entry(name).is_some()
    }

    /// The section as users know it.
    pub(super) fn label(&self) -> String {
        if self.path.is_empty() { "the scenario".to_owned() } else { format!("[{}]", self.path) }
    }

    /// The full path of a field.
    pub(super) fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// An error about a field, placed at its value when it has one.
    pub(super) fn error(&self, name: &str, problem: Problem) -> ScenarioError {
        let origin = self.entry(name).map_or(self.origin, |node| node.origin);
        self.sources.error(origin, problem)
    }

    /// Values that are fine alone and wrong together.
    pub(super) fn inconsistent(&self, name: &str, message: String) -> ScenarioError {
        self.error(name, Problem::Inconsistent { message })
    }

    /// An error about the table as a whole.
    pub(super) fn section_error(&self, problem: Problem) -> ScenarioError {
        self.sources.error(self.origin, problem)
    }

    /// None of several fields is given.
    pub(super) fn one_of(&self, names: &[&str]) -> ScenarioError {
        let choices: Vec<String> = names
            .iter()
            .map(|name| self.section.any_field(name).map_or_else(String::new, Field::example))
            .collect();
        let problem = Problem::OneOf { section: self.label(), choices: choices.join(", ") };
        self.sources.error(self.origin, problem)
    }

    /// A field that another value makes necessary is missing.
    pub(super) fn missing(&self, name: &str) -> ScenarioError {
        let example = self.section.any_field(name).map_or_else(String::new, Field::example);
        let problem = Problem::Missing { field: name.to_owned(), section: self.label(), example };
        self.sources.error(self.origin, problem)
    }

    fn entry(&self, name: &str) -> Option<&'a Node> {
        self.table.and_then(|table| table.get(name)).map(|entry| &entry.node)
    }

    /// The definition of a field; a name without one is a bug in this library.
    fn field(&self, name: &'static str) -> &'static Field {
        self.seen.borrow_mut().push(name);
        let found = self.section.fields_of(self.variant).find(|field| field.name == name);
        found
            .unwrap_or_else(|| panic!("field `{name}` of {} is read but not defined", self.label()))
    }

    fn value<T>(
        &self,
        name: &'static str,
        read: impl Fn(&Self, &Field, &Node) -> Result<T>,
    ) -> Result<Option<T>> {
        let field = self.field(name);
        match (self.entry(name), field.default) {
            (Some(node), _) => read(self, field, node).map(Some),
            (None, Default::Value(text)) => {
                read(self, field, &parse_value(text, Origin::Default)).map(Some)
            }
            (None, Default::Required) => Err(self.missing(name)),
            (None, Default::Nothing | Default::Derived(_)) => Ok(None),
        }
    }

    fn required<T>(&self, name: &'static str, value: Option<T>) -> Result<T> {
        value.ok_or_else(|| self.missing(name))
    }

    /// A quantity in SI.
    pub(super) fn quantity(&self, name: &'static str) -> Result<f64> {
        let value = self.optional_quantity(name)?;
        self.required(name, value)
    }

    /// A quantity in SI that may be absent.
    pub(super) fn optional_quantity(&self, name: &'static str) -> Result<Option<f64>> {
        Ok(self.optional_quantity_with_dimension(name)?.map(|quantity| quantity.value))
    }

    /// A quantity whose dimension tells what it means.
    pub(super) fn optional_quantity_with_dimension(
        &self,
        name: &'static str,
    ) -> Result<Option<Quantity>> {
        self.value(name, |reader, field, node| match field.kind {
            Kind::Quantity(dimensions, range) => {
                reader.read_quantity(name, node, dimensions, range)
            }
            Kind::Unit(dimension) => reader.read_unit(name, node, dimension),
            _ => reader.defined_otherwise(name),
        })
    }

    /// A quantity, or `None` for the word that stands in its place.
    pub(super) fn word_or_quantity(&self, name: &'static str) -> Result<Option<f64>> {
        let value = self.value(name, |reader, field, node| match (field.kind, &node.value) {
            (Kind::WordOr(word, ..), Value::Text(text)) if text == word => Ok(None),
            (Kind::WordOr(_, dimensions, range), _) => {
                reader.read_quantity(name, node, dimensions, range).map(|q| Some(q.value))
            }
            _ => reader.defined_otherwise(name),
        })?;
        Ok(value.flatten())
    }

    /// A plain number.
    pub(super) fn number(&self, name: &'static str) -> Result<f64> {
        let value = self.optional_number(name)?;
        self.required(name, value)
    }

    /// A plain number that may be absent.
    pub(super) fn optional_number(&self, name: &'static str) -> Result<Option<f64>> {
        self.value(name, |reader, field, node| {
            let Kind::Number(range) = field.kind else { reader.defined_otherwise(name) };
            let value = match &node.value {
                Value::Integer(Some(value)) => *value as f64,
                Value::Float(value) => *value,
                Value::Text(text) => match Quantity::parse_as(text, &[Dimension::NONE]) {
                    Ok(quantity) => quantity.value,
                    Err(_) => return Err(reader.wrong_type(name, field.kind, node)),
                },
                Value::Integer(None)
                | Value::Flag(_)
                | Value::Date
                | Value::Array(_)
                | Value::Table(_) => return Err(reader.wrong_type(name, field.kind, node)),
            };
            reader.in_range(name, node, range, value, "", &node.value.describe())?;
            Ok(value)
        })
    }

    /// An integer in its range.
    pub(super) fn integer(&self, name: &'static str) -> Result<u32> {
        let value = self.optional_integer(name)?;
        self.required(name, value)
    }

    /// An integer that may be absent.
    pub(super) fn optional_integer(&self, name: &'static str) -> Result<Option<u32>> {
        self.value(name, |reader, field, node| {
            let Kind::Integer(least, greatest) = field.kind else {
                reader.defined_otherwise(name);
            };
            let Value::Integer(value) = node.value else {
                return Err(reader.wrong_type(name, field.kind, node));
            };
            value
                .filter(|value| (least..=greatest).contains(value))
                .and_then(|value| u32::try_from(value).ok())
                .ok_or_else(|| {
                    let problem = Problem::OutOfRange {
                        field: reader.path_of(name),
                        range: field.kind.to_string(),
                        found: node.value.describe(),
                    };
                    reader.sources.error(node.origin, problem)
                })
        })
    }

    /// `true` or `false`.
    pub(super) fn flag(&self, name: &'static str) -> Result<bool> {
        let value = self.optional_flag(name)?;
        self.required(name, value)
    }

    /// `true` or `false`, or absent.
    pub(super) fn optional_flag(&self, name: &'static str) -> Result<Option<bool>> {
        self.value(name, |reader, field, node| match node.value {
            Value::Flag(value) => Ok(value),
            _ => Err(reader.wrong_type(name, field.kind, node)),
        })
    }

    /// Text.
    pub(super) fn text(&self, name: &'static str) -> Result<String> {
        let value = self.optional_text(name)?;
        self.required(name, value)
    }

    /// Text that may be absent; `false` counts as absent where the field allows it.
    pub(super) fn optional_text(&self, name: &'static str) -> Result<Option<String>> {
        let value = self.value(name, |reader, field, node| {
            let text = match (&node.value, field.kind) {
                (Value::Text(text), _) => text.clone(),
                (Value::Integer(Some(value)), Kind::Label) => value.to_string(),
                (Value::Flag(false), Kind::TextOrFalse) => return Ok(None),
                _ => return Err(reader.wrong_type(name, field.kind, node)),
            };
            if text.trim().is_empty() {
                let message = format!(
                    "`{}` is empty; give a text or leave the field out",
                    reader.path_of(name)
                );
                return Err(reader.sources.error(node.origin, Problem::Inconsistent { message }));
            }
            Ok(Some(text))
        })?;
        Ok(value.flatten())
    }

    /// A file, relative to the file that names it.
    pub(super) fn file(&self, name: &'static str) -> Result<Option<FileRef>> {
        let Some(path) = self.optional_text(name)? else { return Ok(None) };
        let folder = match self.entry(name).map(|node| node.origin) {
            Some(Origin::File { file, .. }) => self.sources.files[file].folder.clone(),
            Some(Origin::Override(_) | Origin::Whole(_) | Origin::Default) | None => {
                std::path::PathBuf::new()
            }
        };
        Ok(Some(FileRef { path, folder }))
    }

    /// A member of a closed set.
    pub(super) fn choice<T: Named>(&self, name: &'static str) -> Result<T> {
        let value = self.optional_choice(name)?;
        self.required(name, value)
    }

    /// A member of a closed set that may be absent.
    pub(super) fn optional_choice<T: Named>(&self, name: &'static str) -> Result<Option<T>> {
        self.value(name, |reader, _, node| {
            let text = reader.read_name(name, node, &super::field::names::<T>())?;
            let found = T::NAMES.iter().find(|(known, _)| *known == text);
            found.map(|(_, member)| *member).ok_or_else(|| reader.missing(name))
        })
    }

    /// A name of a list.
    pub(super) fn catalog_name(&self, name: &'static str) -> Result<String> {
        let value = self.optional_catalog_name(name)?;
        self.required(name, value)
    }

    /// A name of a list that may be absent.
    pub(super) fn optional_catalog_name(&self, name: &'static str) -> Result<Option<String>> {
        self.value(name, |reader, field, node| match field.kind {
            Kind::Choice(names) => reader.read_name(name, node, &names()),
            _ => reader.defined_otherwise(name),
        })
    }

    /// The value of the field that chooses a variant.
    fn any_text(&self, name: &'static str) -> Result<String> {
        self.catalog_name(name)
    }

    /// Two texts.
    pub(super) fn pair(&self, name: &'static str) -> Result<[String; 2]> {
        let value = self.value(name, |reader, field, node| {
            if let Value::Array(items) = &node.value
                && let [a, b] = items.as_slice()
                && let (Value::Text(a), Value::Text(b)) = (&a.value, &b.value)
            {
                return Ok([a.clone(), b.clone()]);
            }
            Err(reader.wrong_type(name, field.kind, node))
        })?;
        self.required(name, value)
    }

    /// Two quantities.
    pub(super) fn optional_point(&self, name: &'static str) -> Result<Option<[f64; 2]>> {
        self.value(name, |reader, field, node| {
            let Kind::Point(dimension) = field.kind else { reader.defined_otherwise(name) };
            reader.read_point(name, node, dimension, field.kind)
        })
    }

    /// Two quantities.
    pub(super) fn point(&self, name: &'static str) -> Result<[f64; 2]> {
        let value = self.optional_point(name)?;
        self.required(name, value)
    }

    /// A list of points.
    pub(super) fn points(&self, name: &'static str) -> Result<Vec<[f64; 2]>> {
        let value = self.value(name, |reader, field, node| {
            let Kind::Points(dimension) = field.kind else { reader.defined_otherwise(name) };
            let Value::Array(items) = &node.value else {
                return Err(reader.wrong_type(name, field.kind, node));
            };
            items
                .iter()
                .map(|item| reader.read_point(name, item, dimension, Kind::Point(dimension)))
                .collect()
        })?;
        self.required(name, value)
    }

    /// A table inside this one; one that is absent has only defaults.
    pub(super) fn section(&self, name: &'static str) -> Result<Self> {
        let field = self.field(name);
        let (Kind::Table(section) | Kind::ChoiceOrTable(_, _, section)) = field.kind else {
            self.defined_otherwise(name);
        };
        let path = self.path_of(name);
        match self.entry(name) {
            Some(node) => match &node.value {
                Value::Table(table) => {
                    Self::open(self.sources, section, path, Some(table), node.origin)
                }
                _ => Err(self.wrong_type(name, field.kind, node)),
            },
            None if matches!(field.default, Default::Required) => Err(self.missing(name)),
            None => Self::open(self.sources, section, path, None, self.origin),
        }
    }

    /// A table inside this one that may be absent.
    pub(super) fn optional_section(&self, name: &'static str) -> Result<Option<Self>> {
        if self.has(name) {
            self.section(name).map(Some)
        } else {
            self.field(name);
            Ok(None)
        }
    }

    /// A list of tables.
    pub(super) fn sections(&self, name: &'static str) -> Result<Vec<Self>> {
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

    fn read_name(&self, name: &str, node: &Node, valid: &[&'static str]) -> Result<String> {
        let Value::Text(text) = &node.value else {
            return Err(self.wrong_type(name, Kind::Text, node));
        };
        if valid.contains(&text.as_str()) {
            return Ok(text.clone());
        }
        let problem = Problem::UnknownName {
            field: self.path_of(name),
            found: shorten(text),
            nearest: nearest(text, valid),
            valid: owned(valid),
        };
        Err(self.sources.error(node.origin, problem))
    }

    fn read_point(&self, name: &str, node: &Node, d: Dimension, kind: Kind) -> Result<[f64; 2]> {
        if let Value::Array(items) = &node.value
            && let [x, z] = items.as_slice()
        {
            let read = |node| self.read_quantity(name, node, &[d], Range::ANY).map(|q| q.value);
            return Ok([read(x)?, read(z)?]);
        }
        Err(self.wrong_type(name, kind, node))
    }

    fn read_quantity(
        &self,
        name: &str,
        node: &Node,
        dimensions: &[Dimension],
        range: Range,
    ) -> Result<Quantity> {
        let example = dimensions[0].example();
        let kind = "a quantity with its unit";
        match &node.value {
            Value::Text(text) => {
                let quantity = Quantity::parse_as(text, dimensions).map_err(|reason| {
                    let unit = unit_of(&example);
                    let example = match reason {
                        QuantityError::NoUnit { .. } => format!("\"{} {unit}\"", text.trim()),
                        _ => format!("\"{example}\""),
                    };
                    let field = self.path_of(name);
                    self.sources.error(node.origin, Problem::Quantity { field, reason, example })
                })?;
                let unit = quantity.dimension.si_unit();
                let found = format!("\"{}\"", shorten(text));
                self.in_range(name, node, range, quantity.value, &unit, &found)?;
                Ok(quantity)
            }
            Value::Integer(Some(_)) | Value::Float(_) => {
                let found = node.value.describe();
                let number = match node.value {
                    Value::Integer(Some(value)) => value.to_string(),
                    Value::Float(value) if value.is_finite() => plain(value),
                    _ => return Err(self.wrong_type_as(name, kind, node)),
                };
                let example = format!("`{name} = \"{number} {}\"`", unit_of(&example));
                let problem = Problem::BareNumber { field: self.path_of(name), found, example };
                Err(self.sources.error(node.origin, problem))
            }
            Value::Integer(None)
            | Value::Flag(_)
            | Value::Date
            | Value::Array(_)
            | Value::Table(_) => Err(self.wrong_type_as(name, kind, node)),
        }
    }

    /// A unit alone counts as one of it.
    fn read_unit(&self, name: &str, node: &Node, dimension: Dimension) -> Result<Quantity> {
        if let Value::Text(text) = &node.value
            && let Ok(quantity) = Quantity::parse_as(&format!("1 {text}"), &[dimension])
        {
            return Ok(quantity);
        }
        self.read_quantity(name, node, &[dimension], Range::POSITIVE)
    }

    fn in_range(
        &self,
        name: &str,
        node: &Node,
        range: Range,
        value: f64,
        unit: &str,
        found: &str,
    ) -> Result<()> {
        if range.contains(value) {
            return Ok(());
        }
        let problem = Problem::OutOfRange {
            field: self.path_of(name),
            range: range.describe(unit),
            found: found.to_owned(),
        };
        Err(self.sources.error(node.origin, problem))
    }

    fn wrong_type(&self, name: &str, kind: Kind, node: &Node) -> ScenarioError {
        self.wrong_type_as(name, &kind.to_string(), node)
    }

    fn wrong_type_as(&self, name: &str, expected: &str, node: &Node) -> ScenarioError {
        let problem = Problem::WrongType {
            field: self.path_of(name),
            expected: expected.to_owned(),
            found: node.value.describe(),
        };
        self.sources.error(node.origin, problem)
    }

    /// A field read as another kind than its definition says is a bug in this library.
    fn defined_otherwise(&self, name: &str) -> ! {
        panic!("field `{name}` of {} is defined as another kind than it is read", self.label())
    }
}

/// How an item of a list is called in paths: its name, the pair it joins, or its number from 1.
pub(super) fn item_name(item: &Node, index: usize) -> String {
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

fn unit_of(example: &str) -> &str {
    example.split_once(' ').map_or("", |(_, unit)| unit)
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// The name that looks most like a word, if any comes close.
pub(super) fn nearest(word: &str, valid: &[&str]) -> Option<String> {
    if word.len() > 60 {
        return None;
    }
    let plain = |text: &str| text.to_lowercase().replace(['-', ' '], "_");
    let word = plain(word);
    valid
        .iter()
        .map(|name| (strsim::damerau_levenshtein(&word, &plain(name)), *name))
        .filter(|(distance, name)| *distance <= 1 + name.len().max(word.len()) / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name.to_owned())
        .or_else(|| {
            // A key that is part of the right one: `coefficient` for `static_coefficient`.
            let part = |name: &&&str| plain(name).contains(&word) || word.contains(&plain(name));
            valid.iter().filter(|_| word.len() >= 3).find(part).map(|name| (*name).to_owned())
        })
}
