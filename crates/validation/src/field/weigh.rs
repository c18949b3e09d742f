//! Posterior of the unknowns, given statements about shares of fallen barrels or stacks: draws from the prior, weighted
//! by likelihoods.

use barrelstack_motion::Random;

use super::cases::{FieldCases, UNKNOWNS};
use super::chance::{Chance, FITS, MEDIANS, Point};
use barrelstack_calibration::shares::{Kind, Likelihood, Statement};

/// Standard deviations of the natural logarithms of the first three unknowns in the prior, the same as in `[unknowns]`
/// of a scenario. The standard deviation for the fourth unknown, the scale factor of the motion, depends on the
/// earthquake.
const SPREADS: [f64; 3] = [0.35, 0.2, 0.6];

/// Smallest and largest simulated value of each unknown. The prior is truncated to these ranges.
pub(super) const RANGES: [[f64; 2]; UNKNOWNS] =
    [[0.12, 0.75], [0.30, 0.85], [0.7, 13.0], [0.5, 2.0]];

/// Number of draws from the prior.
pub(super) const DRAWS: usize = 20_000;

/// A study: its cases, and the probability of a fall that is fitted to them.
#[derive(Clone, Debug)]
pub(super) struct Fitted<'a> {
    /// Cases of the study.
    pub(super) cases: &'a FieldCases,
    /// Fitted probability of a fall.
    pub(super) chance: Chance,
    /// Mean share of fallen barrels in the stacks that fell, for each height from 2 to 6 levels.
    pub(super) fallen: [f64; 5],
    in_space: bool,
}

impl<'a> Fitted<'a> {
    /// Fits the probability of a fall to the cases of a study.
    pub(super) fn new(cases: &'a FieldCases) -> Self {
        Self {
            cases,
            chance: Chance::fit(cases),
            fallen: [2, 3, 4, 5, 6].map(|levels| cases.fallen(levels)),
            in_space: cases.cases.iter().any(|case| case.azimuth.is_some()),
        }
    }

    /// Returns the probability that a stack falls, with the coefficients of the fit in a draw. If `draw` is `None`,
    /// uses the coefficients that maximize the posterior density.
    pub(super) fn share(&self, levels: usize, point: &Point, draw: Option<usize>) -> f64 {
        self.chance.of(levels, point, self.in_space, draw)
    }

    /// Returns the mean probability of a fall over the cases with a given number of levels and over all draws of the
    /// coefficients. The mean is close to the share of these cases in which the stack fell.
    pub(super) fn over_the_design(&self, levels: usize) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for draw in 0..FITS {
            for case in self.cases.of(levels) {
                let azimuth = case.azimuth.unwrap_or_default();
                let point = Point { unknowns: case.unknowns, azimuth };
                sum += self.share(levels, &point, Some(draw));
                count += 1.0;
            }
        }
        sum / count
    }
}

fn lognormal(median: f64, spread: f64, range: [f64; 2], random: &mut Random) -> f64 {
    loop {
        let value = median * libm::exp(spread * random.normal());
        if value >= range[0] && value <= range[1] {
            return value;
        }
    }
}

/// Draws values of the unknowns from the prior. `motion` is the standard deviation of the natural logarithm of the
/// scale factor of the motion.
pub(super) fn prior(motion: f64, seed: u64) -> Vec<[f64; UNKNOWNS]> {
    let mut random = Random::new(seed);
    (0..DRAWS)
        .map(|_| {
            std::array::from_fn(|at| {
                let spread = SPREADS.get(at).copied().unwrap_or(motion);
                lognormal(MEDIANS[at], spread, RANGES[at], &mut random)
            })
        })
        .collect()
}

/// Predicts, for each draw of the unknowns, the share (of barrels or of stacks) about which a statement was made. Each
/// prediction also draws an azimuth, a mixture of heights (all mixtures are equally probable) and coefficients of the
/// fit.
pub(super) fn predicted(
    statement: &Statement,
    studies: &[&Fitted<'_>],
    draws: &[[f64; UNKNOWNS]],
    seed: u64,
) -> Vec<f64> {
    let mut random = Random::new(seed);
    let share = |unknowns: &[f64; UNKNOWNS]| {
        let azimuth = std::f64::consts::TAU * random.uniform();
        let point = Point { unknowns: *unknowns, azimuth };
        let parts: Vec<f64> =
            statement.levels.iter().map(|_| -libm::log(1.0 - random.uniform())).collect();
        let total: f64 = parts.iter().sum();
        let drawn: Vec<usize> =
            studies.iter().map(|_| usize::try_from(random.bits() >> 33).unwrap_or(0)).collect();
        let of = |levels: usize| {
            let pairs = studies.iter().zip(&drawn);
            let stands: f64 =
                pairs.map(|(one, draw)| 1.0 - one.share(levels, &point, Some(*draw))).product();
            let barrels = if statement.kind == Kind::Barrels {
                studies.first().map_or(1.0, |one| one.fallen[levels - 2])
            } else {
                1.0
            };
            (1.0 - stands) * barrels
        };
        statement.levels.iter().zip(&parts).map(|(&levels, part)| part / total * of(levels)).sum()
    };
    draws.iter().map(share).collect()
}

/// Returns the weight of each draw: the likelihood of the share that was predicted for the draw.
pub(super) fn weights(shares: &[f64], likelihood: Likelihood) -> Vec<f64> {
    shares.iter().map(|share| likelihood.of(*share)).collect()
}

/// Mean, median and central 90 % interval of a weighted sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// Lower end of the central 90 % interval.
    pub low: f64,
    /// Upper end of the central 90 % interval.
    pub high: f64,
}

/// Returns the mean, the median and the central 90 % interval of weighted values.
pub(super) fn range(values: &[f64], weights: &[f64]) -> Range {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let total: f64 = weights.iter().sum();
    let at = |share: f64| {
        let mut sum = 0.0;
        for &one in &order {
            sum += weights[one];
            if sum >= share * total {
                return values[one];
            }
        }
        f64::NAN
    };
    let mean = values.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>() / total;
    Range { mean, median: at(0.5), low: at(0.05), high: at(0.95) }
}

/// Returns the effective number of draws (Kish): (Σ w)² / Σ w².
pub(super) fn effective(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    sum * sum / weights.iter().map(|w| w * w).sum::<f64>()
}

/// Returns the mean weight of the draws in which an unknown lies within a range; `None` if there are too few of these
/// draws.
pub(super) fn within(
    draws: &[[f64; UNKNOWNS]],
    weights: &[f64],
    unknown: usize,
    range: [f64; 2],
) -> Option<f64> {
    let inside = |draw: &[f64; UNKNOWNS]| draw[unknown] >= range[0] && draw[unknown] < range[1];
    let (mut sum, mut count) = (0.0, 0.0);
    for (_, weight) in draws.iter().zip(weights).filter(|(draw, _)| inside(draw)) {
        sum += weight;
        count += 1.0;
    }
    (count >= 100.0).then(|| sum / count)
}
