//! Readers of the CDMG volume 1 layout, shared by CSMIP, RENADIC and USC.
//!
//! Each channel is a block of 13 text lines, 7 lines of integers (16I5), 7 lines of reals, and
//! data.

use std::path::Path;

use super::even::{Timed, even_steps};
use super::source::{Columns, GAL, LARGEST_ACCELERATION, Source, latin1, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::join::PART;
use crate::math::STANDARD_GRAVITY;
use crate::record::{Channel, Record, Stage};
use crate::site::{Site, position};
use crate::units::AccelerationUnit;
use crate::utc::{DateOrder, Utc};

/// CSMIP, CDMG and CGS volume 1: uncorrected accelerograms in three data layouts.
///
/// The data are time and value pairs (`10F7.3`, g/10), or values with or without a Fortran format
/// on the data line. Spec: Shakal, Huang and Rojahn 1985, CSMIP report OSMS 85-03, "CSMIP
/// strong-motion data file format"; CDMG volume 1 of the 1970s.
pub(crate) const CSMIP: Format = Format {
    name: "csmip-v1",
    title: "CSMIP/CDMG/CGS volume 1 (uncorrected)",
    sniff: |source| {
        source.find(0, "UNCORRECTED ACCELEROGRAM DATA").is_some_and(|at| at < 4)
            && holds_integers(source)
    },
    read: |source, hints| read_blocks(source, hints, CSMIP.name, 0),
};

/// RENADIC, Universidad de Chile: time and value pairs in g/10, often with a clock channel.
///
/// Coordinates, dates and azimuths in the integers of these files are not used, because they are
/// mostly zero or belong to another day. Spec: "UNIVERSIDAD DE CHILE - RENADIC" on line 8 of each
/// channel.
pub(crate) const RENADIC: Format = Format {
    name: "renadic",
    title: "RENADIC (Universidad de Chile)",
    sniff: |source| source.has(0, "UNCORRECTED ACCELEROGRAM DATA") && source.has(7, "RENADIC"),
    read: read_renadic,
};

/// USC Los Angeles volume 1: `1X,10F7.3` pairs at uneven times.
///
/// Film records were digitized at the bends of the trace, so the step varies from 0.003 to 0.013 s.
/// Spec: Trifunac and Lee 1973, EERL report 73-03, volume 1 card images; Todorovska et al. 1999,
/// USC network data release.
pub(crate) const USC: Format = Format {
    name: "usc",
    title: "USC Los Angeles volume 1",
    sniff: |source| {
        source.text(0).to_ascii_uppercase().starts_with("FILE")
            && source.has(0, "UNCORRECTED ACCELEROGRAM")
    },
    read: |source, hints| read_blocks(source, hints, USC.name, 1),
};

/// Number of lines that are searched for the integers of a header.
const FIRST_LINES: usize = 40;
/// Minimum length of a line of integers: eight integers of five characters each.
const INTEGERS: usize = 40;

/// Returns `true` if a header line contains integers in fixed columns (16I5), as in all files of
/// this layout. A title alone is not sufficient, because a similar title may stand above any table.
pub(super) fn holds_integers(source: &Source<'_>) -> bool {
    (1..FIRST_LINES).any(|line| {
        let raw = source.raw(line);
        let plain = |byte: &u8| byte.is_ascii_digit() || [b' ', b'-', b'\r'].contains(byte);
        raw.len() >= INTEGERS && raw.iter().all(plain) && raw.iter().any(u8::is_ascii_digit)
    })
}

/// Number of header lines: 13 lines of text, 7 lines of integers and 7 lines of reals.
const HEADER_LINES: usize = 27;

fn read_renadic(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let mut record = read_blocks(source, hints, RENADIC.name, 0)?;
    // Times and coordinates in these headers are zero or defaults of the software.
    record.place(None, &Site::default());
    if let Some(other) = other_part(source.name) {
        let seconds = record.channels.first().map_or(0.0, Channel::duration);
        record.warn(
            None,
            format!(
                "the file name indicates {PART}, and only the {seconds:.0} s of this part are used; to use the whole \
                 record, join this file with the other parts, such as {other}, in order of time"
            ),
        );
    }
    Ok(record)
}

/// Returns the name of another part of the record, such as "parte2.v1" for "parte1.v1"; `None` if the name of the file
/// indicates no part.
fn other_part(path: &str) -> Option<String> {
    const WORD: &str = "parte";
    let name = Path::new(path).file_name().map_or(path.into(), |name| name.to_string_lossy());
    let digits = name.to_ascii_lowercase().rfind(WORD)? + WORD.len();
    let (start, rest) = name.split_at(digits);
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (number, end) = rest.split_at(end);
    let other = if number.parse() == Ok(1) { 2 } else { 1 };
    Some(format!("{start}{other}{end}"))
}

/// Reads every block of a volume 1 file. Each line contains pairs of time and value after `indent`
/// blanks, unless the values are equally spaced.
fn read_blocks(
    source: &Source<'_>,
    hints: &Hints<'_>,
    format: &'static str,
    indent: usize,
) -> Result<Record, ReadError> {
    let mut record = Record::new(format, source.name, Stage::Raw);
    let pairs = Columns { indent, per_line: 10, width: 7 };
    source.each_block(|line| read_block(source, hints, &mut record, pairs, line))?;
    Ok(record)
}

fn read_block(
    source: &Source<'_>,
    hints: &Hints<'_>,
    record: &mut Record,
    pairs: Columns,
    first: usize,
) -> Result<usize, ReadError> {
    let mark = "\"UNCORRECTED ACCELEROGRAM DATA\" at the start of a channel";
    source.require_mark(first, "UNCORRECTED ACCELEROGRAM", mark)?;
    source.require_header(first, HEADER_LINES)?;
    if record.channels.is_empty() {
        record.event = source.text(first + 1);
        record.station = station_name(source, first + 5);
    }
    let name = channel_name(source, first + 6);
    // Integer 27 of the header is the direction code.
    let code = super::source::parse_number(source.slice(first + 14, 50, 5));
    let direction = Direction::of_name_or_code(&name, code);
    let data = first + HEADER_LINES;
    let equal = source.has(data, "points");
    let unit = unit(source, if equal { data } else { first + 11 }, hints)?;
    let limit = LARGEST_ACCELERATION / unit.factor();
    let (time_step, mut values, next) = if equal {
        read_equal(source, record, data, limit)?
    } else {
        let count = source
            .number_after(first + 10, "POINTS")
            .ok_or_else(|| missing(source, first + 10, "the number of points"))?;
        let count = super::whole(source, first + 10, "a number of points", count)?;
        let (numbers, next) = source.counted(record, data, 2 * count, pairs, limit.max(1e6))?;
        let timed = Timed::of_pairs(data, pairs, &numbers, 0.001);
        let (step, mut columns) = even_steps(source, record, &name, timed)?;
        (step, columns.pop().unwrap_or_default(), next)
    };
    for value in &mut values {
        *value *= unit.factor();
    }
    let mut channel = Channel::new(name, direction, time_step, values);
    channel.start = start(source, first);
    if let Some((line, stated)) = stated_start(source, first) {
        record.warn_of_start(line, stated.trim(), channel.start);
    }
    channel.site = Site::default().at(position(&source.text(first + 4)));
    // The peak, as in `MAX  =  -.200 G`, is in g even if the data are in g/10.
    let factor = if source.has(first + 11, "CM/SEC") { GAL } else { STANDARD_GRAVITY };
    channel.state_peak(source.printed_after(first + 11, "MAX"), factor);
    record.channels.push(channel);
    source.end_of_channel(next, "UNCORRECTED ACCELEROGRAM")
}

/// Reads equally spaced values below a data line such as
/// `31932 Accelerogram points at 100 pts/sec in units of g. Format: (8f9.6)` or
/// `12001 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC. (UNITS: G)`.
fn read_equal(
    source: &Source<'_>,
    record: &mut Record,
    line: usize,
    limit: f64,
) -> Result<(f64, Vec<f64>, usize), ReadError> {
    let count = super::source::leading_number(source.raw(line))
        .ok_or_else(|| missing(source, line, "the number of points"))?;
    let count = super::whole(source, line, "a number of points", count)?;
    let time_step = if source.has(line, "pts/sec") {
        source.number_after(line, "points at").map(|rate| 1.0 / rate)
    } else {
        source.number_after(line, "spaced at")
    };
    let time_step = time_step
        .filter(|step| step.is_finite() && *step > 0.0)
        .ok_or_else(|| missing(source, line, "the step"))?;
    let columns = format_in(source, line).unwrap_or(Columns::new(8, 9));
    let (values, next) = source.counted(record, line + 1, count, columns, limit)?;
    Ok((time_step, values, next))
}

/// Parses the Fortran format in parentheses on a data line.
pub(crate) fn format_in(source: &Source<'_>, line: usize) -> Option<Columns> {
    let text = latin1(source.raw(line));
    text.match_indices('(').find_map(|(at, _)| {
        let rest = &text[at..];
        rest[1..]
            .trim_start()
            .starts_with(|c: char| c.is_ascii_digit())
            .then(|| Columns::parse(rest))
            .flatten()
    })
}

fn missing(source: &Source<'_>, line: usize, what: &str) -> ReadError {
    source.header(line, what, quoted(&source.text(line)))
}

/// Returns the station name in columns 1 to 40; the network and the kind of data follow in further
/// columns.
pub(crate) fn station_name(source: &Source<'_>, line: usize) -> String {
    let text = latin1(source.slice(line, 0, 40));
    text.trim_start().split("   ").next().unwrap_or("").trim().to_owned()
}

/// Parses the start time from the header, such as `START TIME:  7/06/19, 03:19:37.0 UTC`. `TRIGGER TIME:` is also
/// accepted, because a film recorder starts at its trigger time.
pub(crate) fn start(source: &Source<'_>, first: usize) -> Option<Utc> {
    (first..first + 6)
        .find_map(|line| Utc::in_header(&start_in(source, line)?, DateOrder::MonthFirst))
}

/// Returns the first start time stated in the header, as the line number and the text, even if the text cannot be
/// parsed.
pub(crate) fn stated_start(source: &Source<'_>, first: usize) -> Option<(usize, String)> {
    (first..first + 6).find_map(|line| Some((line, start_in(source, line)?)))
}

/// Returns the text after `START TIME:` or `TRIGGER TIME:`.
fn start_in(source: &Source<'_>, line: usize) -> Option<String> {
    let keys = ["START TIME:", "TRIGGER TIME:"];
    let at = keys.into_iter().find_map(|key| Some(source.find(line, key)? + key.len()))?;
    Some(latin1(&source.raw(line)[at..]))
}

/// Parses a channel name from `CHAN  1:  90 DEG`, `CHAN  2: V   (STA CHN:  2)` or `COMP N00W`;
/// columns 73 to 80 are ignored.
pub(crate) fn channel_name(source: &Source<'_>, line: usize) -> String {
    let text = latin1(source.slice(line, 0, 72));
    let text = text.split('(').next().unwrap_or("");
    let name = text.split_once(':').map_or(text, |(_, name)| name).trim();
    let name = name.strip_prefix("COMP").map_or(name, str::trim);
    name.split("  ").next().unwrap_or("").trim().to_owned()
}

fn unit(
    source: &Source<'_>,
    line: usize,
    hints: &Hints<'_>,
) -> Result<AccelerationUnit, ReadError> {
    let keys = ["SEC AND ", "SECONDS AND ", "units of ", "UNITS: ", "in "];
    source.unit_after(line, &keys).or_else(|| hints.unit()).ok_or_else(|| {
        source.error(
            line,
            Refusal::Missing(Given::Unit),
            "a unit of acceleration",
            quoted(&source.text(line)),
            "state the unit (g, g/10, cm/s2)",
        )
    })
}
