//! Reader of GSE 2 and IMS 1 waveforms with integers (INT) or six-bit compression (CM6).
//!
//! Spec: GSETT-3, CRP/243 (1995), formats and protocols, sections WID2, DAT2 and CHK2, appendix on
//! compression.

use super::counts::{self, Samples, Unit};
use super::source::{Source, latin1, parse_number, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{ReadError, Refusal};
use crate::instrument::SeedName;
use crate::record::{Record, Stage};
use crate::utc::Utc;

pub(crate) const FORMAT: Format =
    Format { name: "gse2", title: "GSE 2 (INT and CM6)", sniff, read };

/// Number of lines searched before the first waveform of a message.
const MOST_LINES_BEFORE: usize = 60;
const AGAIN: &str = "the file is truncated or damaged; get it again from its source";

fn begins(source: &Source<'_>, line: usize, key: &str) -> bool {
    source.raw(line).starts_with(key.as_bytes())
}

fn sniff(source: &Source<'_>) -> bool {
    (0..MOST_LINES_BEFORE).any(|line| begins(source, line, "WID2 "))
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let mut line = 0;
    while let Some(head) = (line..source.lines.len()).find(|&l| begins(source, l, "WID2 ")) {
        let (samples, next) = section(source, head)?;
        let channel = counts::channel(source, &mut record, hints, "GSE 2", samples)?;
        record.channels.push(channel);
        line = next;
    }
    record.station = counts::stations(&record);
    Ok(record)
}

/// Reads one waveform, which begins with its `WID2` line. Also returns the number of the line after
/// the `CHK2` line.
fn section(source: &Source<'_>, head: usize) -> Result<(Samples, usize), ReadError> {
    let text =
        |from: usize, to: usize| latin1(source.slice(head, from, to - from)).trim().to_owned();
    let wrong = |(from, to): (usize, usize), expected: &str| {
        source.header((head, from), expected, quoted(&text(from, to)))
    };
    let start = Utc::in_header(&text(5, 28), crate::utc::DateOrder::DayFirst)
        .ok_or_else(|| wrong((5, 28), "date and time of the first sample"))?;
    let layout = text(44, 47);
    let count = parse_number(text(48, 56).as_bytes())
        .ok_or_else(|| wrong((48, 56), "a number of samples"))?;
    let count = super::whole(source, head, "a number of samples", count)?;
    let rate = parse_number(text(57, 68).as_bytes())
        .filter(|rate| *rate > 0.0)
        .ok_or_else(|| wrong((57, 68), "samples a second"))?;
    let at = |key: &str, from: usize| (from..source.lines.len()).find(|&l| begins(source, l, key));
    let data = at("DAT2", head).ok_or_else(|| source.cut("DAT2 with the samples", "none"))?;
    let end = at("CHK2", data).ok_or_else(|| source.cut("CHK2 with the checksum", "none"))?;
    let integers = match layout.as_str() {
        "INT" => integers(source, data + 1, end)?,
        "CM6" => {
            let encoded = (data + 1..end).flat_map(|line| source.raw(line).iter().copied());
            let numbers = six_bits(encoded, count).ok_or_else(|| {
                source.damaged(data + 1, "six-bit compression (CM6)", "other characters", AGAIN)
            })?;
            twice_summed(&numbers).ok_or_else(|| {
                source.damaged(data + 1, "samples of 32 bits", "larger ones", AGAIN)
            })?
        }
        other => {
            return Err(source.error(
                (head, 44),
                Refusal::Unrecognized,
                "INT or CM6 as layout of the samples",
                quoted(other),
                "convert the file to INT or CM6, or to miniSEED",
            ));
        }
    };
    if integers.len() != count {
        let expected = format!("{count} samples as stated here");
        return Err(source.damaged((head, 48), expected, integers.len().to_string(), AGAIN));
    }
    let stated = source.number_after(end, "CHK2").ok_or_else(|| {
        source.damaged(end, "a checksum after CHK2", quoted(&source.text(end)), AGAIN)
    })?;
    let found = checksum(&integers);
    if stated != found as f64 {
        let found = format!("samples whose checksum is {found}");
        return Err(source.damaged(end, format!("the checksum {stated}"), found, AGAIN));
    }
    let station = text(29, 34);
    let network = at("STA2", head)
        .filter(|&line| line < data)
        .map(|line| latin1(source.slice(line, 5, 9)).trim().to_owned());
    let codes = SeedName {
        network: network.unwrap_or_default(),
        station,
        location: text(39, 43),
        channel: text(35, 38),
    };
    // The azimuth and the angle from the vertical; the channel code takes precedence.
    let angles = [text(95, 100), text(101, 105)].map(|text| parse_number(text.as_bytes()));
    let stated = match angles {
        [Some(azimuth), Some(90.0)] if (0.0..=360.0).contains(&azimuth) => {
            Some(Direction::horizontal(azimuth))
        }
        _ => None,
    };
    let named = Direction::parse(&codes.channel);
    let direction = if named == Direction::default() { stated } else { Some(named) };
    let values = integers.iter().map(|value| *value as f64).collect();
    let time_step = 1.0 / rate;
    let (start, unit) = (Some(start), Unit::Counts);
    Ok((Samples { codes, start, time_step, values, unit, direction }, end + 1))
}

fn integers(source: &Source<'_>, from: usize, to: usize) -> Result<Vec<i64>, ReadError> {
    let mut all = Vec::new();
    for line in from..to {
        let raw = source.raw(line);
        for word in raw.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            let value = std::str::from_utf8(word).ok().and_then(|word| word.parse::<i32>().ok());
            let column = || raw.windows(word.len()).position(|w| w == word).unwrap_or(0);
            all.push(i64::from(value.ok_or_else(|| source.bad_number(line, column(), word))?));
        }
    }
    Ok(all)
}

/// Returns the value of a six-bit character, 0 to 63.
fn six(byte: u8) -> Option<u8> {
    Some(match byte {
        b'+' => 0,
        b'-' => 1,
        b'0'..=b'9' => byte - b'0' + 2,
        b'A'..=b'Z' => byte - b'A' + 12,
        b'a'..=b'z' => byte - b'a' + 38,
        _ => return None,
    })
}

/// Decodes integers from six-bit characters, the most significant bits first. The highest bit of a
/// character states that the integer continues in the next character. The next bit of the first
/// character is the sign. All other bits form the magnitude.
fn six_bits(encoded: impl Iterator<Item = u8>, count: usize) -> Option<Vec<i64>> {
    let mut numbers = Vec::new();
    let mut open: Option<(bool, i64)> = None;
    for byte in encoded.filter(|byte| !byte.is_ascii_whitespace()) {
        // Ignore the padding of the last line.
        if numbers.len() == count {
            break;
        }
        let value = six(byte)?;
        let (negative, size) = match open.take() {
            None => (value & 16 != 0, i64::from(value & 15)),
            Some((negative, size)) => {
                (negative, size.checked_mul(32)?.checked_add(i64::from(value & 31))?)
            }
        };
        if value & 32 != 0 {
            open = Some((negative, size));
        } else {
            numbers.push(if negative { -size } else { size });
        }
    }
    open.is_none().then_some(numbers)
}

/// Sums second differences twice to obtain the samples; `None` if a sample exceeds 32 bits.
fn twice_summed(differences: &[i64]) -> Option<Vec<i64>> {
    let (mut value, mut slope) = (0_i64, 0_i64);
    let mut all = Vec::with_capacity(differences.len());
    for difference in differences {
        slope = slope.checked_add(*difference)?;
        value = value.checked_add(slope)?;
        all.push(i64::from(i32::try_from(value).ok()?));
    }
    Some(all)
}

/// Returns the checksum of the format: the absolute value of a running sum that is kept below 10⁸
/// in magnitude.
fn checksum(values: &[i64]) -> i64 {
    const MODULUS: i64 = 100_000_000;
    let sum = values.iter().fold(0_i64, |sum, value| (sum + value % MODULUS) % MODULUS);
    sum.abs()
}
