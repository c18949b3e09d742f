//! Numbers as text: significant digits for readers, full precision for machine-readable files.

/// Text that is shown in place of a number that is missing, NaN or infinite.
pub const MISSING: &str = "–";

/// Formats `value` with `digits` significant digits (at least one, at most 15).
///
/// Numbers from 10⁻⁴ to below 10⁶ are written without an exponent, others as a mantissa and a power
/// of ten. The minus sign is U+2212. A number that is not finite gives "–".
///
/// ```
/// use barrelstack_columns::significant;
/// assert_eq!(significant(0.353_91, 3), "0.354");
/// assert_eq!(significant(-1234.6, 3), "−1230");
/// assert_eq!(significant(2.5e-7, 2), "2.5×10⁻⁷");
/// assert_eq!(significant(f64::NAN, 3), "–");
/// ```
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return MISSING.into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let digits = digits.clamp(1, 15);
    // Rust's exponent format rounds correctly: 9.996 becomes 1.00e1 and not 10.00.
    let scientific = format!("{:.*e}", digits - 1, value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i64 = exponent.parse().unwrap_or(0);
    let sign = if value < 0.0 { "−" } else { "" };
    if (-4..6).contains(&exponent) {
        let rounded: f64 = scientific.parse().unwrap_or(value.abs());
        let decimals = i64::try_from(digits)
            .ok()
            .and_then(|digits| usize::try_from(digits - 1 - exponent).ok())
            .unwrap_or(0);
        format!("{sign}{rounded:.decimals$}")
    } else {
        format!("{sign}{mantissa}×10{}", superscript(exponent))
    }
}

/// Formats `value` with three significant digits and at most `decimals` decimals, so that no
/// meaningless digit is shown.
///
/// If a value other than zero rounds to zero, a bound is shown instead: `<` and one unit of the last decimal, or `>`
/// and minus one unit for a negative value.
///
/// ```
/// use barrelstack_columns::measured;
/// assert_eq!(measured(20.34, 1), "20.3");
/// assert_eq!(measured(642.3, 1), "642");
/// assert_eq!(measured(0.003_62, 1), "< 0.1");
/// assert_eq!(measured(-0.003_62, 1), "> −0.1");
/// assert_eq!(measured(0.0, 1), "0");
/// ```
pub fn measured(value: f64, decimals: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return significant(value, 3);
    }
    let coarse = fixed(value, decimals);
    if coarse.bytes().all(|b| b == b'0' || b == b'.') {
        let last = format!("0.{:0>decimals$}", 1);
        let last = if decimals == 0 { "1" } else { &last };
        return if value > 0.0 { format!("< {last}") } else { format!("> −{last}") };
    }
    let fine = significant(value, 3);
    if fine.chars().count() < coarse.chars().count() { fine } else { coarse }
}

/// Formats `value` with a fixed number of decimals. The minus sign is U+2212. Returns "–" if `value` is
/// not finite.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return MISSING.into();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.into(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// Formats a number for a CSV cell, as the shortest text that reads back to the same bits; empty if
/// the number is not finite.
pub fn csv_number(value: f64) -> String {
    if value.is_finite() { shortest(value) } else { String::new() }
}

/// Returns the shortest decimal text that reads back to the same bits.
pub fn shortest(value: f64) -> String {
    let plain = format!("{value}");
    // Within these bounds the exponent form is never shorter.
    if (1e-2..1e3).contains(&value.abs()) || value == 0.0 {
        return plain;
    }
    let exponent = format!("{value:e}");
    if exponent.len() < plain.len() { exponent } else { plain }
}

/// Units that [`tied`] keeps on the line of the number before them, alone or as the first part of a compound unit such
/// as `cm/s`.
const UNITS: [&str; 30] = [
    "%", "m", "cm", "mm", "µm", "nm", "km", "in", "ft", "s", "ms", "µs", "min", "h", "g", "kg",
    "t", "N", "kN", "MN", "Pa", "kPa", "MPa", "J", "kJ", "Hz", "deg", "rad", "L", "1",
];

/// Returns `text` with no-break spaces between numbers and their units, so that no line break
/// separates them.
pub fn tied(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 8);
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let tie = c == ' ' && before.is_ascii_digit() && begins_with_unit(&text[at + 1..]);
        out.push(if tie { '\u{a0}' } else { c });
        before = c;
    }
    out
}

fn begins_with_unit(text: &str) -> bool {
    let end = text.find(|c: char| c.is_whitespace() || ".,;:)!?".contains(c)).unwrap_or(text.len());
    let word = &text[..end];
    match word.split_once('/') {
        Some((first, _)) => UNITS.contains(&first),
        // A lone 1 is not a unit; it only begins one, as in `1/s`.
        None => word != "1" && UNITS.contains(&word),
    }
}

/// Writes an integer in superscript digits, such as ⁻⁷.
pub fn superscript(exponent: i64) -> String {
    let raised = |c: char| {
        let digit = c.to_digit(10).and_then(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize));
        digit.unwrap_or('⁻')
    };
    exponent.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_text_reads_back_to_the_same_bits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (0.5, "0.5"),
            (0.001, "1e-3"),
            (1e-9, "1e-9"),
            (1e22, "1e22"),
            (-1234.5, "-1234.5"),
            (5e-324, "5e-324"),
            (100.0, "100"),
            (1e3, "1e3"),
            (0.00123, "0.00123"),
        ] {
            assert_eq!(shortest(value), text);
        }
        let mut value = 1.1e-300_f64;
        while value < 1e300 {
            let text = shortest(value);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            let [plain, exponent] = [format!("{value}"), format!("{value:e}")];
            assert!(text.len() <= plain.len().min(exponent.len()), "{text} {plain} {exponent}");
            value *= 7.3;
        }
    }

    #[test]
    fn rounding_carries_into_the_next_power_of_ten() {
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(999_999.0, 3), "1.00×10⁶");
        assert_eq!(significant(0.000_099_999, 2), "0.00010");
    }

    #[test]
    fn a_small_negative_number_does_not_become_minus_zero() {
        assert_eq!(fixed(-0.000_4, 2), "0.00");
        assert_eq!(fixed(-0.4, 1), "−0.4");
    }

    #[test]
    fn a_number_keeps_its_unit_and_other_words_may_go() {
        assert_eq!(tied("after 6.1 s, 47 cm/s"), "after 6.1\u{a0}s, 47\u{a0}cm/s");
        assert_eq!(tied("p = 2 1/s; 5 % (0.3 m)."), "p = 2\u{a0}1/s; 5\u{a0}% (0.3\u{a0}m).");
        assert_eq!(tied("8 barrels fall, 1 of 2 1 m"), "8 barrels fall, 1 of 2 1\u{a0}m");
        assert_eq!(tied("levels 2 to 4 m"), "levels 2 to 4\u{a0}m");
        assert_eq!(tied(""), "");
    }
}
