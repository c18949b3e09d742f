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

fn assert_nominal(shares: [f64; 5], what: &str) {
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("{what}: mean {mean:.4}, by intensity {shares:?}");
    assert!((0.93..=0.97).contains(&mean), "{what}: {mean}");
    for share in shares {
        assert!((0.93..=0.97).contains(&share), "{what}: {shares:?}");
    }
}

#[test]
fn profile_bands_of_stripes_hold_the_truth_at_their_level() {
    let shares = coverage(|random| {
        let data = evidence(&draw(&plan(), &TRUTH, random));
        profile_band(&data, Dispersion::Free, 0.95, &AT).unwrap()
    });
    assert_nominal(shares, "profile, stripes");
}

#[test]
fn parametric_bootstrap_bands_of_stripes_hold_the_truth_at_their_level() {
    let shares = coverage(|random| {
        let stripes = draw(&plan(), &TRUTH, random);
        simulate(&stripes, Dispersion::Free, 400, || random.uniform()).unwrap().band(0.95, &AT)
    });
    assert_nominal(shares, "parametric bootstrap, stripes");
}

#[test]
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
    assert_nominal(shares, "bootstrap over records");
}
