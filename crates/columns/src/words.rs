//! Text helpers: capitalization, lists of words, names with units, and CSV fields.

/// Capitalizes the first letter of `words`.
///
/// ```
/// assert_eq!(barrelstack_columns::capital("it stands"), "It stands");
/// ```
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Joins words into a list, such as "a, b and c".
pub fn listed(words: impl IntoIterator<Item = impl Into<String>>) -> String {
    let mut words: Vec<String> = words.into_iter().map(Into::into).collect();
    match (words.pop(), words.len()) {
        (None, _) => String::new(),
        (Some(last), 0) => last,
        (Some(last), _) => format!("{} and {last}", words.join(", ")),
    }
}

/// Appends the unit, if there is one, to a name: `pga (m/s2)`.
pub fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") }
}

/// Escapes a CSV field, quoting it where necessary.
///
/// Spreadsheets evaluate fields that begin with `=`, `+`, `-` or `@`. Unless such a field is a
/// number, it is given a leading apostrophe, which marks it as text.
///
/// ```
/// use barrelstack_columns::csv_field;
///
/// assert_eq!(csv_field("=HYPERLINK(1)"), "'=HYPERLINK(1)");
/// assert_eq!(csv_field("-0.5"), "-0.5");
/// assert_eq!(csv_field("rack, left"), "\"rack, left\"");
/// ```
pub fn csv_field(text: &str) -> String {
    let begins = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if begins && text.len() > 1 && text.parse::<f64>().is_err() {
        return csv_field(&format!("'{text}"));
    }
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}

/// Joins the words of a text into one line, separated by single spaces.
pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
