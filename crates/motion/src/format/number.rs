//! Parses printed numbers.

use super::quoted::latin1;

/// A number with the resolution of its printed digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Printed {
    pub(crate) value: f64,
    pub(crate) resolution: f64,
}

/// Parses a finite decimal number, optionally with the Fortran exponent letter `D`; rejects
/// anything else.
pub(crate) fn parse_number(field: &[u8]) -> Option<f64> {
    let field = field.trim_ascii();
    // Reject words that the standard parser accepts: inf, nan, infinity.
    let mut fortran = false;
    for &byte in field {
        match byte {
            b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E' => {}
            b'd' | b'D' => fortran = true,
            _ => return None,
        }
    }
    let text = std::str::from_utf8(field).ok()?;
    let value: f64 =
        if fortran { text.replace(['d', 'D'], "E").parse().ok()? } else { text.parse().ok()? };
    value.is_finite().then_some(value)
}

/// Splits touching numbers such as `-.123E-02-.456E-02` at signs that do not follow an exponent
/// letter.
pub(super) fn split_touching(token: &[u8]) -> Option<Vec<(usize, f64)>> {
    let mut pieces = Vec::new();
    let mut start = 0;
    for at in 1..=token.len() {
        let boundary = at == token.len()
            || (matches!(token[at], b'+' | b'-')
                && (token[at - 1].is_ascii_digit() || token[at - 1] == b'.'));
        if boundary {
            // A piece without a decimal point is not a Fortran real, so its end would be a guess.
            let piece = &token[start..at];
            if !piece.contains(&b'.') {
                return None;
            }
            pieces.push((start, parse_number(piece)?));
            start = at;
        }
    }
    Some(pieces)
}

/// Returns the number at the start of `bytes`, after blanks, `=` and `:`.
pub(crate) fn leading_number(bytes: &[u8]) -> Option<f64> {
    leading_text(bytes).map(|(value, _)| value)
}

/// Returns the [`leading_number`] together with its text.
pub(crate) fn leading_text(bytes: &[u8]) -> Option<(f64, String)> {
    let skip = bytes.iter().position(|&b| !matches!(b, b' ' | b'\t' | b'=' | b':'))?;
    let rest = &bytes[skip..];
    let mut end = 0;
    while end < rest.len() {
        let byte = rest[end];
        let sign_ok = end == 0 || matches!(rest[end - 1], b'e' | b'E' | b'd' | b'D');
        let exponent_ok = end > 0
            && rest.get(end + 1).is_some_and(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-'));
        match byte {
            b'0'..=b'9' | b'.' => {}
            b'+' | b'-' if sign_ok => {}
            b'e' | b'E' | b'd' | b'D' if exponent_ok => {}
            _ => break,
        }
        end += 1;
    }
    let value = parse_number(&rest[..end])?;
    Some((value, latin1(&rest[..end])))
}

/// Returns the [`leading_number`] together with the resolution of its printed digits.
pub(crate) fn leading_printed(bytes: &[u8]) -> Option<Printed> {
    leading_text(bytes).map(|(value, text)| Printed { value, resolution: resolution(&text) })
}

/// Returns one unit of the last digit of a printed number.
pub(crate) fn resolution(text: &str) -> f64 {
    let lower = text.to_ascii_lowercase().replace('d', "e");
    let (mantissa, exponent) = lower.split_once('e').unwrap_or((&lower, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let power = exponent.saturating_sub(i32::try_from(decimals).unwrap_or(0)).clamp(-300, 300);
    crate::math::powf(10.0, f64::from(power))
}

/// Returns `true` if a string is a placeholder that programs print instead of a number, such as
/// `NaN`, `null` or `#N/A`.
pub(super) fn is_no_number(text: &str) -> bool {
    let lower = text.trim_matches(['+', '-', '"']).to_ascii_lowercase();
    let printed =
        ["nan", "inf", "infinity", "null", "none", "na", "n/a", "1.#inf", "1.#ind", "1.#qnan"];
    // Spreadsheets write "#DIV/0!" and "#N/A", also in other languages.
    printed.contains(&lower.as_str())
        || lower.starts_with('#') && lower.ends_with(['!', '?', 'a', 'v'])
}
