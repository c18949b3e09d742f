//! Fragility of one limit state against one intensity measure: raw fractions, fitted curve, confidence band
//! and tests.

use std::collections::BTreeMap;

use barrelstack_fragility::{
    Capacity, Dispersion, Evidence, Fit, FitError, Goodness, Interval, LeaveOneOut, Monotony,
    Returned, Stripe, fit, goodness, goodness_in_bins, leave_one_out, monotony, profile_band,
    profile_median, returns, wilson,
};
use barrelstack_motion::Random;

use super::cases::{Cases, JudgedCase};
use super::limit::LimitState;

/// Confidence level of all bands.
pub(super) const LEVEL: f64 = 0.95;

/// Number of simulated data sets in the test of whether failure becomes likelier with intensity.
const DRAWS: usize = 500;

/// Method by which a confidence band is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandKind {
    /// Jackknife over records, since the cases of one record may be correlated.
    Records,
    /// Profile likelihood of independent cases, used if all cases come from one record.
    Likelihood,
    /// No band: there are several records, but the jackknife fails ([`leave_one_out`]). It fails, for example, if the
    /// cases do not determine a curve once one of the records is omitted.
    None,
}

/// Fragility of one limit state against one intensity measure.
#[derive(Clone, Debug)]
pub struct LimitCurve {
    /// Limit state.
    pub limit: LimitState,
    /// Index of the measure in [`Cases::measures`].
    pub measure: usize,
    /// Numbers of cases and failures at each level or in each bin.
    pub stripes: Vec<Stripe>,
    /// Wilson score interval of each raw fraction.
    pub intervals: Vec<Interval>,
    /// Fitted curve, or the reason why there is none.
    pub fit: Result<Fit, FitError>,
    /// Intensities at which the confidence band is given.
    pub grid: Vec<f64>,
    /// 95 % confidence band at each intensity of `grid`; empty if there is no curve or no band.
    pub band: Vec<Interval>,
    /// 95 % interval of the median of the fitted curve; `None` if the interval cannot be computed.
    pub median: Option<Interval>,
    /// Method by which the confidence band was computed.
    pub band_kind: BandKind,
    /// Curves fitted with one record left out, for each record in turn. The uncertainty of derived results is computed
    /// from these curves. `None` if the jackknife fails ([`leave_one_out`]).
    pub left_out: Option<LeaveOneOut>,
    /// Goodness of fit of the fitted curve to the raw counts; `None` if there is no fitted curve.
    pub goodness: Option<Goodness>,
    /// Result of the test of whether failure becomes likelier with intensity.
    pub monotony: Monotony,
    /// Curves on which the stack failed at one intensity and stood at a higher one. A curve consists of cases of one
    /// motion at several intensities.
    ///
    /// Empty for independent samples, since each sample is a separate curve.
    pub returned: Vec<Returned>,
}

impl LimitCurve {
    /// Counts failures, fits a curve and tests the fit.
    pub fn of(cases: &Cases, limit: LimitState, measure: usize) -> Self {
        let known = cases.only(|case| limit.is_known(case));
        let cases = &known;
        let evidence = evidence(cases, &limit, measure);
        let groups = cases.groups(measure);
        let stripes: Vec<Stripe> = if cases.hunted {
            known_at_levels(&evidence)
        } else {
            groups.iter().map(|(x, of)| stripe(*x, of, |case| limit.reached(case))).collect()
        };
        let intervals = stripes.iter().map(|s| wilson(s.failures, s.cases, LEVEL)).collect();
        let fit = fit(&evidence, Dispersion::Free);
        let grid = grid(&stripes);
        let mut random = Random::new(cases.seed);
        let left_out = leave_one_out(&evidence, Dispersion::Free).ok();
        let (band, median, band_kind) = if let Some(found) = &left_out {
            (found.band(LEVEL, &grid), Some(found.median(LEVEL)), BandKind::Records)
        } else if cases.records.len() == 1 {
            let band = profile_band(&evidence, Dispersion::Free, LEVEL, &grid);
            let median = profile_median(&evidence, Dispersion::Free, LEVEL);
            (band.unwrap_or_default(), median.ok(), BandKind::Likelihood)
        } else {
            (Vec::new(), None, BandKind::None)
        };
        let single = |case: &JudgedCase| {
            Some(stripe(case.intensity(measure)?, &[case], |case| limit.reached(case)))
        };
        let goodness = fit.as_ref().ok().map(|fit| {
            if cases.hunted {
                return goodness(&stripes, fit);
            }
            let of = |(_, of): &(f64, Vec<&JudgedCase>)| {
                of.iter().filter_map(|case| single(case)).collect::<Vec<Stripe>>()
            };
            goodness_in_bins(&groups.iter().map(of).collect::<Vec<_>>(), fit)
        });
        let monotony = monotony(&stripes, DRAWS, || random.uniform());
        let outcomes = cases.all.iter().filter(|_| !cases.sampled).filter_map(|case| {
            Some((case.curve as usize, case.intensity(measure)?, limit.reached(case)))
        });
        let returned = returns(outcomes);
        Self {
            limit,
            measure,
            stripes,
            intervals,
            fit,
            grid,
            band,
            median,
            band_kind,
            left_out,
            goodness,
            monotony,
            returned,
        }
    }

    /// Returns the standard errors of `ln(median)` and of `ln(dispersion)`.
    ///
    /// With several records, the standard errors are clustered by record. With one record, the cases are
    /// taken as independent.
    ///
    /// # Errors
    /// If no curve could be fitted.
    pub fn standard_errors(&self) -> Result<[f64; 2], &FitError> {
        let fit = self.fit.as_ref()?;
        Ok(match &self.left_out {
            Some(others) => [others.median_error(), others.dispersion_error()],
            None => [fit.median_error, fit.dispersion_error],
        })
    }

    /// Returns `true` if the fraction of failures decreases significantly in some range of intensity. A fragility curve
    /// cannot describe such a decrease.
    pub fn violates_order(&self) -> bool {
        self.monotony.p < 0.05
    }

    /// Returns the probability of failure at an intensity, interpolated between the raw fractions.
    ///
    /// Between levels, the probability is linear in the logarithm of the intensity. Above the highest level
    /// it is constant. Below the lowest level it decreases linearly to zero at zero intensity.
    pub fn raw(&self, intensity: f64) -> f64 {
        let points: Vec<(f64, f64)> =
            self.stripes.iter().map(|s| (s.intensity, s.fraction())).collect();
        interpolate(&points, intensity)
    }
}

/// Interpolates between points linearly in the logarithm of the abscissa.
///
/// Above the last point, the value is constant. Below the first point, it decreases linearly to zero at an abscissa of
/// zero.
pub(super) fn interpolate(points: &[(f64, f64)], at: f64) -> f64 {
    let after = points.partition_point(|(x, _)| *x < at);
    match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
        (_, None) => points.last().map_or(0.0, |(_, y)| *y),
        (None, Some((x, y))) => y * (at / x).clamp(0.0, 1.0),
        (Some((x0, y0)), Some((x1, y1))) => {
            y0 + (y1 - y0) * libm::log(at / x0) / libm::log(x1 / x0)
        }
    }
}

/// Counts cases and failures, and returns the two counts as a stripe at the given intensity.
pub(super) fn stripe(
    intensity: f64,
    of: &[&JudgedCase],
    failed: impl Fn(&JudgedCase) -> bool,
) -> Stripe {
    Stripe {
        intensity,
        cases: u32::try_from(of.len()).unwrap_or(u32::MAX),
        failures: of.iter().map(|case| u32::from(failed(case))).sum(),
    }
}

/// Returns observations of the capacity of the stack, that is, of the intensity at which the stack fails.
///
/// In general, each case is one observation: the stack failed or stood at the intensity of the case.
///
/// In an incremental dynamic analysis, a hunt searches for the level at which one motion makes the stack collapse. Its
/// levels depend on the results of earlier runs, so counts at these levels would be biased. Each hunt is therefore one
/// observation: the capacity lies between the lowest level at which the stack failed and the level below it, or beyond
/// the first or last level if there is no such pair.
fn evidence(cases: &Cases, limit: &LimitState, measure: usize) -> Vec<Evidence> {
    let measured = cases.all.iter().filter_map(|case| Some((case, case.intensity(measure)?)));
    if !cases.hunted {
        return measured
            .map(|(case, x)| Evidence::case(x, limit.reached(case), case.record as usize))
            .collect();
    }
    let mut hunts: BTreeMap<u32, (usize, Vec<(f64, bool)>)> = BTreeMap::new();
    for (case, x) in measured {
        let hunt = hunts.entry(case.curve).or_insert_with(|| (case.record as usize, Vec::new()));
        hunt.1.push((x, limit.reached(case)));
    }
    hunts
        .into_values()
        .filter_map(|(record, mut runs)| {
            runs.sort_by(|a, b| a.0.total_cmp(&b.0));
            let failed = runs.iter().position(|(_, failed)| *failed);
            let capacity = match failed {
                None => Capacity::Above(runs.last()?.0),
                Some(0) => Capacity::Below(runs[0].0),
                Some(at) => Capacity::Between(runs[at - 1].0, runs[at].0),
            };
            Some(Evidence::capacity(capacity, record))
        })
        .collect()
}

/// Counts cases and failures of an incremental dynamic analysis at up to eight intensities. Each hunt is a case, and
/// counts at an intensity only if the hunt shows whether the stack fails there.
fn known_at_levels(evidence: &[Evidence]) -> Vec<Stripe> {
    let bounds: Vec<(f64, f64)> = evidence.iter().map(|item| item.capacity.bounds()).collect();
    let ends = || bounds.iter().flat_map(|(low, high)| [*low, *high]);
    let sound = || ends().filter(|x| *x > 0.0 && x.is_finite());
    let (first, last) = (sound().fold(f64::INFINITY, f64::min), sound().fold(0.0, f64::max));
    if first >= last {
        return Vec::new();
    }
    let step = libm::log(last / first) / 7.0;
    (0..8)
        // The last level is not computed: if it were rounded down, the failures at this level would not be counted.
        .map(|i| if i == 7 { last } else { first * libm::exp(step * f64::from(i)) })
        .map(|intensity| {
            let failures = bounds.iter().map(|(_, high)| u32::from(*high <= intensity)).sum();
            let stood: u32 = bounds
                .iter()
                .map(|(low, high)| u32::from(*low >= intensity && *high > intensity))
                .sum();
            Stripe { intensity, cases: failures + stood, failures }
        })
        .filter(|stripe| stripe.cases > 0)
        .collect()
}

/// Returns intensities that are evenly spaced in the logarithm, from below the lowest stripe to above the
/// highest.
fn grid(stripes: &[Stripe]) -> Vec<f64> {
    let (Some(first), Some(last)) = (stripes.first(), stripes.last()) else { return Vec::new() };
    let (low, high) = (0.6 * first.intensity, 1.4 * last.intensity);
    let step = libm::log(high / low) / 48.0;
    (0..=48).map(|i| low * libm::exp(step * f64::from(i))).collect()
}
