//! Tables of text: names to the left, numbers to the right, every column as wide as it must be.

use barrelstack_report::significant;

/// A table with a header.
#[derive(Debug, Default)]
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
    /// Columns set flush left, counted from the left.
    left: usize,
}

impl Table {
    /// An empty table; the first `left` columns are words.
    pub(crate) fn new(left: usize, header: impl IntoIterator<Item: Into<String>>) -> Self {
        Self { rows: vec![header.into_iter().map(Into::into).collect()], left }
    }

    /// One more row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Whether there is nothing below the header.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.len() < 2
    }

    /// The table for a page.
    pub(super) fn on_page(&self, caption: &str) -> barrelstack_report::Table {
        super::page::table(caption, &self.rows)
    }

    /// The rows as lines, indented by two.
    pub(crate) fn lines(&self) -> Vec<String> {
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
                let width = *width;
                if column < self.left {
                    format!("{cell:width$}")
                } else {
                    format!("{cell:>width$}")
                }
            });
            format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
        };
        self.rows.iter().map(line).collect()
    }
}

/// A share in percent, without the noise of the last binary digit.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", (share * 1e8).round() / 1e6)
}

/// A number with four significant digits; a dash where there is none.
pub(super) fn number(value: f64) -> String {
    significant(value, 4).replace('\u{2212}', "-")
}
