//! Reader of CWA (formerly CWB) files from Taiwan: header lines that begin with `#`, then rows with the time and the
//! components in gal.
//!
//! Spec: header lines of the Taiwan Strong Motion Instrumentation Program text files;
//! `#DataSequence` states the order of the columns.

use super::even::{Timed, even_steps};
use super::source::{
    Columns, GAL, LARGEST_ACCELERATION, Source, leading_number, leading_printed, quoted,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "cwa", title: "CWA/CWB text (Taiwan)", sniff, read };

const MOST_HEADER_LINES: usize = 60;

fn sniff(source: &Source<'_>) -> bool {
    (0..MOST_HEADER_LINES).any(|line| source.text(line).starts_with("#DataSequence"))
}

fn field(source: &Source<'_>, key: &str) -> Option<(usize, String)> {
    source.field(MOST_HEADER_LINES, |text| text.strip_prefix(key))
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let need = |key: &str| source.needed(field(source, key), key);
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let (unit_line, unit) = need("#AmplitudeUnit:")?;
    if !unit.to_ascii_lowercase().starts_with("gal") {
        return Err(source.not_acceleration(
            unit_line,
            "gal as unit",
            quoted(&unit),
            "give the acceleration file of the same station",
        ));
    }
    // The key is "#Data:" with its colon; "#DataSequence:" is another line.
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
                "{} components, because {format} has one column for the time and one for each \
                 component",
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
            let used = super::check_seconds(source, &mut record, line, [seconds, rate], rows)?;
            for column in &mut values {
                column.truncate(used);
            }
        }
    }
    for (name, values) in names.into_iter().zip(values) {
        let plain = name.split('(').next().unwrap_or("").trim().to_owned();
        let mut direction = Direction::parse(&plain);
        if name.contains("(-)") && direction.orientation.is_some() {
            record.notes.push(format!("channel {plain} is marked (-) and was reversed"));
            direction.downward = true;
        }
        let mut channel = Channel::new(plain.clone(), direction, time_step, values);
        if let Some((_, text)) = field(source, &format!("#AmplitudeMAX. {plain}:")) {
            // Both extremes are stated, as in "0.658~   -0.837".
            let extremes = text.split('~').filter_map(|part| leading_printed(part.as_bytes()));
            let largest = extremes.max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
            channel.state_peak(largest, GAL);
        }
        record.channels.push(channel);
    }
    let stated = |key: &str| number(source, key).map(|(_, value)| value);
    let epicenter = stated("#EpicenterLatitude(N):").zip(stated("#EpicenterLongitude(E):"));
    let magnitudes = [("Mw", stated("#Magnitude(Mw):")), ("ML", stated("#Magnitude(Ml):"))];
    record.earthquake = Earthquake::of_magnitude(magnitudes).at(epicenter, stated("#Depth(km):"));
    let position = stated("#StationLatitude(N):").zip(stated("#StationLongitude(E):"));
    // Local time in Taiwan is UTC+8.
    let (line, stated) = field(source, "#StartTime(GMT+08):").unwrap_or_default();
    let local = Utc::in_header(&stated, DateOrder::DayFirst);
    record.warn_of_start(line, &stated, local);
    let start = local.map(|local| local.later(-8.0 * 3600.0));
    record.place(start, &Site::default().at(position));
    Ok(record)
}

fn number(source: &Source<'_>, key: &str) -> Option<(usize, f64)> {
    let (line, text) = field(source, key)?;
    leading_number(text.as_bytes()).map(|value| (line, value))
}
