//! Reader of AFAD files (Turkey): `KEY : value` lines and three columns in gal.
//!
//! Spec: header lines of the Turkish National Strong Motion Network (NSMN) text files.

use super::source::{
    GAL, LARGEST_ACCELERATION, Source, latin1, leading_number, leading_printed, shorten,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::{Site, position};
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format =
    Format { name: "afad", title: "AFAD and NSMN text (Turkey)", sniff, read };

const MOST_HEADER_LINES: usize = 40;

fn sniff(source: &Source<'_>) -> bool {
    source.has(0, "STRONG GROUND MOTION RECORDS OF TUR")
        || (0..MOST_HEADER_LINES).any(|line| source.has(line, "RAW PGA VALUES"))
}

fn field(source: &Source<'_>, key: &str) -> Option<(usize, String)> {
    source.field(MOST_HEADER_LINES, |text| {
        let (name, value) = text.split_once(':')?;
        name.trim().starts_with(key).then_some(value)
    })
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let number = |key: &str| {
        let (line, text) = field(source, key).unzip();
        let value = text.as_ref().and_then(|text| leading_number(text.as_bytes()));
        line.zip(value).ok_or_else(|| {
            let found = text.map_or("none".to_owned(), |text| format!("\"{text}\""));
            source.header(line, format!("a number for \"{key}\""), found)
        })
    };
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    let (count_line, count) = number("NUMBER OF DATA")?;
    let count = super::whole(source, count_line, "a number of values", count)?;
    let (_, time_step) = number("SAMPLING INTERVAL")?;
    record.event = field(source, "EARTHQUAKE DATE").map(|(_, text)| text).unwrap_or_default();
    let place = field(source, "PLACE").map(|(_, text)| text).unwrap_or_default();
    let station = field(source, "STATION ID").map(|(_, text)| text).unwrap_or_default();
    record.station = format!("{station} {place}");
    let names_line = (0..MOST_HEADER_LINES)
        .find(|&line| !source.has(line, ":") && source.has(line, "N-S") && source.has(line, "E-W"))
        .ok_or_else(|| source.header((), "a line of column names, N-S, E-W and U-D", "none"))?;
    let text = source.text(names_line);
    let names: Vec<&str> = text.split_whitespace().collect();
    let limit = LARGEST_ACCELERATION / GAL;
    let first = names_line + 1;
    let mut columns = super::rows(source, first, source.lines.len(), names.len(), limit)?;
    let found = columns.first().map_or(0, Vec::len);
    let used = super::check_count(source, &mut record, count_line, count, found)?;
    let peaks = field(source, "RAW PGA VALUES").map(|(_, text)| text).unwrap_or_default();
    for (name, column) in names.iter().zip(&mut columns) {
        let values: Vec<f64> = column[..used].iter().map(|value| value * GAL).collect();
        let mut channel = Channel::new(*name, Direction::parse(name), time_step, values);
        let stated = peaks
            .split_once(&format!("({name})"))
            .and_then(|(_, rest)| leading_printed(rest.as_bytes()));
        channel.state_peak(stated, GAL);
        record.channels.push(channel);
    }
    let text = |key: &str| field(source, key).map(|(_, text)| text).unwrap_or_default();
    let stated = |key: &str| leading_number(text(key).as_bytes());
    let magnitude = text("EARTHQUAKE MAGNITUDE");
    let scale = magnitude.split_whitespace().nth(1).unwrap_or_default();
    record.earthquake = Earthquake::of_magnitude([(scale, stated("EARTHQUAKE MAGNITUDE"))])
        .at(position(&text("EPICENTER COORDINATES")), stated("EARTHQUAKE DEPTH"));
    let site = Site {
        elevation: stated("STATION ALTITUDE"),
        vs30: stated("VS30").filter(|speed| *speed > 0.0),
        ..Site::default()
    };
    let (line, stated) = field(source, "RECORD TIME").unwrap_or_default();
    let start = Utc::in_header(&stated, DateOrder::DayFirst);
    record.warn_of_start(line, &stated, start);
    record.place(start, &site.at(position(&text("STATION COORDINATES"))));
    if !latin1(source.bytes.get(..4000).unwrap_or(source.bytes)).contains("(gal)") {
        record.warn(
            None,
            format!(
                "the header does not state \"(gal)\"; cm/s2, the unit of this format, was assumed (\"{}\")",
                shorten(&source.text(0))
            ),
        );
    }
    Ok(record)
}
