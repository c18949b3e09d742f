//! Messages about 75 formats and near-formats, compared with the table in `docs/formats.md`.

#![allow(
    clippy::format_collect,
    clippy::format_push_string,
    reason = "a test fails by unwrap; a table is built as text"
)]

use std::path::Path;

use barrelstack_motion::{AccelerationUnit, ReadOptions, read};

/// Samples in `tests/data` with the names of their formats.
const SAMPLES: [(&str, &str); 36] = [
    ("PEER AT2", "peer/nga-west2.AT2"),
    ("PEER VT2, a velocity", "peer/velocity.VT2"),
    ("CSMIP V1", "csmip-v1/pairs.RAW"),
    ("CSMIP V2", "csmip-v2/example.V2"),
    ("COSMOS V1", "cosmos/one-a-line.v1c"),
    ("COSMOS V2", "cosmos/example.v2c"),
    ("USGS SMC", "smc/corrected.smc"),
    ("USGS SMC, a velocity", "smc/velocity.smc"),
    ("GeoNet V1A", "geonet/example.V1A"),
    ("GeoNet V2A", "geonet/example.V2A"),
    ("RENADIC", "renadic/example.v1"),
    ("USC volume 1", "usc/example.y0a"),
    ("BHRC", "bhrc/example.V1"),
    ("K-NET", "knet/example.EW"),
    ("ESM and ITACA", "esm/example.ACC.ASC"),
    ("ESM, a velocity", "esm/velocity.VEL.ASC"),
    ("AFAD", "afad/example.txt"),
    ("CWA", "cwa/example.dat"),
    ("UNAM", "unam/example.012"),
    ("CSMNC", "csmnc/example.dat"),
    ("Broadband Platform", "bbp/example.000"),
    ("SLIST", "timeseries/slist.txt"),
    ("TSPAIR", "timeseries/tspair.txt"),
    ("TSPAIR or SLIST of counts", "timeseries/counts.txt"),
    ("GSE 2, INT", "gse2/int.gse"),
    ("GSE 2, CM6", "gse2/cm6.gse"),
    ("SAC, binary", "sac/little.sac"),
    ("SAC, text", "sac-text/example.sac"),
    ("miniSEED 2", "miniseed/steim1.mseed"),
    ("full SEED", "seed/example.seed"),
    ("NumPy archive", "npz/example.npz"),
    ("text of this program", "barrelstack/example.txt"),
    ("columns with names", "columns/three.csv"),
    ("one value to a line", "columns/bare.txt"),
    ("a record inside gzip", "packed/record.AT2.gz"),
    ("a record inside zip", "packed/record.zip"),
];

/// Returns files of other formats, recognized by their first bytes.
fn others() -> Vec<(&'static str, Vec<u8>)> {
    let filled = |head: &[u8]| [head, &[0, 1, 2, 3].repeat(200)].concat();
    let table = |header: &str, row: &dyn Fn(u32) -> String| {
        let rows: String = (0..200).map(row).collect();
        format!("{header}\n{rows}").into_bytes()
    };
    let spectrum = |k: u32| format!("{:.3},{:.4},{:.4}\n", 0.02 * f64::from(k), 0.4, 0.2);
    let wave = |k: u32| format!("{:.3},{:.4}\n", 0.01 * f64::from(k), (f64::from(k) * 0.2).sin());
    vec![
        ("HDF5, ASDF", filled(b"\x89HDF\r\n\x1a\n")),
        ("QuakeML, StationXML", b"<?xml version=\"1.0\"?>\n<q:quakeml/>\n".to_vec()),
        ("miniSEED 3", filled(b"MS\x03")),
        ("GSE 1", b"WID1 1990 1 1 0 0 0.0\n".to_vec()),
        ("SEG-Y", [&[0xC3; 3200][..], &[0; 400]].concat()),
        ("SEG-2", filled(&[0x55, 0x3A])),
        ("Kinemetrics EVT", filled(&[b'K', 1, 1, 9, 0, 0, 0, 1])),
        ("MATLAB", filled(b"MATLAB 5.0 MAT-file")),
        ("TDMS", filled(b"TDSm")),
        ("NPY", filled(b"\x93NUMPY\x01\0")),
        ("Parquet", filled(b"PAR1")),
        ("NetCDF", filled(b"CDF\x01")),
        ("Excel before 2007", filled(&[0xD0, 0xCF, 0x11, 0xE0])),
        ("PDF", b"%PDF-1.7\n1 0 obj\n".to_vec()),
        ("PNG", filled(b"\x89PNG\r\n\x1a\n")),
        ("7z", filled(b"7z\xBC\xAF\x27\x1C")),
        ("bzip2", filled(b"BZh91AY&SY")),
        ("a web page", b"<!DOCTYPE html>\n<html>\n".to_vec()),
        ("WAV", filled(b"RIFF\x24\x08\0\0WAVEfmt ")),
        ("SQLite", filled(b"SQLite format 3\0")),
        ("Python pickle", filled(&[0x80, 0x04, 0x95, 0, 1])),
        ("JSON", b"{\n \"dt\": 0.01,\n \"acc\": [0.1, 0.2]\n}\n".to_vec()),
        ("text in UTF-16", b"\xff\xfe0\x00.\x001\x00\n\x00".to_vec()),
        ("an empty file", Vec::new()),
        ("prose", b"This folder holds records.\nAsk the owner.\n".to_vec()),
        ("velocities alone", table("Time (s),Velocity (cm/s)", &wave)),
        ("response spectrum with names", table("Period (s),Sa (g),Sd (cm)", &spectrum)),
        ("response spectrum without names", table("", &|k| spectrum(k + 5))),
        ("Fourier spectrum", table("Frequency (Hz),Fourier amplitude (cm/s),Phase", &spectrum)),
        ("counts in columns", table("Time (s),Counts", &wave)),
        (
            "times behind the values",
            table("acc (g),time (s)", &|k| {
                format!("{:.4},{:.2}\n", (f64::from(k) * 0.2).sin(), 0.01 * f64::from(k))
            }),
        ),
        (
            "times in days",
            table("time,acc (g)", &|k| {
                format!(
                    "{:.10},{:.4}\n",
                    43_831.0 + 0.01 * f64::from(k) / 86_400.0,
                    (f64::from(k) * 0.2).sin()
                )
            }),
        ),
        ("volts", table("Time (s),Acceleration (mV)", &wave)),
        (
            "a mark of a missing value",
            table("Time (s),Acceleration (m/s2)", &|k| {
                if k == 90 { "0.90,-9999\n".to_owned() } else { wave(k) }
            }),
        ),
        (
            "cells in quotation marks",
            table("\"Time (s)\",\"Acceleration (g)\"", &|k| {
                format!("\"{}\"\n", wave(k).trim().replace(',', "\",\""))
            }),
        ),
        (
            "a remark among the rows",
            table("Time (s),Acceleration (g)", &|k| {
                if k == 90 { "# block 2\n".to_owned() } else { wave(k) }
            }),
        ),
        ("universal file", b"    -1\n    58\nmade\n".to_vec()),
        ("columns without a unit", table("time,acc", &wave)),
        (
            "values without a step",
            table("acceleration (g)", &|k| format!("{:.4}\n", (f64::from(k) * 0.2).sin())),
        ),
    ]
}

fn options(file: &str) -> ReadOptions {
    let unit =
        file.starts_with("sac") || file.starts_with("columns/bare") || file.starts_with("bbp");
    let counts = ["miniseed", "gse2", "timeseries/counts"].iter().any(|of| file.starts_with(of));
    ReadOptions {
        unit: unit.then_some(AccelerationUnit::G),
        time_step: file.starts_with("columns/bare").then_some(0.02),
        sensitivity: counts.then_some(4278.19),
        ..ReadOptions::default()
    }
}

/// Returns one row of the table.
fn row(what: &str, file: &str, bytes: &[u8]) -> String {
    let said = match read(bytes, file, &options(file)) {
        Ok(record) => match record.channels.len() {
            1 => "read: 1 channel".to_owned(),
            count => format!("read: {count} channels"),
        },
        Err(error) => {
            let text = format!(
                "refused: expected {}, found {}; {}",
                error.expected, error.found, error.remedy
            );
            text.replace('|', "\\|")
        }
    };
    format!("| {what} | {said} |\n")
}

#[test]
fn what_is_said_of_formats_and_near_formats_is_as_documented() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut table = String::from("| file | result |\n|---|---|\n");
    for (what, file) in SAMPLES {
        table += &row(what, file, &std::fs::read(data.join(file)).unwrap());
    }
    for (what, bytes) in others() {
        let said = row(what, "file", &bytes);
        // An undamaged file must not be called truncated or damaged.
        assert!(!said.contains("damaged") && !said.contains("is truncated"), "{said}");
        table += &said;
    }
    let document = include_str!("../../../docs/formats.md");
    assert!(document.contains(&table), "docs/formats.md should hold\n{table}");
}
