//! Reader of K-NET and KiK-net files (NIED, Japan): one component in counts, with a scale factor
//! and a large offset.
//!
//! The offset, which is often larger than the motion, is the mean of the whole record. The peak in
//! the header refers to the motion without the offset. Spec: NIED, "K-NET ASCII format" (knetform).

use super::source::{
    Columns, GAL, LARGEST_ACCELERATION, Source, leading_number, leading_printed, quoted,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::math;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "knet", title: "K-NET and KiK-net (NIED)", sniff, read };

const HEADER_LINES: usize = 17;
/// Time (s) to subtract from the stated record time to obtain the time of the first sample in UTC:
/// the delay of the recorder (15 s) and the offset of Japan time (9 h).
const LATE: f64 = 15.0 + 9.0 * 3600.0;

fn sniff(source: &Source<'_>) -> bool {
    source.text(0).starts_with("Origin Time")
        && (0..HEADER_LINES).any(|line| source.has(line, "Scale Factor"))
}

/// Returns the line and the text of a header field, found by the start of its key.
fn field(source: &Source<'_>, key: &str) -> Option<(usize, String)> {
    source.field(HEADER_LINES + 2, |text| {
        text.starts_with(key).then(|| text.get(18..).unwrap_or_default())
    })
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let need = |key: &str| source.needed(field(source, key), key);
    let bad =
        |line: usize, expected: &str, text: &str| source.header((line, 18), expected, quoted(text));
    record.event = format!("{} (Japan time)", need("Origin Time")?.1);
    record.station = need("Station Code")?.1;
    let (line, text) = need("Sampling Freq")?;
    let rate = leading_number(text.as_bytes())
        .filter(|rate| *rate > 0.0)
        .ok_or_else(|| bad(line, "a sampling frequency such as 100Hz", &text))?;
    let (line, text) = need("Scale Factor")?;
    let factor = scale(&text)
        .ok_or_else(|| bad(line, "a scale factor such as 3920(gal)/6182761", &text))?
        * GAL;
    let (_, direction_text) = need("Dir.")?;
    let (name, direction, borehole) = direction(&direction_text);
    let first = field(source, "Memo").map_or(HEADER_LINES, |(line, _)| line + 1);
    let counts = read_counts(source, first, LARGEST_ACCELERATION / factor)?;
    let mut used = counts.len();
    let (duration_line, duration) = need("Duration")?;
    // Some files state no duration, or zero.
    if let Some(seconds) = leading_number(duration.as_bytes()).filter(|s| *s > 0.0) {
        let length = [seconds, rate];
        used = super::check_seconds(source, &mut record, duration_line, length, counts.len())?;
    }
    let mut values: Vec<f64> = counts[..used].iter().map(|count| count * factor).collect();
    let offset = math::take_mean(&mut values);
    record.notes.push(format!(
        "channel {name}: offset of {:.3} cm/s2, the mean of the whole record, removed as the \
         format prescribes",
        offset / GAL
    ));
    let lower = source.name.to_ascii_lowercase();
    let borehole = borehole || ["ns1", "ew1", "ud1"].iter().any(|end| lower.ends_with(end));
    if borehole {
        record.warn(None, "this is the borehole sensor, not the ground surface");
    }
    let mut channel = Channel::new(name, direction, 1.0 / rate, values);
    let (line, stated) = field(source, "Record Time").unwrap_or_default();
    let late = Utc::in_header(&stated, DateOrder::DayFirst);
    record.warn_of_start(line, &stated, late);
    channel.start = late.map(|late| late.later(-LATE));
    let number =
        |key: &str| field(source, key).and_then(|(_, text)| leading_number(text.as_bytes()));
    channel.site = Site {
        sensor: if borehole { "borehole" } else { "surface" }.to_owned(),
        // -9999 means unknown.
        elevation: number("Station Height").filter(|height| *height > -9000.0),
        ..Site::default()
    }
    .at(number("Station Lat.").zip(number("Station Lon")));
    record.earthquake = Earthquake::of_magnitude([("MJMA", number("Mag."))])
        .at(number("Lat.").zip(number("Long.")), number("Depth."));
    let peak = field(source, "Max").and_then(|(_, text)| leading_printed(text.as_bytes()));
    channel.state_peak(peak, GAL);
    record.channels.push(channel);
    Ok(record)
}

/// Reads lines of eight integers, each nine characters wide; the last line may be shorter.
fn read_counts(source: &Source<'_>, first: usize, limit: f64) -> Result<Vec<f64>, ReadError> {
    let last = source.lines.len();
    let mut values = Vec::with_capacity(8 * last.saturating_sub(first));
    for line in first..last {
        let filled = source.raw(line).trim_ascii_end().len();
        let fields = if line + 1 == last { filled.div_ceil(9).min(8) } else { 8 };
        let (mut row, _) = source.fixed(line, fields, Columns::new(8, 9), limit)?;
        values.append(&mut row);
    }
    Ok(values)
}

/// Parses a scale factor such as `3920(gal)/6182761`; returns gal per count.
fn scale(text: &str) -> Option<f64> {
    let (full, counts) = text.split_once('/')?;
    let unit = full.find("(gal)")?;
    let full: f64 = full[..unit].trim().parse().ok()?;
    let counts: f64 = counts.trim().parse().ok()?;
    let factor = full / counts;
    (factor.is_finite() && factor > 0.0).then_some(factor)
}

/// Parses a direction. Returns the name of the channel, the direction, and `true` if the number
/// identifies a borehole sensor.
///
/// In K-NET files, the direction is a name. In KiK-net files, it is a number: 1 to 3 in the
/// borehole, 4 to 6 at the surface.
fn direction(text: &str) -> (String, Direction, bool) {
    let (name, borehole) = match text.trim() {
        "1" => ("N-S", true),
        "2" => ("E-W", true),
        "3" => ("U-D", true),
        "4" => ("N-S", false),
        "5" => ("E-W", false),
        "6" => ("U-D", false),
        other => (other, false),
    };
    let label = if borehole { format!("{name} borehole") } else { name.to_owned() };
    (label, Direction::parse(name), borehole)
}
