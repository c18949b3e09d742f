//! Whether failure becomes likelier with intensity, as every fragility curve takes for granted.

use std::collections::BTreeMap;

use crate::bootstrap::drawn;
use crate::evidence::Stripe;
use crate::goodness::deviance;

/// A stretch of intensities over which the raw fraction of failures falls.
#[derive(Clone, Debug, PartialEq)]
pub struct Fall {
    /// The stripe of the high fraction, at the lower intensity.
    pub from: Stripe,
    /// The stripe of the low fraction, at the higher intensity.
    pub to: Stripe,
    /// The chance of so clear a fall if failure never becomes less likely; independent cases taken
    /// for granted.
    pub p: f64,
}

/// Raw fractions against the nearest ones that never fall.
#[derive(Clone, Debug, PartialEq)]
pub struct Monotony {
    /// The counts, in ascending order of intensity.
    pub stripes: Vec<Stripe>,
    /// The likeliest chances that never fall with intensity (Ayer et al. 1955), one a stripe.
    pub isotonic: Vec<f64>,
    /// Twice the logarithm of the likelihood ratio of the raw fractions to these.
    pub deviance: f64,
    /// The chance of so large a `deviance` if failure never becomes less likely.
    pub p: f64,
    /// Where fractions fall, one for each pool of the isotonic chances, clear or not.
    pub falls: Vec<Fall>,
}

impl Monotony {
    /// The falls that chance does not explain at a level of significance, such as 0.05.
    pub fn significant(&self, level: f64) -> impl Iterator<Item = &Fall> {
        self.falls.iter().filter(move |fall| fall.p < level)
    }
}

/// A pool of neighboring stripes of one chance.
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

/// Pools neighbors that violate the order until none does.
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

/// The isotonic chances and the deviance of each pool, zero for single stripes.
fn isotonic(stripes: &[Stripe]) -> (Vec<Pool>, Vec<f64>, Vec<f64>) {
    let pools = pools(stripes);
    let mut chances = Vec::with_capacity(stripes.len());
    let mut misfits = Vec::with_capacity(pools.len());
    for pool in &pools {
        let chance = pool.chance();
        chances.extend((pool.first..=pool.last).map(|_| chance));
        // A pool of one is met exactly; rounding must not make it a misfit.
        let alone = pool.first == pool.last;
        let misfit = || deviance(&stripes[pool.first..=pool.last], |_| chance).max(0.0);
        misfits.push(if alone { 0.0 } else { misfit() });
    }
    (pools, chances, misfits)
}

/// Tests whether fractions fall with intensity, by the likelihood ratio of the raw fractions to the
/// isotonic ones, whose distribution is drawn from these; stripes without cases are left out.
///
/// A pool of the isotonic chances is a stretch in which fractions fall. Its own `p` compares its
/// part of the deviance with the largest part of any pool in each draw, so that looking at many
/// stretches is paid for.
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

/// The pair of stripes, the first of the lower intensity, whose fractions fall most; of several, the
/// one nearest to each other.
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

/// A group that failed at one intensity and stood at a higher.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Returned {
    /// The group.
    pub group: usize,
    /// The lowest intensity at which it failed.
    pub failed: f64,
    /// The highest at which it stood nevertheless.
    pub stood: f64,
}

/// Groups, such as records, that failed at one intensity and stood at a higher one: a fact about
/// each, whatever the statistics say. Cases are `(group, intensity, failed)`.
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
