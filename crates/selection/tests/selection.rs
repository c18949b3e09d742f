//! Selection of records: published correlations, the conditional spectrum, and the fit of selected sets.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by unwrap and reports by print"
)]

use barrelstack_motion::{Random, STANDARD_GRAVITY, TargetSpectrum};
use barrelstack_selection::{
    Candidate, Choosing, Condition, Selection, SelectionTarget, select, spectral_correlation,
};

/// Period (s), median (g) and standard deviation of ln Sa for the example of Jayaram, Lin and Baker (2011).
///
/// The model is that of Campbell and Bozorgnia (2008) for M 7 at 10 km, Vs30 400 m/s, vertical strike slip; the numbers
/// are from `OpenQuake` 3.24.
const MODEL: [(f64, f64, f64); 19] = [
    (0.05, 0.340_912, 0.517_05),
    (0.075, 0.428_207, 0.538_74),
    (0.1, 0.507_322, 0.544_44),
    (0.15, 0.599_126, 0.546_69),
    (0.2, 0.630_954, 0.542_43),
    (0.25, 0.604_847, 0.5479),
    (0.3, 0.579_151, 0.554_96),
    (0.4, 0.533_652, 0.566_09),
    (0.5, 0.489_63, 0.581_17),
    (0.75, 0.358_608, 0.610_43),
    (1.0, 0.279_653, 0.622_61),
    (1.5, 0.184_944, 0.636_96),
    (2.0, 0.133_827, 0.643_16),
    (2.63, 0.097_265_2, 0.645_07),
    (3.0, 0.083_433_6, 0.646_25),
    (4.0, 0.061_041_3, 0.648_06),
    (5.0, 0.049_429_7, 0.700_06),
    (7.5, 0.025_650_2, 0.759_98),
    (10.0, 0.016_111_8, 0.824_69),
];

fn target(epsilon: Option<f64>) -> SelectionTarget {
    let periods: Vec<f64> = MODEL.iter().map(|row| row.0).collect();
    let median: Vec<f64> = MODEL.iter().map(|row| STANDARD_GRAVITY * row.1).collect();
    let sigma: Vec<f64> = MODEL.iter().map(|row| row.2).collect();
    let at = 13;
    let condition = epsilon.map(|e| Condition::at_epsilon(periods[at], median[at], sigma[at], e));
    SelectionTarget::new(&periods, &median, &sigma, condition).unwrap()
}

/// Returns spectra drawn from the model, with the published correlation between periods.
fn library(count: usize) -> Vec<Candidate> {
    let n = MODEL.len();
    // Cholesky factor of the correlations; these are rounded, so the diagonal gets a small increment.
    let mut root = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| root[i][k] * root[j][k]).sum();
            let left = spectral_correlation(MODEL[i].0, MODEL[j].0) - known;
            root[i][j] = if i == j { (left + 0.01).sqrt() } else { left / root[j][j] };
        }
    }
    let mut random = Random::new(5);
    let one = |k: usize| {
        let deviates: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let along = |i: usize| (0..=i).map(|j| root[i][j] * deviates[j]).sum::<f64>();
        let sa = |i: usize| STANDARD_GRAVITY * MODEL[i].1 * (MODEL[i].2 * along(i)).exp();
        let (name, group) = (format!("record {k}"), format!("event {}", k % 40));
        Candidate { name, spectrum: (0..n).map(sa).collect(), group }
    };
    (0..count).map(one).collect()
}

fn choosing(count: usize) -> Choosing {
    Choosing { count, scale: [0.2, 5.0], most_of_group: None, seed: 1 }
}

#[test]
fn correlations_are_those_of_an_independent_implementation() {
    // From OpenQuake 3.24, BakerJayaram2008; at least one pair in each branch of the model.
    for (one, other, expected) in [
        (0.01, 0.05, 0.947_630_922_693),
        (0.03, 0.1, 0.918_969_949_548),
        (0.05, 0.15, 0.915_304_973_757),
        (0.1, 0.19, 0.799_615_776_072),
        (0.05, 0.2, 0.838_012_470_295),
        (0.15, 0.3, 0.749_020_638_067),
        (0.2, 1.0, 0.444_425_066_357),
        (0.05, 2.63, 0.196_202_923_585),
        (1.0, 2.63, 0.653_426_165_308),
        (2.63, 10.0, 0.530_406_713_425),
        (0.109, 0.2, 0.779_671_892_569),
        (0.08, 0.12, 0.961_887_615_032),
    ] {
        // Measured: 5e-13, the digits printed there.
        assert!((spectral_correlation(one, other) - expected).abs() < 1e-11, "{one} and {other}");
        assert_eq!(spectral_correlation(one, other), spectral_correlation(other, one));
    }
    assert_eq!(spectral_correlation(0.3, 0.3), 1.0);
}

#[test]
fn the_conditional_spectrum_is_that_of_an_independent_implementation() {
    let target = target(Some(2.0));
    // ln of g, and standard deviations, from the same model and correlations in OpenQuake.
    let mean = [
        -0.873_238, -0.712_083, -0.586_521, -0.366_379, -0.253_645, -0.238_353, -0.228_271,
        -0.215_878, -0.215_348, -0.345_793, -0.460_539, -0.673_763, -0.853_586, -1.040_178,
        -1.253_446, -1.698_212, -1.933_283, -2.712_021, -3.253_362,
    ];
    let deviation = [
        0.506_997, 0.534_424, 0.542_489, 0.541_802, 0.532_478, 0.531_706, 0.531_703, 0.527_249,
        0.524_952, 0.507_071, 0.471_313, 0.385_607, 0.280_423, 0.0, 0.198_132, 0.344_367,
        0.449_172, 0.592_774, 0.699_126,
    ];
    for k in 0..mean.len() {
        let ours = target.mean()[k] - STANDARD_GRAVITY.ln();
        // Measured: 5e-6, the digits of the table above.
        assert!((ours - mean[k]).abs() < 2e-5, "{k}: {ours}");
        assert!((target.deviation()[k] - deviation[k]).abs() < 1e-5, "{k}");
    }
}

#[test]
fn a_set_meets_a_published_target_in_mean_and_spread() {
    let target = target(Some(2.0));
    let library = library(2000);
    let found = select(&target, &library, &choosing(40)).unwrap();
    let near = |found: &Selection| {
        let (median, deviation) = (found.median_error(&target), found.deviation_error(&target));
        println!("median {median:.4}, deviation {deviation:.4}, rounds {}", found.rounds);
        median < 0.05 && deviation < 0.1
    };
    // Measured: 1.3 % and 2.6 %.
    assert!(near(&found));
    // For several seeds, and from a fifth of the records; measured at most 2.0 % and 4.1 %.
    for seed in 2..6 {
        let choosing = Choosing { seed, ..choosing(40) };
        assert!(near(&select(&target, &library[..400], &choosing).unwrap()));
    }
    let (at, given) = target.condition().unwrap();
    for chosen in &found.chosen {
        let sa = chosen.scale * library[chosen.candidate].spectrum[at];
        assert!((sa / given.acceleration - 1.0).abs() < 1e-12);
        assert!((0.2..=5.0).contains(&chosen.scale));
    }
    let mut places: Vec<usize> = found.chosen.iter().map(|chosen| chosen.candidate).collect();
    places.dedup();
    assert_eq!(places.len(), 40, "none is chosen twice");
    assert_eq!(found, select(&target, &library, &choosing(40)).unwrap());
    let other = select(&target, &library, &Choosing { seed: 2, ..choosing(40) }).unwrap();
    assert_ne!(found.chosen, other.chosen);
}

#[test]
fn a_set_meets_a_target_without_condition_and_a_spectrum_without_spread() {
    let library = library(2000);
    let free = target(None);
    let found = select(&free, &library, &choosing(40)).unwrap();
    let (median, deviation) = (found.median_error(&free), found.deviation_error(&free));
    println!("free: median {median:.4}, deviation {deviation:.4}");
    // Measured: 1.5 % and 2.7 %.
    assert!(median < 0.05 && deviation < 0.1);
    let table = TargetSpectrum::Table {
        points: MODEL.iter().map(|row| (row.0, STANDARD_GRAVITY * row.1)).collect(),
        damping: 0.05,
    };
    let periods: Vec<f64> = MODEL.iter().map(|row| row.0).collect();
    let mean = SelectionTarget::of_spectrum(&table, &periods).unwrap();
    let found = select(&mean, &library, &choosing(10)).unwrap();
    println!("mean: {:.4}, {:.4}", found.median_error(&mean), found.deviation_error(&mean));
    // Without selection the standard deviation is at least 0.5.
    assert!(found.median_error(&mean) < 0.08 && found.deviation_error(&mean) < 0.4);
}

#[test]
fn no_event_gives_more_than_its_share() {
    let one = Choosing { most_of_group: Some(1), ..choosing(30) };
    let library = library(400);
    let found = select(&target(Some(2.0)), &library, &one).unwrap();
    let mut events: Vec<&str> =
        found.chosen.iter().map(|c| library[c.candidate].group.as_str()).collect();
    events.sort_unstable();
    events.dedup();
    assert_eq!(events.len(), 30);
}

#[test]
fn what_cannot_be_chosen_is_refused_with_the_numbers() {
    let library = library(50);
    let strict = Choosing { scale: [0.999, 1.001], ..choosing(20) };
    let message = select(&target(Some(2.0)), &library, &strict).unwrap_err().to_string();
    assert!(message.contains("of 50 records") && message.contains("20 are requested"), "{message}");
    let message = select(&target(None), &library, &choosing(1)).unwrap_err().to_string();
    assert_eq!(message, "size of the set: expected at least 2, found 1");
    let mut bad = library;
    bad[7].spectrum[2] = 0.0;
    let message = select(&target(None), &bad, &choosing(20)).unwrap_err().to_string();
    let period = target(None).periods()[2];
    assert_eq!(
        message,
        format!(
            "spectrum of record 7 at {period} s: expected an acceleration above 0 (m/s2), found 0"
        )
    );
    bad[7].spectrum.pop();
    let message = select(&target(None), &bad, &choosing(20)).unwrap_err().to_string();
    let n = MODEL.len();
    let found = n - 1;
    assert_eq!(
        message,
        format!(
            "spectrum of record 7: expected {n} accelerations, one for each period of the target, found {found}"
        )
    );
    let given = Some(Condition { period: 0.31, acceleration: 1.0 });
    let message = SelectionTarget::new(&[0.1, 1.0], &[1.0, 1.0], &[0.5, 0.5], given);
    assert!(
        message
            .unwrap_err()
            .to_string()
            .contains("expected one of the periods of the target, 0.1, 1, found 0.31")
    );
}
