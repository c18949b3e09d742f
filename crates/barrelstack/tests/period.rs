//! The period of rocking: the formula, the measurement, and a block that rocks.

use std::f64::consts::TAU;

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack::period::{RigidBlock, drift, swings};

const GRAVITY: f64 = 9.80665;

fn block() -> RigidBlock {
    let scenario = Scenario::builtin("rocking-block", &[]).unwrap();
    RigidBlock::of(&assemble(&scenario).unwrap(), GRAVITY).unwrap()
}

#[test]
fn a_uniform_rectangle_has_the_parameters_of_housner() {
    // 0.4 m by 1.6 m: R = √(b² + h²), α = atan(b/h), p² = 3g/(4R).
    let found = block();
    let radius = 0.2_f64.hypot(0.8);
    assert!((found.radius - radius).abs() < 1e-12);
    assert!((found.slenderness - 0.25_f64.atan()).abs() < 1e-12);
    let frequency = (0.75 * GRAVITY / radius).sqrt();
    assert!((found.frequency / frequency - 1.0).abs() < 1e-12, "{}", found.frequency);
}

#[test]
fn the_period_grows_from_zero_at_rest_to_infinity_at_the_tilt_of_no_return() {
    let block = RigidBlock { radius: 1.0, slenderness: 0.2, frequency: 2.0 };
    assert_eq!(block.period(0.0), 0.0);
    assert!(block.period(0.2).is_infinite());
    // (4/2) arcosh(2) = 2 ln(2 + √3).
    let half_way = 2.0 * (2.0 + 3.0_f64.sqrt()).ln();
    assert!((block.period(0.1) - half_way).abs() < 1e-12);
    assert_eq!(block.period(-0.1), block.period(0.1));
}

#[test]
fn a_sine_swings_with_its_period_and_its_amplitude() {
    let times: Vec<f64> = (0..4000).map(|k| f64::from(k) / 1000.0).collect();
    let values: Vec<f64> = times.iter().map(|t| 0.3 * (TAU * (t + 0.1) / 0.8).sin()).collect();
    let found = swings(&times, &values);
    assert_eq!(found.len(), 9);
    for swing in found {
        assert!((swing.period - 0.8).abs() < 1e-5, "{swing:?}"); // measured 3e-7
        assert!((swing.amplitude - 0.3).abs() < 1e-5, "{swing:?}"); // measured 6e-7
    }
}

#[test]
fn small_swings_beside_a_large_one_are_left_out_and_an_unfinished_one_is_none() {
    let times: Vec<f64> = (0..=300).map(|k| f64::from(k) / 100.0).collect();
    let value =
        |t: f64| if t < 1.0 { 0.05 * (TAU * 5.0 * t).sin() } else { (TAU * (t - 1.0) / 2.2).sin() };
    let found = swings(&times, &times.iter().map(|t| value(*t)).collect::<Vec<_>>());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].period - 2.2).abs() < 0.02, "{found:?}");
    assert!(swings(&[], &[]).is_empty() && swings(&[0.0, 1.0], &[1.0, 2.0]).is_empty());
}

#[test]
fn a_block_rocks_freely_with_the_period_of_housner_at_every_amplitude() {
    let scenario = Scenario::builtin("rocking-block", &[]).unwrap();
    let run = scenario.run().unwrap();
    let recording = &run.recording;
    let tilt = &recording.channel("block rotation").unwrap().values;
    // The pulse ends at 1 s; afterwards the block rocks freely.
    let free = recording.times.iter().position(|time| *time > 1.05).unwrap();
    let found = swings(&recording.times[free..], &tilt[free..]);
    assert!(found.len() > 6, "{found:?}");
    let block = block();
    let mut worst = 0.0_f64;
    for swing in found.iter().take(6) {
        worst = worst.max((swing.period / block.period(swing.amplitude) - 1.0).abs());
    }
    // Housner's block is slender and rigid; this one is 1:4 on springs.
    assert!(worst < 0.01, "{worst}"); // measured 0.0035
}

#[test]
fn the_drift_of_a_stack_has_swings_while_it_stood_and_a_free_scene_has_no_drift() {
    let run = |name: &str, changes: &[String]| {
        let scenario = Scenario::builtin(name, changes).unwrap();
        scenario.run().unwrap()
    };
    let stack = run("candia-8-barrels", &["run.stop_after_collapse=0.1 s".to_owned()]);
    let found = drift(&stack).unwrap();
    assert!(!found.swings.is_empty());
    let last = stack.fates.collapse_time().unwrap();
    for swing in &found.swings {
        assert!(swing.start + 0.5 * swing.period <= last && swing.amplitude <= found.largest);
    }
    assert!(found.height > 2.0 && found.height < stack.assembly.height);
    assert!(drift(&run("rolling-disc", &[])).is_none());
}
