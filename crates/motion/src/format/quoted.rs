//! What stands in a file, as text of messages.

/// Bytes as text, one character each.
pub(crate) fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| char::from(byte)).collect()
}

/// At most 40 characters of a text, for messages.
pub(crate) fn shorten(text: &str) -> String {
    if text.chars().count() <= 40 {
        text.to_owned()
    } else {
        text.chars().take(37).chain("...".chars()).collect()
    }
}

/// As [`shorten`], between quotation marks.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", shorten(text))
}
