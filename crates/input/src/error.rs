//! Errors in input files: the problem, its place and a remedy.

use std::fmt;

use crate::quantity::QuantityError;

/// The place of an error in the input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A position in a file.
    File {
        /// Name of the file as given.
        file: String,
        /// Line number, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// Number of characters of the faulty text on this line.
        width: usize,
        /// Content of the line.
        text: String,
    },
    /// An override, written `path=value`.
    Override {
        /// Text of the override.
        text: String,
    },
    /// A file as a whole.
    Whole {
        /// Name of the file as given.
        file: String,
    },
    /// No place: the value is a default, which appears nowhere in the input.
    Unknown,
}

impl Place {
    /// Returns the place of a byte range in the text of a file.
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

/// Writes the place in short form: `file:line:column`, the override, or the name of the file.
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
    #[error("this is not valid TOML: {message}")]
    Syntax {
        /// Error message from the parser.
        message: String,
    },
    /// The bytes are not UTF-8 text.
    #[error("byte {offset} is not UTF-8 text; save the file as plain text in UTF-8")]
    NotText {
        /// Offset of the first invalid byte.
        offset: usize,
    },
    /// The file is far larger than any valid file.
    #[error(
        "the file has {size} bytes, but at most {limit} bytes are read; if it is a motion record, name it in \
         motion.record of a scenario"
    )]
    TooLarge {
        /// Size in bytes.
        size: usize,
        /// Limit in bytes.
        limit: usize,
    },
    /// The file cannot be read.
    #[error("cannot read the file: {reason}; correct the path")]
    Unreadable {
        /// Reason, in plain words.
        reason: String,
    },
    /// A key that the table does not have.
    #[error("unknown key `{key}` in {section}{}", suggestion(nearest.as_deref()))]
    UnknownKey {
        /// The unknown key.
        key: String,
        /// Label of the table that contains the key, such as `[run]`.
        section: String,
        /// The most similar valid key; `None` if no valid key is similar enough.
        nearest: Option<String>,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A key that belongs to a variant other than the selected one.
    #[error(
        "`{key}` does not belong to `{tag} = \"{variant}\"` in {section}, only to {owners}; leave it out, \
         or set `{tag}` to {owners}"
    )]
    ForeignKey {
        /// The key.
        key: String,
        /// Label of the table that contains the key, such as `[run]`.
        section: String,
        /// Name of the tag field.
        tag: String,
        /// Name of the selected variant.
        variant: String,
        /// Names of the variants that have this field, in quotation marks and joined by "or".
        owners: String,
        /// All valid keys.
        valid: Vec<String>,
    },
    /// A required field is missing.
    #[error("`{field}` is missing from {section}; {}", addition(example))]
    Missing {
        /// Key of the field.
        field: String,
        /// Label of the table that lacks the field, such as `[run]`.
        section: String,
        /// The field with a valid value, as it would be written in the file.
        example: String,
    },
    /// A value of the wrong type.
    #[error("`{field}` must be {expected}, found {found}")]
    WrongType {
        /// Dotted path of the field, such as `run.step`.
        field: String,
        /// Expected type.
        expected: String,
        /// Value found.
        found: String,
    },
    /// A number without a unit, where a quantity is required.
    #[error("`{field}` needs a unit, found {found}; write for example {example}")]
    BareNumber {
        /// Dotted path of the field, such as `run.step`.
        field: String,
        /// Value found.
        found: String,
        /// Suggested replacement: the same number with the SI unit.
        example: String,
    },
    /// A string that is not a quantity of the required dimension.
    #[error("`{field}`: {reason}{}", correction(reason, example))]
    Quantity {
        /// Dotted path of the field, such as `run.step`.
        field: String,
        /// The reason why the text is rejected.
        reason: QuantityError,
        /// A valid value.
        example: String,
    },
    /// A number outside its range.
    #[error("`{field}` must be {range}, found {found}")]
    OutOfRange {
        /// Dotted path of the field, such as `run.step`.
        field: String,
        /// The permitted range, in words.
        range: String,
        /// Value found.
        found: String,
    },
    /// A name that is not in the list of valid names.
    #[error("`{field}`: there is no \"{found}\"{}", suggestion(nearest.as_deref()))]
    UnknownName {
        /// Dotted path of the field, such as `run.step`.
        field: String,
        /// Name found.
        found: String,
        /// The most similar valid name; `None` if no valid name is similar enough.
        nearest: Option<String>,
        /// All valid names.
        valid: Vec<String>,
    },
    /// Two mutually exclusive fields are given.
    #[error("{section} has both `{first}` and `{second}`; keep one")]
    Exclusive {
        /// Label of the table that contains the fields, such as `[run]`.
        section: String,
        /// Name of the first field.
        first: String,
        /// Name of the second field.
        second: String,
    },
    /// None of several alternative fields is given.
    #[error("{section} needs one of {choices}")]
    OneOf {
        /// Label of the table that lacks the field, such as `[run]`.
        section: String,
        /// The alternatives, each with an example of its value, joined by commas.
        choices: String,
    },
    /// Values that are valid by themselves but inconsistent with each other.
    #[error("{message}")]
    Inconsistent {
        /// Description of the inconsistency.
        message: String,
    },
}

/// Returns the advice to add a field; `example` shows the field with a valid value.
fn addition(example: &str) -> String {
    if example.starts_with('`') {
        format!("add it, for example {example}")
    } else {
        format!("add {example}")
    }
}

/// Returns the advice on a quantity; empty if the reason contains advice.
fn correction(reason: &QuantityError, example: &str) -> String {
    if let QuantityError::Malformed { reason, .. } = reason
        && reason.contains("write `")
    {
        return String::new();
    }
    format!("; write for example {example}")
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

impl Problem {
    /// Returns a note for the user: the valid names, the valid units, or a hint about units that are easily
    /// confused. Returns `None` if there is no such note for the problem.
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

/// An input error: a problem and its place.
///
/// `Display` writes the problem, the place, the line with a caret below the fault, and the valid
/// names, if there are any. [`InputError::sentence`] returns a one-line form without the line and
/// the names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError(Box<(Problem, Place)>);

impl InputError {
    /// Creates an error from a problem and its place.
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

    /// Returns the error on one line: the place, then the problem.
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

/// Shortens a line for a terminal to a part of at most 100 characters that contains `column`. Returns this part, then
/// the column and the width of the fault within the part. Control characters are replaced by spaces.
fn window(line: &str, column: usize, width: usize) -> (String, usize, usize) {
    const BEFORE: usize = 60;
    const TOTAL: usize = 100;
    let skip = if column > TOTAL { column - BEFORE } else { 0 };
    let shown: String =
        line.chars().skip(skip).take(TOTAL).map(|c| if c.is_control() { ' ' } else { c }).collect();
    let column = column - skip;
    (shown, column, width.min(TOTAL + 1 - column.min(TOTAL)).max(1))
}
