//! Filter corners from the noise before the first arrival, for records with known noise.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use barrelstack_motion::{
    Channel, Direction, NoiseCriterion, Processing, Random, Record, bundled, noise_corners,
};

const STEP: f64 = 0.01;
const ARRIVAL: f64 = 20.0;

/// Returns white noise of 1 mm/s² for 20 s, followed by band-limited white noise with a decaying
/// envelope of 1 m/s² added to it.
fn known(low: f64, high: f64, seed: u64) -> Channel {
    let mut random = Random::new(seed);
    let n = 8000;
    let noise: Vec<f64> = (0..n).map(|_| 1e-3 * random.normal()).collect();
    let band =
        Processing { high_pass: Some(low), low_pass: Some(high), order: 8, ..Processing::none() };
    let white: Vec<f64> = (0..n).map(|_| random.normal()).collect();
    let filtered = Processing { pads: barrelstack_motion::Pads::Removed, ..band }
        .apply(STEP, &white, 0.0)
        .unwrap()
        .acceleration;
    let a = (0..n)
        .map(|k| {
            let t = k as f64 * STEP - ARRIVAL;
            let envelope = if t < 0.0 { 0.0 } else { (-t / 10.0).exp() };
            noise[k] + envelope * filtered[k]
        })
        .collect();
    Channel::new("E", Direction::parse("E"), STEP, a)
}

fn octaves(found: f64, expected: f64) -> f64 {
    (found / expected).log2()
}

#[test]
fn corners_lie_where_the_signal_of_a_known_band_meets_the_noise() {
    let criterion = NoiseCriterion::default();
    for (low, high, seed) in [(0.1, 12.0, 1), (0.15, 20.0, 2), (0.12, 30.0, 3)] {
        let found = noise_corners(&known(low, high, seed), ARRIVAL, &criterion).unwrap();
        println!("{low} and {high} Hz: {found:?}");
        // A signal of 100 times the noise exceeds 3 times the noise for another third of an octave
        // on the flanks of this filter, and the smoothing window adds half an octave. Measured: 1.3
        // octaves below and 0.4 octaves above.
        assert!((-1.5..0.2).contains(&octaves(found.high_pass, low)), "{found:?}");
        assert!((-0.2..0.9).contains(&octaves(found.low_pass, high)), "{found:?}");
        assert!(found.least_ratio > 3.0);
    }
}

#[test]
fn the_arrival_is_found_and_shared_by_all_channels() {
    let mut record = bundled("napa-college-2014").unwrap();
    record.channels =
        vec![known(0.1, 12.0, 1), Channel { name: "N".to_owned(), ..known(0.1, 15.0, 4) }];
    let found: Vec<_> =
        record.noise_corners(&NoiseCriterion::default()).into_iter().map(Result::unwrap).collect();
    // Measured: 0.02 s late.
    assert!((found[0].arrival - ARRIVAL).abs() < 0.2, "{found:?}");
    assert_eq!(found[0].arrival, found[1].arrival);
    // Both horizontals use the narrower band.
    assert_eq!((found[0].high_pass, found[0].low_pass), (found[1].high_pass, found[1].low_pass));
}

#[test]
fn a_record_without_noise_is_refused_corners_with_the_reason() {
    let criterion = NoiseCriterion::default();
    let refusal = |channel: &Channel, arrival: f64| {
        noise_corners(channel, arrival, &criterion).unwrap_err().to_string()
    };
    let good = known(0.1, 12.0, 1);
    assert!(
        refusal(&good, 0.5).contains("0.50 s of noise before the shaking; at least 1 s are needed")
    );
    assert!(
        refusal(&good, 77.0)
            .contains("3.00 s of shaking after the arrival; at least 5 s are needed")
    );
    let mut silent = good.clone();
    silent.acceleration[..2000].fill(0.0);
    assert!(refusal(&silent, ARRIVAL).contains("below the resolution of the file"));
    let weak = Channel {
        acceleration: good.acceleration.iter().take(2000).cycle().take(8000).copied().collect(),
        ..good
    };
    assert!(
        refusal(&weak, ARRIVAL).contains("the signal-to-noise ratio falls to"),
        "{}",
        refusal(&weak, ARRIVAL)
    );
}

#[test]
fn the_bundled_record_has_the_corners_of_an_independent_program() {
    let record: Record = bundled("napa-college-2014").unwrap();
    let found = record.noise_corners(&NoiseCriterion::default());
    let east = found[0].as_ref().unwrap();
    // gmprocess 2.8.0, with this arrival, a ratio of 3 from 0.2 to 5 Hz and equal corners for both
    // horizontals, gives 0.1122 and 40 Hz.
    assert!(octaves(east.high_pass, 0.1122).abs() < 1.0 / 3.0, "{east:?}");
    assert_eq!(east.low_pass, 40.0);
    let sentence = east.sentence(&NoiseCriterion::default());
    assert!(sentence.contains("too short to resolve frequencies below 0.35 Hz"), "{sentence}");
}
