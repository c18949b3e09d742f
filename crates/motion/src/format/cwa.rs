//! CWA (formerly CWB), Taiwan: `#` lines, then time and three components in gal, vertical first.
//!
//! Spec: header lines of the Taiwan Strong Motion Instrumentation Program text files; the order of
//! the columns stands in `#DataSequence`.

use super::even::{Timed, even_steps};
use super::source::{Columns, LARGEST_ACCELERATION, Source, leading_number, quoted, resolution};
use super::{Format, ReadOptions};
use crate::direction::Direction;
use crate::error::{ReadError, Refusal};
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "cwa", title: "CWA/CWB text (Taiwan)", sniff, read };

const GAL: f64 = 0.01;
const MOST_HEADER_LINES: usize = 60;

fn sniff(source: &Source<'_>) -> bool {
    (0..MOST_HEADER_LINES).any(|line| source.text(line).starts_with("#DataSequence"))
}

fn field(source: &Source<'_>, key: &str) -> Option<(usize, String)> {
    (0..MOST_HEADER_LINES).find_map(|line| {
        let text = source.text(line);
        text.strip_prefix(key).map(|rest| (line, rest.trim().to_owned()))
    })
}

#[expect(clippy::too_many_lines, reason = "one header, read from top to bottom")]
fn read(source: &Source<'_>, _: &ReadOptions) -> Result<Record, ReadError> {
    let need = |key: &str| {
        field(source, key)
            .ok_or_else(|| source.header((), format!("a header line \"{key}\""), "none"))
    };
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let (unit_line, unit) = need("#AmplitudeUnit:")?;
    if !unit.to_ascii_lowercase().starts_with("gal") {
        return Err(source.error(
            unit_line,
            Refusal::NotAcceleration,
            "gal as unit",
            quoted(&unit),
            "give the acceleration file of the same station",
        ));
    }
    // "#Data:" with its colon; "#DataSequence:" is another line.
    let (format_line, format) = need("#Data:")?;
    let columns = Columns::parse(&format).ok_or_else(|| {
        source.header(format_line, "a Fortran format such as 4F10.3", quoted(&format))
    })?;
    let (sequence_line, sequence) = need("#DataSequence:")?;
    let names: Vec<String> = sequence
        .replace("Time", "")
        .split(';')
        .map(|part| part.trim().to_owned())
        .filter(|part| !part.is_empty())
        .collect();
    if names.len() + 1 != columns.per_line {
        return Err(source.header(
            sequence_line,
            format!(
                "{} components, as {format} has time and one column each",
                columns.per_line - 1
            ),
            quoted(&sequence),
        ));
    }
    let limit = LARGEST_ACCELERATION / GAL;
    let mut time = Vec::new();
    let mut values = vec![Vec::new(); names.len()];
    for line in format_line + 1..source.lines.len() {
        let (row, _) = source.fixed(line, columns.per_line, columns, limit)?;
        time.push(row[0]);
        for (column, value) in values.iter_mut().zip(&row[1..]) {
            column.push(value * GAL);
        }
    }
    record.station = format!(
        "{} {}",
        field(source, "#StationCode:").map(|(_, text)| text).unwrap_or_default(),
        field(source, "#StationName:").map(|(_, text)| text).unwrap_or_default()
    );
    record.event = field(source, "#Origin Time").map(|(_, text)| text).unwrap_or_default();
    let rows = time.len();
    let timed = Timed { first_line: format_line + 1, per_line: 1, time, values, resolution: 0.001 };
    let (mut time_step, mut values) = even_steps(source, &mut record, "all", timed)?;
    if let Some((line, rate)) = number(source, "#SampleRate(Hz):") {
        if (rate * time_step - 1.0).abs() < 1e-3 {
            time_step = 1.0 / rate;
        } else {
            record.warn(
                line + 1,
                format!(
                    "the header states {rate} Hz, the time column has a step of {time_step} s; \
                         the time column is used"
                ),
            );
        }
        if let Some((line, seconds)) = number(source, "#RecordLength(sec):") {
            let stated = (seconds * rate).round();
            let stated = super::whole(source, line, "a record length", stated)?;
            // Whole seconds are stated; up to one second more or less is rounding.
            if (rows as f64 - stated as f64).abs() > rate {
                let used = super::check_count(source, &mut record, line, stated, rows)?;
                for column in &mut values {
                    column.truncate(used);
                }
            } else if rows != stated {
                record.warn(
                    line + 1,
                    format!("the header states {stated} rows, the file holds {rows}"),
                );
            }
        }
    }
    for (name, values) in names.into_iter().zip(values) {
        let plain = name.split('(').next().unwrap_or("").trim().to_owned();
        let mut direction = Direction::parse(&plain);
        if name.contains("(-)") && direction.orientation.is_some() {
            record.notes.push(format!("channel {plain} is stated as negative and was turned"));
            direction.downward = true;
        }
        let mut channel = Channel::new(plain.clone(), direction, time_step, values);
        if let Some((_, text)) = field(source, &format!("#AmplitudeMAX. {plain}:")) {
            // Both extremes are stated: "0.658~   -0.837".
            let extremes = text.split('~').filter_map(|part| leading_number(part.as_bytes()));
            if let Some((value, digits)) = extremes.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) {
                channel.state_peak(value, resolution(&digits), GAL);
            }
        }
        record.channels.push(channel);
    }
    let stated = |key: &str| number(source, key).map(|(_, value)| value);
    let position = stated("#StationLatitude(N):").zip(stated("#StationLongitude(E):"));
    // Taiwan is eight hours ahead.
    let start = field(source, "#StartTime(GMT+08):")
        .and_then(|(_, text)| Utc::in_header(&text, DateOrder::DayFirst))
        .map(|local| local.later(-8.0 * 3600.0));
    record.place(start, &Site::default().at(position));
    Ok(record)
}

fn number(source: &Source<'_>, key: &str) -> Option<(usize, f64)> {
    let (line, text) = field(source, key)?;
    leading_number(text.as_bytes()).map(|(value, _)| (line, value))
}
