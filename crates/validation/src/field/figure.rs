//! Figure of the hindcast of South Napa: the share of barrels on the floor as a function of the friction of barrels on
//! racks, and the prior and posterior densities of this friction.

use barrelstack_report::{Axis, Figure, Mark, Panels, Plot, Series, SeriesStyle};

use super::results::Results;

/// Draws the figure.
pub(super) fn figure(results: &Results) -> Figure {
    let x = || Axis::new("friction of barrels on racks", "").log();
    let friction: Vec<f64> = results.curve.iter().map(|(friction, _)| *friction).collect();
    let share = Series {
        range: results.curve.iter().map(|(_, range)| [range.low, range.high]).collect(),
        ..Series::new(
            "model: median and central 90 % over all else",
            friction,
            results.curve.iter().map(|(_, range)| range.median).collect(),
        )
    };
    let mark = |at: f64, label: &str| Mark { at, label: label.to_owned() };
    let shares = Plot {
        x: x(),
        y: Axis { range: Some([0.0, 1.0]), ..Axis::new("share of barrels on the floor", "") },
        series: vec![share],
        levels: vec![mark(0.35, ""), mark(0.5, "half (35 to 65 %)"), mark(0.65, "")],
        marks: vec![mark(0.30, "catalog")],
        ..Plot::default()
    };
    let line = |label: &str, column: usize, index: usize| Series {
        style: SeriesStyle { index: Some(index), ..SeriesStyle::default() },
        ..Series::new(
            label,
            results.densities.iter().map(|row| row[0]).collect(),
            results.densities.iter().map(|row| row[column]).collect(),
        )
    };
    let densities = Plot {
        x: x(),
        y: Axis::new("density per unit of ln μ", ""),
        series: vec![
            line("prior", 1, 3),
            line("given half of the barrels", 2, 0),
            line("given all statements", 3, 1),
        ],
        marks: vec![mark(0.22, "paper"), mark(0.30, "catalog")],
        ..Plot::default()
    };
    let panels = Panels {
        title: "South Napa 2014, stacks of four to six levels in space".to_owned(),
        lines: vec![],
        rows: vec![vec![shares, densities]],
    };
    Figure::new(
        "field",
        "Left: share of barrels on the floor against the friction of barrels on racks. Right: that friction before and \
         after the observations.",
        panels,
    )
}
