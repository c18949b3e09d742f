//! Reader of miniSEED 2: data records of integers, floats or Steim-compressed counts, joined by
//! channel.
//!
//! The decoder is part of this crate. The only maintained Rust crate, miniseed-rs (0.2.2), decodes
//! the same encodings but ignores the time correction in the header and the microseconds of
//! blockette 1001, which are needed to align channels. It also does not compare the last sample of
//! Steim frames with the stated value, which detects damage. Other crates wrap a C library. Spec:
//! FDSN, Standard for the Exchange of Earthquake Data, version 2.4, chapter 8 and appendix B.

use std::collections::BTreeMap;

use super::source::{Source, latin1};
use super::{Format, Hints, seed};
use crate::direction::Direction;
use crate::error::{Given, ReadError, Refusal};
use crate::instrument::SeedName;
use crate::record::{Channel, Quantity, Record, Stage};
use crate::site::Site;
use crate::utc::Utc;

pub(crate) const FORMAT: Format = Format { name: "miniseed", title: "miniSEED 2", sniff, read };

const FIXED_HEADER: usize = 48;

fn sniff(source: &Source<'_>) -> bool {
    let b = source.bytes;
    b.len() >= FIXED_HEADER
        && b[..6].iter().all(|c| c.is_ascii_digit() || *c == b' ')
        && matches!(b[6], b'D' | b'R' | b'Q' | b'M')
        && matches!(b[7], b' ' | 0)
        && b[8..20].iter().all(|c| c.is_ascii_alphanumeric() || matches!(*c, b' ' | b'-'))
}

/// Header of one data record.
struct Header {
    id: SeedName,
    samples: usize,
    rate: f64,
    start: Utc,
    data: usize,
    length: usize,
    encoding: u8,
    big: bool,
}

/// Samples of one data record.
struct Piece {
    rate: f64,
    start: Utc,
    values: Vec<f64>,
}

/// Samples of one channel, joined from its data records.
struct Trace {
    rate: f64,
    start: Utc,
    values: Vec<f64>,
}

/// Largest difference, in samples, between the stated start of a data record and the start that
/// follows from the number of samples before it; larger differences are gaps or overlaps.
const LARGEST_OFFSET: f64 = 0.6;
/// Largest relative error of the sampling rate caused by the recorder's clock.
const LARGEST_CLOCK_ERROR: f64 = 2e-4;

fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let bytes = source.bytes;
    let mut pieces: BTreeMap<SeedName, Vec<Piece>> = BTreeMap::new();
    let mut at = 0;
    while at + FIXED_HEADER <= bytes.len() {
        let header = header(source, at)?;
        let end = at + header.length;
        if end > bytes.len() {
            return Err(damaged(
                source,
                &format!("a data record of {} bytes at byte {at}", header.length),
                format!("{} bytes", bytes.len() - at),
            ));
        }
        if header.samples > 0 {
            let values = decode(source, &header, &bytes[at + header.data..end], at)?;
            let piece = Piece { rate: header.rate, start: header.start, values };
            pieces.entry(header.id).or_default().push(piece);
        }
        at = end;
    }
    if at != bytes.len() {
        return Err(damaged(
            source,
            &format!("a whole number of data records, the last of which ends at byte {at}"),
            format!("{} bytes in all", bytes.len()),
        ));
    }
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let mut stations: Vec<String> =
        pieces.keys().map(|id| format!("{}.{}", id.network, id.station)).collect();
    stations.dedup();
    record.station = stations.join(", ");
    keep_accelerometers(hints, &mut record, &mut pieces);
    for (id, pieces) in pieces {
        let trace = joined(source, &mut record, &id, pieces)?;
        let known = hints.instrument(&id, Some(trace.start));
        let sensitivity = known.map(|known| known.sensitivity).or_else(|| hints.sensitivity());
        let sensitivity = sensitivity.ok_or_else(|| {
            source.error(
                (),
                Refusal::Missing(Given::Sensitivity),
                format!("a sensitivity for channel {} (miniSEED holds counts)", id.channel),
                hints.no_instrument(&id, Some(trace.start)),
                "state the counts per m/s2 from the station's StationXML (InstrumentSensitivity)",
            )
        })?;
        let step = 1.0 / trace.rate;
        let values: Vec<f64> = trace.values.iter().map(|count| count / sensitivity).collect();
        let per = match hints.recorded().or(known.and_then(|known| known.quantity)) {
            Some(Quantity::Velocity) => "m/s",
            Some(Quantity::Displacement) => "m",
            Some(Quantity::Acceleration) | None => "m/s2",
        };
        let values = seed::as_acceleration(source, &mut record, hints, &id, known, step, values)?;
        record.notes.push(format!(
            "channel {}: counts divided by {sensitivity} counts per {per}, as given",
            id.channel
        ));
        let direction = known
            .and_then(|known| known.direction)
            .unwrap_or_else(|| Direction::parse(&id.channel));
        let station = format!("{}.{}", id.network, id.station);
        let mut channel = Channel::new(id.channel, direction, step, values);
        channel.start = Some(trace.start);
        channel.site = Site { station, sensor: id.location, ..Site::default() };
        if let Some(known) = known {
            known.complete(&mut channel.site);
        }
        record.channels.push(channel);
    }
    Ok(record)
}

/// Removes the channels of other sensors if the file contains channels of accelerometers.
fn keep_accelerometers(
    hints: &Hints<'_>,
    record: &mut Record,
    pieces: &mut BTreeMap<SeedName, Vec<Piece>>,
) {
    let is_accelerometer = |id: &SeedName, pieces: &[Piece]| {
        let known = hints.instrument(id, pieces.first().map(|piece| piece.start));
        seed::quantity(hints, id, known) == Some(Quantity::Acceleration)
    };
    if !pieces.iter().any(|(id, pieces)| is_accelerometer(id, pieces)) {
        return;
    }
    let mut names = Vec::new();
    pieces.retain(|id, pieces| {
        let kept = is_accelerometer(id, pieces);
        if !kept {
            names.push(id.channel.clone());
        }
        kept
    });
    if !names.is_empty() {
        let names = names.join(", ");
        record
            .warn(None, format!("channels not recorded by an accelerometer were ignored: {names}"));
    }
}

fn damaged(source: &Source<'_>, expected: &str, found: String) -> ReadError {
    source.damaged(
        (),
        expected,
        found,
        "the file is truncated or damaged; get it again from its source",
    )
}

fn two(bytes: &[u8], at: usize, big: bool) -> u16 {
    let pair = [bytes.get(at).copied().unwrap_or(0), bytes.get(at + 1).copied().unwrap_or(0)];
    if big { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) }
}

fn signed_pair(bytes: &[u8], at: usize, big: bool) -> f64 {
    f64::from(i16::from_ne_bytes(two(bytes, at, big).to_ne_bytes()))
}

fn header(source: &Source<'_>, at: usize) -> Result<Header, ReadError> {
    let bytes = &source.bytes[at..];
    // The year determines the byte order; there is no flag.
    let big = (1900..2200).contains(&two(bytes, 20, true));
    let year = two(bytes, 20, big);
    let day = two(bytes, 22, big);
    if !(1900..2200).contains(&year) || !(1..=366).contains(&day) {
        return Err(damaged(
            source,
            &format!("a data record header at byte {at}"),
            format!("year {year}, day {day}"),
        ));
    }
    let part = |from: usize, to: usize| latin1(&bytes[from..to]).trim().to_owned();
    // The location code is empty if it is blank or the placeholder "--".
    let location = Some(part(13, 15)).filter(|code| code != "--").unwrap_or_default();
    let id =
        SeedName { network: part(18, 20), station: part(8, 13), location, channel: part(15, 18) };
    let (hour, minute, second) = (bytes[24].into(), bytes[25].into(), f64::from(bytes[26]));
    let seconds = second + f64::from(two(bytes, 28, big)) * 1e-4;
    let Some(mut start) = Utc::ordinal(year.into(), day.into(), hour, minute, seconds) else {
        return Err(damaged(
            source,
            &format!("a start time in the data record at byte {at}"),
            format!("day {day} of {year}, {hour}:{minute}:{seconds}"),
        ));
    };
    let (factor, multiplier) = (signed_pair(bytes, 32, big), signed_pair(bytes, 34, big));
    let rate = if factor == 0.0 || multiplier == 0.0 {
        0.0
    } else {
        (if factor > 0.0 { factor } else { -1.0 / factor })
            * (if multiplier > 0.0 { multiplier } else { -1.0 / multiplier })
    };
    // Bit 1 of the activity flags is set if the time already includes the correction.
    if bytes[36] & 2 == 0 {
        start = start.later(1e-4 * f64::from(i32::from_be_bytes(order(&bytes[40..44], big))));
    }
    let mut encoding = None;
    let mut blockette = usize::from(two(bytes, 46, big));
    let mut count = 0;
    while blockette >= FIXED_HEADER && blockette + 8 <= bytes.len() && count < 16 {
        if two(bytes, blockette, big) == 1000 {
            encoding = Some((bytes[blockette + 4], bytes[blockette + 5], bytes[blockette + 6]));
        } else if two(bytes, blockette, big) == 1001 {
            start = start.later(1e-6 * f64::from(i8::from_ne_bytes([bytes[blockette + 5]])));
        }
        blockette = usize::from(two(bytes, blockette + 2, big));
        count += 1;
    }
    let Some((encoding, order, exponent)) = encoding else {
        return Err(damaged(source, "blockette 1000 in every data record", "none".to_owned()));
    };
    if !(7..=20).contains(&exponent) {
        return Err(damaged(source, "a record length of 2^7 to 2^20", format!("2^{exponent}")));
    }
    let (data, length) = (usize::from(two(bytes, 44, big)), 1_usize << exponent);
    let samples = usize::from(two(bytes, 30, big));
    if samples > 0 && (data < FIXED_HEADER || data >= length || rate <= 0.0) {
        return Err(damaged(
            source,
            "data that begin inside the data record, and a sampling rate above 0",
            format!("data at byte {data} of {length}, {rate} Hz"),
        ));
    }
    let big = order == 1;
    Ok(Header { id, samples, rate, start, data, length, encoding, big })
}

/// Joins the data records of one channel in the order of their times. Repeated data records are
/// ignored; a gap or an overlap is an error, because samples must not be invented.
///
/// The times are compared with the number of samples since the first data record, so that gaps
/// shorter than a sample cannot accumulate unnoticed. A recorder's clock may be fast or slow by up
/// to [`LARGEST_CLOCK_ERROR`].
fn joined(
    source: &Source<'_>,
    record: &mut Record,
    id: &SeedName,
    mut pieces: Vec<Piece>,
) -> Result<Trace, ReadError> {
    pieces.sort_by_key(|piece| piece.start);
    let found = pieces.len();
    pieces.dedup_by(|a, b| a.start == b.start && a.rate == b.rate && a.values == b.values);
    let channel = &id.channel;
    if pieces.len() < found {
        let repeated = found - pieces.len();
        record.warn(
            None,
            format!(
                "channel {channel}: {repeated} data records that repeat earlier ones were left out"
            ),
        );
    }
    let mut pieces = pieces.into_iter();
    let Some(Piece { rate, start, mut values }) = pieces.next() else {
        return Err(damaged(source, "a data record", "none".to_owned()));
    };
    let mut drift = 0.0_f64;
    for piece in pieces {
        if piece.rate != rate {
            return Err(source.damaged(
                (),
                format!("one sampling rate in channel {channel}"),
                format!("{rate} and {} Hz", piece.rate),
                "give the data records of one rate in a file of their own",
            ));
        }
        let (counted, stated) = (values.len() as f64 / rate, piece.start.since(start));
        let off = stated - counted;
        if off.abs() > (LARGEST_OFFSET / rate).max(LARGEST_CLOCK_ERROR * stated) {
            let what = if off > 0.0 { "gap" } else { "overlap" };
            return Err(source.damaged(
                (),
                format!("channel {channel} without gaps or overlaps"),
                format!(
                    "{what}s of {:.4} s in total up to {}: {} samples at {rate} Hz last \
                     {counted:.4} s, \
                     and the times of their data records span {stated:.4} s",
                    off.abs(),
                    piece.start,
                    values.len(),
                ),
                "get the record again without gaps, or cut the file into parts without gaps",
            ));
        }
        drift = if off.abs() > drift.abs() { off } else { drift };
        values.extend(piece.values);
    }
    if drift.abs() > LARGEST_OFFSET / rate {
        record.warn(
            None,
            format!(
                "channel {channel}: the times of its data records differ by up to {drift:.4} s from \
                 those of its samples at {rate} Hz, because the recorder's clock is inexact; the \
                 stated rate is used"
            ),
        );
    }
    Ok(Trace { rate, start, values })
}

fn decode(
    source: &Source<'_>,
    header: &Header,
    data: &[u8],
    at: usize,
) -> Result<Vec<f64>, ReadError> {
    let n = header.samples;
    let big = header.big;
    let fixed = |width: usize, convert: &dyn Fn(&[u8]) -> f64| -> Result<Vec<f64>, ReadError> {
        if data.len() < n * width {
            return Err(damaged(source, &format!("{n} samples"), format!("{} bytes", data.len())));
        }
        Ok(data.chunks_exact(width).take(n).map(convert).collect())
    };
    let values = match header.encoding {
        1 => fixed(2, &|b| f64::from(i16::from_be_bytes(order(b, big))))?,
        3 => fixed(4, &|b| f64::from(i32::from_be_bytes(order(b, big))))?,
        4 => fixed(4, &|b| f64::from(f32::from_be_bytes(order(b, big))))?,
        5 => fixed(8, &|b| f64::from_be_bytes(order(b, big)))?,
        10 | 11 => steim(data, n, header.encoding == 11, big).ok_or_else(|| {
            damaged(
                source,
                &format!("{n} Steim-compressed samples that end at the stated last value"),
                format!("a contradiction in the record at byte {at}"),
            )
        })?,
        other => {
            return Err(source.error(
                (),
                Refusal::Unrecognized,
                "encoding 1, 3, 4, 5, 10 or 11",
                other.to_string(),
                "convert the file to Steim-2 or to plain columns",
            ));
        }
    };
    match values.iter().position(|value| !value.is_finite()) {
        Some(k) => {
            Err(damaged(source, &format!("a finite sample {}", k + 1), values[k].to_string()))
        }
        None => Ok(values),
    }
}

/// Converts bytes from the given byte order to big-endian order.
fn order<const N: usize>(bytes: &[u8], big: bool) -> [u8; N] {
    let mut ordered = [0; N];
    ordered.copy_from_slice(&bytes[..N]);
    if !big {
        ordered.reverse();
    }
    ordered
}

/// Decodes Steim-1 and Steim-2 data.
///
/// The data are frames of 16 words that hold first differences. The first word of a frame has a
/// two-bit code for every word, which states how the differences in that word are packed.
fn steim(data: &[u8], samples: usize, second: bool, big: bool) -> Option<Vec<f64>> {
    let mut differences: Vec<i64> = Vec::with_capacity(samples);
    let (mut first, mut last) = (0_i64, 0_i64);
    for (index, frame) in data.chunks_exact(64).enumerate() {
        let word = |k: usize| u32::from_be_bytes(order(&frame[4 * k..4 * k + 4], big));
        let control = word(0);
        for k in 1..16 {
            let value = word(k);
            if index == 0 && k <= 2 {
                let constant = signed(value, 32);
                if k == 1 {
                    first = constant;
                } else {
                    last = constant;
                }
                continue;
            }
            let nibble = (control >> (30 - 2 * k)) & 3;
            let (count, bits) = match (nibble, second, value >> 30) {
                (0, _, _) => continue,
                (1, _, _) => (4, 8),
                (2, false, _) => (2, 16),
                (3, false, _) | (2, true, 0) => {
                    if second {
                        return None;
                    }
                    (1, 32)
                }
                (2, true, 1) => (1, 30),
                (2, true, 2) => (2, 15),
                (2, true, _) => (3, 10),
                (_, true, 0) => (5, 6),
                (_, true, 1) => (6, 5),
                (_, true, 2) => (7, 4),
                _ => return None,
            };
            for part in (0..count).rev() {
                differences.push(signed(value >> (part * bits), bits));
            }
        }
    }
    if differences.len() < samples || samples == 0 {
        return None;
    }
    // The first difference is relative to the last sample of the previous data record; it is not used.
    let mut value = first;
    let mut values = Vec::with_capacity(samples);
    values.push(value as f64);
    for difference in &differences[1..samples] {
        value = value.checked_add(*difference)?;
        values.push(value as f64);
    }
    (value == last).then_some(values)
}

/// Returns the lowest `bits` bits of a word as a signed number.
fn signed(word: u32, bits: u32) -> i64 {
    let shift = 64 - bits;
    #[expect(clippy::cast_possible_wrap, reason = "sign extension of two's complement")]
    let wide = (u64::from(word) << shift) as i64;
    wide >> shift
}
