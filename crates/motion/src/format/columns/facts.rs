//! Finds facts stated in header lines: time step, number of samples, duration, unit, peak and
//! component.

use super::factors;
use super::times::LARGEST_BARE_STEP;
use super::words::{
    ACCELERATIONS, BARE, BESIDE_STEPS, COMPONENT_KEYS, COUNT_KEYS, DISPLACEMENTS, DURATION_KEYS,
    OTHER_FREQUENCIES, OTHER_MEANING, PEAK_KEYS, RATE_KEYS, RATE_MARKS, SAMPLING_KEYS, STEP_KEYS,
    UNIT_WORDS, VELOCITIES,
};
use crate::direction::Direction;
use crate::error::ReadError;
use crate::format::source::{Source, latin1, leading_printed, leading_text, quoted};
use crate::record::Quantity;
use crate::units::MotionUnit;

/// A value stated in a header, with its line (counted from 0).
#[derive(Clone, Copy, Debug)]
pub(super) struct Stated<T> {
    pub(super) line: usize,
    pub(super) value: T,
}

/// A peak acceleration stated in a header.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peak {
    pub(super) value: f64,
    pub(super) resolution: f64,
    /// Factor that converts the peak to SI units; `None` if the peak is in the unit of the samples.
    pub(super) factor: Option<f64>,
}

/// Facts stated in the header lines above a table.
#[derive(Debug, Default)]
pub(super) struct Facts {
    /// Time between samples (s).
    pub(super) step: Option<Stated<f64>>,
    /// A stated frequency (Hz) that may be the sampling rate, although the header does not name it
    /// as such.
    pub(super) possible_rate: Option<Stated<f64>>,
    /// Number of samples.
    pub(super) count: Option<Stated<usize>>,
    /// Duration of the record (s) and its resolution (s): one unit in the last printed digit.
    pub(super) duration: Option<Stated<[f64; 2]>>,
    /// Unit of the samples.
    pub(super) unit: Option<Stated<MotionUnit>>,
    /// Word that the header states as the unit although it is not a unit of motion.
    pub(super) unknown_unit: Option<Stated<String>>,
    pub(super) peak: Option<Stated<Peak>>,
    /// Name of the component, if the header states a name that is a direction.
    pub(super) component: Option<String>,
}

/// Largest time step (s) that is accepted from a line that does not name the quantity.
const LARGEST_UNNAMED_STEP: f64 = 0.1;
/// Smallest sampling rate (Hz) that is accepted from a line that does not name the quantity.
const SMALLEST_UNNAMED_RATE: f64 = 20.0;

impl Facts {
    /// Finds facts in header lines, except in lines of column names.
    ///
    /// # Errors
    /// If two lines state different time steps, or a line states a scale factor.
    pub(super) fn read(
        source: &Source<'_>,
        lines: impl Iterator<Item = usize> + Clone,
    ) -> Result<Self, ReadError> {
        factors::refuse(source, lines.clone())?;
        let mut facts = Self::default();
        let mut unnamed: Vec<Stated<f64>> = Vec::new();
        for line in lines {
            let text = source.text(line);
            let lower = folded(source.raw(line));
            unnamed.extend(unnamed_step(&lower).map(|value| Stated { line, value }));
            if let Some(step) = step(&lower) {
                match facts.step {
                    Some(first) if (first.value / step - 1.0).abs() > 1e-3 => {
                        return Err(source.damaged(
                            line,
                            format!(
                                "a step of {} s, as stated on line {}",
                                first.value,
                                first.line + 1
                            ),
                            format!("{step} s"),
                            "keep only the correct step in the header",
                        ));
                    }
                    Some(_) => {}
                    None => facts.step = Some(Stated { line, value: step }),
                }
            }
            let stated = possible_rate(&lower).map(|value| Stated { line, value });
            facts.possible_rate = facts.possible_rate.or(stated);
            let stated = count(&lower).map(|value| Stated { line, value });
            facts.count = facts.count.or(stated);
            let stated = duration(&lower).map(|value| Stated { line, value });
            facts.duration = facts.duration.or(stated);
            let stated = unit(&lower).map(|value| Stated { line, value });
            facts.unit = facts.unit.or(stated);
            if facts.unknown_unit.is_none() {
                let stated = unknown_unit(&lower).map(|value| Stated { line, value });
                facts.unknown_unit = stated;
            }
            let stated = peak(&lower).map(|value| Stated { line, value });
            facts.peak = facts.peak.or(stated);
            facts.component = facts.component.take().or_else(|| component(&text));
        }
        let alike = |other: &Stated<f64>| (other.value / unnamed[0].value - 1.0).abs() < 1e-3;
        if facts.step.is_none() && unnamed.iter().all(alike) {
            facts.step = unnamed.first().copied();
        }
        Ok(facts)
    }

    /// Returns the time step (s) computed from the number of samples and the duration. An error
    /// about a missing time step suggests this value.
    pub(super) fn step_by_duration(&self) -> Option<f64> {
        let (count, [duration, _]) = (self.count?.value, self.duration?.value);
        (count > 1).then(|| duration / count as f64)
    }
}

/// Returns the text after a key. The key must be a separate word that is not preceded by a word in
/// [`OTHER_MEANING`], and not followed by `/` or `per`.
fn behind<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    text.match_indices(key).find_map(|(at, _)| {
        let (before, rest) = (&text[..at], &text[at + key.len()..]);
        let joined = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let own = !before.ends_with(joined) && !rest.starts_with(joined);
        let last = before.split_whitespace().last().unwrap_or("");
        let other =
            OTHER_MEANING.contains(&last) || rest.starts_with('/') || rest.starts_with(" per ");
        (own && !other).then_some(rest)
    })
}

/// Text after a key, split into a unit in parentheses, a number, and the rest.
pub(super) struct Value<'a> {
    in_parentheses: Option<&'a str>,
    pub(super) printed: crate::format::Printed,
    behind: &'a str,
}

pub(super) fn value_behind<'a>(text: &'a str, key: &str) -> Option<Value<'a>> {
    let mut rest = behind(text, key)?.trim_start();
    let mut in_parentheses = None;
    if let Some(inner) = rest.strip_prefix(['(', '[']) {
        let (unit, after) = inner.split_once([')', ']'])?;
        (in_parentheses, rest) = (Some(unit.trim()), after);
    }
    let mut rest = rest.trim_start_matches([' ', '\t', '=', ':', ',', ';']);
    for filler in ["of ", "is ", "= "] {
        rest = rest.strip_prefix(filler).unwrap_or(rest).trim_start();
    }
    let rest = rest.trim_start_matches([' ', ':', '=']);
    let (number, at) = number_with_comma(rest);
    let printed = leading_printed(number.as_bytes())?;
    let at = if let Some(at) = at {
        at
    } else {
        let (_, text) = leading_text(rest.as_bytes())?;
        rest.find(&text)? + text.len()
    };
    let behind = rest[at..].trim_start_matches([' ', '(', '[']);
    let word = behind.split([' ', ',', ';', ')', ']', '\t']).next().unwrap_or("");
    Some(Value { in_parentheses, printed, behind: word })
}

/// Interprets the commas of a number at the start of a text: in `0,005`, the comma is a decimal
/// comma; in `3,200`, it is a thousands separator.
///
/// Returns the number with a decimal point and without thousands separators, and the length of the
/// number in the text. If there is no such comma, returns the unchanged text and `None`.
fn number_with_comma(text: &str) -> (String, Option<usize>) {
    let end = text.find(|c: char| !c.is_ascii_digit() && c != ',').unwrap_or(text.len());
    let token = text[..end].trim_end_matches(',');
    let groups: Vec<&str> = token.split(',').collect();
    let plain = || (text.to_owned(), None);
    match groups.as_slice() {
        _ if text[end..].starts_with('.') => plain(),
        ["0", decimals] if !decimals.is_empty() => (format!("0.{decimals}"), Some(token.len())),
        [first, rest @ ..] if !rest.is_empty() => {
            let thousands = (1..=3).contains(&first.len()) && rest.iter().all(|g| g.len() == 3);
            if thousands { (groups.concat(), Some(token.len())) } else { plain() }
        }
        _ => plain(),
    }
}

/// Converts a header line (UTF-8, else Latin-1) to lower case without accents:
/// `Pas d'échantillonnage` gives `pas d'echantillonnage`.
pub(in crate::format) fn folded(raw: &[u8]) -> String {
    let text = std::str::from_utf8(raw).map_or_else(|_| latin1(raw), str::to_owned);
    text.trim().to_lowercase().chars().filter_map(plain_letter).collect()
}

/// Returns a lower-case letter without its accent; `None` for a combining accent.
fn plain_letter(c: char) -> Option<char> {
    Some(match c {
        '\u{e0}'..='\u{e5}' => 'a',
        '\u{e7}' => 'c',
        '\u{e8}'..='\u{eb}' => 'e',
        '\u{ec}'..='\u{ef}' | '\u{131}' => 'i',
        '\u{f1}' => 'n',
        '\u{f2}'..='\u{f6}' => 'o',
        '\u{f9}'..='\u{fc}' => 'u',
        '\u{11f}' => 'g',
        '\u{15f}' => 's',
        '\u{2019}' => '\'',
        '\u{300}'..='\u{36f}' => return None,
        other => other,
    })
}

/// Returns the length (s) of a unit of time; `None` if the text is not such a unit.
pub(super) fn time_factor(text: &str) -> Option<f64> {
    Some(match text.trim().to_lowercase().trim_end_matches(['.', ',']) {
        "s" | "sec" | "secs" | "second" | "seconds" | "seg" | "sn" | "sek" => 1.0,
        "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => 1e-3,
        "ns" | "nanoseconds" => 1e-9,
        "us" | "\u{b5}s" | "usec" | "microsecond" | "microseconds" => 1e-6,
        "min" | "minute" | "minutes" => 60.0,
        _ => return None,
    })
}

fn step(text: &str) -> Option<f64> {
    let positive = |value: f64| (value.is_finite() && value > 0.0).then_some(value);
    let by_step = STEP_KEYS.iter().find_map(|key| {
        let value = value_behind(text, key)?;
        let unit = value.in_parentheses.and_then(time_factor).or_else(|| time_factor(value.behind));
        // "1/200" does not state a step of 1 s.
        let number = match value.behind.strip_prefix('/').and_then(|d| leading_text(d.as_bytes())) {
            Some((divisor, _)) => value.printed.value / divisor,
            None => value.printed.value,
        };
        // "DT=5" without a unit does not state a step in seconds.
        let bare = unit.is_none() && number > LARGEST_BARE_STEP;
        positive(number * unit.unwrap_or(1.0)).filter(|_| !bare)
    });
    let by_rate = || {
        let stated = RATE_KEYS.iter().find_map(|key| {
            let value = value_behind(text, key)?;
            let time =
                value.in_parentheses.and_then(time_factor).or_else(|| time_factor(value.behind));
            let divisor = value.behind.strip_prefix('/').and_then(|d| leading_text(d.as_bytes()));
            let number = value.printed.value;
            // Some headers state the step under the name of the rate.
            let kilo = value.behind.starts_with("khz") || value.in_parentheses == Some("khz");
            match (time, divisor) {
                _ if kilo => Some(1e-3 / number),
                (Some(factor), _) => Some(number * factor),
                (None, Some((divisor, _))) => Some(number / divisor),
                (None, None) if number < 1.0 => Some(number),
                (None, None) => Some(1.0 / number),
            }
        });
        let counted =
            || RATE_MARKS.iter().find_map(|mark| number_before(text, mark)).map(|rate| 1.0 / rate);
        positive(stated.or_else(counted)?)
    };
    by_step.or_else(by_rate)
}

/// Returns the number of samples and the time step (s), if one line states both.
pub(in crate::format) fn count_and_step(text: &str) -> Option<(f64, f64)> {
    Some((count(text)? as f64, step(text)?))
}

/// Returns the time step (s) from a line that does not name this quantity, such as `interval 5 ms`,
/// `Sampling: 200 Hz`, or `200 Hz` alone.
fn unnamed_step(text: &str) -> Option<f64> {
    let size = |value: f64| (value > 0.0 && value <= LARGEST_UNNAMED_STEP).then_some(value);
    let rate = |value: f64| (value >= SMALLEST_UNNAMED_RATE).then_some(1.0 / value);
    let plain = text.trim_start_matches(['#', '%', '!', '/', ' ']);
    let by_key = SAMPLING_KEYS.iter().find_map(|key| {
        let value = value_behind(text, key)?;
        let unit = value.in_parentheses.unwrap_or(value.behind);
        let number = value.printed.value;
        match (time_factor(unit), unit) {
            (Some(factor), _) => size(number * factor),
            (None, "hz" | "sps") => rate(number),
            // At the beginning of a line, a rate is the sampling rate; after other words it may be
            // a data rate or the speed of a drum.
            (None, "") if *key == "rate" && plain.starts_with(key) => rate(number),
            // A bare number may have another meaning; "delta" is also a distance in degrees.
            (None, "") if BARE.contains(key) => rate(number)
                .filter(|_| *key != "delta")
                .or_else(|| size(number))
                .filter(|step| (step.recip() - step.recip().round()).abs() < 1e-6),
            _ => None,
        }
    });
    let alone = || rate(plain.strip_suffix("hz")?.trim().parse().ok()?);
    let beside = || {
        let counted = text.contains("points") && count(text).is_some();
        (counted || BESIDE_STEPS.iter().any(|word| text.contains(*word))).then_some(())?;
        let words: Vec<&str> =
            text.split([' ', '\t', ',', ';', '(', ')']).filter(|w| !w.is_empty()).collect();
        let mut steps = words
            .windows(2)
            .filter_map(|pair| size(pair[0].parse::<f64>().ok()? * time_factor(pair[1])?));
        steps.next().filter(|_| steps.next().is_none())
    };
    by_key.or_else(alone).or_else(beside)
}

/// Returns a frequency (Hz) that could be the sampling rate, from a line in any language; `None` if
/// the line names another frequency, such as that of a filter.
fn possible_rate(text: &str) -> Option<f64> {
    if OTHER_FREQUENCIES.iter().any(|word| text.contains(word)) {
        return None;
    }
    let (name, rest) = text.split_once([':', '='])?;
    let (rate, _) = leading_text(rest.as_bytes())?;
    let hertz = |text: &str| words(text).any(|word| matches!(word, "hz" | "sps"));
    ((hertz(name) || hertz(rest)) && rate >= SMALLEST_UNNAMED_RATE).then_some(rate)
}

/// Returns the number directly before a word.
fn number_before(text: &str, word: &str) -> Option<f64> {
    text.match_indices(word).find_map(|(at, _)| {
        if text[at + word.len()..].starts_with(|c: char| c.is_ascii_alphanumeric()) {
            return None;
        }
        let number = text[..at].trim_end().rsplit([' ', '\t', ',', '(', '=', ':']).next()?;
        number.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0)
    })
}

/// Smallest number before "points" that is interpreted as the number of samples; smaller numbers
/// may describe a filter.
const FEWEST_POINTS: f64 = 50.0;

fn count(text: &str) -> Option<usize> {
    let behind = COUNT_KEYS.iter().find_map(|key| {
        let value = value_behind(text, key)?;
        // In "3200 samples, 200 sps", a rate follows the word.
        let rate = ["sps", "hz", "samples/s"].iter().any(|unit| value.behind.starts_with(unit));
        (!rate && value.printed.value.fract() == 0.0).then_some(value.printed.value)
    });
    let stated = behind.or_else(|| {
        ["points", "samples", "data points", "values", "pts"]
            .iter()
            .filter(|word| {
                let rest = text.find(**word).map_or("", |at| &text[at + word.len()..]);
                !rest.trim_start().starts_with(['/', '-']) && !rest.trim_start().starts_with("per")
            })
            .find_map(|word| number_before(text, word))
            .filter(|value| *value >= FEWEST_POINTS)
    })?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 1e9")]
    (stated.fract() == 0.0 && (2.0..1e9).contains(&stated)).then_some(stated as usize)
}

fn duration(text: &str) -> Option<[f64; 2]> {
    if ["5-95", "5-75", "d5", "d595"].iter().any(|word| text.contains(word)) {
        return None;
    }
    DURATION_KEYS.iter().find_map(|key| {
        let value = value_behind(text, key)?;
        let factor =
            value.in_parentheses.and_then(time_factor).or_else(|| time_factor(value.behind));
        let bare = value.in_parentheses.is_none() && value.behind.is_empty() && *key != "length";
        let factor = factor.or(bare.then_some(1.0))?;
        let stated = [value.printed.value, value.printed.resolution].map(|v| v * factor);
        (stated[0] > 0.0).then_some(stated)
    })
}

fn peak(text: &str) -> Option<Peak> {
    PEAK_KEYS.iter().find_map(|key| {
        let value = value_behind(text, key)?;
        let unit = value.in_parentheses.and_then(MotionUnit::parse);
        let unit = unit.or_else(|| MotionUnit::parse(value.behind));
        if unit.is_some_and(|unit| unit.quantity != Quantity::Acceleration) {
            return None;
        }
        let Value { printed, .. } = value;
        (printed.value != 0.0).then_some(Peak {
            value: printed.value,
            resolution: printed.resolution,
            factor: unit.map(|unit| unit.factor),
        })
    })
}

/// Returns `true` if a lower-case text mentions acceleration.
pub(in crate::format) fn says_acceleration(lower: &str) -> bool {
    words(lower).any(|word| ACCELERATIONS.iter().any(|start| word.starts_with(start)))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty())
}

/// Parses the unit in a header line. The unit follows the word "unit"; in a line that mentions
/// acceleration, it may also be in parentheses or follow "in", a colon or a comma.
pub(in crate::format) fn unit(lower: &str) -> Option<MotionUnit> {
    // In prose, a length is not accepted as the unit: "in" is also a preposition, and "m" is
    // ambiguous.
    let rate = |text: &str| {
        MotionUnit::parse(text.trim()).filter(|unit| unit.quantity != Quantity::Displacement)
    };
    // The unit of a peak is not necessarily the unit of the samples.
    if PEAK_KEYS.iter().any(|key| value_behind(lower, key).is_some()) {
        return None;
    }
    if let Some((_, behind)) = lower.split_once("converted to ") {
        return rate(behind.split([' ', ',', ';', ')']).next().unwrap_or(""));
    }
    let is_original = |before: &str| {
        before.split_whitespace().last().is_some_and(|word| OTHER_MEANING.contains(&word))
    };
    let behind_word = |word: &&str| {
        let own = lower.match_indices(*word).find(|(at, _)| !is_original(&lower[..*at]));
        own.map(|(at, _)| &lower[at + word.len()..])
    };
    if let Some(behind) = UNIT_WORDS.iter().find_map(behind_word) {
        let whole = behind.trim_start_matches(['s', ' ', '\t', ':', '=', '(', '[']);
        if let Some(unit) = rate(whole.trim_end_matches([')', ']', '"', '.'])) {
            return Some(unit);
        }
        let tokens = behind.split([' ', ',', ';', ':', '=', '(', ')', '[', ']', '\t']);
        let words: Vec<&str> = tokens.filter(|word| !word.is_empty()).collect();
        if let Some(at) = words.iter().position(|word| rate(word).is_some()) {
            return rate(words[at]).filter(|_| !is_scaled(&words, at));
        }
    }
    if !says_acceleration(lower) {
        return None;
    }
    let behind = &lower[ACCELERATIONS.iter().find_map(|start| lower.find(start))?..];
    let groups = behind.split(['(', '[']).skip(1).filter_map(|text| text.split([')', ']']).next());
    let after_in = behind.split(" in ").skip(1).filter_map(|text| text.split([' ', ',']).next());
    let last = behind.rsplit([':', '=', ',']).next();
    groups.chain(after_in).chain(last).find_map(rate)
}

/// Returns `true` if a factor stands next to the unit, as in `0.001 g`, `% g`, `thousandths of g` or
/// `g x 100`. `unit` is the index of the unit in `words`.
fn is_scaled(words: &[&str], unit: usize) -> bool {
    let before = words[..unit].iter().rev().find(|word| **word != "of").unwrap_or(&"");
    let shares = ["%", "percent", "tenth", "hundredth", "thousandth", "milli", "micro"];
    let behind = words.get(unit + 1).unwrap_or(&"");
    before.starts_with(|c: char| c.is_ascii_digit() || c == '.') && before.parse() != Ok(1.0)
        || shares.iter().any(|share| before.starts_with(share))
        || ["x", "*", "times"].contains(behind)
        || behind.trim_start_matches(['x', '*']).parse::<f64>().is_ok()
            && behind.starts_with(['x', '*'])
}

/// Returns the word after "unit" at the beginning of a line, unless it is a unit of motion.
fn unknown_unit(lower: &str) -> Option<String> {
    let plain = lower.trim_start_matches(['#', '%', '!', '/', '"', ' ']);
    let rest = ["units", "unit", "acceleration units", "acceleration unit", "accel units"]
        .iter()
        .find_map(|key| behind(plain, key).filter(|_| plain.starts_with(key)))?;
    let rest = rest.trim_matches([' ', ':', '=', ',', '(', ')', '[', ']', '"']);
    let word = rest.strip_prefix("of ").or_else(|| rest.strip_prefix("are ")).unwrap_or(rest);
    let known = |word: &str| MotionUnit::parse(word).is_some() || time_factor(word).is_some();
    (!word.is_empty() && !word.contains(' ') && !known(word)).then(|| word.to_owned())
}

fn component(text: &str) -> Option<String> {
    let lower = text.to_ascii_lowercase();
    COMPONENT_KEYS.iter().find_map(|key| {
        let plain = lower.trim_start_matches(['#', '%', '!', '/', ' ']);
        let at = text.len() - plain.len();
        let rest = behind(plain, key).filter(|_| plain.starts_with(key))?;
        let value = text.get(at + key.len()..).filter(|_| !rest.is_empty())?;
        let value = value.trim_matches([' ', ':', '=', ',', '\t', '.']);
        (Direction::parse(value) != Direction::default()).then(|| value.to_owned())
    })
}

/// Returns an error if the header lines describe the numbers as quantities other than accelerations.
pub(super) fn refuse_other_quantities(
    source: &Source<'_>,
    lines: impl Iterator<Item = usize> + Clone,
) -> Result<(), ReadError> {
    let refuse = |line: usize, what: &str, remedy: &str| {
        Err(source.not_acceleration(line, what, quoted(&source.text(line)), remedy))
    };
    let mut acceleration = false;
    for line in lines.clone() {
        let lower = folded(source.raw(line));
        if is_spectrum(&lower) {
            let remedy =
                "give the file with the time history from which this spectrum was computed";
            return refuse(line, "an acceleration history, not a spectrum", remedy);
        }
        acceleration |= says_acceleration(&lower);
    }
    if acceleration {
        return Ok(());
    }
    for line in lines {
        let lower = folded(source.raw(line));
        let other = words(&lower).any(|word| {
            VELOCITIES.iter().chain(DISPLACEMENTS).any(|start| word.starts_with(start))
                || word == "counts"
        });
        if other {
            return refuse(line, "accelerations", "give the acceleration history");
        }
    }
    Ok(())
}

fn is_spectrum(lower: &str) -> bool {
    let history = ["ompatib", "match", "history", "series", "accelerogram"];
    let spectral =
        ["spectr", "spettr", "spektr", "fourier amplitude"].iter().any(|word| lower.contains(word));
    let plain = lower.trim_start_matches(['#', '%', '!', '/', '"', ' ']);
    let begins = [
        "period,",
        "period (",
        "period(",
        "period[",
        "period [",
        "per(s)",
        "frequency,",
        "frequency (",
        "freq (",
    ];
    let names_columns = !plain.contains([':', '=']);
    (spectral && !history.iter().any(|word| lower.contains(word)))
        || words(lower).any(|word| matches!(word, "psa" | "psv" | "fas"))
        || (names_columns && begins.iter().any(|begin| plain.starts_with(begin)))
}
