//! Tables of the report page: effects of varied quantities, Sobol' indices, and intensity measures.

use barrelstack_fragility::{Demanded, Interval, Measured};
use barrelstack_report::{Cell, Column, Table};

use super::Decision;
use super::indices::Sensitivity;
use super::measures::MeasureRow;
use super::sensitivity::{Level, alike};
use super::words::{count, percent, range};

pub(super) fn effects(decision: &Decision) -> Table {
    let mut table = Table::new(
        "Share of cases that collapse at each value of every varied quantity, over all motions and levels.",
        &[("quantity", ""), ("value", ""), ("cases", ""), ("collapsed", ""), ("95 % interval", "")],
    );
    let levels = decision.effects.iter().flat_map(|effect| &effect.groups).map(|g| &g.levels);
    let levels = levels.max_by_key(|levels| levels.len()).cloned().unwrap_or_default();
    let measure = decision.cases.measure();
    table.columns.extend(levels.iter().map(|level| {
        Column::new(format!("{} {}", measure.label, measure.words(level.intensity)), "")
    }));
    if !levels.is_empty() {
        table.caption += " Intervals are clustered by motion.";
    }
    let with_interval = |share: f64, interval: Interval| {
        format!("{} ({})", percent(share), range(interval, percent))
    };
    for effect in &decision.effects {
        for (at, group) in effect.groups.iter().enumerate() {
            let first = |text: String| Cell::text(if at == 0 { text } else { String::new() });
            let mut row = vec![
                first(effect.factor.clone()),
                Cell::text(&group.label),
                count(group.cases),
                Cell::text(percent(group.share())),
                Cell::text(range(group.interval, percent)),
            ];
            row.extend(levels.iter().map(|level| {
                let own = group.levels.iter().find(|own| alike(own.intensity, level.intensity));
                let share = |own: &Level| f64::from(own.collapsed) / f64::from(own.cases);
                Cell::maybe(own.map(|own| with_interval(share(own), own.interval)))
            }));
            table.rows.push(row);
        }
    }
    table
}

/// Tabulates the first-order and total index of every varied quantity for every result.
pub(super) fn indices(all: &[Sensitivity]) -> Table {
    let rows = all.iter().flat_map(|of| of.inputs.iter().zip(0..).map(move |one| (of, one)));
    let result = |of: &Sensitivity, at: i32| {
        if at == 0 { of.result.replace('_', " ") } else { String::new() }
    };
    Table::of(
        "Sobol' indices with 95 % intervals (jackknife over blocks).",
        rows.map(|(of, ((name, index), at))| (result(of, at), of.blocks, name, index)),
        &[
            ("result", "", &|(result, ..)| Cell::text(result)),
            ("quantity", "", &|(_, _, name, _)| Cell::text(*name)),
            ("first", "", &|(.., of)| Cell::text(share(of.first))),
            ("95 % interval (first)", "", &|(.., of)| Cell::text(known(of.first_interval))),
            ("total", "", &|(.., of)| Cell::text(share(of.total))),
            ("95 % interval (total)", "", &|(.., of)| Cell::text(known(of.total_interval))),
            ("blocks", "", &|(_, of, ..)| count(u32::try_from(*of).unwrap_or(u32::MAX))),
        ],
    )
}

/// Formats the interval of a Sobol' index, rounded outward so that its printed width is never zero, or states that
/// there are too few blocks for an interval.
fn known(interval: Interval) -> String {
    let (low, high) =
        ((100.0 * interval.low).floor() / 100.0, (100.0 * interval.high).ceil() / 100.0);
    let whole = low <= 0.0 && high >= 1.0;
    if whole { "too few blocks".to_owned() } else { range(Interval { low, high }, share) }
}

/// Formats a share with two decimals.
fn share(value: f64) -> String {
    format!("{value:.2}")
}

pub(super) fn measures(decision: &Decision) -> Table {
    let all = &decision.cases.measures;
    let median = |row: &MeasureRow| match &row.collapse {
        Ok(found) => all[row.measure].words(found.fit.curve.median),
        Err(_) => "no curve".to_owned(),
    };
    let collapse = |row: &MeasureRow, digits, of: fn(&Measured) -> Option<f64>| {
        Cell::number(row.collapse.as_ref().ok().and_then(of), digits)
    };
    let drift =
        |row: &MeasureRow, of: fn(Demanded) -> Option<f64>| Cell::number(row.drift.and_then(of), 2);
    let proficient = |of: Demanded| Some(of.proficiency).filter(|value| *value > 0.0);
    Table::of(
        "Intensity measures as predictors of collapse, and of the drift of stacks that stood; the measure with the \
         largest likelihood comes first.",
        &decision.measures,
        &[
            ("measure", "", &|row| Cell::text(&all[row.measure].label)),
            ("median of collapse", "", &|row| Cell::text(median(row))),
            ("dispersion β", "", &|row| collapse(row, 2, |of| Some(of.fit.curve.dispersion))),
            ("concordance", "", &|row| collapse(row, 2, |of| Some(of.concordance))),
            ("ln likelihood", "", &|row| collapse(row, 4, |of| Some(of.fit.ln_likelihood))),
            ("drift: dispersion", "", &|row| drift(row, |of| Some(of.dispersion))),
            ("drift: dispersion/slope", "", &|row| drift(row, proficient)),
            ("tested against", "", &|row| Cell::maybe(row.beside.map(|at| &all[at].label))),
            ("p (collapse)", "", &|row| collapse(row, 2, |of| of.sufficiency)),
            ("p (drift)", "", &|row| drift(row, |of| of.sufficiency)),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::{Interval, known};

    #[test]
    fn no_interval_of_an_index_loses_its_width_when_it_is_printed() {
        assert_eq!(known(Interval { low: 0.0, high: 0.003 }), "0.00 to 0.01");
        assert_eq!(known(Interval { low: 0.996, high: 1.0 }), "0.99 to 1.00");
        assert_eq!(known(Interval { low: 0.0, high: 1.0 }), "too few blocks");
    }
}
