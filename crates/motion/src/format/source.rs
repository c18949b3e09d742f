//! Access to the lines, columns and numbers of a text file, with the position of each error.

use super::number::split_touching;
pub(crate) use super::number::{
    Printed, leading_number, leading_printed, leading_text, parse_number, resolution,
};
pub(crate) use super::place::{Columns, FilePosition};
pub(crate) use super::quoted::{latin1, quoted, shorten, utf8};
use crate::error::{ReadError, ReadFailure, Refusal};
use crate::record::Record;
use crate::units::AccelerationUnit;

/// Largest acceleration that a reader accepts (m/s²), about a thousand g.
pub(crate) const LARGEST_ACCELERATION: f64 = 1e4;

/// Characters that spreadsheets and programs write around numbers.
const MARKS: [char; 10] = ['"', '\'', '(', ')', '[', ']', '{', '}', '%', '$'];

/// SI value of the gal (m/s²); most networks write this unit as cm/s².
pub(crate) const GAL: f64 = 0.01;

/// A file split into lines. Line numbers count from 0 here, but from 1 in messages.
pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) bytes: &'a [u8],
    pub(crate) lines: Vec<&'a [u8]>,
}

impl<'a> Source<'a> {
    pub(crate) fn new(name: &'a str, bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let mut text = bytes;
        while let [rest @ .., 0x1A] = text {
            text = rest;
        }
        let separator = if text.contains(&b'\n') { b'\n' } else { b'\r' };
        while let [rest @ .., b'\n' | b'\r'] = text {
            text = rest;
        }
        // Count the lines first: a growing vector would need three times the memory for a file of
        // short lines.
        let count = text.split(|&byte| byte == separator).count();
        let mut lines: Vec<&[u8]> = Vec::with_capacity(count);
        lines.extend(text.split(|&byte| byte == separator).map(|mut line| {
            // Some agencies pad their lines with NUL characters.
            while let [rest @ .., b'\r' | 0] = line {
                line = rest;
            }
            line
        }));
        while lines.last().is_some_and(|line| line.trim_ascii().is_empty()) {
            lines.pop();
        }
        Self { name, bytes, lines }
    }

    /// Returns the trimmed text of a line (Latin-1); empty beyond the end of the file.
    pub(crate) fn text(&self, line: usize) -> String {
        latin1(self.raw(line)).trim().to_owned()
    }

    /// Returns the untrimmed bytes of a line; empty beyond the end of the file.
    pub(crate) fn raw(&self, line: usize) -> &'a [u8] {
        self.lines.get(line).copied().unwrap_or(&[])
    }

    /// Returns at most `width` characters of a line, starting at column `from` (counted from 0).
    pub(crate) fn slice(&self, line: usize, from: usize, width: usize) -> &'a [u8] {
        let raw = self.raw(line);
        let start = from.min(raw.len());
        &raw[start..(from.saturating_add(width)).min(raw.len())]
    }

    /// Returns `true` if the line contains `needle`, ignoring case.
    pub(crate) fn has(&self, line: usize, needle: &str) -> bool {
        self.find(line, needle).is_some()
    }

    /// Returns the byte offset of `needle` in the line, ignoring case.
    pub(crate) fn find(&self, line: usize, needle: &str) -> Option<usize> {
        find_ignoring_case(self.raw(line), needle.as_bytes())
    }

    /// Returns the first number after `key` on the line, skipping blanks, `=` and `:`.
    pub(crate) fn number_after(&self, line: usize, key: &str) -> Option<f64> {
        let start = self.find(line, key)? + key.len();
        leading_number(&self.raw(line)[start..])
    }

    /// Returns the first number after `key`, with the resolution of its printed digits.
    pub(crate) fn printed_after(&self, line: usize, key: &str) -> Option<Printed> {
        let start = self.find(line, key)? + key.len();
        leading_printed(&self.raw(line)[start..])
    }

    /// Returns the unit after one of `keys` on the line, with or without parentheses.
    pub(crate) fn unit_after(&self, line: usize, keys: &[&str]) -> Option<AccelerationUnit> {
        keys.iter().find_map(|key| self.word_after(line, key)?.1.parse().ok())
    }

    /// Returns the word after `key` on the line, and the offset of the end of the key.
    pub(crate) fn word_after(&self, line: usize, key: &str) -> Option<(usize, String)> {
        let at = self.find(line, key)? + key.len();
        let text = latin1(&self.raw(line)[at..]);
        let word = text.trim_start_matches(['(', ' ']).split([' ', ')', ',', ';']).next()?;
        Some((at, word.trim_end_matches('.').to_owned()))
    }

    /// Applies `value` to the text of each line before `end`. Returns the first line for which the
    /// result is not `None`, together with this result.
    pub(crate) fn field(
        &self,
        end: usize,
        value: impl Fn(&str) -> Option<&str>,
    ) -> Option<(usize, String)> {
        (0..end.min(self.lines.len()))
            .find_map(|line| Some((line, value(&self.text(line))?.trim().to_owned())))
    }

    /// Returns a required header field, or an error stating that the field is missing.
    pub(crate) fn needed<T>(&self, field: Option<T>, key: &str) -> Result<T, ReadError> {
        field.ok_or_else(|| self.header((), format!("a value for \"{key}\""), "none"))
    }

    /// Reads blocks up to the end of the file, skipping blank lines between them. `read` receives the first line of a
    /// block and returns the line after the block.
    pub(crate) fn each_block(
        &self,
        mut read: impl FnMut(usize) -> Result<usize, ReadError>,
    ) -> Result<(), ReadError> {
        let mut line = 0;
        while line < self.lines.len() {
            let blank = self.raw(line).trim_ascii().is_empty();
            line = if blank { line + 1 } else { read(line)? };
        }
        Ok(())
    }

    /// Checks that `line`, the first line of a block, contains `mark`. The error message states that
    /// `expected` is missing.
    pub(crate) fn require_mark(
        &self,
        line: usize,
        mark: &str,
        expected: &str,
    ) -> Result<(), ReadError> {
        if self.has(line, mark) {
            return Ok(());
        }
        let remedy =
            "lines are missing or added before this one; get the file again from its source";
        Err(self.damaged(line, expected, quoted(&self.text(line)), remedy))
    }

    /// Checks that all header lines of a block exist and are followed by data.
    pub(crate) fn require_header(&self, first: usize, lines: usize) -> Result<(), ReadError> {
        let found = self.lines.len() - first;
        if found > lines {
            return Ok(());
        }
        Err(self.cut(format!("{lines} header lines and data"), format!("{found} lines")))
    }

    /// Checks that the first nonblank line from `line` on ends a channel, and returns the line at
    /// which reading continues.
    ///
    /// If the line is marked "/&" or "end of data", the line after it is returned. If it contains
    /// `next`, the text with which the next channel begins, the line itself is returned. If only
    /// blank lines follow, the number of lines in the file is returned.
    pub(crate) fn end_of_channel(&self, line: usize, next: &str) -> Result<usize, ReadError> {
        let blank = |line: &usize| !self.raw(*line).trim_ascii().is_empty();
        let Some(line) = (line..self.lines.len()).find(blank) else { return Ok(self.lines.len()) };
        if self.text(line).starts_with("/&") || self.has(line, "END OF DATA") {
            return Ok(line + 1);
        }
        if self.has(line, next) {
            return Ok(line);
        }
        Err(self.damaged(
            line,
            "the end of the channel, \"/&\"",
            quoted(&self.text(line)),
            "the header states a different number of points than the file contains; get the file \
             again \
             from its source",
        ))
    }

    /// Returns an error about a damaged file.
    pub(crate) fn damaged(
        &self,
        place: impl Into<FilePosition>,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> ReadError {
        self.error(place, Refusal::Damaged, expected, found, remedy)
    }

    /// Returns an error about a valid file that contains no accelerations.
    pub(crate) fn not_acceleration(
        &self,
        place: impl Into<FilePosition>,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> ReadError {
        self.error(place, Refusal::NotAcceleration, expected, found, remedy)
    }

    /// Returns an error about a damaged header.
    pub(crate) fn header(
        &self,
        place: impl Into<FilePosition>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        self.damaged(place, expected, found, "restore the header from the original file")
    }

    pub(crate) fn error(
        &self,
        place: impl Into<FilePosition>,
        refusal: Refusal,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> ReadError {
        let place = place.into();
        // An error about a whole line is placed at the first non-blank character.
        let begin = |line: usize| {
            self.raw(line).iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(0)
        };
        ReadFailure {
            file: self.name.to_owned(),
            line: place.line.map(|line| line + 1),
            column: place.column.or_else(|| place.line.map(begin)).map(|column| column + 1),
            refusal,
            expected: expected.into(),
            found: found.into(),
            remedy: remedy.into(),
        }
        .into()
    }

    /// Returns an error about a field that is not a number, with a remedy that depends on the text
    /// of the field.
    pub(crate) fn bad_number(&self, line: usize, column: usize, field: &[u8]) -> ReadError {
        let text = latin1(field.trim_ascii());
        let begins = self.raw(line)[..column.min(self.raw(line).len())].trim_ascii().is_empty();
        let words = text.starts_with(|c: char| c.is_alphabetic() || "#%!/$\u{c}\"])}".contains(c));
        let (found, remedy) = if self.raw(line).trim_ascii().is_empty() {
            (
                "a blank line among the rows".to_owned(),
                "remove it if no row is lost there; otherwise get the file again from its source",
            )
        } else if text.is_empty() {
            ("blanks".to_owned(), "the file is damaged; get it again from its source")
        } else if text.contains("\u{e2}\u{88}\u{92}") || text.contains("\u{e2}\u{80}\u{93}") {
            (
                format!("a dash for the minus sign in {}", quoted(&utf8(self.raw(line)))),
                "write a hyphen for each minus sign",
            )
        } else if text.matches('.').count() > 1 && !text.contains(|c: char| c.is_alphabetic()) {
            (
                format!("{}, a number with several points", quoted(&text)),
                "remove the points that separate thousands",
            )
        } else if text.contains('*') {
            (
                quoted(&text),
                "the value overflowed its column when the file was written; get the file again \
                 in a wider format",
            )
        } else if super::number::is_no_number(&text) {
            (
                quoted(&text),
                "the program that wrote the file had no number here; get the file again from its source",
            )
        } else if parse_number(text.trim_matches(MARKS).as_bytes()).is_some() {
            (quoted(&text), "write only the number, with a hyphen if it is negative")
        } else if begins && words {
            (
                format!("words among the rows, {}", quoted(&self.text(line))),
                "remove this line, and others like it, if it is a remark, a repeated header or a footer; \
                 otherwise get the file again from its source",
            )
        } else {
            (
                quoted(&text),
                "the file is damaged or has another layout; get it again from its source",
            )
        };
        self.damaged((line, column), "a number", found, remedy)
    }

    /// Returns an error about a truncated file, located after the last character of the file.
    pub(crate) fn cut(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        let last = self.lines.len().saturating_sub(1);
        self.damaged(
            (last, self.end_of(last)),
            expected,
            found,
            "the file is truncated; get it again from its source",
        )
    }

    /// Returns the column after the last character of a line.
    pub(crate) fn end_of(&self, line: usize) -> usize {
        self.raw(line).trim_ascii_end().len()
    }

    /// Reads `count` numbers from fixed columns, starting on `line`. Returns the numbers and the
    /// next line.
    ///
    /// A line is split at fixed columns. If the line does not fit these columns, it is split at
    /// blanks, provided that this gives the right number of fields.
    pub(crate) fn fixed(
        &self,
        line: usize,
        count: usize,
        columns: Columns,
        limit: f64,
    ) -> Result<(Vec<f64>, usize), ReadError> {
        self.fixed_or_more(line, count, columns, limit, false)
            .map(|(values, next, _)| (values, next))
    }

    /// Reads the `count` numbers that the header states, as [`Source::fixed`] does. Excess numbers on
    /// the last line and on the lines after it are ignored with a warning.
    pub(crate) fn counted(
        &self,
        record: &mut Record,
        line: usize,
        count: usize,
        columns: Columns,
        limit: f64,
    ) -> Result<(Vec<f64>, usize), ReadError> {
        let (values, mut next, mut more) = self.fixed_or_more(line, count, columns, limit, true)?;
        let mut numbers = Vec::new();
        while next < self.lines.len() {
            numbers.clear();
            let filler = self.raw(next).is_empty()
                || (self.tokens(next, f64::INFINITY, &mut numbers).is_ok() && !numbers.is_empty());
            if !filler {
                break;
            }
            more += numbers.len();
            next += 1;
        }
        if more > 0 {
            record.warn(
                next,
                format!(
                    "{more} numbers follow the {count} that the header states; they are \
                     ignored"
                ),
            );
        }
        Ok((values, next))
    }

    /// Reads `count` numbers as [`Source::fixed`] does. Returns the numbers, the next line, and the
    /// count of excess numbers on the last line. If `lenient` is `false`, excess numbers are an error.
    fn fixed_or_more(
        &self,
        line: usize,
        count: usize,
        columns: Columns,
        limit: f64,
        lenient: bool,
    ) -> Result<(Vec<f64>, usize, usize), ReadError> {
        let mut more = 0;
        let mut values = Vec::with_capacity(count.min(self.bytes.len()));
        let mut at = line;
        while values.len() < count {
            if at >= self.lines.len() {
                return Err(
                    self.cut(format!("{count} numbers"), format!("{} numbers", values.len()))
                );
            }
            let wanted = columns.per_line.min(count - values.len());
            let before = values.len();
            if let Err(error) = self.fixed_line(at, wanted, columns, limit, &mut values) {
                values.truncate(before);
                let mut tokens = Vec::with_capacity(wanted);
                let read = self.tokens(at, limit, &mut tokens).is_ok();
                let last = lenient && before + wanted == count && wanted < columns.per_line;
                if read && last && tokens.len() > wanted {
                    more = tokens.len() - wanted;
                    tokens.truncate(wanted);
                } else if !read || tokens.len() != wanted {
                    return Err(error);
                }
                values.append(&mut tokens);
            }
            at += 1;
        }
        Ok((values, at, more))
    }

    fn fixed_line(
        &self,
        line: usize,
        wanted: usize,
        columns: Columns,
        limit: f64,
        values: &mut Vec<f64>,
    ) -> Result<(), ReadError> {
        let raw = self.raw(line);
        let filled = raw.trim_ascii_end().len();
        for k in 0..wanted {
            let from = columns.indent + k * columns.width;
            if from >= filled {
                return Err(self.ragged(line, wanted, k));
            }
            let field = self.slice(line, from, columns.width);
            let value = parse_number(field).ok_or_else(|| self.bad_number(line, from, field))?;
            values.push(self.within(line, from, value, limit)?);
        }
        let end = columns.indent + wanted * columns.width;
        if filled > end {
            return Err(self.damaged(
                (line, end),
                format!("the end of the line after {wanted} numbers"),
                quoted(&latin1(raw[end..].trim_ascii())),
                "the header states fewer numbers than the file contains, or other columns; get the \
                 file again from its source",
            ));
        }
        Ok(())
    }

    /// Appends the numbers of a line to `values`. The numbers are separated by blanks, tabs, commas or
    /// semicolons, or follow each other without a separator, as in `-.123E-02-.456E-02`.
    pub(crate) fn tokens(
        &self,
        line: usize,
        limit: f64,
        values: &mut Vec<f64>,
    ) -> Result<(), ReadError> {
        let raw = self.raw(line);
        let mut at = 0;
        while at < raw.len() {
            if is_separator(raw[at]) {
                at += 1;
                continue;
            }
            let start = at;
            while at < raw.len() && !is_separator(raw[at]) {
                at += 1;
            }
            let token = &raw[start..at];
            if let Some(value) = parse_number(token) {
                values.push(self.within(line, start, value, limit)?);
                continue;
            }
            let pieces =
                split_touching(token).ok_or_else(|| self.bad_number(line, start, token))?;
            for (offset, value) in pieces {
                values.push(self.within(line, start + offset, value, limit)?);
            }
        }
        Ok(())
    }

    /// Returns all numbers of the lines `from..to`, separated as described at [`Source::tokens`].
    pub(crate) fn all_tokens(
        &self,
        from: usize,
        to: usize,
        limit: f64,
    ) -> Result<Vec<f64>, ReadError> {
        let mut values = Vec::with_capacity(self.bytes.len() / 12);
        for line in from..to.min(self.lines.len()) {
            self.tokens(line, limit, &mut values)?;
        }
        Ok(values)
    }

    /// Returns `value`, or an error if the value exceeds any possible acceleration.
    pub(crate) fn within(
        &self,
        line: usize,
        column: usize,
        value: f64,
        limit: f64,
    ) -> Result<f64, ReadError> {
        if value.abs() <= limit {
            Ok(value)
        } else {
            Err(self.damaged(
                (line, column),
                format!("a number up to {limit:.3e} in the file's unit"),
                format!("{value:e}"),
                "ground accelerations are smaller; check the unit, or get the file again from its source",
            ))
        }
    }

    /// Returns an error about a row that does not have `width` numbers.
    pub(crate) fn ragged(&self, line: usize, width: usize, found: usize) -> ReadError {
        self.damaged(
            (line, self.end_of(line)),
            format!("{width} numbers"),
            format!("{found} numbers"),
            "the file is truncated or a line was lost; get it again from its source",
        )
    }

    /// Checks that the file contains no control characters other than white space. The error locates
    /// the first one.
    pub(crate) fn require_text(&self) -> Result<(), ReadError> {
        for (line, raw) in self.lines.iter().enumerate() {
            if let Some(column) = raw.iter().position(|&b| b < 0x09 || (0x0E..0x20).contains(&b)) {
                return Err(self.damaged(
                    (line, column),
                    "text",
                    format!("byte 0x{:02X}", raw[column]),
                    "the file is binary or damaged; give the original file",
                ));
            }
        }
        Ok(())
    }
}

fn is_separator(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b',' | b';')
}

fn find_ignoring_case(haystack: &[u8], needle: &[u8]) -> Option<usize> {
    if needle.is_empty() || haystack.len() < needle.len() {
        return None;
    }
    haystack.windows(needle.len()).position(|window| window.eq_ignore_ascii_case(needle))
}
