//! Columns of the table of a study, and the row for a case.

use super::Study;
use super::design::PlannedCase;
use super::motions::{MEASURES, Shaken};
use super::space::{self, FinishedCase};
use crate::ensemble::{self, CASE_COLUMNS, CaseColumn};
use barrelstack_report::column::{ColumnSpec, Role, Value, ValueKind};
use barrelstack_space::columns;

/// Columns that every table has before the columns of the factors.
const KEYS: [(&str, ValueKind); 3] =
    [("case", ValueKind::Integer), ("id", ValueKind::Text), ("chunk", ValueKind::Integer)];

/// Columns that identify the motion of a case and its scaling.
const MOTION: [&str; 3] = ["record", "level", "scale_factor"];

/// Returns the meaning of a column, for the data dictionary of the table.
pub(super) fn meaning(spec: &ColumnSpec) -> &'static str {
    match (spec.role, spec.name.as_str()) {
        (Role::Key, "case") => "number of the case in its study",
        (Role::Key, "id") => "unique identifier of the case, independent of the number of cases",
        (Role::Key, _) => "number of the chunk in which the case was run",
        (Role::Factor, _) => "value of a varied field",
        (Role::Motion, "record") => "name of the motion",
        (Role::Motion, "level") => "intensity to which the motion was scaled",
        (Role::Motion, _) => "factor by which the motion was scaled",
        (Role::Intensity, _) => "intensity measure of the scaled motion",
        (Role::Outcome | Role::Demand | Role::Run, name) => {
            ensemble::meaning(name).or_else(|| columns::meaning(name)).unwrap_or("")
        }
    }
}

/// Returns the names of the columns that every table has.
pub(super) fn fixed_columns() -> impl Iterator<Item = &'static str> {
    let keys = KEYS.iter().map(|(name, _)| *name);
    let measures = MEASURES.iter().map(|(name, _)| *name);
    keys.chain(MOTION).chain(measures).chain(CASE_COLUMNS.iter().map(|column| column.name))
}

impl Study {
    /// Returns the columns of the table, in order.
    pub(super) fn columns(&self) -> Vec<ColumnSpec> {
        let unit = self.intensity.as_ref().map_or("", |intensity| intensity.measure.unit());
        let key = |(name, kind): &(&str, ValueKind)| ColumnSpec::new(name, "", Role::Key, *kind);
        let motion = [("", ValueKind::Text), (unit, ValueKind::Number), ("", ValueKind::Number)];
        let motion = MOTION
            .iter()
            .zip(motion)
            .map(|(name, (unit, kind))| ColumnSpec::new(name, unit, Role::Motion, kind));
        let measures = MEASURES.iter().map(|(name, measure)| {
            ColumnSpec::new(name, measure.unit(), Role::Intensity, ValueKind::Number)
        });
        let results = CASE_COLUMNS.iter().map(CaseColumn::spec);
        let factors = self.factors.iter().map(|factor| factor.column.clone());
        let fixed =
            KEYS.iter().map(key).chain(factors).chain(motion).chain(measures).chain(results);
        fixed.chain(columns::specs().filter(|_| self.in_space)).collect()
    }

    /// Returns the table row of a case; `shaken` is `None` if the motion could not be read.
    pub(super) fn row(
        &self,
        case: &PlannedCase,
        chunk: usize,
        shaken: Option<&Shaken>,
        finished: &FinishedCase,
    ) -> Vec<Option<Value>> {
        let mut row = vec![
            Some(Value::Integer(i64::try_from(case.number).unwrap_or(i64::MAX))),
            text(&format!("{:016x}", case.id)),
            i64::try_from(chunk).ok().map(Value::Integer),
        ];
        row.extend((0..self.factors.len()).map(|factor| self.factor_value(case, factor)));
        row.push(text(&self.motions[case.motion].name));
        row.push(case.level.map(Value::Number));
        row.push(shaken.map(|shaken| Value::Number(shaken.factor)));
        let measures = shaken.and_then(|shaken| shaken.measures);
        row.extend((0..MEASURES.len()).map(|at| number(measures.map(|measures| measures[at]))));
        row.extend(CASE_COLUMNS.iter().map(|column| column.of(&finished.result)));
        row.extend(space::values(finished).filter(|_| self.in_space));
        row
    }
}

/// Returns text as a table value; `None` if the text is empty.
fn text(text: &str) -> Option<Value> {
    (!text.is_empty()).then(|| Value::Text(text.to_owned()))
}

/// Returns a number as a table value; `None` for NaN, which could be mistaken for a value in a table.
fn number(value: Option<f64>) -> Option<Value> {
    value.filter(|value| !value.is_nan()).map(Value::Number)
}
