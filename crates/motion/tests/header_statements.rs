//! Statements of headers in many words: steps by their unit, quantities, and times since 1970.

#![allow(clippy::unwrap_used, reason = "a test fails by unwrap; small tables are built as text")]

use std::fmt::Write as _;

use barrelstack_motion::{ReadError, ReadOptions, Record, Refusal, read};

const STEP: f64 = 0.005;

/// Returns 600 values of a wave (g).
fn wave(k: usize) -> f64 {
    let t = STEP * k as f64;
    0.15 * (9.0 * t).sin() * (-0.3 * t).exp()
}

/// Reads a series of accelerations under a header line, with a step of the caller (s).
fn series(header: &str, step: Option<f64>) -> Result<Record, ReadError> {
    let mut text = format!("Acceleration (g)\n{header}\n");
    (0..600).for_each(|k| writeln!(text, "{:.7}", wave(k)).unwrap());
    read(text.as_bytes(), "made.txt", &ReadOptions { time_step: step, ..ReadOptions::default() })
}

fn plain(text: &str) -> Result<Record, ReadError> {
    read(text.as_bytes(), "made.csv", &ReadOptions::default())
}

/// Steps in words and units of many agencies.
const STATED: [&str; 16] = [
    "sampling rate: 0.005 s",
    "sampling frequency: 0.005 s",
    "Sampling rate : 1/200",
    "Sampling: 200 Hz",
    "Sampled at 5 ms",
    "resampled to 0.005 s",
    "200 Hz",
    "Abtastrate: 200 Hz",
    "tasa de muestreo = 200",
    "Pas de temps: 0.005 s",
    "Pas d'\u{e9}chantillonnage = 0.005",
    "dt: 0,005",
    "samples/sec = 200",
    "muestreo: 200 sps",
    "step = 5e-3 s",
    "Intervalo: 0.005 seg",
];

#[test]
fn a_step_is_read_by_its_unit_whatever_it_is_called() {
    for header in STATED {
        let record = series(header, None).unwrap_or_else(|error| panic!("{header}: {error}"));
        let channel = &record.channels[0];
        assert_eq!((channel.time_step, channel.acceleration.len()), (STEP, 600), "{header}");
    }
    // Numbers that may count other things are no step.
    for header in ["record 200", "station 12 Hz street", "filter 0.1 Hz", "tapered over 0.05 s"] {
        let error = series(header, None).unwrap_err();
        assert!(matches!(error.refusal, Refusal::Missing(_)), "{header}: {error}");
        assert_eq!(series(header, Some(0.01)).unwrap().channels[0].time_step, 0.01, "{header}");
    }
}

#[test]
fn a_step_of_the_caller_never_replaces_that_of_the_file() {
    for header in STATED {
        let record = series(header, Some(0.01)).unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!(record.channels[0].time_step, STEP, "{header}");
        let ignored = |message: &str| message.contains("the time step given was ignored");
        assert!(record.warnings.iter().any(|one| ignored(&one.message)), "{header}");
    }
}

#[test]
fn of_acceleration_velocity_and_displacement_in_ground_letters_one_is_a_channel() {
    let mut text = String::from("t,a_g,v_g,d_g\n");
    (0..600).for_each(|k| {
        let a = wave(k);
        writeln!(text, "{:.3},{a:.7},{:.7},{:.7}", STEP * k as f64, 60.0 * a, 8.0 * a).unwrap();
    });
    match plain(&text) {
        Ok(record) => {
            assert_eq!(record.channels.len(), 1);
            assert!((record.channels[0].pga() / 9.806_65 - 0.13).abs() < 0.03);
        }
        // The letters state no unit.
        Err(error) => assert!(matches!(error.refusal, Refusal::Missing(_)), "{error}"),
    }
}

#[test]
fn a_table_of_periods_is_a_spectrum_in_every_language() {
    for header in
        ["T [s];Se [g]", "T (sec),Sae (g)", "Period (s),Acceleration (g)", "Periodo (s);Sa (g)"]
    {
        let mark = if header.contains(';') { ';' } else { ',' };
        let mut text = format!("{header}\n");
        (1..400).for_each(|k| {
            let period = 0.01 * f64::from(k);
            writeln!(text, "{period:.2}{mark}{:.5}", 0.3 * period * (-period).exp() + 0.05)
                .unwrap();
        });
        let error = plain(&text).unwrap_err();
        assert_eq!(error.refusal, Refusal::NotAcceleration, "{header}: {error}");
    }
}

#[test]
fn a_hole_in_times_since_1970_is_found() {
    let table = |hole: f64| {
        let mut text = String::from("time (s),acceleration (g)\n");
        (0..600).for_each(|k| {
            let late = if k > 300 { hole } else { 0.0 };
            let time = 1_408_875_644.0 + STEP * k as f64 + late;
            writeln!(text, "{time:.3},{:.7}", wave(k)).unwrap();
        });
        plain(&text)
    };
    assert_eq!(table(0.0).unwrap().channels[0].time_step, STEP);
    let error = table(0.5).unwrap_err();
    assert!(!matches!(error.refusal, Refusal::Missing(_)), "{error}");
}
