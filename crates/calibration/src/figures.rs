//! Figures that compare the measurements of a test with the fit.

use barrelstack_report::{Axis, Figure, Plot, Series, SeriesStyle};

use super::Estimate;

/// Number of intervals into which a fitted curve is divided for drawing.
const PLACES: usize = 60;

/// Creates a series of measured values, plotted as points.
pub(super) fn measured(label: &str, x: Vec<f64>, y: Vec<f64>, index: usize) -> Series {
    let style = SeriesStyle { points: true, index: Some(index), ..SeriesStyle::default() };
    Series { style, ..Series::new(label, x, y) }
}

/// Creates a series that is plotted as a line, such as fitted values.
pub(super) fn fitted(label: &str, x: Vec<f64>, y: Vec<f64>, index: usize) -> Series {
    let style = SeriesStyle { index: Some(index), ..SeriesStyle::default() };
    Series { style, ..Series::new(label, x, y) }
}

/// Creates a fitted curve `y = of(x)` between two values of `x`.
pub(super) fn curve(label: &str, [from, to]: [f64; 2], of: impl Fn(f64) -> f64) -> Series {
    let place = |k: usize| from + (to - from) * k as f64 / PLACES as f64;
    let x: Vec<f64> = (0..=PLACES).map(place).collect();
    let y = x.iter().map(|x| of(*x)).collect();
    fitted(label, x, y, 0)
}

/// Creates a horizontal line at the value of an estimate, drawn from one value of `x` to another; the interval of the
/// estimate is shaded.
pub(super) fn level(estimate: &Estimate, [from, to]: [f64; 2], index: usize) -> Series {
    let label = format!("{}, 95 % interval", estimate.name);
    let range = vec![[estimate.low, estimate.high]; 2];
    Series { range, ..fitted(&label, vec![from, to], vec![estimate.value; 2], index) }
}

/// Returns the smallest and the largest value, with a margin.
pub(super) fn span(values: &[f64]) -> [f64; 2] {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let air = 0.04 * (high - low).max(0.1 * high.abs());
    [low - air, high + air]
}

/// Creates a figure of a test.
pub(super) fn figure(id: &str, caption: &str, [x, y]: [Axis; 2], series: Vec<Series>) -> Figure {
    // Time series are interactive, so that a reader can zoom in.
    let interactive = series.iter().all(|one| one.range.is_empty() && !one.style.points);
    Figure::new(id, caption, Plot { x, y, series, interactive, ..Plot::default() })
}
