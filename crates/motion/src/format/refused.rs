//! Recognizes known formats that are refused, and explains what to do instead.

use super::columns::facts::says_acceleration;
use super::source::{Source, leading_text, parse_number};
use super::{Format, Hints};
use crate::error::{ReadError, Refusal};
use crate::instrument::station_xml;
use crate::record::{Quantity, Record};

/// Number of lines searched for rows that begin with a date.
const LINES_BEFORE_DATES: usize = 100;

pub(crate) const HDF5: Format = Format {
    name: "hdf5",
    title: "HDF5 and ASDF containers (refused)",
    sniff: |source| source.bytes.starts_with(b"\x89HDF\r\n\x1a\n"),
    read: |source, _| {
        Err(source.not_acceleration(
            (),
            "a strong-motion file",
            "an HDF5 container",
            "export the acceleration series to plain columns first",
        ))
    },
};

pub(crate) const XML: Format = Format {
    name: "xml",
    title: "StationXML and QuakeML (refused)",
    sniff: |source| {
        let text = source.text(0);
        text.starts_with("<?xml") || text.starts_with("<FDSNStationXML")
    },
    read: xml,
};

/// Blocks of acceleration, velocity and displacement published by the USGS around 1987. There is no reader for this
/// format, because no sample with which a reader could be tested may be redistributed.
pub(crate) const USGS_BLOCKS: Format = Format {
    name: "usgs-1987",
    title: "USGS blocks of 1987 (refused)",
    sniff: |source| {
        ["SAMPLES/SEC=", "DATA TYPE="].iter().all(|key| (0..7).any(|line| source.has(line, key)))
    },
    read: |source, _| {
        Err(source.error(
            (0..7).find(|&line| source.has(line, "DATA TYPE=")),
            Refusal::Unrecognized,
            "a readable format",
            "blocks of the USGS layout of 1987",
            "cut the block with DATA TYPE=AC into a file of plain columns and state its unit and step",
        ))
    },
};

/// USGS SLAMMER table of records, with their time steps.
///
/// The record files are bare columns in g; they are read as plain columns with unit and step given
/// by the caller. Spec: Jibson et al. 2013, USGS Techniques and Methods 12-B1, "Adding records".
pub(crate) const SLAMMER: Format = Format {
    name: "slammer",
    title: "USGS SLAMMER record table (refused)",
    sniff: |source| {
        let fields: Vec<&[u8]> = source.raw(0).split(|&b| b == b'\t').collect();
        // Column 10, counted from 0, is the time step.
        fields.len() >= 12
            && parse_number(fields[0]).is_none()
            && parse_number(fields[10]).is_some_and(|step| step > 0.0 && step < 1.0)
    },
    read: |source, _| {
        Err(source.not_acceleration(
            0,
            "an acceleration history",
            "SLAMMER's table of records",
            "give a record file of this table, and state its unit, g, and the time step that this table states for it",
        ))
    },
};

fn xml(source: &Source<'_>, _: &Hints<'_>) -> Result<Record, ReadError> {
    let mut found = station_xml(&String::from_utf8_lossy(source.bytes)).unwrap_or_default();
    found.retain(|known| known.quantity == Some(Quantity::Acceleration));
    let remedy = if found.is_empty() {
        "give the waveform file".to_owned()
    } else {
        let list: Vec<String> =
            found.iter().map(|known| format!("{} {}", known.channel, known.sensitivity)).collect();
        format!(
            "give the waveform file with the sensitivity stated here (counts per m/s2: {})",
            list.join(", ")
        )
    };
    Err(source.not_acceleration((), "an acceleration history", "XML metadata", remedy))
}

/// Returns the first line of two consecutive rows that begin with a date or a time of day and end
/// with a number.
pub(super) fn clock_times(source: &Source<'_>) -> Option<usize> {
    let clock = |text: &str| {
        let numbers = |text: &str, marks: &[char]| {
            let mut parts = text.split(marks);
            parts.clone().count() >= 3
                && parts.all(|part| part.starts_with(|c: char| c.is_ascii_digit()))
        };
        let date = text.split('T').next().unwrap_or_default();
        numbers(text, &[':']) || numbers(date, &['-', '/'])
    };
    let dated = |line: usize| {
        let text = source.text(line);
        let fields: Vec<&str> = text
            .split([',', ';', '\t', ' '])
            .map(|f| f.trim_matches('"'))
            .filter(|f| !f.is_empty())
            .collect();
        let [first, .., last] = fields.as_slice() else { return false };
        clock(first) && parse_number(last.as_bytes()).is_some()
    };
    (0..source.lines.len().min(LINES_BEFORE_DATES)).find(|&line| dated(line) && dated(line + 1))
}

/// Returns the first line of two consecutive rows that consist of numbers surrounded by other
/// characters, such as quotation marks.
pub(super) fn marked_rows(source: &Source<'_>) -> Option<usize> {
    let marks =
        ["\"", "'", "|", "&", "\\", "[", "]", "{", "}", "(", ")", "$", ":", "\u{e2}\u{88}\u{92}"];
    let marked = |line: usize| {
        let text = source.text(line);
        let plain = marks.iter().fold(text.clone(), |plain, mark| plain.replace(mark, " "));
        let numbers: Vec<&str> =
            plain.split([',', ';', '\t', ' ']).filter(|field| !field.is_empty()).collect();
        plain != text
            && !numbers.is_empty()
            && numbers.iter().all(|field| parse_number(field.as_bytes()).is_some())
    };
    (0..source.lines.len().min(LINES_BEFORE_DATES)).find(|&line| marked(line) && marked(line + 1))
}

/// Returns the last line of a file without rows of numbers, if this line looks like column
/// headings: it names acceleration or time, and is not a sentence.
pub(super) fn headings_alone(source: &Source<'_>) -> Option<usize> {
    let text = |line: usize| source.text(line);
    let last = (0..source.lines.len()).rfind(|&line| !text(line).trim().is_empty())?;
    let lower = text(last).trim().to_lowercase();
    let fields = lower.split([',', ';', '\t']).map(|field| field.split_whitespace().count());
    let short = fields.max().is_some_and(|words| words <= 4) && !lower.ends_with(['.', '!', '?']);
    let numbers = |line: usize| leading_text(text(line).trim().as_bytes()).is_some();
    let names = says_acceleration(&lower) || lower.starts_with("time");
    (names && short && !(0..source.lines.len()).any(numbers)).then_some(last)
}

/// Declares a format that is recognized and refused; the error message states the name of the format.
macro_rules! refused_by_name {
    ($constant:ident, $name:literal, $what:literal, $fits:expr, $remedy:literal) => {
        pub(crate) const $constant: Format = Format {
            name: $name,
            title: concat!($what, " (refused)"),
            sniff: $fits,
            read: |source, _| {
                Err(source.error(
                    (),
                    Refusal::Unrecognized,
                    "a readable format",
                    concat!("a file of the format ", $what),
                    $remedy,
                ))
            },
        };
    };
}

refused_by_name!(
    EVT,
    "evt",
    "Kinemetrics EVT (Altus, Everest)",
    is_evt,
    "convert it to COSMOS or miniSEED with the recorder's own program and give that file"
);
refused_by_name!(
    WIN,
    "win",
    "WIN or WIN32 (Japan)",
    |source| is_win(source.bytes) || is_win32(source.bytes),
    "convert it to SAC or miniSEED, with win2sac for example, and give that file with the \
     sensitivity of each channel"
);
refused_by_name!(
    SEISAN,
    "seisan",
    "SEISAN waveforms",
    is_seisan,
    "convert it to SAC or miniSEED with SEISAN's wavetool and give that file"
);
refused_by_name!(
    MINISEED3,
    "miniseed3",
    "miniSEED 3",
    |source| source.bytes.starts_with(b"MS\x03"),
    "convert it to miniSEED 2 with mseedconvert and give that file"
);
refused_by_name!(
    GEOCSV,
    "geocsv",
    "GeoCSV (EarthScope)",
    |source| (0..4).any(|line| source.has(line, "dataset: GeoCSV")),
    "download the same data as miniSEED, or as the text SLIST or TSPAIR, and give that file"
);
refused_by_name!(
    GSE1,
    "gse1",
    "GSE 1",
    |source| source.raw(0).starts_with(b"WID1") || source.raw(0).starts_with(b"XW01"),
    "convert it to GSE 2 with integers, or to SAC, and give that file"
);
refused_by_name!(
    SEGY,
    "segy",
    "SEG-Y or SEG-2",
    |source| {
        let b = source.bytes;
        // The text header of SEG-Y has 40 cards of 80 characters that begin with C, in EBCDIC or
        // ASCII.
        let cards = |c: u8| (0..40).all(|card| b.get(80 * card) == Some(&c));
        cards(0xC3) || cards(b'C') || b.starts_with(&[0x55, 0x3A]) || b.starts_with(&[0x3A, 0x55])
    },
    "export the acceleration of the channel to plain columns with its unit and step"
);
refused_by_name!(
    UNIVERSAL,
    "uff",
    "universal file (SDRC, data set 58)",
    |source| source.text(0) == "-1" && source.text(1).starts_with("58"),
    "export time and acceleration to plain columns with names and units, and give that file"
);
refused_by_name!(
    MATLAB,
    "matlab",
    "MATLAB",
    |source| source.bytes.starts_with(b"MATLAB "),
    "write time and acceleration from MATLAB to a CSV file with writematrix and give that file"
);
refused_by_name!(
    TDMS,
    "tdms",
    "TDMS (National Instruments)",
    |source| source.bytes.starts_with(b"TDSm"),
    "export time and acceleration to a CSV file and give that file"
);
refused_by_name!(
    NUMPY,
    "npy",
    "NumPy (one array)",
    |source| source.bytes.starts_with(b"\x93NUMPY"),
    "write time and acceleration with numpy.savetxt, one row per sample, and give that file"
);
refused_by_name!(
    PARQUET,
    "parquet",
    "Parquet",
    |source| source.bytes.starts_with(b"PAR1"),
    "write the table as CSV and give that file"
);
refused_by_name!(
    NETCDF,
    "netcdf",
    "NetCDF",
    |source| source.bytes.starts_with(b"CDF\x01") || source.bytes.starts_with(b"CDF\x02"),
    "write time and acceleration to a CSV file and give that file"
);
refused_by_name!(
    OFFICE,
    "office",
    "Excel or Word before 2007",
    |source| source.bytes.starts_with(&[0xD0, 0xCF, 0x11, 0xE0]),
    "save the sheet as CSV, with time and acceleration in columns, and give that file"
);
refused_by_name!(
    PDF,
    "pdf",
    "PDF",
    |source| source.bytes.starts_with(b"%PDF"),
    "give the data file of the record, not its description"
);
refused_by_name!(
    PICTURE,
    "picture",
    "PNG, JPEG, GIF or TIFF (a picture)",
    |source| {
        [&b"\x89PNG"[..], b"\xFF\xD8\xFF", b"GIF8", b"II*\0", b"MM\0*"]
            .iter()
            .any(|magic| source.bytes.starts_with(magic))
    },
    "give the data file of the record, not a picture of it"
);
refused_by_name!(
    PACKED,
    "packed-otherwise",
    "7z, RAR, bzip2, xz, zstd or compress (a packed file)",
    |source| {
        [
            &b"7z\xBC\xAF\x27\x1C"[..],
            b"Rar!\x1A\x07",
            b"BZh91AY&SY",
            b"\xFD7zXZ\0",
            b"\x28\xB5\x2F\xFD",
            b"\x1F\x9D",
        ]
        .iter()
        .any(|magic| source.bytes.starts_with(magic))
    },
    "unpack it and give the record inside; zip, tar and gzip files can be given as they are"
);
refused_by_name!(
    WEB_PAGE,
    "html",
    "HTML (a web page)",
    |source| {
        // Some pages begin with an XML declaration.
        (0..4).any(|line| {
            let start = source.text(line).to_ascii_lowercase();
            ["<!doctype html", "<html", "<head"].iter().any(|tag| start.starts_with(tag))
        })
    },
    "the download returned a web page instead of the record, often a login page; open it in a \
     browser and download the record again"
);

/// COSMOS volume 3: response and Fourier spectra, which do not determine a motion.
pub(crate) const COSMOS_SPECTRA: Format = Format {
    name: "cosmos-v3",
    title: "COSMOS volume 3 (refused)",
    sniff: |source| {
        source.has(0, "(Format v")
            && ["SPECTR", "RESPONSE", "FOURIER"].iter().any(|word| source.has(0, word))
    },
    read: |source, _| {
        Err(source.not_acceleration(
            0,
            "a COSMOS file of volume 0, 1 or 2",
            "COSMOS volume 3, response and Fourier spectra",
            "give the file of volume 1 or 2 of the same record",
        ))
    },
};

/// Returns `true` for a file that starts with the tag of Kinemetrics. The tag consists of the
/// letter `K`, byte order, version, instrument, and the kind of frame: a 32-bit number, which is 1
/// for the file header.
fn is_evt(source: &Source<'_>) -> bool {
    let Some(&[b'K', order @ 0..=1, version @ 0..=3, _, a, b, c, d]) =
        source.bytes.first_chunk::<8>()
    else {
        return false;
    };
    let kind = [u32::from_be_bytes([a, b, c, d]), u32::from_le_bytes([a, b, c, d])];
    (version > 0 || order > 0) && kind.contains(&1)
}

/// Returns `true` if the bytes are a date and time in binary-coded decimal: year, month, day, hour,
/// minute, second.
fn is_coded_time(bytes: &[u8]) -> bool {
    let decimal =
        |byte: u8| (byte >> 4 < 10 && byte & 15 < 10).then_some(10 * (byte >> 4) + (byte & 15));
    let numbers: Option<Vec<u8>> = bytes.iter().map(|byte| decimal(*byte)).collect();
    let Some(&[_, month, day, hour, minute, second]) = numbers.as_deref() else { return false };
    (1..=12).contains(&month) && (1..=31).contains(&day) && hour < 24 && minute < 60 && second < 60
}

fn big_endian(bytes: &[u8], at: usize) -> Option<usize> {
    let four = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
    usize::try_from(u32::from_be_bytes(four)).ok()
}

/// Returns `true` for WIN data: blocks of one second, each with its length and its time. The times
/// of the first two blocks are checked.
///
/// Spec: Urabe and Tsukada 1991, WIN format (Earthquake Research Institute, Tokyo).
fn is_win(bytes: &[u8]) -> bool {
    let timed = |at: usize| bytes.get(at + 4..at + 10).is_some_and(is_coded_time);
    let Some(length) = big_endian(bytes, 0) else { return false };
    let fits = (15..=bytes.len()).contains(&length) && timed(0);
    fits && (length == bytes.len() || timed(length))
}

/// Returns `true` for WIN data with four leading zero bytes and a time of eight bytes.
fn is_win32(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0; 4]) && bytes.get(5..11).is_some_and(is_coded_time) && bytes.len() > 20
}

/// Returns `true` for an unformatted Fortran file whose first record is a line of 80 characters,
/// with the record length before and after the line.
///
/// Spec: Ottemöller, Voss and Havskov, SEISAN manual, appendix B.
fn is_seisan(source: &Source<'_>) -> bool {
    let b = source.bytes;
    let line = |from: usize| {
        b.get(from..from + 80).is_some_and(|line| line.iter().all(|c| (0x20..0x7F).contains(c)))
    };
    // Record lengths have one byte (PC), four bytes in either order, or eight bytes.
    (b.starts_with(b"KP") && b.get(82) == Some(&b'P') && line(2))
        || ((b.starts_with(&[80, 0, 0, 0]) || b.starts_with(&[0, 0, 0, 80])) && line(4))
        || ((b.starts_with(&[80, 0, 0, 0, 0, 0, 0, 0])
            || b.starts_with(&[0, 0, 0, 0, 0, 0, 0, 80]))
            && line(8))
}
