//! A plot as a drawing: axes, grid, bands, lines, marks and legend.

use crate::{
    Axis, Mark, Plot, Scale,
    drawing::{Anchor, Drawing, Item, Room, Runs, broken, text_width},
    simplify::simplify,
    ticks::{Ticks, linear_ticks, log_ticks},
};

/// Width (px) on a page and on a phone.
const WIDTH: [f64; 2] = [680.0, 358.0];
const PLOT_HEIGHT: f64 = 230.0;
/// Minimum height (px) per category on a category axis.
const ROW: f64 = 36.0;
/// Maximum width of the names on a category axis, as a fraction of the width of the figure.
const NAMES: f64 = 0.4;
/// Height (px) of a line of text.
const LINE: f64 = 15.0;
const FONT: f64 = 12.0;
/// Height (px) of a row of labels above the plot; the labels of marks are in the lowest rows, and
/// those of bands above them.
const NOTE: f64 = 16.0;
/// Width (px) of the line sample beside the name of a series.
const SAMPLE: f64 = 26.0;
/// Maximum number of rows of mark labels; labels that do not fit are omitted.
const MARK_ROWS: usize = 3;

/// A range of data, and the range of pixels to which the data are mapped.
struct Map {
    range: [f64; 2],
    pixels: [f64; 2],
    log: bool,
}

impl Map {
    fn at(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let share = if self.log {
            (value / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        };
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }

    fn holds(&self, value: f64) -> bool {
        value >= self.range[0] && value <= self.range[1]
    }
}

/// A mark with the positions (px) of its line and of its label.
struct PlacedMark<'a> {
    at: f64,
    label: &'a str,
    center: f64,
    /// Row of the label, counted from the plot upward; `None` if no row has room.
    row: Option<usize>,
}

/// A series in the legend: the position and the lines of its text.
struct LegendEntry {
    series: usize,
    corner: [f64; 2],
    lines: Vec<String>,
}

impl Plot {
    pub(crate) fn draw(&self, id: &str, title: &str, room: Room) -> Drawing {
        let width = room.of(WIDTH[0], WIDTH[1]);
        let x_range = self.x.data_range(self.series.iter().map(|s| &s.x[..s.len()]), false);
        // Without a margin, a dot on the frame would be clipped.
        let spare = self.series.iter().any(|s| s.style.points || s.style.bar);
        let x_range = if spare { self.x.with_air(x_range) } else { x_range };
        let areas = self.series.iter().any(|s| s.style.area);
        let ordinates = self.series.iter().flat_map(|s| [&s.y[..s.len()], s.range.as_flattened()]);
        let y_range = self.y.with_air(self.y.data_range(ordinates, areas));
        let names: Vec<Vec<String>> =
            self.y.names.iter().map(|name| broken(name, FONT, NAMES * width)).collect();
        let y_ticks = if names.is_empty() {
            self.y.ticks(y_range, 7)
        } else {
            Ticks { values: Vec::new(), labels: names.concat() }
        };
        let widest = y_ticks.labels.iter().map(|l| text_width(l, FONT)).fold(0.0, f64::max);
        let title_room = if self.y.title().is_empty() { 14.0 } else { 34.0 };
        let left = title_room + widest;
        let right = width - 14.0;
        let (legend, legend_height) = self.legend_layout(8.0_f64.max(left - widest), left, right);
        let x = Map { range: x_range, pixels: [left, right], log: self.x.scale == Scale::Log };
        let marks = self.mark_layout(&x);
        let mark_rows = marks.iter().filter_map(|mark| mark.row).max().map_or(0, |row| row + 1);
        let rows = mark_rows + usize::from(!self.bands.is_empty());
        let top = 12.0 + legend_height + NOTE * rows as f64;
        let tallest = names.iter().map(Vec::len).max().unwrap_or(0) as f64;
        let bottom = top
            + if names.is_empty() {
                PLOT_HEIGHT
            } else {
                names.len() as f64 * ROW.max(LINE * tallest + 6.0)
            };
        let y = Map { range: y_range, pixels: [bottom, top], log: self.y.scale == Scale::Log };

        let x_title = broken(&self.x.title(), FONT, width - 16.0);
        let foot = 31.0 + LINE * x_title.len() as f64;
        let mut drawing = Drawing::new(width, bottom + foot, title);
        self.draw_bands(&mut drawing, &x, [top, bottom], top - 7.0 - NOTE * mark_rows as f64);
        self.draw_axes(&mut drawing, &x, &y, &y_ticks);
        draw_names(&mut drawing, &names, &x, &y);
        for (line, text) in x_title.iter().enumerate() {
            // Centered below the plot, unless the text would leave the picture.
            let half = 0.5 * text_width(text, FONT);
            let middle = (0.5 * (left + right)).min(width - half).max(half);
            let at = [middle, bottom + 37.0 + LINE * line as f64];
            drawing.text("label", at, Anchor::Middle, text);
        }
        drawing.push(Item::Clip {
            id: format!("{id}-clip"),
            lower: [left, top - 1.0],
            size: [right - left, bottom - top + 2.0],
            items: self.draw_series(&x, &y),
        });
        self.draw_marks(&mut drawing, &marks, &x, &y);
        for LegendEntry { series, corner, lines } in legend {
            self.draw_sample(&mut drawing, series, [corner[0], corner[1] - 4.0]);
            for (line, text) in lines.iter().enumerate() {
                let at = [corner[0] + SAMPLE + 6.0, corner[1] + LINE * line as f64];
                drawing.text("label", at, Anchor::Start, text);
            }
        }
        drawing
    }

    /// Draws the line sample of a series for the legend, with its left end at the given position.
    fn draw_sample(&self, drawing: &mut Drawing, at: usize, [x, y]: [f64; 2]) {
        let series = &self.series[at];
        let (style, look) = (series.style, self.look(at));
        let middle = x + 0.5 * SAMPLE;
        if !series.range.is_empty() && style.points {
            let bar = vec![[middle, y - 6.0], [middle, y + 6.0]];
            drawing.path(&format!("whisker s{look}"), "", vec![bar], false);
        } else if !series.range.is_empty() || style.area {
            let corners =
                vec![[x, y - 5.0], [x + SAMPLE, y - 5.0], [x + SAMPLE, y + 5.0], [x, y + 5.0]];
            drawing.path(&format!("area s{look}"), "", vec![corners], true);
        }
        if !style.points {
            let line = vec![[x, y], [x + SAMPLE, y]];
            drawing.path(&self.class(at), self.dash(at), vec![line], false);
        }
        if style.dots || style.points {
            drawing.push(self.dot(at, [middle, y]));
        }
    }

    fn class(&self, at: usize) -> String {
        let style = &self.series[at].style;
        if style.muted {
            "series muted".into()
        } else {
            format!("series s{}{}", self.look(at), if style.bar { " bar" } else { "" })
        }
    }

    fn dot(&self, at: usize, center: [f64; 2]) -> Item {
        let radius = if self.series[at].style.points { 3.4 } else { 2.6 };
        Item::Circle { class: format!("dot s{}", self.look(at)), center, radius }
    }

    /// Lays out the legend: position and lines of each entry, and the total height. Entries start at `left` or, if the
    /// longest entry does not fit between `left` and `right`, at `edge`.
    fn legend_layout(&self, edge: f64, left: f64, right: f64) -> (Vec<LegendEntry>, f64) {
        let named = || self.series.iter().filter(|series| !series.label.is_empty());
        let wide = |label: &str| SAMPLE + 6.0 + text_width(label, FONT);
        let longest = named().map(|series| wide(&series.label)).fold(0.0, f64::max);
        let left = if left + longest > right { edge } else { left };
        let mut entries = Vec::new();
        let mut pen = [left, 14.0];
        let mut height: f64 = 0.0;
        for (at, series) in self.series.iter().enumerate() {
            if series.label.is_empty() {
                continue;
            }
            let lines = broken(&series.label, FONT, right - left - SAMPLE - 6.0);
            let wide = lines.iter().map(|line| wide(line)).fold(0.0, f64::max);
            if pen[0] > left && pen[0] + wide > right {
                pen = [left, height + 17.0];
            }
            height = height.max(pen[1] + LINE * (lines.len() - 1) as f64);
            entries.push(LegendEntry { series: at, corner: pen, lines });
            pen[0] += wide + 18.0;
        }
        let height = if entries.is_empty() { 0.0 } else { height + 2.0 };
        (entries, height)
    }

    fn draw_axes(&self, drawing: &mut Drawing, x: &Map, y: &Map, y_ticks: &Ticks) {
        let [left, right] = x.pixels;
        let [bottom, top] = y.pixels;
        for (value, label) in y_ticks.values.iter().zip(&y_ticks.labels) {
            let at = y.at(*value);
            drawing.line("grid", [left, at], [right, at]);
            drawing.text("tick", [left - 7.0, at + 4.0], Anchor::End, label);
        }
        // A label with its gap takes about fifty pixels.
        let most = if right - left < 400.0 { 5 } else { 8 };
        let x_ticks = self.x.ticks(x.range, most);
        for (value, label) in x_ticks.values.iter().zip(&x_ticks.labels) {
            let at = x.at(*value);
            drawing.line("grid", [at, top], [at, bottom]);
            drawing.line("axis", [at, bottom], [at, bottom + 4.0]);
            drawing.text("tick", [at, bottom + 17.0], Anchor::Middle, label);
        }
        drawing.line("axis", [left, bottom], [right, bottom]);
        if !y.log && y.range[0] < 0.0 && y.range[1] > 0.0 {
            drawing.line("zero", [left, y.at(0.0)], [right, y.at(0.0)]);
        }
        let middle = 0.5 * (top + bottom);
        drawing.turned_text("label", [13.0, middle], Anchor::Middle, -90.0, &self.y.title());
    }

    /// Draws bands from the top to the bottom of the plot, with the baseline of the labels at y = `row` (px).
    fn draw_bands(&self, drawing: &mut Drawing, x: &Map, [top, bottom]: [f64; 2], row: f64) {
        for band in &self.bands {
            if !(self.x.shows(band.from) && self.x.shows(band.to)) {
                continue;
            }
            let from = x.at(band.from.max(x.range[0]));
            let to = x.at(band.to.min(x.range[1]));
            if to > from {
                drawing.rect("band", [from, top], [to - from, bottom - top]);
                drawing.text("note", [0.5 * (from + to), row], Anchor::Middle, &band.label);
            }
        }
    }

    fn draw_series(&self, x: &Map, y: &Map) -> Vec<Item> {
        let mut items = Vec::new();
        // Muted series are drawn first, below the others.
        let mut order: Vec<usize> = (0..self.series.len()).collect();
        order.sort_by_key(|&at| !self.series[at].style.muted);
        for at in order {
            let series = &self.series[at];
            let class = self.class(at);
            let runs = self.runs(at, x, y);
            if series.style.area {
                let foot =
                    if y.log { y.pixels[0] } else { y.at(0.0_f64.clamp(y.range[0], y.range[1])) };
                let shapes: Runs = runs
                    .iter()
                    .map(|run| {
                        let mut shape = run.clone();
                        if let (Some(first), Some(last)) = (run.first(), run.last()) {
                            shape.push([last[0], foot]);
                            shape.push([first[0], foot]);
                        }
                        shape
                    })
                    .collect();
                let class = format!("area s{}", self.look(at));
                items.push(Item::Path { class, dash: "", runs: shapes, closed: true });
            }
            items.extend(self.draw_range(at, x, y));
            if !series.style.points {
                items.push(Item::Path { class, dash: self.dash(at), runs, closed: false });
            }
            if series.style.dots || series.style.points {
                for k in 0..series.len() {
                    if self.x.shows(series.x[k]) && self.y.shows(series.y[k]) {
                        items.push(self.dot(at, [x.at(series.x[k]), y.at(series.y[k])]));
                    }
                }
            }
        }
        items
    }

    /// Draws the ranges of a series: a band about its line, or bars through its points.
    fn draw_range(&self, at: usize, x: &Map, y: &Map) -> Option<Item> {
        let series = &self.series[at];
        let count = series.len().min(series.range.len());
        let shown = |k: usize| {
            let [low, high] = series.range[k];
            self.x.shows(series.x[k]) && self.y.shows(low) && self.y.shows(high)
        };
        let spot = |k: usize, end: usize| {
            let point = [x.at(series.x[k]), y.at(series.range[k][end])];
            point.map(|v: f64| v.clamp(-9999.0, 9999.0))
        };
        let known: Vec<usize> = (0..count).filter(|k| shown(*k)).collect();
        if known.is_empty() {
            return None;
        }
        let look = self.look(at);
        if series.style.points {
            let bars = known.iter().map(|&k| vec![spot(k, 0), spot(k, 1)]).collect();
            let class = format!("whisker s{look}");
            return Some(Item::Path { class, dash: "", runs: bars, closed: false });
        }
        let bands = known.chunk_by(|a, b| b - a == 1).map(|run| {
            let up = run.iter().map(|&k| spot(k, 1));
            up.chain(run.iter().rev().map(|&k| spot(k, 0))).collect()
        });
        let class = format!("area s{look}");
        Some(Item::Path { class, dash: "", runs: bands.collect(), closed: true })
    }

    /// Returns the points (px) of a series, divided into lines at gaps.
    fn runs(&self, at: usize, x: &Map, y: &Map) -> Runs {
        let series = &self.series[at];
        let shown = |k: &usize| self.x.shows(series.x[*k]) && self.y.shows(series.y[*k]);
        // Positions far outside the window are clamped, which keeps the numbers short.
        let spot = |k: &usize| -> [f64; 2] {
            [x.at(series.x[*k]), y.at(series.y[*k])].map(|v| v.clamp(-9999.0, 9999.0))
        };
        let known: Vec<usize> = (0..series.len()).filter(shown).collect();
        let runs = known.chunk_by(|a, b| b - a == 1);
        runs.map(|run| simplify(&run.iter().map(spot).collect::<Vec<_>>(), 0.1)).collect()
    }

    /// Lays out the visible marks from left to right, each label in the lowest row that has room.
    fn mark_layout<'a>(&'a self, x: &Map) -> Vec<PlacedMark<'a>> {
        let [left, right] = x.pixels;
        let mut marks: Vec<_> =
            self.marks.iter().filter(|m| self.x.shows(m.at) && x.holds(m.at)).collect();
        marks.sort_by(|a, b| a.at.total_cmp(&b.at));
        // Right end of each row so far.
        let mut ends: Vec<f64> = Vec::new();
        let place = |mark: &'a Mark| {
            let half = 0.5 * text_width(&mark.label, 11.0);
            let at = x.at(mark.at);
            // A label that is wider than the plot extends to the left, never to the right.
            let center = at.clamp((left + half).min(right - half), right - half);
            let free = ends.iter().position(|end| center - half > *end);
            let row = free.or(Some(ends.len()).filter(|row| *row < MARK_ROWS));
            if let Some(row) = row {
                ends.resize(ends.len().max(row + 1), 0.0);
                ends[row] = center + half + 6.0;
            }
            PlacedMark { at, label: &mark.label, center, row }
        };
        marks.into_iter().map(place).collect()
    }

    fn draw_marks(&self, drawing: &mut Drawing, marks: &[PlacedMark<'_>], x: &Map, y: &Map) {
        let ([left, right], [bottom, top]) = (x.pixels, y.pixels);
        for mark in marks {
            let foot = top - 8.0 - NOTE * mark.row.unwrap_or(0) as f64;
            drawing.line("mark", [mark.at, foot + 4.0], [mark.at, bottom]);
            if mark.row.is_some() {
                drawing.text("note", [mark.center, foot], Anchor::Middle, mark.label);
            }
        }
        for level in self.levels.iter().filter(|m| self.y.shows(m.at) && y.holds(m.at)) {
            let at = y.at(level.at);
            drawing.line("mark", [left, at], [right, at]);
            drawing.text("note", [right - 4.0, at - 4.0], Anchor::End, &level.label);
        }
    }
}

/// Draws the names of the rows, each to the left of its row.
fn draw_names(drawing: &mut Drawing, names: &[Vec<String>], x: &Map, y: &Map) {
    let ([left, right], height) = (x.pixels, 0.5 * (y.at(-1.0) - y.at(-2.0)).abs());
    for (place, lines) in names.iter().enumerate() {
        let middle = y.at(Axis::row(place));
        if place > 0 {
            drawing.line("grid", [left, middle - height], [right, middle - height]);
        }
        let first = middle + 4.0 - 0.5 * LINE * (lines.len() - 1) as f64;
        for (line, text) in lines.iter().enumerate() {
            let at = [left - 7.0, first + LINE * line as f64];
            drawing.text("label", at, Anchor::End, text);
        }
    }
}

impl Axis {
    /// Returns the range to show: the given range if it is usable, otherwise the range of the data.
    ///
    /// For constant data, the range extends to both sides of the value. If there are no data, the
    /// range is 0 to 1, or 1 to 10 on a logarithmic axis.
    pub(crate) fn data_range<'a>(
        &self,
        columns: impl Iterator<Item = &'a [f64]>,
        with_zero: bool,
    ) -> [f64; 2] {
        if let Some([low, high]) = self.range
            && self.shows(low)
            && self.shows(high)
            && low < high
        {
            return [low, high];
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in columns.flatten().copied().filter(|v| self.shows(*v)) {
            low = low.min(value);
            high = high.max(value);
        }
        if self.scale == Scale::Log {
            return match low < high {
                true => [low, high],
                false if low.is_finite() => [low / 3.0, low * 3.0],
                false => [1.0, 10.0],
            };
        }
        if with_zero && low.is_finite() {
            low = low.min(0.0);
            high = high.max(0.0);
        }
        if low < high && (high - low) > 1e-9 * low.abs().max(high.abs()) {
            [low, high]
        } else if low.is_finite() {
            let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
            [low - half, low + half]
        } else {
            [0.0, 1.0]
        }
    }

    /// Widens a linear range of data so that no line coincides with the frame of the plot.
    fn with_air(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        if self.scale == Scale::Log || self.range == Some([low, high]) {
            return [low, high];
        }
        let air = 0.05 * (high - low);
        let touches_zero = |v: f64| v == 0.0;
        [
            if touches_zero(low) { low } else { low - air },
            if touches_zero(high) { high } else { high + air },
        ]
    }

    pub(crate) fn ticks(&self, range: [f64; 2], target: usize) -> Ticks {
        match self.scale {
            Scale::Linear => linear_ticks(range[0], range[1], target),
            Scale::Log => log_ticks(range[0], range[1]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_that_crowd_take_three_rows_and_no_more() {
        let mark = |at: f64| Mark { at, label: "a label that is wide".into() };
        let crowd = (0..6).map(|k| mark(5.0 + 0.01 * f64::from(k)));
        let plot = Plot { marks: crowd.chain([mark(9.0)]).collect(), ..Plot::default() };
        let x = Map { range: [0.0, 10.0], pixels: [50.0, 660.0], log: false };
        let rows: Vec<Option<usize>> = plot.mark_layout(&x).iter().map(|mark| mark.row).collect();
        assert_eq!(rows, [Some(0), Some(1), Some(2), None, None, None, Some(0)]);
    }
}
