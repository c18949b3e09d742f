//! Studies whose cases take a few milliseconds, and tables with known contents.

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

/// Returns a finished study with PGV as its measure and a table of the given columns; motions are called `motion` and a
/// number.
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
        stacks: Some("stacks of 4 levels on two-barrel racks, shaken along the barrels".into()),
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

/// Returns a study of twelve records at eight levels; `falls` returns how many of six barrels fall for a record at a
/// level (m/s).
pub(crate) fn study(falls: impl Fn(usize, f64) -> usize) -> Collected {
    let levels = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
    let cases: Vec<(usize, f64)> =
        (0..12).flat_map(|record| levels.map(|level| (record, level))).collect();
    let count: Vec<usize> = cases.iter().map(|(record, level)| falls(*record, *level)).collect();
    let each = |of: &dyn Fn(usize, f64, usize) -> Option<f64>| -> Vec<Option<f64>> {
        cases.iter().zip(&count).map(|((r, x), n)| of(*r, *x, *n)).collect()
    };
    let say = |of: &dyn Fn(usize) -> Option<String>| count.iter().map(|n| of(*n)).collect();
    let rows = cases.len();
    let columns = vec![
        integer("case", Role::Key, (0..rows).map(|row| i64::try_from(row).ok()).collect()),
        number("friction", "", Role::Factor, each(&|r, _, _| Some(0.3 + 0.02 * r as f64))),
        text(
            "record",
            Role::Motion,
            cases.iter().map(|(r, _)| Some(format!("record {r}"))).collect(),
        ),
        number("level", "m/s", Role::Motion, each(&|_, x, _| Some(x))),
        number("pga", "m/s2", Role::Intensity, each(&|r, x, _| Some(x * (6.0 + 0.5 * r as f64)))),
        number("pgv", "m/s", Role::Intensity, each(&|_, x, _| Some(x * (1.0 + 1e-12)))),
        text(
            "outcome",
            Role::Outcome,
            say(&|n| Some(if n > 0 { "collapse" } else { "stable" }.into())),
        ),
        text("ended", Role::Run, vec![Some("rest".into()); rows]),
        number("motion_left", "s", Role::Run, vec![Some(0.0); rows]),
        text("mode", Role::Outcome, say(&|n| (n > 0).then(|| "rocking".into()))),
        integer("barrels", Role::Outcome, vec![Some(6); rows]),
        text("fall_heights", Role::Outcome, say(&|n| (n > 0).then(|| vec!["1.8"; n].join(";")))),
        text("fall_forces", Role::Outcome, say(&|n| (n > 0).then(|| vec!["1.1e6"; n].join(";")))),
        text("fall_wine", Role::Outcome, say(&|n| (n > 0).then(|| vec!["0.225"; n].join(";")))),
        number("stack_wine", "m3", Role::Outcome, vec![Some(6.0 * 0.225); rows]),
        number("top_drift_ratio", "", Role::Demand, each(&|_, x, n| (n == 0).then_some(0.05 * x))),
    ];
    made(columns, "stripes", &["friction"], "record ", 12)
}

/// Returns the capacity of a record (m/s), a quantile of a lognormal distribution of median 0.5 and dispersion 0.3.
pub(crate) fn capacity(record: usize) -> f64 {
    let share = (record as f64 + 0.5) / 12.0;
    0.5 * (0.3 * barrelstack_fragility::normal_quantile(share)).exp()
}

pub(crate) fn ordinary() -> Collected {
    study(|record, level| if level >= capacity(record) { 4 } else { 0 })
}

/// Reports a skipped test.
pub(crate) fn skipped(why: &str) {
    // Write to the terminal directly: the runner captures `print!` of passing tests.
    std::io::stdout().write_all(format!("skipped: {why}\n").as_bytes()).unwrap();
}
