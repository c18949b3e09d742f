//! Readers of strong-motion files, one module per format; the format is detected from the content.

mod afad;
mod bbp;
mod bhrc;
mod cdmg;
mod columns;
mod cosmos;
mod counts;
mod csmip_v2;
mod csmnc;
mod cwa;
mod esm;
mod even;
mod geonet;
mod gravity;
mod gse;
mod hints;
mod knet;
mod miniseed;
mod native;
mod npz;
mod number;
mod packed;
mod peer;
mod place;
mod quoted;
mod refused;
mod sac;
mod sac_text;
mod seed;
mod seed_volume;
mod smc;
mod source;
mod timeseries;
mod unam;
pub(crate) mod zip;

use crate::error::{ReadError, Refusal};
use crate::instrument::Instrument;
use crate::math::STANDARD_GRAVITY;
use crate::record::{Channel, Quantity, Record};
use crate::units::AccelerationUnit;
use hints::Hints;
pub(crate) use packed::LARGEST as LARGEST_UNPACKED;
use source::{FilePosition, LARGEST_ACCELERATION, parse_number};
pub(crate) use source::{Printed, Source, quoted, shorten, utf8};

/// Information that a file may lack.
///
/// A value stated in the file takes precedence over an option, unless the description of the option states otherwise.
/// Options that are given but not used are reported.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of acceleration, for formats that do not state it.
    pub unit: Option<AccelerationUnit>,
    /// Time step (s), for formats that do not state it.
    pub time_step: Option<f64>,
    /// Sensitivity in counts per m/s², for files of counts; overrides the sensitivity in a COSMOS header or in the
    /// control headers of a SEED volume. The unit is counts per m/s or per m if [`ReadOptions::recorded`] is velocity
    /// or displacement.
    pub sensitivity: Option<f64>,
    /// Metadata of individual channels. The first entry that matches a channel takes precedence over
    /// the sensitivity for all channels.
    pub instruments: Vec<Instrument>,
    /// Quantity recorded in SEED and SAC files; takes precedence over the channel codes. Velocity
    /// and displacement are differentiated.
    pub recorded: Option<Quantity>,
}

/// A file format that can be read.
#[derive(Clone, Copy)]
pub struct Format {
    /// Short name, as in [`Record::format`].
    pub name: &'static str,
    /// Full name, with the publisher of the format.
    pub title: &'static str,
    sniff: fn(&Source<'_>) -> bool,
    read: fn(&Source<'_>, &Hints<'_>) -> Result<Record, ReadError>,
}

impl Format {
    /// Reads `bytes` as this format, without detecting the format. `name` is used only in messages.
    ///
    /// [`read`] detects the format. This method is for callers that know the format or run every
    /// reader on the same bytes.
    ///
    /// # Errors
    /// The same as for [`read`].
    pub fn read(
        &self,
        bytes: &[u8],
        name: &str,
        options: &ReadOptions,
    ) -> Result<Record, ReadError> {
        let source = Source::new(name, bytes);
        check_bytes(&source)?;
        check_options(&source, options)?;
        self.read_source(&source, options)
    }

    fn read_source(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Record, ReadError> {
        let hints = Hints::new(options);
        let mut record = (self.read)(source, &hints)?;
        if let Some(found) = hints.contradiction() {
            return Err(source.error(
                (),
                Refusal::Options,
                "metadata with one sensitivity for each channel",
                found,
                "give only the StationXML valid at the time of the record",
            ));
        }
        record.format = self.name;
        for what in hints.ignored() {
            record.warn(
                None,
                format!("{what} given was ignored, because this file does not need it"),
            );
        }
        finish(source, &mut record)?;
        Ok(record)
    }
}

impl std::fmt::Debug for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Format").field("name", &self.name).finish_non_exhaustive()
    }
}

/// All readable formats, in the order in which they are tried.
pub const FORMATS: &[Format] = &[
    sac::FORMAT,
    miniseed::FORMAT,
    seed_volume::FORMAT,
    native::FORMAT,
    npz::FORMAT,
    smc::FORMAT,
    geonet::FORMAT,
    cdmg::RENADIC,
    cdmg::USC,
    cdmg::CSMIP,
    csmip_v2::FORMAT,
    bhrc::FORMAT,
    cosmos::FORMAT,
    knet::FORMAT,
    esm::FORMAT,
    afad::FORMAT,
    cwa::FORMAT,
    unam::FORMAT,
    peer::FORMAT,
    csmnc::FORMAT,
    timeseries::FORMAT,
    gse::FORMAT,
    sac_text::FORMAT,
    bbp::FORMAT,
    columns::FORMAT,
];

/// Description of the readable formats, for the error about a file in any other format. A list of all names would hide
/// the rest of the message.
const KNOWN_FORMATS: &str = "a strong-motion record in a known format, such as PEER AT2, COSMOS, CSMIP, K-NET, ESM, \
                             SAC, SEED, or plain columns of numbers";

/// Known formats that are refused. These formats are tried before all others.
const KNOWN_OTHERS: &[Format] = &[
    refused::HDF5,
    refused::WEB_PAGE,
    refused::XML,
    refused::GEOCSV,
    refused::USGS_BLOCKS,
    refused::SLAMMER,
    refused::COSMOS_SPECTRA,
    refused::EVT,
    refused::WIN,
    refused::SEISAN,
    refused::MINISEED3,
    refused::GSE1,
    refused::SEGY,
    refused::UNIVERSAL,
    refused::MATLAB,
    refused::TDMS,
    refused::NUMPY,
    refused::PARQUET,
    refused::NETCDF,
    refused::OFFICE,
    refused::PDF,
    refused::PICTURE,
    refused::PACKED,
];

/// Reads a strong-motion file of any format.
///
/// The file may be compressed with gzip, or be a zip, tar or tar.gz archive of one record. `name`
/// is used only in messages. The components of a record may be spread over several files of an
/// archive; the notes of the record list these files and the files left out. An archive of several
/// records is refused ([`Refusal::SeveralRecords`]); [`crate::Archive`] returns its files one by
/// one.
///
/// # Errors
/// If no format matches, the file contains no acceleration or is damaged, or the unit, step or
/// sensitivity is neither in the file nor in `options`.
///
/// ```
/// use barrelstack_motion::{ReadOptions, read};
/// let file = b"PEER STRONG MOTION DATABASE RECORD\nEVENT, STATION, 090\n\
///     ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0200 SEC\n .1 .2 -.3 .0\n";
/// let record = read(file, "small.at2", &ReadOptions::default())?;
/// assert_eq!(record.channels[0].time_step, 0.02);
/// assert_eq!(record.channels[0].direction.azimuth, Some(90.0));
/// # Ok::<(), barrelstack_motion::ReadError>(())
/// ```
pub fn read(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Record, ReadError> {
    let source = Source::new(name, bytes);
    check_bytes(&source)?;
    check_options(&source, options)?;
    match packed::read(&source, options)? {
        Some(record) => Ok(record),
        None => read_any(&source, options),
    }
}

/// Reads bytes that are not compressed.
fn read_any(source: &Source<'_>, options: &ReadOptions) -> Result<Record, ReadError> {
    let Some(format) = KNOWN_OTHERS.iter().chain(FORMATS).find(|format| (format.sniff)(source))
    else {
        if let Some(line) = refused::clock_times(source) {
            return Err(source.error(
                line,
                Refusal::Unrecognized,
                "times in seconds",
                format!(
                    "{}, a row that begins with a date or a time of day",
                    quoted(&source.text(line))
                ),
                "write the seconds since the first sample in place of dates and times of day, or \
                 values alone below a line with the step",
            ));
        }
        if let Some(line) = refused::marked_rows(source) {
            return Err(source.error(
                line,
                Refusal::Unrecognized,
                "numbers separated by blanks, commas, semicolons or tabs",
                format!(
                    "other characters next to the numbers, {}",
                    quoted(&utf8(source.raw(line)))
                ),
                "write only the numbers, with hyphens for minus signs, and times in seconds",
            ));
        }
        if let Some(line) = refused::headings_alone(source) {
            return Err(source.error(
                line,
                Refusal::Unrecognized,
                "rows of numbers below the headings",
                format!("{}, after which the file ends", quoted(&source.text(line))),
                "the file is truncated or was never filled; export it again, or get it again from its source",
            ));
        }
        let first_line = || format!("\"{}\" as first line", shorten(&source.text(0)));
        return Err(source.error(
            (),
            Refusal::Unrecognized,
            KNOWN_FORMATS,
            quoted::binary(source.bytes).unwrap_or_else(first_line),
            "convert the file to plain columns, with one value, or time and value, per line",
        ));
    };
    format.read_source(source, options)
}

/// Refuses content that no format allows: an empty file, or text in UTF-16.
fn check_bytes(source: &Source<'_>) -> Result<(), ReadError> {
    let (expected, found, remedy) = if source.bytes.trim_ascii().is_empty() {
        ("a strong-motion file", "an empty file", "get the file again from its source")
    } else if source.bytes.starts_with(&[0xff, 0xfe]) || source.bytes.starts_with(&[0xfe, 0xff]) {
        ("text in UTF-8", "UTF-16", "save the file as UTF-8 or plain text")
    } else {
        return Ok(());
    };
    Err(source.damaged((), expected, found, remedy))
}

/// Parses the velocities (m/s) at the first samples, one per channel, from a header line that this
/// crate has written.
fn initial_velocities(
    source: &Source<'_>,
    line: usize,
    text: &str,
    channels: usize,
) -> Result<Vec<f64>, ReadError> {
    let velocities: Option<Vec<f64>> =
        text.split_whitespace().map(|word| parse_number(word.as_bytes())).collect();
    // The limit of accelerations in m/s² is far above any velocity in m/s.
    velocities
        .filter(|v| v.len() == channels && v.iter().all(|v| v.abs() <= LARGEST_ACCELERATION))
        .ok_or_else(|| {
            source.damaged(
                line,
                format!("{channels} velocities (m/s), one per channel"),
                quoted(text),
                "correct the header line",
            )
        })
}

fn check_options(source: &Source<'_>, options: &ReadOptions) -> Result<(), ReadError> {
    for (what, value) in [
        ("time step (s)", options.time_step),
        ("sensitivity (counts per m/s2)", options.sensitivity),
    ] {
        if let Some(value) = value
            && !(value.is_finite() && value > 0.0)
        {
            return Err(source.error(
                (),
                Refusal::Options,
                format!("a {what} above 0"),
                format!("{value}, as given"),
                "give a positive number",
            ));
        }
    }
    Ok(())
}

/// Runs the checks that apply to every format.
pub(crate) fn finish(source: &Source<'_>, record: &mut Record) -> Result<(), ReadError> {
    if record.channels.is_empty() {
        return Err(source.not_acceleration(
            (),
            "an acceleration channel",
            "none",
            "give the file that holds the accelerations",
        ));
    }
    drop_dead_channels(source, record)?;
    for channel in &mut record.channels {
        if channel.site.station.is_empty() {
            channel.site.station.clone_from(&record.station);
        }
    }
    for channel in &record.channels {
        let label = &channel.name;
        if !(channel.time_step.is_finite() && channel.time_step > 0.0) {
            return Err(source.damaged(
                (),
                format!("a time step above 0 for channel {label}"),
                channel.time_step.to_string(),
                "the header is damaged; get the file again from its source",
            ));
        }
        if channel.acceleration.len() < 2 {
            return Err(source.damaged(
                (),
                format!("at least 2 samples in channel {label}"),
                channel.acceleration.len().to_string(),
                "the file is truncated; get it again from its source",
            ));
        }
        if let Some(sample) = missing_value(&channel.acceleration) {
            return Err(source.damaged(
                (),
                "accelerations only",
                format!(
                    "{:.6} m/s2 at sample {}, which looks like a placeholder for a missing value",
                    channel.acceleration[sample],
                    sample + 1
                ),
                "get the record without gaps, or cut the file before the gap",
            ));
        }
    }
    gravity::take_out(source, record)?;
    for index in 0..record.channels.len() {
        let channel = &mut record.channels[index];
        let label = channel.name.clone();
        let pga = channel.pga();
        if !(pga <= LARGEST_ACCELERATION) {
            return Err(source.damaged(
                (),
                format!("accelerations below {LARGEST_ACCELERATION} m/s2 in channel {label}"),
                format!("{pga:e} m/s2"),
                "check the unit, or get the file again from its source",
            ));
        }
        if channel.direction.downward {
            for value in &mut channel.acceleration {
                *value = -*value;
            }
            channel.initial_velocity = -channel.initial_velocity;
            channel.direction.downward = false;
            record.notes.push(format!("channel {label} points down and was reversed"));
        }
        let mut messages = Vec::new();
        for peak in &record.channels[index].peaks {
            if !peak.agrees() {
                messages.push(format!(
                    "channel {label}: the header states a peak {} of {:.6} (SI), the numbers \
                     give {:.6}",
                    peak.quantity, peak.stated, peak.measured
                ));
            }
        }
        messages.extend(record.channels[index].implausible().map(|found| found.what));
        let in_g = pga / STANDARD_GRAVITY;
        if in_g > 3.0 {
            messages.push(format!("channel {label}: PGA is {in_g:.3} g; check the unit"));
        } else if in_g < 0.001 {
            messages.push(format!("channel {label}: PGA is {in_g:.2e} g; check the unit"));
        }
        for message in messages {
            record.warn(None, message);
        }
    }
    record.align_each_site().map_err(|error| {
        source.damaged(
            (),
            "channels of one station and sensor that were recorded at the same time",
            error.to_string(),
            "split the file, so that each part contains only channels recorded at the same time",
        )
    })
}

/// Returns the index of a sample that is a placeholder for a missing value, such as -9999 in any
/// unit of acceleration. The change to or from such a sample is more than three times as large as
/// any change between other samples.
fn missing_value(values: &[f64]) -> Option<usize> {
    let jump = |row: usize| (values[row] - values[row - 1]).abs();
    let largest = (1..values.len()).max_by(|a, b| jump(*a).total_cmp(&jump(*b)))?;
    [largest, largest - 1].into_iter().find(|&row| {
        let value = values[row];
        let rest = (1..values.len())
            .filter(|&k| values[k] != value && values[k - 1] != value)
            .map(jump)
            .fold(0.0, f64::max);
        jump(largest) > 3.0 * rest && is_mark(value)
    })
}

/// Returns `true` if a value (m/s²) is a placeholder in at least one unit of acceleration. A
/// placeholder consists of at least three nines, or is another common number such as 32767.
fn is_mark(value: f64) -> bool {
    AccelerationUnit::ALL.iter().any(|unit| {
        let number = (value / unit.factor()).abs();
        let text = format!("{number:.6}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        let power = number >= 1e6 && crate::math::log10(number).fract().abs() < 1e-9;
        is_nines(number) || power || ["999.25", "32767", "32768"].contains(&text)
    })
}

/// Returns `true` if a number is above 99 and all its digits are nines, as in 999 or 99.9.
fn is_nines(number: f64) -> bool {
    let text = format!("{number:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.chars().all(|c| c == '9' || c == '.') && text.len() >= 3 && number > 99.0
}

/// Converts a number in a header to a positive integer.
fn whole(source: &Source<'_>, line: usize, what: &str, value: f64) -> Result<usize, ReadError> {
    if value.fract() == 0.0 && (1.0..=1e9).contains(&value) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1e9")]
        return Ok(value as usize);
    }
    Err(source.header(line, format!("{what}, 1 or more"), value.to_string()))
}

/// Largest number of values that may be added to fill up the last line: one less than the ten
/// values per line of the widest layout.
const FILLED: usize = 9;

/// Returns how many of the `found` values are used if the header states their number.
///
/// All values are used if there is one value fewer than stated, or if there are one or two more,
/// because published headers contain such errors. If there are up to [`FILLED`] more, the last line
/// was filled up, and only the stated number of values is used.
///
/// # Errors
/// If the difference is larger: the file is truncated, or its header belongs to another file.
fn check_count(
    source: &Source<'_>,
    record: &mut Record,
    line: usize,
    stated: usize,
    found: usize,
) -> Result<usize, ReadError> {
    if stated == found {
        return Ok(found);
    }
    if found + 1 == stated || found == stated + 1 || found == stated + 2 {
        record.warn(
            line + 1,
            format!("the header states {stated} values, the file contains {found}; all are used"),
        );
        return Ok(found);
    }
    // Twice as many values do not mean a filled line: decimal commas have split each number into
    // two.
    if found > stated && found <= stated + FILLED && found < 2 * stated {
        record.warn(
            line + 1,
            format!(
                "the header states {stated} values, the file contains {found}; the last {} are ignored",
                found - stated
            ),
        );
        return Ok(stated);
    }
    let column = source.find(line, &stated.to_string());
    Err(source.damaged(
        column.map_or(FilePosition::from(line), |column| FilePosition::from((line, column))),
        format!("{stated} values as stated here"),
        format!("{found}"),
        "the file is truncated or its header belongs to another file; get it again from its source",
    ))
}

/// Checks the number of values as [`check_count`] does, for a header that states the length of the
/// record in whole seconds. A difference of up to one second is considered rounding.
fn check_seconds(
    source: &Source<'_>,
    record: &mut Record,
    line: usize,
    [seconds, rate]: [f64; 2],
    found: usize,
) -> Result<usize, ReadError> {
    let stated = whole(source, line, "a length of the record", (seconds * rate).round())?;
    if found.abs_diff(stated) as f64 > rate {
        return check_count(source, record, line, stated, found);
    }
    if found != stated {
        record.warn(
            line + 1,
            format!("the header states {stated} values, the file contains {found}"),
        );
    }
    Ok(found)
}

/// Returns the file name without folders and extension.
pub(crate) fn file_stem(name: &str) -> String {
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    base.rsplit_once('.').map_or(base, |(stem, _)| stem).to_owned()
}

/// Reads rows of `width` numbers separated by blanks, and returns them as columns.
fn rows(
    source: &Source<'_>,
    from: usize,
    to: usize,
    width: usize,
    limit: f64,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let mut columns = vec![Vec::with_capacity(to.saturating_sub(from)); width];
    let mut row = Vec::with_capacity(width);
    for line in from..to {
        row.clear();
        source.tokens(line, limit, &mut row)?;
        if row.len() != width {
            return Err(source.ragged(line, width, row.len()));
        }
        for (column, value) in columns.iter_mut().zip(&row) {
            column.push(*value);
        }
    }
    Ok(columns)
}

/// Removes constant channels, such as clocks and unused inputs.
fn drop_dead_channels(source: &Source<'_>, record: &mut Record) -> Result<(), ReadError> {
    let dead = |channel: &mut Channel| match channel.acceleration.as_slice() {
        [first, rest @ ..] => !rest.is_empty() && rest.iter().all(|value| value == first),
        [] => false,
    };
    let left_out: Vec<Channel> = record.channels.extract_if(.., dead).collect();
    if !left_out.is_empty() && record.channels.is_empty() {
        return Err(source.not_acceleration(
            (),
            "a channel whose values vary",
            "one value throughout",
            "give the file that holds the accelerations",
        ));
    }
    for channel in left_out {
        record.warn(
            None,
            format!(
                "channel {} is constant (a clock or an unused input) and was ignored",
                channel.name
            ),
        );
    }
    Ok(())
}

/// Removes the mean of a raw digital channel, whose zero is arbitrary, and adds a note.
fn remove_offset(record: &mut Record, name: &str, values: &mut [f64]) {
    let offset = crate::math::take_mean(values);
    record.notes.push(format!(
        "channel {name}: offset of {offset:.4e} m/s2, the mean of the whole record, removed because \
         the digitizer's zero is arbitrary"
    ));
}
