//! Names, units and initial velocities in headers of plain columns.

#![allow(
    clippy::format_collect,
    clippy::format_push_string,
    reason = "a test fails by unwrap; small tables are built as text"
)]

use barrelstack_motion::{AccelerationUnit, Given, ReadOptions, Record, Refusal, read};

#[test]
fn columns_without_time_are_channels_only_if_named() {
    let rows: Vec<String> = (0..60).map(|k| format!("{}.5 -0.25 0.{k:02}\n", k % 7)).collect();
    let rows = rows.concat();
    let given = ReadOptions { time_step: Some(0.01), ..ReadOptions::default() };
    let named = format!("unit: cm/s2\nEW NS UD\n{rows}");
    let record = read(named.as_bytes(), "named.txt", &given).unwrap();
    // The second column is constant and is ignored with a warning.
    let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["EW", "UD"]);
    // Without names, the columns are not taken as one series, since neighbors in a row differ
    // strongly.
    let bare = format!("unit: cm/s2\n{rows}");
    let error = read(bare.as_bytes(), "bare.txt", &given).unwrap_err();
    assert!(error.to_string().contains("do not form a single series"), "{error}");
    let wave = |k: i32| format!("{:.4}", (f64::from(k) * 0.1).sin());
    let rows: String = (0..60)
        .map(|row| format!("{} {} {}\n", wave(3 * row), wave(3 * row + 1), wave(3 * row + 2)))
        .collect();
    let series = format!("unit: cm/s2\n{rows}");
    let record = read(series.as_bytes(), "series.txt", &given).unwrap();
    assert_eq!(record.channels[0].acceleration.len(), 180);
    assert!(record.warnings.iter().any(|w| w.message.contains("row by row")));
}

#[test]
fn a_unit_behind_every_name_is_a_stated_one() {
    let rows: String = (0..50).fold(String::new(), |text, k| {
        text + &format!("{:.2},{},{}\n", 0.01 * f64::from(k), k % 7, 5 - k % 5)
    });
    let table = |header: &str| {
        read(format!("{header}\n{rows}").as_bytes(), "t.csv", &ReadOptions::default())
    };
    let record = table("time (s),EW (cm/s2),NS (cm/s2)").unwrap();
    assert!((record.channels[0].pga() - 0.06).abs() < 1e-12);
    assert_eq!(record.channels[1].direction.azimuth, Some(0.0));
    let record = table("time (s),EW (cm/s2),NS (g)").unwrap();
    assert!((record.channels[1].pga() - 5.0 * 9.80665).abs() < 1e-9);
    for header in ["time (s),EW,NS", "time (s),EW (cm/s2),NS"] {
        let error = table(header).unwrap_err();
        assert_eq!(error.refusal, Refusal::Missing(Given::Unit), "{header}: {error}");
    }
}

#[test]
fn an_initial_velocity_that_cannot_be_used_is_refused_with_its_line() {
    for stated in ["0.1", "0.1 x", "0.1 0.2 0.3", "0.1 NaN"] {
        let text = format!(
            "# acceleration (m/s2)\n# initial velocity (m/s): {stated}\n\
             time (s),EW (m/s2),NS (m/s2)\n0,1,2\n0.1,2,1\n0.2,1,0\n"
        );
        let error = read(text.as_bytes(), "t.csv", &ReadOptions::default()).unwrap_err();
        assert_eq!((error.refusal, error.line), (Refusal::Damaged, Some(2)), "{error}");
        assert!(error.to_string().contains("2 velocities (m/s)"), "{error}");
    }
}

const GIVEN_G: ReadOptions = ReadOptions {
    unit: Some(AccelerationUnit::G),
    time_step: None,
    sensitivity: None,
    instruments: Vec::new(),
    recorded: None,
};

/// A decaying wave with a peak of 1.5.
pub(crate) fn wave(k: usize) -> f64 {
    let t = 0.005 * k as f64;
    1.5 * (6.0 * (t - 8.0)).cos() * (-0.05 * (t - 8.0) * (t - 8.0)).exp()
}

/// Returns the wave in rows of five touching columns of 14 characters.
fn touching() -> String {
    let mut text = String::new();
    for row in 0..640 {
        for column in 0..5 {
            let value = format!("{:.7E}", wave(5 * row + column));
            let (mantissa, exponent) = value.split_once('E').unwrap();
            let exponent: i32 = exponent.parse().unwrap();
            text += &format!("{:>14}", format!("{mantissa}E{exponent:+03}"));
        }
        text.push('\n');
    }
    text
}

pub(crate) fn given(text: &str, options: &ReadOptions) -> Record {
    read(text.as_bytes(), "a.txt", options).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn refused(text: &str, word: &str) {
    let error = read(text.as_bytes(), "a.txt", &GIVEN_G).unwrap_err().to_string();
    assert!(error.contains(word), "{word}: {error}");
}

#[test]
fn words_of_a_sentence_are_no_names_and_the_header_states_step_count_and_unit() {
    let header = "Orientation                   : NS\n\
        Filter Cut-off Frequency (Hz) : 0.100 - 50.000\n\
        Time Increment (s)            : 0.005\n\
        Number of Data                : 3200\n\
        PGA (m/s/s)                   : 1.5000000E+00\n\
        Accelaration time series in m/s/s\n";
    let file = format!("{header}{}", touching());
    let record = given(&file, &ReadOptions::default());
    let [channel] = record.channels.as_slice() else { panic!("{}", record.channels.len()) };
    assert_eq!((channel.acceleration.len(), channel.time_step), (3200, 0.005));
    assert_eq!(channel.direction.azimuth, Some(0.0));
    assert!((channel.pga() - 1.5).abs() < 1e-6 && channel.peaks[0].agrees());
    assert!(record.warnings.is_empty(), "{:?}", record.warnings);
    refused(&file.replace(": 3200", ": 4000"), "expected 4000 values as stated here, found 3200");
    refused(&file.replace(": 3200", ": 640"), "expected 640 values as stated here, found 3200");
    let other = file.replace("Number", "Duration (s) : 32\nNumber");
    refused(
        &other,
        "expected a total duration of 32 s, as stated here, found a total duration of 16",
    );
    let two = file.replace("Number", "dt = 0.01 s\nNumber");
    refused(&two, "expected a step of 0.005 s, as stated on line 3, found 0.01 s");
    let other_peak = given(&file.replace(": 1.5000000E+00", ": 2.0"), &ReadOptions::default());
    assert!(other_peak.warnings.iter().any(|w| w.message.contains("states a peak")));
}

#[test]
fn a_given_step_that_count_and_duration_contradict_is_refused() {
    let file = format!("acceleration in cm/s2\n3200 points, duration 16 s\n{}", touching());
    let step = |step| ReadOptions { time_step: Some(step), ..ReadOptions::default() };
    assert_eq!(given(&file, &step(0.005)).channels[0].acceleration.len(), 3200);
    let error = read(file.as_bytes(), "a.txt", &step(0.01)).unwrap_err();
    assert_eq!(error.refusal, Refusal::Options, "{error}");
    assert!(error.to_string().contains("about 0.0050 s"), "{error}");
    let error = read(file.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("about 0.0050 s"), "{error}");
}

#[test]
fn steps_are_read_as_headers_state_them() {
    let rows: String = (0..3200).map(|k| format!("{:.5}\n", wave(k))).collect();
    for (line, step) in [
        ("dt=0.005", 0.005),
        ("DT = .0050 SEC", 0.005),
        ("dt,0.005", 0.005),
        ("Delta t: 5 ms", 0.005),
        ("dt = 1/200", 0.005),
        ("time step (ms): 5", 0.005),
        ("Sampling rate: 200 Hz", 0.005),
        ("sampling frequency (Hz) = 200", 0.005),
        ("3200 samples, 200 sps", 0.005),
        ("NO. OF DATA: 3200  EQUALLY SPACED INTERVALS OF:  0.005  SEC", 0.005),
        ("fs 200", 0.005),
        ("Sampling Interval (s)   0.005", 0.005),
    ] {
        let file = format!("{line}\nacc: m/s2\n{rows}");
        let record = given(&file, &ReadOptions::default());
        assert_eq!(record.channels[0].time_step, step, "{line}");
        assert!((record.channels[0].pga() - 1.5).abs() < 1e-4, "{line}");
    }
    for line in ["original dt = 0.02", "filtered by 5 points", "significant duration 4 s"] {
        let file = format!("{line}\nacc: m/s2\n{rows}");
        let error = read(file.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err();
        assert_eq!(error.refusal, Refusal::Missing(Given::Step), "{line}: {error}");
    }
}

/// Returns rows of time (times `per_second`), acceleration, velocity and displacement.
fn avd(per_second: f64, separator: &str) -> String {
    let (mut v, mut d) = (0.0, 0.0);
    let mut text = String::new();
    for k in 0..2000 {
        let t = 0.01 * f64::from(k);
        let a = 2.0 * (3.0 * t).sin() * (-0.1 * t).exp();
        v += 0.01 * a;
        d += 0.01 * v;
        let row = [t * per_second, a, 100.0 * v, 100.0 * d].map(|value| format!("{value:.6}"));
        text += &(row.join(separator) + "\n");
    }
    text
}

#[test]
fn velocities_and_displacements_are_named_and_left_out() {
    for header in [
        "Time (s),Acceleration (g),Velocity (cm/s),Displacement (cm)",
        "Time [s],Acceleration [m/s2],Velocity [m/s],Displacement [m]",
        "t,acc,vel,disp",
        "t,a,v,d",
        "time, s, acceleration, g, velocity, cm/s, displacement, cm",
        "Time_s,Acc_g,Vel_cm/s,Disp",
        "\"Time (s)\",\"Accel (g)\",\"Vel (cm/s)\",\"Displ (cm)\"",
        "Time,Acceleration,Velocity,Displacement\n(s),(g),(cm/s),(cm)",
        "time (s),force (kN),EW (g),NS (cm/s)",
    ] {
        let rows = if header.contains("force") {
            let turned = |row: &str| {
                let [t, a, v, d] = row.split(',').collect::<Vec<_>>()[..] else { panic!() };
                format!("{t},{v},{a},{d}\n")
            };
            avd(1.0, ",").lines().map(turned).collect()
        } else {
            avd(1.0, ",")
        };
        let record = given(&format!("{header}\n{rows}"), &GIVEN_G);
        assert_eq!(record.channels.len(), 1, "{header}");
        let unit = if header.contains("m/s2") { 1.0 } else { 9.80665 };
        let peak = record.channels[0].pga() / unit;
        assert!((peak - 1.9).abs() < 0.1, "{header}: {peak}");
        assert!(record.warnings.iter().any(|w| w.message.contains("were ignored")), "{header}");
    }
    let tabs = "Time [sec]\tAcceleration [g]\tVelocity [cm/sec]\tDisplacement [cm]";
    assert_eq!(
        given(&format!("{tabs}\n{}", avd(1.0, "\t")), &ReadOptions::default()).channels.len(),
        1
    );
    // Without names, the numbers show that one column is the integral of another.
    refused(&avd(1.0, " "), "the integral of another");
    refused(&format!("Time (s),Velocity (cm/s)\n{}", pairs(1.0)), "give the acceleration history");
    refused(&format!("Time (s),Acceleration (m/s)\n{}", pairs(1.0)), "a unit of acceleration");
}

/// Returns rows of time (times `per_second`) and the wave.
fn pairs(per_second: f64) -> String {
    (0..3200).map(|k| format!("{:.6},{:.6}\n", 0.005 * k as f64 * per_second, wave(k))).collect()
}

#[test]
fn times_are_taken_in_their_unit_and_every_fault_has_its_own_reason() {
    for (header, per_second) in [
        ("time (ms),acc (g)", 1e3),
        ("Time [msec],Acceleration [g]", 1e3),
        ("time_ms,acc_g", 1e3),
        ("t (us),a (g)", 1e6),
        ("time (s),acc (g)", 1.0),
        ("t,ag (g)", 1.0),
    ] {
        let record = given(&format!("{header}\n{}", pairs(per_second)), &ReadOptions::default());
        assert!((record.channels[0].time_step / 0.005 - 1.0).abs() < 1e-9, "{header}");
        assert!((record.channels[0].pga() - 1.5 * 9.80665).abs() < 1e-3, "{header}");
    }
    refused(
        &format!("time,acc (g)\n{}", pairs(1e3)),
        "a time step that is plausible for a strong-motion record",
    );
    refused(
        &format!("time (days),acc (g)\n{}", pairs(1.0)),
        "a time column in s, ms, us, ns or min",
    );
    let unknown = format!("time (s),acc (furlong)\n{}", pairs(1.0));
    let error = read(unknown.as_bytes(), "a.txt", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("found the unit \"furlong\""), "{error}");
    let rows = pairs(1.0);
    let lines: Vec<&str> = rows.lines().collect();
    let again = [&lines[..100], &lines[99..]].concat().join("\n");
    refused(&format!("time (s),acc (g)\n{again}"), "0.495 s again");
    refused(&again, "0.495 s again");
    refused("time (s),acc (g)\n0.0,0.5\n", "a single row");
    for word in ["inf", "NaN", "-inf", "#N/A"] {
        for row in [0, 50] {
            let mut lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
            lines[row] = format!("{:.6},{word}", 0.005 * row as f64);
            let file = format!("time (s),acc (g)\n{}", lines.join("\n"));
            let error = read(file.as_bytes(), "a.txt", &GIVEN_G).unwrap_err().to_string();
            assert!(error.contains("no number here"), "{word} in row {row}: {error}");
        }
    }
    let mut empty = lines.clone();
    empty[70] = "0.350000,,";
    refused(&format!("time (s),acc (g)\n{}", empty.join("\n")), "an empty cell");
    let counted: String = (0..3200).map(|k| format!("{} {:.6}\n", k + 1, wave(k))).collect();
    let record = given(&format!("dt = 0.005 s\n{counted}"), &GIVEN_G);
    assert_eq!(
        (record.channels[0].acceleration.len(), record.channels[0].time_step),
        (3200, 0.005)
    );
    assert!(read(counted.as_bytes(), "a.txt", &GIVEN_G).is_err());
}

#[test]
fn spectra_are_refused_as_spectra() {
    let row = |k: u32| {
        format!(
            "{:.5},{:.5},{:.5}\n",
            0.1 + 0.0495 * f64::from(k),
            1.0 + (f64::from(k) * 0.7).sin(),
            0.1
        )
    };
    let rows: String = (0..100).map(row).collect();
    refused(&rows, "as in a spectrum");
    for header in [
        "Period (s),Sa (g),Sd (cm)",
        "T [s],PSA [g],SD [cm]",
        "Per(s)PSA @ damp 02% PSA @ damp 05% (m/s/s)",
        "Acceleration response spectrum, 5 % damping",
        "Frequency (Hz),Fourier amplitude,Phase",
    ] {
        let error = read(format!("{header}\n{rows}").as_bytes(), "a.txt", &GIVEN_G).unwrap_err();
        assert_eq!(error.refusal, Refusal::NotAcceleration, "{header}: {error}");
    }
    let matched =
        format!("Accelerogram matched to the response spectrum\nTime (s),Acc (g)\n{}", pairs(1.0));
    assert_eq!(given(&matched, &ReadOptions::default()).channels.len(), 1);
}

#[test]
fn decimal_commas_are_read_as_such_or_refused() {
    let points = given(&format!("time (s);acc (g)\n{}", pairs(1.0).replace(',', ";")), &GIVEN_G);
    let commas = pairs(1.0).replace(',', ";").replace('.', ",");
    let record = given(&format!("time (s);acc (g)\n{commas}"), &GIVEN_G);
    assert_eq!(record.channels[0].acceleration, points.channels[0].acceleration);
    let tabs = commas.replace(';', "\t");
    assert_eq!(given(&tabs, &GIVEN_G).channels[0].acceleration, points.channels[0].acceleration);
    let alone: String = (0..3200).map(|k| format!("{:.5}\n", wave(k)).replace('.', ",")).collect();
    let record = given(&format!("dt = 0,005\n{alone}").replace("0,005", "0.005"), &GIVEN_G);
    assert_eq!(record.channels[0].acceleration.len(), 3200);
    refused(&pairs(1.0).replace('.', ","), "decimal points");
}

/// A header that was cut within a word names the time column "e", which is also a direction.
#[test]
fn times_under_the_name_of_a_component_are_no_accelerations() {
    let dt = 0.003_906_25;
    let rows: String = (0..400)
        .map(|k| format!("{:.8} {:.6} 0.1 0.2\n", dt * f64::from(k), (0.1 * f64::from(k)).cos()))
        .collect();
    for name in ["ti\ne", "EW", "acc", "E"] {
        let text = format!(
            "Number of Data : 400\ndt = {dt}\nPGA (m/s^2) : 1\nacceleration in m/s^2\n\
             {name} acc Velocity Displacement\n{rows}"
        );
        refused(&text, "whose values rise by 0.00390625 from row to row");
    }
    let text = format!("acceleration in m/s^2\ntime acc Velocity Displacement\n{rows}");
    let record = given(&text, &ReadOptions::default());
    assert_eq!(record.channels.len(), 1);
}

/// If a date cannot be parsed, the components cannot be aligned, so a warning is given.
#[test]
fn dates_that_cannot_be_read_are_reported_in_every_format_that_states_them() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for (file, from, to) in [
        (
            "knet/example.EW",
            "Record Time       1903/01/02 19:51:43",
            "Record Time       1903/13/52 19:51",
        ),
        ("cwa/example.dat", "1903/01/02-23:50:29.000", "some day in winter"),
        (
            "unam/example.012",
            "FECHA DEL SISMO",
            "HORA DE LA PRIMERA MUESTRA (GMT)        : x\nFECHA DEL SISMO",
        ),
        ("csmip-v2/example.V2", "\n", "  START TIME: 99/99/19, 33:19:37.0 UTC\n"),
    ] {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        assert!(text.contains(from), "{file}");
        let before = read(&bytes, file, &ReadOptions::default()).unwrap();
        let damaged: Vec<u8> = text
            .replacen(from, to, 1)
            .chars()
            .map(|c| u8::try_from(u32::from(c)).unwrap())
            .collect();
        let after = read(&damaged, file, &ReadOptions::default()).unwrap();
        let warned = |record: &Record| {
            record.warnings.iter().any(|warning| {
                warning.message.contains("not a valid date and time of the first sample")
            })
        };
        assert!(!warned(&before), "{file}");
        assert!(warned(&after), "{file}: {:?}", after.warnings);
    }
}

#[test]
fn a_row_of_units_of_which_one_is_damaged_is_refused_and_never_read_as_names() {
    let rows: String = (0..60)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            let row = [t, (9.0 * t).sin(), (7.0 * t).cos(), (5.0 * t).sin()];
            row.map(|value| format!("{value:.4}")).join(",") + "\n"
        })
        .collect();
    let table = |header: &str| {
        read(format!("{header}\n{rows}").as_bytes(), "t.csv", &ReadOptions::default())
    };
    let names = "Time,Acceleration,Velocity,Displacement";
    let record = table(&format!("{names}\ns,g,cm/s,cm")).unwrap();
    assert_eq!(record.channels.len(), 1);
    let damaged = [
        ("s,gc,cm/s,cm", "\"gc\""),
        ("s,g,cmvelocity/s,cm", "\"cmvelocity/s\""),
        ("times,g,cm/s,cm", "\"times\""),
        ("(s),(g),(cm s),(cmm)", "\"cm s\""),
        ("[s],[g]],[cm/0s],[c.m]", "\"cm/0s\""),
    ];
    for (units, found) in damaged {
        let error = table(&format!("{names}\n{units}")).unwrap_err();
        assert_eq!(error.refusal, Refusal::Damaged, "{units}: {error}");
        let words = error.to_string();
        assert!(words.contains("line 2") && words.contains(found), "{units}: {words}");
    }
    // Names that resemble units remain names, and a sentence with a unit remains a sentence.
    for header in ["Unit: g\ntime (s),EW (g),NS (g),UD (g)", "time,g,EW (g),NS (g)"] {
        table(header).unwrap();
    }
    let two: String = (0..60).map(|k| format!("{:.2} {}\n", 0.01 * f64::from(k), k % 5)).collect();
    for header in ["Unit: g", "units, g", "time g"] {
        let result = read(format!("{header}\n{two}").as_bytes(), "t.txt", &ReadOptions::default());
        let refused = result.err().filter(|error| error.refusal == Refusal::Damaged);
        assert!(refused.is_none(), "{header}: {refused:?}");
    }
}

#[test]
fn the_length_of_a_vector_beside_its_components_is_no_channel() {
    let rows: String = (0..80)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            let (x, y) = ((9.0 * t).sin(), (7.0 * t).cos());
            format!("{t:.3},{x:.5},{y:.5},{:.5}\n", x.hypot(y))
        })
        .collect();
    for of in ["Absolute acceleration", "Abs", "Resultant acc", "acc total"] {
        let header =
            format!("\"Time (s)\",\"Acceleration x (g)\",\"Acceleration y (g)\",\"{of} (g)\"");
        let text = format!("{header}\n{rows}");
        let record = read(text.as_bytes(), "phone.csv", &ReadOptions::default()).unwrap();
        assert_eq!(record.channels.len(), 2, "{of}");
        assert!(record.warnings.iter().any(|w| w.message.contains(of)), "{of}");
    }
    // An absolute acceleration alone is accepted as a motion.
    let rows: String = (0..80)
        .map(|k| format!("{:.2},{:.4}\n", 0.01 * f64::from(k), f64::from(k).sin()))
        .collect();
    let text = format!("time (s),absolute acceleration (g)\n{rows}");
    let record = read(text.as_bytes(), "floor.csv", &ReadOptions::default()).unwrap();
    assert_eq!(record.channels.len(), 1);
}
