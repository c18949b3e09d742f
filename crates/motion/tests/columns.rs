//! What headers of plain columns say of their names, units and initial velocities.

#![allow(clippy::unwrap_used, reason = "a test fails by unwrap")]

use barrelstack_motion::{Given, ReadOptions, Refusal, read};

#[test]
fn columns_without_time_are_channels_only_if_named() {
    let rows: Vec<String> = (0..60).map(|k| format!("{}.5 -0.25 0.{k:02}\n", k % 7)).collect();
    let rows = rows.concat();
    let given = ReadOptions { time_step: Some(0.01), ..ReadOptions::default() };
    let named = format!("unit: cm/s2\nEW NS UD\n{rows}");
    let record = read(named.as_bytes(), "named.txt", &given).unwrap();
    // The second column never changes and is left out with a warning.
    let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["EW", "UD"]);
    let bare = format!("unit: cm/s2\n{rows}");
    let record = read(bare.as_bytes(), "bare.txt", &given).unwrap();
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
    for header in ["time (s),EW (cm/s2),NS (g)", "time (s),EW,NS", "time (s),EW (cm/s2),NS"] {
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
