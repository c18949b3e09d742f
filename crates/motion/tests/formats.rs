//! One test suite for every format, on the samples in `tests/data`.
//!
//! Every sample contains the same decaying sine, so that the expected numbers follow from a
//! formula.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use std::path::{Path, PathBuf};

use barrelstack_motion::{
    AccelerationUnit, Given, Orientation, Quantity, ReadOptions, Record, Refusal, STANDARD_GRAVITY,
    Stage, StatedPeak, read, write,
};

pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

pub(crate) fn bytes(file: &str) -> Vec<u8> {
    std::fs::read(folder().join(file)).unwrap()
}

/// Returns the acceleration (m/s²) of component `c` (0 east or first, 1 north or second, 2 up) at time `t`.
fn formula(c: usize, t: f64) -> f64 {
    let c_f = c as f64;
    [0.3, 0.2, 0.1][c]
        * STANDARD_GRAVITY
        * (std::f64::consts::TAU * (1.1 + 0.3 * c_f) * t + 0.2 * c_f).sin()
        * (-0.7 * t).exp()
}

pub(crate) fn options(file: &str) -> ReadOptions {
    let unit = |unit| ReadOptions { unit: Some(unit), ..ReadOptions::default() };
    match file {
        "columns/bare.txt" => ReadOptions { time_step: Some(0.02), ..unit(AccelerationUnit::G) },
        "columns/count-first.txt" => unit(AccelerationUnit::G),
        "columns/touching.acc" => {
            ReadOptions { time_step: Some(0.01), ..unit(AccelerationUnit::MetersPerSecondSquared) }
        }
        "bbp/example.000" => unit(AccelerationUnit::Gal),
        "timeseries/counts.txt" | "gse2/cm6.gse" | "gse2/int.gse" => {
            ReadOptions { sensitivity: Some(427_819.0 / 100.0), ..ReadOptions::default() }
        }
        _ if file.starts_with("sac") => unit(AccelerationUnit::G),
        "miniseed/steim2.mseed" => {
            ReadOptions { sensitivity: Some(427_819.0 / 100.0 / 300.0), ..ReadOptions::default() }
        }
        _ if file.starts_with("miniseed/") => {
            ReadOptions { sensitivity: Some(427_819.0 / 100.0), ..ReadOptions::default() }
        }
        _ => ReadOptions::default(),
    }
}

/// File, stage and step; for each channel its name, the component of the formula and the number of
/// samples; and half a unit of the last printed digit (g).
type Expected = (
    &'static str,
    Stage,
    f64,
    &'static [(&'static str, usize, usize)],
    /* half a digit */ f64,
);

pub(crate) const SAMPLES: &[Expected] = &[
    ("peer/nga-west2.AT2", Stage::Corrected, 0.02, &[("360", 0, 103)], 5.0e-8),
    ("peer/poles.AT2", Stage::Corrected, 0.00244, &[("360", 0, 103)], 5.0e-8),
    ("peer/values-first.AT2", Stage::Corrected, 0.02, &[("UP", 0, 103)], 5.0e-8),
    ("peer/cut-header.AT2", Stage::Corrected, 0.02, &[("360", 0, 103)], 5.0e-8),
    ("peer/crcrlf.at2", Stage::Corrected, 0.02, &[("360", 0, 103)], 5.0e-8),
    ("peer/begin-end.at2", Stage::Corrected, 0.02, &[("begin-end", 0, 103)], 5.0e-6),
    (
        "csmip-v1/pairs.RAW",
        Stage::Raw,
        0.005,
        &[("90 DEG", 0, 103), ("UP", 2, 102), ("360 DEG", 1, 102)],
        5.0e-5,
    ),
    (
        "csmip-v1/formatted.RAW",
        Stage::Raw,
        0.01,
        &[("90 Deg", 0, 103), ("360 Deg", 1, 101), ("Up", 2, 102)],
        5.0e-7,
    ),
    ("csmip-v1/spaced.v1", Stage::Raw, 0.005, &[("270 DEG", 0, 103)], 5.0e-7),
    (
        "renadic/example.v1",
        Stage::Raw,
        0.01,
        &[("EW", 0, 103), ("V", 2, 103), ("NS", 1, 103)],
        5.0e-5,
    ),
    ("bhrc/example.V1", Stage::Raw, 0.005, &[("L", 0, 103), ("V", 2, 103), ("T", 1, 103)], 5.0e-7),
    (
        "csmip-v2/example.V2",
        Stage::Corrected,
        0.01,
        &[("H1", 0, 103), ("Up", 2, 103), ("H2", 1, 102)],
        5.1e-9,
    ),
    ("cosmos/example.v2c", Stage::Corrected, 0.01, &[("90 deg", 0, 103)], 5.1e-8),
    ("cosmos/one-a-line.v1c", Stage::Raw, 0.01, &[("90 deg", 0, 103)], 5.1e-8),
    ("smc/corrected.smc", Stage::Corrected, 0.005, &[("360", 0, 103)], 5.1e-6),
    (
        "geonet/example.V2A",
        Stage::Corrected,
        0.02,
        &[("N28W", 0, 103), ("S62W", 1, 103), ("Up", 2, 103)],
        5.1e-6,
    ),
    (
        "geonet/example.V1A",
        Stage::Raw,
        0.02,
        &[("S65E", 0, 103), ("N25E", 1, 103), ("Up", 2, 103)],
        5.1e-6,
    ),
    ("esm/example.ACC.ASC", Stage::Corrected, 0.005, &[("HNE", 0, 103)], 5.1e-10),
    (
        "afad/example.txt",
        Stage::Raw,
        0.01,
        &[("N-S", 0, 103), ("E-W", 1, 103), ("U-D", 2, 103)],
        5.1e-10,
    ),
    ("cwa/example.dat", Stage::Raw, 0.02, &[("U", 2, 100), ("N", 1, 100), ("E", 0, 100)], 5.1e-7),
    (
        "unam/example.012",
        Stage::Raw,
        0.004,
        &[("V;+", 2, 103), ("N90E", 0, 103), ("N00E", 1, 103)],
        5.1e-7,
    ),
    ("columns/bare.txt", Stage::Unknown, 0.02, &[("bare", 0, 103)], 5.0e-8),
    ("columns/time-and-value.csv", Stage::Unknown, 0.02, &[("time-and-value", 0, 103)], 5.0e-8),
    ("columns/count-first.txt", Stage::Unknown, 0.005, &[("count-first", 0, 103)], 5.0e-8),
    ("columns/touching.acc", Stage::Unknown, 0.01, &[("touching", 0, 103)], 5.1e-9),
    (
        "columns/three.csv",
        Stage::Unknown,
        0.01,
        &[("EW acceleration", 0, 103), ("NS acceleration", 1, 103), ("UD acceleration", 2, 103)],
        5.1e-9,
    ),
    ("csmnc/example.dat", Stage::Raw, 0.01, &[("EW", 0, 103)], 5.1e-10),
    ("bbp/example.000", Stage::Unknown, 0.01, &[("000", 0, 103)], 5.1e-7),
    (
        "timeseries/slist.txt",
        Stage::Unknown,
        0.01,
        &[("HNE", 0, 103), ("HNN", 1, 103), ("HNZ", 2, 103)],
        1.3e-8,
    ),
    (
        "timeseries/tspair.txt",
        Stage::Unknown,
        0.01,
        &[("HNE", 0, 103), ("HNN", 1, 103), ("HNZ", 2, 103)],
        1.3e-8,
    ),
    (
        "npz/example.npz",
        Stage::Corrected,
        0.01,
        &[("E", 0, 103), ("N", 1, 103), ("Up", 2, 103)],
        0.0,
    ),
    (
        "barrelstack/example.txt",
        Stage::Corrected,
        0.01,
        &[("E", 0, 103), ("N", 1, 103), ("Up", 2, 103)],
        5.1e-7,
    ),
];

/// Expectations for formats whose offset is removed; the mean of the formula is removed before the
/// comparison.
pub(crate) const OFFSET: &[Expected] = &[
    ("cosmos/counts.v0c", Stage::Raw, 0.005, &[("90 deg", 0, 103)], 2.8e-7),
    ("knet/example.EW", Stage::Raw, 0.01, &[("E-W", 0, 200)], 3.2e-7),
    ("knet/borehole.NS1", Stage::Raw, 0.01, &[("N-S borehole", 1, 200)], 3.2e-7),
    ("sac/little.sac", Stage::Raw, 0.02, &[("HNE", 0, 103)], 7.5e-9),
    ("sac/big.sac", Stage::Raw, 0.02, &[("HNE", 0, 103)], 7.5e-9),
    ("sac-text/example.sac", Stage::Raw, 0.01, &[("HNE", 0, 103)], 7.5e-8),
    ("timeseries/counts.txt", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("gse2/cm6.gse", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("gse2/int.gse", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("seed/example.seed", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("miniseed/int32.mseed", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("miniseed/steim1.mseed", Stage::Raw, 0.01, &[("HNE", 0, 103)], 1.2e-5),
    ("miniseed/steim2.mseed", Stage::Raw, 0.01, &[("HNE", 0, 103)], 3.6e-3),
];

fn check(expected: &Expected, offset: bool) -> Record {
    let (file, stage, step, channels, half) = expected;
    let record = read(&bytes(file), file, &options(file)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(record.format, file.split('/').next().unwrap());
    assert_eq!(record.stage, *stage, "{file}");
    let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
    let wanted: Vec<&str> = channels.iter().map(|c| c.0).collect();
    assert_eq!(names, wanted, "{file}");
    for (channel, (name, component, samples)) in record.channels.iter().zip(*channels) {
        assert!((channel.time_step / step - 1.0).abs() < 1e-9, "{file}: {}", channel.time_step);
        assert_eq!(channel.acceleration.len(), *samples, "{file} {name}");
        let truth: Vec<f64> = (0..*samples).map(|k| formula(*component, k as f64 * step)).collect();
        let mean = if offset { truth.iter().sum::<f64>() / *samples as f64 } else { 0.0 };
        // The header of this sample states a sensitivity other than that of its counts.
        let scale = if file.starts_with("cosmos/counts") { 0.023_282_4 } else { 1.0 };
        let off = channel.acceleration.iter().zip(&truth).map(|(a, b)| a - scale * (b - mean));
        let off = off.fold(0.0_f64, |worst, off| worst.max(off.abs())) / STANDARD_GRAVITY;
        println!("{file} {name}: {off:.1e} g, half a digit {half:.1e} g");
        // Measured: half a digit, and up to 1.06 of half a digit if the offset was removed.
        assert!(off <= 1.1 * half, "{file} {name}: {off:e} g against {half:e} g");
        for peak in &channel.peaks {
            assert!(peak.agrees(), "{file} {name}: {peak:?}");
        }
    }
    record
}

#[test]
fn every_sample_gives_the_formula_it_was_made_from() {
    for expected in SAMPLES {
        check(expected, false);
    }
    for expected in OFFSET {
        check(expected, true);
    }
}

#[test]
fn directions_are_read_from_names() {
    let of = |file: &str| -> Vec<(Option<f64>, Option<Orientation>)> {
        let record = read(&bytes(file), file, &options(file)).unwrap();
        record.channels.iter().map(|c| (c.direction.azimuth, c.direction.orientation)).collect()
    };
    let h = Some(Orientation::Horizontal);
    let v = Some(Orientation::Vertical);
    assert_eq!(of("csmip-v1/pairs.RAW"), [(Some(90.0), h), (None, v), (Some(0.0), h)]);
    assert_eq!(of("geonet/example.V2A"), [(Some(332.0), h), (Some(242.0), h), (None, v)]);
    assert_eq!(of("csmip-v2/example.V2"), [(None, h), (None, v), (None, h)]);
    assert_eq!(of("bhrc/example.V1"), [(Some(50.0), h), (None, v), (Some(140.0), h)]);
    assert_eq!(of("unam/example.012"), [(None, v), (Some(90.0), h), (Some(0.0), h)]);
    assert_eq!(of("cwa/example.dat"), [(None, v), (Some(0.0), h), (Some(90.0), h)]);
    assert_eq!(of("knet/borehole.NS1"), [(Some(0.0), h)]);
    assert_eq!(of("usc/example.y0a"), [(Some(300.0), h)]);
}

#[test]
fn stated_peaks_are_found() {
    for (file, count) in [
        ("csmip-v1/pairs.RAW", 1),
        ("csmip-v1/formatted.RAW", 1),
        ("renadic/example.v1", 1),
        ("csmip-v2/example.V2", 3),
        ("cosmos/example.v2c", 1),
        ("cosmos/counts.v0c", 1),
        ("smc/corrected.smc", 1),
        ("knet/example.EW", 1),
        ("geonet/example.V2A", 3),
        ("geonet/example.V1A", 1),
        ("esm/example.ACC.ASC", 1),
        ("afad/example.txt", 1),
        ("cwa/example.dat", 1),
        ("unam/example.012", 1),
    ] {
        let record = read(&bytes(file), file, &options(file)).unwrap();
        for channel in &record.channels {
            assert_eq!(channel.peaks.len(), count, "{file} {}", channel.name);
            assert!(channel.peaks.iter().all(StatedPeak::agrees), "{file}: {:?}", channel.peaks);
        }
    }
}

#[test]
fn uneven_times_are_interpolated_with_a_warning() {
    for file in ["usc/example.y0a", "smc/uncorrected.smc"] {
        let record = read(&bytes(file), file, &options(file)).unwrap();
        let channel = &record.channels[0];
        assert_eq!(channel.time_step, 0.002, "{file}");
        assert!(record.warnings.iter().any(|w| w.message.contains("uneven")), "{file}");
        for (k, a) in channel.acceleration.iter().enumerate() {
            let truth = 0.3
                * STANDARD_GRAVITY
                * (std::f64::consts::TAU * 1.1 * k as f64 * 0.002).sin()
                * (-0.7 * k as f64 * 0.002).exp();
            assert!((a - truth).abs() < 2e-3 * STANDARD_GRAVITY, "{file} sample {k}");
        }
    }
}

#[test]
fn what_is_no_acceleration_is_refused_by_name() {
    for (file, word) in [
        ("peer/velocity.VT2", "VELOCITY"),
        ("peer/displacement.DT2", "DISPLACEMENT"),
        ("csmip-v2/spectra.v3", "spectra"),
        ("cosmos/degrees.v1c", "unit code 25"),
        ("smc/velocity.smc", "VELOCITY"),
        ("esm/velocity.VEL.ASC", "VELOCITY"),
        ("columns/displacement.csv", "displacement"),
        ("slammer/EQdata.txt", "table"),
    ] {
        let error = read(&bytes(file), file, &options(file)).unwrap_err();
        assert_eq!(error.refusal, Refusal::NotAcceleration, "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn a_known_layout_without_a_reader_is_refused_by_name() {
    let rows = "   1.00  -2.00\n".repeat(20);
    let text = format!("STATION\nSAMPLES/SEC=200\nDATA TYPE=AC\n{rows}");
    let error = read(text.as_bytes(), "blocks.044", &ReadOptions::default()).unwrap_err();
    assert_eq!((error.refusal, error.line), (Refusal::Unrecognized, Some(3)), "{error}");
    assert!(error.to_string().contains("USGS layout of 1987"), "{error}");
}

#[test]
fn what_a_format_does_not_say_must_be_given() {
    for (file, given, word) in [
        ("columns/bare.txt", Given::Step, "time step"),
        ("columns/touching.acc", Given::Step, "time step"),
        ("columns/count-first.txt", Given::Unit, "unit"),
        ("sac/little.sac", Given::UnitOrSensitivity, "sensitivity"),
        ("miniseed/int32.mseed", Given::Sensitivity, "sensitivity"),
        ("cosmos/no-gain.v0c", Given::Sensitivity, "gain"),
    ] {
        let error = read(&bytes(file), file, &ReadOptions::default()).unwrap_err();
        assert_eq!(error.refusal, Refusal::Missing(given), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn what_was_given_and_is_not_needed_is_reported_once() {
    let all = ReadOptions {
        unit: Some(AccelerationUnit::G),
        time_step: Some(0.5),
        sensitivity: Some(4278.0),
        recorded: Some(Quantity::Acceleration),
        ..ReadOptions::default()
    };
    let ignored = |file: &str| -> Vec<&str> {
        let record = read(&bytes(file), file, &all).unwrap();
        let recognized = |what: &&str| {
            let sentence = format!("{what} given was ignored");
            let times = record.warnings.iter().filter(|w| w.message.starts_with(&sentence)).count();
            assert!(times < 2, "{file}: {:?}", record.warnings);
            times == 1
        };
        ["the unit", "the time step", "the sensitivity", "the quantity"]
            .into_iter()
            .filter(recognized)
            .collect()
    };
    for (file, ..) in SAMPLES.iter().chain(OFFSET) {
        let left: &[&str] = match *file {
            "columns/bare.txt" | "columns/touching.acc" => &["the sensitivity", "the quantity"],
            "columns/count-first.txt" => &["the time step", "the sensitivity", "the quantity"],
            "cosmos/counts.v0c" => &["the unit", "the time step", "the quantity"],
            "bbp/example.000" => &["the time step", "the sensitivity"],
            "gse2/cm6.gse" | "gse2/int.gse" | "timeseries/counts.txt" => {
                &["the unit", "the time step"]
            }
            _ if ["sac", "miniseed/", "seed/"].iter().any(|kind| file.starts_with(kind)) => {
                &["the unit", "the time step"]
            }
            _ => &["the unit", "the time step", "the sensitivity", "the quantity"],
        };
        assert_eq!(ignored(file), left, "{file}");
    }
}

#[test]
fn an_option_out_of_its_range_is_no_fault_of_the_file() {
    for given in [
        ReadOptions { time_step: Some(0.0), ..ReadOptions::default() },
        ReadOptions { sensitivity: Some(f64::NAN), ..ReadOptions::default() },
    ] {
        let error = read(&bytes("columns/bare.txt"), "bare.txt", &given).unwrap_err();
        assert_eq!((error.refusal, error.line), (Refusal::Options, None), "{error}");
        assert!(error.to_string().contains("above 0"), "{error}");
    }
}

#[test]
fn a_header_of_our_own_form_that_lacks_a_line_is_damaged() {
    let whole = String::from_utf8(bytes("barrelstack/example.txt")).unwrap();
    for key in ["unit", "time_step", "channels"] {
        let start = format!("# {key}:");
        let lines: Vec<&str> = whole.lines().filter(|line| !line.starts_with(&start)).collect();
        let last = lines.iter().take_while(|line| line.starts_with('#')).count();
        let error =
            read(lines.join("\n").as_bytes(), "n.txt", &ReadOptions::default()).unwrap_err();
        assert_eq!((error.refusal, error.line), (Refusal::Damaged, Some(last)), "{error}");
        assert!(error.to_string().contains(&start), "{error}");
    }
}

#[test]
fn places_of_our_own_form_are_stated_once_or_for_each_channel() {
    let whole = String::from_utf8(bytes("barrelstack/example.txt")).unwrap();
    let bare: Vec<&str> = whole.lines().filter(|line| !line.starts_with("# recorded:")).collect();
    for count in 0..=4 {
        let mut lines = bare.clone();
        for _ in 0..count {
            lines.insert(1, "# recorded: latitude 38.27, longitude -122.28");
        }
        let text = lines.join("\n");
        match read(text.as_bytes(), "n.txt", &ReadOptions::default()) {
            Ok(_) => assert!([0, 1, 3].contains(&count), "{count} lines for three channels"),
            Err(error) => {
                assert!([2, 4].contains(&count), "{error}");
                assert_eq!((error.refusal, error.line), (Refusal::Damaged, Some(count + 1)));
            }
        }
    }
}

#[test]
fn a_wrong_unit_appears_in_the_warnings() {
    let file = "columns/time-and-value.csv";
    let text = String::from_utf8(bytes(file)).unwrap().replace("(g's)", "(cm/s2)");
    let record = read(text.as_bytes(), file, &ReadOptions::default()).unwrap();
    assert!(record.warnings.iter().any(|w| w.message.contains("check the unit")));
    let bare = String::from_utf8(bytes("columns/bare.txt")).unwrap();
    let tall: Vec<String> =
        bare.lines().map(|line| format!("{}", 20.0 * line.parse::<f64>().unwrap())).collect();
    let record =
        read(tall.join("\n").as_bytes(), "tall.txt", &options("columns/bare.txt")).unwrap();
    assert!(
        record.warnings.iter().any(|w| w.message.contains("PGA is 5.")),
        "{:?}",
        record.warnings
    );
}

#[test]
fn the_own_text_form_and_csv_survive_a_round_trip_with_the_initial_velocity() {
    for file in ["csmip-v2/example.V2", "knet/example.EW", "peer/values-first.AT2"] {
        let mut record = read(&bytes(file), file, &options(file)).unwrap();
        record.channels[0].initial_velocity = -0.012_345_678_9;
        for (name, text) in [
            ("copy.txt", write::text(&record).unwrap()),
            ("copy.csv", write::csv(&record).unwrap()),
        ] {
            let again = read(text.as_bytes(), name, &ReadOptions::default()).unwrap();
            assert_eq!(again.channels.len(), record.channels.len());
            for (a, b) in again.channels.iter().zip(&record.channels) {
                assert_eq!(a.acceleration, b.acceleration[..a.acceleration.len()], "{name}");
                assert_eq!(a.initial_velocity.to_bits(), b.initial_velocity.to_bits(), "{name}");
                assert_eq!(a.direction, b.direction);
            }
        }
    }
}

/// Returns the error of reading a file.
fn refusal(bytes: &[u8], name: &str) -> barrelstack_motion::ReadError {
    read(bytes, name, &ReadOptions::default()).unwrap_err()
}

#[test]
fn formats_without_a_reader_are_refused_by_their_names() {
    let mut win = vec![0, 0, 0, 20, 0x20, 0x01, 0x31, 0x23, 0x59, 0x58];
    win.extend([0; 10]);
    win.extend([0, 0, 0, 20, 0x20, 0x01, 0x31, 0x23, 0x59, 0x59]);
    win.extend([0; 10]);
    let win32 = [&[0; 4][..], &[0x20, 0x20, 0x01, 0x31, 0x23, 0x59, 0x58, 0x00], &[0; 40]].concat();
    let card = |length: &[u8]| [length, &[b'X'; 80], length].concat();
    let segy = [b'C'; 3700];
    let cases: [(&[u8], &str); 21] = [
        (b"K\x01\x01\x09\0\0\0\x01\x07\xf8\0\0", "Kinemetrics EVT"),
        (&win, "WIN"),
        (&win32, "WIN"),
        (&card(&[80, 0, 0, 0]), "SEISAN"),
        (&card(&[0, 0, 0, 80]), "SEISAN"),
        (b"MS\x03\x04 and so on", "miniSEED 3"),
        (b"WID1 1990081 12 30 00 000\n", "GSE 1"),
        (&segy, "SEG-Y"),
        (b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MATLAB"),
        (b"TDSm\x0e\0\0\0", "TDMS"),
        (b"\x93NUMPY\x01\0v\0{'descr'", "NumPy"),
        (b"PAR1\x15\x04", "Parquet"),
        (b"CDF\x01\0\0", "NetCDF"),
        (b"\xD0\xCF\x11\xE0\xA1\xB1", "Excel"),
        (b"%PDF-1.7\n1 0 obj", "PDF"),
        (b"\x89PNG\r\n\x1a\n", "PNG"),
        (b"BZh91AY&SY\0\0", "bzip2"),
        (b"7z\xBC\xAF\x27\x1C\0", "7z"),
        (b"<?xml version=\"1.0\"?>\n<!DOCTYPE html>\n<html>", "web page"),
        (b"\x89HDF\r\n\x1a\n\0", "HDF5"),
        (
            b"Response spectra           (Format v01.20 with 13 text lines) Src: made\n",
            "COSMOS volume 3",
        ),
    ];
    for (bytes, name) in cases {
        let error = refusal(bytes, "unknown.bin");
        assert_ne!(error.refusal, Refusal::Damaged, "{name}: {error}");
        assert!(error.found.contains(name), "{name}: {error}");
    }
    // A SEED volume without data contains only metadata.
    let volume = bytes("seed/example.seed");
    let dataless = refusal(&volume[..4 * 4096], "dataless.seed");
    assert_eq!(dataless.refusal, Refusal::NotAcceleration, "{dataless}");
}

#[test]
fn text_formats_that_contradict_themselves_are_refused_with_both_numbers() {
    let of = |file: &str| String::from_utf8(bytes(file)).unwrap();
    let cases = [
        // (file, text to replace, replacement, words of the message)
        ("csmnc/example.dat", "DURATION:  1.03", "DURATION:  2.06", ["1.030", "2.06"]),
        ("csmnc/example.dat", "POINTS:   103", "POINTS:   140", ["140", "1.03"]),
        ("timeseries/slist.txt", "103 samples", "104 samples", ["104", "103"]),
        ("timeseries/tspair.txt", "100 sps", "200 sps", ["200 sps", "0.005"]),
        ("timeseries/tspair.txt", "+2.0175699890e-01", "****************", ["line 3", "\"***"]),
        ("gse2/cm6.gse", "CM6      103", "CM6      102", ["112562", "checksum"]),
        ("gse2/cm6.gse", "CHK2   112562", "CHK2   112563", ["112563", "112562"]),
        ("gse2/int.gse", "INT      103", "INT      104", ["104", "103"]),
        ("bbp/example.000", "103  1.0", "140  1.0", ["140", "103"]),
    ];
    for (file, from, to, said) in cases {
        let text = of(file);
        assert!(text.contains(from), "{file}: {from}");
        let error = read(text.replacen(from, to, 1).as_bytes(), file, &options(file)).unwrap_err();
        assert_eq!(error.refusal, Refusal::Damaged, "{file}: {error}");
        for word in said {
            assert!(error.to_string().contains(word), "{file}: {error}");
        }
    }
}

#[test]
fn velocities_of_new_formats_are_no_accelerations_until_the_caller_has_them_differentiated() {
    let text = String::from_utf8(bytes("timeseries/slist.txt")).unwrap().replace("M/S**2", "M/S");
    let error = refusal(text.as_bytes(), "velocity.txt");
    assert_eq!(error.refusal, Refusal::OtherInstrument, "{error}");
    let options = ReadOptions { recorded: Some(Quantity::Velocity), ..ReadOptions::default() };
    let record = read(text.as_bytes(), "velocity.txt", &options).unwrap();
    // The derivative of a sine of 1.1 Hz is about 7 times as large as the sine.
    let as_read = read(&bytes("timeseries/slist.txt"), "a.txt", &ReadOptions::default()).unwrap();
    let ratio = record.channels[0].pga() / as_read.channels[0].pga();
    assert!((4.0..10.0).contains(&ratio), "{ratio}");
    let csmnc = String::from_utf8(bytes("csmnc/example.dat")).unwrap();
    let csmnc = csmnc.replace("ACCELERATION          UNIT: CM/SEC/SEC", "VELOCITY UNIT: CM/SEC");
    assert_eq!(refusal(csmnc.as_bytes(), "v.dat").refusal, Refusal::NotAcceleration);
    // Broadband Platform text states neither the unit nor the quantity.
    let bbp = refusal(&bytes("bbp/example.000"), "a.000");
    assert_eq!(bbp.refusal, Refusal::Missing(Given::Unit), "{bbp}");
}

#[test]
fn a_title_alone_makes_no_file_of_volume_1_or_2() {
    for title in ["Corrected accelerogram", "UNCORRECTED ACCELEROGRAM DATA"] {
        let row = |k: i32| {
            let time = 0.01 * f64::from(k);
            format!("{time:.2}  {:.6}\n", 1.5 * (6.0 * time).sin())
        };
        let rows: String = (0..60).map(row).collect();
        let text = format!("{title}\ntime (s)  acceleration (m/s2)\n{rows}");
        let record = read(text.as_bytes(), "a.txt", &ReadOptions::default()).unwrap();
        assert_eq!(record.channels.len(), 1);
        assert!((record.channels[0].time_step - 0.01).abs() < 1e-12, "{title}");
    }
}

#[test]
fn sac_of_version_7_is_read_with_the_step_of_its_footer() {
    for (file, big) in [("sac/little.sac", false), ("sac/big.sac", true)] {
        let old = bytes(file);
        let mut new = old.clone();
        let put = |value: f64| if big { value.to_be_bytes() } else { value.to_le_bytes() };
        let version = if big { 7_i32.to_be_bytes() } else { 7_i32.to_le_bytes() };
        new[304..308].copy_from_slice(&version);
        new.extend(put(1.0 / 300.0));
        for _ in 1..22 {
            new.extend(put(-12345.0));
        }
        let [six, seven] =
            [&old, &new].map(|file_bytes| read(file_bytes, file, &options(file)).unwrap());
        assert_eq!(seven.channels[0].acceleration, six.channels[0].acceleration);
        assert_eq!(seven.channels[0].time_step, 1.0 / 300.0);
        let cut = read(&new[..new.len() - 8], file, &options(file)).unwrap_err();
        assert!(cut.to_string().contains("footer"), "{cut}");
    }
}
