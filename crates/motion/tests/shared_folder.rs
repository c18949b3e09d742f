//! Every real file in `../shared/ground-motions` is read, or refused for the right reason.
//!
//! Most of these files may not be bundled; the test is reported as skipped if the folder is
//! missing.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::consistency::derivatives_of_one_another;
use crate::shared::shared;
use barrelstack_motion::{
    AccelerationUnit, Channel, Component, History, Orientation, Processing, ReadError, ReadOptions,
    Record, Refusal, STANDARD_GRAVITY, Stage, read,
};

fn folder() -> Option<PathBuf> {
    shared("")
}

/// Returns the reading options for a file, taken from the README of the folder.
fn options(file: &str) -> ReadOptions {
    let g = Some(AccelerationUnit::G);
    match file {
        "columns/ChiChi.txt" => ReadOptions { unit: g, ..ReadOptions::default() },
        _ if file.starts_with("slammer/") && file != "slammer/EQdata.txt" => {
            ReadOptions { unit: g, time_step: Some(0.02), ..ReadOptions::default() }
        }
        _ if file.starts_with("sac/") => ReadOptions { unit: g, ..ReadOptions::default() },
        _ if file.starts_with("mseed/") => {
            ReadOptions { sensitivity: Some(427_819.0), ..ReadOptions::default() }
        }
        _ => ReadOptions::default(),
    }
}

/// Files without acceleration, with a word that the error must contain.
const REFUSED: [(&str, &str); 6] = [
    ("README.md", "convert the file"),
    ("asdf/nc72282711_workspace.h5", "HDF5"),
    ("mseed/BK.CMB.xml", "427819"),
    ("peer/RSN995_NORTHR_PEL360.DT2", "DISPLACEMENT"),
    ("peer/RSN995_NORTHR_PEL360.VT2", "VELOCITY"),
    ("slammer/EQdata.txt", "table"),
];

fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let relative = path.strip_prefix(folder).unwrap().to_str().unwrap();
                found.push(relative.replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

fn read_all(folder: &Path) -> Vec<(String, Result<Record, ReadError>)> {
    files(folder)
        .into_iter()
        .map(|file| {
            let bytes = std::fs::read(folder.join(&file)).unwrap();
            let result = read(&bytes, &file, &options(&file));
            (file, result)
        })
        .collect()
}

#[test]
fn every_file_is_read_or_refused_for_the_right_reason() {
    let Some(folder) = folder() else { return };
    let (mut channels, mut peaks) = (0, 0);
    for (file, result) in read_all(&folder) {
        if let Some((_, word)) = REFUSED.iter().find(|(name, _)| *name == file) {
            let error = result.expect_err(&file);
            assert!(error.to_string().contains(word), "{error}");
            continue;
        }
        let record = result.unwrap_or_else(|error| panic!("{error}"));
        for channel in &record.channels {
            channels += 1;
            for peak in &channel.peaks {
                peaks += 1;
                assert!(peak.agrees(), "{file} {}: {peak:?}", channel.name);
            }
        }
    }
    println!("{channels} channels read, {peaks} stated peaks met");
    assert!(channels >= 55 && peaks >= 45, "{channels} channels, {peaks} peaks");
}

#[test]
fn raw_records_come_to_rest_after_processing_and_stay_consistent() {
    let Some(folder) = folder() else { return };
    let (mut worst, mut count) = ((0.0_f64, 0.0_f64), 0);
    for (file, result) in read_all(&folder) {
        let Ok(record) = result else { continue };
        if record.stage != Stage::Raw {
            continue;
        }
        for number in 1..=record.channels.len() {
            for chain in [Processing::raw(), Processing::compact()] {
                let component = Component::Number(number);
                let motion = record.ground_motion(&component, None, &chain).unwrap();
                let History::Sampled(sampled) = &motion.horizontal else {
                    panic!("a processed record is sampled")
                };
                let end = sampled.at(sampled.duration());
                let (v, d) =
                    (end.velocity.abs() / sampled.pgv(), end.displacement.abs() / sampled.pgd());
                assert!(v < 1e-3 && d < 1e-2, "{file} #{number}: {v:e}, {d:e}");
                worst = (worst.0.max(v), worst.1.max(d));
                count += 1;
                derivatives_of_one_another(&file, sampled);
            }
        }
    }
    println!(
        "{count} processed components end with at most {:.1e} of PGV and {:.1e} of PGD",
        worst.0, worst.1
    );
    assert!(count >= 60, "{count}");
}

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("FORMATS.md")
}

#[test]
fn the_table_of_results_is_current() {
    let Some(folder) = folder() else { return };
    let written = std::fs::read_to_string(page()).unwrap();
    assert!(
        written == table_of_results(&folder),
        "FORMATS.md is not what the readers give; regenerate it with \
         cargo test -p barrelstack-motion --test all shared_folder -- --ignored"
    );
}

/// Rewrites `FORMATS.md` from the folder: `cargo test -p barrelstack-motion --test all shared_folder
/// -- --ignored`.
#[test]
#[ignore = "writes FORMATS.md into the source tree"]
fn the_table_of_results_is_written() {
    let folder = folder().expect("the folder of shared records");
    std::fs::write(page(), table_of_results(&folder)).unwrap();
}

/// Formats the azimuth in degrees clockwise from north, or the known orientation.
fn azimuth(channel: &Channel) -> String {
    match (channel.direction.azimuth, channel.direction.orientation) {
        (Some(azimuth), _) => azimuth.to_string(),
        (None, Some(Orientation::Vertical)) => "up".to_owned(),
        (None, Some(Orientation::Horizontal)) => "horizontal".to_owned(),
        (None, None) => "unknown".to_owned(),
    }
}

/// Formats the results of the readers for every file as a page.
fn table_of_results(folder: &Path) -> String {
    let mut text = String::from(
        "# Formats read\n\nThis page lists how every file of the shared folder `ground-motions` is read.\n\
         PGV and PGD result from trapezoidal integration without filtering; for a raw record, they are mostly drift.\n\
         The last column counts the stated peaks that the samples meet, and gives the largest relative difference.\n\
         Regenerate with `cargo test -p barrelstack-motion --test all shared_folder -- --ignored`.\n\n\
         | file | format | stage | channel | azimuth (°) | start (UTC) | step (s) | samples | PGA (g) | PGV (cm/s) | PGD (cm) | stated peaks |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut refused = String::from("\n## Refused\n\n| file | reason |\n| --- | --- |\n");
    let mut warned = String::from("\n## Warnings\n\n| file | warning |\n| --- | --- |\n");
    for (file, result) in read_all(folder) {
        match result {
            Err(error) => {
                assert_ne!(error.refusal, Refusal::Damaged, "{error}");
                let reason = error.to_string();
                let reason = reason.strip_prefix(&file).unwrap_or(&reason);
                let reason = reason.trim_start_matches([',', ':', ' ']);
                writeln!(refused, "| {file} | {reason} |").unwrap();
            }
            Ok(record) => {
                for channel in &record.channels {
                    let worst = channel
                        .peaks
                        .iter()
                        .map(|p| (p.measured / p.stated - 1.0).abs())
                        .fold(0.0, f64::max);
                    let stated = if channel.peaks.is_empty() {
                        "none".to_owned()
                    } else {
                        format!("{} met, {:.2} %", channel.peaks.len(), 100.0 * worst)
                    };
                    writeln!(
                        text,
                        "| {file} | {} | {} | {} | {} | {} | {} | {} | {:.4} | {:.2} | {:.2} | {stated} |",
                        record.format,
                        record.stage,
                        channel.name,
                        azimuth(channel),
                        channel.start.map_or("not stated".to_owned(), |start| start.to_string()),
                        channel.time_step,
                        channel.acceleration.len(),
                        channel.pga() / STANDARD_GRAVITY,
                        100.0 * channel.pgv(),
                        100.0 * channel.pgd(),
                    )
                    .unwrap();
                }
                for warning in &record.warnings {
                    writeln!(warned, "| {file} | {warning} |").unwrap();
                }
            }
        }
    }
    text.push_str(&refused);
    text.push_str(&warned);
    text
}
