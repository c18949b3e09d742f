//! Reader of USGS SMC files in cm/s²: corrected records at equal steps, and uncorrected records as
//! time and value pairs.
//!
//! A file has 11 text lines, 6 lines in the format 8I10, 10 lines in the format 5E15.7, comments,
//! and data in the format 8E10.4 without blanks between values. Spec: USGS National Strong-Motion
//! Program, "SMC-format data files" (smcfmt), and Converse and Brady 1992, USGS Open-File Report
//! 92-296A.

use super::even::{Timed, even_steps};
use super::source::{Columns, GAL, LARGEST_ACCELERATION, Source, latin1, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::utc::Utc;

pub(crate) const FORMAT: Format = Format { name: "smc", title: "USGS SMC", sniff, read };

const TEXT_LINES: usize = 11;
const INTEGER_LINES: usize = 6;
const REAL_LINES: usize = 10;
const COLUMNS: Columns = Columns { indent: 0, per_line: 8, width: 10 };

fn sniff(source: &Source<'_>) -> bool {
    let text = source.text(0).to_ascii_uppercase();
    let mut words = text.split_whitespace();
    let volume = words.next().unwrap_or("");
    volume.len() == 1
        && volume.chars().all(|c| c.is_ascii_digit())
        && words.next().is_some_and(|word| {
            ["UNCORRECTED", "CORRECTED", "VELOCITY", "DISPLACEMENT", "RESPONSE", "FOURIER"]
                .iter()
                .any(|known| word.starts_with(known))
        })
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let title = source.text(0).to_ascii_uppercase();
    if !title.contains("ACCELEROGRAM") {
        return Err(source.not_acceleration(
            0,
            "an accelerogram",
            quoted(&title),
            "give the acceleration file of the same record",
        ));
    }
    let stage = if title.contains("UNCORRECTED") { Stage::Raw } else { Stage::Corrected };
    let mut record = Record::new(FORMAT.name, source.name, stage);
    record.event = source.text(3);
    let end = source.find(5, "component").unwrap_or(41);
    let station = latin1(source.slice(5, 0, end));
    station.split_once('=').map_or("", |(_, name)| name).trim().clone_into(&mut record.station);
    let (integers, line) = source.fixed(TEXT_LINES, 8 * INTEGER_LINES, COLUMNS, f64::INFINITY)?;
    let (reals, line) = source.fixed(line, 5 * REAL_LINES, Columns::new(5, 15), f64::INFINITY)?;
    // Reals 3 to 8 of the format are the epicenter, the depth, and the moment, surface-wave and
    // local magnitudes; real 17 is the epicentral distance.
    let stated = |index: usize| reals.get(index).copied().filter(|value| value.abs() < 1e37);
    record.earthquake = Earthquake {
        epicentral_distance: stated(16),
        ..Earthquake::of_magnitude([("Mw", stated(5)), ("Ms", stated(6)), ("ML", stated(7))])
            .at(stated(2).zip(stated(3)), stated(4))
    };
    let known = |index: usize| Some(integers[index]).filter(|value| *value != integers[0]);
    let real = |index: usize| Some(reals[index]).filter(|value| value.abs() < 1e37);
    let comments = known(15).unwrap_or(0.0);
    let count =
        known(16).ok_or_else(|| missing(source, TEXT_LINES + 2, "integer 17, the count"))?;
    let count = super::whole(source, TEXT_LINES + 2, "a number of values", count)?;
    if !(0.0..=1e6).contains(&comments) {
        return Err(missing(source, TEXT_LINES + 1, "integer 16, the number of comment lines"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
    let data = line + comments as usize;
    for comment in line..data {
        if !source.text(comment).starts_with('|') {
            return Err(missing(source, comment, "a comment line that starts with \"|\""));
        }
    }
    let limit = LARGEST_ACCELERATION / GAL;
    let (numbers, next) = source.counted(&mut record, data, count, COLUMNS, limit)?;
    if next < source.lines.len() {
        record.warn(
            next + 1,
            format!("everything after the {count} values is ignored, from this line to the end"),
        );
    }
    let name = component(source);
    let (time_step, values) = if let Some(rate) = real(1).filter(|rate| *rate > 0.0) {
        (1.0 / rate, numbers)
    } else {
        let timed = Timed::of_pairs(data, COLUMNS, &numbers, 1e-4);
        let (step, mut columns) = even_steps(source, &mut record, &name, timed)?;
        (step, columns.pop().unwrap_or_default())
    };
    let direction = match known(13) {
        Some(azimuth) if (0.0..=360.0).contains(&azimuth) && known(12) != Some(0.0) => {
            Direction::horizontal(azimuth)
        }
        _ => Direction::parse(&name),
    };
    let values: Vec<f64> = values.iter().map(|value| value * GAL).collect();
    let mut channel = Channel::new(name, direction, time_step, values);
    // If the seconds and milliseconds are missing, the other integers state the time of the event,
    // so the start of the record is unknown.
    #[expect(clippy::cast_possible_truncation, reason = "saturates, and is checked then")]
    let whole = |index: usize| known(index).map(|value| value as i64);
    let clock = known(5).zip(known(6)).map(|(second, milli)| second + 1e-3 * milli);
    channel.start = (|| Utc::ordinal(whole(1)?, whole(2)?, whole(3)?, whole(4)?, clock?))();
    channel.site = Site::default().at(real(10).zip(real(11)));
    let peak = ["pk acc", "pk     "].iter().find_map(|key| source.printed_after(6, key));
    channel.state_peak(peak, GAL);
    record.channels.push(channel);
    for line in 0..TEXT_LINES {
        if source.has(line, "building") || source.has(line, "floor") {
            record
                .warn(line + 1, "the header mentions a building; this may not be a ground motion");
        }
    }
    Ok(record)
}

fn missing(source: &Source<'_>, line: usize, what: &str) -> ReadError {
    source.header(line.min(source.lines.len().saturating_sub(1)), what, quoted(&source.text(line)))
}

/// Parses the component, such as `component= 360` at column 42 of line 6.
fn component(source: &Source<'_>) -> String {
    let text = source.text(5);
    let lower = text.to_ascii_lowercase();
    lower
        .find("component")
        .and_then(|at| text.get(at + 9..))
        .map(|rest| rest.trim_start_matches([' ', '=']).trim().to_owned())
        .unwrap_or_default()
}
