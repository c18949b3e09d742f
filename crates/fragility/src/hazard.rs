//! Seismic hazard of a site, and its integration with a fragility curve or with losses.

use crate::math::{exp, ln};

/// Reason why a table is not a hazard curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum HazardError {
    /// The table has fewer than two rows.
    #[error("a hazard curve needs at least two rows, found {0}")]
    Short(usize),
    /// A number is not valid as an intensity or a rate.
    #[error("row {}: expected {what} that is positive and finite, found {found}", row + 1)]
    Invalid {
        /// Index of the row, counted from 0.
        row: usize,
        /// Name of the invalid quantity.
        what: &'static str,
        /// Invalid value.
        found: f64,
    },
    /// Intensities are not in ascending order.
    #[error(
        "row {}: expected an intensity above {before}, found {found}; sort the rows by intensity",
        row + 1
    )]
    Unsorted {
        /// Index of the row, counted from 0.
        row: usize,
        /// Intensity of the previous row.
        before: f64,
        /// Intensity of this row.
        found: f64,
    },
    /// Rates increase with intensity.
    #[error(
        "row {}: expected an annual rate of at most {before}, found {found}; a higher intensity cannot be exceeded \
         more often than a lower one",
        row + 1
    )]
    Rising {
        /// Index of the row, counted from 0.
        row: usize,
        /// Rate of the previous row.
        before: f64,
        /// Rate of this row.
        found: f64,
    },
}

/// Seismic hazard curve of a site: the annual rate at which each intensity is exceeded.
///
/// Between rows, the logarithm of the rate is linear in the logarithm of the intensity. The table is not
/// extrapolated. Shaking weaker than the first row is assumed to have no effect. For shaking stronger than
/// the last row, results are given as a lower and an upper bound ([`Rate`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Hazard {
    rows: Vec<(f64, f64)>,
}

/// Annual rate of an event, as a lower and an upper bound. The bounds differ in the assumed effect of shaking beyond
/// the last row of the hazard table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Rate (1/year) if shaking stronger than the last row has the same effect as the last row.
    pub low: f64,
    /// Rate (1/year) if shaking stronger than the last row has the worst possible effect.
    pub high: f64,
    /// Probability of the event, or expected consequence, at the intensity of the first row. If this value is not
    /// small, weaker and more frequent shaking matters as well, and the table should begin at a lower intensity.
    pub at_first: f64,
}

/// Contribution of a range of intensities to an annual rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Lower end of the range.
    pub from: f64,
    /// Upper end of the range.
    pub to: f64,
    /// Contribution to the rate (1/year).
    pub rate: f64,
}

/// Abscissas and weights of five-point Gauss–Legendre quadrature on the interval from −1 to 1.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Width of the integration intervals in `ln x`. With this width, the error is about 10⁻⁹ even for a
/// fragility curve with a dispersion of 0.05.
const PIECE: f64 = 0.01;

impl Hazard {
    /// Creates a hazard curve from rows of intensity and annual rate of exceedance (1/year), in ascending
    /// order of intensity.
    ///
    /// # Errors
    /// If there are fewer than two rows, a number is not positive, or the rows are not in order.
    pub fn new(rows: &[(f64, f64)]) -> Result<Self, HazardError> {
        if rows.len() < 2 {
            return Err(HazardError::Short(rows.len()));
        }
        for (row, (x, rate)) in rows.iter().enumerate() {
            for (what, found) in [("an intensity", *x), ("an annual rate", *rate)] {
                if !(found.is_finite() && found > 0.0) {
                    return Err(HazardError::Invalid { row, what, found });
                }
            }
            if let Some((x_before, rate_before)) = row.checked_sub(1).map(|i| rows[i]) {
                if *x <= x_before {
                    return Err(HazardError::Unsorted { row, before: x_before, found: *x });
                }
                if *rate > rate_before {
                    return Err(HazardError::Rising { row, before: rate_before, found: *rate });
                }
            }
        }
        Ok(Self { rows: rows.to_vec() })
    }

    /// Returns the rows of the table: pairs of an intensity and its annual rate of exceedance (1/year).
    pub fn rows(&self) -> &[(f64, f64)] {
        &self.rows
    }

    /// Returns the annual rate at which an intensity is exceeded; `None` outside the table.
    pub fn exceedance(&self, intensity: f64) -> Option<f64> {
        let after = self.rows.partition_point(|(x, _)| *x < intensity);
        let next = *self.rows.get(after)?;
        if next.0 == intensity {
            return Some(next.1);
        }
        let before = self.rows[after.checked_sub(1)?];
        let exponent = ln(next.1 / before.1) / ln(next.0 / before.0);
        Some(before.1 * exp(exponent * ln(intensity / before.0)))
    }

    /// Returns the intensity that is exceeded once per return period (years) on average; `None` outside the
    /// table.
    pub fn intensity(&self, return_period: f64) -> Option<f64> {
        let rate = 1.0 / return_period;
        let pair = self.rows.windows(2).find(|pair| pair[0].1 >= rate && rate >= pair[1].1)?;
        let [(x0, r0), (x1, r1)] = [pair[0], pair[1]];
        if r0 == r1 {
            return Some(x0);
        }
        Some(x0 * exp(ln(x1 / x0) * ln(rate / r0) / ln(r1 / r0)))
    }

    /// Returns the integral of `of(x) |dλ(x)|` between two intensities, where `λ(x)` is the annual rate at which the
    /// intensity `x` is exceeded. Intensities outside the table contribute nothing.
    fn integral(&self, from: f64, to: f64, of: &impl Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        for pair in self.rows.windows(2) {
            let [(x0, r0), (x1, r1)] = [pair[0], pair[1]];
            let (low, high) = (ln(from.max(x0)), ln(to.min(x1)));
            if high <= low || r0 == r1 {
                continue;
            }
            // λ(u) = r0 exp(−k (u − u0)), and −dλ = k λ du.
            let (u0, k) = (ln(x0), -ln(r1 / r0) / ln(x1 / x0));
            // A steep hazard curve needs finer intervals.
            let pieces = ((high - low) / PIECE * (1.0 + 0.02 * k)).ceil().clamp(1.0, 1e6);
            let width = (high - low) / pieces;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≤ 1e6")]
            let pieces = pieces as usize;
            for piece in 0..pieces {
                let middle = low + (piece as f64 + 0.5) * width;
                for (at, weight) in GAUSS {
                    let u = middle + 0.5 * width * at;
                    let density = k * r0 * exp(-k * (u - u0));
                    sum += 0.5 * width * weight * density * of(exp(u));
                }
            }
        }
        sum
    }

    fn ends(&self) -> [(f64, f64); 2] {
        [self.rows[0], self.rows[self.rows.len() - 1]]
    }

    /// Returns the annual rate of an event, such as failure. `probability` gives the probability of the event
    /// at an intensity (Cornell and Krawinkler 2000).
    pub fn rate_of(&self, probability: impl Fn(f64) -> f64) -> Rate {
        self.expected(1.0, probability)
    }

    /// Returns the expected annual consequence, such as barrels lost per year.
    ///
    /// `consequence` returns the expected consequence at an intensity. No consequence may exceed `worst`.
    pub fn expected(&self, worst: f64, consequence: impl Fn(f64) -> f64) -> Rate {
        let [(first, _), (last, beyond)] = self.ends();
        let within = self.integral(first, last, &consequence);
        Rate {
            low: within + beyond * consequence(last),
            high: within + beyond * worst,
            at_first: consequence(first),
        }
    }

    /// Returns the contribution of each range of intensities to the annual rate of an event, or to the expected annual
    /// consequence (deaggregation). Each range lies between two consecutive `edges`.
    ///
    /// `consequence` returns the probability of the event, or the expected consequence, at an intensity. Intensities
    /// outside the table contribute nothing.
    pub fn contributions(
        &self,
        edges: &[f64],
        consequence: impl Fn(f64) -> f64,
    ) -> Vec<Contribution> {
        let part = |pair: &[f64]| Contribution {
            from: pair[0],
            to: pair[1],
            rate: self.integral(pair[0], pair[1], &consequence),
        };
        edges.windows(2).map(part).collect()
    }
}

/// Returns the probability of at least one event in a number of years, for a given annual rate of events.
///
/// Events are assumed to be independent (a Poisson process).
pub fn chance_within(years: f64, annual_rate: f64) -> f64 {
    -libm::expm1(-annual_rate * years)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lognormal;

    fn power_law(k0: f64, k: f64) -> Hazard {
        let rows: Vec<(f64, f64)> = (0..=40)
            .map(|i| exp(-12.0 + 0.6 * f64::from(i)))
            .map(|x| (x, k0 * exp(-k * ln(x))))
            .collect();
        Hazard::new(&rows).unwrap()
    }

    #[test]
    fn a_power_law_gives_the_closed_form() {
        for (k, beta) in [(1.0, 0.3), (2.5, 0.45), (3.0, 0.6), (2.0, 0.05)] {
            let curve = Lognormal { median: 0.5, dispersion: beta };
            let rate = power_law(1e-4, k).rate_of(|x| curve.probability(x));
            let exact = 1e-4 * exp(-k * ln(0.5) + 0.5 * k * k * beta * beta);
            let error = (rate.low / exact - 1.0).abs().max((rate.high / exact - 1.0).abs());
            assert!(error < 1e-6, "{k} {beta}: {error:e}"); // measured 2e-7, the ends of the table
        }
    }

    #[test]
    fn contributions_add_up_to_the_rate_within_the_table() {
        let hazard = power_law(1e-4, 2.0);
        let curve = Lognormal { median: 0.5, dispersion: 0.4 };
        let edges: Vec<f64> = [-12.0, -3.0, -1.0, -0.3, 0.4, 12.0].map(exp).to_vec();
        let parts = hazard.contributions(&edges, |x| curve.probability(x));
        let sum: f64 = parts.iter().map(|part| part.rate).sum();
        let rate = hazard.rate_of(|x| curve.probability(x));
        assert!((sum / rate.low - 1.0).abs() < 1e-6); // measured 1e-8
        assert!(parts[2].rate > parts[0].rate);
    }

    #[test]
    fn a_short_table_leaves_the_end_open_and_says_what_the_beginning_does() {
        let hazard = Hazard::new(&[(0.1, 0.02), (0.4, 0.002)]).unwrap();
        let curve = Lognormal { median: 0.4, dispersion: 0.5 };
        let rate = hazard.rate_of(|x| curve.probability(x));
        assert!((rate.high - rate.low - 0.001).abs() < 1e-15); // half of the rate of the last row
        assert_eq!(rate.at_first, curve.probability(0.1));
    }

    #[test]
    fn rates_and_intensities_are_read_in_logarithms_and_not_beyond_the_table() {
        let hazard = Hazard::new(&[(0.1, 0.1), (1.0, 0.001)]).unwrap();
        assert!((hazard.exceedance(0.1_f64.sqrt() * 1.0).unwrap() - 0.01).abs() < 1e-15);
        assert!((hazard.intensity(100.0).unwrap() - 0.1_f64.sqrt()).abs() < 1e-12);
        assert_eq!(hazard.exceedance(0.05), None);
        assert_eq!(hazard.exceedance(2.0), None);
        assert_eq!(hazard.intensity(1e6), None);
        assert!((chance_within(50.0, 1.0 / 475.0) - 0.100_0).abs() < 1e-3);
    }

    #[test]
    fn tables_that_are_no_hazard_curve_are_refused_by_row() {
        let said = |rows: &[(f64, f64)]| Hazard::new(rows).unwrap_err().to_string();
        assert!(said(&[(0.1, 0.1)]).contains("at least two rows"));
        assert!(
            said(&[(0.1, 0.1), (0.05, 0.01)]).starts_with("row 2: expected an intensity above")
        );
        assert!(
            said(&[(0.1, 0.1), (0.2, 0.2)]).starts_with("row 2: expected an annual rate of at")
        );
        assert!(said(&[(0.1, 0.0), (0.2, 0.2)]).starts_with("row 1: expected an annual rate that"));
    }
}
