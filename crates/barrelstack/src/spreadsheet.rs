//! Tables for spreadsheet programs: a workbook (`.xlsx`) of tables that are written as CSV, and CSV with decimal
//! commas.
//!
//! Both are made from the text of the CSV file, so that all files have the same numbers.

use std::fmt::Write as _;
use std::io::{self, Write};

use barrelstack_motion::write::{Deflated, Entry, zip};
use barrelstack_report::csv_field;
use serde_json::Value;

/// Largest number of rows of a sheet.
pub const ROWS: usize = 1 << 20;
/// Largest number of columns of a sheet.
pub const COLUMNS: usize = 1 << 14;
/// Largest number of characters in a cell.
const CHARACTERS: usize = 32_767;
/// Largest number of characters in the name of a sheet.
const NAME: usize = 31;
/// Digits of a whole number that a spreadsheet program shows; longer ones are names, such as fingerprints.
const DIGITS: usize = 15;

/// Begins a part of a workbook.
const XML: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n";
/// Namespace of workbooks and sheets (ECMA-376-1, 18).
const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
/// Namespace of relationships between parts (ECMA-376-1, 22.8).
const RELATED: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
/// Namespace of the lists of relationships (ECMA-376-2, 9.3).
const LIST: &str = "http://schemas.openxmlformats.org/package/2006/relationships";
/// Begins the content types of spreadsheets.
const TYPE: &str = "application/vnd.openxmlformats-officedocument.spreadsheetml";

/// Returns a workbook (ECMA-376) with a sheet for each table, given with its name and its text as CSV.
///
/// The first row of a sheet is the heading of the table, and stays in view. Cells of a column that contains only numbers
/// are numbers, and all others are texts: the text `058` of a station, or a fingerprint, is kept as it is. No text is a
/// formula. Longer texts than a cell holds are cut.
///
/// ```
/// let book = barrelstack::spreadsheet::workbook(&[("records", "station,pga (m/s2)\n058,3.5\n")])?;
/// assert!(book.starts_with(b"PK"));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// If a table has more rows or columns than a sheet, if two tables have the same name, or if the workbook is too large
/// for its format.
pub fn workbook(tables: &[(&str, &str)]) -> io::Result<Vec<u8>> {
    let mut names: Vec<String> = Vec::new();
    let mut entries = Vec::new();
    for (number, (name, csv)) in (1..).zip(tables) {
        let name = sheet_name(name);
        if names.iter().any(|other| other.eq_ignore_ascii_case(&name)) {
            return Err(refused(format!("two sheets are named {name}")));
        }
        let mut part = Deflated::new(format!("xl/worksheets/sheet{number}.xml"));
        sheet(csv, &mut part).map_err(|error| refused(format!("table {name}: {error}")))?;
        entries.push(part.finish()?);
        names.push(name);
    }
    let numbers = || 1..=names.len();
    let rows: Vec<String> = (1..)
        .zip(&names)
        .map(|(n, name)| {
            format!("<sheet name=\"{}\" sheetId=\"{n}\" r:id=\"rId{n}\"/>", escaped(name))
        })
        .collect();
    let book = format!(
        "<workbook xmlns=\"{MAIN}\" xmlns:r=\"{RELATED}\"><sheets>{}</sheets></workbook>",
        rows.concat()
    );
    let relation = |id: String, kind: &str, target: String| {
        format!("<Relationship Id=\"{id}\" Type=\"{RELATED}/{kind}\" Target=\"{target}\"/>")
    };
    let relations =
        |list: String| format!("<Relationships xmlns=\"{LIST}\">{list}</Relationships>");
    let sheets = numbers()
        .map(|n| relation(format!("rId{n}"), "worksheet", format!("worksheets/sheet{n}.xml")));
    let styles = relation("styles".to_owned(), "styles", "styles.xml".to_owned());
    let part = |name: &str, kind: &str| {
        format!("<Override PartName=\"/xl/{name}.xml\" ContentType=\"{TYPE}.{kind}+xml\"/>")
    };
    let kinds: String =
        numbers().map(|n| part(&format!("worksheets/sheet{n}"), "worksheet")).collect();
    let types = format!(
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default Extension=\"rels\" \
         ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>{}{}{kinds}</Types>",
        part("workbook", "sheet.main"),
        part("styles", "styles")
    );
    let root = relation("rId1".to_owned(), "officeDocument", "xl/workbook.xml".to_owned());
    let parts = [
        ("[Content_Types].xml", types),
        ("_rels/.rels", relations(root)),
        ("xl/workbook.xml", book),
        ("xl/_rels/workbook.xml.rels", relations(sheets.collect::<String>() + &styles)),
        ("xl/styles.xml", style_sheet()),
    ];
    let stored = |(name, text): (&str, String)| {
        Entry::stored(name.to_owned(), format!("{XML}{text}").into_bytes())
    };
    zip(&parts.map(stored).into_iter().chain(entries).collect::<Vec<_>>())
}

/// Returns the styles: that of cells, and that of headings, which are bold.
fn style_sheet() -> String {
    let font = |bold: &str| format!("<font>{bold}<sz val=\"11\"/><name val=\"Calibri\"/></font>");
    let cell = |font: u8| {
        format!("<xf numFmtId=\"0\" fontId=\"{font}\" fillId=\"0\" borderId=\"0\" xfId=\"0\"/>")
    };
    // The format requires the two fills.
    format!(
        "<styleSheet xmlns=\"{MAIN}\"><fonts count=\"2\">{}{}</fonts><fills count=\"2\"><fill><patternFill \
         patternType=\"none\"/></fill><fill><patternFill patternType=\"gray125\"/></fill></fills><borders count=\"1\">\
         <border/></borders><cellStyleXfs count=\"1\"><xf numFmtId=\"0\" fontId=\"0\" fillId=\"0\" borderId=\"0\"/>\
         </cellStyleXfs><cellXfs count=\"2\">{}{}</cellXfs></styleSheet>",
        font(""),
        font("<b/>"),
        cell(0),
        cell(1)
    )
}

/// Returns the table of the provenance: the given facts, then the members of the documents, by name and value.
///
/// A document is the text of a JSON file; only its member `provenance` is listed, if it has one.
pub fn provenance(facts: &[(String, String)], documents: &[&str]) -> String {
    let mut rows = facts.to_vec();
    for text in documents {
        let document: Value = serde_json::from_str(text).unwrap_or_default();
        listed("", document.get("provenance").unwrap_or(&document), &mut rows);
    }
    let row =
        |(name, value): (String, String)| format!("{},{}\n", csv_field(&name), csv_field(&value));
    "name,value\n".to_owned() + &rows.into_iter().map(row).collect::<String>()
}

/// Appends the members of a value, and their members, with their paths.
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

/// Returns a table with decimal commas, and with semicolons between the columns, as spreadsheet programs of many languages
/// write CSV.
///
/// ```
/// let csv = barrelstack::spreadsheet::with_decimal_commas("rack,pga (m/s2)\n\"4,5-bar\",0.5\n");
/// assert_eq!(csv, "rack;pga (m/s2)\n4,5-bar;0,5\n");
/// ```
pub fn with_decimal_commas(csv: &str) -> String {
    let mut text = String::with_capacity(csv.len());
    for row in Rows(csv) {
        for (at, cell) in row.iter().enumerate() {
            if at > 0 {
                text.push(';');
            }
            if is_number(cell) {
                text.push_str(&cell.replace('.', ","));
            } else if cell.contains([';', '"', '\n', '\r']) {
                // Writing to a String cannot fail.
                let _ = write!(text, "\"{}\"", cell.replace('"', "\"\""));
            } else {
                text.push_str(cell);
            }
        }
        text.push('\n');
    }
    text
}

/// The rows of a table that [`csv_field`] wrote; each has its cells.
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

/// Returns `true` if a text is a number, and not a name that consists of digits.
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

/// Writes a sheet.
fn sheet(csv: &str, out: &mut impl Write) -> io::Result<()> {
    let mut rows = Rows(csv);
    let heading = rows.next().unwrap_or_default();
    if heading.len() > COLUMNS {
        return Err(refused(format!(
            "{} columns are more than the {COLUMNS} of a sheet",
            heading.len()
        )));
    }
    let body = rows.0;
    // A column of numbers has at least one, and only empty cells besides.
    let mut numbers: Vec<Option<bool>> = vec![None; heading.len()];
    let mut count = 1;
    for row in Rows(body) {
        count += 1;
        for (column, cell) in numbers.iter_mut().zip(&row).filter(|(_, cell)| !cell.is_empty()) {
            *column = Some(column.unwrap_or(true) && is_number(cell));
        }
    }
    if count > ROWS {
        return Err(refused(format!("{count} rows are more than the {ROWS} of a sheet")));
    }
    write!(
        out,
        "{XML}<worksheet xmlns=\"{MAIN}\"><sheetViews><sheetView workbookViewId=\"0\"><pane ySplit=\"1\" \
         topLeftCell=\"A2\" activePane=\"bottomLeft\" state=\"frozen\"/></sheetView></sheetViews><cols>"
    )?;
    for (at, name) in (1..).zip(&heading) {
        let width = (name.chars().count() + 2).clamp(9, 40);
        write!(out, "<col min=\"{at}\" max=\"{at}\" width=\"{width}\" customWidth=\"1\"/>")?;
    }
    write!(out, "</cols><sheetData><row r=\"1\">")?;
    for (at, name) in heading.iter().enumerate() {
        text_cell(out, &format!("r=\"{}1\" s=\"1\"", letters(at)), name)?;
    }
    write!(out, "</row>")?;
    for (line, row) in (2_usize..).zip(Rows(body)) {
        write!(out, "<row r=\"{line}\">")?;
        for ((at, cell), column) in row.iter().enumerate().zip(&numbers) {
            match column {
                _ if cell.is_empty() => {}
                Some(true) => write!(out, "<c r=\"{}{line}\"><v>{cell}</v></c>", letters(at))?,
                Some(false) | None => {
                    text_cell(out, &format!("r=\"{}{line}\"", letters(at)), cell)?;
                }
            }
        }
        write!(out, "</row>")?;
    }
    write!(out, "</sheetData></worksheet>")
}

/// Writes a cell with a text; `attributes` are its place and its style.
fn text_cell(out: &mut impl Write, attributes: &str, text: &str) -> io::Result<()> {
    // In CSV an apostrophe marks what would be a formula as text; here the type of the cell does.
    let marked =
        text.strip_prefix('\'').filter(|rest| rest.starts_with(['=', '+', '-', '@', '\t', '\r']));
    let text: String = marked.unwrap_or(text).chars().take(CHARACTERS).collect();
    write!(
        out,
        "<c {attributes} t=\"inlineStr\"><is><t xml:space=\"preserve\">{}</t></is></c>",
        escaped(&text)
    )
}

/// Returns a text as XML; characters that XML cannot contain become spaces.
fn escaped(text: &str) -> String {
    let plain = |c: char| {
        if (c < ' ' && !matches!(c, '\t' | '\n' | '\r')) || matches!(c, '\u{fffe}' | '\u{ffff}') {
            ' '
        } else {
            c
        }
    };
    let text: String = text.chars().map(plain).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns the letters of a column: A to Z, then AA, AB and so on.
fn letters(mut at: usize) -> String {
    let mut reversed = Vec::new();
    loop {
        reversed.push(char::from(b'A' + u8::try_from(at % 26).unwrap_or_default()));
        if at < 26 {
            return reversed.iter().rev().collect();
        }
        at = at / 26 - 1;
    }
}

/// Returns a name that a sheet can have: not too long, and without the characters that are not allowed.
fn sheet_name(name: &str) -> String {
    let kept = |c: char| {
        if matches!(c, '[' | ']' | ':' | '*' | '?' | '/' | '\\' | '\'') { ' ' } else { c }
    };
    name.chars().take(NAME).map(kept).collect()
}

fn refused(reason: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, reason)
}

#[cfg(test)]
mod tests {
    use super::{is_number, letters, workbook};

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

    #[test]
    fn columns_have_letters() {
        assert_eq!(
            [0, 25, 26, 701, 702, 16_383].map(letters),
            ["A", "Z", "AA", "ZZ", "AAA", "XFD"]
        );
    }

    #[test]
    fn a_table_that_no_sheet_holds_is_refused() {
        let long = "n\n".repeat(super::ROWS + 1);
        let wide = "n,".repeat(super::COLUMNS);
        for (table, what) in [(long, "rows"), (wide, "columns")] {
            let error = workbook(&[("t", &table)]).unwrap_err().to_string();
            assert!(error.contains(what), "{error}");
        }
        assert!(workbook(&[("t", "n\n"), ("T", "n\n")]).is_err());
    }
}
