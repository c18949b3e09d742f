//! Test of an assumption of every fragility curve: that failure becomes likelier with intensity.

use std::collections::BTreeMap;

use crate::bootstrap::drawn;
use crate::evidence::Stripe;
use crate::goodness::deviance;

/// Range of intensities over which the observed fraction of failures decreases.
#[derive(Clone, Debug, PartialEq)]
pub struct Fall {
    /// Stripe at the lower intensity, which has the higher fraction of failures.
    pub from: Stripe,
    /// Stripe at the higher intensity, which has the lower fraction of failures.
    pub to: Stripe,
    /// p-value for independent cases: the probability of a decrease at least as significant as this one if
    /// failure never becomes less likely with intensity.
    pub p: f64,
}

/// Comparison of the observed fractions of failures with the best-fitting nondecreasing probabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct Monotony {
    /// Failure counts, in ascending order of intensity.
    pub stripes: Vec<Stripe>,
    /// Nondecreasing probabilities that maximize the likelihood, one for each stripe (Ayer et al. 1955).
    pub isotonic: Vec<f64>,
    /// Deviance: twice the log-likelihood ratio between the observed fractions and the nondecreasing
    /// probabilities.
    pub deviance: f64,
    /// p-value: the probability of a `deviance` at least as large as this one if failure never becomes less
    /// likely with intensity.
    pub p: f64,
    /// All decreases of the fractions, whether significant or not. Neighboring stripes between which the fraction
    /// decreases are pooled, and have the same isotonic probability. Each pool of several stripes gives one decrease.
    pub falls: Vec<Fall>,
}

impl Monotony {
    /// Returns the decreases that are significant at `level`, such as 0.05.
    pub fn significant(&self, level: f64) -> impl Iterator<Item = &Fall> {
        self.falls.iter().filter(move |fall| fall.p < level)
    }
}

/// Adjacent stripes that have the same isotonic probability.
struct Pool {
    first: usize,
    last: usize,
    cases: f64,
    failures: f64,
}

impl Pool {
    fn chance(&self) -> f64 {
        self.failures / self.cases
    }
}

/// Pools neighboring stripes until no pool has a lower fraction of failures than the pool before it.
fn pools(stripes: &[Stripe]) -> Vec<Pool> {
    let mut pools: Vec<Pool> = vec![];
    for (i, stripe) in stripes.iter().enumerate() {
        let mut pool = Pool {
            first: i,
            last: i,
            cases: f64::from(stripe.cases),
            failures: f64::from(stripe.failures),
        };
        while let Some(before) = pools.pop_if(|before| before.chance() > pool.chance()) {
            pool.first = before.first;
            pool.cases += before.cases;
            pool.failures += before.failures;
        }
        pools.push(pool);
    }
    pools
}

/// Returns the pools, the isotonic probability of each stripe, and the deviance of each pool, which is zero
/// for single stripes.
fn isotonic(stripes: &[Stripe]) -> (Vec<Pool>, Vec<f64>, Vec<f64>) {
    let pools = pools(stripes);
    let mut chances = Vec::with_capacity(stripes.len());
    let mut misfits = Vec::with_capacity(pools.len());
    for pool in &pools {
        let chance = pool.chance();
        chances.extend((pool.first..=pool.last).map(|_| chance));
        // A single stripe fits exactly; rounding must not give it a deviance.
        let alone = pool.first == pool.last;
        let misfit = || deviance(&stripes[pool.first..=pool.last], |_| chance).max(0.0);
        misfits.push(if alone { 0.0 } else { misfit() });
    }
    (pools, chances, misfits)
}

/// Tests whether the fraction of failures decreases with intensity.
///
/// The statistic is the likelihood ratio between the observed fractions and the isotonic (nondecreasing)
/// probabilities. Its distribution is simulated: failure counts are drawn with these probabilities. Stripes
/// without cases are ignored. Each pool of several stripes with the same isotonic probability is a range in
/// which fractions decrease. The `p` of a pool compares the deviance of the pool with the largest deviance of
/// any pool in each simulated sample. This corrects for multiple comparisons.
pub fn monotony(
    stripes: &[Stripe],
    replicates: usize,
    mut uniform: impl FnMut() -> f64,
) -> Monotony {
    let mut sorted: Vec<Stripe> = stripes.iter().filter(|s| s.cases > 0).copied().collect();
    sorted.sort_by(|a, b| a.intensity.total_cmp(&b.intensity));
    let (pools, chances, misfits) = isotonic(&sorted);
    let observed: f64 = misfits.iter().sum();
    let mut as_large = 0_usize;
    let mut pool_as_large = vec![0_usize; pools.len()];
    if observed > 0.0 {
        for _ in 0..replicates {
            let draw = drawn(&sorted, |i| chances[i], &mut uniform);
            let (_, _, misfits_there) = isotonic(&draw);
            as_large += usize::from(misfits_there.iter().sum::<f64>() >= observed - 1e-12);
            let largest = misfits_there.iter().copied().fold(0.0, f64::max);
            for (count, misfit) in pool_as_large.iter_mut().zip(&misfits) {
                *count += usize::from(largest >= misfit - 1e-12);
            }
        }
    }
    let share = |count: usize| (count + 1) as f64 / (replicates + 1) as f64;
    let falls = pools
        .iter()
        .zip(&pool_as_large)
        .filter(|(pool, _)| pool.last > pool.first)
        .filter_map(|(pool, count)| {
            let (from, to) = steepest(&sorted[pool.first..=pool.last])?;
            Some(Fall { from, to, p: share(*count) })
        })
        .collect();
    let p = if observed > 0.0 { share(as_large) } else { 1.0 };
    Monotony { stripes: sorted, isotonic: chances, deviance: observed, p, falls }
}

/// Returns the two stripes between which the fraction decreases most; the stripe of lower intensity comes
/// first.
///
/// If there are several such pairs, the one whose first stripe has the highest intensity is returned; if there are
/// several of these, the one whose second stripe has the lowest intensity. `None` is returned if the fraction never
/// decreases.
fn steepest(stripes: &[Stripe]) -> Option<(Stripe, Stripe)> {
    let mut found: Option<(f64, Stripe, Stripe)> = None;
    for (i, from) in stripes.iter().enumerate() {
        for to in &stripes[i + 1..] {
            let drop = from.fraction() - to.fraction();
            let more = |(most, earlier, _): (f64, Stripe, Stripe)| {
                drop > most || (drop == most && from.intensity > earlier.intensity)
            };
            if drop > 0.0 && found.is_none_or(more) {
                found = Some((drop, *from, *to));
            }
        }
    }
    found.map(|(_, from, to)| (from, to))
}

/// Group of cases that failed at one intensity and stood at a higher one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Returned {
    /// Number that identifies the group.
    pub group: usize,
    /// Lowest intensity at which the group failed.
    pub failed: f64,
    /// Highest intensity at which the group stood.
    pub stood: f64,
}

/// Returns the groups that failed at one intensity and stood at a higher one. A group is, for example, all cases of one
/// record.
///
/// Each case is a triple `(group, intensity, failed)`. No statistical test is performed.
pub fn returns(cases: impl IntoIterator<Item = (usize, f64, bool)>) -> Vec<Returned> {
    let mut bounds: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for (group, intensity, failed) in cases {
        let (lowest, highest) = bounds.entry(group).or_insert((f64::INFINITY, f64::NEG_INFINITY));
        if failed {
            *lowest = lowest.min(intensity);
        } else {
            *highest = highest.max(intensity);
        }
    }
    bounds
        .into_iter()
        .filter(|(_, (failed, stood))| failed < stood)
        .map(|(group, (failed, stood))| Returned { group, failed, stood })
        .collect()
}
