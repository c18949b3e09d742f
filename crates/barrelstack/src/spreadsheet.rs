//! Tables for spreadsheet programs: a workbook (`.xlsx`) of tables that are written as CSV, and CSV with decimal
//! commas.
//!
//! Both are made from the text of the CSV file, so that all files have the same numbers.

use std::fmt::Write as _;

use barrelstack_report::csv_field;
#[cfg(feature = "xlsx")]
use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, Workbook, Worksheet, XlsxError};
use serde_json::Value;

/// Largest number of characters in a cell.
#[cfg(feature = "xlsx")]
const CHARACTERS: usize = 32_767;
/// Largest number of characters in the name of a sheet.
#[cfg(feature = "xlsx")]
const NAME: usize = 31;
/// Largest number of digits of an integer that a spreadsheet program keeps exactly. Longer strings of digits are
/// identifiers, such as fingerprints, and are written as text.
const DIGITS: usize = 15;

/// Returns a workbook (ECMA-376) with a sheet for each table, given with its name and its text as CSV.
///
/// The first row of a sheet is the header row of the table, and stays in view when the sheet is scrolled. If a column
/// contains only numbers, its cells are written as numbers; all other cells are written as text, which keeps
/// identifiers such as the station `058` or a fingerprint unchanged. No string becomes a formula. A string that is
/// longer than a cell can hold is truncated.
///
/// ```
/// let book = barrelstack::spreadsheet::workbook(&[("records", "station,pga (m/s2)\n058,3.5\n")])?;
/// assert!(book.starts_with(b"PK"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a table has more rows or columns than a sheet, or if two tables have the same name.
#[cfg(feature = "xlsx")]
pub fn workbook(tables: &[(&str, &str)]) -> Result<Vec<u8>, XlsxError> {
    let mut book = Workbook::new();
    // The same tables give the same bytes.
    let undated = ExcelDateTime::from_ymd(2000, 1, 1)?;
    book.set_properties(&DocProperties::new().set_creation_datetime(&undated));
    for (name, csv) in tables {
        fill(book.add_worksheet().set_name(sheet_name(name))?, csv)?;
    }
    book.save_to_buffer()
}

/// Returns the provenance as a CSV table of names and values: the rows of `facts`, then the members of `documents`.
///
/// Each document is the content of a JSON file. If it has a member `provenance`, only the members of `provenance` are
/// listed. Nested members are listed under their paths, such as `a.b`. A member `columns` is left out, because the
/// tables state their columns.
pub fn provenance(facts: &[(String, String)], documents: &[&str]) -> String {
    let mut rows = facts.to_vec();
    for text in documents {
        let document: Value = serde_json::from_str(text).unwrap_or_default();
        let mut document = document.get("provenance").unwrap_or(&document).clone();
        if let Value::Object(members) = &mut document {
            members.remove("columns");
        }
        listed("", &document, &mut rows);
    }
    let row =
        |(name, value): (String, String)| format!("{},{}\n", csv_field(&name), csv_field(&value));
    "name,value\n".to_owned() + &rows.into_iter().map(row).collect::<String>()
}

/// Appends all members of a JSON value, at every depth, to `rows` as pairs of path and value.
fn listed(path: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    match value {
        Value::Object(members) => {
            let below = |name: &str| {
                if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
            };
            members.iter().for_each(|(name, member)| listed(&below(name), member, rows));
        }
        Value::Array(items) => {
            (1..).zip(items).for_each(|(at, item)| listed(&format!("{path} {at}"), item, rows));
        }
        Value::String(text) => rows.push((path.to_owned(), text.clone())),
        Value::Null => {}
        Value::Bool(_) | Value::Number(_) => rows.push((path.to_owned(), value.to_string())),
    }
}

/// Rewrites a CSV table with decimal commas, and with semicolons between the columns, as spreadsheet programs write CSV
/// in many locales.
///
/// ```
/// let csv = barrelstack::spreadsheet::with_decimal_commas("rack,pga (m/s2)\n\"4,5-bar\",0.5\n");
/// assert_eq!(csv, "rack;pga (m/s2)\n4,5-bar;0,5\n");
/// let lists = barrelstack::spreadsheet::with_decimal_commas("fall_heights\n1.5;2.25\n");
/// assert_eq!(lists, "fall_heights\n\"1,5;2,25\"\n");
/// ```
pub fn with_decimal_commas(csv: &str) -> String {
    let mut text = String::with_capacity(csv.len());
    for row in Rows(csv) {
        for (at, cell) in row.iter().enumerate() {
            if at > 0 {
                text.push(';');
            }
            // A cell may hold a list of numbers.
            let is_list = cell.split(';').all(is_number);
            let cell = if is_list { cell.replace('.', ",") } else { cell.clone() };
            if cell.contains([';', '"', '\n', '\r']) {
                // Writing to a String cannot fail.
                let _ = write!(text, "\"{}\"", cell.replace('"', "\"\""));
            } else {
                text.push_str(&cell);
            }
        }
        text.push('\n');
    }
    text
}

/// Iterator over the rows of a CSV table whose cells [`csv_field`] wrote. Each item has the cells of one row.
struct Rows<'a>(&'a str);

impl Iterator for Rows<'_> {
    type Item = Vec<String>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.0.is_empty() {
            return None;
        }
        let (mut row, mut cell, mut quoted) = (Vec::new(), String::new(), false);
        let mut letters = self.0.char_indices().peekable();
        while let Some((_, letter)) = letters.next() {
            match letter {
                '"' if quoted && letters.next_if(|(_, next)| *next == '"').is_some() => {
                    cell.push('"');
                }
                '"' => quoted = !quoted,
                ',' if !quoted => row.push(std::mem::take(&mut cell)),
                '\n' if !quoted => break,
                '\r' if !quoted => {}
                _ => cell.push(letter),
            }
        }
        self.0 = letters.next().map_or("", |(at, _)| &self.0[at..]);
        row.push(cell);
        Some(row)
    }
}

/// Returns `true` if a string is a finite number, and does not look like an identifier.
///
/// A string looks like an identifier if its integer part has a leading zero or more than [`DIGITS`] digits, or if it
/// has an exponent after an integer part of several digits.
fn is_number(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let whole = digits.split(['.', 'e']).next().unwrap_or_default();
    let named = (whole.len() > 1 && whole.starts_with('0'))
        || whole.len() > DIGITS
        || (whole.len() > 1 && digits.contains('e'));
    digits.starts_with(|first: char| first.is_ascii_digit())
        && !named
        && text.parse::<f64>().is_ok_and(f64::is_finite)
}

/// Writes a table into a sheet.
#[cfg(feature = "xlsx")]
fn fill(sheet: &mut Worksheet, csv: &str) -> Result<(), XlsxError> {
    let mut rows = Rows(csv);
    let heading = rows.next().unwrap_or_default();
    let body = rows.0;
    // In a column of numbers, every cell that is not empty is a number, and there is at least one such cell.
    let mut numbers: Vec<Option<bool>> = vec![None; heading.len()];
    for row in Rows(body) {
        for (column, cell) in numbers.iter_mut().zip(&row).filter(|(_, cell)| !cell.is_empty()) {
            *column = Some(column.unwrap_or(true) && is_number(cell));
        }
    }
    let bold = Format::new().set_bold();
    sheet.set_freeze_panes(1, 0)?;
    for (at, name) in heading.iter().enumerate() {
        let column = u16::try_from(at).map_err(|_| XlsxError::RowColumnLimitError)?;
        let width = (name.chars().count() + 2).clamp(9, 40);
        sheet.set_column_width(column, f64::from(u8::try_from(width).unwrap_or(40)))?;
        sheet.write_string_with_format(0, column, content(name), &bold)?;
    }
    for (line, row) in (1..).zip(Rows(body)) {
        for ((column, cell), is_numeric) in (0..).zip(&row).zip(&numbers) {
            match cell.parse::<f64>() {
                _ if cell.is_empty() => {}
                Ok(number) if *is_numeric == Some(true) => {
                    sheet.write_number(line, column, number)?;
                }
                _ => {
                    sheet.write_string(line, column, content(cell))?;
                }
            }
        }
    }
    Ok(())
}

/// Returns the content of a cell, truncated to the number of characters that a cell can hold.
#[cfg(feature = "xlsx")]
fn content(text: &str) -> String {
    // In CSV, an apostrophe marks a string that would otherwise be a formula. Here the type of the cell marks it.
    let marked =
        text.strip_prefix('\'').filter(|rest| rest.starts_with(['=', '+', '-', '@', '\t', '\r']));
    marked.unwrap_or(text).chars().take(CHARACTERS).collect()
}

/// Converts a name to a valid sheet name: truncates it, and replaces characters that are not allowed by spaces.
#[cfg(feature = "xlsx")]
fn sheet_name(name: &str) -> String {
    let kept = |c: char| {
        if matches!(c, '[' | ']' | ':' | '*' | '?' | '/' | '\\' | '\'') { ' ' } else { c }
    };
    name.chars().take(NAME).map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::is_number;
    #[cfg(feature = "xlsx")]
    use super::workbook;

    #[test]
    fn names_of_digits_are_no_numbers() {
        for number in ["0", "-0.5", "12", "1e-7", "2.5e300", "0.0001", "123456789012345"] {
            assert!(is_number(number), "{number}");
        }
        for name in
            ["", "058", "1234567890123456", "12e45", "inf", "NaN", "+5", "-", "0.1.0", "1e999"]
        {
            assert!(!is_number(name), "{name}");
        }
    }

    #[cfg(feature = "xlsx")]
    #[test]
    fn a_table_that_no_sheet_holds_is_refused() {
        let long = "n\n".repeat((1 << 20) + 1);
        let wide = "n,".repeat(1 << 14);
        for table in [long, wide] {
            let error = workbook(&[("t", &table)]).unwrap_err().to_string();
            assert!(error.contains("limits of Excel") || error.contains("exceeds"), "{error}");
        }
        assert!(workbook(&[("t", "n\n"), ("T", "n\n")]).is_err());
    }
}
