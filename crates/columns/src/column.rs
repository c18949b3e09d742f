//! Columns of results with name, unit and values, for machine-readable tables.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::described::{Described, Objects};
use crate::{csv_field, described, shortest, with_unit};

/// The role of a column in a table of cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Identifies the case.
    Key,
    /// A parameter that the study varies.
    Factor,
    /// The motion and its target intensity.
    Motion,
    /// Intensity of the scaled motion.
    Intensity,
    /// Outcome of the run.
    Outcome,
    /// Response of the stack.
    Demand,
    /// Settings and diagnostics of the computation.
    Run,
}

impl Described for Role {
    fn schema(_: &mut Objects) -> serde_json::Value {
        serde_json::json!({ "type": "string", "enum": ["key", "factor", "motion", "intensity", "outcome", "demand", "run"] })
    }
}

/// The type of the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ValueKind {
    /// Whole numbers.
    Integer,
    /// Numbers in SI units.
    Number,
    /// Text.
    Text,
}

impl Described for ValueKind {
    fn schema(_: &mut Objects) -> serde_json::Value {
        serde_json::json!({ "type": "string", "enum": ["integer", "number", "text"] })
    }
}

/// A single value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A whole number.
    Integer(i64),
    /// A number in SI units.
    Number(f64),
    /// Text.
    Text(String),
}

described! {
    /// Description of a column of a table.
    #[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
    pub struct ColumnSpec {
        /// Name of the column without its unit, unique in a table.
        pub name: String,
        /// SI unit; empty for dimensionless numbers and for text.
        pub unit: String,
        /// Role of the values.
        pub role: Role,
        /// Type of the values.
        pub kind: ValueKind,
    }
}

impl ColumnSpec {
    /// Creates the description of a column.
    pub fn new(name: &str, unit: &str, role: Role, kind: ValueKind) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), role, kind }
    }

    /// Returns the name with its unit, as in files, such as `pga (m/s2)`.
    pub fn heading(&self) -> String {
        with_unit(&self.name, &self.unit)
    }
}

/// Converts words to the name of a column; the name is the same in all file formats.
///
/// Letters, digits, `.` and `-` are kept, and every other character becomes `_`. For example,
/// `B4.1 displacement x` becomes `B4.1_displacement_x`.
pub fn column_name(words: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || matches!(c, '.' | '-') { c } else { '_' };
    words.chars().map(kept).collect()
}

/// The values of a column, one per row; a value is `None` if it does not apply or does not exist.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Values {
    /// Whole numbers.
    Integer(Vec<Option<i64>>),
    /// Numbers in SI units.
    Number(Vec<Option<f64>>),
    /// Strings.
    Text(Vec<Option<String>>),
}

impl Values {
    /// Creates a column without rows, of the given type.
    pub fn empty(kind: ValueKind) -> Self {
        match kind {
            ValueKind::Integer => Self::Integer(Vec::new()),
            ValueKind::Number => Self::Number(Vec::new()),
            ValueKind::Text => Self::Text(Vec::new()),
        }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Integer(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// `true` if the column has no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the value in a row; `None` if the value is missing.
    pub fn get(&self, row: usize) -> Option<Value> {
        match self {
            Self::Integer(values) => values.get(row).copied().flatten().map(Value::Integer),
            Self::Number(values) => values.get(row).copied().flatten().map(Value::Number),
            Self::Text(values) => values.get(row).cloned().flatten().map(Value::Text),
        }
    }

    /// Removes the values from `row` to the end, and returns the removed values.
    #[must_use]
    pub fn split_off(&mut self, row: usize) -> Self {
        match self {
            Self::Integer(values) => Self::Integer(values.split_off(row)),
            Self::Number(values) => Self::Number(values.split_off(row)),
            Self::Text(values) => Self::Text(values.split_off(row)),
        }
    }

    /// Appends the values of `more`, which must have the type of this column.
    ///
    /// # Errors
    /// If the types differ.
    pub fn append(&mut self, more: Self) -> Result<(), String> {
        match (self, more) {
            (Self::Integer(values), Self::Integer(more)) => values.extend(more),
            (Self::Number(values), Self::Number(more)) => values.extend(more),
            (Self::Text(values), Self::Text(more)) => values.extend(more),
            _ => {
                return Err("the values do not have the type of the column".to_owned());
            }
        }
        Ok(())
    }

    /// Appends a value of the type of the column; a whole number is also accepted in a column of
    /// numbers.
    ///
    /// # Errors
    /// If the value has a different type.
    pub fn push(&mut self, value: Option<Value>) -> Result<(), String> {
        match (self, value) {
            (Self::Integer(values), None) => values.push(None),
            (Self::Number(values), None) => values.push(None),
            (Self::Text(values), None) => values.push(None),
            (Self::Integer(values), Some(Value::Integer(value))) => values.push(Some(value)),
            (Self::Number(values), Some(Value::Number(value))) => values.push(Some(value)),
            (Self::Number(values), Some(Value::Integer(value))) => values.push(Some(value as f64)),
            (Self::Text(values), Some(Value::Text(value))) => values.push(Some(value)),
            (_, Some(value)) => {
                let value = match value {
                    Value::Integer(value) => value.to_string(),
                    Value::Number(value) => value.to_string(),
                    Value::Text(value) => format!("\"{value}\""),
                };
                return Err(format!("{value} does not have the type of its column"));
            }
        }
        Ok(())
    }
}

/// A column with its values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// Name, unit, role and type.
    #[serde(flatten)]
    pub spec: ColumnSpec,
    /// The values, one per row.
    pub values: Values,
}

impl Column {
    /// Creates a column without rows.
    pub fn empty(spec: ColumnSpec) -> Self {
        Self { values: Values::empty(spec.kind), spec }
    }
}

/// Returns columns of equal length as CSV: a header row with units, then one line for each row of
/// values; missing values are empty.
///
/// Numbers are written with the fewest digits that read back to the same bits.
pub fn to_csv(columns: &[Column]) -> String {
    csv_heading(columns) + &csv_rows(columns)
}

/// Returns the header row of the columns as CSV.
pub fn csv_heading(columns: &[Column]) -> String {
    let heading = |column: &Column| csv_field(&column.spec.heading());
    columns.iter().map(heading).collect::<Vec<_>>().join(",") + "\n"
}

/// Returns columns as CSV without the header row.
pub fn csv_rows(columns: &[Column]) -> String {
    let mut text = String::new();
    for row in 0..columns.first().map_or(0, |column| column.values.len()) {
        for (index, column) in columns.iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            match column.values.get(row) {
                None => {}
                Some(Value::Integer(value)) => drop(write!(text, "{value}")),
                Some(Value::Number(value)) => text.push_str(&shortest(value)),
                Some(Value::Text(value)) => text.push_str(&csv_field(&value)),
            }
        }
        text.push('\n');
    }
    text
}
