//! Layout of a table in print: column widths and line breaks of cells.

use crate::{
    drawing::Anchor,
    font::Font,
    style::{Style, Tag},
};

/// Distance between columns (points).
const GUTTER: f64 = 10.0;
/// Distance (points) between baselines.
const LEADING: f64 = 11.0;
/// Total padding (points) above and below the lines of a row.
const AIR: f64 = 4.5;

/// The cells of a table, laid out for a given width.
pub(crate) struct Sheet {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
    numeric: Vec<bool>,
    widths: Vec<f64>,
}

impl Sheet {
    /// Lays out rows in at most `width` (points).
    ///
    /// Each row has one cell per column; `head` may be empty. `numeric` has one element per column: `true` if the
    /// column contains numbers.
    pub(crate) fn new(
        head: Vec<String>,
        rows: Vec<Vec<String>>,
        numeric: Vec<bool>,
        width: f64,
    ) -> Self {
        let columns = numeric.len();
        let mut wish = vec![0.0_f64; columns];
        let mut least = vec![0.0_f64; columns];
        for (bold, row) in rows.iter().map(|row| (false, row)).chain([(true, &head)]) {
            for (at, cell) in row.iter().enumerate().take(columns) {
                let whole = measure(bold, cell);
                let longest = cell.split_whitespace().map(|word| measure(bold, word));
                let longest = longest.fold(0.0, f64::max);
                wish[at] = wish[at].max(whole);
                least[at] = least[at].max(if numeric[at] && !bold { whole } else { longest });
            }
        }
        let room = width - GUTTER * columns.saturating_sub(1) as f64;
        Self { widths: shared(&wish, &least, room), head, rows, numeric }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns the lines of every cell of the header row; `None` if there is no header row.
    pub(crate) fn head(&self) -> Option<Vec<Vec<String>>> {
        (!self.head.is_empty()).then(|| self.broken(true, &self.head))
    }

    /// Returns the lines of every cell of a row.
    pub(crate) fn row(&self, at: usize) -> Vec<Vec<String>> {
        self.broken(false, &self.rows[at])
    }

    fn broken(&self, bold: bool, cells: &[String]) -> Vec<Vec<String>> {
        let size = size(bold);
        let cells = cells.iter().zip(&self.widths);
        // The margin keeps rounding errors from breaking a text that fits exactly.
        cells.map(|(cell, width)| wrap(Font::of(bold), size, cell, width + 1e-6)).collect()
    }

    /// Returns the distance (points) from the left edge of the table to the anchor point of the text in a column, and
    /// the alignment of the text at this point.
    pub(crate) fn place(&self, column: usize) -> (f64, Anchor) {
        let left = self.widths[..column].iter().map(|width| width + GUTTER).sum::<f64>();
        if self.numeric[column] {
            (left + self.widths[column], Anchor::End)
        } else {
            (left, Anchor::Start)
        }
    }
}

/// Returns the distance (points) from the top of a row to the baseline of the line with index `line`.
pub(crate) fn baseline(line: usize) -> f64 {
    0.5 * AIR + 8.5 + LEADING * line as f64
}

/// Returns the height of a row (points).
pub(crate) fn row_height(cells: &[Vec<String>]) -> f64 {
    AIR + LEADING * cells.iter().map(Vec::len).max().unwrap_or(1).max(1) as f64
}

fn size(bold: bool) -> f64 {
    Style::of(Tag::Text, if bold { "page-small-bold" } else { "page-small" }).font_size
}

fn measure(bold: bool, text: &str) -> f64 {
    Font::of(bold).width(text, size(bold))
}

/// Distributes `room` over columns.
///
/// Columns have their preferred widths if these fit. Otherwise, each column has its minimum width
/// plus a part of the remaining width, in proportion to the difference between its preferred and
/// its minimum width. If even the minimum widths do not fit, all are reduced in proportion.
fn shared(wish: &[f64], least: &[f64], room: f64) -> Vec<f64> {
    let sum = |widths: &[f64]| widths.iter().sum::<f64>();
    if sum(wish) <= room {
        return wish.to_vec();
    }
    let needed = sum(least);
    if needed >= room {
        return least.iter().map(|width| width * room / needed).collect();
    }
    let lacking = sum(wish) - needed;
    let spare = (room - needed) / lacking;
    wish.iter().zip(least).map(|(wish, least)| least + (wish - least) * spare).collect()
}

/// Breaks text into lines that are no wider than `width`; a single word that is wider is split.
pub(crate) fn wrap(font: &Font, size: f64, text: &str, width: f64) -> Vec<String> {
    let fits = |line: &str| font.width(line, size) <= width;
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if fits(&longer) {
            line = longer;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for character in word.chars() {
            line.push(character);
            if line.chars().count() > 1 && !fits(&line) {
                line.pop();
                lines.push(std::mem::replace(&mut line, character.to_string()));
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_exceeds_its_width_and_no_word_is_lost() {
        let text = "Rack R2 of level 2 walks 12.5 cm pneumonoultramicroscopicsilicovolcanoconiosis";
        for width in [20.0, 60.0, 200.0, 1000.0] {
            let lines = wrap(Font::of(false), 9.5, text, width);
            assert!(
                lines.iter().all(|line| Font::of(false).width(line, 9.5) <= width),
                "{lines:?}"
            );
            let squeezed = |text: &str| text.replace(' ', "");
            assert_eq!(squeezed(&lines.concat()), squeezed(text));
        }
        assert!(wrap(Font::of(false), 9.5, " ", 50.0).is_empty());
    }

    #[test]
    fn columns_share_what_there_is() {
        assert_eq!(shared(&[10.0, 20.0], &[5.0, 5.0], 40.0), [10.0, 20.0]);
        let tight = shared(&[10.0, 100.0], &[10.0, 20.0], 60.0);
        assert_eq!(tight, [10.0, 50.0]);
        assert_eq!(shared(&[50.0, 50.0], &[50.0, 50.0], 50.0), [25.0, 25.0]);
    }
}
