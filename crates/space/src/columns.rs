//! Additional columns, with the directions of falls, for tables of three-dimensional cases.

use barrelstack::ensemble;
use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, Values};

use crate::fate::Heading;
use crate::variants::Case;

/// Name, kind and meaning of each column: the direction in which the first body left its seat, and the numbers of
/// barrels that fell in each direction.
const COLUMNS: [(&str, ValueKind, &str); 5] = [
    (
        "heading",
        ValueKind::Text,
        "direction in which the first body left its seat: right or left across the barrels, away \
         or near along the barrels",
    ),
    (
        "debris_right",
        ValueKind::Integer,
        "number of fallen barrels whose displacement from rest is mainly to the right",
    ),
    (
        "debris_left",
        ValueKind::Integer,
        "number of fallen barrels whose displacement from rest is mainly to the left",
    ),
    (
        "debris_away",
        ValueKind::Integer,
        "number of fallen barrels whose displacement from rest is mainly along the barrels, away \
         from the viewer",
    ),
    (
        "debris_near",
        ValueKind::Integer,
        "number of fallen barrels whose displacement from rest is mainly along the barrels, toward \
         the near side",
    ),
];

/// Returns the specifications of the columns, in the order of [`values`].
pub fn specs() -> impl Iterator<Item = ColumnSpec> {
    COLUMNS.iter().map(|(name, kind, _)| ColumnSpec::new(name, "", Role::Outcome, *kind))
}

/// Returns the meaning of a column; `None` if the column does not belong to this module.
pub fn meaning(name: &str) -> Option<&'static str> {
    COLUMNS.iter().find(|(known, ..)| *known == name).map(|(.., meaning)| *meaning)
}

/// Returns the values of a case, in the order of [`specs`].
///
/// `headings` contains the direction in which the first body left its seat, if any body did, and the directions of the
/// fallen barrels. It is `None` for a case that is neither stable nor a collapse.
pub fn values(
    headings: Option<(Option<Heading>, &[Heading])>,
) -> impl Iterator<Item = Option<Value>> {
    let first =
        headings.and_then(|(first, _)| first).map(|heading| Value::Text(heading.name().to_owned()));
    let lie = move |heading: Heading| {
        let barrels = headings?.1.iter().filter(|one| **one == heading).count();
        i64::try_from(barrels).ok().map(Value::Integer)
    };
    std::iter::once(first).chain(Heading::ALL.into_iter().map(lie))
}

/// Returns the table of the variants of a stack; variant 0 is the scenario as stated. The table has the columns of the
/// table for a plane model, followed by the columns of this module. Interrupted cases have no row.
pub fn variants(cases: &[Case]) -> Vec<Column> {
    let mut all = ensemble::variants(cases.iter().map(|case| &case.result));
    let ended = cases.iter().filter(|case| !case.result.is_interrupted());
    let rows: Vec<Vec<Option<Value>>> =
        ended.map(|case| values(case.headings()).collect()).collect();
    let text = |value: &Option<Value>| match value {
        Some(Value::Text(text)) => Some(text.clone()),
        _ => None,
    };
    let count = |value: &Option<Value>| match value {
        Some(Value::Integer(count)) => Some(*count),
        _ => None,
    };
    all.extend(specs().enumerate().map(|(at, spec)| {
        let values = rows.iter().map(|row| &row[at]);
        let values = match spec.kind {
            ValueKind::Text => Values::Text(values.map(text).collect()),
            ValueKind::Integer | ValueKind::Number => Values::Integer(values.map(count).collect()),
        };
        Column { spec, values }
    }));
    all
}
