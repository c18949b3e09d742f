//! A table: named columns with units, and rows of cells.

use crate::{csv_field, number, with_unit};

/// A table with a caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Caption; plain text.
    pub caption: String,
    /// The columns, left to right.
    pub columns: Vec<Column>,
    /// The rows. A row that is too short is filled with [`Cell::Missing`], and surplus cells are
    /// not shown.
    pub rows: Vec<Vec<Cell>>,
}

/// Name and unit of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Heading of the column.
    pub name: String,
    /// Unit of the numbers, shown in parentheses; empty if there is none.
    pub unit: String,
}

impl Column {
    /// Creates a column; `unit` may be empty.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }

    pub(crate) fn heading(&self) -> String {
        with_unit(&self.name, &self.unit)
    }
}

/// Rating of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rating {
    /// Favorable.
    Good,
    /// Needs attention.
    Fair,
    /// Unfavorable.
    Poor,
}

impl Rating {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Fair => "fair",
            Self::Poor => "poor",
        }
    }
}

/// One cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Plain text.
    Text(String),
    /// Text that is not translated: a key or a value of an input file, or a name that a user gave.
    Verbatim(String),
    /// Text with a rating; the text must state the rating too, because the color only repeats the
    /// rating.
    Rated(Rating, String),
    /// A number, and its number of significant digits; CSV keeps all digits.
    Number(f64, usize),
    /// A measured number, shown by [`measured`](crate::measured) with at most the given number of
    /// decimals; CSV keeps all digits.
    Measured(f64, usize),
    /// No value: shown as a dash, empty in CSV.
    Missing,
}

impl Cell {
    /// Creates a text cell.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// Creates a text cell that is not translated.
    pub fn verbatim(text: impl Into<String>) -> Self {
        Self::Verbatim(text.into())
    }

    /// Creates a text cell; `None` gives a missing cell.
    pub fn maybe(text: Option<impl Into<String>>) -> Self {
        text.map_or(Self::Missing, Self::text)
    }

    /// Creates a cell with a number, shown with the given number of significant digits; `None`
    /// gives a missing cell.
    pub fn number(value: Option<f64>, digits: usize) -> Self {
        value.map_or(Self::Missing, |value| Self::Number(value, digits))
    }

    /// Creates a cell with a measured number, shown with at most the given number of decimals;
    /// `None` gives a missing cell.
    pub fn measured(value: Option<f64>, decimals: usize) -> Self {
        value.map_or(Self::Missing, |value| Self::Measured(value, decimals))
    }

    pub(crate) fn shown(&self) -> String {
        match self {
            Self::Text(text) | Self::Verbatim(text) | Self::Rated(_, text) => text.clone(),
            Self::Number(value, digits) => number::significant(*value, *digits),
            Self::Measured(value, decimals) => number::measured(*value, *decimals),
            Self::Missing => number::MISSING.into(),
        }
    }
}

/// A column of a table of items: its name, its unit, and the function that makes its cells.
pub type ColumnOf<'a, T> = (&'a str, &'a str, &'a dyn Fn(&T) -> Cell);

impl Table {
    /// Creates an empty table with these columns, given as pairs of name and unit.
    pub fn new(caption: impl Into<String>, columns: &[(&str, &str)]) -> Self {
        let columns = columns.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
        Self { caption: caption.into(), columns, rows: Vec::new() }
    }

    /// Creates a table with one row per item.
    pub fn of<T>(
        caption: impl Into<String>,
        things: impl IntoIterator<Item = T>,
        columns: &[ColumnOf<'_, T>],
    ) -> Self {
        let heads: Vec<_> = columns.iter().map(|(name, unit, _)| (*name, *unit)).collect();
        let row = |thing: T| columns.iter().map(|(.., cell)| cell(&thing)).collect();
        Self { rows: things.into_iter().map(row).collect(), ..Self::new(caption, &heads) }
    }

    /// Formats the table as lines of text with aligned columns: a header row with units, then every row.
    pub fn to_lines(&self) -> Vec<String> {
        let heads = self.columns.iter().map(Column::heading).collect();
        let row = |row: &Vec<Cell>| {
            (0..self.columns.len())
                .map(|at| row.get(at).map_or_else(|| number::MISSING.into(), Cell::shown))
                .collect()
        };
        let rows: Vec<Vec<String>> =
            std::iter::once(heads).chain(self.rows.iter().map(row)).collect();
        let width = |at: usize| rows.iter().map(|row| row[at].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        };
        rows.iter().map(line).collect()
    }

    /// Formats the table as CSV: a header row with units, then every row at full precision.
    pub fn to_csv(&self) -> String {
        let mut out = String::new();
        let header: Vec<_> = self.columns.iter().map(|c| csv_field(&c.heading())).collect();
        out.push_str(&header.join(","));
        out.push('\n');
        for row in &self.rows {
            let cells: Vec<_> = (0..self.columns.len())
                .map(|at| match row.get(at) {
                    Some(Cell::Text(text) | Cell::Verbatim(text) | Cell::Rated(_, text)) => {
                        csv_field(text)
                    }
                    Some(Cell::Number(value, _) | Cell::Measured(value, _)) => {
                        number::csv_number(*value)
                    }
                    Some(Cell::Missing) | None => String::new(),
                })
                .collect();
            out.push_str(&cells.join(","));
            out.push('\n');
        }
        out
    }

    /// Returns the cells of a row as displayed, one per column.
    pub(crate) fn shown<'a>(&'a self, row: &'a [Cell]) -> impl Iterator<Item = String> + 'a {
        let cells = row.iter().chain(std::iter::repeat(&Cell::Missing));
        cells.take(self.columns.len()).map(Cell::shown)
    }

    /// Returns, for each column, `true` if the column contains numbers and no text.
    pub(crate) fn numeric(&self) -> Vec<bool> {
        let numeric = |column: usize| {
            let cells = || self.rows.iter().filter_map(|row| row.get(column));
            cells().any(|cell| matches!(cell, Cell::Number(..) | Cell::Measured(..)))
                && !cells()
                    .any(|cell| matches!(cell, Cell::Text(_) | Cell::Verbatim(_) | Cell::Rated(..)))
        };
        (0..self.columns.len()).map(numeric).collect()
    }
}
