//! A plot: series over a pair of axes, with marks, levels and bands.

use serde::Serialize;

use crate::{escape, number, style::DASHES};

/// Lines over a pair of axes.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Plot {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lines.
    pub series: Vec<Series>,
    /// Upright lines at chosen x.
    pub marks: Vec<Mark>,
    /// Level lines at chosen y.
    pub levels: Vec<Mark>,
    /// Shaded stretches of x.
    pub bands: Vec<Band>,
    /// Drawn live in the page, with readout and zoom. Needs x that never decreases in every
    /// series; a plot that breaks this (a hysteresis loop) is drawn as SVG everywhere.
    pub interactive: bool,
    /// x is the time of the run (s): cursor and zoom are shared with the player and with every
    /// other such plot. Only for interactive plots.
    pub timeline: bool,
}

/// An axis.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Axis {
    /// Name of the quantity.
    pub label: String,
    /// Unit, shown in parentheses; empty for a pure number.
    pub unit: String,
    /// How values map to lengths.
    pub scale: Scale,
    /// Shown range; from the data when `None`, or when it is empty, reversed or not finite.
    pub range: Option<[f64; 2]>,
    /// Names of an upright axis that stand for numbers: the first is 1, on top, the next below it is
    /// 2. They take the place of ticks, and nothing else is shown of the axis.
    pub names: Vec<String>,
}

impl Axis {
    /// A linear axis ranged by its data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// The same axis with a logarithmic scale; values at or below zero become gaps.
    #[must_use]
    pub fn log(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// An axis of names from top to bottom; what belongs to the name at `place` (from 0) is drawn at
    /// [`Axis::row`].
    pub fn named(names: Vec<String>) -> Self {
        Self { range: Some([-(names.len() as f64) - 0.5, -0.5]), names, ..Self::default() }
    }

    /// The ordinate of the name at a place (from 0).
    pub fn row(place: usize) -> f64 {
        -(place as f64) - 1.0
    }

    /// What an ordinate is told as: the nearest name, where there are names.
    fn told(&self, value: f64) -> String {
        let rows = (0..self.names.len()).filter(|place| (value - Self::row(*place)).abs() <= 0.5);
        match rows.map(|place| escape::csv(&self.names[place])).next() {
            Some(name) => name,
            None => number::csv_number(value),
        }
    }

    /// Name and unit as printed.
    pub(crate) fn title(&self) -> String {
        if self.label.is_empty() {
            return self.unit.clone();
        }
        escape::with_unit(&self.label, &self.unit)
    }

    /// Whether the axis can show `value`.
    pub(crate) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }
}

/// How values map to lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences, equal lengths.
    #[default]
    Linear,
    /// Equal ratios, equal lengths.
    Log,
}

/// One line of a plot.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Series {
    /// Name in the legend.
    pub label: String,
    /// Abscissas; points beyond the shorter of `x` and `y` are not drawn.
    pub x: Vec<f64>,
    /// Ordinates; a value that is not finite makes a gap.
    pub y: Vec<f64>,
    /// How far each ordinate may be off, from and to: a filled band about a line, a bar through each
    /// of [`SeriesStyle::points`]. Empty where nothing is known.
    pub range: Vec<[f64; 2]>,
    /// How it is drawn.
    pub style: SeriesStyle,
}

impl Series {
    /// A plain line.
    pub fn new(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { label: label.into(), x, y, ..Self::default() }
    }

    pub(crate) fn len(&self) -> usize {
        self.x.len().min(self.y.len())
    }
}

/// How a series is drawn.
#[expect(clippy::struct_excessive_bools, reason = "each is a trait that goes with most others")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SeriesStyle {
    /// Which color and dash pattern, from 0; the place in the plot when `None`. Colors repeat after
    /// six, each time with other dashes.
    pub index: Option<usize>,
    /// Shade between the line and zero (or the foot of the plot).
    pub area: bool,
    /// Draw a dot at every point, for measured or sparse data.
    pub dots: bool,
    /// Dots alone, which no line joins: single measurements, raw fractions.
    pub points: bool,
    /// A line as thick as a bar, for stretches of an axis with names.
    pub bar: bool,
    /// Thin and gray: context, such as single motions behind their mean.
    pub muted: bool,
}

/// A place on an axis worth a line and a word.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// Where, in the axis's unit.
    pub at: f64,
    /// The word.
    pub label: String,
}

/// A shaded stretch of the horizontal axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Start, in the axis's unit.
    pub from: f64,
    /// End.
    pub to: f64,
    /// The word.
    pub label: String,
}

impl Plot {
    /// Lines over time (s), with chosen times, which the page draws live.
    pub fn over_time(y: Axis, series: Vec<Series>, marks: Vec<Mark>) -> Self {
        let x = Axis::new("time", "s");
        Self { x, y, series, marks, interactive: true, ..Self::default() }
    }

    /// Whether the page may draw it live: asked for, x never decreases, and no names or ranges.
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

    /// Which of the six colors a series has.
    pub(crate) fn look(&self, at: usize) -> usize {
        self.index(at) % 6
    }

    /// The dash pattern of a series, which differs where a color comes again.
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
        let with_unit = |label: &str, unit: &str| escape::csv(&escape::with_unit(label, unit));
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
                let cell = |value: Option<&f64>| value.map_or(String::new(), |v| self.y.told(*v));
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
