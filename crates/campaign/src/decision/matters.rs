//! Tables of what matters: varied quantities, and measures of shaking.

use barrelstack_fragility::Interval;
use barrelstack_report::{Cell, Column, Table};

use super::Decision;
use super::cases::Measure;
use super::indices::Sensitivity;
use super::measures::MeasureRow;
use super::sensitivity::alike;
use super::words::{count, percent};

pub(super) fn effects(decision: &Decision) -> Table {
    let mut table = Table::new(
        "Share of collapse at the values of every varied quantity, over all motions and levels.",
        &[("quantity", ""), ("value", ""), ("cases", ""), ("collapsed", ""), ("95 % interval", "")],
    );
    let levels = decision.effects.iter().flat_map(|effect| &effect.groups).map(|g| &g.levels);
    let levels = levels.max_by_key(|levels| levels.len()).cloned().unwrap_or_default();
    let measure = decision.cases.measure();
    table.columns.extend(levels.iter().map(|level| {
        Column::new(format!("{} {}", measure.label, measure.words(level.intensity)), "")
    }));
    if !levels.is_empty() {
        table.caption += " Intervals count motions, not cases.";
    }
    let told = |share: f64, interval: Interval| {
        format!("{} ({} to {})", percent(share), percent(interval.low), percent(interval.high))
    };
    for effect in &decision.effects {
        for (at, group) in effect.groups.iter().enumerate() {
            let first = |text: String| Cell::text(if at == 0 { text } else { String::new() });
            let mut row = vec![
                first(effect.factor.clone()),
                Cell::text(&group.label),
                count(group.cases),
                Cell::text(percent(group.share())),
                Cell::text(format!(
                    "{} to {}",
                    percent(group.interval.low),
                    percent(group.interval.high)
                )),
            ];
            row.extend(levels.iter().map(|level| {
                let own = group.levels.iter().find(|own| alike(own.intensity, level.intensity));
                own.map_or(Cell::Missing, |own| {
                    let share = f64::from(own.collapsed) / f64::from(own.cases);
                    Cell::text(told(share, own.interval))
                })
            }));
            table.rows.push(row);
        }
    }
    table
}

/// First and total indices of everything that varies, on every result.
pub(super) fn indices(all: &[Sensitivity]) -> Table {
    let mut table = Table::new(
        "Sobol' indices with 95 % intervals by resampling of blocks.",
        &[
            ("result", ""),
            ("quantity", ""),
            ("first", ""),
            ("95 % interval (first)", ""),
            ("total", ""),
            ("95 % interval (total)", ""),
            ("blocks", ""),
        ],
    );
    let range = |of: Interval| Cell::text(format!("{} to {}", share(of.low), share(of.high)));
    for of in all {
        for (at, (name, index)) in of.inputs.iter().enumerate() {
            let result = if at == 0 { of.result.replace('_', " ") } else { String::new() };
            table.rows.push(vec![
                Cell::text(result),
                Cell::text(name),
                Cell::text(share(index.first)),
                range(index.first_interval),
                Cell::text(share(index.total)),
                range(index.total_interval),
                count(u32::try_from(of.blocks).unwrap_or(u32::MAX)),
            ]);
        }
    }
    table
}

/// A share of two digits behind the point, that may come out a hair below zero.
fn share(value: f64) -> String {
    let rounded = (100.0 * value).round() / 100.0 + 0.0;
    format!("{rounded:.2}").replace('-', "−")
}

pub(super) fn measures(decision: &Decision) -> Table {
    let cases = &decision.cases;
    let mut table = Table::new(
        "Intensity measures against collapse and against the drift of stacks that stood, the one under which the \
         outcomes are likeliest on top.",
        &[
            ("measure", ""),
            ("median of collapse", ""),
            ("dispersion β", ""),
            ("concordance", ""),
            ("ln likelihood", ""),
            ("drift: dispersion", ""),
            ("drift: dispersion/slope", ""),
            ("beside", ""),
            ("p (collapse)", ""),
            ("p (drift)", ""),
        ],
    );
    for row in &decision.measures {
        table.rows.push(measure_row(row, &cases.measures));
    }
    table
}

fn measure_row(row: &MeasureRow, all: &[Measure]) -> Vec<Cell> {
    let measure = &all[row.measure];
    let number = |value: Option<f64>| value.map_or(Cell::Missing, |v| Cell::Number(v, 2));
    let collapse = row.collapse.as_ref().ok();
    vec![
        Cell::text(&measure.label),
        match &row.collapse {
            Ok(found) => Cell::text(measure.words(found.fit.curve.median)),
            Err(_) => Cell::text("no curve"),
        },
        number(collapse.map(|found| found.fit.curve.dispersion)),
        number(collapse.map(|found| found.concordance)),
        collapse.map_or(Cell::Missing, |found| Cell::Number(found.fit.ln_likelihood, 4)),
        number(row.drift.map(|found| found.dispersion)),
        number(row.drift.map(|found| found.proficiency).filter(|value| *value > 0.0)),
        row.beside.map_or(Cell::Missing, |at| Cell::text(&all[at].label)),
        number(collapse.and_then(|found| found.sufficiency)),
        number(row.drift.and_then(|found| found.sufficiency)),
    ]
}
