//! Page section on the uncertain constants of the seats, and on their effects on the share of
//! collapses.

use barrelstack_report::{Axis, Block, Cell, Figure, Plot, Series, Table, significant};

use crate::variants::words::percent;
use crate::variants::{Spread, Unknown};

/// Returns, for each plane, a table of the uncertain constants; and, for all planes, a figure of the share of collapses
/// as a function of the constant that changes it most. Omits planes without a range of the share of collapses
/// ([`Spread::range`]).
///
/// `planes` pairs the words for a plane, such as "along the barrels" (empty for a three-dimensional model), with the
/// statistics of the variants in this plane.
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
        .max_by(|a, b| a.effect().total_cmp(&b.effect()));
    blocks.extend(first.map(|one| Block::Figure(figure(one, &known))));
    blocks
}

fn table(place: &str, spread: &Spread) -> Table {
    let range = spread.range.map(|range| range.map(percent)).unwrap_or_default();
    let shaken = if place.is_empty() { String::new() } else { format!("Shaken {place}: ") };
    let stated = spread.share_as_stated.map(percent).unwrap_or_default();
    let at = |one: &Unknown, place: usize| one.low_median_high().map(|three| *three[place]);
    let value = |one: &Unknown, place| Cell::maybe(at(one, place).map(|at| one.words(at.value)));
    let share = |one: &Unknown, place| Cell::maybe(at(one, place).map(|at| percent(at.share)));
    Table::of(
        format!(
            "{shaken}{} to {} of stacks collapse, depending on the true values of the uncertain constants of the seats \
             (95 % range); {stated} collapse with all of these constants at their medians. For each constant, the table \
             gives the 5 % fractile, the median and the 95 % fractile, and for each of these values the share of \
             stacks that collapse, averaged over the other constants. The column “change” gives the difference \
             between the largest and the smallest share as the constant varies between these fractiles, with its 95 \
             % interval; the constants are in the order of this difference. If all other constants were known, only a \
             part of the variance of the share would remain; the column “variance” gives this part as a fraction. The \
             column “range left” gives the average width of the range of shares that would remain if the constant \
             were measured exactly.",
            range[0], range[1]
        ),
        &spread.decides,
        &[
            ("constant", "", &|one| Cell::text(one.name)),
            ("5 % fractile", "", &|one| value(one, 0)),
            ("collapse", "", &|one| share(one, 0)),
            ("median", "", &|one| value(one, 1)),
            ("collapse", "", &|one| share(one, 1)),
            ("95 % fractile", "", &|one| value(one, 2)),
            ("collapse", "", &|one| share(one, 2)),
            ("change", "%", &|one| {
                let [low, high] =
                    one.difference.map(|end| format!("{:+.0}", 100.0 * end).replace('-', "−"));
                Cell::text(format!("{:+.0} ({low} to {high})", 100.0 * one.effect()))
            }),
            ("variance", "", &|one| Cell::text(significant(one.total, 2))),
            ("range left", "%", &|one| Cell::Measured(100.0 * one.width_if_measured, 0)),
        ],
    )
}

fn figure(one: &Unknown, planes: &[&(&str, &Spread)]) -> Figure {
    let (unit, scale) = one.shown_unit();
    let log = !unit.is_empty();
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
            "Share of stacks that collapse, as a function of the {}, averaged over all other uncertain constants, with its 95 % interval.",
            one.name
        ),
        Plot {
            x: if log { x.log() } else { x },
            y: Axis { range: Some([0.0, 100.0]), ..Axis::new("stacks that collapse", "%") },
            series: series.collect(),
            ..Plot::default()
        },
    )
}
