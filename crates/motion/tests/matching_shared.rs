//! The frequency domain alone brings recorded motions to their targets.
//!
//! The records may not be bundled; the test is reported as skipped if their folder is missing.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use crate::shared;
use std::time::Instant;

use barrelstack_motion::{
    Component, MatchMethod, Matching, Processing, ReadOptions, SiteClass, TargetSpectrum, read,
};

const RECORDS: [&str; 8] = [
    "ARL360.at2",
    "IELC180.AT2",
    "NIS090.AT2",
    "RSN1063_NORTHR_RRS228.AT2",
    "RSN1503_CHICHI_TCU065-E.AT2",
    "RSN6_IMPVALL.I_I-ELC180.AT2",
    "RSN995_NORTHR_PEL090.AT2",
    "RSN995_NORTHR_PEL360.AT2",
];

#[test]
fn real_records_meet_codes_in_the_frequency_domain() {
    let Some(folder) = shared::shared("peer") else { return };
    let targets = [
        TargetSpectrum::Eurocode8 {
            ground_acceleration: 0.3,
            site: SiteClass::B,
            small_magnitude: false,
            damping: 0.05,
        },
        TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping: 0.05 },
    ];
    let settings = Matching { method: MatchMethod::Frequency, ..Matching::default() };
    let mut met = 0;
    for file in RECORDS {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let record = read(&bytes, file, &ReadOptions::default()).unwrap();
        let motion =
            record.ground_motion(&Component::Number(1), None, &Processing::none()).unwrap();
        for target in &targets {
            let begin = Instant::now();
            match motion.match_spectrum(target, &settings) {
                Ok(matched) => {
                    met += 1;
                    println!(
                        "{file} {target}: {:.2} % after {} rounds, {:.1?}",
                        100.0 * matched.misfit,
                        matched.rounds,
                        begin.elapsed()
                    );
                }
                Err(error) => println!("{file} {target}: {error}, {:.1?}", begin.elapsed()),
            }
        }
    }
    // Measured: 15 of them, with misfits of 3.8 to 4.7 %; PEL360 to EN 1998-1 stalls at 5.7 %.
    println!("{met} of 16");
    assert!(met >= 15, "{met}");
}
