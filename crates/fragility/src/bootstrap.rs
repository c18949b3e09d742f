//! Confidence by resampling.

use std::collections::BTreeMap;

use crate::curve::Lognormal;
use crate::evidence::{Evidence, Stripe, evidence};
use crate::fit::{Dispersion, FitError, fit};
use crate::math::{ln, normal, normal_quantile, quantile, student_quantile};
use crate::proportion::Interval;

/// Curves fitted to resampled data.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// The curve of the data themselves.
    pub fitted: Lognormal,
    /// One curve for each resampled data set that determines one, in the order drawn.
    pub curves: Vec<Lognormal>,
    /// Resampled data sets that do not, for the reasons of [`FitError`]. They are left out of
    /// every interval; above a few percent the intervals are too narrow.
    pub refused: usize,
    /// Curves with one group left out, for the acceleration; empty for simulated counts.
    left_out: Vec<Lognormal>,
}

impl Replicates {
    /// The interval of anything computed from a curve: percentiles, corrected for bias and
    /// acceleration (`BCa`; Efron 1987) and, where groups were resampled, for their number by
    /// Student's t (Hesterberg 2015), without which bands over a few dozen records are too narrow.
    pub fn interval(&self, level: f64, of: impl Fn(&Lognormal) -> f64) -> Interval {
        let mut values: Vec<f64> = self.curves.iter().map(&of).collect();
        values.sort_by(f64::total_cmp);
        let here = of(&self.fitted);
        let bias = bias(&values, here);
        let acceleration = self.acceleration(&of);
        let tail = 0.5 * (1.0 - level);
        let reach = match self.left_out.len() {
            0 | 1 => -normal_quantile(tail),
            groups => {
                let n = groups as f64;
                (n / (n - 1.0)).sqrt() * student_quantile(level, groups - 1)
            }
        };
        let share = |z: f64| normal(bias + (bias + z) / (1.0 - acceleration * (bias + z)).max(0.1));
        let bounds = [share(-reach), share(reach)].map(|share| quantile(&values, share));
        Interval { low: bounds[0], high: bounds[1] }
    }

    /// Skewness of the influence of the groups, over six.
    fn acceleration(&self, of: &impl Fn(&Lognormal) -> f64) -> f64 {
        let values: Vec<f64> = self.left_out.iter().map(of).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let (mut squares, mut cubes) = (0.0, 0.0);
        for value in &values {
            let off = mean - value;
            squares += off * off;
            cubes += off * off * off;
        }
        if squares > 0.0 { cubes / (6.0 * squares * squares.sqrt()) } else { 0.0 }
    }

    /// The interval of the chance of failure at each intensity.
    pub fn band(&self, level: f64, intensities: &[f64]) -> Vec<Interval> {
        // The score is a monotone function of the chance and does not run into 0 and 1.
        let score = |curve: &Lognormal, x: f64| ln(x / curve.median) / curve.dispersion;
        let chance = |x: &f64| {
            let scores = self.interval(level, |curve| score(curve, *x));
            Interval { low: normal(scores.low), high: normal(scores.high) }
        };
        intensities.iter().map(chance).collect()
    }

    /// The interval of the median.
    pub fn median(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.median)
    }

    /// The interval of the dispersion.
    pub fn dispersion(&self, level: f64) -> Interval {
        self.interval(level, |curve| curve.dispersion)
    }

    /// The same with the first `most` curves alone, for what is slow to compute from a curve.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        let mut fewer = self.clone();
        fewer.curves.truncate(most.max(1));
        fewer
    }

    /// Share of the resampled data sets that determine no curve.
    pub fn refused_share(&self) -> f64 {
        self.refused as f64 / (self.refused + self.curves.len()) as f64
    }
}

/// The score of the share of ascending values that lie below one, ties halved.
fn bias(ascending: &[f64], value: f64) -> f64 {
    let below = ascending.partition_point(|x| *x < value);
    let same = ascending[below..].partition_point(|x| *x <= value);
    let n = ascending.len() as f64;
    let share = (below as f64 + 0.5 * same as f64) / n;
    normal_quantile(share.clamp(1.0 / (n + 1.0), n / (n + 1.0)))
}

/// A whole number below `count` from a uniform number.
fn below(count: usize, uniform: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below count")]
    let index = (uniform * count as f64) as usize;
    index.min(count - 1)
}

/// Collects the curves of `replicates` data sets; at least half of them must determine one.
fn collect(
    fitted: Lognormal,
    replicates: usize,
    dispersion: Dispersion,
    mut sample: impl FnMut(&mut Vec<Evidence>),
) -> Result<Replicates, FitError> {
    let curves = Vec::with_capacity(replicates);
    let mut found = Replicates { fitted, curves, refused: 0, left_out: vec![] };
    let mut drawn = vec![];
    for _ in 0..replicates {
        drawn.clear();
        sample(&mut drawn);
        match fit(&drawn, dispersion) {
            Ok(fit) => found.curves.push(fit.curve),
            Err(_) => found.refused += 1,
        }
    }
    if found.curves.is_empty() || found.curves.len() < found.refused {
        return Err(FitError::Unstable { usable: found.curves.len(), replicates });
    }
    Ok(found)
}

/// Evidence by group, where the same capacity is one item however many groups say it.
struct Groups {
    capacities: Vec<Evidence>,
    /// Which capacities a group says, and how often.
    members: Vec<Vec<(usize, f64)>>,
}

impl Groups {
    fn of(all: &[Evidence]) -> Self {
        let mut places: BTreeMap<(u64, u64), usize> = BTreeMap::new();
        let mut capacities: Vec<Evidence> = vec![];
        let mut members: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for item in all {
            let (low, high) = item.capacity.bounds();
            let place = *places.entry((low.to_bits(), high.to_bits())).or_insert_with(|| {
                capacities.push(*item);
                capacities.len() - 1
            });
            members.entry(item.group).or_default().push((place, item.weight));
        }
        Self { capacities, members: members.into_values().collect() }
    }

    /// The evidence of the groups, each as often as it says.
    fn gather(&self, times: impl IntoIterator<Item = usize>, into: &mut Vec<Evidence>) {
        let mut weights = vec![0.0; self.capacities.len()];
        for group in times {
            for (place, weight) in &self.members[group] {
                weights[*place] += weight;
            }
        }
        let said = self.capacities.iter().zip(weights).filter(|(_, weight)| *weight > 0.0);
        into.extend(said.map(|(item, weight)| Evidence { weight, ..*item }));
    }
}

/// Resamples whole groups with replacement: all that one record says is drawn or left out
/// together, so that the dependence between cases of one record is kept (Efron and Tibshirani
/// 1993, chapter 8).
///
/// # Errors
/// As [`fit`] for the data themselves, or when fewer than half of the resampled data sets
/// determine a curve.
pub fn bootstrap(
    all: &[Evidence],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Replicates, FitError> {
    let fitted = fit(all, dispersion)?.curve;
    let groups = Groups::of(all);
    let count = groups.members.len();
    let mut found = collect(fitted, replicates, dispersion, |drawn| {
        groups.gather((0..count).map(|_| below(count, uniform())), drawn);
    })?;
    for left in 0..count {
        let mut rest = vec![];
        groups.gather((0..count).filter(|group| *group != left), &mut rest);
        // A group without which there is no curve has no finite influence to count.
        found.left_out.push(fit(&rest, dispersion).map_or(fitted, |fit| fit.curve));
    }
    Ok(found)
}

/// How many of `cases` fail when each does with a chance.
pub(crate) fn binomial(cases: u32, chance: f64, uniform: &mut impl FnMut() -> f64) -> u32 {
    (0..cases).map(|_| u32::from(uniform() < chance)).sum()
}

/// Counts drawn from a curve at the intensities and numbers of cases of `stripes`.
pub(crate) fn drawn(
    stripes: &[Stripe],
    chance: impl Fn(usize) -> f64,
    uniform: &mut impl FnMut() -> f64,
) -> Vec<Stripe> {
    let draw =
        |(i, s): (usize, &Stripe)| Stripe { failures: binomial(s.cases, chance(i), uniform), ..*s };
    stripes.iter().enumerate().map(draw).collect()
}

/// Draws counts from the fitted curve itself and fits each again (parametric bootstrap): for
/// independent cases whose curve is believed.
///
/// # Errors
/// As [`bootstrap`].
pub fn simulate(
    stripes: &[Stripe],
    dispersion: Dispersion,
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Result<Replicates, FitError> {
    let found = fit(&evidence(stripes), dispersion)?;
    let chance = |i: usize| found.curve.probability(stripes[i].intensity);
    collect(found.curve, replicates, dispersion, |into| {
        into.extend(evidence(&drawn(stripes, chance, &mut uniform)));
    })
}
