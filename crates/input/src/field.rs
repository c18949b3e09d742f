//! Definition of the fields of input files: name, kind, default and help.
//!
//! The reader, the writer, the reference and the JSON Schema are derived from it, so that they cannot disagree.

use std::fmt;

use crate::dimension::Dimension;
use crate::quantity::plain;

/// A table of an input file.
#[derive(Debug)]
pub struct Section {
    /// Name in the reference and the schema, unique.
    pub name: &'static str,
    /// Purpose, in one sentence.
    pub help: &'static str,
    /// Fields common to all variants.
    pub fields: &'static [Field],
    /// Fields that depend on the value of one field.
    pub variants: Option<Variants>,
    /// Groups of mutually exclusive fields.
    pub exclusive: &'static [&'static [&'static str]],
}

/// Fields that depend on the value of one field.
#[derive(Debug)]
pub struct Variants {
    /// The field that selects the variant.
    pub tag: &'static str,
    /// The variants.
    pub list: &'static [Variant],
}

/// Fields present for one value of the selecting field.
#[derive(Debug)]
pub struct Variant {
    /// The value.
    pub name: &'static str,
    /// Meaning, in one sentence.
    pub help: &'static str,
    /// The fields.
    pub fields: &'static [Field],
}

/// One field.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Key in the file.
    pub name: &'static str,
    /// Kind of value.
    pub kind: Kind,
    /// Meaning of an absent field.
    pub default: Default,
    /// Meaning, in one sentence.
    pub help: &'static str,
}

/// Meaning of an absent field.
#[derive(Debug, Clone, Copy)]
pub enum Default {
    /// It must be given.
    Required,
    /// Absent.
    Nothing,
    /// A value that depends on other fields, in words.
    Derived(&'static str),
    /// A value, as TOML.
    Value(&'static str),
}

/// Kind of value of a field.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Text.
    Text,
    /// Text, or an integer, which is taken as text.
    Label,
    /// `true` or `false`.
    Flag,
    /// An integer.
    Integer(i64, i64),
    /// A plain number, or a percentage.
    Number(Range),
    /// A quantity of one of these dimensions.
    Quantity(&'static [Dimension], Range),
    /// A word, or a quantity.
    WordOr(&'static str, &'static [Dimension], Range),
    /// A unit, or a quantity that serves as one.
    Unit(Dimension),
    /// Two quantities `[x, z]`.
    Point(Dimension),
    /// Three quantities `[x, y, z]`.
    Triple(Dimension),
    /// A list of points.
    Points(Dimension),
    /// Two texts.
    Pair,
    /// Text, or `false`.
    TextOrFalse,
    /// One of a list of names.
    Choice(fn() -> Vec<&'static str>),
    /// A table.
    Table(&'static Section),
    /// A list of tables, referred to by name in overrides.
    Tables(&'static Section),
    /// A list of texts.
    Texts,
    /// A single value, whose kind depends on another field.
    Value,
    /// A list of such values.
    Values,
    /// One of a list of names, or a table; a name is short for a table with this key set to it.
    ChoiceOrTable(fn() -> Vec<&'static str>, &'static str, &'static Section),
}

/// A range of numbers in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest value.
    pub least: f64,
    /// `true` if the smallest value is excluded.
    pub above: bool,
    /// Largest value.
    pub greatest: f64,
}

/// Largest magnitude of a number without a limit of its own: far beyond any stack, far below overflow.
const VAST: f64 = 1e12;

impl Range {
    /// Any number of reasonable magnitude.
    pub const ANY: Self = Self { least: -VAST, above: false, greatest: VAST };
    /// Greater than zero.
    pub const POSITIVE: Self = Self { least: 0.0, above: true, greatest: VAST };
    /// Zero or greater.
    pub const NOT_NEGATIVE: Self = Self { least: 0.0, above: false, greatest: VAST };

    /// Creates a range from the smallest to the largest value, both included.
    pub const fn between(least: f64, greatest: f64) -> Self {
        Self { least, above: false, greatest }
    }

    /// Creates a range of positive numbers up to the largest value, included.
    pub const fn up_to(greatest: f64) -> Self {
        Self { least: 0.0, above: true, greatest }
    }

    /// `true` if a number lies in the range; `false` for one that is not finite.
    pub fn contains(&self, value: f64) -> bool {
        let low = if self.above { value > self.least } else { value >= self.least };
        low && value <= self.greatest
    }

    /// Describes the range in words, with a unit.
    pub fn describe(&self, unit: &str) -> String {
        let unit = if unit.is_empty() || unit == "1" { String::new() } else { format!(" {unit}") };
        let bounds = (self.above, self.least == -VAST, self.greatest == VAST);
        let (least, greatest) = (plain(self.least), plain(self.greatest));
        match bounds {
            (_, true, true) => format!("a number no larger than 1e12{unit} in size"),
            (true, _, true) => format!("greater than {least}{unit} and below 1e12{unit}"),
            (false, _, true) => format!("at least {least}{unit} and below 1e12{unit}"),
            (true, _, false) => format!("greater than {least}{unit} and at most {greatest}{unit}"),
            (false, _, false) => format!("between {least} and {greatest}{unit}"),
        }
    }
}

/// A closed set whose members have names in files.
pub trait Named: Copy + PartialEq + 'static {
    /// All members with their names.
    const NAMES: &'static [(&'static str, Self)];

    /// Returns the name of the member.
    fn name(self) -> &'static str {
        // Every member is in the list, as round-trip tests verify.
        Self::NAMES.iter().find(|(_, member)| *member == self).map_or("", |(name, _)| name)
    }
}

/// Returns the names of a closed set.
pub fn names<T: Named>() -> Vec<&'static str> {
    T::NAMES.iter().map(|(name, _)| *name).collect()
}

impl Field {
    /// Creates a field from its name, kind, default and help.
    pub const fn new(name: &'static str, kind: Kind, default: Default, help: &'static str) -> Self {
        Self { name, kind, default, help }
    }

    /// Returns the field with a valid value, as a user would write it.
    pub fn example(&self) -> String {
        if let Kind::Table(_) = self.kind {
            format!("a table `{}`", self.name)
        } else if let Kind::Tables(_) = self.kind {
            format!("a table `[[{}]]`", self.name)
        } else {
            format!("`{} = {}`", self.name, self.kind.example())
        }
    }
}

impl Kind {
    /// Returns the table inside a field, or of each item of its list.
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

    /// Returns a valid value as TOML.
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
            Self::Quantity(dimensions, _) | Self::WordOr(_, dimensions, _) => {
                format!("\"{}\"", dimensions[0].example())
            }
            Self::Unit(dimension) => format!("\"{}\"", dimension.si_unit()),
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

/// Writes the kind of value in words.
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
    /// Returns the common fields with those of a variant, if given.
    pub fn fields_of(
        &'static self,
        variant: Option<&'static Variant>,
    ) -> impl Iterator<Item = &'static Field> {
        self.fields.iter().chain(variant.map_or(&[][..], |v| v.fields))
    }

    /// Returns the field of a name in the section or any of its variants.
    pub fn any_field(&'static self, name: &str) -> Option<&'static Field> {
        self.all_fields().find(|field| field.name == name)
    }

    /// Returns the fields of the section and of all its variants.
    pub fn all_fields(&'static self) -> impl Iterator<Item = &'static Field> {
        let variants = self.variants.iter().flat_map(|v| v.list).flat_map(|v| v.fields);
        self.fields.iter().chain(variants)
    }

    /// Returns the other fields of the exclusive groups that contain a field.
    pub fn rivals(&'static self, name: &str) -> impl Iterator<Item = &'static str> {
        let groups = self.exclusive.iter().filter(move |group| group.contains(&name));
        groups.flat_map(|group| group.iter().copied()).filter(move |rival| *rival != name)
    }
}
