//! Fits compared with independent results, invariances, and errors.

use crate::common::eight_stripes;
use barrelstack_fragility::{
    Capacity, Dispersion, Evidence, FitError, Stripe, evidence, fit, moments, normal, profile_band,
    profile_median, stripes,
};
use barrelstack_motion::Random;
use proptest::prelude::*;

fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} against {exact}");
}

#[test]
fn eight_stripes_have_the_known_fit() {
    let stripes = eight_stripes();
    let found = fit(&evidence(&stripes), Dispersion::Free).unwrap();
    // All within half a unit of the last printed digit.
    near(found.curve.median, 0.42630, 5e-6); // measured 1e-7
    near(found.curve.dispersion, 0.45593, 5e-6); // measured 3e-6
    near(found.ln_likelihood_of(&stripes), -9.68333, 5e-6); // measured 2e-6
    near(found.median_error, 0.0598, 5e-5);
    near(found.dispersion_error, 0.1439, 5e-5);
}

#[test]
fn the_top_of_the_likelihood_is_higher_than_its_surroundings() {
    let stripes = eight_stripes();
    let found = fit(&evidence(&stripes), Dispersion::Free).unwrap();
    let ln_likelihood = |theta: f64, beta: f64| -> f64 {
        stripes
            .iter()
            .map(|s| {
                let p = normal((s.intensity / theta).ln() / beta);
                let (k, n) = (f64::from(s.failures), f64::from(s.cases));
                let part = |k: f64, p: f64| if k == 0.0 { 0.0 } else { k * p.ln() };
                part(k, p) + part(n - k, 1.0 - p)
            })
            .sum()
    };
    let (theta, beta) = (found.curve.median, found.curve.dispersion);
    near(ln_likelihood(theta, beta), found.ln_likelihood, 1e-10); // measured 1e-14
    for (a, b) in [(1.001, 1.0), (0.999, 1.0), (1.0, 1.001), (1.0, 0.999), (1.001, 1.002)] {
        assert!(ln_likelihood(theta * a, beta * b) < found.ln_likelihood);
    }
}

#[test]
fn capacities_have_the_mean_and_spread_of_their_logarithms() {
    let x = [0.21, 0.35, 0.44, 0.52, 0.78, 0.31];
    let all: Vec<Evidence> = x.iter().map(|x| Evidence::capacity(Capacity::At(*x), 0)).collect();
    let found = fit(&all, Dispersion::Free).unwrap();
    let sample = moments(&x).unwrap();
    near(found.curve.median, sample.median, 1e-12);
    let n = x.len() as f64;
    near(found.curve.dispersion, sample.dispersion * ((n - 1.0) / n).sqrt(), 1e-12);
    near(found.median_error, found.curve.dispersion / n.sqrt(), 1e-10);
    near(found.dispersion_error, 1.0 / (2.0 * n).sqrt(), 1e-10);
}

#[test]
fn a_narrow_bracket_says_what_an_exact_capacity_says() {
    let x = [0.21, 0.35, 0.44, 0.52, 0.78, 0.31];
    let fitted = |of: &dyn Fn(f64) -> Capacity| {
        let all: Vec<Evidence> = x.iter().map(|x| Evidence::capacity(of(*x), 0)).collect();
        fit(&all, Dispersion::Free).unwrap().curve
    };
    let exact = fitted(&|x| Capacity::At(x));
    let bracketed = fitted(&|x| Capacity::Between(x * 0.999, x * 1.001));
    near(bracketed.median / exact.median, 1.0, 1e-5); // measured 1e-7
    near(bracketed.dispersion / exact.dispersion, 1.0, 1e-5); // measured 2e-6
}

#[test]
fn records_that_never_fail_raise_the_median_instead_of_being_dropped() {
    let mut all: Vec<Evidence> =
        [0.3, 0.4, 0.5, 0.6].map(|x| Evidence::capacity(Capacity::At(x), 0)).to_vec();
    let without = fit(&all, Dispersion::Free).unwrap().curve;
    all.extend([Evidence::capacity(Capacity::Above(0.8), 0); 2]);
    let with = fit(&all, Dispersion::Free).unwrap().curve;
    // Two of six capacities are above 0.8, so the fitted curve must leave about a third there.
    near(with.probability(0.8), 2.0 / 3.0, 0.12); // measured 0.073
    assert!(with.median > 1.2 * without.median);
}

#[test]
fn a_given_dispersion_is_kept_and_needs_no_overlap() {
    let separated = [(0.2, 10, 0), (0.4, 10, 10)].map(|(intensity, cases, failures)| Stripe {
        intensity,
        cases,
        failures,
    });
    let found = fit(&evidence(&separated), Dispersion::Fixed(0.4)).unwrap();
    assert_eq!((found.curve.dispersion, found.dispersion_error, found.parameters), (0.4, 0.0, 1));
    near(found.curve.median, 0.08_f64.sqrt(), 1e-9); // by symmetry
    let data = evidence(&eight_stripes());
    let free = fit(&data, Dispersion::Free).unwrap();
    let fixed = fit(&data, Dispersion::Fixed(free.curve.dispersion)).unwrap();
    near(fixed.curve.median, free.curve.median, 1e-10);
    assert!(fit(&data, Dispersion::Fixed(0.3)).unwrap().ln_likelihood < free.ln_likelihood);
}

#[test]
fn data_that_determine_no_curve_are_refused_by_name() {
    let of = |counts: &[(f64, u32, u32)]| {
        let stripes: Vec<Stripe> = counts
            .iter()
            .map(|&(intensity, cases, failures)| Stripe { intensity, cases, failures })
            .collect();
        fit(&evidence(&stripes), Dispersion::Free).unwrap_err()
    };
    assert_eq!(of(&[]), FitError::Empty);
    assert_eq!(of(&[(0.2, 5, 0), (0.4, 5, 0)]), FitError::NothingFailed { largest: 0.4 });
    assert_eq!(of(&[(0.2, 5, 5), (0.4, 5, 5)]), FitError::EverythingFailed { smallest: 0.2 });
    assert_eq!(of(&[(0.2, 5, 0), (0.4, 5, 5)]), FitError::Separated { above: 0.2, below: 0.4 });
    // If failures and survivals overlap in a single level, the error states that level as both bounds.
    assert_eq!(of(&[(0.4, 5, 2)]), FitError::Separated { above: 0.4, below: 0.4 });
    // Only one level has both failures and survivals, so any steep curve through it fits.
    let one_mixed = of(&[(0.2, 5, 0), (0.3, 5, 2), (0.4, 5, 5)]);
    assert_eq!(one_mixed, FitError::Separated { above: 0.3, below: 0.3 });
    assert_eq!(of(&[(0.2, 5, 4), (0.4, 5, 1)]), FitError::NotIncreasing);
    assert_eq!(of(&[(0.2, 5, 2), (0.4, 5, 2)]), FitError::NotIncreasing);
    assert_eq!(of(&[(0.2, 5, 5), (0.4, 5, 0)]), FitError::NotIncreasing);
    let zero = fit(&[Evidence::case(0.0, true, 0)], Dispersion::Free).unwrap_err();
    assert!(matches!(zero, FitError::Invalid { index: 0, found: 0.0, .. }));
    let data = evidence(&eight_stripes());
    assert_eq!(fit(&data, Dispersion::Fixed(-1.0)).unwrap_err(), FitError::BadDispersion(-1.0));
    assert_eq!(
        profile_band(&data, Dispersion::Free, 1.0, &[0.4]).unwrap_err(),
        FitError::BadLevel(1.0)
    );
}

#[test]
fn identical_capacities_have_no_dispersion() {
    let all = [Evidence::capacity(Capacity::At(0.4), 0); 3];
    assert_eq!(
        fit(&all, Dispersion::Free).unwrap_err(),
        FitError::Separated { above: 0.4, below: 0.4 }
    );
    assert!(moments(&[0.4, 0.4]).is_err() && moments(&[0.4]).is_err());
}

#[test]
fn the_profile_band_holds_the_curve_and_widens_with_the_level() {
    let data = evidence(&eight_stripes());
    let found = fit(&data, Dispersion::Free).unwrap();
    let at = [0.01, 0.1, 0.3, 0.42, 0.7, 1.5, 5.0];
    let wide = profile_band(&data, Dispersion::Free, 0.95, &at).unwrap();
    let narrow = profile_band(&data, Dispersion::Free, 0.5, &at).unwrap();
    for ((x, wide), narrow) in at.iter().zip(&wide).zip(&narrow) {
        let p = found.curve.probability(*x);
        assert!(wide.low < narrow.low && narrow.high < wide.high, "{x}");
        assert!(narrow.low < p && p < narrow.high, "{x}");
    }
    // Near the median the band agrees with the standard error: ±1.96 · 0.0598 in ln θ.
    let median = profile_median(&data, Dispersion::Free, 0.95).unwrap();
    near(median.low, found.median_interval(0.95).low, 0.004); // measured 0.0017
    near(median.high, found.median_interval(0.95).high, 0.006); // measured 0.0024
}

#[test]
fn the_profile_of_a_fixed_dispersion_agrees_with_the_likelihood_itself() {
    let data = evidence(&eight_stripes());
    let beta = Dispersion::Fixed(0.45);
    let found = fit(&data, beta).unwrap();
    let bounds = profile_median(&data, beta, 0.95).unwrap();
    let ln_likelihood = |theta: f64| -> f64 {
        let term = |s: &Stripe| {
            let p = normal((s.intensity / theta).ln() / 0.45);
            let (k, n) = (f64::from(s.failures), f64::from(s.cases));
            k * p.ln() + (n - k) * (1.0 - p).max(1e-300).ln()
        };
        eight_stripes().iter().map(term).sum()
    };
    for bound in [bounds.low, bounds.high] {
        let fall = found.ln_likelihood - ln_likelihood(bound);
        near(fall, 0.5 * 3.841_458_820_694_124, 1e-5); // measured 1e-7
    }
}

#[test]
fn a_median_that_data_hardly_bound_has_an_open_interval() {
    let weak = [(0.3, 4, 1), (0.6, 4, 2)].map(|(intensity, cases, failures)| Stripe {
        intensity,
        cases,
        failures,
    });
    let bounds = profile_median(&evidence(&weak), Dispersion::Free, 0.95).unwrap();
    assert_eq!((bounds.low, bounds.high), (0.0, f64::INFINITY));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn the_unit_of_intensity_does_not_matter(seed in 0_u64..1000, unit in 1e-3_f64..1e3) {
        let mut random = Random::new(seed);
        let cases: Vec<(f64, bool)> = (0..40)
            .map(|_| {
                let x = (0.8 * random.normal()).exp();
                (x, random.uniform() < normal(x.ln() / 0.5))
            })
            .collect();
        let fitted = |unit: f64| {
            fit(&evidence(&stripes(cases.iter().map(|(x, f)| (x * unit, *f)))), Dispersion::Free)
        };
        match (fitted(1.0), fitted(unit)) {
            (Ok(one), Ok(other)) => {
                // Measured: 2e-15 for both.
                prop_assert!((other.curve.median / one.curve.median / unit - 1.0).abs() < 1e-11);
                prop_assert!((other.curve.dispersion / one.curve.dispersion - 1.0).abs() < 1e-11);
            }
            (one, other) => prop_assert_eq!(one.is_err(), other.is_err()),
        }
    }

    #[test]
    fn any_counts_give_a_curve_or_a_reason(
        counts in prop::collection::vec((0.01_f64..10.0, 1_u32..30, 0.0_f64..=1.0), 1..9)
    ) {
        let stripes: Vec<Stripe> = counts
            .iter()
            .map(|&(intensity, cases, share)| {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≤ 30")]
                let failures = (share * f64::from(cases)).round() as u32;
                Stripe { intensity, cases, failures }
            })
            .collect();
        match fit(&evidence(&stripes), Dispersion::Free) {
            Ok(found) => {
                prop_assert!(found.curve.median.is_finite() && found.curve.dispersion > 0.0);
                prop_assert!(found.median_error.is_finite());
            }
            Err(error) => prop_assert!(error != FitError::NotConverged, "{stripes:?}"),
        }
    }
}
