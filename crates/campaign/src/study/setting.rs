//! Values of factors, both as written in scenario files and as written in tables.

use crate::scenario::field::{Field, Kind, Named as _, Range};
use crate::scenario::reader::Reader;
use crate::scenario::tree::{Node, Origin, Value as Written};
use crate::scenario::{Dimension, Problem, Quantity, ScenarioError};

use super::fields::Spacing;
use barrelstack_report::column::{Value, ValueKind};

/// One value of a factor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Setting {
    /// Value as written in a scenario file, with its position in the study file.
    pub(super) node: Node,
    /// Value as written in a table, in SI units.
    pub(super) value: Value,
}

impl Setting {
    /// Returns the value as a number (SI); NaN if the value is text.
    pub(super) fn number(&self) -> f64 {
        match &self.value {
            Value::Number(value) => *value,
            Value::Integer(value) => *value as f64,
            Value::Text(_) => f64::NAN,
        }
    }

    /// Returns the value as unambiguous text, from which the identity of a case is derived.
    pub(super) fn word(&self) -> String {
        word(&self.value)
    }
}

/// Returns a table value as unambiguous text.
pub(crate) fn word(value: &Value) -> String {
    match value {
        Value::Number(value) => crate::scenario::quantity::plain(*value),
        Value::Integer(value) => value.to_string(),
        Value::Text(text) => text.clone(),
    }
}

/// Domain of a field: the allowed values and their notation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    kind: Kind,
    /// Dimension of the numbers. If the field allows several dimensions, this is the one that the study uses.
    dimension: Dimension,
}

impl PartialEq for Domain {
    fn eq(&self, other: &Self) -> bool {
        self.kind.to_string() == other.kind.to_string() && self.dimension == other.dimension
    }
}

/// Reads a required value whose kind depends on other fields. If the value is missing, the error states which
/// kind is expected.
pub(super) fn required(
    reader: &Reader<'_>,
    name: &'static str,
    kind: Kind,
) -> Result<Node, ScenarioError> {
    let node = if reader.has(name) { reader.node(name)? } else { None };
    node.ok_or_else(|| reader.missing_as(name, kind))
}

impl Domain {
    /// Returns the domain of a field; `None` if the field does not hold a single value.
    pub(super) fn of(field: &Field) -> Option<Self> {
        let dimension = match field.kind {
            Kind::Quantity(dimensions, _) | Kind::WordOr(_, dimensions, _) => dimensions[0],
            Kind::Text
            | Kind::Label
            | Kind::Flag
            | Kind::Integer(..)
            | Kind::Number(_)
            | Kind::TextOrFalse
            | Kind::Choice(_)
            | Kind::ChoiceOrTable(..) => Dimension::NONE,
            Kind::Unit(_)
            | Kind::Point(_)
            | Kind::Triple(_)
            | Kind::Points(_)
            | Kind::Pair
            | Kind::Table(_)
            | Kind::Tables(_)
            | Kind::Texts
            | Kind::Value
            | Kind::Values => return None,
        };
        Some(Self { kind: field.kind, dimension })
    }

    /// Returns the domain of positive quantities that have one of the given dimensions.
    pub(super) fn positive(dimensions: &'static [Dimension]) -> Self {
        Self { kind: Kind::Quantity(dimensions, Range::POSITIVE), dimension: dimensions[0] }
    }

    /// Restricts the domain to the dimension of `node`, which is the first of the given values.
    ///
    /// A field may allow several dimensions, such as acceleration or velocity, but a column holds only one.
    #[must_use]
    pub(super) fn fixed_by(self, node: &Node) -> Self {
        let Kind::Quantity(dimensions, _) = self.kind else { return self };
        let Written::Text(text) = &node.value else { return self };
        let dimension =
            Quantity::parse_as(text, dimensions).map_or(self.dimension, |q| q.dimension);
        Self { dimension, ..self }
    }

    /// `true` if the values are real numbers.
    pub(super) fn continuous(self) -> bool {
        matches!(self.kind, Kind::Number(_) | Kind::Quantity(..))
    }

    /// Returns the kind of a table column that holds the values.
    pub(super) fn column_kind(self) -> ValueKind {
        if self.continuous() {
            ValueKind::Number
        } else if let Kind::Integer(..) = self.kind {
            ValueKind::Integer
        } else {
            ValueKind::Text
        }
    }

    /// Returns the unit of a table column that holds the values.
    pub(super) fn unit(self) -> String {
        if self.dimension == Dimension::NONE || self.column_kind() == ValueKind::Text {
            String::new()
        } else {
            self.dimension.si_unit()
        }
    }

    /// Converts a number (SI) to a value for the field.
    pub(super) fn setting(self, number: f64, origin: Origin) -> Setting {
        let written = if let Kind::Quantity(..) = self.kind {
            Written::Text(Quantity { value: number, dimension: self.dimension }.to_string())
        } else {
            Written::Float(number)
        };
        Setting { node: Node { origin, value: written }, value: Value::Number(number) }
    }

    /// Reads a value for the field.
    pub(super) fn read(
        self,
        reader: &Reader<'_>,
        name: &str,
        node: &Node,
    ) -> Result<Setting, ScenarioError> {
        let kind = self.kind;
        let value = match (kind, &node.value) {
            (Kind::Number(range), _) => Value::Number(reader.read_number(name, node, range)?),
            (Kind::Quantity(_, range), _) => {
                // The scenario parses the written number again and obtains the same bits.
                Value::Number(reader.read_quantity(name, node, &[self.dimension], range)?.value)
            }
            (Kind::Integer(..), _) => Value::Integer(reader.read_integer(name, node, kind)?),
            (Kind::Choice(names) | Kind::ChoiceOrTable(names, ..), _) => {
                Value::Text(reader.read_name(name, node, &names())?)
            }
            (Kind::Flag | Kind::TextOrFalse, Written::Flag(flag)) => Value::Text(flag.to_string()),
            (Kind::Label, Written::Integer(Some(value))) => Value::Text(value.to_string()),
            (
                Kind::Text | Kind::Label | Kind::TextOrFalse | Kind::WordOr(..),
                Written::Text(text),
            ) => Value::Text(text.clone()),
            _ => return Err(reader.wrong_type(name, kind, node)),
        };
        Ok(Setting { node: node.clone(), value })
    }

    /// Reads a required number with a unit that the field allows, and returns it in SI units.
    pub(super) fn number(
        self,
        reader: &Reader<'_>,
        name: &'static str,
    ) -> Result<f64, ScenarioError> {
        let node = required(reader, name, self.kind)?;
        // The parameters of a distribution may lie outside of the range of the field, so only the unit is checked.
        let open = if let Kind::Quantity(dimensions, _) = self.kind {
            Kind::Quantity(dimensions, Range::ANY)
        } else {
            Kind::Number(Range::ANY)
        };
        Ok(Self { kind: open, ..self }.read(reader, name, &node)?.number())
    }

    /// Reads a required list of distinct values.
    pub(super) fn settings(
        self,
        reader: &Reader<'_>,
        name: &'static str,
    ) -> Result<Vec<Setting>, ScenarioError> {
        let Some(nodes) = reader.nodes(name)? else { return Err(reader.missing(name)) };
        let mut settings: Vec<Setting> = Vec::new();
        for node in &nodes {
            let setting = self.read(reader, name, node)?;
            if settings.iter().any(|other| other.value == setting.value) {
                let message =
                    format!("`{}` contains {} twice", reader.path_of(name), setting.word());
                return Err(reader.error_at(node.origin, Problem::Inconsistent { message }));
            }
            settings.push(setting);
        }
        Ok(settings)
    }

    /// Reads a `[….range]` table, and returns the `count` values from `from` to `to` that it defines.
    pub(super) fn range(
        self,
        reader: &Reader<'_>,
        origin: Origin,
    ) -> Result<Vec<Setting>, ScenarioError> {
        let spacing: Spacing = reader.choice("spacing")?;
        let (count, whole) = (reader.integer("count")?, matches!(self.kind, Kind::Integer(..)));
        if !self.continuous() && !whole {
            let message =
                "a field that is not a number has no range; give a list of its `values`".to_owned();
            return Err(reader.inconsistent("from", message));
        }
        let end = |name| -> Result<f64, ScenarioError> {
            let node = required(reader, name, self.kind)?;
            Ok(self.read(reader, name, &node)?.number())
        };
        let (from, to) = (end("from")?, end("to")?);
        if spacing == Spacing::Logarithmic && (from <= 0.0 || to <= 0.0) {
            let message =
                format!("with spacing \"{}\", `from` and `to` must be above zero", spacing.name());
            return Err(reader.inconsistent("spacing", message));
        }
        if from == to {
            return Err(reader.inconsistent("to", "`to` must differ from `from`".to_owned()));
        }
        let value = |at: u32| {
            let share = f64::from(at) / f64::from(count - 1);
            match (at, spacing) {
                (0, _) => from,
                (at, _) if at + 1 == count => to,
                (_, Spacing::Linear) => rounded(from + share * (to - from)),
                (_, Spacing::Logarithmic) => {
                    rounded(from * libm::exp(share * libm::log(to / from)))
                }
            }
        };
        let mut settings = Vec::new();
        for at in 0..count {
            let value = value(at);
            if !whole {
                settings.push(self.setting(value, origin));
                continue;
            }
            if value != value.round() {
                let message =
                    format!("{count} values from {from} to {to} are not all whole numbers");
                return Err(reader.inconsistent("count", message));
            }
            #[expect(
                clippy::cast_possible_truncation,
                reason = "a whole number within the range of the field"
            )]
            let value = value as i64;
            let node = Node { origin, value: Written::Integer(Some(value)) };
            settings.push(Setting { node, value: Value::Integer(value) });
        }
        Ok(settings)
    }

    /// Returns the table value for `written`, the value of the field in the resolved base scenario; `None` if it does
    /// not fit the kind or the dimension of the domain.
    pub(super) fn base_value(self, written: &Written) -> Option<Value> {
        match (self.column_kind(), written) {
            (ValueKind::Integer, Written::Integer(value)) => value.map(Value::Integer),
            (ValueKind::Number, Written::Float(value)) => Some(Value::Number(*value)),
            (ValueKind::Number, Written::Integer(value)) => value.map(|v| Value::Number(v as f64)),
            (ValueKind::Number, Written::Text(text)) => {
                // If the base states the field in another of its allowed dimensions, there is no base value.
                Quantity::parse_as(text, &[self.dimension]).ok().map(|q| Value::Number(q.value))
            }
            (ValueKind::Text, Written::Text(text)) => Some(Value::Text(text.clone())),
            (ValueKind::Text, Written::Flag(flag)) => Some(Value::Text(flag.to_string())),
            _ => None,
        }
    }
}

/// Rounds a number to twelve significant digits, so that 0.39999999999999997 becomes 0.4.
fn rounded(value: f64) -> f64 {
    // A number formatted with twelve digits can always be parsed.
    format!("{value:.11e}").parse().unwrap_or(value)
}
