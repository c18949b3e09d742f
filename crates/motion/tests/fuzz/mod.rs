//! Seeded, structure-aware damage to files, and properties that every result must have.

use std::path::{Path, PathBuf};

use barrelstack_motion::{
    AccelerationUnit, FORMATS, Flatfile, Format, MotionError, Random, ReadError, ReadOptions,
    Record, read, station_xml,
};

/// Numbers that break readers: limits of types, of formats and of plausibility.
const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "100",
    "9999",
    "32767",
    "65536",
    "99999999",
    "1e9",
    "2147483647",
    "4294967296",
    "1E308",
    "-1E308",
    "1e-320",
    "NaN",
    "inf",
    ".",
    "-",
    "+5.D+02",
    "*******",
];

/// Words that readers look for, and some unexpected ones.
const WORDS: [&[u8]; 20] = [
    b"\n",
    b"\r\n",
    b"\r",
    b"  ",
    b"\t",
    b",",
    b"/&",
    b"|",
    b"#",
    b":",
    b"(8F10.3)",
    b"(1X,10F7.3)",
    b"(99999F99999.1)",
    b"NPTS",
    b"UNITS",
    b"accel",
    b"points",
    b"\xff\xfe",
    b"\0",
    b"\xd1",
];

/// 32-bit words that may occur in binary headers.
const BINARY: [u32; 10] = [
    0,
    1,
    2,
    6,
    0xff,
    0x7fff_ffff,
    0x8000_0000,
    u32::MAX,
    0x7fc0_0000,
    (-12345_i32).cast_unsigned(),
];

/// A sample file.
pub(crate) struct Sample {
    /// Path relative to the folder of samples.
    pub(crate) name: String,
    /// Content of the file.
    pub(crate) bytes: Vec<u8>,
}

fn below(random: &mut Random, n: usize) -> usize {
    if n == 0 { 0 } else { usize::try_from(random.bits() % n as u64).unwrap_or(0) }
}

fn pick<'a, T>(random: &mut Random, from: &'a [T]) -> &'a T {
    &from[below(random, from.len())]
}

/// Returns all samples in `tests/data`, sorted by name.
pub(crate) fn samples() -> Vec<Sample> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut files: Vec<PathBuf> = Vec::new();
    let mut open = vec![root.clone()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { &mut open } else { &mut files }.push(path);
        }
    }
    files.sort();
    files
        .iter()
        .map(|path| Sample {
            name: path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/"),
            bytes: std::fs::read(path).unwrap(),
        })
        .filter(|sample| !sample.name.ends_with("SOURCE.txt") && !sample.name.starts_with('.'))
        .collect()
}

/// A parser of external bytes.
#[derive(Clone, Copy)]
pub(crate) enum Reader {
    Format(&'static Format),
    /// One record inside gzip or zip.
    Packed,
    StationXml,
    Flatfile,
}

impl Reader {
    pub(crate) fn all() -> Vec<Self> {
        let others = [Self::Packed, Self::StationXml, Self::Flatfile];
        FORMATS.iter().map(Self::Format).chain(others).collect()
    }

    /// Returns the name of the folder that holds the samples of the reader.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Format(format) => format.name,
            Self::Packed => "packed",
            Self::StationXml => "stationxml",
            Self::Flatfile => "flatfile",
        }
    }

    /// Reads a file and panics if the result violates a property. Returns `true` if the file was
    /// accepted.
    pub(crate) fn take(self, bytes: &[u8], given: &ReadOptions) -> bool {
        let text = || String::from_utf8_lossy(bytes);
        match self {
            Self::Format(format) => record_holds(&format.read(bytes, "fuzz", given)),
            Self::Packed => record_holds(&read(bytes, "fuzz", given)),
            Self::StationXml => has_message(&station_xml(&text())),
            Self::Flatfile => has_message(&Flatfile::parse("fuzz", &text())),
        }
    }
}

fn has_message<T>(result: &Result<T, MotionError>) -> bool {
    if let Err(error) = result {
        let text = error.to_string();
        assert!(!text.is_empty() && text.len() < 1000, "{text}");
    }
    result.is_ok()
}

fn record_holds(result: &Result<Record, ReadError>) -> bool {
    must_hold(result);
    result.is_ok()
}

/// Returns the samples in the folder of a reader.
pub(crate) fn samples_of(reader: Reader, samples: &[Sample]) -> Vec<&Sample> {
    let folder = format!("{}/", reader.name());
    samples.iter().filter(|sample| sample.name.starts_with(&folder)).collect()
}

/// Returns the options of a caller: none, one of them, or all.
pub(crate) fn options(random: &mut Random) -> ReadOptions {
    let choice = random.bits();
    let units =
        [AccelerationUnit::G, AccelerationUnit::Gal, AccelerationUnit::MillimetersPerSecondSquared];
    ReadOptions {
        unit: (choice & 0b11 != 0).then(|| *pick(random, &units)),
        time_step: (choice & 0b1100 != 0).then_some(0.01),
        sensitivity: (choice & 0b11_0000 != 0).then_some(1000.0),
        ..ReadOptions::default()
    }
}

/// Applies one to five changes to a file; `others` supply foreign lines.
pub(crate) fn mutate(bytes: &[u8], others: &[Sample], random: &mut Random) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=below(random, 5) {
        if out.is_empty() {
            break;
        }
        match below(random, 16) {
            0 => *one(&mut out, random) = low_byte(random),
            1 => {
                let length = below(random, out.len());
                out.truncate(length);
            }
            2 => {
                let range = span(out.len(), 200, random);
                out.drain(range);
            }
            3 => {
                let piece = out[span(out.len(), 200, random)].to_vec();
                let at = below(random, out.len());
                out.splice(at..at, piece);
            }
            4 | 5 => change_number(&mut out, random),
            6 => {
                // A digit of the header, where the counts are.
                let head = out.len().min(3000);
                let digits: Vec<usize> = (0..head).filter(|&k| out[k].is_ascii_digit()).collect();
                if !digits.is_empty() {
                    out[*pick(random, &digits)] = b"0123456789"[below(random, 10)];
                }
            }
            7 => {
                let word = *pick(random, &WORDS);
                let at = below(random, out.len());
                // Overwrites or inserts.
                let end =
                    if random.bits() & 1 == 0 { at } else { (at + word.len()).min(out.len()) };
                out.splice(at..end, word.iter().copied());
            }
            8 => out = new_line_ends(&out, random),
            9..=11 => change_lines(&mut out, random),
            12 => {
                let lender = &pick(random, others).bytes;
                let lines: Vec<&[u8]> = lender.split_inclusive(|&b| b == b'\n').take(200).collect();
                let line = pick(random, &lines);
                let at = line_start(&out, below(random, out.len()));
                out.splice(at..at, line.iter().copied());
            }
            13 | 14 => {
                let value = *pick(random, &BINARY);
                let word =
                    if random.bits() & 1 == 0 { value.to_le_bytes() } else { value.to_be_bytes() };
                let at = below(random, out.len()) & !3;
                let end = (at + 4).min(out.len());
                out[at..end].copy_from_slice(&word[..end - at]);
            }
            _ => {
                let (a, b) = (below(random, out.len()), below(random, out.len()));
                out.swap(a, b);
            }
        }
    }
    out
}

fn one<'a>(out: &'a mut [u8], random: &mut Random) -> &'a mut u8 {
    let at = below(random, out.len());
    &mut out[at]
}

fn low_byte(random: &mut Random) -> u8 {
    random.bits().to_le_bytes()[0]
}

fn span(length: usize, most: usize, random: &mut Random) -> std::ops::Range<usize> {
    let at = below(random, length);
    at..(at + below(random, most)).min(length)
}

/// Replaces a number by another number, keeping its column width or shifting the rest.
fn change_number(out: &mut Vec<u8>, random: &mut Random) {
    let start = below(random, out.len());
    let is_part = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+');
    let Some(from) = (start..out.len()).find(|&k| is_part(out[k])) else { return };
    let to = (from..out.len()).find(|&k| !is_part(out[k])).unwrap_or(out.len());
    let mut number = pick(random, &NUMBERS).as_bytes().to_vec();
    if random.bits() & 1 == 0 {
        number.resize(to - from, b' ');
    }
    out.splice(from..to, number);
}

fn new_line_ends(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let end: &[u8] = [b"\r\n".as_slice(), b"\r", b"\r\r\n", b"\n\n"][below(random, 4)];
    let mut out = Vec::with_capacity(bytes.len() * 2);
    for &byte in bytes {
        if byte == b'\n' { out.extend(end) } else { out.push(byte) }
    }
    out
}

fn line_start(bytes: &[u8], at: usize) -> usize {
    bytes[..at].iter().rposition(|&b| b == b'\n').map_or(0, |k| k + 1)
}

/// Deletes, duplicates, empties, moves, truncates or extends lines.
fn change_lines(out: &mut Vec<u8>, random: &mut Random) {
    let from = line_start(out, below(random, out.len()));
    let to = (from..out.len()).find(|&k| out[k] == b'\n').map_or(out.len(), |k| k + 1);
    match below(random, 6) {
        0 => drop(out.drain(from..to)),
        1 => {
            let line = out[from..to].to_vec();
            let times = 1 + below(random, 8);
            let lines = line.repeat(times);
            out.splice(to..to, lines);
        }
        2 => drop(out.splice(from..from, *b"\n")),
        3 => {
            let line: Vec<u8> = out.drain(from..to).collect();
            let at = if out.is_empty() { 0 } else { line_start(out, below(random, out.len())) };
            out.splice(at..at, line);
        }
        4 => {
            let at = from + below(random, to - from);
            out.drain(at..to.saturating_sub(1).max(at));
        }
        _ => {
            // Join the line with the next.
            if to > from && out.get(to - 1) == Some(&b'\n') {
                out.remove(to - 1);
            }
        }
    }
}

/// Panics unless the result is usable or the error states a reason and a remedy.
pub(crate) fn must_hold(result: &Result<Record, ReadError>) {
    match result {
        Ok(record) => {
            assert!(!record.channels.is_empty(), "a record without channels");
            for channel in &record.channels {
                assert!(channel.time_step > 0.0 && channel.time_step.is_finite(), "step");
                assert!(channel.acceleration.len() >= 2, "fewer than two samples");
                assert!(channel.acceleration.iter().all(|a| a.is_finite()), "not finite");
                assert!(channel.initial_velocity.is_finite(), "initial velocity");
            }
        }
        Err(error) => {
            let text = error.to_string();
            assert!(!text.is_empty() && !text.ends_with('.'), "{text}");
            assert!(!error.found.is_empty() && !error.remedy.is_empty(), "{text}");
            assert!(text.len() < 1000, "a message of {} bytes", text.len());
        }
    }
}
