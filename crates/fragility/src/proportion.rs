//! Confidence intervals of a proportion from counts.

use crate::math::{beta_quantile, exp, ln, normal_quantile};

/// Confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// `true` if a value lies within the interval, bounds included.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}

/// Returns the score interval of a proportion (Wilson 1927); 0 to 1 if there are no cases.
///
/// The interval is short, and its coverage is close to the level on average.
pub fn wilson(failures: u32, cases: u32, level: f64) -> Interval {
    if cases == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let z = -normal_quantile(0.5 * (1.0 - level));
    let n = f64::from(cases);
    let p = f64::from(failures) / n;
    let scale = 1.0 + z * z / n;
    let center = (p + z * z / (2.0 * n)) / scale;
    let half = z / scale * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    Interval {
        low: if failures == 0 { 0.0 } else { center - half },
        high: if failures >= cases { 1.0 } else { center + half },
    }
}

/// Returns the exact interval of a proportion (Clopper and Pearson 1934); 0 to 1 if there are no cases.
///
/// The coverage is never below `level`.
pub fn clopper_pearson(failures: u32, cases: u32, level: f64) -> Interval {
    let tail = 0.5 * (1.0 - level);
    let (k, n) = (f64::from(failures), f64::from(cases));
    Interval {
        low: if failures == 0 { 0.0 } else { beta_quantile(tail, k, n - k + 1.0) },
        high: if failures >= cases { 1.0 } else { beta_quantile(1.0 - tail, k + 1.0, n - k) },
    }
}

/// Returns the largest proportion of a population that a sample of `count` observations may plausibly miss completely.
///
/// A part of the population that makes up this proportion is missed with the probability `(1 − level)/2`. This is the
/// probability of one tail of a two-sided confidence interval with the level `level`.
pub fn unobserved(count: usize, level: f64) -> f64 {
    if count == 0 { 1.0 } else { 1.0 - exp(ln(0.5 * (1.0 - level)) / count as f64) }
}

/// Returns the one-sided upper confidence bound of a proportion (Clopper and Pearson 1934); 1 if there are no
/// cases.
///
/// The coverage is never below `probability`.
pub fn at_most(failures: u32, cases: u32, probability: f64) -> f64 {
    if failures >= cases {
        return 1.0;
    }
    let (k, n) = (f64::from(failures), f64::from(cases));
    beta_quantile(probability, k + 1.0, n - k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::ln_choose;

    #[test]
    fn one_sided_bounds_have_their_textbook_values() {
        // For no failures in n cases the bound is 1 − 0.05^(1/n) (rule of three).
        assert!((at_most(0, 24, 0.95) - (1.0 - 0.05_f64.powf(1.0 / 24.0))).abs() < 1e-12);
        // If the true probability equals the bound, then in 5 % of samples of 34 cases at most one case fails.
        let p = at_most(1, 34, 0.95);
        let tail = (1.0 - p).powi(34) + 34.0 * p * (1.0 - p).powi(33);
        assert!((tail - 0.05).abs() < 1e-9, "{p}: {tail}");
        assert_eq!((at_most(3, 3, 0.95), at_most(0, 0, 0.95)), (1.0, 1.0));
        assert!(((1.0 - unobserved(24, 0.95)).powi(24) - 0.025).abs() < 1e-12);
    }

    #[test]
    fn wilson_has_its_textbook_values() {
        let found = wilson(5, 20, 0.95);
        assert!((found.low - 0.111_86).abs() < 1e-5 && (found.high - 0.468_70).abs() < 1e-5);
        assert_eq!(wilson(0, 20, 0.95).low, 0.0);
        assert_eq!(wilson(20, 20, 0.95).high, 1.0);
        assert_eq!(wilson(0, 0, 0.95), Interval { low: 0.0, high: 1.0 });
    }

    /// Returns the probability of at least `k` failures in `n` cases, each of which fails with the
    /// probability `p`.
    fn at_least(k: u32, n: u32, p: f64) -> f64 {
        (k..=n)
            .map(|j| {
                let odds = f64::from(j) * ln(p) + f64::from(n - j) * ln(1.0 - p);
                exp(ln_choose(n, j) + odds)
            })
            .sum()
    }

    #[test]
    fn clopper_pearson_bounds_leave_exactly_the_tails() {
        for n in [1, 2, 7, 20, 100, 1000] {
            for k in (0..=n).step_by((n as usize / 17).max(1)) {
                let found = clopper_pearson(k, n, 0.95);
                if k > 0 {
                    let tail = at_least(k, n, found.low);
                    assert!((tail - 0.025).abs() < 1e-9, "{k} of {n}: {tail}"); // measured 1e-12
                }
                if k < n {
                    let tail = 1.0 - at_least(k + 1, n, found.high);
                    assert!((tail - 0.025).abs() < 1e-9, "{k} of {n}: {tail}"); // measured 1e-11
                }
            }
        }
    }
}
