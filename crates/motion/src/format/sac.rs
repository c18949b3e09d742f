//! Reader of SAC binary files: a header of 158 words and one component. The caller must provide the
//! unit.
//!
//! Spec: SAC users manual, "SAC data file format", header versions 6 and 7. Version 7 has a footer
//! of 22 numbers in double precision; the first of them is the step.

use super::source::{Source, latin1};
use super::{Format, Hints, seed};
use crate::direction::{Direction, Orientation};
use crate::earthquake::Earthquake;
use crate::error::{Given, ReadError, Refusal};
use crate::instrument::SeedName;
use crate::record::{Channel, Record, Stage};
use crate::site::Site;
use crate::units::AccelerationUnit;
use crate::utc::Utc;

pub(crate) const FORMAT: Format = Format { name: "sac", title: "SAC binary", sniff, read };

const HEADER_BYTES: usize = 632;
/// Length of the footer in version 7 (bytes).
const FOOTER_BYTES: usize = 176;
const UNDEFINED: f64 = -12345.0;
/// Index of the header word with the version. Other words used here are 79 (number of points), 85
/// (file type, where 1 is a time series) and 105 (evenly spaced).
const VERSION: usize = 76;
const POINTS: usize = 79;
const FILE_TYPE: usize = 85;
const DEPENDENT: usize = 86;
const EVEN: usize = 105;
const TIME_SERIES: i32 = 1;

fn word(bytes: &[u8], index: usize, big: bool) -> Option<[u8; 4]> {
    let mut four: [u8; 4] = bytes.get(4 * index..4 * index + 4)?.try_into().ok()?;
    if big {
        four.reverse();
    }
    Some(four)
}

fn integer(bytes: &[u8], index: usize, big: bool) -> i32 {
    word(bytes, index, big).map_or(-12345, i32::from_le_bytes)
}

fn real(bytes: &[u8], index: usize, big: bool) -> Option<f64> {
    word(bytes, index, big)
        .map(|four| f64::from(f32::from_le_bytes(four)))
        .filter(|v| *v != UNDEFINED)
}

fn byte_order(bytes: &[u8]) -> Option<bool> {
    if bytes.len() < HEADER_BYTES {
        return None;
    }
    [false, true].into_iter().find(|&big| {
        [6, 7].contains(&integer(bytes, VERSION, big))
            && (-12345..=100).contains(&integer(bytes, FILE_TYPE, big))
    })
}

fn sniff(source: &Source<'_>) -> bool {
    byte_order(source.bytes).is_some()
}

#[expect(clippy::too_many_lines, reason = "one header, read from top to bottom")]
fn read(source: &Source<'_>, hints: &Hints<'_>) -> Result<Record, ReadError> {
    let bytes = source.bytes;
    let big = byte_order(bytes).ok_or_else(|| {
        source.error(
            (),
            Refusal::Unrecognized,
            "a SAC header of version 6 or 7, 632 bytes",
            format!("{} bytes of other data", bytes.len()),
            "give a binary SAC file",
        )
    })?;
    let damaged = |expected: &str, found: String| {
        source.damaged(
            (),
            expected,
            found,
            "the file is truncated or damaged; get it again from its source",
        )
    };
    if integer(bytes, FILE_TYPE, big) != TIME_SERIES || integer(bytes, EVEN, big) != 1 {
        return Err(source.not_acceleration(
            (),
            "an evenly spaced time series",
            format!(
                "SAC file type {} (evenly spaced: {})",
                integer(bytes, FILE_TYPE, big),
                integer(bytes, EVEN, big)
            ),
            "export the acceleration as an evenly spaced time series",
        ));
    }
    // Values of IDEP: 6 displacement, 7 velocity, 8 acceleration, 5 unknown.
    let dependent = integer(bytes, DEPENDENT, big);
    if matches!(dependent, 6 | 7) && hints.recorded().is_none() {
        return Err(source.not_acceleration(
            (),
            "acceleration as the dependent variable",
            if dependent == 6 { "displacement" } else { "velocity" },
            "give the acceleration file of the same channel",
        ));
    }
    let points = integer(bytes, POINTS, big);
    let count = usize::try_from(points)
        .ok()
        .filter(|count| *count > 0)
        .ok_or_else(|| damaged("a number of points above 0", points.to_string()))?;
    let data = &bytes[HEADER_BYTES..];
    let (footer_bytes, footer_words) = match integer(bytes, VERSION, big) {
        7 => (FOOTER_BYTES, " and a footer of 176"),
        _ => (0, ""),
    };
    if count.checked_mul(4).and_then(|length| length.checked_add(footer_bytes)) != Some(data.len())
    {
        return Err(damaged(
            &format!("{count} samples of 4 bytes after the header{footer_words}"),
            format!("{} bytes", data.len()),
        ));
    }
    let (data, footer) = data.split_at(4 * count);
    let time_step = match footer.first_chunk() {
        Some(eight) if big => Some(f64::from_be_bytes(*eight)),
        Some(eight) => Some(f64::from_le_bytes(*eight)),
        None => step(bytes, big),
    };
    let time_step =
        time_step.ok_or_else(|| damaged("a step above 0", "none".to_owned())).and_then(|step| {
            let is_step = step.is_finite() && step > 0.0;
            is_step.then_some(step).ok_or_else(|| damaged("a step above 0", format!("{step} s")))
        })?;
    let text = |from: usize, length: usize| {
        let raw = bytes.get(from..from + length).unwrap_or(&[]);
        let raw = raw.split(|&b| b == 0).next().unwrap_or(&[]);
        let text = latin1(raw).trim().to_owned();
        if text == "-12345" { String::new() } else { text }
    };
    let location = Some(text(464, 8)).filter(|code| code != "--").unwrap_or_default();
    let codes = SeedName {
        network: text(608, 8),
        station: text(440, 8),
        location: location.clone(),
        channel: text(600, 8),
    };
    let start = start(bytes, big);
    let known = hints.instrument(&codes, start);
    let sensitivity = known.map(|known| known.sensitivity).or_else(|| hints.sensitivity());
    let factor = sensitivity.map(|sensitivity| 1.0 / sensitivity);
    let factor =
        factor.or_else(|| hints.unit().map(AccelerationUnit::factor)).ok_or_else(|| {
            source.error(
                (),
                Refusal::Missing(Given::UnitOrSensitivity),
                "a unit or a sensitivity (SAC files hold neither)",
                hints.no_instrument(&codes, start),
                "state the unit of the values, or the sensitivity in counts per m/s2 from the \
             station's metadata",
            )
        })?;
    let mut values = Vec::with_capacity(count);
    for (k, four) in data.chunks_exact(4).enumerate() {
        let value = word(four, 0, big).map_or(f64::NAN, |four| f64::from(f32::from_le_bytes(four)));
        if !value.is_finite() {
            return Err(damaged(
                &format!("a finite number as sample {}", k + 1),
                value.to_string(),
            ));
        }
        values.push(value * factor);
    }
    let mut record = Record::new(FORMAT.name, source.name, Stage::Raw);
    format!("{} {}", text(608, 8), text(440, 8)).trim().clone_into(&mut record.station);
    // Word 4 is a scale factor that programs state but do not apply.
    if let Some(scale) = real(bytes, 3, big).filter(|scale| *scale != 1.0 && *scale != 0.0) {
        record.warn(
            None,
            format!(
                "the header states a scale of {scale}, which was not applied: check that the \
                     given unit or sensitivity applies to the numbers as stored"
            ),
        );
    }
    let name = codes.channel.clone();
    let values =
        seed::as_acceleration(source, &mut record, hints, &codes, known, time_step, values)?;
    let stated = match (real(bytes, 57, big), real(bytes, 58, big)) {
        (_, Some(0.0)) => Direction::up(),
        (_, Some(180.0)) => Direction { downward: true, ..Direction::up() },
        (Some(azimuth), Some(90.0)) => Direction::horizontal(azimuth),
        _ => Direction::parse(&name),
    };
    let direction = known.and_then(|known| known.direction).unwrap_or(stated);
    let name = if name.is_empty() {
        match direction.orientation {
            Some(Orientation::Vertical) => "up".to_owned(),
            _ => "channel 1".to_owned(),
        }
    } else {
        name
    };
    let mut channel = Channel::new(name, direction, time_step, values);
    channel.start = start;
    // Five decimals of a degree exceed the resolution of single precision.
    let real = |index: usize| real(bytes, index, big).map(|value| (value * 1e5).round() / 1e5);
    // Words 31 to 33 are latitude, longitude and elevation; the "hole" is the location code.
    channel.site = Site { sensor: location, elevation: real(33), ..Site::default() }
        .at(real(31).zip(real(32)));
    // Words 35, 36, 39 and 50 are the epicenter, magnitude and distance (km); the unit of the depth
    // is ambiguous.
    record.earthquake = Earthquake {
        epicentral_distance: real(50),
        ..Earthquake::of_magnitude([("", real(39))]).at(real(35).zip(real(36)), None)
    };
    if let Some(known) = known {
        known.complete(&mut channel.site);
    }
    record.channels.push(channel);
    Ok(record)
}

/// Returns the step (s) stored in single precision in word 0, as the shortest decimal that rounds
/// to the stored value: 0.02 for 0.0199999996, 1/1024 exactly, 0.0033333334 for 1/300.
fn step(bytes: &[u8], big: bool) -> Option<f64> {
    let stored = f32::from_le_bytes(word(bytes, 0, big)?);
    stored.to_string().parse().ok()
}

/// Returns the time of the first sample: the reference time in words 70 to 75 plus the offset in
/// word 5.
fn start(bytes: &[u8], big: bool) -> Option<Utc> {
    let part = |index: usize| i64::from(integer(bytes, index, big));
    let seconds = part(74) as f64 + 1e-3 * part(75) as f64;
    let reference = Utc::ordinal(part(70), part(71), part(72), part(73), seconds)?;
    Some(reference.later(real(bytes, 5, big)?))
}
