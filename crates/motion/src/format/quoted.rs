//! Formats the content of files for messages.

/// Decodes bytes as Latin-1 text, one character per byte.
pub(crate) fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| char::from(byte)).collect()
}

/// Decodes bytes as UTF-8 text, for messages.
pub(crate) fn utf8(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.trim_ascii()).into_owned()
}

/// Truncates a string to 40 characters, for messages.
pub(crate) fn shorten(text: &str) -> String {
    if text.chars().count() <= 40 {
        text.to_owned()
    } else {
        text.chars().take(37).chain("...".chars()).collect()
    }
}

/// Truncates a string as [`shorten`] does, and encloses it in quotation marks.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", shorten(text))
}

/// Describes a binary file by its first four bytes; returns `None` for a text file.
///
/// A file is considered binary if more than 5 % of its first 512 bytes are control characters other than white space.
/// A text file may therefore contain a stray byte.
pub(crate) fn binary(bytes: &[u8]) -> Option<String> {
    let head = bytes.get(..512).unwrap_or(bytes);
    let odd = head.iter().filter(|&&b| b < 0x09 || (0x0E..0x20).contains(&b)).count();
    let first: Vec<String> = head.iter().take(4).map(|b| format!("{b:02X}")).collect();
    (20 * odd > head.len())
        .then(|| format!("a binary file of an unknown format that begins with {}", first.join(" ")))
}
