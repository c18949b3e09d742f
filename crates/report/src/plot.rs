//! A plot: series on a pair of axes, with marks, levels and bands.

use serde::Serialize;

use crate::{csv_field, number, style::DASHES, with_unit};

/// A plot of series on a pair of axes.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Plot {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lines.
    pub series: Vec<Series>,
    /// Vertical lines at given values of x.
    pub marks: Vec<Mark>,
    /// Horizontal lines at given values of y.
    pub levels: Vec<Mark>,
    /// Shaded intervals of x.
    pub bands: Vec<Band>,
    /// `true` if the page draws the plot interactively, with readout and zoom. If x decreases
    /// anywhere in a series, as in a hysteresis loop, the plot is nevertheless drawn as SVG.
    pub interactive: bool,
    /// `true` if x is the time of the run (s), so that the cursor and the zoom are shared with the
    /// player and with all other plots over the time of the run. Applies to interactive plots only.
    pub timeline: bool,
}

/// An axis.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Axis {
    /// Name of the quantity.
    pub label: String,
    /// Unit, shown in parentheses; empty for a dimensionless number.
    pub unit: String,
    /// Scale of the axis.
    pub scale: Scale,
    /// Range to show. If it is `None`, empty, reversed or not finite, the range of the data is
    /// shown.
    pub range: Option<[f64; 2]>,
    /// Names of the categories on a vertical axis, from top to bottom, which replace the ticks; empty
    /// for a numeric axis. [`Axis::row`] gives the ordinate of each name.
    pub names: Vec<String>,
}

impl Axis {
    /// Creates a linear axis that shows the range of the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// Returns the axis with a logarithmic scale; values at or below zero become gaps.
    #[must_use]
    pub fn log(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// Creates a category axis with these names, from top to bottom; [`Axis::row`] gives the ordinate of a
    /// name.
    pub fn named(names: Vec<String>) -> Self {
        Self { range: Some([-(names.len() as f64) - 0.5, -0.5]), names, ..Self::default() }
    }

    /// Returns the ordinate of the category name with index `place`, counted from 0.
    pub fn row(place: usize) -> f64 {
        -(place as f64) - 1.0
    }

    /// Formats an ordinate for CSV; on a category axis, returns the nearest name.
    fn csv_ordinate(&self, value: f64) -> String {
        let rows = (0..self.names.len()).filter(|place| (value - Self::row(*place)).abs() <= 0.5);
        match rows.map(|place| csv_field(&self.names[place])).next() {
            Some(name) => name,
            None => number::csv_number(value),
        }
    }

    /// Returns the name and unit as printed beside the axis.
    pub(crate) fn title(&self) -> String {
        if self.label.is_empty() {
            return self.unit.clone();
        }
        with_unit(&self.label, &self.unit)
    }

    /// `true` if the axis can show `value`.
    pub(crate) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }
}

/// Mapping from data values to positions along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scale {
    /// Linear: equal differences have equal lengths on the axis.
    #[default]
    Linear,
    /// Logarithmic: equal ratios have equal lengths on the axis.
    Log,
}

/// One line of a plot.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Series {
    /// Name in the legend.
    pub label: String,
    /// Abscissas. If `x` and `y` differ in length, the surplus values of the longer one are not drawn.
    pub x: Vec<f64>,
    /// Ordinates; a value that is not finite makes a gap.
    pub y: Vec<f64>,
    /// Lower and upper bound of each ordinate, drawn as a filled band around the line or, with
    /// [`SeriesStyle::points`], as a bar through each point. Empty if unknown.
    pub range: Vec<[f64; 2]>,
    /// Drawing style.
    pub style: SeriesStyle,
}

impl Series {
    /// Creates a plain line.
    pub fn new(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { label: label.into(), x, y, ..Self::default() }
    }

    /// Creates thick bars for a category axis. For each bar, `bars` contains the index of its name and the values of x
    /// at its two ends.
    pub fn bars(
        label: impl Into<String>,
        bars: impl IntoIterator<Item = (usize, [f64; 2])>,
    ) -> Self {
        let style = SeriesStyle { bar: true, index: Some(0), ..SeriesStyle::default() };
        let mut series = Self { style, ..Self::new(label, Vec::new(), Vec::new()) };
        for (row, [from, to]) in bars {
            // NaN breaks the line between one bar and the next.
            series.x.extend([from, to, f64::NAN]);
            series.y.extend([Axis::row(row); 3]);
        }
        series
    }

    pub(crate) fn len(&self) -> usize {
        self.x.len().min(self.y.len())
    }
}

/// Drawing style of a series.
#[expect(clippy::struct_excessive_bools, reason = "the options are independent")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SeriesStyle {
    /// Index of the color and the dash pattern, from 0; if `None`, the index of the series in the
    /// plot. Colors repeat after six, each time with a different dash pattern.
    pub index: Option<usize>,
    /// `true` to shade the area between the line and zero (or the bottom of the plot).
    pub area: bool,
    /// `true` to draw a dot at every point, for measured or sparse data.
    pub dots: bool,
    /// `true` to draw dots but no line, for single values such as measurements or observed fractions.
    pub points: bool,
    /// `true` to draw the line as a thick bar, for intervals on a category axis.
    pub bar: bool,
    /// `true` to draw a thin gray line, for context such as single motions beside their mean.
    pub muted: bool,
}

/// A labeled position on an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// Position, in the unit of the axis.
    pub at: f64,
    /// Label.
    pub label: String,
}

/// A shaded interval of the horizontal axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Start, in the unit of the axis.
    pub from: f64,
    /// End, in the unit of the axis.
    pub to: f64,
    /// Label.
    pub label: String,
}

impl Plot {
    /// Creates an interactive plot of lines over time (s), with marks.
    pub fn over_time(y: Axis, series: Vec<Series>, marks: Vec<Mark>) -> Self {
        let x = Axis::new("time", "s");
        Self { x, y, series, marks, interactive: true, ..Self::default() }
    }

    /// `true` if the page can draw the plot interactively: interactivity was requested, x never decreases, and the plot
    /// has neither category names nor ranges.
    pub(crate) fn is_live(&self) -> bool {
        self.interactive
            && self.y.names.is_empty()
            && self.series.iter().all(|s| s.range.is_empty())
            && self.series.iter().any(|s| s.len() > 1)
            && self.series.iter().all(|s| {
                let x = &s.x[..s.len()];
                x.iter().all(|v| self.x.shows(*v)) && x.windows(2).all(|p| p[1] >= p[0])
            })
    }

    fn index(&self, at: usize) -> usize {
        self.series[at].style.index.unwrap_or(at)
    }

    /// Returns the index of the color of a series, from 0 to 5.
    pub(crate) fn look(&self, at: usize) -> usize {
        self.index(at) % 6
    }

    /// Returns the dash pattern of a series; series of the same color have different dash patterns.
    pub(crate) fn dash(&self, at: usize) -> &'static str {
        let round = self.index(at) / 6;
        let style = &self.series[at].style;
        if style.muted || style.bar { "" } else { DASHES[(self.look(at) + round) % 6] }
    }

    pub(crate) fn to_csv(&self) -> String {
        let mut groups: Vec<(&[f64], Vec<&Series>)> = Vec::new();
        for series in &self.series {
            let x = &series.x[..series.len()];
            match groups.iter_mut().find(|(known, _)| same(known, x)) {
                Some((_, members)) => members.push(series),
                None => groups.push((x, vec![series])),
            }
        }
        let with_unit = |label: &str, unit: &str| csv_field(&with_unit(label, unit));
        let mut header = Vec::new();
        for (_, members) in &groups {
            header.push(with_unit(&self.x.label, &self.x.unit));
            for series in members {
                header.push(with_unit(&series.label, &self.y.unit));
                if !series.range.is_empty() {
                    let end =
                        |end: &str| with_unit(&format!("{}, {end}", series.label), &self.y.unit);
                    header.extend([end("from"), end("to")]);
                }
            }
        }
        let mut out = header.join(",");
        out.push('\n');
        let rows = groups.iter().map(|(x, _)| x.len()).max().unwrap_or(0);
        for row in 0..rows {
            let mut cells = Vec::new();
            for (x, members) in &groups {
                let cell =
                    |value: Option<&f64>| value.map_or(String::new(), |v| self.y.csv_ordinate(*v));
                cells.push(x.get(row).map_or(String::new(), |v| number::csv_number(*v)));
                for series in members {
                    cells.push(cell(series.y[..series.len()].get(row)));
                    if !series.range.is_empty() {
                        let ends = series.range.get(row);
                        cells.extend([0, 1].map(|end| cell(ends.map(|ends| &ends[end]))));
                    }
                }
            }
            out.push_str(&cells.join(","));
            out.push('\n');
        }
        out
    }
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}
