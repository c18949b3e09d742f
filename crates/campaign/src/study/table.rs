//! Table of a study, with one row per case.

use std::fmt::Write as _;

use barrelstack_report::csv_field;

use super::error::StudyError;
use super::shard;
use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, Values, to_csv};

/// Table of a study: one row per case, in the order of the cases, with typed columns in SI units.
///
/// Columns are looked up by name without the unit, such as `pgv`. A value is `None` if it does not apply,
/// such as the mode of a stack that stood. It is also `None` if it is unknown, such as every result of a case
/// that could not run; the column `error` then states the reason.
///
/// ```no_run
/// use barrelstack_campaign::study::{Collected, Tally};
///
/// let table = Collected::read(std::path::Path::new("results"))?.table;
/// let strongest = table.numbers("pgv").unwrap_or_default().iter().flatten().copied().fold(0.0, f64::max);
/// println!("{} of {} collapse, up to {strongest} m/s", Tally::of(&table).collapsed, table.rows());
/// # Ok::<(), barrelstack_campaign::study::StudyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StudyTable {
    columns: Vec<Column>,
}

impl StudyTable {
    /// Creates a table from columns of the same length.
    ///
    /// # Errors
    /// If two columns have the same name, if their lengths differ, or if the values of a column are not of the kind
    /// that its specification states.
    pub fn new(columns: Vec<Column>) -> Result<Self, StudyError> {
        let rows = columns.first().map_or(0, |column| column.values.len());
        for (index, column) in columns.iter().enumerate() {
            let name = &column.spec.name;
            if columns[..index].iter().any(|other| other.spec.name == *name) {
                return Err(StudyError::Table(format!("two columns have the name `{name}`")));
            }
            if column.values.len() != rows {
                let found = column.values.len();
                return Err(StudyError::Table(format!(
                    "the column `{name}` has {found} rows, but others have {rows}"
                )));
            }
            let fits = matches!(
                (&column.values, column.spec.kind),
                (Values::Integer(_), ValueKind::Integer)
                    | (Values::Number(_), ValueKind::Number)
                    | (Values::Text(_), ValueKind::Text)
            );
            if !fits {
                return Err(StudyError::Table(format!(
                    "the values of the column `{name}` do not have the stated type"
                )));
            }
        }
        Ok(Self { columns })
    }

    /// Creates a table without rows. The names of the columns must be unique.
    pub fn empty(specs: &[ColumnSpec]) -> Self {
        Self { columns: specs.iter().cloned().map(Column::empty).collect() }
    }

    /// Appends a row, which has one element per column; an element is `None` if the value does not apply or is unknown.
    ///
    /// # Errors
    /// If the number of elements differs from the number of columns, or if the kind of a value differs from that of its
    /// column.
    pub fn push(&mut self, row: Vec<Option<Value>>) -> Result<(), StudyError> {
        if row.len() != self.columns.len() {
            let (found, expected) = (row.len(), self.columns.len());
            return Err(StudyError::Table(format!(
                "a row has {found} values for {expected} columns"
            )));
        }
        let mut pairs = self.columns.iter_mut().zip(row);
        pairs.try_for_each(|(column, value)| column.values.push(value)).map_err(StudyError::Table)
    }

    /// Joins tables with the same columns and sorts the rows by case.
    pub(super) fn join(specs: &[ColumnSpec], parts: &[Self]) -> Result<Self, StudyError> {
        let mut order: Vec<(i64, usize, usize)> = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            if !part.specs().eq(specs.iter()) {
                return Err(StudyError::Table(
                    "the shards belong to studies with different columns".to_owned(),
                ));
            }
            let cases = part.integers("case").unwrap_or_default();
            order.extend(
                cases.iter().enumerate().filter_map(|(row, case)| Some(((*case)?, index, row))),
            );
        }
        order.sort_unstable();
        let mut table = Self::empty(specs);
        for (number, column) in table.columns.iter_mut().enumerate() {
            for (_, part, row) in &order {
                let value = parts[*part].columns[number].values.get(*row);
                column.values.push(value).map_err(StudyError::Table)?;
            }
        }
        Ok(table)
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Returns all columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Returns the specifications of the columns, in order.
    pub fn specs(&self) -> impl Iterator<Item = &ColumnSpec> {
        self.columns.iter().map(|column| &column.spec)
    }

    /// Returns the columns with the given role, such as the columns of all factors, in order.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(move |column| column.spec.role == role)
    }

    /// Returns the column with the given name (without the unit); `None` if there is no such column.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.spec.name == name)
    }

    /// Returns the numbers (SI) of a column; `None` if there is no such column of numbers.
    pub fn numbers(&self, name: &str) -> Option<&[Option<f64>]> {
        if let Values::Number(values) = &self.column(name)?.values { Some(values) } else { None }
    }

    /// Returns the integers of a column; `None` if there is no such column of integers.
    pub fn integers(&self, name: &str) -> Option<&[Option<i64>]> {
        if let Values::Integer(values) = &self.column(name)?.values { Some(values) } else { None }
    }

    /// Returns the strings of a column; `None` if there is no such column of strings.
    pub fn texts(&self, name: &str) -> Option<&[Option<String>]> {
        if let Values::Text(values) = &self.column(name)?.values { Some(values) } else { None }
    }

    /// Returns the number of rows that precede a case. The table must be sorted by case.
    pub(super) fn rows_before(&self, case: i64) -> usize {
        let cases = self.integers("case").unwrap_or_default();
        cases.partition_point(|number| number.is_some_and(|number| number < case))
    }

    /// Removes all rows from index `row` on, and returns them as a table.
    pub(super) fn split_off(&mut self, row: usize) -> Self {
        let split = |column: &mut Column| Column {
            spec: column.spec.clone(),
            values: column.values.split_off(row),
        };
        Self { columns: self.columns.iter_mut().map(split).collect() }
    }

    /// Appends the rows of a table with the same columns.
    pub(super) fn append(&mut self, rows: Self) -> Result<(), StudyError> {
        let mut pairs = self.columns.iter_mut().zip(rows.columns);
        let append = |(column, more): (&mut Column, Column)| column.values.append(more.values);
        pairs.try_for_each(append).map_err(StudyError::Table)
    }

    /// Returns the table as CSV text.
    pub fn to_csv(&self) -> String {
        to_csv(&self.columns)
    }

    /// Returns the table as the bytes of a Parquet file. The same table always gives the same bytes.
    ///
    /// # Errors
    /// If the table cannot be encoded.
    pub fn to_parquet(&self) -> Result<Vec<u8>, StudyError> {
        Ok(shard::to_bytes(self, &[])?)
    }

    /// Returns a description of every column as CSV: name, unit, role, kind, and meaning.
    ///
    /// In the CSV of the table itself, the unit follows the name of the column, and lists of numbers are
    /// separated by semicolons.
    pub fn dictionary(&self) -> String {
        let mut text = "name,unit,role,kind,meaning\n".to_owned();
        for spec in self.specs() {
            let word = |of: serde_json::Value| of.as_str().unwrap_or_default().to_owned();
            let cells = [
                spec.name.clone(),
                spec.unit.clone(),
                serde_json::to_value(spec.role).map_or_else(|_| String::new(), word),
                if shard::holds_lists(spec) {
                    "list".to_owned()
                } else {
                    serde_json::to_value(spec.kind).map_or_else(|_| String::new(), word)
                },
                super::rows::meaning(spec).to_owned(),
            ];
            let _ = writeln!(text, "{}", cells.map(|cell| csv_field(&cell)).join(","));
        }
        text
    }

    /// Reads a table from the bytes of a Parquet file that [`StudyTable::to_parquet`] wrote.
    ///
    /// # Errors
    /// If the bytes are not the content of such a file.
    pub fn from_parquet(bytes: Vec<u8>) -> Result<Self, StudyError> {
        Ok(shard::from_bytes(bytes, "")?.0)
    }
}
