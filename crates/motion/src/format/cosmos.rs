//! Reader of COSMOS format 1.20, volumes 0 (counts), 1 and 2.
//!
//! The first line of each block of numbers states their count and their Fortran format; the reader uses both. Spec:
//! Strong-Motion Data Format of the COSMOS Board, version 1.20 (2001), tables 2 to 6.

use super::source::{
    Columns, GAL, LARGEST_ACCELERATION, Printed, Source, latin1, leading_number, quoted, shorten,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::math::{self, STANDARD_GRAVITY};
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::Utc;

pub(crate) const FORMAT: Format =
    Format { name: "cosmos", title: "COSMOS 1.20 volumes 0, 1 and 2", sniff, read };

/// Code of the unit g in the format; the codes of other units follow (table 2 of the specification).
const UNIT_G: i64 = 2;
const UNIT_CM_S2: i64 = 4;
const UNIT_GAL: i64 = 10;
const UNIT_COUNTS: i64 = 50;

fn sniff(source: &Source<'_>) -> bool {
    source.has(0, "(Format v") && source.has(0, "text lines")
}

struct Header {
    integers: Vec<f64>,
    reals: Vec<f64>,
    unknown: f64,
    data_line: usize,
}

impl Header {
    /// Returns the integer of the header that has the number `n` in the specification (counted from 1); `None` if it is
    /// missing, marked as unknown, or too large for a code.
    fn integer(&self, n: usize) -> Option<i64> {
        let value = *self.integers.get(n - 1)?;
        #[expect(clippy::cast_possible_truncation, reason = "compared with codes only")]
        (value != self.unknown && value.abs() < 1e9).then_some(value as i64)
    }

    /// Returns the real number of the header that has the number `n` in the specification (counted from 1); `None` if
    /// it is missing or marked as unknown.
    fn real(&self, n: usize) -> Option<f64> {
        self.reals.get(n - 1).copied().filter(|value| *value != self.unknown && *value != -999.0)
    }
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let stage = if source.text(0).to_ascii_lowercase().starts_with("corrected") {
        Stage::Corrected
    } else {
        Stage::Raw
    };
    let mut record = Record::new(FORMAT.name, source.name, stage);
    let mut refused = None;
    source.each_block(|line| {
        let header = header(source, line)?;
        let (channel, next) = read_channel(source, hints, &mut record, line, &header)?;
        match channel {
            Ok(channel) => record.channels.push(channel),
            Err(error) => {
                record.warn(
                    line + 1,
                    format!("channel left out: expected {}, found {}", error.expected, error.found),
                );
                refused = Some(error);
            }
        }
        Ok(next)
    })?;
    match refused {
        Some(error) if record.channels.is_empty() => Err(error),
        _ => Ok(record),
    }
}

fn damaged(source: &Source<'_>, line: usize, expected: &str) -> ReadError {
    source.damaged(
        line.min(source.lines.len().saturating_sub(1)),
        expected,
        quoted(&source.text(line)),
        "lines are missing or added; get the file again from its source",
    )
}

/// Reads a header, which states how many text lines, integers, reals and comments it has; the data
/// line follows.
fn header(source: &Source<'_>, first: usize) -> Result<Header, ReadError> {
    if !source.has(first, "(Format v") {
        return Err(damaged(source, first, "\"... (Format v01.20 with 13 text lines)\""));
    }
    let text_lines = source
        .number_after(first, "with ")
        .ok_or_else(|| damaged(source, first, "the number of text lines"))?;
    let text_lines = super::whole(source, first, "a number of text lines", text_lines)?;
    let unknown = (first..first + text_lines.min(100))
        .find(|&line| source.has(line, "unknown/unspecified"))
        .and_then(|line| source.number_after(line, "unspecified:"))
        .unwrap_or(-999.0);
    let mut line = first + text_lines;
    let mut tables = Vec::new();
    for kind in ["integer-header", "real-header"] {
        let stated = leading_number(source.raw(line)).filter(|_| source.has(line, kind));
        let count =
            stated.ok_or_else(|| damaged(source, line, &format!("a line of {kind} values")))?;
        let count = super::whole(source, line, "a number of header values", count)?;
        let columns = format_after(source, line)
            .ok_or_else(|| damaged(source, line, "a Fortran format such as (10I8)"))?;
        let (values, next) = source.fixed(line + 1, count, columns, f64::INFINITY)?;
        tables.push(values);
        line = next;
    }
    let comments = leading_number(source.raw(line)).filter(|_| source.has(line, "comment"));
    let comments = comments.ok_or_else(|| damaged(source, line, "the number of comment lines"))?;
    if !(0.0..=1e6).contains(&comments) {
        return Err(damaged(source, line, "the number of comment lines"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
    let data_line = line + 1 + comments as usize;
    let reals = tables.pop().unwrap_or_default();
    let integers = tables.pop().unwrap_or_default();
    Ok(Header { integers, reals, unknown, data_line })
}

/// Parses a Fortran format such as `Format= (10I8)` or `Format=(8F10.5)`.
fn format_after(source: &Source<'_>, line: usize) -> Option<Columns> {
    let at = source.find(line, "format")?;
    let text = latin1(&source.raw(line)[at..]);
    Columns::parse(&text[text.find('(')?..])
}

type ChannelOrRefusal = Result<Channel, ReadError>;

fn read_channel(
    source: &Source<'_>,
    hints: &Hints<'_>,
    record: &mut Record,
    first: usize,
    header: &Header,
) -> Result<(ChannelOrRefusal, usize), ReadError> {
    let line = header.data_line;
    let count = leading_number(source.raw(line))
        .filter(|_| source.has(line, "pts"))
        .ok_or_else(|| damaged(source, line, "a line such as \"7000 acceleration pts\""))?;
    let count = super::whole(source, line, "a number of points", count)?;
    let columns =
        format_after(source, line).ok_or_else(|| damaged(source, line, "a Fortran format"))?;
    let (mut values, mut next) = source.counted(record, line + 1, count, columns, 1e12)?;
    let quantity = header.integer(2);
    let unit = header.integer(3);
    let refuse = |found: String| {
        source.not_acceleration(
            line,
            "an acceleration channel (quantity 1)",
            found,
            "give the acceleration file of the same record",
        )
    };
    // The closing line is free text; any line up to the next header is accepted.
    if next < source.lines.len() && !source.has(next, "(Format v") {
        if !source.has(next, "end") {
            return Err(damaged(source, next, "\"End-of-data\""));
        }
        next += 1;
    }
    let text = source.text(line).to_ascii_lowercase();
    if quantity.is_some_and(|code| code != 1) {
        return Ok((Err(refuse(format!("quantity {} ({text})", quantity.unwrap_or(0)))), next));
    }
    if text.contains("velocity") || text.contains("displacement") {
        return Ok((Err(refuse(quoted(&text))), next));
    }
    let factor = match unit {
        Some(UNIT_G) => STANDARD_GRAVITY,
        Some(UNIT_CM_S2 | UNIT_GAL) => GAL,
        Some(UNIT_COUNTS) => counts_to_si(source, hints, header, line)?,
        other => {
            let code = other.map_or("none".to_owned(), |code| code.to_string());
            return Ok((Err(refuse(format!("unit code {code} (\"{}\")", shorten(&text)))), next));
        }
    };
    let time_step = header
        .real(62)
        .map(|milliseconds| milliseconds / 1000.0)
        .filter(|step| *step > 0.0)
        .ok_or_else(|| damaged(source, line, "a sample interval in real header 62 (ms)"))?;
    for value in &mut values {
        *value *= factor;
        if value.abs() > 100.0 * LARGEST_ACCELERATION {
            return Err(damaged(source, line, "accelerations of a plausible size"));
        }
    }
    if record.channels.is_empty() {
        record.event = source.text(first + 1);
        record.station = source.text(first + 4);
    }
    let name = channel_name(source, first);
    let mut direction = Direction::of_name_or_code(&name, header.integer(54).map(|n| n as f64));
    if direction == Direction::default()
        && let Some(code) = seed_code(source, first, line)
    {
        direction = Direction::parse(&code);
    }
    let mut channel = Channel::new(name, direction, time_step, values);
    channel.start = start(header);
    channel.site = site(source, first, header);
    let peak = header.real(64).map(|value| Printed { value, resolution: 1e-6 });
    channel.state_peak(peak, factor);
    if unit == Some(UNIT_COUNTS) {
        let offset = math::take_mean(&mut channel.acceleration);
        record.notes.push(format!(
            "channel {}: counts multiplied by {factor:.6e} m/s2; digitizer offset of {offset:.4} \
             m/s2 (mean \
             of the record) removed",
            channel.name
        ));
    }
    Ok((Ok(channel), next))
}

/// Returns the time of the first sample, from integers 40 to 45 and real 30.
fn start(header: &Header) -> Option<Utc> {
    let part = |n: usize| header.integer(n);
    Utc::new(part(40)?, part(42)?, part(43)?, part(44)?, part(45)?, header.real(30)?)
}

/// Returns the site, from reals 1 to 3; the location of the sensor in a structure comes from text
/// line 9.
fn site(source: &Source<'_>, first: usize, header: &Header) -> Site {
    let line = source.text(first + 8);
    let sensor = line.split_once("Location:").map_or("", |(_, place)| place.trim()).to_owned();
    let site = Site { sensor, elevation: header.real(3), ..Site::default() };
    site.at(header.real(1).zip(header.real(2)))
}

/// Returns the factor that converts counts to accelerations: the reciprocal of the sensitivity
/// given by the caller (counts per m/s²), or else `LSB (µV) / (sensor sensitivity (V/g) × gain)`.
fn counts_to_si(
    source: &Source<'_>,
    hints: &Hints<'_>,
    header: &Header,
    line: usize,
) -> Result<f64, ReadError> {
    if let Some(sensitivity) = hints.sensitivity() {
        return Ok(1.0 / sensitivity);
    }
    let needed = [(22, "LSB in microvolt"), (42, "sensor V/g"), (47, "gain")];
    let mut values = [0.0; 3];
    for ((number, what), value) in needed.into_iter().zip(&mut values) {
        *value = header.real(number).filter(|value| *value > 0.0).ok_or_else(|| {
            source.error(
                line,
                Refusal::Missing(Given::Sensitivity),
                format!("real header {number} ({what}) to turn counts into accelerations"),
                header.real(number).map_or("unknown".to_owned(), |v| v.to_string()),
                "state the sensitivity in counts per m/s2",
            )
        })?;
    }
    let [lsb, sensor, gain] = values;
    Ok(lsb * 1e-6 / (sensor * gain) * STANDARD_GRAVITY)
}

/// Parses a channel name from `Sta Chan   1: 90 Deg (Rcrdr Chan  ?) Location:...`.
fn channel_name(source: &Source<'_>, first: usize) -> String {
    let text = source.text(first + 8);
    let name = text.split('(').next().unwrap_or("");
    let name = name.strip_prefix("Sta").map_or(name, str::trim);
    let name = name.strip_prefix("Chan").or_else(|| name.strip_prefix("Cha")).unwrap_or(name);
    // Examples are "Sta Cha:  1: 340 deg" and "Sta Chan   1: 90 Deg".
    name.rsplit(':').next().unwrap_or("").trim().to_owned()
}

/// Returns the channel code in a comment such as `|<SCNL>BMR.BNZ.AK.--`.
fn seed_code(source: &Source<'_>, from: usize, to: usize) -> Option<String> {
    (from..to).find_map(|line| {
        let text = source.text(line);
        let (_, code) = text.split_once("<SCNL>")?;
        code.split('.').nth(1).map(|code| code.trim().to_owned())
    })
}
