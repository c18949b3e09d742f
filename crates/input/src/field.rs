//! Definition of the fields of input files: name, kind, default and help.
//!
//! The reader, the writer, the reference and the JSON Schema are all derived from these definitions
//! and therefore always agree.

use std::fmt;

use crate::dimension::Dimension;
use crate::quantity::plain;

/// A table of an input file.
#[derive(Debug)]
pub struct Section {
    /// Unique name in the reference and the schema.
    pub name: &'static str,
    /// Purpose of the table, in one sentence.
    pub help: &'static str,
    /// Fields common to all variants.
    pub fields: &'static [Field],
    /// Further fields, which depend on the value of a tag field.
    pub variants: Option<Variants>,
    /// Groups of mutually exclusive fields.
    pub exclusive: &'static [&'static [&'static str]],
}

/// Sets of fields. The value of a tag field selects one of the sets.
#[derive(Debug)]
pub struct Variants {
    /// Name of the field that selects the variant.
    pub tag: &'static str,
    /// The variants.
    pub list: &'static [Variant],
}

/// Set of fields that a table has if the tag field has one specific value.
#[derive(Debug)]
pub struct Variant {
    /// Value of the tag field that selects this variant.
    pub name: &'static str,
    /// Meaning of the variant, in one sentence.
    pub help: &'static str,
    /// Fields of the variant.
    pub fields: &'static [Field],
}

/// Definition of one field of a table.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Key in the file.
    pub name: &'static str,
    /// Kind of value that the field accepts.
    pub kind: Kind,
    /// The value that the reader uses if the field is absent.
    pub default: Default,
    /// Meaning of the field, in one sentence.
    pub help: &'static str,
}

/// The value that the reader uses if a field is absent.
#[derive(Debug, Clone, Copy)]
pub enum Default {
    /// The field is required.
    Required,
    /// The field is optional and has no default value.
    Nothing,
    /// A value derived from other fields, described in words.
    Derived(&'static str),
    /// A fixed value, written as TOML.
    Value(&'static str),
}

/// Kind of value of a field.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// A string.
    Text,
    /// A string, or an integer that is read as a string.
    Label,
    /// `true` or `false`.
    Flag,
    /// An integer from the first to the second bound, both inclusive.
    Integer(i64, i64),
    /// A plain number, or a percentage.
    Number(Range),
    /// A quantity of one of the given dimensions.
    Quantity(&'static [Dimension], Range),
    /// The given word, or a quantity.
    WordOr(&'static str, &'static [Dimension], Range),
    /// A unit such as `kN`, or a quantity that serves as a unit.
    Unit(Dimension),
    /// Two quantities `[x, z]`.
    Point(Dimension),
    /// Three quantities `[x, y, z]`.
    Triple(Dimension),
    /// A list of points.
    Points(Dimension),
    /// A list of two strings.
    Pair,
    /// A string, or `false`.
    TextOrFalse,
    /// One of a list of names.
    Choice(fn() -> Vec<&'static str>),
    /// A nested table.
    Table(&'static Section),
    /// A list of tables; an override addresses an item by its name or its number.
    Tables(&'static Section),
    /// A list of strings.
    Texts,
    /// A value that is neither a list nor a table, and whose kind depends on another field.
    Value,
    /// A list of values that are neither lists nor tables, and whose kind depends on another field.
    Values,
    /// One of a list of names, or a table. A name is short for a table with a single field: the string in this variant
    /// is the key of that field, and the name is its value.
    ChoiceOrTable(fn() -> Vec<&'static str>, &'static str, &'static Section),
}

/// A range of valid numbers, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub least: f64,
    /// `true` if the lower bound is excluded.
    pub above: bool,
    /// Upper bound, always included.
    pub greatest: f64,
}

/// Limit for the magnitude of numbers that have no limit of their own. The limit is far above any
/// physical value and far below overflow.
const VAST: f64 = 1e12;

impl Range {
    /// Any number up to 1e12 in magnitude.
    pub const ANY: Self = Self { least: -VAST, above: false, greatest: VAST };
    /// Any number greater than zero, up to 1e12.
    pub const POSITIVE: Self = Self { least: 0.0, above: true, greatest: VAST };
    /// Any number from zero to 1e12.
    pub const NOT_NEGATIVE: Self = Self { least: 0.0, above: false, greatest: VAST };

    /// Creates a range from `least` to `greatest`, both inclusive.
    pub const fn between(least: f64, greatest: f64) -> Self {
        Self { least, above: false, greatest }
    }

    /// Creates a range of positive numbers up to and including `greatest`.
    pub const fn up_to(greatest: f64) -> Self {
        Self { least: 0.0, above: true, greatest }
    }

    /// Returns `true` if a number lies in the range; a number that is not finite never does.
    pub fn contains(&self, value: f64) -> bool {
        let low = if self.above { value > self.least } else { value >= self.least };
        low && value <= self.greatest
    }

    /// Describes the range in words, with the given unit.
    pub fn describe(&self, unit: &str) -> String {
        let unit = if unit.is_empty() || unit == "1" { String::new() } else { format!(" {unit}") };
        let bounds = (self.above, self.least == -VAST, self.greatest == VAST);
        let (least, greatest) = (plain(self.least), plain(self.greatest));
        match bounds {
            (_, true, true) => format!("a number no larger than 1e12{unit} in magnitude"),
            (true, _, true) => format!("greater than {least}{unit} and below 1e12{unit}"),
            (false, _, true) => format!("at least {least}{unit} and below 1e12{unit}"),
            (true, _, false) => format!("greater than {least}{unit} and at most {greatest}{unit}"),
            (false, _, false) => format!("between {least} and {greatest}{unit}"),
        }
    }
}

/// A closed set of members that are written by name in files.
pub trait Named: Copy + PartialEq + 'static {
    /// Every member with its name.
    const NAMES: &'static [(&'static str, Self)];

    /// Returns the name of the member.
    fn name(self) -> &'static str {
        // Every member is in the list; round-trip tests verify it.
        Self::NAMES.iter().find(|(_, member)| *member == self).map_or("", |(name, _)| name)
    }
}

/// Returns the names of all members of a closed set.
pub fn names<T: Named>() -> Vec<&'static str> {
    T::NAMES.iter().map(|(name, _)| *name).collect()
}

impl Field {
    /// Creates a field from its name, kind, default and help.
    pub const fn new(name: &'static str, kind: Kind, default: Default, help: &'static str) -> Self {
        Self { name, kind, default, help }
    }

    /// Returns an example: the field with a valid value, as written in a file.
    pub fn example(&self) -> String {
        if let Kind::Table(_) = self.kind {
            format!("a table `{}`", self.name)
        } else if let Kind::Tables(_) = self.kind {
            format!("a table `[[{}]]`", self.name)
        } else if let Default::Value(text) = self.default {
            format!("`{} = {text}`", self.name)
        } else {
            format!("`{} = {}`", self.name, self.kind.example())
        }
    }
}

/// Returns a quantity of a dimension as a user would write it.
///
/// If the range of a positive length has an upper limit of at least 100 m, the result is a hundredth of this limit. If
/// the range of a time has an upper limit of at least 100 s, the result is 1 s. The limit [`VAST`] does not count. In
/// all other cases, the result is that of [`Dimension::example`].
pub(crate) fn example_in(dimension: Dimension, range: Range) -> String {
    let large = (100.0..VAST).contains(&range.greatest);
    // A lower limit above zero belongs to lengths of bodies.
    let long = large && range.above && range.least == 0.0;
    match (dimension, range.greatest / 100.0) {
        (Dimension::LENGTH, value) if long && value >= 1000.0 => {
            format!("{} km", plain(value / 1000.0))
        }
        (Dimension::LENGTH, value) if long => format!("{} m", plain(value)),
        (Dimension::TIME, _) if large => "1 s".to_owned(),
        _ => dimension.example(),
    }
}

impl Kind {
    /// Returns the section of a nested table, or of the items of a list of tables.
    pub fn section(&self) -> Option<&'static Section> {
        match self {
            Self::Table(section) | Self::Tables(section) | Self::ChoiceOrTable(_, _, section) => {
                Some(section)
            }
            Self::Text
            | Self::Label
            | Self::Flag
            | Self::Integer(..)
            | Self::Number(_)
            | Self::Quantity(..)
            | Self::WordOr(..)
            | Self::Unit(_)
            | Self::Point(_)
            | Self::Triple(_)
            | Self::Points(_)
            | Self::Pair
            | Self::TextOrFalse
            | Self::Texts
            | Self::Value
            | Self::Values
            | Self::Choice(_) => None,
        }
    }

    /// Returns a valid value, written as TOML.
    pub fn example(&self) -> String {
        match self {
            Self::Text => "\"…\"".to_owned(),
            Self::Label => "\"360\"".to_owned(),
            Self::Flag => "true".to_owned(),
            Self::Integer(least, _) => least.max(&1).to_string(),
            Self::Number(range) => {
                if range.contains(0.5) {
                    "0.5".to_owned()
                } else {
                    range.greatest.to_string()
                }
            }
            Self::Quantity(dimensions, range) | Self::WordOr(_, dimensions, range) => {
                format!("\"{}\"", example_in(dimensions[0], *range))
            }
            Self::Unit(dimension) => format!("\"{}\"", dimension.si_unit()),
            Self::Point(Dimension::LENGTH) => "[\"1 m\", \"2 m\"]".to_owned(),
            Self::Points(Dimension::LENGTH) => {
                "[[\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"], [\"0 m\", \"1 m\"]]".to_owned()
            }
            Self::Point(d) => format!("[\"{0}\", \"{0}\"]", d.example()),
            Self::Triple(d) => format!("[\"{0}\", \"{0}\", \"{0}\"]", d.example()),
            Self::Points(d) => format!("[[\"{0}\", \"{0}\"], …]", d.example()),
            Self::Pair => "[\"block\", \"ground\"]".to_owned(),
            Self::TextOrFalse => "\"UP\"".to_owned(),
            Self::Texts => "[\"…\"]".to_owned(),
            Self::Value => "\"0.35 g\"".to_owned(),
            Self::Values => "[0.3, 0.4, 0.5]".to_owned(),
            Self::Choice(names) | Self::ChoiceOrTable(names, ..) => {
                format!("\"{}\"", names().first().unwrap_or(&""))
            }
            Self::Table(_) => "{ … }".to_owned(),
            Self::Tables(_) => "[{ … }]".to_owned(),
        }
    }
}

/// Describes the kind of value in words.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |dimensions: &[Dimension]| {
            dimensions.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
        };
        match self {
            Self::Text => f.write_str("text"),
            Self::Label => f.write_str("text or an integer"),
            Self::Flag => f.write_str("true or false"),
            Self::Integer(least, greatest) if least == greatest => write!(f, "the integer {least}"),
            Self::Integer(least, greatest) => write!(f, "an integer from {least} to {greatest}"),
            Self::Number(_) => f.write_str("a number"),
            Self::Quantity(dimensions, _) => write!(f, "{} with its unit", list(dimensions)),
            Self::WordOr(word, dimensions, _) => {
                write!(f, "\"{word}\" or {} with its unit", list(dimensions))
            }
            Self::Unit(dimension) => write!(f, "the unit of {dimension}"),
            Self::Point(dimension) => write!(f, "a list [x, z], each {dimension} with its unit"),
            Self::Triple(dimension) => {
                write!(f, "a list [x, y, z], each {dimension} with its unit")
            }
            Self::Points(dimension) => {
                write!(f, "a list of points [x, z], each {dimension} with its unit")
            }
            Self::Pair => f.write_str("a list of two names"),
            Self::TextOrFalse => f.write_str("text or false"),
            Self::Texts => f.write_str("a list of texts"),
            Self::Value => f.write_str("a value"),
            Self::Values => f.write_str("a list of values"),
            Self::Choice(_) => f.write_str("a name"),
            Self::Table(_) => f.write_str("a table"),
            Self::Tables(_) => f.write_str("a list of tables"),
            Self::ChoiceOrTable(..) => f.write_str("a name or a table"),
        }
    }
}

impl Section {
    /// Returns the common fields, followed by the fields of `variant` unless it is `None`.
    pub fn fields_of(
        &'static self,
        variant: Option<&'static Variant>,
    ) -> impl Iterator<Item = &'static Field> {
        self.fields.iter().chain(variant.map_or(&[][..], |v| v.fields))
    }

    /// Returns the field with the given name in the section or any of its variants.
    pub fn any_field(&'static self, name: &str) -> Option<&'static Field> {
        self.all_fields().find(|field| field.name == name)
    }

    /// Returns the fields of the section and of all its variants.
    pub fn all_fields(&'static self) -> impl Iterator<Item = &'static Field> {
        let variants = self.variants.iter().flat_map(|v| v.list).flat_map(|v| v.fields);
        self.fields.iter().chain(variants)
    }

    /// Returns the names of the fields that are mutually exclusive with the given field.
    pub fn rivals(&'static self, name: &str) -> impl Iterator<Item = &'static str> {
        let groups = self.exclusive.iter().filter(move |group| group.contains(&name));
        groups.flat_map(|group| group.iter().copied()).filter(move |rival| *rival != name)
    }
}
