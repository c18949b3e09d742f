//! How often 95 % bands hold the truth, over a thousand synthetic campaigns.

mod drawing;

use barrelstack_fragility::{
    Dispersion, Evidence, Lognormal, bootstrap, evidence, profile_band, simulate,
};
use barrelstack_motion::Random;
use drawing::draw;

const TRUTH: Lognormal = Lognormal { median: 0.45, dispersion: 0.45 };
const AT: [f64; 5] = [0.2, 0.3, 0.45, 0.6, 0.9];
const CAMPAIGNS: usize = 1000;

fn plan() -> Vec<(f64, u32)> {
    [0.15, 0.25, 0.35, 0.45, 0.6, 0.8, 1.0].map(|x| (x, 30)).to_vec()
}

/// The shares of campaigns whose band holds the truth, by intensity.
fn coverage(mut band: impl FnMut(&mut Random) -> Vec<barrelstack_fragility::Interval>) -> [f64; 5] {
    let mut random = Random::new(2026);
    let mut held = [0_u32; 5];
    for _ in 0..CAMPAIGNS {
        for (held, (interval, x)) in held.iter_mut().zip(band(&mut random).iter().zip(AT)) {
            *held += u32::from(interval.holds(TRUTH.probability(x)));
        }
    }
    held.map(|held| f64::from(held) / CAMPAIGNS as f64)
}

/// The mean within 93 to 97 %, and at each intensity within `each`, which allows for the scatter of
/// a thousand campaigns (0.7 % of standard deviation).
#[expect(clippy::print_stdout, reason = "the measured coverage, shown with --nocapture")]
fn assert_nominal(shares: [f64; 5], each: std::ops::RangeInclusive<f64>, what: &str) {
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("{what}: mean {mean:.4}, by intensity {shares:?}");
    assert!((0.93..=0.97).contains(&mean), "{what}: {mean}");
    assert!(shares.iter().all(|share| each.contains(share)), "{what}: {shares:?}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "a thousand campaigns take a minute; run in release")]
fn profile_bands_of_stripes_hold_the_truth_at_their_level() {
    let shares = coverage(|random| {
        let data = evidence(&draw(&plan(), &TRUTH, random));
        profile_band(&data, Dispersion::Free, 0.95, &AT).unwrap()
    });
    // Measured: mean 0.945, 0.935 to 0.949.
    assert_nominal(shares, 0.93..=0.97, "profile, stripes");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "a thousand campaigns take a minute; run in release")]
fn parametric_bootstrap_bands_of_stripes_hold_the_truth_at_their_level() {
    let shares = coverage(|random| {
        let stripes = draw(&plan(), &TRUTH, random);
        simulate(&stripes, Dispersion::Free, 400, || random.uniform()).unwrap().band(0.95, &AT)
    });
    // Measured: mean 0.950, 0.943 to 0.955.
    assert_nominal(shares, 0.93..=0.97, "parametric bootstrap, stripes");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "a thousand campaigns take a minute; run in release")]
fn bands_resampled_over_records_hold_the_truth_when_cases_of_a_record_agree() {
    let shares = coverage(|random| {
        let data: Vec<Evidence> = (0..40)
            .flat_map(|group| {
                let capacity = TRUTH.median * (TRUTH.dispersion * random.normal()).exp();
                plan().into_iter().map(move |(x, _)| Evidence::case(x, capacity <= x, group))
            })
            .collect();
        bootstrap(&data, Dispersion::Free, 400, || random.uniform()).unwrap().band(0.95, &AT)
    });
    // Measured: mean 0.943, from 0.925 two dispersions above the median to 0.964: with 40 records
    // the upper tail of the curve is still held a little too seldom.
    assert_nominal(shares, 0.92..=0.97, "bootstrap over records");
}
