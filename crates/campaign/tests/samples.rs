//! Studies of ten thousand samples: size of the page, bins, and the test of monotonicity.

use crate::common::{integer, made, number, text};
use barrelstack_campaign::decision::{Decision, Request, decide};
use barrelstack_campaign::study::Role;
use barrelstack_motion::Random;
use barrelstack_report::html;

/// Returns the decision of a made-up study of 24 records at levels from 0.1 to 1 m/s; `chance` is the probability of
/// collapse at a level.
fn sampled(count: usize, seed: u64, chance: impl Fn(f64) -> f64) -> Decision {
    let mut random = Random::new(seed);
    let levels: Vec<f64> = (0..count).map(|_| 0.1 + 0.9 * random.uniform()).collect();
    let fell: Vec<bool> = levels.iter().map(|x| random.uniform() < chance(*x)).collect();
    let say = |of: &dyn Fn(bool) -> Option<&'static str>| {
        fell.iter().map(|fell| of(*fell).map(Into::into)).collect::<Vec<Option<String>>>()
    };
    let column = |factor: f64| levels.iter().map(|x| Some(factor * x)).collect::<Vec<_>>();
    let columns = vec![
        integer("case", Role::Key, (0..count).map(|row| i64::try_from(row).ok()).collect()),
        number("friction", "", Role::Factor, (0..count).map(|_| Some(random.uniform())).collect()),
        text("record", Role::Motion, (0..count).map(|k| Some(format!("m{}", k % 24))).collect()),
        number("level", "m/s", Role::Motion, column(1.0)),
        number("pga", "m/s2", Role::Intensity, column(8.0)),
        number("pgv", "m/s", Role::Intensity, column(1.0)),
        text("outcome", Role::Outcome, say(&|f| Some(if f { "collapse" } else { "stable" }))),
        text("ended", Role::Run, vec![Some("rest".into()); count]),
        number("motion_left", "s", Role::Run, vec![Some(0.0); count]),
        text("mode", Role::Outcome, say(&|f| f.then_some("rocking"))),
        integer("barrels", Role::Outcome, vec![Some(6); count]),
        text("fall_heights", Role::Outcome, say(&|f| f.then_some("1.8;0.9"))),
        text("fall_wine", Role::Outcome, say(&|f| f.then_some("0.225;0.225"))),
        number("stack_wine", "m3", Role::Outcome, vec![Some(6.0 * 0.225); count]),
        number("top_drift_ratio", "", Role::Demand, column(0.05)),
    ];
    let mut collected = made(columns, "sobol", &[], "m", 24);
    collected.provenance.seed = seed;
    decide(&collected, &Request::default()).unwrap()
}

/// Returns the probability of collapse for a lognormal capacity of median 0.5 m/s and dispersion 0.4.
fn ordered(level: f64) -> f64 {
    barrelstack_fragility::Lognormal { median: 0.5, dispersion: 0.4 }.probability(level)
}

/// Returns the probability of [`ordered`], increased by 0.5 in the range from 0.25 to 0.35 m/s (an island of collapse).
///
/// Weaker islands are not always found: with an increase of 0.3, 19 of 20 are found among ten thousand samples and 7 of
/// 20 among 2,400 (`validation/README.md`).
fn island(level: f64) -> f64 {
    ordered(level) + if (0.25..0.35).contains(&level) { 0.5 } else { 0.0 }
}

#[test]
fn a_page_of_ten_thousand_samples_is_small_binned_and_says_what_it_rests_on() {
    let found = sampled(10_000, 1, ordered);
    let bins = found.curves[0].stripes.len();
    assert_eq!(bins, 16);
    let cases: u32 = found.curves[0].stripes.iter().map(|stripe| stripe.cases).sum();
    assert_eq!(cases, 10_000);
    // Measured: 175 kB, with every figure drawn for wide and for narrow screens.
    // Measured: 201 kB, most of it scripts.
    assert!(html(&found.document).len() < 210_000, "{} bytes", html(&found.document).len());
    let headline = &found.document.verdict.headline;
    assert!(headline.contains("10000 cases") && headline.contains(" to "), "{headline}");
    // Measured: 0.489 to 0.502.
    let median = found.curves[0].median.unwrap();
    assert!(median.holds(0.5) && median.high - median.low < 0.02, "{median:?}");
    assert!(html(&found.document).contains("counted in 16 bins of about 625 neighboring cases"));
    if let Ok(folder) = std::env::var("BARRELSTACK_PAGES") {
        std::fs::write(std::path::Path::new(&folder).join("samples.html"), html(&found.document))
            .unwrap();
    }
}

#[test]
fn an_island_among_samples_is_found_with_every_seed_and_none_where_there_is_none() {
    let violations = |chance: fn(f64) -> f64| {
        (1..=20).filter(|seed| sampled(10_000, *seed, chance).curves[0].violates_order()).count()
    };
    assert_eq!(violations(island), 20);
    // Measured: none is found; the level of the test is one in twenty.
    assert!(violations(ordered) <= 1);
}
