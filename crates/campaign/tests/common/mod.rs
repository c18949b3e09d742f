//! Studies of a few milliseconds a case, and tables made by hand.

#![allow(dead_code, reason = "each suite uses a part")]

use std::io::Write as _;

use barrelstack_campaign::study::{
    Collected, Column, ColumnSpec, MotionSource, Provenance, Role, StudyTable, ValueKind, Values,
};

/// Two barrels on two levels; the duration of shaking is appended.
pub(crate) const HEAD: &str = "\
schema = 1
title = \"two barrels for a moment\"
seed = 7
[base.stack]
levels = 2
columns = 2
[base.run]
";

fn spec(name: &str, unit: &str, role: Role, kind: ValueKind) -> ColumnSpec {
    ColumnSpec { name: name.into(), unit: unit.into(), role, kind }
}

pub(crate) fn number(name: &str, unit: &str, role: Role, values: Vec<Option<f64>>) -> Column {
    Column { spec: spec(name, unit, role, ValueKind::Number), values: Values::Number(values) }
}

pub(crate) fn text(name: &str, role: Role, values: Vec<Option<String>>) -> Column {
    Column { spec: spec(name, "", role, ValueKind::Text), values: Values::Text(values) }
}

pub(crate) fn integer(name: &str, role: Role, values: Vec<Option<i64>>) -> Column {
    Column { spec: spec(name, "", role, ValueKind::Integer), values: Values::Integer(values) }
}

/// A finished study over PGV with a table of these columns, under motions called `motion` and a number.
pub(crate) fn made(
    columns: Vec<Column>,
    design: &str,
    drawn: &[&str],
    motion: &str,
    motions: usize,
) -> Collected {
    let table = StudyTable::new(columns).unwrap();
    let of = |k: usize| MotionSource {
        name: format!("{motion}{k}"),
        source: "made".into(),
        hash: None,
        key: k.to_string(),
    };
    let provenance = Provenance {
        schema: 1,
        program: "barrelstack".into(),
        version: "0".into(),
        title: "made by hand".into(),
        text_hash: String::new(),
        study_hash: "0".into(),
        seed: 7,
        design: design.into(),
        measure: Some("pgv".into()),
        stop: None,
        drawn: drawn.iter().map(|name| (*name).to_owned()).collect(),
        varied: Vec::new(),
        common: Vec::new(),
        motions: (0..motions).map(of).collect(),
        columns: table.specs().cloned().collect(),
        chunks: 1,
        chunks_done: 1,
        cases: table.rows(),
        complete: true,
    };
    Collected { table, provenance }
}

/// Reports a skipped test.
pub(crate) fn skipped(why: &str) {
    // Write to the terminal directly: the runner captures `print!` of passing tests.
    std::io::stdout().write_all(format!("skipped: {why}\n").as_bytes()).unwrap();
}
