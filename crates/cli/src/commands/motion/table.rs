//! Text tables: names aligned left, numbers aligned right, columns as wide as their contents.

use barrelstack_report::significant;

/// A table with a header.
#[derive(Debug, Default)]
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
    /// Number of columns that are aligned left, counted from the left.
    left: usize,
}

impl Table {
    /// Creates an empty table; the first `left` columns are text.
    pub(crate) fn new(left: usize, header: impl IntoIterator<Item: Into<String>>) -> Self {
        Self { rows: vec![header.into_iter().map(Into::into).collect()], left }
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Returns `true` if there are no rows below the header.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.len() < 2
    }

    /// Converts the table to a table of a page, with a caption.
    pub(super) fn on_page(&self, caption: &str) -> barrelstack_report::Table {
        super::page::table(caption, &self.rows)
    }

    /// Returns the rows as lines, indented by two spaces.
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

/// Formats a share in percent, without binary rounding errors.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", (share * 1e8).round() / 1e6)
}

/// Formats a number with four significant digits; a dash for NaN.
pub(super) fn number(value: f64) -> String {
    significant(value, 4).replace('\u{2212}', "-")
}
