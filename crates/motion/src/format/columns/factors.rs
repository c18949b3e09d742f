//! Detects scale factors in header lines. A file with a scale factor is refused, because it is
//! unknown whether the factor has been applied.

use super::facts::{folded, says_acceleration, value_behind};
use super::words::UNIT_WORDS;
use crate::error::ReadError;
use crate::format::source::{Source, leading_text, quoted};
use crate::units::MotionUnit;

/// Keywords for a factor by which the values are to be multiplied.
const FACTOR_KEYS: &[&str] = &[
    "scale factor",
    "scale_factor",
    "scalefactor",
    "scaling factor",
    "scale",
    "multiplier",
    "multiply by",
    "multiplication factor",
    "conversion factor",
    "calibration factor",
    "gain",
];

/// Keywords that mean a factor only at the beginning of a line; elsewhere, they may refer to an
/// instrument.
const AT_THE_BEGIN: [&str; 2] = ["scale", "gain"];

/// Refuses a factor stated above the values, such as `1.0e+03 *` (as MATLAB prints matrices),
/// `scale factor: 0.01`, or a unit with a number, such as `unit = 0.01 m/s2`.
pub(super) fn refuse(
    source: &Source<'_>,
    lines: impl Iterator<Item = usize>,
) -> Result<(), ReadError> {
    for line in lines {
        let lower = folded(source.raw(line));
        let matlab =
            lower.strip_suffix('*').is_some_and(|number| number.trim().parse::<f64>().is_ok());
        let plain = lower.trim_start_matches(['#', '%', '!', '/', ' ']);
        let of = |key: &&str| {
            value_behind(plain, key)
                .filter(|_| !AT_THE_BEGIN.contains(key) || plain.starts_with(key))
        };
        let factor = FACTOR_KEYS.iter().find_map(of).map(|value| value.printed.value);
        let in_unit = UNIT_WORDS.iter().find_map(|word| lower.split_once(word));
        if matlab
            || factor.is_some_and(|factor| factor != 1.0)
            || in_unit.is_some_and(|(_, behind)| is_unit_with_factor(behind))
            || is_multiplied(&lower)
        {
            return Err(source.damaged(
                line,
                "values that need not be multiplied by a factor",
                format!("{}, a factor of all values below", quoted(&source.text(line))),
                "multiply the values by the factor, unless they already contain the factor, and remove the factor",
            ));
        }
    }
    Ok(())
}

/// Returns `true` if a line about accelerations or their unit contains a factor, such as
/// `acc*100 (g)`, `acceleration x 1000`, `Acc. (1e-3 g)` or `in g, multiplied by 1000`.
fn is_multiplied(lower: &str) -> bool {
    let speaks = says_acceleration(lower) || UNIT_WORDS.iter().any(|word| lower.contains(word));
    let marks = ["*", " x ", " \u{d7} ", "multiplied by ", "scaled by ", "divided by ", " times "];
    let in_parentheses = || lower.split(['(', '[']).skip(1).any(is_unit_with_factor);
    speaks && (in_parentheses() || marks.into_iter().any(|mark| has_factor(lower, mark)))
}

/// Returns `true` if the text contains `mark`, followed by a number other than 1 and not preceded
/// by a number.
pub(super) fn has_factor(text: &str, mark: &str) -> bool {
    text.match_indices(mark).any(|(at, _)| {
        let of_a_number = text[..at].trim_end().ends_with(|c: char| c.is_ascii_digit() || c == '*');
        let number = leading_text(text[at + mark.len()..].trim_start().as_bytes());
        !of_a_number && number.is_some_and(|(factor, _)| factor != 1.0)
    })
}

/// Returns `true` if a unit is combined with a factor other than 1, such as `0.01 m/s2`, `10^-3 g`,
/// `% g`, `g x 100` or `m/s2*0.01`.
pub(super) fn is_unit_with_factor(text: &str) -> bool {
    let lower = text.to_lowercase();
    let text = lower.trim_start_matches(['s', ' ', '\t', ':', '=', ',', ';', '(', '[']);
    let text = text.strip_prefix("of ").unwrap_or(text);
    let text = text.split([')', ']', ',', ';']).next().unwrap_or("").trim();
    let times = [' ', '*', 'x', '\u{d7}', '\t'];
    let is_unit = |text: &str| MotionUnit::parse(text).is_some();
    !is_unit(text)
        && text.char_indices().any(|(at, _)| {
            let (left, right) = (text[..at].trim(), text[at..].trim_matches([' ', '\t', '(']));
            let before = is_factor(left.trim_end_matches(times)) && is_unit(right);
            let by = right.starts_with(['*', 'x', '\u{d7}', '/']) && !right.starts_with("**");
            let factor = right.trim_start_matches(times).trim_start_matches('/');
            before || by && is_unit(left) && is_factor(factor)
        })
}

/// Returns `true` if a text is a number other than 1, a quotient or power such as `1/10` or `10^-3`,
/// or a word for a fraction, such as `%` or `tenths`.
fn is_factor(text: &str) -> bool {
    let text = text.strip_suffix(" of").unwrap_or(text);
    let number = |text: &str| text.parse::<f64>().ok();
    let value = match text.split_once(['/', '^']) {
        Some((base, rest)) => number(base).zip(number(rest)).map(|_| f64::NAN),
        None => number(text),
    };
    value.is_some_and(|value| value != 1.0)
        || ["%", "percent", "tenths", "hundredths", "thousandths"].contains(&text)
}
