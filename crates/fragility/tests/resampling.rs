//! Resampling, goodness of fit and monotony, with seeded random numbers.

use crate::common::eight_stripes;
use crate::drawing::draw;
use barrelstack_fragility::{
    Capacity, Dispersion, Evidence, FitError, Lognormal, Returned, Stripe, demand_against,
    evidence, failure_against, fit, goodness, goodness_by_simulation, leave_one_out, monotony,
    normality, returns, simulate, stripes,
};
use barrelstack_motion::Random;

fn counts(of: &[(f64, u32, u32)]) -> Vec<Stripe> {
    of.iter().map(|&(intensity, cases, failures)| Stripe { intensity, cases, failures }).collect()
}

#[test]
fn the_same_seed_gives_the_same_replicates() {
    let once = |seed| {
        let mut random = Random::new(seed);
        simulate(&eight_stripes(), Dispersion::Free, 50, || random.uniform()).unwrap()
    };
    assert_eq!(once(3), once(3));
    assert_ne!(once(3), once(4));
}

#[test]
fn replicates_of_counts_scatter_by_the_standard_errors() {
    let mut random = Random::new(1);
    let found = fit(&evidence(&eight_stripes()), Dispersion::Free).unwrap();
    let drawn = simulate(&eight_stripes(), Dispersion::Free, 2000, || random.uniform()).unwrap();
    let logs: Vec<f64> = drawn.curves.iter().map(|curve| curve.median.ln()).collect();
    let n = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / n;
    let spread = (logs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    assert!((spread / found.median_error - 1.0).abs() < 0.06, "{spread}"); // measured 0.02
    assert_eq!(drawn.refused, 0);
    assert!(drawn.median(0.95).holds(found.curve.median));
    assert!(drawn.dispersion(0.95).holds(found.curve.dispersion));
    assert!(drawn.band(0.95, &[0.4])[0].holds(found.curve.probability(0.4)));
}

/// Returns evidence of twenty records at six levels; each record has one capacity, so that its cases agree.
fn dependent(random: &mut Random) -> Vec<Evidence> {
    (0..20)
        .flat_map(|group| {
            let capacity = (0.4 * random.normal()).exp();
            [0.4, 0.6, 0.8, 1.0, 1.3, 1.8].map(|x| Evidence::case(x, capacity <= x, group))
        })
        .collect()
}

#[test]
fn leaving_whole_records_out_sees_the_dependence_that_counts_hide() {
    let mut random = Random::new(5);
    let all = dependent(&mut random);
    let naive = fit(&all, Dispersion::Free).unwrap();
    let whole = leave_one_out(&all, Dispersion::Free).unwrap();
    assert_eq!(whole.groups(), 20);
    let interval = whole.median(0.95);
    let half = 0.5 * (interval.high / interval.low).ln() / 2.093;
    // The true error is that of 20 capacities, β/√20 = 0.089; a fit to 120 independent cases gives less.
    assert!(half > 1.3 * naive.median_error, "{half} against {}", naive.median_error); // ratio 1.9
    assert!((0.06..0.13).contains(&half), "{half}");
}

#[test]
fn a_curve_that_hangs_on_one_record_gets_no_interval() {
    // Only two of five records overlap; without one of the two there is no curve.
    let all: Vec<Evidence> = [(0.3, false), (0.4, false), (0.5, true), (0.45, false), (0.44, true)]
        .iter()
        .enumerate()
        .map(|(group, (x, failed))| Evidence::case(*x, *failed, group))
        .collect();
    let found = leave_one_out(&all, Dispersion::Free).unwrap_err();
    assert!(matches!(found, FitError::Unstable { usable: 3, replicates: 5 }), "{found}");
}

#[test]
fn counts_from_a_curve_fit_it_and_counts_from_a_mixture_do_not() {
    let good = eight_stripes();
    let found = fit(&evidence(&good), Dispersion::Free).unwrap();
    let test = goodness(&good, &found);
    assert!(test.p > 0.5 && test.freedom == test.groups - 2, "{test:?}"); // measured p 0.97
    let mut random = Random::new(8);
    let p = goodness_by_simulation(&good, Dispersion::Free, 200, || random.uniform()).unwrap();
    assert!(p > 0.5, "{p}"); // measured 0.97

    // Half of the cases fail early and the rest late, which gives a plateau that no lognormal curve has.
    let bad = counts(&[(0.1, 40, 0), (0.2, 40, 20), (0.4, 40, 20), (0.8, 40, 20), (1.6, 40, 40)]);
    let found = fit(&evidence(&bad), Dispersion::Free).unwrap();
    assert!(goodness(&bad, &found).p < 1e-3);
    let p = goodness_by_simulation(&bad, Dispersion::Free, 200, || random.uniform()).unwrap();
    assert!(p < 0.01, "{p}");
}

#[test]
fn p_values_of_true_curves_are_even() {
    let curve = Lognormal { median: 0.4, dispersion: 0.4 };
    let plan = [(0.2, 40), (0.3, 40), (0.4, 40), (0.5, 40), (0.7, 40)];
    let mut random = Random::new(4);
    let campaigns = 400;
    let low = (0..campaigns)
        .filter(|_| {
            let drawn = draw(&plan, &curve, &mut random);
            goodness(&drawn, &fit(&evidence(&drawn), Dispersion::Free).unwrap()).p < 0.1
        })
        .count() as f64;
    let share = low / f64::from(campaigns);
    assert!((share - 0.1).abs() < 0.05, "{share}"); // measured 0.09
}

#[test]
fn lognormal_capacities_pass_and_two_lumps_do_not() {
    let mut random = Random::new(11);
    let good: Vec<f64> = (0..40).map(|_| (0.4 * random.normal()).exp()).collect();
    let test = normality(&good, 300, || random.uniform()).unwrap();
    assert!(test.p > 0.05, "{test:?}"); // measured 0.6
    let lumps: Vec<f64> =
        (0..40).map(|i| if i % 2 == 0 { 0.2 } else { 1.0 } + 1e-3 * f64::from(i)).collect();
    assert!(normality(&lumps, 300, || random.uniform()).unwrap().p < 0.01);
    // Lilliefors's (1967) 5 % point for n = 20 is 0.190.
    let twenty: Vec<f64> = (0..20).map(|i| f64::from(i + 1)).collect();
    assert!(normality(&twenty, 10, || random.uniform()).unwrap().distance < 0.19);
}

#[test]
fn an_island_of_failure_is_found_and_its_levels_are_named() {
    let island = counts(&[
        (0.2, 20, 1),
        (0.4, 20, 14),
        (0.6, 20, 15),
        (1.0, 20, 2),
        (1.4, 20, 4),
        (2.0, 20, 20),
    ]);
    let mut random = Random::new(6);
    let found = monotony(&island, 999, || random.uniform());
    assert!(found.p <= 0.002, "{}", found.p);
    let falls: Vec<_> = found.significant(0.05).collect();
    assert_eq!(falls.len(), 1);
    assert_eq!((falls[0].from.intensity, falls[0].to.intensity), (0.6, 1.0));
    // Pooling of adjacent violators: 14, 15, 2 and 4 of 80 get one probability.
    assert!(found.isotonic[1..5].iter().all(|p| (p - 35.0 / 80.0).abs() < 1e-15));
    assert!(found.isotonic.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn small_falls_are_reported_but_not_called_significant() {
    let noisy = counts(&[(0.2, 20, 1), (0.4, 20, 9), (0.6, 20, 8), (0.8, 20, 15)]);
    let mut random = Random::new(7);
    let found = monotony(&noisy, 400, || random.uniform());
    assert_eq!(found.falls.len(), 1);
    assert!(found.p > 0.2 && found.significant(0.05).next().is_none(), "{found:?}");
    let rising = monotony(&eight_stripes(), 100, || random.uniform());
    assert!(rising.falls.is_empty() && rising.p == 1.0 && rising.deviance == 0.0);
}

#[test]
fn the_test_of_order_seldom_cries_wolf() {
    let curve = Lognormal { median: 0.5, dispersion: 0.8 };
    let plan = [(0.3, 15), (0.4, 15), (0.5, 15), (0.6, 15), (0.8, 15)];
    let mut random = Random::new(9);
    let wolves = (0..200)
        .filter(|_| {
            let drawn = draw(&plan, &curve, &mut random);
            monotony(&drawn, 99, || random.uniform()).p <= 0.05
        })
        .count();
    assert!(wolves <= 16, "{wolves} of 200"); // measured 4
}

#[test]
fn records_that_stand_again_are_listed_whatever_the_statistics() {
    let cases = [(0, 0.2, false), (0, 0.4, true), (0, 0.8, false), (1, 0.2, false), (1, 0.4, true)];
    assert_eq!(returns(cases), [Returned { group: 0, failed: 0.4, stood: 0.8 }]);
}

/// Returns a quantity on which failure depends, a correlated second quantity, and the failures.
fn two_measures(random: &mut Random) -> (Vec<f64>, Vec<f64>, Vec<bool>) {
    let (mut cause, mut companion, mut failed) = (vec![], vec![], vec![]);
    for _ in 0..400 {
        let u = 0.6 * random.normal();
        cause.push(u.exp());
        companion.push((u + 0.4 * random.normal()).exp());
        failed.push(u + 0.25 * random.normal() > 0.1);
    }
    (cause, companion, failed)
}

#[test]
fn the_measure_that_causes_failure_is_efficient_and_sufficient_and_its_companion_neither() {
    let mut random = Random::new(12);
    let (cause, companion, failed) = two_measures(&mut random);
    let pair =
        |x: &[f64]| -> Vec<(f64, bool)> { x.iter().copied().zip(failed.iter().copied()).collect() };
    let by_cause = failure_against(&pair(&cause), Some(&companion)).unwrap();
    let by_companion = failure_against(&pair(&companion), Some(&cause)).unwrap();
    assert!((by_cause.fit.curve.dispersion - 0.25).abs() < 0.05); // measured 0.02
    assert!(by_companion.fit.curve.dispersion > 1.5 * by_cause.fit.curve.dispersion);
    assert!(by_cause.sufficiency.unwrap() > 0.05); // measured 0.6
    assert!(by_companion.sufficiency.unwrap() < 1e-6);
    assert!(by_cause.concordance > by_companion.concordance && by_companion.concordance > 0.5);
    // The same measure in other units adds no information.
    let same: Vec<f64> = cause.iter().map(|x| 100.0 * x).collect();
    assert_eq!(failure_against(&pair(&cause), Some(&same)).unwrap().sufficiency, None);
}

#[test]
fn demand_is_separated_by_its_cause() {
    let mut random = Random::new(13);
    let (cause, companion, _) = two_measures(&mut random);
    let demand: Vec<f64> =
        cause.iter().map(|x| 0.02 * x.powf(1.4) * (0.3 * random.normal()).exp()).collect();
    let pair =
        |x: &[f64]| -> Vec<(f64, f64)> { x.iter().copied().zip(demand.iter().copied()).collect() };
    let by_cause = demand_against(&pair(&cause), Some(&companion)).unwrap();
    let by_companion = demand_against(&pair(&companion), Some(&cause)).unwrap();
    assert!((by_cause.slope - 1.4).abs() < 0.06 && (by_cause.dispersion - 0.3).abs() < 0.03);
    assert!(by_companion.dispersion > 1.5 * by_cause.dispersion);
    assert!(by_cause.sufficiency.unwrap() > 0.01 && by_companion.sufficiency.unwrap() < 1e-6);
    assert!(demand_against(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)], None).is_none());
}

#[test]
fn brackets_and_stripes_of_the_same_records_agree() {
    let mut random = Random::new(14);
    let levels = [0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.7, 2.2];
    let capacities: Vec<f64> = (0..60).map(|_| (0.4 * random.normal()).exp()).collect();
    let brackets: Vec<Evidence> = capacities
        .iter()
        .enumerate()
        .map(|(group, c)| {
            let after = levels.partition_point(|x| x < c);
            let capacity = match (after.checked_sub(1), levels.get(after)) {
                (None, _) => Capacity::Below(levels[0]),
                (Some(i), Some(high)) => Capacity::Between(levels[i], *high),
                (Some(i), None) => Capacity::Above(levels[i]),
            };
            Evidence::capacity(capacity, group)
        })
        .collect();
    let cases = levels.iter().flat_map(|x| capacities.iter().map(move |c| (*x, c <= x)));
    let by_stripes = fit(&evidence(&stripes(cases)), Dispersion::Free).unwrap();
    let by_brackets = fit(&brackets, Dispersion::Free).unwrap();
    let gap = (by_stripes.curve.median / by_brackets.curve.median).ln().abs();
    assert!(gap < 0.5 * by_brackets.median_error, "{gap}"); // measured 0.1 of the error
}
