//! Observed capacities, to which fragility curves are fitted.

use crate::fit::FitError;

/// Value or bounds of the capacity of a case. The capacity is the intensity at which the case begins to fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Capacity {
    /// The capacity is this intensity.
    At(f64),
    /// The case failed at this intensity, so that its capacity is at or below this intensity.
    Below(f64),
    /// The case stood at this intensity, so that its capacity is above this intensity.
    Above(f64),
    /// The case stood at the first intensity and failed at the second, which is higher.
    Between(f64, f64),
}

impl Capacity {
    /// Returns the lowest and the highest possible capacity, which are 0 and infinity if there is no bound.
    pub fn bounds(self) -> (f64, f64) {
        match self {
            Self::At(x) => (x, x),
            Self::Below(x) => (0.0, x),
            Self::Above(x) => (x, f64::INFINITY),
            Self::Between(low, high) => (low, high),
        }
    }
}

/// Observation of a capacity, made in one or several cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Observed capacity.
    pub capacity: Capacity,
    /// Number of cases with this observation.
    pub weight: f64,
    /// Number that identifies a group of dependent cases, for example the index of their record.
    /// [`leave_one_out`](crate::leave_one_out) omits one group at a time; other methods ignore the group.
    pub group: usize,
}

impl Evidence {
    /// Creates the evidence of one case that failed or stood at an intensity.
    pub fn case(intensity: f64, failed: bool, group: usize) -> Self {
        let capacity = if failed { Capacity::Below(intensity) } else { Capacity::Above(intensity) };
        Self { capacity, weight: 1.0, group }
    }

    /// Creates the evidence of one case with a known or bounded capacity.
    pub fn capacity(capacity: Capacity, group: usize) -> Self {
        Self { capacity, weight: 1.0, group }
    }
}

/// Numbers of cases and of failures at one intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    /// Intensity, in the unit of the intensity measure.
    pub intensity: f64,
    /// Number of cases that were run.
    pub cases: u32,
    /// Number of failures.
    pub failures: u32,
}

impl Stripe {
    /// Returns the fraction of cases that failed; NaN if there are no cases.
    pub fn fraction(&self) -> f64 {
        f64::from(self.failures) / f64::from(self.cases)
    }
}

/// Converts failure counts to evidence. Each stripe is a separate group.
pub fn evidence(stripes: &[Stripe]) -> Vec<Evidence> {
    let mut all = Vec::with_capacity(2 * stripes.len());
    for (group, stripe) in stripes.iter().enumerate() {
        let stood = stripe.cases.saturating_sub(stripe.failures);
        let parts = [
            (Capacity::Below(stripe.intensity), stripe.failures),
            (Capacity::Above(stripe.intensity), stood),
        ];
        for (capacity, count) in parts {
            if count > 0 {
                all.push(Evidence { capacity, weight: f64::from(count), group });
            }
        }
    }
    all
}

/// Counts cases and failures at each intensity, in ascending order.
///
/// Each case is `(intensity, failed)`; cases of exactly the same intensity share a stripe.
pub fn stripes(cases: impl IntoIterator<Item = (f64, bool)>) -> Vec<Stripe> {
    let mut sorted: Vec<(f64, bool)> = cases.into_iter().collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Vec<Stripe> = vec![];
    for (intensity, failed) in sorted {
        match found.last_mut() {
            Some(last) if last.intensity == intensity => {
                last.cases += 1;
                last.failures += u32::from(failed);
            }
            _ => found.push(Stripe { intensity, cases: 1, failures: u32::from(failed) }),
        }
    }
    found
}

/// Checks that every intensity is positive and finite, that every pair of bounds is in ascending order, and
/// that every weight is positive.
pub(crate) fn check(all: &[Evidence]) -> Result<(), FitError> {
    if all.is_empty() {
        return Err(FitError::Empty);
    }
    let bad = |index: usize, expected: &'static str, found: f64| {
        Err(FitError::Invalid { index, expected, found })
    };
    for (index, item) in all.iter().enumerate() {
        if !(item.weight.is_finite() && item.weight > 0.0) {
            return bad(index, "a positive number of cases", item.weight);
        }
        let (low, high) = match item.capacity {
            Capacity::At(x) | Capacity::Below(x) | Capacity::Above(x) => (x, x),
            Capacity::Between(low, high) => (low, high),
        };
        for x in [low, high] {
            if !(x.is_finite() && x > 0.0) {
                return bad(index, "a positive, finite intensity", x);
            }
        }
        if matches!(item.capacity, Capacity::Between(..)) && low >= high {
            return bad(index, "a bracket whose first intensity is the lower one", low);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_gather_into_ascending_stripes() {
        let found = stripes([(0.4, true), (0.2, false), (0.4, false), (0.4, true)]);
        assert_eq!(
            found,
            [
                Stripe { intensity: 0.2, cases: 1, failures: 0 },
                Stripe { intensity: 0.4, cases: 3, failures: 2 },
            ]
        );
        assert_eq!(evidence(&found).len(), 3);
    }

    #[test]
    fn bad_evidence_is_named_by_its_place() {
        let mut all = vec![Evidence::case(0.2, true, 0), Evidence::case(-0.1, true, 0)];
        assert_eq!(
            check(&all).unwrap_err().to_string(),
            "observation 2: expected a positive, finite intensity, found -0.1"
        );
        all[1].capacity = Capacity::Between(0.4, 0.3);
        assert!(check(&all).is_err());
        assert_eq!(check(&[]), Err(FitError::Empty));
    }
}
