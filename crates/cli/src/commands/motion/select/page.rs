//! Page of a selection: spectra compared with the target, spread of the spectra, and records.

use barrelstack_motion::STANDARD_GRAVITY;
use barrelstack_report::{
    Axis, Block, Cell, Document, Figure, Plot, Series, SeriesStyle, Table, Verdict,
};
use barrelstack_selection::{Candidate, SelectionTarget};

use super::set::Set;
use crate::commands::page;

/// Writes `index.html`, `index.md` and the figures.
pub(super) fn write(
    set: &Set<'_>,
    target: &SelectionTarget,
    candidates: &[Candidate],
    statement: &str,
) -> anyhow::Result<()> {
    let document = document(set, target, candidates, statement);
    page::write(&set.args.out, &set.args.language.page(&document), &[])
}

fn document(
    set: &Set<'_>,
    target: &SelectionTarget,
    candidates: &[Candidate],
    statement: &str,
) -> Document {
    let args = set.args;
    let given = target.condition().map(|(_, given)| {
        format!(
            "Every record is scaled to Sa({} s) = {:.3} g; the target is the spectrum conditional on this value.",
            given.period,
            given.acceleration / STANDARD_GRAVITY
        )
    });
    let sentences = [Some(format!("{}.", set.fit(target))), given, Some(format!("{statement}."))];
    let mut blocks =
        vec![Block::heading(2, "Spectra"), Block::Figure(spectra(set, target, candidates))];
    if target.deviation().iter().any(|s| *s > 0.0) {
        blocks.push(Block::Figure(spread(set, target)));
    }
    blocks.push(Block::heading(2, "Records"));
    blocks.push(Block::Table(records(set)));
    let limit = |range: Option<super::Range>| {
        range.map_or("none".to_owned(), |range| {
            let [from, to] = range.ends();
            if to == f64::MAX { format!("from {from}") } else { format!("{from} to {to}") }
        })
    };
    let provenance = [
        ("target", args.target.clone()),
        ("spectrum", args.spectrum.name().to_owned()),
        ("factors", limit(Some(args.scale))),
        ("magnitude", limit(args.limits.magnitude)),
        ("distance (km)", limit(args.limits.distance)),
        ("Vs30 (m/s)", limit(args.limits.vs30)),
        ("maximum per event", args.most_of_event.map_or("no limit".to_owned(), |n| n.to_string())),
        ("seed", args.seed.to_string()),
        ("method", "Jayaram, Lin and Baker (2011)".to_owned()),
        ("correlations", "Baker and Jayaram (2008)".to_owned()),
        ("program", concat!("barrelstack ", env!("CARGO_PKG_VERSION")).to_owned()),
    ];
    Document {
        title: format!("{} records for {}", set.selection.chosen.len(), args.target),
        verdict: Verdict {
            headline: format!("{} records chosen.", set.selection.chosen.len()),
            sentences: sentences.into_iter().flatten().collect(),
            ..Verdict::default()
        },
        blocks,
        provenance: provenance.into_iter().map(|(k, v)| (k.to_owned(), v)).collect(),
        warnings: Vec::new(),
        ..Document::default()
    }
}

/// Plots all selected spectra, and the medians of the set and of the target with bands of two
/// standard deviations.
fn spectra(set: &Set<'_>, target: &SelectionTarget, candidates: &[Candidate]) -> Figure {
    let periods = target.periods().to_vec();
    let line = |label: &str, values: Vec<f64>, style: SeriesStyle| Series {
        label: label.to_owned(),
        x: periods.clone(),
        y: values,
        style,
        ..Series::default()
    };
    let color = |index: usize| SeriesStyle { index: Some(index), ..SeriesStyle::default() };
    let muted = SeriesStyle { muted: true, ..SeriesStyle::default() };
    #[expect(clippy::disallowed_methods, reason = "a position in a picture needs few digits")]
    let in_g = |log: f64| log.exp() / STANDARD_GRAVITY;
    let moments = |mean: &[f64], deviation: &[f64], by: f64| -> Vec<f64> {
        mean.iter().zip(deviation).map(|(m, s)| in_g(m + by * s)).collect()
    };
    let mut series: Vec<Series> = set
        .selection
        .chosen
        .iter()
        .map(|chosen| {
            let scaled = candidates[chosen.candidate].spectrum.iter();
            let values = scaled.map(|sa| chosen.scale * sa / STANDARD_GRAVITY).collect();
            line("", values, muted)
        })
        .collect();
    let (mean, deviation) = (target.mean(), target.deviation());
    series.push(line("target, median", moments(mean, deviation, 0.0), color(0)));
    series.push(line("set, median", moments(&set.selection.mean, deviation, 0.0), color(1)));
    if deviation.iter().any(|s| *s > 0.0) {
        for by in [-2.0, 2.0] {
            let label = if by > 0.0 { "target ± 2 standard deviations" } else { "" };
            series.push(line(label, moments(mean, deviation, by), color(2)));
            let label = if by > 0.0 { "set ± 2 standard deviations" } else { "" };
            let own = moments(&set.selection.mean, &set.selection.deviation, by);
            series.push(line(label, own, color(3)));
        }
    }
    let plot = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new("pseudo-acceleration, 5 %", "g").log(),
        series,
        ..Plot::default()
    };
    let caption = format!(
        "Spectra of the {} records as scaled (thin; {}), their median, and the target.",
        set.selection.chosen.len(),
        set.args.spectrum.name()
    );
    Figure::new("spectra", caption, plot)
}

/// Plots the standard deviations of ln Sa.
fn spread(set: &Set<'_>, target: &SelectionTarget) -> Figure {
    let periods = target.periods().to_vec();
    let plot = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new("standard deviation of ln Sa", ""),
        series: vec![
            Series::new("target", periods.clone(), target.deviation().to_vec()),
            Series::new("set", periods, set.selection.deviation.clone()),
        ],
        ..Plot::default()
    };
    let caption = "Spread of the set and of the target at each period.".to_owned();
    Figure::new("spread", caption, plot)
}

fn records(set: &Set<'_>) -> Table {
    let head = [
        ("record", ""),
        ("event", ""),
        ("factor", ""),
        ("magnitude", ""),
        ("to rupture", "km"),
        ("to epicenter", "km"),
        ("Vs30", "m/s"),
        ("PGA", "g"),
        ("PGV", "cm/s"),
        ("D5-95", "s"),
    ];
    let mut table = Table::new(
        "Records of the set, with PGA and PGV of the first horizontal as scaled.",
        &head,
    );
    for (row, chosen) in set.chosen() {
        let number = |column: &str, factor: f64, digits: usize| {
            set.number(column, row).map_or(Cell::text(""), |v| Cell::Number(factor * v, digits))
        };
        table.rows.push(vec![
            Cell::text(set.text("record", row)),
            Cell::text(set.text("event", row)),
            Cell::Number(chosen.scale, 3),
            number("magnitude", 1.0, 3),
            number("rupture_distance", 1.0, 3),
            number("epicentral_distance", 1.0, 3),
            number("vs30", 1.0, 3),
            number("pga_h1", chosen.scale / STANDARD_GRAVITY, 3),
            number("pgv_h1", 100.0 * chosen.scale, 3),
            number("d5_95_h1", 1.0, 3),
        ]);
    }
    table
}
