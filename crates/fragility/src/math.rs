//! Transcendental functions that are bit-identical on every platform, and probability distributions based on
//! them.

use special::{Beta, Gamma};
use std::f64::consts::FRAC_1_SQRT_2;

pub(crate) fn ln(x: f64) -> f64 {
    libm::log(x)
}

pub(crate) fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// `ln √(2π)`.
pub(crate) const LN_ROOT_TAU: f64 = 0.918_938_533_204_672_7;

/// Score below which `Φ` is evaluated by an asymptotic series, since `erfc` underflows at −37.5.
const DEEP: f64 = -30.0;

/// Returns the asymptotic series `1 − 1/z² + 3/z⁴ − …` of `−z Φ(z)/φ(z)` for very negative `z` (Abramowitz
/// and Stegun 1964, 26.2.12). At `z = −30` its error is 2·10⁻¹⁴.
fn deep_series(z: f64) -> f64 {
    let t = 1.0 / (z * z);
    1.0 - t * (1.0 - t * (3.0 - t * (15.0 - t * (105.0 - t * 945.0))))
}

/// Returns the standard normal density `φ(z)`.
pub fn normal_density(z: f64) -> f64 {
    exp(-0.5 * z * z - LN_ROOT_TAU)
}

/// Returns the standard normal distribution function `Φ(z)`, which is accurate even in the lower tail.
pub fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Returns `ln Φ(z)` for any `z`.
pub(crate) fn ln_normal(z: f64) -> f64 {
    if z < DEEP {
        -0.5 * z * z - LN_ROOT_TAU - ln(-z) + ln(deep_series(z))
    } else if z > 5.0 {
        libm::log1p(-normal(-z))
    } else {
        ln(normal(z))
    }
}

/// Returns `φ(z)/Φ(z)`, the derivative of `ln Φ`.
pub(crate) fn mills(z: f64) -> f64 {
    if z < DEEP { -z / deep_series(z) } else { normal_density(z) / normal(z) }
}

/// Returns `Φ(high) − Φ(low)` without loss of digits in either tail.
pub(crate) fn normal_between(low: f64, high: f64) -> f64 {
    if low > 0.0 { normal(-low) - normal(-high) } else { normal(high) - normal(low) }
}

/// Returns the `z` at which `Φ(z)` equals a probability; infinite for the probabilities 0 and 1, and NaN
/// outside the range from 0 to 1.
///
/// A rough initial value (Abramowitz and Stegun 1964, 26.2.23) is refined by Halley's method on `ln Φ` of the
/// smaller tail, which keeps all digits down to the smallest probability.
pub fn normal_quantile(probability: f64) -> f64 {
    if probability.is_nan() || !(0.0..=1.0).contains(&probability) {
        return f64::NAN;
    }
    if probability == 0.0 {
        return f64::NEG_INFINITY;
    }
    if probability > 0.5 {
        // 1 − p is exact for p in [0.5, 1].
        return -normal_quantile(1.0 - probability);
    }
    let target = ln(probability);
    let t = (-2.0 * target).sqrt();
    let rise = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let fall = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let mut z = rise / fall - t;
    for _ in 0..4 {
        let slope = mills(z);
        let miss = ln_normal(z) - target;
        let curvature = -slope * (z + slope);
        z -= 2.0 * miss * slope / (2.0 * slope * slope - miss * curvature);
    }
    z
}

/// Returns the probability that a χ² variable with `freedom` degrees of freedom is at least `value`; 1 if
/// `freedom` is 0.
pub fn chi_square_above(value: f64, freedom: usize) -> f64 {
    if freedom == 0 || value <= 0.0 {
        return 1.0;
    }
    if freedom == 1 {
        return 2.0 * normal(-value.sqrt());
    }
    1.0 - (0.5 * value).inc_gamma(0.5 * freedom as f64)
}

/// Returns the quantile of χ² with one degree of freedom.
pub(crate) fn chi_square_quantile_one(probability: f64) -> f64 {
    let z = normal_quantile(0.5 * (1.0 - probability));
    z * z
}

/// Returns the probability that `|T|` is at least `|t|`, where `T` has Student's t distribution with
/// `freedom` degrees of freedom.
pub fn student_beyond(t: f64, freedom: usize) -> f64 {
    if freedom == 0 || t.is_nan() {
        return 1.0;
    }
    let (p, q) = (0.5 * freedom as f64, 0.5);
    let x = freedom as f64 / (freedom as f64 + t * t);
    x.inc_beta(p, q, p.ln_beta(q))
}

/// Returns the `t` for which `T` lies between `−t` and `t` with a given probability, where `T` has Student's
/// t distribution; infinite if `freedom` is 0.
///
/// The quantile is computed from the incomplete beta function. Above 1000 degrees of freedom, that function
/// is slow and loses digits, so the asymptotic series is used instead (Abramowitz and Stegun 1964, 26.7.5).
pub fn student_quantile(probability: f64, freedom: usize) -> f64 {
    if freedom == 0 {
        return f64::INFINITY;
    }
    let nu = freedom as f64;
    if freedom > 1000 {
        let z = -normal_quantile(0.5 * (1.0 - probability));
        let y = z * z;
        let terms = [
            (y + 1.0) / 4.0,
            ((5.0 * y + 16.0) * y + 3.0) / 96.0,
            (((3.0 * y + 19.0) * y + 17.0) * y - 15.0) / 384.0,
        ];
        return z * (1.0 + (terms[0] + (terms[1] + terms[2] / nu) / nu) / nu);
    }
    let x = beta_quantile(1.0 - probability, 0.5 * nu, 0.5);
    (nu * (1.0 / x - 1.0)).sqrt()
}

/// Returns the `x` at which the regularized incomplete beta function `I(p, q)` equals a probability.
pub(crate) fn beta_quantile(probability: f64, p: f64, q: f64) -> f64 {
    probability.inv_inc_beta(p, q, p.ln_beta(q))
}

/// Returns `ln C(n, k)`.
pub(crate) fn ln_choose(n: u32, k: u32) -> f64 {
    let ln_factorial = |n: u32| libm::lgamma(f64::from(n) + 1.0);
    ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k)
}

/// Returns a quantile of sorted values, interpolated linearly between order statistics (Hyndman and Fan 1996,
/// type 7). Infinite values are allowed.
///
/// # Panics
/// If there are no values.
pub fn quantile(ascending: &[f64], share: f64) -> f64 {
    let last = ascending.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f64;
    let (below, part) = (place.floor(), place - place.floor());
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to last")]
    let index = below as usize;
    let low = ascending[index];
    if part == 0.0 {
        return low;
    }
    let high = ascending[(index + 1).min(last)];
    if low == high { low } else { low + part * (high - low) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_distribution_has_its_tabulated_values() {
        let table = [
            (1.0, 0.841_344_746_068_542_9),
            (-3.0, 1.349_898_031_630_094_5e-3),
            (-10.0, 7.619_853_024_160_526e-24),
        ];
        for (z, p) in table {
            assert!((normal(z) / p - 1.0).abs() < 1e-14, "{z}"); // measured 2e-15
        }
        // ln Φ(−40) = −804.608442…, where Φ itself underflows.
        assert!((ln_normal(-40.0) + 804.608_442_013_753_7).abs() < 1e-9); // measured 2e-13
        assert!((mills(-30.000_001) / mills(-29.999_999) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn the_quantile_inverts_the_distribution_to_rounding() {
        for p in [1e-300, 1e-100, 1e-16, 1e-5, 0.025, 0.3, 0.5, 0.7, 0.975, 0.999_999] {
            let z = normal_quantile(p);
            let error = (ln_normal(z) - ln(p)).abs();
            assert!(error < 1e-12 * ln(p).abs().max(1.0), "{p}: {error:e}"); // measured 4e-14
        }
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(normal_quantile(1.0), f64::INFINITY);
        assert!(normal_quantile(1.5).is_nan());
    }

    #[test]
    fn tails_of_chi_square_and_student_agree_with_printed_tables() {
        assert!((chi_square_above(3.841_458_820_694_124, 1) - 0.05).abs() < 1e-13);
        assert!((chi_square_above(12.591_587_243_743_977, 6) - 0.05).abs() < 1e-12);
        assert!((student_beyond(2.776_445_105_197_793, 4) - 0.05).abs() < 1e-12);
        assert!((student_beyond(-1.984_467_5, 98) - 0.05).abs() < 1e-6);
        assert!((student_quantile(0.95, 4) - 2.776_445_105_197_793).abs() < 1e-10);
        for (freedom, t) in [(2, 4.303), (3, 3.182), (9, 2.262), (30, 2.042), (120, 1.980)] {
            assert!((student_quantile(0.95, freedom) - t).abs() < 5e-4, "{freedom}"); // measured 4.5e-4
        }
        assert!((student_quantile(0.95, 1) - 12.706_204_736_174_7).abs() < 1e-8);
        assert!((student_quantile(0.95, 999) - 1.962_341_461).abs() < 1e-7);
        assert_eq!(student_quantile(0.95, 0), f64::INFINITY);
        assert_eq!(chi_square_above(7.0, 0), 1.0);
    }

    #[test]
    fn student_passes_from_the_beta_function_to_the_series_and_to_the_normal() {
        for probability in [0.5, 0.95, 0.99, 0.999] {
            let [before, at, after, later] =
                [999, 1000, 1001, 1002].map(|freedom| student_quantile(probability, freedom));
            // The step where the method changes, compared with the steps before and after; measured 5e-11.
            let bend = (at - after) - 0.5 * ((before - at) + (after - later));
            assert!(bend.abs() < 1e-9, "{probability}: {bend:e}");
            assert!((student_beyond(later, 1002) / (1.0 - probability) - 1.0).abs() < 1e-9); // measured 3e-10
        }
        let far = student_quantile(0.95, 1_000_000_000);
        assert!((far - 1.959_963_984_540_054).abs() < 1e-8, "{far}"); // measured 2.4e-9
    }

    #[test]
    fn quantiles_of_samples_interpolate_and_carry_infinities() {
        let sample = [1.0, 2.0, 4.0, f64::INFINITY];
        assert_eq!(quantile(&sample, 0.0), 1.0);
        assert_eq!(quantile(&sample, 0.5), 3.0);
        assert_eq!(quantile(&sample, 0.9), f64::INFINITY);
        assert_eq!(quantile(&sample, 1.0), f64::INFINITY);
    }

    #[test]
    fn binomial_coefficients_are_those_of_pascal() {
        assert!((ln_choose(20, 5) - 15504.0_f64.ln()).abs() < 1e-12);
        assert_eq!(ln_choose(7, 0), 0.0);
    }
}
