//! What tables of cases in space have besides: where things went.

use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, Values};

use crate::fate::Heading;
use crate::variants::Case;

/// The column of the way of the first body, and that of barrels that came to lie each way.
const COLUMNS: [(&str, ValueKind, &str); 5] = [
    (
        "heading",
        ValueKind::Text,
        "in which direction the first body left its seat: right or left across the barrels, away or near along them",
    ),
    (
        "debris_right",
        ValueKind::Integer,
        "fallen barrels that came to lie to the right of where they stood, more than along the barrels",
    ),
    ("debris_left", ValueKind::Integer, "the same to the left"),
    (
        "debris_away",
        ValueKind::Integer,
        "fallen barrels that came to lie away along the barrels, more than across them",
    ),
    ("debris_near", ValueKind::Integer, "the same the other way along the barrels"),
];

/// The columns, in the order of [`values`].
pub fn specs() -> impl Iterator<Item = ColumnSpec> {
    COLUMNS.iter().map(|(name, kind, _)| ColumnSpec::new(name, "", Role::Outcome, *kind))
}

/// What a column means; none where it is not of space.
pub fn meaning(name: &str) -> Option<&'static str> {
    COLUMNS.iter().find(|(known, ..)| *known == name).map(|(.., meaning)| *meaning)
}

/// The values of a case: the way of the first body, if one left its seat, and those of fallen barrels; none of a case
/// without a verdict.
pub fn values(ways: Option<(Option<Heading>, &[Heading])>) -> impl Iterator<Item = Option<Value>> {
    let first = ways.and_then(|(first, _)| first).map(|way| Value::Text(way.name().to_owned()));
    let lie = move |way: Heading| {
        let barrels = ways?.1.iter().filter(|one| **one == way).count();
        i64::try_from(barrels).ok().map(Value::Integer)
    };
    std::iter::once(first).chain(Heading::ALL.into_iter().map(lie))
}

/// The columns of cases.
pub fn table(cases: &[Case]) -> Vec<Column> {
    let rows: Vec<Vec<Option<Value>>> =
        cases.iter().map(|case| values(case.ways()).collect()).collect();
    let text = |value: &Option<Value>| match value {
        Some(Value::Text(text)) => Some(text.clone()),
        _ => None,
    };
    let count = |value: &Option<Value>| match value {
        Some(Value::Integer(count)) => Some(*count),
        _ => None,
    };
    let column = |(at, spec): (usize, ColumnSpec)| {
        let values = rows.iter().map(|row| &row[at]);
        let values = match spec.kind {
            ValueKind::Text => Values::Text(values.map(text).collect()),
            ValueKind::Integer | ValueKind::Number => Values::Integer(values.map(count).collect()),
        };
        Column { spec, values }
    };
    specs().enumerate().map(column).collect()
}
