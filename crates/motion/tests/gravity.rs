//! Gravity recorded by accelerometers is removed from every axis in every unit, and no other mean
//! is accepted as ground motion.

#![allow(clippy::format_collect, reason = "small tables are built as text")]

use crate::columns::wave;
use barrelstack_motion::{Channel, ReadOptions, Record, STANDARD_GRAVITY, read};

const UNITS: [(&str, f64); 6] = [
    ("g", STANDARD_GRAVITY),
    ("m/s2", 1.0),
    ("cm/s2", 0.01),
    ("mm/s2", 0.001),
    ("mg", 1e-3 * STANDARD_GRAVITY),
    ("ft/s2", 0.3048),
];

/// Returns a table of three axes, each with a component of gravity (m/s²).
fn phone(unit: (&str, f64), parts: [f64; 3]) -> String {
    let (word, factor) = unit;
    let row = |k: usize| {
        let a = wave(k);
        let axes = [a, 0.5 * a, 0.2 * a];
        let values = std::iter::zip(axes, parts).map(|(a, part)| (a + part) / factor);
        let values: Vec<String> = values.map(|value| format!("{value:.7}")).collect();
        format!("{:.3},{}\n", 0.005 * k as f64, values.join(","))
    };
    let rows: String = (0..3200).map(row).collect();
    format!("time (s),ax ({word}),ay ({word}),az ({word})\n{rows}")
}

fn given(text: &str) -> Record {
    read(text.as_bytes(), "a.csv", &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn gravity_is_in_no_peak_whatever_the_axis_its_sign_and_the_unit() {
    for unit in UNITS {
        for axis in 0..3 {
            for part in [9.81, -9.81, 9.6, 10.1] {
                let mut parts = [0.0; 3];
                parts[axis] = part;
                let record = given(&phone(unit, parts));
                let peaks: Vec<f64> = record.channels.iter().map(Channel::pga).collect();
                // Measured: 5.8e-4.
                for (peak, right) in std::iter::zip(&peaks, [1.5, 0.75, 0.3]) {
                    assert!((peak / right - 1.0).abs() < 2e-3, "{unit:?} {parts:?}: {peaks:?}");
                }
                let said = record.warnings.iter().filter(|w| w.message.contains("is gravity"));
                assert_eq!(said.count(), 1, "{unit:?} {parts:?}: {:?}", record.warnings);
            }
        }
    }
}

#[test]
fn gravity_is_found_over_tilted_axes_and_the_tilt_is_stated() {
    let (part, up) = (9.81 * 30_f64.to_radians().sin(), 9.81 * 30_f64.to_radians().cos());
    for unit in UNITS {
        let record = given(&phone(unit, [part, 0.0, up]));
        // Measured: 8.6e-4 and 1.8e-4.
        assert!((record.channels[0].pga() - 1.5).abs() < 2e-3, "{}", record.channels[0].pga());
        assert!((record.channels[2].pga() - 0.3).abs() < 2e-3, "{}", record.channels[2].pga());
        let tilt = record.warnings.iter().filter(|w| w.message.contains("30 degrees off"));
        assert_eq!(tilt.count(), 1, "{:?}", record.warnings);
    }
}

#[test]
fn values_alone_lose_gravity_and_their_stated_peak_is_compared_without_it() {
    for (word, factor) in UNITS {
        let values: String =
            (0..3200).map(|k| format!("{:.7}\n", (wave(k) + 9.81) / factor)).collect();
        let pga = 1.5 / factor;
        let record = given(&format!("unit: {word}\ndt = 0.005 s\nPGA = {pga:.4}\n{values}"));
        let channel = &record.channels[0];
        // Measured: 8.6e-4.
        assert!((channel.pga() - 1.5).abs() < 2e-3, "{word}: {}", channel.pga());
        assert!(channel.peaks.iter().all(|peak| (peak.measured - 1.5).abs() < 2e-3));
    }
}

/// The mean is gravity with a wrong unit, or the axis is one of several of which the others are
/// missing.
#[test]
fn another_mean_is_refused_with_advice_that_works() {
    for (word, mean) in [("g", 9.81 * STANDARD_GRAVITY), ("m/s2", 1.0), ("m/s2", 6.9)] {
        let factor = if word == "g" { STANDARD_GRAVITY } else { 1.0 };
        let table = |mean: f64| -> String {
            let row = |k: usize| {
                let (t, a) = (0.005 * k as f64, 0.5 * wave(k) + mean);
                format!("{t:.3},{:.7}\n", a / factor)
            };
            format!("time (s),ax ({word})\n{}", (0..3200).map(row).collect::<String>())
        };
        let error = read(table(mean).as_bytes(), "a.csv", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("a mean of"), "{error}");
        // Measured: 1.6e-7.
        assert!((given(&table(0.0)).channels[0].pga() - 0.75).abs() < 1e-6);
    }
}
