//! What can be wrong with an input file, where, and what to do about it.

use std::fmt;

use crate::quantity::QuantityError;

/// Where an input is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// In a file.
    File {
        /// Name of the file as given.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// Length in characters of what is wrong on that line.
        width: usize,
        /// The line.
        text: String,
    },
    /// In an override, `path=value`.
    Override {
        /// The override as given.
        text: String,
    },
    /// In a file as a whole.
    Whole {
        /// Name of the file as given.
        file: String,
    },
    /// In no text of the user.
    Unknown,
}

impl Place {
    /// The place of a byte range of a text.
    pub(crate) fn in_text(file: &str, text: &str, start: usize, end: usize) -> Self {
        let start = floor_boundary(text, start);
        let end = floor_boundary(text, end).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let line = text[..start].matches('\n').count() + 1;
        let line_text = text[line_start..line_end].trim_end_matches('\r');
        Self::File {
            file: file.to_owned(),
            line,
            column: text[line_start..start].chars().count() + 1,
            width: text[start..end.min(line_end)].chars().count().max(1),
            text: line_text.to_owned(),
        }
    }
}

fn floor_boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// The short form: `file:line:column`, or the override.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { file, line, column, .. } => write!(f, "{file}:{line}:{column}"),
            Self::Override { text } => {
                write!(f, "override `{}`", crate::quantity::shorten(text))
            }
            Self::Whole { file } => f.write_str(file),
            Self::Unknown => f.write_str("default value"),
        }
    }
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The text is not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// The parser's words.
        message: String,
    },
    /// The bytes are not UTF-8 text.
    #[error("byte {offset} is not UTF-8 text; save the file as plain text in UTF-8")]
    NotText {
        /// Offset of the first bad byte.
        offset: usize,
    },
    /// The file is far larger than such a file.
    #[error("the file has {size} bytes, at most {limit} are read; is it a record?")]
    TooLarge {
        /// Size in bytes.
        size: usize,
        /// Limit in bytes.
        limit: usize,
    },
    /// The file cannot be read.
    #[error("cannot read the file: {reason}; correct the path")]
    Unreadable {
        /// The system's words.
        reason: String,
    },
    /// A key that no field has.
    #[error("unknown key `{key}` in {section}{}", suggestion(nearest.as_deref()))]
    UnknownKey {
        /// The key.
        key: String,
        /// Where it stands.
        section: String,
        /// The valid key that looks most like it.
        nearest: Option<String>,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A field of another variant.
    #[error("`{key}` does not belong to `{tag} = \"{variant}\"` in {section}, only to {owners}")]
    ForeignKey {
        /// The key.
        key: String,
        /// Where it stands.
        section: String,
        /// The field that chooses the variant.
        tag: String,
        /// The variant chosen.
        variant: String,
        /// The variants that have the field.
        owners: String,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A field that must be given.
    #[error("`{field}` is missing from {section}; add {example}")]
    Missing {
        /// The field.
        field: String,
        /// Where it belongs.
        section: String,
        /// What to add.
        example: String,
    },
    /// A value of another type.
    #[error("`{field}` must be {expected}, found {found}")]
    WrongType {
        /// The field.
        field: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A number where a quantity is needed.
    #[error("`{field}` needs a unit, found {found}; write for example {example}")]
    BareNumber {
        /// The field.
        field: String,
        /// What was found.
        found: String,
        /// The field with a unit.
        example: String,
    },
    /// A text that is not the quantity needed.
    #[error("`{field}`: {reason}; write for example {example}")]
    Quantity {
        /// The field.
        field: String,
        /// Why.
        reason: QuantityError,
        /// A good value.
        example: String,
    },
    /// A number outside its range.
    #[error("`{field}` must be {range}, found {found}")]
    OutOfRange {
        /// The field.
        field: String,
        /// The range.
        range: String,
        /// The value.
        found: String,
    },
    /// A name that is not in the list.
    #[error("`{field}`: there is no \"{found}\"{}", suggestion(nearest.as_deref()))]
    UnknownName {
        /// The field.
        field: String,
        /// The name.
        found: String,
        /// The valid name that looks most like it.
        nearest: Option<String>,
        /// All valid names.
        valid: Vec<String>,
    },
    /// Two fields that exclude each other.
    #[error("{section} has both `{first}` and `{second}`; keep one")]
    Exclusive {
        /// Where they stand.
        section: String,
        /// The first.
        first: String,
        /// The second.
        second: String,
    },
    /// None of several fields.
    #[error("{section} needs one of {choices}")]
    OneOf {
        /// Where it belongs.
        section: String,
        /// The choices.
        choices: String,
    },
    /// Values that are fine alone and wrong together.
    #[error("{message}")]
    Inconsistent {
        /// The sentence.
        message: String,
    },
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

impl Problem {
    /// The list of valid names, when that helps.
    fn help(&self) -> Option<String> {
        if let Self::UnknownKey { valid, .. }
        | Self::ForeignKey { valid, .. }
        | Self::UnknownName { valid, .. } = self
            && !valid.is_empty()
        {
            return Some(format!("valid here: {}", valid.join(", ")));
        }
        let Self::Quantity { reason, .. } = self else { return None };
        if let QuantityError::UnknownUnit { .. } = reason {
            let units: Vec<&str> = crate::unit::names().filter(|unit| *unit != "1").collect();
            return Some(format!(
                "units: {}, and their products, quotients and powers",
                units.join(" ")
            ));
        }
        let QuantityError::WrongDimension { text, found, expected } = reason else { return None };
        let note = |kind: &str, wanted: &str, note: &str| {
            (found.starts_with(kind) && expected.starts_with(wanted)).then(|| note.to_owned())
        };
        if text.ends_with('g') {
            let grams = "`g` is the acceleration of gravity; grams are written `gram`";
            return note("an acceleration", "a mass", grams);
        }
        let weights =
            "a mass is written in `kg`, `lb` or `t`, its weight in `kgf`, `lbf` or `tonf`";
        note("a mass", "a force", weights).or_else(|| note("a force", "a mass", weights))
    }
}

/// Why an input cannot be used: one problem at one place.
///
/// `Display` writes the sentence, the place, the line with a caret under what is wrong, and the
/// valid names when there are any. [`InputError::sentence`] is the same on one line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError(Box<(Problem, Place)>);

impl InputError {
    /// A problem at a place.
    pub fn new(problem: Problem, place: Place) -> Self {
        Self(Box::new((problem, place)))
    }

    /// What is wrong.
    pub fn problem(&self) -> &Problem {
        &self.0.0
    }

    /// Where it is wrong.
    pub fn place(&self) -> &Place {
        &self.0.1
    }

    /// The error on one line: place, then problem.
    pub fn sentence(&self) -> String {
        printable(&format!("{}: {}", self.place(), self.problem()))
    }
}

impl std::error::Error for InputError {}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&printable(&self.problem().to_string()))?;
        let margin = match self.place() {
            Place::File { line, column, width, text, .. } => {
                let number = line.to_string();
                let margin = " ".repeat(number.len());
                let (shown, column, width) = window(text, *column, *width);
                let caret = "^".repeat(width);
                let indent = " ".repeat(column - 1);
                write!(
                    f,
                    "\n{margin}--> {}\n{margin} |\n{number} | {shown}\n{margin} | {indent}{caret}",
                    self.place()
                )?;
                margin
            }
            Place::Override { .. } | Place::Whole { .. } => {
                write!(f, "\n --> {}", printable(&self.place().to_string()))?;
                " ".to_owned()
            }
            Place::Unknown => " ".to_owned(),
        };
        if let Some(help) = self.problem().help() {
            write!(f, "\n{margin} = {help}")?;
        }
        Ok(())
    }
}

/// Text that cannot disturb a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// The part of a line around the column that fits a terminal, tabs and controls shown as spaces.
fn window(line: &str, column: usize, width: usize) -> (String, usize, usize) {
    const BEFORE: usize = 60;
    const TOTAL: usize = 100;
    let skip = if column > TOTAL { column - BEFORE } else { 0 };
    let shown: String =
        line.chars().skip(skip).take(TOTAL).map(|c| if c.is_control() { ' ' } else { c }).collect();
    let column = column - skip;
    (shown, column, width.min(TOTAL + 1 - column.min(TOTAL)).max(1))
}
