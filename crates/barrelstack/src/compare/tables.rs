//! Tables of a comparison, with one column per run.

use barrelstack_report::{Cell, Column, Table};

use super::{Difference, Side, letter};
use crate::demand::DEMANDS;
use crate::report;
use crate::variants::Spread;
use crate::variants::words::{course, course_in_plane, percent};

/// Creates an empty table: the `first` columns, one column per run, then the `last` columns.
fn table(caption: &str, first: &[(&str, &str)], sides: &[Side], last: &[(&str, &str)]) -> Table {
    let mut table = Table::new(caption, first);
    let letters = sides.iter().enumerate().map(|(at, _)| Column::new(letter(at), ""));
    table.columns.extend(letters);
    table.columns.extend(last.iter().map(|(name, unit)| Column::new(*name, *unit)));
    table
}

/// Tabulates the inputs that differ between runs; `names` are the names of the runs.
pub fn inputs(names: &[String], differing: &[Difference]) -> Table {
    let mut table = Table::new(
        "Inputs that differ between the runs. All other inputs are equal.",
        &[("input", "")],
    );
    table.columns.extend(names.iter().map(|name| Column::new(name, "")));
    table.columns.push(Column::new("meaning", ""));
    for one in differing {
        let mut row = vec![Cell::verbatim(&one.path)];
        let shown = |value: &String| report::shown(&one.path, value);
        let cell = |value: &Option<String>| {
            value.as_ref().map_or(Cell::Missing, |value| Cell::verbatim(shown(value)))
        };
        row.extend(one.values.iter().map(cell));
        row.push(Cell::text(one.help));
        table.rows.push(row);
    }
    table
}

/// Tabulates the inputs that are equal in all runs.
pub(super) fn common(sides: &[Side], differing: &[Difference]) -> Table {
    let mut settings: Vec<_> = sides.iter().take(1).flat_map(|one| one.stated.settings()).collect();
    settings.retain(|setting| differing.iter().all(|one| one.path != setting.path));
    report::settings_table("Inputs that all runs share.", &settings)
}

/// Tabulates the outcome of each run.
pub(super) fn outcomes(sides: &[Side]) -> Table {
    let mut table = table("Outcome of each run.", &[("", "")], sides, &[]);
    let mut row = |name: &str, cell: &dyn Fn(&Side) -> Cell| {
        let mut row = vec![Cell::text(name)];
        row.extend(sides.iter().map(cell));
        table.rows.push(row);
    };
    let seconds = |time: Option<f64>| Cell::maybe(time.map(|time| format!("{time:.2} s")));
    row("run", &|side| Cell::text(&side.name));
    let collapse = |spread: Option<&Spread>| {
        Cell::maybe(spread.map(|Spread { collapsed, variants, interval, .. }| {
            let [low, high] = interval.map(percent);
            format!("{collapsed} of {variants} ({low} to {high})")
        }))
    };
    if sides.iter().any(|side| side.summary.ensemble().is_some()) {
        row("variants that collapse, with the 95 % interval of their share", &|side| {
            collapse(side.summary.ensemble())
        });
        row("first loss of a seat, and barrels fallen, in the variants that collapse", &|side| {
            let spread = side.summary.ensemble().filter(|spread| spread.collapsed > 0);
            let course = if side.other.is_some() { course_in_plane } else { course };
            Cell::maybe(spread.map(course))
        });
        row("run that is shown", &|side| match side.summary.variant() {
            0 => Cell::text("as stated"),
            number => Cell::text(format!("variant {number}")),
        });
        if sides.iter().any(|side| side.other.is_some()) {
            row("variants that collapse in the other plane", &|side| {
                collapse(side.other.as_ref().and_then(|other| other.spread.as_ref()))
            });
        }
    }
    row("outcome", &|side| Cell::text(side.summary.outcome().kind));
    if sides.iter().any(|side| side.other.is_some()) {
        row("outcome in the other plane", &|side| {
            Cell::maybe(side.other.as_ref().map(|other| other.outcome.kind()))
        });
    }
    row("mode", &|side| Cell::maybe(side.summary.outcome().mode));
    row("gives way after", &|side| seconds(side.summary.outcome().time));
    row("first body to lose its seat", &|side| Cell::maybe(side.summary.outcome().first.as_ref()));
    row("first fall of a barrel", &|side| seconds(side.summary.outcome().first_fall));
    row("barrels fallen", &|side| {
        let outcome = side.summary.outcome();
        let place = if side.other.is_some() { " in this plane" } else { "" };
        let fallen = outcome.barrels_fallen;
        Cell::maybe(fallen.map(|fallen| format!("{fallen} of {}{place}", outcome.barrels)))
    });
    row("end of the run", &|side| seconds(Some(side.end_time)));
    table
}

/// Tabulates the demands on each stack until its first loss of a seat.
pub(super) fn demands(sides: &[Side]) -> Table {
    let mut table = table(
        "Demands on each stack until its first loss of a seat, except the slip at the end of the run. The report of a \
         single run also states the demands over the whole run.",
        &[("demand", ""), ("unit", "")],
        sides,
        &[],
    );
    for demand in DEMANDS {
        let shown = |side: &Side| demand.shown(side.summary.demands());
        let values: Vec<Option<f64>> = sides.iter().map(shown).collect();
        if values.iter().all(Option::is_none) {
            continue;
        }
        let mut row = vec![Cell::text(demand.label), Cell::text(demand.shown_unit)];
        row.extend(values.into_iter().map(|value| Cell::measured(value, demand.decimals)));
        table.rows.push(row);
    }
    table
}
