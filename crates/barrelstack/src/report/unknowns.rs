//! Page section on the constants that nobody has measured, and on their effects on the share of
//! collapses.

use barrelstack_report::{Axis, Block, Cell, Figure, Plot, Series, Table, significant};

use crate::variants::words::percent;
use crate::variants::{Spread, Unknown};

/// Returns a table of the unknown constants for each plane, and a figure of the share of collapses
/// as a function of the most influential constant. Planes without a known range are omitted. Each
/// spread is given with the words for its plane, such as "along the barrels", which are empty in
/// space.
pub fn unknowns(planes: &[(&str, &Spread)]) -> Vec<Block> {
    let known: Vec<&(&str, &Spread)> =
        planes.iter().filter(|(_, spread)| spread.range.is_some()).collect();
    if known.is_empty() {
        return Vec::new();
    }
    let mut blocks: Vec<Block> =
        known.iter().map(|(place, spread)| Block::Table(table(place, spread))).collect();
    let first = known
        .iter()
        .filter_map(|(_, spread)| spread.decides.first())
        .max_by(|a, b| effect(a).total_cmp(&effect(b)));
    blocks.extend(first.map(|one| Block::Figure(figure(one, &known))));
    blocks
}

fn effect(one: &Unknown) -> f64 {
    one.ends().map_or(0.0, |[first, last]| (last.share - first.share).abs())
}

fn table(place: &str, spread: &Spread) -> Table {
    let range = spread.range.map(|range| range.map(percent)).unwrap_or_default();
    let shaken = if place.is_empty() { String::new() } else { format!("Shaken {place}: ") };
    let stated = spread.share_as_stated.map(percent).unwrap_or_default();
    Table::of(
        format!(
            "{shaken}{} to {} of stacks collapse, depending on the constants that nobody has measured; {stated} collapse with all of these constants as stated. Each constant is given at its 5 % and its 95 % fractile, with the share of collapses averaged over the other constants, and the 95 % interval of the change. The last column is the average width of the range once the constant is measured.",
            range[0], range[1]
        ),
        &spread.decides,
        &[
            ("constant", "", &|one| Cell::text(one.name)),
            ("from", "", &|one| Cell::maybe(one.ends().map(|[end, _]| one.words(end.value)))),
            ("collapse", "", &|one| Cell::maybe(one.ends().map(|[end, _]| percent(end.share)))),
            ("to", "", &|one| Cell::maybe(one.ends().map(|[_, end]| one.words(end.value)))),
            ("collapse", "", &|one| Cell::maybe(one.ends().map(|[_, end]| percent(end.share)))),
            ("change", "percentage points", &|one| {
                let [low, high] = one.difference.map(|end| format!("{:+.0}", 100.0 * end));
                Cell::text(format!("{low} to {high}"))
            }),
            ("share of the variance", "", &|one| Cell::text(significant(one.total, 2))),
            ("range if measured", "percentage points", &|one| {
                Cell::Measured(100.0 * one.width_if_measured, 0)
            }),
        ],
    )
}

fn figure(one: &Unknown, planes: &[&(&str, &Spread)]) -> Figure {
    let mega = one.unit != "1";
    let scale = if mega { 1e-6 } else { 1.0 };
    let unit = if mega { format!("M{}", one.unit) } else { String::new() };
    let series = planes.iter().filter_map(|(place, spread)| {
        let same = spread.decides.iter().find(|other| other.field == one.field)?;
        Some(Series {
            range: same.shares.iter().map(|at| at.interval.map(|end| 100.0 * end)).collect(),
            ..Series::new(
                if place.is_empty() { "stacks that collapse" } else { place },
                same.shares.iter().map(|at| scale * at.value).collect(),
                same.shares.iter().map(|at| 100.0 * at.share).collect(),
            )
        })
    });
    let x = Axis::new(one.name, unit);
    Figure::new(
        "decides",
        format!(
            "Share of stacks that collapse, as a function of the {}, averaged over all other unknown constants, with its 95 % interval.",
            one.name
        ),
        Plot {
            x: if mega { x.log() } else { x },
            y: Axis { range: Some([0.0, 100.0]), ..Axis::new("stacks that collapse", "%") },
            series: series.collect(),
            ..Plot::default()
        },
    )
}
