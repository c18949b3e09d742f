//! Errors of input files: problem, place and remedy.

use std::fmt;

use crate::quantity::QuantityError;

/// The place of an error in the input.
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
        /// Length in characters of the faulty text on that line.
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
    /// In no text of the user, but in a default.
    Unknown,
}

impl Place {
    /// Returns the place of a byte range of a text.
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

/// Writes the short form: `file:line:column`, or the override.
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

/// The kind of an input error.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The text is not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// Message of the parser.
        message: String,
    },
    /// The bytes are not UTF-8 text.
    #[error("byte {offset} is not UTF-8 text; save the file as plain text in UTF-8")]
    NotText {
        /// Offset of the first bad byte.
        offset: usize,
    },
    /// The file is far larger than any valid one.
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
        /// Message of the system.
        reason: String,
    },
    /// An unknown key.
    #[error("unknown key `{key}` in {section}{}", suggestion(nearest.as_deref()))]
    UnknownKey {
        /// The key.
        key: String,
        /// Table that contains it.
        section: String,
        /// The most similar valid key.
        nearest: Option<String>,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A field of another variant.
    #[error("`{key}` does not belong to `{tag} = \"{variant}\"` in {section}, only to {owners}")]
    ForeignKey {
        /// The key.
        key: String,
        /// Table that contains it.
        section: String,
        /// The field that selects the variant.
        tag: String,
        /// The variant selected.
        variant: String,
        /// The variants that have the field.
        owners: String,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A required field is missing.
    #[error("`{field}` is missing from {section}; add {example}")]
    Missing {
        /// The field.
        field: String,
        /// Table that needs it.
        section: String,
        /// Text to add.
        example: String,
    },
    /// A value of the wrong type.
    #[error("`{field}` must be {expected}, found {found}")]
    WrongType {
        /// The field.
        field: String,
        /// Expected type.
        expected: String,
        /// Value found.
        found: String,
    },
    /// A number where a quantity is needed.
    #[error("`{field}` needs a unit, found {found}; write for example {example}")]
    BareNumber {
        /// The field.
        field: String,
        /// Value found.
        found: String,
        /// The field with a valid value.
        example: String,
    },
    /// A text that is not the quantity required.
    #[error("`{field}`: {reason}; write for example {example}")]
    Quantity {
        /// The field.
        field: String,
        /// Reason.
        reason: QuantityError,
        /// A valid value.
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
    /// An unknown name.
    #[error("`{field}`: there is no \"{found}\"{}", suggestion(nearest.as_deref()))]
    UnknownName {
        /// The field.
        field: String,
        /// The name.
        found: String,
        /// The most similar valid name.
        nearest: Option<String>,
        /// All valid names.
        valid: Vec<String>,
    },
    /// Two fields that exclude each other.
    #[error("{section} has both `{first}` and `{second}`; keep one")]
    Exclusive {
        /// Table that contains them.
        section: String,
        /// The first.
        first: String,
        /// The second.
        second: String,
    },
    /// None of several fields.
    #[error("{section} needs one of {choices}")]
    OneOf {
        /// Table that needs one.
        section: String,
        /// The choices.
        choices: String,
    },
    /// Values that are valid by themselves and inconsistent together.
    #[error("{message}")]
    Inconsistent {
        /// Message.
        message: String,
    },
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

impl Problem {
    /// Returns the list of valid names or units, if that helps.
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

/// An error in an input: a problem at a place.
///
/// `Display` writes the problem, the place, the line with a caret below the fault, and the
/// valid names if there are any. [`InputError::sentence`] is the same on one line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError(Box<(Problem, Place)>);

impl InputError {
    /// Creates an error of a problem at a place.
    pub fn new(problem: Problem, place: Place) -> Self {
        Self(Box::new((problem, place)))
    }

    /// Returns the problem.
    pub fn problem(&self) -> &Problem {
        &self.0.0
    }

    /// Returns the place.
    pub fn place(&self) -> &Place {
        &self.0.1
    }

    /// Returns the error on one line: place, then problem.
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

/// Replaces control characters, which could disturb a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// Returns the part of a line around the column that fits a terminal, with control characters as spaces.
fn window(line: &str, column: usize, width: usize) -> (String, usize, usize) {
    const BEFORE: usize = 60;
    const TOTAL: usize = 100;
    let skip = if column > TOTAL { column - BEFORE } else { 0 };
    let shown: String =
        line.chars().skip(skip).take(TOTAL).map(|c| if c.is_control() { ' ' } else { c }).collect();
    let column = column - skip;
    (shown, column, width.min(TOTAL + 1 - column.min(TOTAL)).max(1))
}
