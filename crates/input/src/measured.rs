//! Tables of measurements: CSV with a unit in the header of every column.

use std::path::{Path, PathBuf};

use crate::names::nearest;
use crate::system;
use crate::{Dimension, Quantity};

/// Remedy suggested for a cell that should hold a number but does not.
const CORRECT: &str = "correct it, or remove the row (the decimal mark is a point)";

/// Maximum size of a measurement file (bytes).
const SIZE_LIMIT: usize = 64 << 20;

/// A table of measurements, read from CSV with a unit in the header of each column.
///
/// Columns are separated by commas, or by semicolons or tabs if the header contains them.
/// Empty lines and lines that start with `#` are skipped.
///
/// ```
/// use barrelstack_input::measured::Table;
/// use barrelstack_input::Dimension;
///
/// let table = Table::parse("press.csv", "penetration (mm),force (kN)\n0.5,0.49\n1.0,0.98\n")?;
/// assert_eq!(table.required("force", Dimension::FORCE)?, [490.0, 980.0]);
/// # Ok::<(), barrelstack_input::measured::TableError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Table {
    file: String,
    header_line: usize,
    columns: Vec<Column>,
    rows: Vec<(usize, Vec<String>)>,
}

/// A reason why a table of measurements cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read.
    #[error("cannot read {path}: {reason}; correct the path", path = path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// Reason, in plain words.
        reason: String,
    },
    /// A cell or a line does not hold the expected content.
    #[error("{file}, line {line}{place}: expected {expected}, found {found}; {remedy}", place = in_column(column.as_deref()))]
    Cell {
        /// Name of the file.
        file: String,
        /// Number of the line, from 1.
        line: usize,
        /// Name of the column, as in the header; `None` if the error concerns the whole line.
        column: Option<String>,
        /// Expected content.
        expected: Box<str>,
        /// Content found.
        found: Box<str>,
        /// Suggested remedy.
        remedy: Box<str>,
    },
    /// The file is not a table of measurements, or lacks required content.
    #[error("{file}: {reason}")]
    Unsuited {
        /// Name of the file.
        file: String,
        /// Reason, with a remedy.
        reason: String,
    },
}

fn in_column(column: Option<&str>) -> String {
    column.map(|name| format!(", column \"{name}\"")).unwrap_or_default()
}

/// Content of a cell in a column that may have empty cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellContent {
    /// An empty cell.
    Empty,
    /// The word that is accepted in place of a number, as passed to [`Table::entries`].
    Word,
    /// A value, in SI units.
    Number(f64),
}

/// Name and unit of a column.
#[derive(Clone, Debug)]
struct Column {
    name: String,
    unit: Option<String>,
}

impl Column {
    /// Parses a header cell such as `force (kN)`.
    fn of(text: &str) -> Self {
        match text.strip_suffix(')').and_then(|text| text.rsplit_once('(')) {
            Some((name, unit)) => {
                Self { name: name.trim().to_owned(), unit: Some(unit.trim().to_owned()) }
            }
            None => Self { name: text.to_owned(), unit: None },
        }
    }

    fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }
}

impl Table {
    /// Reads a table from a file.
    ///
    /// # Errors
    /// If the file cannot be read or is not a table.
    pub fn load(path: &Path) -> Result<Self, TableError> {
        let unreadable = |reason| TableError::Unreadable { path: path.to_owned(), reason };
        let bytes = system::read(path, SIZE_LIMIT).map_err(unreadable)?;
        let text = String::from_utf8(bytes)
            .map_err(|_| unreadable("it is not text in UTF-8: export it as CSV".to_owned()))?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Parses a table from text. `file` is the file name that error messages show.
    ///
    /// # Errors
    /// If the text has no header or no rows, or if a row has a different number of columns than the
    /// header.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(at, line)| (at + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let unsuited = |reason: &str| TableError::Unsuited {
            file: file.to_owned(),
            reason: reason.to_owned(),
        };
        let (header_line, header) = lines
            .next()
            .ok_or_else(|| unsuited("it is empty: write a header such as `penetration (mm),force (kN)` and the measurements below it"))?;
        let separator = [';', '\t'].into_iter().find(|mark| header.contains(*mark)).unwrap_or(',');
        let cells = |line: &str| -> Vec<String> {
            line.split(separator)
                .map(|cell| cell.trim().trim_matches('"').trim().to_owned())
                .collect()
        };
        let columns: Vec<Column> = cells(header).iter().map(|cell| Column::of(cell)).collect();
        let mut rows = Vec::new();
        for (line, text) in lines {
            let row = cells(text);
            if row.len() != columns.len() {
                return Err(TableError::Cell {
                    file: file.to_owned(),
                    line,
                    column: None,
                    expected: format!("{} columns as in the header", columns.len()).into(),
                    found: row.len().to_string().into(),
                    remedy: "complete the row or remove it".into(),
                });
            }
            rows.push((line, row));
        }
        if rows.is_empty() {
            return Err(unsuited(
                "it has a header but no measurements; write one line per measurement below the header",
            ));
        }
        Ok(Self { file: file.to_owned(), header_line, columns, rows })
    }

    /// Returns the file name that error messages show.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns the names of all columns, without their units.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// Returns `true` if a column has this name, ignoring case.
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|column| column.is(name))
    }

    /// Returns a warning for each column whose name is not in `known`.
    pub fn unused(&self, known: &[&str]) -> Vec<String> {
        let unknown = |column: &&Column| !known.iter().any(|name| column.is(name));
        let columns = self.columns.iter().filter(unknown);
        columns.map(|column| format!("column \"{}\" is not used", column.name)).collect()
    }

    /// Returns the number of rows, without the header.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Returns the values of a required column, in SI units.
    ///
    /// # Errors
    /// If the column is missing, has no unit or a unit of another dimension, or holds anything but
    /// numbers.
    pub fn required(&self, name: &str, dimension: Dimension) -> Result<Vec<f64>, TableError> {
        let (at, unit) = self.place(name, dimension)?;
        let column = &self.columns[at].name;
        let value = |(line, row): &(usize, Vec<String>)| {
            self.value(*line, column, &row[at], (unit, dimension))
        };
        self.rows.iter().map(value).collect()
    }

    /// Returns the cells of a required column. Each cell is a number (SI units), the `word` that
    /// replaces a number, or empty.
    ///
    /// # Errors
    /// The same as for [`Table::required`], except that empty cells and the word are accepted.
    pub fn entries(
        &self,
        name: &str,
        dimension: Dimension,
        word: &str,
    ) -> Result<Vec<CellContent>, TableError> {
        let (at, unit) = self.place(name, dimension)?;
        let column = &self.columns[at].name;
        let entry = |(line, row): &(usize, Vec<String>)| match row[at].as_str() {
            "" => Ok(CellContent::Empty),
            cell if cell == word => Ok(CellContent::Word),
            cell => self.value(*line, column, cell, (unit, dimension)).map(CellContent::Number),
        };
        self.rows.iter().map(entry).collect()
    }

    /// Returns the names of all columns, with their units, for error messages.
    fn listed(&self) -> String {
        let heads = self.columns.iter().map(|column| match &column.unit {
            Some(unit) => format!("\"{} ({unit})\"", column.name),
            None => format!("\"{}\"", column.name),
        });
        let heads: Vec<String> = heads.collect();
        match heads.as_slice() {
            [one] => format!("only the column {one}"),
            _ => format!("the columns {}", heads.join(", ")),
        }
    }

    /// Returns the error about a missing column, or about a column whose unit is not the expected one. `example` is the
    /// header of the column, in backticks.
    fn lacks(&self, name: &str, example: &str) -> TableError {
        let names: Vec<&str> = self.names().collect();
        let remedy = match nearest(name, &names) {
            Some(near) => format!("if \"{near}\" is this column, write {example} in its place"),
            None => format!(
                "add the column, or write {example} as the heading of the column that holds its values"
            ),
        };
        let expected = format!("a column {example}");
        self.refuse(self.header_line, None, &expected, &self.listed(), &remedy)
    }

    /// Returns the index and the unit of the only column with the given name. The unit must have the given dimension.
    fn place(&self, name: &str, dimension: Dimension) -> Result<(usize, &str), TableError> {
        let mut found = self.columns.iter().enumerate().filter(|(_, column)| column.is(name));
        let example = || format!("`{name} ({})`", dimension.si_unit());
        let at_header = |column: Option<&str>, expected: &str, found: &str, remedy: &str| {
            self.refuse(self.header_line, column, expected, found, remedy)
        };
        let Some((at, column)) = found.next() else {
            return Err(self.lacks(name, &example()));
        };
        if found.next().is_some() {
            let expected = format!("one column {}", example());
            let remedy = "keep one of the columns with this name";
            return Err(at_header(None, &expected, &self.listed(), remedy));
        }
        let named = Some(column.name.as_str());
        let Some(unit) = column.unit.as_deref().filter(|unit| !unit.is_empty()) else {
            let expected = format!("a unit in parentheses, as in {}", example());
            return Err(at_header(named, &expected, "none", "add the unit to the header"));
        };
        if let Err(error) = Quantity::parse_as(&format!("1 {unit}"), &[dimension]) {
            let expected = format!("a unit of {dimension}");
            let found = format!("\"{unit}\" ({error})");
            let better = Quantity::suggestion(&format!("1 {unit}"), &[dimension]);
            let remedy = match better.strip_prefix("1 ") {
                Some(better) => format!("write \"{} ({better})\" in the header", column.name),
                None => format!("write {} in the header", example()),
            };
            return Err(at_header(named, &expected, &found, &remedy));
        }
        Ok((at, unit))
    }

    fn value(
        &self,
        line: usize,
        column: &str,
        cell: &str,
        (unit, dimension): (&str, Dimension),
    ) -> Result<f64, TableError> {
        let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
        let quantity =
            number.and_then(|_| Quantity::parse_as(&format!("{cell} {unit}"), &[dimension]).ok());
        quantity.map(|quantity| quantity.value).ok_or_else(|| {
            let shown: String = cell.chars().filter(|c| !c.is_control()).take(40).collect();
            let found = if cell.is_empty() { "nothing".to_owned() } else { format!("\"{shown}\"") };
            self.refuse(line, Some(column), "a number", &found, CORRECT)
        })
    }

    /// Returns the values of a required column (SI units), which must all be positive.
    ///
    /// # Errors
    /// The same as for [`Table::required`], and if a value is not positive.
    pub fn positive(&self, name: &str, dimension: Dimension) -> Result<Vec<f64>, TableError> {
        let values = self.required(name, dimension)?;
        if let Some(row) = values.iter().position(|value| *value <= 0.0) {
            let (expected, remedy) = ("a number above zero", "correct it, or remove the row");
            return Err(self.at(row, name, expected, &self.cell(row, name), remedy));
        }
        Ok(values)
    }

    /// Returns the values of a column of annual rates (1/year).
    ///
    /// The unit in the header must be `1/year`, `1/yr` or `1/a`. The rates are not converted, since
    /// a year is not an SI unit.
    ///
    /// # Errors
    /// If the column is missing, has another unit, or holds anything but numbers.
    pub fn per_year(&self, name: &str) -> Result<Vec<f64>, TableError> {
        let place = self.columns.iter().position(|column| column.is(name));
        let unit = place.and_then(|at| self.columns[at].unit.as_deref());
        let (Some(at), Some("1/year" | "1/yr" | "1/a")) = (place, unit) else {
            return Err(self.lacks(name, &format!("`{name} (1/year)`")));
        };
        let number = |(line, row): &(usize, Vec<String>)| {
            let value = row[at].parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| {
                self.refuse(*line, Some(name), "a number", &format!("\"{}\"", row[at]), CORRECT)
            })
        };
        self.rows.iter().map(number).collect()
    }

    /// Creates an error about one cell; rows are counted from 0.
    pub fn at(
        &self,
        row: usize,
        column: &str,
        expected: &str,
        found: &str,
        remedy: &str,
    ) -> TableError {
        let line = self.rows.get(row).map_or(self.header_line, |(line, _)| *line);
        self.refuse(line, Some(column), expected, found, remedy)
    }

    /// Returns the text of a cell, or an empty string if there is no such cell. Rows are counted from 0.
    pub fn cell(&self, row: usize, name: &str) -> String {
        let at = self.columns.iter().position(|column| column.is(name));
        let cell = at.and_then(|at| self.rows.get(row)?.1.get(at));
        cell.cloned().unwrap_or_default()
    }

    fn refuse(
        &self,
        line: usize,
        column: Option<&str>,
        expected: &str,
        found: &str,
        remedy: &str,
    ) -> TableError {
        TableError::Cell {
            file: self.file.clone(),
            line,
            column: column.map(str::to_owned),
            expected: expected.into(),
            found: found.into(),
            remedy: remedy.into(),
        }
    }

    /// Creates an error about the file as a whole.
    pub fn unsuited(&self, reason: impl Into<String>) -> TableError {
        TableError::Unsuited { file: self.file.clone(), reason: reason.into() }
    }
}
