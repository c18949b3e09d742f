//! Reader of TSPAIR and SLIST text, as written by FDSN web services, irisws-timeseries and `ObsPy`.
//!
//! Every block begins with the line
//! `TIMESERIES NET_STA_LOC_CHA_Q, n samples, r sps, start, TSPAIR or SLIST, type, unit`. Lines of
//! time and value, or values alone, follow. Spec: `EarthScope`, timeseries web service, output
//! formats `ascii`, `ascii1` and `ascii2`.

use super::counts::{self, Samples, Unit};
use super::source::{Source, parse_number, quoted};
use super::{Format, Hints};
use crate::error::ReadError;
use crate::instrument::SeedName;
use crate::record::{Record, Stage};
use crate::utc::Utc;

pub(crate) const FORMAT: Format =
    Format { name: "timeseries", title: "TSPAIR and SLIST text (FDSN)", sniff, read };

const MARK: &str = "TIMESERIES ";
/// Largest accepted magnitude of a sample, in counts or in the stated unit.
const LIMIT: f64 = 1e12;

fn sniff(source: &Source<'_>) -> bool {
    source.raw(0).starts_with(MARK.as_bytes())
        && (source.has(0, "TSPAIR") || source.has(0, "SLIST"))
}

/// Content of the first line of a block.
struct Head {
    line: usize,
    codes: SeedName,
    count: usize,
    rate: f64,
    start: Utc,
    pairs: bool,
    unit: Unit,
}

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    source.require_text()?;
    let mut record = Record::new(FORMAT.name, source.name, Stage::Unknown);
    let mut open: Option<(Head, Vec<f64>)> = None;
    let mut line = 0;
    while line < source.lines.len() {
        let head = head(source, line)?;
        let next = (line + 1..source.lines.len())
            .find(|&line| source.raw(line).starts_with(MARK.as_bytes()))
            .unwrap_or(source.lines.len());
        let values = values(source, &head, next)?;
        open = Some(match open.take() {
            Some((first, mut all)) if first.codes == head.codes => {
                continued(source, &first, all.len(), &head)?;
                all.extend(values);
                (first, all)
            }
            Some(done) => {
                finish(source, &mut record, hints, done)?;
                (head, values)
            }
            None => (head, values),
        });
        line = next;
    }
    if let Some(done) = open {
        finish(source, &mut record, hints, done)?;
    }
    record.station = counts::stations(&record);
    Ok(record)
}

fn finish(
    source: &Source<'_>,
    record: &mut Record,
    hints: &Hints<'_>,
    (head, values): (Head, Vec<f64>),
) -> Result<(), ReadError> {
    let Head { codes, rate, start, unit, .. } = head;
    if unit == Unit::Counts {
        record.stage = Stage::Raw;
    }
    let time_step = 1.0 / rate;
    let samples = Samples { codes, start: Some(start), time_step, values, unit, direction: None };
    let channel = counts::channel(source, record, hints, "this text", samples)?;
    record.channels.push(channel);
    Ok(())
}

fn head(source: &Source<'_>, line: usize) -> Result<Head, ReadError> {
    let text = source.text(line);
    let fields: Vec<&str> =
        text.strip_prefix(MARK).unwrap_or("").split(',').map(str::trim).collect();
    let wrong = |expected: &str, found: &str| source.header(line, expected, quoted(found));
    let [name, count, rate, start, kind, _, rest @ ..] = fields.as_slice() else {
        let expected = "\"TIMESERIES\" with source, samples, rate, start, layout, type and unit";
        return Err(wrong(expected, &text));
    };
    let number = |field: &str, word: &str| parse_number(field.strip_suffix(word)?.as_bytes());
    let count = number(count, "samples")
        .or_else(|| number(count, "sample"))
        .ok_or_else(|| wrong("a number of samples such as \"3200 samples\"", count))?;
    let count = super::whole(source, line, "a number of samples", count)?;
    let rate = number(rate, "sps")
        .filter(|rate| *rate > 0.0)
        .ok_or_else(|| wrong("a rate above 0 such as \"200 sps\"", rate))?;
    let start = start.parse::<Utc>().map_err(|_| wrong("the time of the first sample", start))?;
    let pairs = match *kind {
        "TSPAIR" => true,
        "SLIST" => false,
        other => return Err(wrong("TSPAIR or SLIST as layout", other)),
    };
    // Without a unit, the values are counts and need a sensitivity.
    let word = rest.first().copied().unwrap_or_default();
    let unit = Unit::of(word).ok_or_else(|| {
        source.not_acceleration(
            line,
            "counts, or a unit of acceleration",
            quoted(word),
            "give the accelerations of the same station",
        )
    })?;
    let mut parts = name.split('_').map(str::to_owned);
    let mut part = || parts.next().unwrap_or_default();
    let codes = SeedName { network: part(), station: part(), location: part(), channel: part() };
    Ok(Head { line, codes, count, rate, start, pairs, unit })
}

/// Returns the values of a block. Their number and their times must agree with the first line of
/// the block.
fn values(source: &Source<'_>, head: &Head, end: usize) -> Result<Vec<f64>, ReadError> {
    let mut values = Vec::with_capacity(head.count.min(source.bytes.len()));
    for line in head.line + 1..end {
        if source.raw(line).trim_ascii().is_empty() {
            continue;
        }
        if !head.pairs {
            source.tokens(line, LIMIT, &mut values)?;
            continue;
        }
        let text = source.text(line);
        let (time, value) = text
            .split_once([' ', '\t', ','])
            .ok_or_else(|| source.damaged(line, "a time and a value", quoted(&text), AGAIN))?;
        let time: Utc =
            time.trim().parse().map_err(|_| source.damaged(line, "a time", quoted(time), AGAIN))?;
        let off = time.since(head.start) - values.len() as f64 / head.rate;
        if off.abs() > 0.5 / head.rate {
            let expected = format!("sample {} at the {} sps stated", values.len() + 1, head.rate);
            let found = format!("a time that is {off:.6} s off ({time})");
            return Err(source.damaged(line, expected, found, AGAIN));
        }
        let value = value.trim_matches([' ', '\t', ',']);
        let column = source.find(line, value).unwrap_or(0);
        let value = parse_number(value.as_bytes())
            .ok_or_else(|| source.bad_number(line, column, value.as_bytes()))?;
        values.push(source.within(line, column, value, LIMIT)?);
    }
    if values.len() != head.count {
        let expected = format!("{} samples as stated here", head.count);
        return Err(source.damaged(head.line, expected, values.len().to_string(), AGAIN));
    }
    Ok(values)
}

const AGAIN: &str = "the text is truncated or damaged; get it again from its source";

/// Checks that a block begins where the previous block ended.
fn continued(
    source: &Source<'_>,
    first: &Head,
    count: usize,
    next: &Head,
) -> Result<(), ReadError> {
    let off = next.start.since(first.start) - count as f64 / first.rate;
    if next.rate != first.rate || next.unit != first.unit {
        let expected = format!("{} sps throughout, in one unit", first.rate);
        return Err(source.damaged(next.line, expected, format!("{} sps", next.rate), AGAIN));
    }
    if off.abs() > 0.5 / first.rate {
        return Err(source.damaged(
            next.line,
            format!("channel {} without a gap", first.codes.channel),
            format!("{off:.4} s between two blocks"),
            "give the part before or after the gap",
        ));
    }
    Ok(())
}
