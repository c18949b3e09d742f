//! Ground motion in space: directions of its components, and rotation of the stack.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

mod common;

use barrelstack::Record;
use barrelstack::motion::AccelerationUnit;
use barrelstack_dynamics::{Drive as _, Vec3};

use barrelstack_space::Ground;

use common::soft_demo;

/// Returns a ground velocity (m/s) that is a pulse to the east and half of it to the north, and the warnings; `first`
/// is the component across the barrels.
fn peak(first: &str, azimuth: &str, names: [&str; 2]) -> (Vec3, Vec<String>) {
    let pulse = |size: f64| -> Vec<f64> {
        (0..400).map(|k| if (100..200).contains(&k) { size } else { 0.0 }).collect()
    };
    let (east, north) = (pulse(1.0), pulse(0.5));
    let channels = [(names[0], east.as_slice()), (names[1], north.as_slice())];
    let unit = AccelerationUnit::MetersPerSecondSquared;
    let record = Record::of_samples("pulse", &channels, 0.01, unit).unwrap();
    let changes = [
        "stack.view=spatial".to_owned(),
        format!("stack.azimuth={azimuth}"),
        format!("motion.component={first}"),
    ];
    let scenario = soft_demo(&changes).with_record(&record).unwrap();
    let ground = Ground::of(&scenario).unwrap();
    (ground.at(1.5).1, ground.warnings)
}

fn close(found: Vec3, way: [f64; 2]) -> bool {
    (found.x - way[0]).abs() < 1e-12 && (found.y - way[1]).abs() < 1e-12
}

#[test]
fn components_point_where_their_azimuths_say() {
    // Across the barrels east: away is north. Across them north: away is west.
    let (east, _) = peak("E", "0 deg", ["E", "N"]);
    let (north, told) = peak("N", "0 deg", ["E", "N"]);
    println!("{east:?} {north:?} {told:?}");
    let scale = east.x;
    assert!(scale > 0.1);
    assert!(close(east, [scale, 0.5 * scale]), "{east:?}");
    assert!(close(north, [0.5 * scale, -scale]), "{north:?}");
    assert!(!told.iter().any(|told| told.contains("quarter turn")), "{told:?}");
}

#[test]
fn a_stack_that_is_turned_against_the_clock_sees_the_ground_turn_with_it() {
    let (straight, _) = peak("E", "0 deg", ["E", "N"]);
    let (left, _) = peak("E", "90 deg", ["E", "N"]);
    let (right, _) = peak("E", "-90 deg", ["E", "N"]);
    // Right becomes near, away becomes right; and vice versa.
    assert!(close(left, [straight.y, -straight.x]), "{left:?}");
    assert!(close(right, [-straight.y, straight.x]), "{right:?}");
}

#[test]
fn components_of_unknown_directions_are_said_to_be_taken() {
    let (found, told) = peak("H1", "0 deg", ["H1", "H2"]);
    assert!(close(found, [found.x, 0.5 * found.x]), "{found:?}");
    assert!(told.iter().any(|told| told.contains("does not say how")), "{told:?}");
}
