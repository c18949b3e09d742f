//! Header statements about columns (step, count, unit, factor) and contradictions with the rows.

#![allow(clippy::format_collect, reason = "small tables are built as text")]

use crate::columns::{given, refused, wave};
use barrelstack_motion::{AccelerationUnit, ReadOptions, Refusal, read};

#[test]
fn steps_and_counts_are_read_in_the_languages_of_the_agencies() {
    let rows: String = (0..60).map(|k| format!("{:.4}\n", (0.2 * f64::from(k)).sin())).collect();
    for (step, count) in [
        ("Passo di campionamento (s): 0.005", "Numero dati: 60"),
        ("Frequenza di campionamento: 200 Hz", "Numero di campioni: 60"),
        ("Intervalo de muestreo: 0.005 s", "Numero de datos: 60"),
    ] {
        let text = format!("{step}\n{count}\naccelerations in cm/s2\n{rows}");
        let record = read(text.as_bytes(), "t.txt", &ReadOptions::default());
        let record = record.unwrap_or_else(|error| panic!("{step}: {error}"));
        assert!((record.channels[0].time_step - 0.005).abs() < 1e-9, "{step}");
        let text = text.replace(": 60", ": 90");
        let error = read(text.as_bytes(), "t.txt", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("90"), "{count}: {error}");
    }
}

#[test]
fn a_velocity_stated_on_the_line_of_the_count_is_refused_whatever_the_unit_given() {
    let rows: String = (0..60).map(|k| format!("{:.5E}\n", (0.2 * f64::from(k)).sin())).collect();
    for quantity in ["VELOCITY IN M/SEC", "Displacement in cm"] {
        let text = format!("{quantity}, NPTS=   60, DT= .00500 SEC\n{rows}");
        let given = ReadOptions { unit: Some(AccelerationUnit::G), ..ReadOptions::default() };
        for options in [given, ReadOptions::default()] {
            let error = read(text.as_bytes(), "t.txt", &options).unwrap_err();
            assert_eq!(error.refusal, Refusal::NotAcceleration, "{quantity}: {error}");
        }
    }
}

/// Returns 60 positive and negative values, one per line.
fn waves() -> String {
    (0..60).map(|k| format!("{:.4}\n", (0.3 * f64::from(k)).sin())).collect()
}

#[test]
fn a_step_in_other_words_or_under_the_name_of_the_rate_is_taken() {
    for stated in [
        "sampling rate: 0.005 s",
        "sampling frequency: 0.005 s",
        "Sampling rate : 1/200",
        "Sampling: 200 Hz",
        "200 Hz",
        "delta = 0.005",
        "dt: 0,005",
        "SAMPLES/SEC=200",
        "rate: 200",
        "Abtastrate: 200 Hz",
        "Original dt 0.01 s, resampled to 0.005 s",
        "interval 5 ms",
    ] {
        let text = format!("Station NOW\n{stated}\nAcceleration in cm/s2\n{}", waves());
        // A step given by the caller must not replace the stated step.
        let given = ReadOptions { time_step: Some(0.02), ..ReadOptions::default() };
        match read(text.as_bytes(), "t.txt", &given) {
            Ok(record) => assert!((record.channels[0].time_step - 0.005).abs() < 1e-9, "{stated}"),
            Err(error) => assert!(error.to_string().contains("step"), "{stated}: {error}"),
        }
    }
}

#[test]
fn numbers_that_are_no_steps_leave_the_step_given() {
    for other in [
        "Baud rate: 9600",
        "delta = 0.083",
        "delta = 50",
        "Slip rate: 25 mm/yr",
        "taper of 0.1 s at both ends of 60 values",
        "step 0.02",
        "Instrument: Kinemetrics ETNA, deployed 2010",
    ] {
        let text = format!("Station NOW\n{other}\nunit: cm/s2\n{}", waves());
        let given = ReadOptions { time_step: Some(0.01), ..ReadOptions::default() };
        let record = read(text.as_bytes(), "t.txt", &given);
        let record = record.unwrap_or_else(|error| panic!("{other}: {error}"));
        assert!((record.channels[0].time_step - 0.01).abs() < 1e-12, "{other}");
    }
}

#[test]
fn letters_of_the_ground_are_quantities_and_rotations_and_spectra_are_refused() {
    let table = |header: &str, mark: &str| {
        let rows: String = (0..60)
            .map(|k| {
                let t = 0.01 * f64::from(k);
                let columns = header.matches(mark).count();
                let sine = |j: usize| format!("{mark}{:.5}", (30.0 * t + j as f64).sin() + 0.1);
                format!("{t:.2}{}\n", (0..columns).map(sine).collect::<String>())
            })
            .collect();
        let given = ReadOptions { unit: Some(AccelerationUnit::G), ..ReadOptions::default() };
        read(format!("{header}\n{rows}").as_bytes(), "t.csv", &given)
    };
    assert_eq!(table("t,a_g,v_g,d_g", ",").unwrap().channels.len(), 1);
    assert_eq!(table("time (s),Acc (N),Acc (E),Acc (V)", ",").unwrap().channels.len(), 3);
    for (header, mark) in [
        ("T [s];Se [g]", ";"),
        ("T (sec),Sae (g)", ","),
        ("Periodo (s),Acc (g)", ","),
        ("time (s),NS (rad/s)", ","),
        ("Zeit (s);Geschwindigkeit (cm/s)", ";"),
    ] {
        let error = table(header, mark).unwrap_err();
        assert_eq!(error.refusal, Refusal::NotAcceleration, "{header}: {error}");
    }
}

#[test]
fn a_hole_in_times_since_1970_is_found() {
    let table = |hole: f64| {
        let rows: String = (0..400)
            .map(|k| {
                let t = 1_577_836_800.0 + 0.01 * f64::from(k) + if k < 200 { 0.0 } else { hole };
                format!("{t:.2},{:.4}\n", (0.3 * f64::from(k)).sin())
            })
            .collect();
        let text = format!("timestamp (s),acc (g)\n{rows}");
        read(text.as_bytes(), "t.csv", &ReadOptions::default())
    };
    assert!((table(0.0).unwrap().channels[0].time_step - 0.01).abs() < 1e-9);
    for hole in [0.03, 0.5, 1.0] {
        // A short gap is filled with a warning.
        if let Ok(record) = table(hole) {
            let warned = record.warnings.iter().any(|w| w.message.contains("unevenly spaced"));
            assert!(warned && hole < 0.1, "{hole}: {:?}", record.warnings);
        }
    }
}

#[test]
fn a_hole_in_times_behind_row_numbers_is_found() {
    let table = |lost: std::ops::Range<usize>| -> String {
        let rows = (0..3200).filter(|k| !lost.contains(k)).enumerate();
        rows.map(|(row, k)| format!("{row},{:.3},{:.5}\n", 0.005 * k as f64, wave(k))).collect()
    };
    let text = |lost| format!("No,Time (s),Acceleration (m/s2)\n{}", table(lost));
    let record = given(&text(0..0), &ReadOptions::default());
    assert!((record.channels[0].time_step - 0.005).abs() < 1e-12);
    refused(&text(1000..1060), "a gap of 0.3050 s");
}

#[test]
fn a_factor_beside_the_unit_is_not_passed_over() {
    let values: String = (0..400).map(|k| format!("{:.5}\n", 100.0 * wave(k))).collect();
    for unit in [
        "units: 0.001 g",
        "units: thousandths of g",
        "units: 10^-3 g",
        "units: 1/100 g",
        "units: g x 100",
        "unit = 0.01 m/s2",
        "units: cm/s2 (x 10)",
        "Acceleration in units of 0.1 gal",
    ] {
        let text = format!("dt = 0.005 s\n{unit}\n{values}");
        let error = read(text.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err();
        assert_eq!(error.refusal, Refusal::Damaged, "{unit}: {error}");
    }
    for (unit, factor) in [("units: % g", 0.01), ("units: percent g", 0.01), ("unit = 1 g", 1.0)] {
        let record = given(&format!("dt = 0.005 s\n{unit}\n{values}"), &ReadOptions::default());
        let plain = given(&format!("dt = 0.005 s\nunit: g\n{values}"), &ReadOptions::default());
        let right = factor * plain.channels[0].pga();
        assert!((record.channels[0].pga() / right - 1.0).abs() < 1e-9, "{unit}");
    }
    for unit in ["units: cm/s2", "units = g, npts = 400", "Acceleration in units of gal"] {
        given(&format!("dt = 0.005 s\n{unit}\n{values}"), &ReadOptions::default());
    }
}

#[test]
fn pairs_of_time_and_value_beside_each_other_are_no_channels() {
    let row = |k: usize| -> String {
        (0..4)
            .map(|j| format!("{:.3}, {:.5}, ", 0.005 * (4 * k + j) as f64, wave(4 * k + j)))
            .collect()
    };
    let rows: String = (0..200).map(|k| row(k).trim_end_matches(", ").to_owned() + "\n").collect();
    refused(&format!("*AMPLITUDE, NAME=QUAKE\n{rows}"), "one time per row");
}

#[test]
fn a_step_given_that_contradicts_a_frequency_under_unknown_words_is_refused() {
    let read_with = |stated: &str, step: f64| {
        let text = format!("{stated}\nunits: cm/s2\n{}", waves());
        let options = ReadOptions { time_step: Some(step), ..ReadOptions::default() };
        read(text.as_bytes(), "t.txt", &options)
    };
    for stated in ["Tasten frekvens (Hz) : 200", "Kadar pensampelan : 200 Hz"] {
        let error = read_with(stated, 0.01).unwrap_err();
        assert!(error.found.contains("0.01 s"), "{stated}: {error}");
        assert!((read_with(stated, 0.005).unwrap().channels[0].time_step - 0.005).abs() < 1e-12);
    }
    for other in [
        "Filter corner: 50 Hz",
        "Nyquist (Hz): 50",
        "Natural frequency (Hz): 50",
        "Low cut: 0.1 Hz",
    ] {
        let record = read_with(other, 0.01).unwrap_or_else(|error| panic!("{other}: {error}"));
        assert!((record.channels[0].time_step - 0.01).abs() < 1e-12, "{other}");
    }
}

#[test]
fn a_count_below_the_values_is_no_sample() {
    let text = format!("dt = 0.005 s\nunits: mm/s2\n{}60\n", waves());
    let record = given(&text, &ReadOptions::default());
    assert_eq!(record.channels[0].acceleration.len(), 60);
    assert!(record.warnings.iter().any(|warning| warning.message.contains("60 is the number")));
}
