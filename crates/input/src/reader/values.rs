//! Reader methods for values such as quantities, numbers, names and points.

use crate::FileRef;
use crate::dimension::Dimension;
use crate::error::{InputError, Problem};
use crate::field::{Default, Field, Kind, Named, Range, example_in};
use crate::quantity::{Quantity, plain, shorten};
use crate::tree::{Node, Origin, Value, parse_value};

use super::{Reader, Result, nearest, owned};

impl Reader<'_> {
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

    fn required<T>(&self, name: &'static str, value: Result<Option<T>>) -> Result<T> {
        value?.ok_or_else(|| self.missing(name))
    }

    /// Reads a required quantity, in SI units.
    pub fn quantity(&self, name: &'static str) -> Result<f64> {
        self.required(name, self.optional_quantity(name))
    }

    /// Reads an optional quantity, in SI units.
    pub fn optional_quantity(&self, name: &'static str) -> Result<Option<f64>> {
        Ok(self.optional_quantity_with_dimension(name)?.map(|quantity| quantity.value))
    }

    /// Reads an optional quantity with its dimension, for fields that accept several dimensions.
    pub fn optional_quantity_with_dimension(&self, name: &'static str) -> Result<Option<Quantity>> {
        self.value(name, |reader, field, node| {
            if let Kind::Quantity(dimensions, range) = field.kind {
                reader.read_quantity(name, node, dimensions, range)
            } else if let Kind::Unit(dimension) = field.kind {
                reader.read_unit(name, node, dimension)
            } else {
                reader.defined_otherwise(name)
            }
        })
    }

    /// Reads a quantity in SI units.
    ///
    /// Returns `None` if the value is the word given in [`Kind::WordOr`], or if the field is absent and has no fixed
    /// default.
    pub fn word_or_quantity(&self, name: &'static str) -> Result<Option<f64>> {
        let value = self.value(name, |reader, field, node| {
            let Kind::WordOr(word, dimensions, range) = field.kind else {
                reader.defined_otherwise(name);
            };
            if node.value == Value::Text(word.to_owned()) {
                return Ok(None);
            }
            reader.read_quantity(name, node, dimensions, range).map(|q| Some(q.value))
        })?;
        Ok(value.flatten())
    }

    /// Reads a required plain number.
    pub fn number(&self, name: &'static str) -> Result<f64> {
        self.required(name, self.optional_number(name))
    }

    /// Reads an optional plain number.
    pub fn optional_number(&self, name: &'static str) -> Result<Option<f64>> {
        self.value(name, |reader, field, node| {
            let Kind::Number(range) = field.kind else { reader.defined_otherwise(name) };
            reader.read_number(name, node, range)
        })
    }

    /// Reads a plain number, which must lie in `range`, from a node.
    pub fn read_number(&self, name: &str, node: &Node, range: Range) -> Result<f64> {
        let wrong = || self.wrong_type(name, Kind::Number(range), node);
        let value = match &node.value {
            Value::Integer(Some(value)) => *value as f64,
            Value::Float(value) => *value,
            Value::Text(text) => match Quantity::parse_as(text, &[Dimension::NONE]) {
                Ok(quantity) => quantity.value,
                Err(_) => return Err(wrong()),
            },
            Value::Integer(None)
            | Value::Flag(_)
            | Value::Date
            | Value::Array(_)
            | Value::Table(_) => return Err(wrong()),
        };
        self.in_range(name, node, range, value, "", &node.value.describe())?;
        Ok(value)
    }

    /// Reads a required integer, which must lie in the range of the field.
    pub fn integer(&self, name: &'static str) -> Result<u32> {
        self.required(name, self.optional_integer(name))
    }

    /// Reads an optional integer, which must lie in the range of the field.
    pub fn optional_integer(&self, name: &'static str) -> Result<Option<u32>> {
        self.value(name, |reader, field, node| {
            let value = reader.read_integer(name, node, field.kind)?;
            u32::try_from(value).map_err(|_| reader.integer_out_of_range(name, node, field.kind))
        })
    }

    /// Reads an integer from a node. The integer must lie within the bounds of `kind`. Panics unless `kind` is a
    /// [`Kind::Integer`].
    pub fn read_integer(&self, name: &str, node: &Node, kind: Kind) -> Result<i64> {
        let Kind::Integer(least, greatest) = kind else { self.defined_otherwise(name) };
        let Value::Integer(value) = node.value else {
            return Err(self.wrong_type(name, kind, node));
        };
        value
            .filter(|value| (least..=greatest).contains(value))
            .ok_or_else(|| self.integer_out_of_range(name, node, kind))
    }

    fn integer_out_of_range(&self, name: &str, node: &Node, kind: Kind) -> InputError {
        let problem = Problem::OutOfRange {
            field: self.path_of(name),
            range: kind.to_string(),
            found: node.value.describe(),
        };
        self.sources.error(node.origin, problem)
    }

    /// Reads a required flag, `true` or `false`.
    pub fn flag(&self, name: &'static str) -> Result<bool> {
        self.required(name, self.optional_flag(name))
    }

    /// Reads an optional flag, `true` or `false`.
    pub fn optional_flag(&self, name: &'static str) -> Result<Option<bool>> {
        self.value(name, |reader, field, node| {
            let Value::Flag(value) = node.value else {
                return Err(reader.wrong_type(name, field.kind, node));
            };
            Ok(value)
        })
    }

    /// Reads a required string.
    pub fn text(&self, name: &'static str) -> Result<String> {
        self.required(name, self.optional_text(name))
    }

    /// Reads an optional string.
    ///
    /// For [`Kind::Label`], an integer is converted to a string. For [`Kind::TextOrFalse`], `false` counts as absent.
    pub fn optional_text(&self, name: &'static str) -> Result<Option<String>> {
        let value = self.value(name, |reader, field, node| {
            let text = match (&node.value, field.kind) {
                (Value::Text(text), _) => text.clone(),
                (Value::Integer(Some(value)), Kind::Label) => value.to_string(),
                (Value::Flag(false), Kind::TextOrFalse) => return Ok(None),
                _ => return Err(reader.wrong_type(name, field.kind, node)),
            };
            if text.trim().is_empty() {
                let message = format!(
                    "`{}` is empty; give the field a value or leave it out",
                    reader.path_of(name)
                );
                return Err(reader.sources.error(node.origin, Problem::Inconsistent { message }));
            }
            Ok(Some(text))
        })?;
        Ok(value.flatten())
    }

    /// Reads an optional value that is not a list, a table or a date. The caller interprets the value.
    pub fn node(&self, name: &'static str) -> Result<Option<Node>> {
        self.value(name, |reader, field, node| {
            if matches!(node.value, Value::Array(_) | Value::Table(_) | Value::Date) {
                return Err(reader.wrong_type(name, field.kind, node));
            }
            Ok(node.clone())
        })
    }

    /// Reads an optional, nonempty list whose items are not lists, tables or dates. The caller interprets the items.
    ///
    /// For [`Kind::Texts`], every item must be a string.
    pub fn nodes(&self, name: &'static str) -> Result<Option<Vec<Node>>> {
        self.value(name, |reader, field, node| {
            let Value::Array(items) = &node.value else {
                return Err(reader.wrong_type(name, field.kind, node));
            };
            let texts = matches!(field.kind, Kind::Texts);
            for item in items {
                let single = !matches!(item.value, Value::Array(_) | Value::Table(_) | Value::Date);
                if !single || texts && !matches!(item.value, Value::Text(_)) {
                    return Err(reader.wrong_type(name, field.kind, item));
                }
            }
            if items.is_empty() {
                let message =
                    format!("`{}` is an empty list; give at least one item", reader.path_of(name));
                return Err(reader.sources.error(node.origin, Problem::Inconsistent { message }));
            }
            Ok(items.clone())
        })
    }

    /// Reads a list of strings; the list is empty if the field is absent.
    pub fn texts(&self, name: &'static str) -> Result<Vec<String>> {
        let nodes = self.nodes(name)?.unwrap_or_default();
        let text =
            |node| if let Node { value: Value::Text(text), .. } = node { Some(text) } else { None };
        Ok(nodes.into_iter().filter_map(text).collect())
    }

    /// Reads an optional file path, which is relative to the folder of the file that contains it.
    pub fn file(&self, name: &'static str) -> Result<Option<FileRef>> {
        let Some(path) = self.optional_text(name)? else { return Ok(None) };
        Ok(Some(match self.entry(name).map(|node| node.origin) {
            Some(Origin::File { file, .. }) => {
                FileRef::new(path, self.sources.files[file].folder.clone())
            }
            Some(Origin::Override(_) | Origin::Whole(_) | Origin::Default) | None => {
                FileRef::of_caller(path)
            }
        }))
    }

    /// Reads a required value of type `T`, which is written by name in the file.
    pub fn choice<T: Named>(&self, name: &'static str) -> Result<T> {
        self.required(name, self.optional_choice(name))
    }

    /// Reads an optional value of type `T`, which is written by name in the file.
    pub fn optional_choice<T: Named>(&self, name: &'static str) -> Result<Option<T>> {
        self.value(name, |reader, _, node| {
            let text = reader.read_name(name, node, &crate::field::names::<T>())?;
            let found = T::NAMES.iter().find(|(known, _)| *known == text);
            found.map(|(_, member)| *member).ok_or_else(|| reader.missing(name))
        })
    }

    /// Reads a required name, which must be one of the names that the [`Kind::Choice`] of the field lists.
    pub fn catalog_name(&self, name: &'static str) -> Result<String> {
        self.required(name, self.optional_catalog_name(name))
    }

    /// Reads an optional name, which must be one of the names that the [`Kind::Choice`] of the field lists.
    pub fn optional_catalog_name(&self, name: &'static str) -> Result<Option<String>> {
        self.value(name, |reader, field, node| {
            let Kind::Choice(names) = field.kind else { reader.defined_otherwise(name) };
            reader.read_name(name, node, &names())
        })
    }

    /// Reads a required list of two strings.
    pub fn pair(&self, name: &'static str) -> Result<[String; 2]> {
        let value = self.value(name, |reader, field, node| {
            if let Value::Array(items) = &node.value
                && let [a, b] = items.as_slice()
                && let (Value::Text(a), Value::Text(b)) = (&a.value, &b.value)
            {
                return Ok([a.clone(), b.clone()]);
            }
            Err(reader.wrong_type(name, field.kind, node))
        });
        self.required(name, value)
    }

    /// Reads an optional point, which is written as a list of two quantities. Returns their values in SI units.
    pub fn optional_point(&self, name: &'static str) -> Result<Option<[f64; 2]>> {
        self.list(name)
    }

    /// Reads a required point, which is written as a list of two quantities. Returns their values in SI units.
    pub fn point(&self, name: &'static str) -> Result<[f64; 2]> {
        self.required(name, self.optional_point(name))
    }

    /// Reads a required list of three quantities. Returns their values in SI units.
    pub fn triple(&self, name: &'static str) -> Result<[f64; 3]> {
        self.required(name, self.optional_triple(name))
    }

    /// Reads an optional list of three quantities. Returns their values in SI units.
    pub fn optional_triple(&self, name: &'static str) -> Result<Option<[f64; 3]>> {
        self.list(name)
    }

    fn list<const N: usize>(&self, name: &'static str) -> Result<Option<[f64; N]>> {
        self.value(name, |reader, field, node| {
            let (Kind::Point(dimension) | Kind::Triple(dimension)) = field.kind else {
                reader.defined_otherwise(name)
            };
            reader.read_point(name, node, dimension, field.kind)
        })
    }

    /// Reads a required list of points. Returns their coordinates in SI units.
    pub fn points(&self, name: &'static str) -> Result<Vec<[f64; 2]>> {
        let value = self.value(name, |reader, field, node| {
            let Kind::Points(dimension) = field.kind else { reader.defined_otherwise(name) };
            let Value::Array(items) = &node.value else {
                return Err(reader.wrong_type(name, field.kind, node));
            };
            items
                .iter()
                .map(|item| reader.read_point(name, item, dimension, Kind::Point(dimension)))
                .collect()
        });
        self.required(name, value)
    }

    /// Reads a name from a node; it must be one of `valid`.
    pub fn read_name(&self, name: &str, node: &Node, valid: &[&'static str]) -> Result<String> {
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

    fn read_point<const N: usize>(
        &self,
        name: &str,
        node: &Node,
        d: Dimension,
        kind: Kind,
    ) -> Result<[f64; N]> {
        let Value::Array(items) = &node.value else {
            return Err(self.wrong_type(name, kind, node));
        };
        if items.len() != N {
            let problem = Problem::WrongType {
                field: self.path_of(name),
                expected: kind.to_string(),
                found: match items.len() {
                    0 => "an empty list".to_owned(),
                    1 => "a list with 1 item".to_owned(),
                    count => format!("a list with {count} items"),
                },
            };
            return Err(self.sources.error(node.origin, problem));
        }
        let mut point = [0.0; N];
        for (value, item) in point.iter_mut().zip(items) {
            *value = self.read_quantity(name, item, &[d], Range::ANY)?.value;
        }
        Ok(point)
    }

    /// Reads a quantity, whose SI value must lie in `range`, from a node.
    pub fn read_quantity(
        &self,
        name: &str,
        node: &Node,
        dimensions: &[Dimension],
        range: Range,
    ) -> Result<Quantity> {
        // A number without a unit is most often meant in SI units.
        let unit = dimensions[0].si_unit();
        let kind = "a quantity with its unit";
        match &node.value {
            Value::Text(text) => {
                let quantity = Quantity::parse_as(text, dimensions).map_err(|reason| {
                    let mut example = Quantity::suggestion(text, dimensions);
                    if example == dimensions[0].example() {
                        example = example_in(dimensions[0], range);
                    }
                    let example = format!("\"{example}\"");
                    let field = self.path_of(name);
                    self.sources.error(node.origin, Problem::Quantity { field, reason, example })
                })?;
                let unit = quantity.dimension.si_unit();
                let found = format!("\"{}\"", shorten(text));
                self.in_range(name, node, range, quantity.value, &unit, &found)?;
                Ok(quantity)
            }
            Value::Integer(Some(number)) => {
                Err(self.bare_number(name, node, *number as f64, &unit, range))
            }
            Value::Float(number) if number.is_finite() => {
                Err(self.bare_number(name, node, *number, &unit, range))
            }
            Value::Float(_)
            | Value::Integer(None)
            | Value::Flag(_)
            | Value::Date
            | Value::Array(_)
            | Value::Table(_) => Err(self.wrong_type_as(name, kind, node)),
        }
    }

    /// Creates an error about a number without a unit, with advice to add the SI unit.
    ///
    /// The example contains the number itself, or another number if this one is out of `range`.
    fn bare_number(
        &self,
        name: &str,
        node: &Node,
        number: f64,
        unit: &str,
        range: Range,
    ) -> InputError {
        let valid = [number, 1.0, range.least, range.greatest];
        let number = plain(valid.into_iter().find(|one| range.contains(*one)).unwrap_or(number));
        let of_a_list = self.section.any_field(name).is_some_and(|field| {
            matches!(field.kind, Kind::Values | Kind::Point(_) | Kind::Triple(_) | Kind::Points(_))
        });
        let example = if of_a_list {
            format!("\"{number} {unit}\"")
        } else {
            format!("`{name} = \"{number} {unit}\"`")
        };
        // Accelerations are often stated in g, so both units are offered.
        let example =
            if unit == "m/s^2" { example.replace(unit, "g") + " or " + &example } else { example };
        let found = node.value.describe();
        let problem = Problem::BareNumber { field: self.path_of(name), found, example };
        self.sources.error(node.origin, problem)
    }

    /// Reads a unit or a quantity. A name alone, such as `kN`, means one unit, here 1 kN.
    fn read_unit(&self, name: &str, node: &Node, dimension: Dimension) -> Result<Quantity> {
        if let Value::Text(text) = &node.value
            && !text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
        {
            let one =
                Node { origin: node.origin, value: Value::Text(format!("1 {}", text.trim())) };
            let read = self.read_quantity(name, &one, &[dimension], Range::POSITIVE);
            return read.map_err(|error| unit_alone(&error));
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

    /// Creates an error about a value that is not of the required kind.
    pub fn wrong_type(&self, name: &str, kind: Kind, node: &Node) -> InputError {
        self.wrong_type_as(name, &kind.to_string(), node)
    }

    fn wrong_type_as(&self, name: &str, expected: &str, node: &Node) -> InputError {
        let problem = Problem::WrongType {
            field: self.path_of(name),
            expected: expected.to_owned(),
            found: node.value.describe(),
        };
        self.sources.error(node.origin, problem)
    }
}

/// Converts an error about a quantity to an error about a unit, by removing the number from the example.
fn unit_alone(error: &InputError) -> InputError {
    let mut problem = error.problem().clone();
    if let Problem::Quantity { example, .. } = &mut problem
        && let Some((_, unit)) = example.split_once(' ')
    {
        *example = format!("\"{unit}");
    }
    InputError::new(problem, error.place().clone())
}
