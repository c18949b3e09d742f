//! Reader of uncorrected (V1A) and corrected (V2A) accelerograms of GeoNet, New Zealand. Values are in mm/s², mm/s and
//! mm.
//!
//! A component has 16 text lines, 10 lines of ten numbers, each 8 characters wide, then blocks of
//! data in the same columns; V2A files include the filter pads. Spec: GeoNet, "Strong motion
//! data, file formats" (GNS Science).

use super::source::{Columns, LARGEST_ACCELERATION, Source, quoted};
use super::{Format, Hints};
use crate::direction::Direction;
use crate::earthquake::Earthquake;
use crate::error::ReadError;
use crate::math;
use crate::record::{Channel, Quantity, Record, Stage};
use crate::site::{Site, position};
use crate::utc::Utc;

pub(crate) const FORMAT: Format =
    Format { name: "geonet", title: "GeoNet V1A and V2A (New Zealand)", sniff, read };

const TEXT_LINES: usize = 16;
const NUMBER_LINES: usize = 10;
const COLUMNS: Columns = Columns { indent: 0, per_line: 10, width: 8 };
const MILLIMETER: f64 = 0.001;

fn sniff(source: &Source<'_>) -> bool {
    (source.has(0, "corrected accelerogram") && source.text(1).starts_with("Site "))
        || source.has(0, "GNS Science")
}

fn read(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let raw = source.has(0, "uncorrected");
    let stage = if raw { Stage::Raw } else { Stage::Corrected };
    let mut record = Record::new(FORMAT.name, source.name, stage);
    record.station = source.text(2);
    record.event = source.text(6);
    source.each_block(|line| read_component(source, &mut record, line))?;
    Ok(record)
}

fn read_component(
    source: &Source<'_>,
    record: &mut Record,
    first: usize,
) -> Result<usize, ReadError> {
    if !source.has(first, "corrected accelerogram") {
        return Err(source.damaged(first,
            "\"Corrected accelerogram\" or \"Uncorrected accelerogram\" at the start of a component",
            quoted(&source.text(first)),
            "a header states a different number of points than the file contains; get the file again \
             from its source",
        ));
    }
    let corrected = !source.has(first, "uncorrected");
    let numbers = first + TEXT_LINES;
    let (header, mut line) = source.fixed(numbers, 10 * NUMBER_LINES, COLUMNS, f64::INFINITY)?;
    let cell = |row: usize, column: usize| header[10 * (row - 1) + column - 1];
    let count_of =
        |column: usize| super::whole(source, numbers + 3, "a number of points", cell(4, column));
    let time_step = cell(7, 6);
    let limit = LARGEST_ACCELERATION / MILLIMETER;
    let count = count_of(if corrected { 4 } else { 1 })?;
    let (mut values, next) = source.fixed(line, count, COLUMNS, limit)?;
    line = next;
    for value in &mut values {
        *value *= MILLIMETER;
    }
    let text = source.text(first + 12);
    let name = text
        .strip_prefix("Component")
        .unwrap_or(&text)
        .split_whitespace()
        .next()
        .unwrap_or("")
        .to_owned();
    let mut channel = Channel::new(name.clone(), Direction::parse(&name), time_step, values);
    // Time zero is given as year and month, day and hour, minute and milliseconds. A corrected
    // record begins earlier, with the filter pad.
    #[expect(clippy::cast_possible_truncation, reason = "saturates, and is checked then")]
    let whole = |row: usize, column: usize| cell(row, column) as i64;
    let zero = Utc::new(
        whole(1, 9),
        whole(1, 10),
        whole(2, 9),
        whole(2, 10),
        whole(4, 9),
        1e-3 * cell(4, 10),
    );
    channel.start = zero.map(|zero| zero.later(-cell(7, 2)));
    channel.site = Site::default().at(position(&source.text(first + 1)));
    // Example: "Epicentre 42 41 33S 173 01 19E  Bearing S18W  Dist    9km  Depth   15km Mw 7.82".
    let origin = source.text(first + 8);
    let place = first + 8;
    record.earthquake = Earthquake {
        epicentral_distance: source.number_after(place, "Dist "),
        ..Earthquake::of_magnitude([
            ("Mw", source.number_after(place, "Mw ")),
            ("ML", source.number_after(place, "ML ")),
        ])
        .at(origin.split("Bearing").next().and_then(position), source.number_after(place, "Depth "))
    };
    let mut measured = vec![(Quantity::Acceleration, math::peak(&channel.acceleration))];
    if corrected {
        for (column, quantity) in [(5, Quantity::Velocity), (6, Quantity::Displacement)] {
            if cell(4, column) > 0.0 {
                let (block, next) = source.fixed(line, count_of(column)?, COLUMNS, 1e9)?;
                line = next;
                measured.push((quantity, MILLIMETER * math::peak(&block)));
            }
        }
    }
    for (k, (quantity, measured)) in measured.into_iter().enumerate() {
        let stated = source.printed_after(first + 13 + k, "peak");
        channel.state(quantity, stated, MILLIMETER, measured);
    }
    if record.channels.iter().any(|other| other.name == name) {
        channel.name = format!("{name} ({})", record.channels.len() + 1);
        record.warn(first + 13, format!("two components are named {name}; the second is renamed"));
    }
    record.channels.push(channel);
    Ok(line)
}
