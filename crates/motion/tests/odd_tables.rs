//! Tables as other programs write them: column orders, instrument units, placeholders for missing
//! values, remarks among the rows. Each is read as the wave, or is refused with a correct reason
//! and a remedy that works.

#![allow(clippy::format_collect, reason = "small tables are built as text")]

use crate::columns::{given, wave};
use barrelstack_motion::{AccelerationUnit, ReadOptions, Refusal, read};

const ROWS: usize = 3200;

/// Returns rows with time and wave (m/s²) in the layout of a format.
fn rows(row: impl Fn(usize, f64, f64) -> String) -> String {
    (0..ROWS).map(|k| row(k, 0.005 * k as f64, wave(k))).collect()
}

fn plain(k: usize, t: f64, a: f64) -> String {
    let _ = k;
    format!("{t:.3},{a:.6}\n")
}

fn refusal(text: &str) -> (Refusal, String) {
    let error = read(text.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err();
    (error.refusal, error.to_string())
}

/// Checks that a table is read as the wave and nothing else.
fn is_the_wave(text: &str, channels: usize) {
    let record = given(text, &ReadOptions::default());
    assert_eq!(record.channels.len(), channels);
    let first = &record.channels[0];
    assert_eq!((first.acceleration.len(), first.time_step), (ROWS, 0.005));
    assert!((first.pga() - 1.5).abs() < 1e-3, "{}", first.pga());
}

#[test]
fn times_behind_the_accelerations_are_times() {
    is_the_wave(
        &format!("Acceleration (m/s2),Time (s)\n{}", rows(|_, t, a| format!("{a:.6},{t:.3}\n"))),
        1,
    );
    let three = rows(|k, t, a| format!("{k},{a:.6},{:.6},{t:.3},{:.6}\n", 0.5 * a, 0.2 * a));
    is_the_wave(&format!("No,EW (m/s2),NS (m/s2),Time (s),UD (m/s2)\n{three}"), 3);
    let lost = format!(
        "Acceleration (m/s2),Time (s)\n{}",
        rows(|k, t, a| if (900..960).contains(&k) {
            String::new()
        } else {
            format!("{a:.6},{t:.3}\n")
        })
    );
    assert!(refusal(&lost).1.contains("a gap of 0.3050 s"));
}

#[test]
fn the_length_of_a_vector_is_no_channel_under_any_name() {
    let table = rows(|_, t, a| {
        let (b, c) = (0.6 * a, 0.3 * a);
        format!("{t:.3},{a:.6},{b:.6},{c:.6},{:.6}\n", (a * a + b * b + c * c).sqrt())
    });
    is_the_wave(&format!("time (s),ax (m/s2),ay (m/s2),az (m/s2),aT (m/s2)\n{table}"), 3);
    is_the_wave(&format!("time (s),X (m/s2),Y (m/s2),Z (m/s2),all (m/s2)\n{table}"), 3);
}

#[test]
fn times_in_days_hours_and_minutes_are_not_read_as_seconds() {
    for (unit, digits) in [(86_400.0, 10), (3600.0, 9), (60.0, 8)] {
        for name in ["Time", "t"] {
            let table = rows(|_, t, a| format!("{:.digits$},{a:.6}\n", 43_831.0 + t / unit));
            let (_, said) = refusal(&format!("{name},Acceleration (m/s2)\n{table}"));
            assert!(said.contains("without a unit"), "{said}");
        }
    }
    let days = rows(|_, t, a| format!("{:.10},{a:.6}\n", t / 86_400.0));
    let (_, said) = refusal(&format!("Time (s),Acceleration (m/s2)\n{days}"));
    assert!(said.contains("multiply days by 86400"), "{said}");
}

#[test]
fn a_mark_of_a_missing_value_is_no_acceleration() {
    for (unit, factor) in
        [("m/s2", 1.0), ("cm/s2", 100.0), ("mm/s2", 1000.0), ("g", 1.0 / 9.806_65)]
    {
        for mark in ["-9999", "-999", "9999", "-99999", "1e9", "-999.25"] {
            let table = rows(|k, t, a| {
                let value = if k == 700 { mark.to_owned() } else { format!("{:.6}", factor * a) };
                format!("{t:.3},{value}\n")
            });
            let (refusal, said) = refusal(&format!("Time (s),Acceleration ({unit})\n{table}"));
            assert_eq!(refusal, Refusal::Damaged, "{unit} {mark}: {said}");
            assert!(said.contains("missing value"), "{unit} {mark}: {said}");
        }
    }
    // A wave may pass through a number that resembles a placeholder.
    let off = |k: &usize| (wave(*k) - 0.999).abs();
    let near = (0..ROWS).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    let smooth =
        rows(|k, t, a| format!("{t:.3},{:.3}\n", if k == near { 999.0 } else { 1000.0 * a }));
    given(&format!("Time (s),Acceleration (mm/s2)\n{smooth}"), &ReadOptions::default());
}

#[test]
fn units_of_instruments_are_refused_whatever_the_unit_given() {
    for unit in ["mV", "LSB", "volts", "counts"] {
        for text in [
            format!("Time (s),Acceleration ({unit})\n{}", rows(plain)),
            format!("dt = 0.005 s\nunits: {unit}\n{}", rows(|_, _, a| format!("{a:.6}\n"))),
        ] {
            for unit in [None, Some(AccelerationUnit::G)] {
                let options = ReadOptions { unit, ..ReadOptions::default() };
                let error = read(text.as_bytes(), "a.txt", &options).unwrap_err();
                assert_eq!(error.refusal, Refusal::NotAcceleration, "{error}");
            }
        }
    }
    for word in ["Unidades: cm/s2", "Einheit: cm/s2", "Satuan : gal", "UNITA: cm/s^2"] {
        let values = rows(|_, _, a| format!("{:.4}\n", 100.0 * a));
        is_the_wave(&format!("dt = 0.005 s\n{word}\n{values}"), 1);
    }
    for (unit, factor) in [("milli-g", 1000.0), ("percent g", 100.0), ("g-force", 1.0)] {
        let table = rows(|_, t, a| format!("{t:.3},{:.6}\n", factor * a / 9.806_65));
        is_the_wave(&format!("Time (s),Acceleration ({unit})\n{table}"), 1);
    }
}

#[test]
fn steps_of_other_programs_and_languages_precede_the_one_given() {
    for stated in [
        "Delta_X\t0.005",
        "wf_increment=0.005",
        "SAMPLING_INTERVAL_S: 0.005",
        "sampling_rate_hz: 200",
        "3200 points, 0.005 sec, scaled in m/s2",
        "Laju cuplik (Hz) : 200",
        "частота дискретизации: 200",
        "采样频率: 200 Hz",
    ] {
        let text = format!("{stated}\nunits: m/s2\n{}", rows(|_, _, a| format!("{a:.6}\n")));
        let given = ReadOptions { time_step: Some(0.01), ..ReadOptions::default() };
        let record = read(text.as_bytes(), "a.txt", &given);
        let record = record.unwrap_or_else(|error| panic!("{stated}: {error}"));
        assert!((record.channels[0].time_step - 0.005).abs() < 1e-12, "{stated}");
    }
}

#[test]
fn a_factor_above_the_values_is_not_passed_over() {
    let values = rows(|_, _, a| format!("    {:.4}\n", 1e-3 * a));
    let text = format!("dt = 0.005 s, units = m/s2\n\nacc =\n\n   1.0e+03 *\n\n{values}");
    assert!(refusal(&text).1.contains("a factor of all values below"));
}

#[test]
fn units_of_other_quantities_in_a_row_of_units_are_units() {
    let table = rows(|_, t, a| format!("{t:.3},{a:.6},{:.4},{:.3}\n", 0.1 * a, 3.0 * a));
    is_the_wave(&format!("Time,Table Accel,Table Disp,Load Cell\ns,m/s2,mm,kN\n{table}"), 1);
}

/// Checks that a table is refused with the given words, and that the corrected table is read.
fn obeyed(wrong: &str, word: &str, mended: &str) {
    let (_, said) = refusal(wrong);
    assert!(said.contains(word) && !said.contains("damaged"), "{word}: {said}");
    is_the_wave(mended, 1);
}

#[test]
fn what_stands_among_the_rows_is_named_and_may_be_left_out() {
    let whole = format!("Time (s),Acceleration (m/s2)\n{}", rows(plain));
    let with = |line: &str| {
        let at = whole.match_indices('\n').nth(1000).unwrap().0 + 1;
        format!("{}{line}\n{}", &whole[..at], &whole[at..])
    };
    for line in ["# block 2", "Time (s),Acceleration (m/s2)", "PAGE 2", "! next"] {
        obeyed(&with(line), "words among the rows", &whole);
    }
    for footer in ["END OF DATA", "Max,0.15", "];"] {
        obeyed(&format!("{whole}{footer}\n"), "words among the rows", &whole);
    }
    obeyed(&with(""), "a blank line among the rows", &whole);
    let minus = whole.replace('-', "\u{2212}");
    obeyed(&minus, "with hyphens for minus signs", &whole);
    let last = whole.rfind('-').unwrap();
    let minus = format!("{}\u{2212}{}", &whole[..last], &whole[last + 1..]);
    obeyed(&minus, "a dash for the minus sign", &whole);
    let booked =
        rows(
            |k, t, a| {
                if k > 9 && a < 0.0 { format!("{t:.3},({:.6})\n", -a) } else { plain(k, t, a) }
            },
        );
    let booked = format!("Time (s),Acceleration (m/s2)\n{booked}");
    obeyed(&booked, "write only the number", &whole);
    let thousands = whole.replacen("1.4", "1.013.4", 1);
    obeyed(&thousands, "several points", &whole);
    let quoted = format!(
        "\"Time (s)\",\"Acceleration (m/s2)\"\n{}",
        rows(|_, t, a| format!("\"{t:.3}\",\"{a:.6}\"\n"))
    );
    obeyed(&quoted, "other characters next to the numbers", &whole);
    let drawn = format!(
        "| Time (s) | Acceleration (m/s2) |\n|---|---|\n{}",
        rows(|_, t, a| format!("| {t:.3} | {a:.6} |\n"))
    );
    obeyed(&drawn, "other characters next to the numbers", &whole);
}

#[test]
fn further_columns_of_times_are_left_out_if_they_agree() {
    let (ms, us) = (1e3, 1e6);
    for (header, factors) in [
        ("Time (s),Time (ms),Acceleration (m/s2)", [1.0, ms]),
        ("Time (ms),Time (s),Acceleration (m/s2)", [ms, 1.0]),
        ("Timestamp,Time (s),Acceleration (m/s2)", [us, 1.0]),
        ("Time (s),elapsed,Acceleration (m/s2)", [1.0, ms]),
    ] {
        let [one, two] = factors;
        let table = rows(|_, t, a| format!("{:.3},{:.3},{a:.6}\n", one * t, two * t));
        is_the_wave(&format!("{header}\n{table}"), 1);
    }
    let pairs = rows(|_, t, a| format!("{t:.3},{a:.6},{t:.3},{:.6}\n", 0.5 * a));
    is_the_wave(&format!("Time (s),Acc1 (m/s2),Time (s),Acc2 (m/s2)\n{pairs}"), 2);
    let other = rows(|_, t, a| format!("{t:.3},{:.3},{a:.6}\n", 2.0 * t));
    let (_, said) = refusal(&format!("Time (s),Time (s),Acceleration (m/s2)\n{other}"));
    assert!(said.contains("several time columns that agree"), "{said}");
}

#[test]
fn marks_among_comparable_values_are_found() {
    for (peak, marks) in [(400.0, 1), (400.0, 3), (580.0, 1), (850.0, 4)] {
        for mark in ["-999", "999", "-999.0"] {
            let rough = |k: usize, a: f64| if k.is_multiple_of(2) { a } else { -a } * peak / 1.5;
            let table = rows(|k, t, a| {
                let marked = (700..700 + marks).contains(&k);
                let value = rough(k, a);
                format!("{t:.3},{}\n", if marked { mark.to_owned() } else { format!("{value:.4}") })
            });
            let (_, said) = refusal(&format!("Time (s),Acceleration (cm/s2)\n{table}"));
            assert!(said.contains("line 702") && said.contains("missing value"), "{said}");
        }
    }
    // A peak next to similar values is valid, and so is a single sample that stands out slightly
    // from a rough record.
    let smooth = rows(|_, t, a| format!("{t:.3},{:.3}\n", (666.0 * a).clamp(-999.0, 999.0)));
    given(&format!("Time (s),Acceleration (mm/s2)\n{smooth}"), &ReadOptions::default());
}

#[test]
fn factors_in_headers_are_refused_and_a_factor_of_one_is_none() {
    for stated in [
        "scale factor: 0.01\nunit: m/s2",
        "gain: 2\nunit: m/s2",
        "# Calibration factor = 0.5\nunit: m/s2",
        "# Scale Factor = 2.0\n# unit: m/s2",
        "multiplier 100\nunit: m/s2",
        "scale: 9.81\nunit: m/s2",
        "unit = 0.01 m/s2",
        "units: 10^-3 g",
        "UNITS (1/100 g)",
        "units of 0.1 cm/s^2",
        "unit: g x 100",
        "unit: m/s2 * 0.01",
        "units: thousandths of g",
        "units of g/1000",
        "acc*100 (g)",
        "Accel (cm/s/s) * 10",
        "Acc. (1e-3 g)",
        "Acceleration x 1000 in g",
        "scaled by 1000, unit g",
        "acceleration in g, multiplied by 100",
        "1 unit = 0.01 g",
    ] {
        let text = format!("{stated}\ndt = 0.005 s\n{}", rows(|_, _, a| format!("{a:.6}\n")));
        for unit in [None, Some(AccelerationUnit::G)] {
            let options = ReadOptions { unit, ..ReadOptions::default() };
            let error = read(text.as_bytes(), "a.txt", &options).unwrap_err().to_string();
            assert!(error.contains("need not be multiplied by a factor"), "{stated}: {error}");
        }
    }
    for name in ["acc (0.01 m/s2)", "acc (10^-3 g)", "acc (g x 100)", "acc*100 (g)", "acc (g) * 10"]
    {
        let text = format!("time (s),{name}\n{}", rows(plain));
        let options = ReadOptions { unit: Some(AccelerationUnit::Gal), ..ReadOptions::default() };
        let error = read(text.as_bytes(), "a.txt", &options).unwrap_err().to_string();
        assert!(error.contains("without a factor"), "{name}: {error}");
    }
    for stated in [
        "gain: 1\nunit: m/s2",
        "scale factor: 1.0\nunit: m/s2",
        "unit = 1 m/s2",
        "unit: m/s**2",
        "units: m s-2",
    ] {
        let values = rows(|_, _, a| format!("{a:.6}\n"));
        is_the_wave(&format!("{stated}\ndt = 0.005 s\n{values}"), 1);
    }
}

#[test]
fn count_and_step_of_a_peer_header_are_read_in_other_words() {
    for stated in [
        "dt(s)=0.005 npts=3200",
        "NPTS: 3200, DT (sec): 0.005",
        "npts = 3200  dt [s] = .005",
        "NPTS=3200, DT(ms)=5",
    ] {
        let text = format!(
            "PEER NGA STRONG MOTION DATABASE RECORD\nMade, Station, 090\n\
             ACCELERATION TIME SERIES IN UNITS OF M/S2\n{stated}\n{}",
            rows(|_, _, a| format!("{a:15.7E}\n"))
        );
        is_the_wave(&text, 1);
    }
    let (_, said) = refusal("PEER\nA, B, 090\nUNITS OF G\nNPTS and DT unknown\n0.1\n0.2\n");
    assert!(said.contains("write the number of values and the step"), "{said}");
}

#[test]
fn exponents_of_fortran_in_headers_are_read() {
    for step in ["5.0D-03", "0.5d-2", "50.D-4", "0.005D0", "5.0E-03"] {
        let values = rows(|_, _, a| format!("{}\n", format!("{a:.6E}").replace('E', "D")));
        is_the_wave(&format!("Acceleration (m/s2)\nDT = {step} SEC  NPTS = 3200\n{values}"), 1);
    }
}

#[test]
fn columns_of_gravity_beside_the_motion_are_no_channels() {
    let table = rows(|k, t, a| format!("{t:.3},{a:.6},{:.4}\n", 9.8 + 0.001 * (k as f64).sin()));
    is_the_wave(&format!("Time (s),User x (m/s2),Gravity z (m/s2)\n{table}"), 1);
}

#[test]
fn a_scale_in_a_sac_header_is_named_and_a_step_below_zero_is_stated() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/sac/little.sac");
    let bytes = std::fs::read(file).unwrap();
    let options =
        ReadOptions { unit: Some(AccelerationUnit::MetersPerSecondSquared), ..Default::default() };
    let with = |word: usize, value: f32| {
        let mut bytes = bytes.clone();
        bytes[4 * word..4 * word + 4].copy_from_slice(&value.to_le_bytes());
        read(&bytes, "a.sac", &options)
    };
    let named = |record: &barrelstack_motion::Record| {
        record.warnings.iter().any(|w| w.message.contains("a scale of"))
    };
    assert!(named(&with(3, 0.01).unwrap()));
    assert!(!named(&with(3, 1.0).unwrap()) && !named(&with(3, -12345.0).unwrap()));
    let error = with(0, -0.005).unwrap_err().to_string();
    assert!(error.contains("found -0.005 s"), "{error}");
}

#[test]
fn the_unit_that_values_have_now_counts_and_not_that_of_before() {
    for stated in [
        "Original unit: cm/s2, unit: m/s2",
        "unit: cm/s2 converted to m/s2",
        "converted to m/s2, unit before g",
        "units: m/s2 (1 g = 9.81 m/s2)",
    ] {
        let values = rows(|_, _, a| format!("{a:.6}\n"));
        is_the_wave(&format!("{stated}\ndt = 0.005 s\n{values}"), 1);
    }
}

#[test]
fn steps_of_no_record_are_no_steps_and_kilohertz_are_thousands() {
    let values = rows(|_, _, a| format!("{a:.6}\n"));
    for step in ["DT=5", "dt 20", "time step: 1"] {
        let (refused, said) = refusal(&format!("{step}\nunit: m/s2\n{values}"));
        assert_eq!(refused, Refusal::Missing(barrelstack_motion::Given::Step), "{step}: {said}");
    }
    for rate in ["Sampling rate 0.2 kHz", "sampling rate (kHz): 0.2"] {
        is_the_wave(&format!("{rate}\nunit: m/s2\n{values}"), 1);
    }
}

#[test]
fn headings_without_rows_are_named_as_such() {
    for text in [
        "time (s),acceleration (g)\n",
        "Station: X\ntime (s);acc (m/s2)\n\n",
        "unit: g\nstep: 0.01 s\nacceleration\n",
    ] {
        let error = read(text.as_bytes(), "a.csv", &ReadOptions::default()).unwrap_err();
        let said = error.to_string();
        assert!(said.contains("expected rows of numbers below the headings"), "{said}");
        assert!(said.contains("after which the file ends"), "{said}");
    }
    // Text that is not a table must not be described as anything it is not.
    for text in [
        "Notes\nThe files hold accelerations, processed according to the manual.\n",
        "12 stations\nacceleration\n",
    ] {
        let error = read(text.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err();
        assert!(!error.to_string().contains("below the headings"), "{error}");
    }
}
