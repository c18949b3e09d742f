//! Reader of ESM and ITACA ASCII files (DYNA 1.2): `KEY: value` lines, then one value per line.
//!
//! Spec: Luzi et al. 2016, "Engineering Strong-Motion database, format DYNA 1.2" (INGV).

use super::source::{
    GAL, LARGEST_ACCELERATION, Source, leading_number, leading_printed, parse_number, quoted,
};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::units::AccelerationUnit;
use crate::utc::{DateOrder, Utc};

pub(crate) const FORMAT: Format = Format { name: "esm", title: "ESM and ITACA ASCII", sniff, read };

/// Largest number of header lines that are searched.
const MOST_HEADER_LINES: usize = 120;

fn sniff(source: &Source<'_>) -> bool {
    source.text(0).starts_with("EVENT_NAME:")
        || ((0..20).any(|line| source.text(line).starts_with("STATION_CODE:"))
            && (0..MOST_HEADER_LINES).any(|line| source.text(line).starts_with("NDATA:")))
}

/// Returns the line and the value of a key, if present; the value may contain colons.
fn field(source: &Source<'_>, end: usize, key: &str) -> Option<(usize, String)> {
    let found = source.field(end, |text| {
        text.split_once(':').filter(|(name, _)| name.trim() == key).map(|(_, value)| value)
    });
    found.filter(|(_, value)| !value.is_empty())
}

/// Parses a start time such as `20190728_160905.700`, or `2020/10/30 11:51:24.000000` as written by
/// AFAD's TADAS.
fn start(text: &str) -> Option<Utc> {
    let compact = || {
        let (date, clock) = text.split_once('_')?;
        let whole = |part: Option<&str>| part?.parse::<i64>().ok();
        Utc::new(
            whole(date.get(..4))?,
            whole(date.get(4..6))?,
            whole(date.get(6..8))?,
            whole(clock.get(..2))?,
            whole(clock.get(2..4))?,
            clock.get(4..)?.parse().ok()?,
        )
    };
    compact().or_else(|| Utc::in_header(text, DateOrder::DayFirst))
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let end = (0..source.lines.len().min(MOST_HEADER_LINES))
        .find(|&line| parse_number(source.raw(line)).is_some())
        .ok_or_else(|| source.cut("values after the header", "none"))?;
    let need = |key: &str| source.needed(field(source, end, key), key);
    let number = |key: &str| {
        let (line, text) = need(key)?;
        leading_number(text.as_bytes())
            .map(|value| (line, value))
            .ok_or_else(|| source.header(line, format!("a number for {key}"), quoted(&text)))
    };
    let (line, data_type) = need("DATA_TYPE")?;
    if !data_type.eq_ignore_ascii_case("ACCELERATION") {
        return Err(source.not_acceleration(
            line,
            "DATA_TYPE: ACCELERATION",
            quoted(&data_type),
            "give the .ACC.ASC file of the same component",
        ));
    }
    let (line, text) = need("UNITS")?;
    let unit: AccelerationUnit = text.parse().map_err(|_| {
        source.not_acceleration(
            line,
            "a unit of acceleration, such as cm/s^2",
            quoted(&text),
            "give the .ACC.ASC file of the same component",
        )
    })?;
    let (count_line, count) = number("NDATA")?;
    let count = super::whole(source, count_line, "a number of values", count)?;
    let (_, time_step) = number("SAMPLING_INTERVAL_S")?;
    let text = |key: &str| field(source, end, key).map(|(_, value)| value).unwrap_or_default();
    let filtered = !text("FILTER_TYPE").is_empty() && text("FILTER_TYPE") != "NONE";
    let stage = if filtered || text("BASELINE_CORRECTION") == "BASELINE REMOVED" {
        Stage::Corrected
    } else {
        Stage::Raw
    };
    let mut record = Record::new(FORMAT.name, source.name, stage);
    record.event = text("EVENT_NAME");
    let stated = |key: &str| leading_number(text(key).as_bytes());
    record.earthquake = Earthquake {
        id: text("EVENT_ID"),
        epicentral_distance: stated("EPICENTRAL_DISTANCE_KM"),
        ..Earthquake::of_magnitude([("Mw", stated("MAGNITUDE_W")), ("ML", stated("MAGNITUDE_L"))])
            .at(
                stated("EVENT_LATITUDE_DEGREE").zip(stated("EVENT_LONGITUDE_DEGREE")),
                stated("EVENT_DEPTH_KM"),
            )
    };
    record.station = format!("{} {}", text("STATION_CODE"), text("STATION_NAME"));
    let limit = LARGEST_ACCELERATION / unit.factor();
    let mut values = Vec::with_capacity(source.lines.len() - end);
    for line in end..source.lines.len() {
        let value = parse_number(source.raw(line))
            .ok_or_else(|| source.bad_number(line, 0, source.raw(line)))?;
        let value = source.within(line, 0, value, limit)?;
        values.push(value * unit.factor());
    }
    let used = super::check_count(source, &mut record, count_line, count, values.len())?;
    values.truncate(used);
    let name = text("STREAM");
    let mut channel = Channel::new(name.clone(), Direction::parse(&name), time_step, values);
    if let Some((line, text)) = field(source, end, "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS") {
        channel.start = start(&text);
        record.warn_of_start(line, &text, channel.start);
    }
    let number = |key: &str| leading_number(text(key).as_bytes());
    channel.site = Site {
        sensor: text("LOCATION"),
        elevation: number("STATION_ELEVATION_M"),
        vs30: number("VS30_M/S").or(number("VS30_M/SEC")).filter(|speed| *speed > 0.0),
        ..Site::default()
    }
    .at(number("STATION_LATITUDE_DEGREE").zip(number("STATION_LONGITUDE_DEGREE")));
    channel.state_peak(leading_printed(text("PGA_CM/S^2").as_bytes()), GAL);
    if text("LATE/NORMAL_TRIGGERED").eq_ignore_ascii_case("LT") {
        record.warn(None, "late-triggered record: its beginning is missing");
    }
    record.channels.push(channel);
    Ok(record)
}
