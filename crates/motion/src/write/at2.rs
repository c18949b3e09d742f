//! Writes PEER AT2 files: one component in g, five numbers per line.
//!
//! Spec: header lines of files from NGA and NGA-West2; the sources are stated in the reader, `format::peer`.

use std::fmt::Write as _;

use crate::direction::{Direction, Orientation};
use crate::error::MotionError;
use crate::math::STANDARD_GRAVITY;
use crate::record::{Channel, Record};

/// Placeholder for a missing event name.
pub(crate) const NO_EVENT: &str = "EVENT NOT STATED";
/// Placeholder for a missing station name.
pub(crate) const NO_STATION: &str = "STATION NOT STATED";

/// Length (characters) of the longest name that readers accept as a component. Readers interpret a longer name as a
/// part of the event name.
const LONGEST_NAME: usize = 12;

/// Writes a record of one channel as PEER AT2, in g with eight significant digits.
///
/// The four header lines are the provenance; the event, station and component; the quantity and
/// unit; and the number of samples and the time step (s) at full precision. Commas, parentheses and some
/// words that readers of the format would interpret are replaced.
///
/// ```
/// use barrelstack_motion::{ReadOptions, bundled, read, write};
/// let mut napa = bundled("napa-college-2014").unwrap();
/// napa.channels.truncate(1);
/// let file = write::at2(&napa)?;
/// let again = read(file.as_bytes(), "copy.at2", &ReadOptions::default()).unwrap();
/// assert!((again.channels[0].pga() / napa.channels[0].pga() - 1.0).abs() < 5e-8);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
///
/// # Errors
/// If the record does not have exactly one channel.
pub fn at2(record: &Record) -> Result<String, MotionError> {
    let [channel] = record.channels.as_slice() else {
        let names = super::names(&record.channels).join(", ");
        return Err(MotionError::Parameter {
            what: "components for AT2".to_owned(),
            expected: "one, because AT2 holds a single component".to_owned(),
            found: format!("{} ({names})", record.channels.len()),
        });
    };
    let mut title = String::from("WRITTEN BY BARRELSTACK");
    for note in super::provenance(record) {
        let _ = write!(title, "; {note}");
    }
    if channel.initial_velocity != 0.0 {
        let _ = write!(title, "; starts with {:e} m/s", channel.initial_velocity);
    }
    let or = |text: &str, missing: &str| {
        let plain = harmless(text);
        if plain.is_empty() { missing.to_owned() } else { plain }
    };
    let a = &channel.acceleration;
    let mut text = format!(
        "{}\n{}, {}, {}\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {}, DT= {} SEC\n",
        harmless(&title),
        or(&record.event, NO_EVENT),
        or(&record.station, NO_STATION),
        component(channel),
        a.len(),
        channel.time_step,
    );
    for row in a.chunks(5) {
        for value in row {
            text.push_str(&number(value / STANDARD_GRAVITY));
        }
        text.push('\n');
    }
    Ok(text)
}

/// Replaces characters and words that readers would mistake for parts of the header.
fn harmless(text: &str) -> String {
    const OWN: [&str; 5] = ["SPECTR", "UNITS", "VELOCITY", "DISPLACEMENT", "ACCEL"];
    let plain = super::line(text).replace(',', ";").replace(['(', ')'], "");
    let broken = super::broken(&super::broken(&plain, &OWN), &super::FOREIGN);
    broken.chars().map(|c| if c.is_ascii() { c } else { '?' }).collect()
}

/// Returns the component name for the header.
///
/// This is the channel name if it has at most [`LONGEST_NAME`] characters and [`Direction::parse`] derives the
/// direction of the channel from it; otherwise, it is the azimuth or `UP`. A channel that has no azimuth and is not
/// known to be vertical keeps its name, cut to [`LONGEST_NAME`] characters.
fn component(channel: &Channel) -> String {
    let name = harmless(&channel.name);
    let fits = !name.is_empty() && name.len() <= LONGEST_NAME;
    if fits && Direction::parse(&name) == channel.direction {
        return name;
    }
    match (channel.direction.azimuth, channel.direction.orientation) {
        (Some(azimuth), _) => format!("{azimuth:.1}").trim_end_matches(".0").to_owned(),
        (None, Some(Orientation::Vertical)) => "UP".to_owned(),
        _ if fits => name,
        _ => name.chars().take(LONGEST_NAME).collect::<String>().trim().to_owned(),
    }
}

/// Formats a number like `%15.7E` in C; numbers too small for a two-digit exponent become zero.
fn number(value: f64) -> String {
    let value = if value.abs() < 1e-98 { 0.0 } else { value };
    let text = format!("{value:.7e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |d| ('-', d));
    format!("{:>15}", format!("{mantissa}E{sign}{digits:0>2}"))
}
