//! Reference values of three records, computed with independent programs.
//!
//! The records may not be bundled. The tests run if the folder `../shared/ground-motions` is next
//! to the workspace, and are reported as skipped otherwise.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use crate::shared::shared;
use barrelstack_motion::{
    IntensityMeasure, ReadOptions, STANDARD_GRAVITY, Sampled, dominant_pulse, read, response,
};

/// PGA (g), PGV (m/s), PGD (m), Arias intensity (m/s), CAV (m/s), D5-95 (s), then PSA (g) at 5 %
/// damping for several periods.
struct Row {
    file: &'static str,
    pga: f64,
    pgv: f64,
    pgd: f64,
    arias: f64,
    cav: f64,
    duration: f64,
    spectrum: [f64; 7],
}

const PERIODS: [f64; 7] = [0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0];

const ROWS: [Row; 3] = [
    Row {
        file: "peer/RSN995_NORTHR_PEL360.AT2",
        pga: 0.3583,
        pgv: 0.2737,
        pgd: 0.0303,
        arias: 2.004,
        cav: 11.837,
        duration: 10.65,
        spectrum: [0.6583, 0.9839, 0.6986, 0.6604, 0.4521, 0.0555, 0.0238],
    },
    Row {
        file: "peer/IELC180.AT2",
        pga: 0.3129,
        pgv: 0.2968,
        pgd: 0.1303,
        arias: 1.703,
        cav: 13.110,
        duration: 24.10,
        spectrum: [0.7110, 0.6343, 0.6747, 0.7123, 0.4862, 0.1870, 0.0992],
    },
    Row {
        file: "renadic/hualane1002271.v1",
        pga: 0.3894,
        pgv: 0.5844,
        pgd: 7.7928,
        arias: 7.913,
        cav: 53.426,
        duration: 61.66,
        spectrum: [1.1922, 1.0467, 0.9336, 0.8012, 0.5315, 0.1237, 0.0652],
    },
];

/// Checks a value within half a unit of the reference's last printed digit; measured 0.50 at most.
fn near(what: &str, value: f64, reference: f64, digit: f64) {
    let off = (value - reference).abs() / digit;
    println!("{what}: {value}, off by {off:.2} digits");
    assert!(off <= 0.51, "{what}: {value} against {reference}, off by {off:.2} digits");
}

#[test]
fn the_reference_records_give_the_reference_values() {
    for row in &ROWS {
        let Some(path) = shared(row.file) else { return };
        let bytes = std::fs::read(path).unwrap();
        let record = read(&bytes, row.file, &ReadOptions::default()).unwrap();
        let channel = &record.channels[0];
        let motion = Sampled::new(channel.time_step, channel.acceleration.clone()).unwrap();
        let of = |measure: IntensityMeasure| measure.of(&motion).unwrap();
        near("PGA", motion.pga() / STANDARD_GRAVITY, row.pga, 1e-4);
        near("PGV", motion.pgv(), row.pgv, 1e-4);
        near("PGD", of(IntensityMeasure::Pgd), row.pgd, 1e-4);
        // The exact integral drives a model; for the first record it is 0.37 % larger.
        let exact = motion.pgd() / of(IntensityMeasure::Pgd) - 1.0;
        assert!((0.0..4e-3).contains(&exact), "{}: {exact}", row.file);
        near("Arias", of(IntensityMeasure::Arias), row.arias, 1e-3);
        near("CAV", of(IntensityMeasure::Cav), row.cav, 1e-3);
        let duration = of(IntensityMeasure::D5_95);
        assert!(
            (duration - row.duration).abs() <= channel.time_step,
            "{}: D5-95 {duration}",
            row.file
        );
        for (period, reference) in PERIODS.into_iter().zip(row.spectrum) {
            if period < 10.0 * channel.time_step * (1.0 - 1e-9) {
                continue;
            }
            let peaks = response(channel.time_step, motion.acceleration(), period, 0.05).unwrap();
            let psa = peaks.pseudo_acceleration / STANDARD_GRAVITY;
            near(&format!("{} PSA({period})", row.file), psa, reference, 1e-4);
        }
    }
}

#[test]
fn the_motion_of_the_seed_paper_scales_as_published() {
    let file = "peer/RSN995_NORTHR_PEL360.AT2";
    let Some(path) = shared(file) else { return };
    let record = read(&std::fs::read(path).unwrap(), file, &ReadOptions::default()).unwrap();
    let motion = record.default_motion().unwrap();
    // A corrected record drives a model as published, from its first sample.
    assert_eq!(motion.duration, 1999.0 * 0.02);
    let factor = motion.scale_factor(IntensityMeasure::Pgv, 0.6).unwrap();
    assert!((factor - 2.192).abs() < 5e-4, "{factor}"); // measured 1.9e-4
    let strong = motion.scale_to(IntensityMeasure::Pgv, 0.6).unwrap();
    // Measured: 4.5e-4 g and 6.0e-4 m.
    assert!((strong.pga() / STANDARD_GRAVITY - 0.786).abs() < 6e-4);
    assert!((strong.pgd() - 0.066).abs() < 8e-4);
    let half = strong.froude(0.5);
    assert!((half.pgv() - 0.6 * 0.5_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn the_pulse_of_rinaldi_is_found() {
    let file = "peer/RSN1063_NORTHR_RRS228.AT2";
    let Some(path) = shared(file) else { return };
    let record = read(&std::fs::read(path).unwrap(), file, &ReadOptions::default()).unwrap();
    let channel = &record.channels[0];
    let motion = Sampled::new(channel.time_step, channel.acceleration.clone()).unwrap();
    let fit = dominant_pulse(&motion, 0.4, 8.0).unwrap();
    println!("{fit:?}");
    // Published periods of this pulse are around 1.0 to 1.3 s.
    assert!((0.95..1.4).contains(&fit.period), "{fit:?}");
    // The record's PGV is 1.48 m/s.
    assert!((0.9..1.6).contains(&fit.peak_velocity), "{fit:?}");
    assert!(fit.energy_share > 0.5, "{fit:?}");
}
