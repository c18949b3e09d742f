//! Fragility fits compared with published numbers, the coverage of the confidence bands of the fits, and an annual rate
//! compared with a closed form.

use barrelstack_dynamics::math::exp;
use barrelstack_fragility::{
    Dispersion, Fit, Hazard, Interval, Lognormal, Stripe, evidence, fit, profile_band, simulate,
};

use crate::problem::{absent, absolute, relative, setting};
use crate::tumble::Random;
use crate::{Effort, Failure, Outcome, Problem};

const BAKER: &str = "Baker 2015, eqs. 8 to 11";

/// Returns eight stripes (intensity levels) of twenty cases each.
fn stripes() -> Vec<Stripe> {
    let x = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0];
    let failures = [0, 1, 5, 9, 12, 15, 18, 20];
    let stripe = |(intensity, failures)| Stripe { intensity, cases: 20, failures };
    x.into_iter().zip(failures).map(stripe).collect()
}

fn fitted(stripes: &[Stripe]) -> Result<Fit, Failure> {
    fit(&evidence(stripes), Dispersion::Free).map_err(absent)
}

/// Creates the problem of one number that follows from a fit to the eight stripes. The exact answer is the published
/// number, and the tolerance is half a unit of its last digit.
fn number(
    id: &str,
    quantity: &'static str,
    exact: f64,
    half_digit: f64,
    of: impl Fn(&Fit) -> f64 + Send + Sync + 'static,
) -> Problem {
    setting(format!("fragility/{id}"), "eight stripes of twenty cases", BAKER)
        .quantity(quantity, "", absolute(exact, half_digit))
        .by(move |_| Ok(of(&fitted(&stripes())?)))
}

const TRUTH: Lognormal = Lognormal { median: 0.45, dispersion: 0.45 };
const LEVELS: [f64; 7] = [0.15, 0.25, 0.35, 0.45, 0.6, 0.8, 1.0];
const AT: [f64; 5] = [0.2, 0.3, 0.45, 0.6, 0.9];

/// Returns the share of confidence bands that contain the true curve at an intensity, averaged over five intensities.
/// Each band is fitted to a campaign of seven stripes of thirty cases.
fn coverage(
    effort: Effort,
    band: fn(&[Stripe], &mut Random) -> Result<Vec<Interval>, Failure>,
) -> Result<Outcome, Failure> {
    let campaigns = if effort == Effort::Full { 1000 } else { 60 };
    let mut random = Random(2026);
    let mut held = [0_u32; AT.len()];
    for _ in 0..campaigns {
        let drawn: Vec<Stripe> = LEVELS
            .iter()
            .map(|&intensity| {
                let p = TRUTH.probability(intensity);
                let failures = (0..30).map(|_| u32::from(random.within(0.0, 1.0) < p)).sum();
                Stripe { intensity, cases: 30, failures }
            })
            .collect();
        for ((held, interval), x) in held.iter_mut().zip(band(&drawn, &mut random)?).zip(AT) {
            *held += u32::from(interval.holds(TRUTH.probability(x)));
        }
    }
    let shares = held.map(|held| f64::from(held) / f64::from(campaigns));
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let each: Vec<String> =
        shares.iter().zip(AT).map(|(share, x)| format!("{share:.3} at {x}")).collect();
    Ok(Outcome::of(mean).noted(format!("{campaigns} campaigns: {}", each.join(", "))))
}

fn covered(
    id: &str,
    title: &str,
    source: &str,
    band: fn(&[Stripe], &mut Random) -> Result<Vec<Interval>, Failure>,
) -> Problem {
    setting(format!("fragility/{id}"), title, source)
        // With sixty campaigns, the mean coverage over five correlated intensities scatters by about 0.02.
        .quantity(
            "share of 95 % bands that contain the true curve, mean over five intensities",
            "",
            absolute(0.95, 0.02).fast(0.05),
        )
        .by(move |effort| coverage(effort, band))
}

/// Creates the problem of the annual rate of failure under the hazard `λ(x) = k₀ x⁻ᵏ`. For a fragility curve with the
/// median θ and the dispersion β, the exact rate is `k₀ θ⁻ᵏ exp(k²β²/2)`.
fn power_law() -> Problem {
    let (k0, k, ln_median) = (1e-4, 2.5, -0.7);
    let curve = Lognormal { median: exp(ln_median), dispersion: 0.45 };
    setting(
        "fragility/annual-rate",
        "lognormal fragility under a power-law hazard",
        "Cornell et al. 2002: λ = k₀ θ⁻ᵏ exp(k²β²/2)",
    )
    .quantity(
        "annual rate of failure",
        "1/a",
        relative(k0 * exp(-k * ln_median + 0.5 * (k * curve.dispersion).powi(2)), 1e-6),
    )
    .by(move |_| {
        let row = |i: i32| -12.0 + 0.6 * f64::from(i);
        let rows: Vec<(f64, f64)> = (0..=40).map(row).map(|u| (exp(u), k0 * exp(-k * u))).collect();
        let hazard = Hazard::new(&rows).map_err(absent)?;
        Ok(hazard.rate_of(|x| curve.probability(x)).low)
    })
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        number("median", "median θ", 0.426_30, 5e-6, |fit| fit.curve.median),
        number("dispersion", "dispersion β", 0.455_93, 5e-6, |fit| fit.curve.dispersion),
        number("likelihood", "ln L with binomial coefficients", -9.683_33, 5e-6, |fit| {
            fit.ln_likelihood_of(&stripes())
        }),
        number("median-error", "standard error of ln θ", 0.0598, 5e-5, |fit| fit.median_error),
        number("dispersion-error", "standard error of ln β", 0.1439, 5e-5, |fit| {
            fit.dispersion_error
        }),
        covered(
            "coverage-likelihood",
            "bands by profile likelihood",
            "Wilks 1938",
            |stripes, _| {
                profile_band(&evidence(stripes), Dispersion::Free, 0.95, &AT).map_err(absent)
            },
        ),
        covered(
            "coverage-bootstrap",
            "bands by parametric bootstrap of 400 replicates, corrected for bias",
            "Efron 1987",
            |stripes, random| {
                simulate(stripes, Dispersion::Free, 400, || random.within(0.0, 1.0))
                    .map(|replicates| replicates.band(0.95, &AT))
                    .map_err(absent)
            },
        ),
        power_law(),
    ]
}
