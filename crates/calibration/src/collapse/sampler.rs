//! Adaptive multiple importance sampling of a posterior in a box.
//!
//! The method is that of Cornuet, Marin, Mira and Robert (2012): the first round covers the box by a Latin
//! hypercube, and each further round samples around likely points. The weight of a sample is its likelihood
//! divided by the mixture density of the proposals of all rounds. The samples of all rounds are used. The
//! weights are correct even if the likelihood is itself random, as for one simulated course of a chaotic
//! collapse: the randomness acts as one more coordinate, sampled from its own distribution. The method is
//! implemented here because samplers on crates.io require gradients, or chains of thousands of steps that
//! cannot run in parallel.

use barrelstack_dynamics::math;
use barrelstack_motion::Random;

/// Fraction of all samples that belong to the first round.
const FIRST: f64 = 0.3;

/// Number of rounds after the first.
const ROUNDS: usize = 5;

/// Fraction of the samples of a later round that are still drawn uniformly from the whole box. These samples bound the
/// weights.
const WIDE: f64 = 0.2;

/// Minimum effective sample size, both for a proposal and for the result. If the effective sample size is smaller, the
/// likelihood is raised to a power below one.
const FEWEST: f64 = 40.0;

/// One sample: a point of the box `[−1, 1]ⁿ`, and the seed of the random numbers of its simulation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Draw {
    pub(crate) point: Vec<f64>,
    pub(crate) seed: u64,
}

/// Samples with their weights, which sum to one.
#[derive(Clone, Debug)]
pub(crate) struct Posterior {
    pub(crate) draws: Vec<Draw>,
    pub(crate) weights: Vec<f64>,
    /// Power to which the likelihood was raised to reach the minimum effective sample size; usually
    /// one. If the power is below one, intervals are wider than they would be with enough samples.
    pub(crate) power: f64,
}

/// Proposal distribution of a round: normal kernels around centers, each coordinate reflected at the bounds of
/// the box.
struct Proposal {
    count: usize,
    centers: Vec<Vec<f64>>,
    /// Cumulative weights of the centers.
    cumulated: Vec<f64>,
    weights: Vec<f64>,
    width: Vec<f64>,
}

/// Draws about `count` samples of a posterior distribution. The prior is uniform in the box.
///
/// `evaluate` returns the log-likelihood of each sample of a batch, `−∞` for a likelihood of zero.
/// Returns `None` if every sample has a likelihood of zero.
pub(super) fn sample(
    dimensions: usize,
    count: usize,
    seed: u64,
    mut evaluate: impl FnMut(&[Draw]) -> Vec<f64>,
) -> Option<Posterior> {
    let mut random = Random::new(seed);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a count"
    )]
    let first = ((FIRST * count as f64) as usize).max(1);
    let each = count.saturating_sub(first).div_ceil(ROUNDS);
    let mut draws = numbered(hypercube(first, dimensions, &mut random), 0, seed);
    let mut logs = evaluate(&draws);
    let mut proposals: Vec<Proposal> = Vec::new();
    for _ in 0..ROUNDS {
        if each == 0 {
            break;
        }
        let densities = densities(&draws, first, &proposals);
        let (weights, _) = flattened(&logs, &densities)?;
        let proposal = Proposal::around(&draws, weights, each, dimensions);
        let points = (0..each).map(|_| proposal.draw(dimensions, &mut random)).collect();
        let round = numbered(points, draws.len(), seed);
        logs.extend(evaluate(&round));
        draws.extend(round);
        proposals.push(proposal);
    }
    let densities = densities(&draws, first, &proposals);
    let (weights, power) = flattened(&logs, &densities)?;
    Some(Posterior { draws, weights, power })
}

/// Assigns a seed to each point from its index; the first point has the index `from`.
fn numbered(points: Vec<Vec<f64>>, from: usize, seed: u64) -> Vec<Draw> {
    let seeded = |(at, point)| Draw {
        point,
        seed: Random::new(seed.rotate_left(32) ^ (from + at) as u64).bits(),
    };
    points.into_iter().enumerate().map(seeded).collect()
}

/// Returns a Latin hypercube sample: every coordinate axis is divided into `count` equal parts, and each part
/// contains one point.
pub(crate) fn hypercube(count: usize, dimensions: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; dimensions]; count];
    for at in 0..dimensions {
        let mut parts: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            #[expect(clippy::cast_possible_truncation, reason = "a remainder below a count")]
            parts.swap(last, (random.bits() % (last as u64 + 1)) as usize);
        }
        for (point, part) in points.iter_mut().zip(parts) {
            point[at] = 2.0 * (part as f64 + random.uniform()) / count as f64 - 1.0;
        }
    }
    points
}

/// Returns the density of the mixture of all rounds at every sample, relative to the uniform density of the
/// box.
fn densities(draws: &[Draw], first: usize, proposals: &[Proposal]) -> Vec<f64> {
    let total = draws.len() as f64;
    let density = |draw: &Draw| {
        let later = proposals.iter().map(|p| p.count as f64 * p.density(&draw.point));
        (first as f64 + later.sum::<f64>()) / total
    };
    draws.iter().map(density).collect()
}

/// Returns the weights of samples, which sum to one, with the likelihood raised to a power. `None` if every likelihood
/// is zero.
fn weights(logs: &[f64], densities: &[f64], power: f64) -> Option<Vec<f64>> {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most == f64::NEG_INFINITY {
        return None;
    }
    let weight = |(log, density): (&f64, &f64)| {
        // Zero likelihood stays zero, even to the power zero.
        if *log == f64::NEG_INFINITY { 0.0 } else { math::exp(power * (log - most)) / density }
    };
    let weights: Vec<f64> = logs.iter().zip(densities).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    Some(weights.into_iter().map(|weight| weight / sum).collect())
}

/// Returns the weights with the likelihood raised to a power, and this power. It is the largest power, at most one,
/// for which the effective sample size is large enough. `None` if every likelihood is zero.
fn flattened(logs: &[f64], densities: &[f64]) -> Option<(Vec<f64>, f64)> {
    let whole = weights(logs, densities, 1.0)?;
    if effective(&whole) >= FEWEST {
        return Some((whole, 1.0));
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        let enough = effective(&weights(logs, densities, middle)?) >= FEWEST;
        if enough { low = middle } else { high = middle }
    }
    Some((weights(logs, densities, low)?, low))
}

/// Returns the effective sample size by Kish's formula.
fn effective(weights: &[f64]) -> f64 {
    1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>()
}

impl Proposal {
    fn around(draws: &[Draw], weights: Vec<f64>, count: usize, dimensions: usize) -> Self {
        let n = dimensions as f64;
        // Silverman's rule for the bandwidth.
        let rule = math::pow(4.0 / (n + 2.0) / effective(&weights), 1.0 / (n + 4.0));
        let spread = |at: usize| {
            let mean = |of: fn(f64) -> f64| {
                let terms = draws.iter().zip(&weights);
                terms.map(|(draw, weight)| weight * of(draw.point[at])).sum::<f64>()
            };
            let middle = mean(|x| x);
            (mean(|x| x * x) - middle * middle).max(1e-6).sqrt()
        };
        let width = (0..dimensions).map(|at| rule * spread(at)).collect();
        let mut sum = 0.0;
        let (mut centers, mut kept, mut cumulated) = (Vec::new(), Vec::new(), Vec::new());
        for (draw, weight) in draws.iter().zip(weights) {
            // Centers of negligible weight are omitted.
            if weight > 1e-9 {
                sum += weight;
                centers.push(draw.point.clone());
                kept.push(weight);
                cumulated.push(sum);
            }
        }
        Self { count, centers, cumulated, weights: kept, width }
    }

    fn draw(&self, dimensions: usize, random: &mut Random) -> Vec<f64> {
        if random.uniform() < WIDE {
            return (0..dimensions).map(|_| 2.0 * random.uniform() - 1.0).collect();
        }
        let total = self.cumulated.last().copied().unwrap_or(1.0);
        let aim = total * random.uniform();
        let at = self.cumulated.partition_point(|sum| *sum < aim).min(self.centers.len() - 1);
        let moved = |(center, width): (&f64, &f64)| mirrored(center + width * random.normal());
        self.centers[at].iter().zip(&self.width).map(moved).collect()
    }

    /// Returns the density of the proposal at a point, relative to the uniform density of the box.
    fn density(&self, point: &[f64]) -> f64 {
        let total = self.cumulated.last().copied().unwrap_or(1.0);
        let kernel = |center: &Vec<f64>| -> f64 {
            let coordinates = point.iter().zip(center).zip(&self.width);
            coordinates
                .map(|((x, center), width)| 2.0 * mirrored_normal(*x, *center, *width))
                .product()
        };
        let sum: f64 = self.centers.iter().zip(&self.weights).map(|(c, w)| w * kernel(c)).sum();
        WIDE + (1.0 - WIDE) * sum / total
    }
}

/// Reflects a coordinate into the interval from −1 to 1.
fn mirrored(mut x: f64) -> f64 {
    // A kernel is narrower than the box, so a few reflections suffice.
    for _ in 0..16 {
        if x > 1.0 {
            x = 2.0 - x;
        } else if x < -1.0 {
            x = -2.0 - x;
        } else {
            return x;
        }
    }
    x.clamp(-1.0, 1.0)
}

/// Returns the probability density of a normal deviate that is reflected into the interval from −1 to 1.
fn mirrored_normal(x: f64, center: f64, width: f64) -> f64 {
    let normal = |x: f64| {
        let off = (x - center) / width;
        math::exp(-0.5 * off * off) / (width * (2.0 * std::f64::consts::PI).sqrt())
    };
    // The kernel and its reflections; those further out are negligible.
    normal(x) + normal(2.0 - x) + normal(-2.0 - x) + normal(4.0 + x) + normal(x - 4.0)
}

impl Posterior {
    /// Creates the posterior of samples that were drawn from the prior. Returns `None` if every sample has a likelihood
    /// of zero.
    pub(crate) fn of(draws: Vec<Draw>, logs: &[f64]) -> Option<Self> {
        let (weights, power) = flattened(logs, &vec![1.0; draws.len()])?;
        Some(Self { draws, weights, power })
    }

    /// Returns the effective sample size.
    pub(crate) fn effective(&self) -> f64 {
        effective(&self.weights)
    }

    /// Returns a quantile of a coordinate.
    pub(crate) fn quantile(&self, at: usize, share: f64) -> f64 {
        let mut values: Vec<(f64, f64)> =
            self.draws.iter().zip(&self.weights).map(|(d, w)| (d.point[at], *w)).collect();
        values.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut sum = 0.0;
        for (value, weight) in &values {
            sum += weight;
            if sum >= share {
                return *value;
            }
        }
        values.last().map_or(0.0, |(value, _)| *value)
    }

    /// Returns the covariance matrix of the coordinates.
    pub(crate) fn covariance(&self) -> Vec<Vec<f64>> {
        let count = self.draws.first().map_or(0, |draw| draw.point.len());
        let mean = |of: &dyn Fn(&Draw) -> f64| -> f64 {
            self.draws.iter().zip(&self.weights).map(|(draw, weight)| weight * of(draw)).sum()
        };
        let means: Vec<f64> = (0..count).map(|at| mean(&|draw| draw.point[at])).collect();
        let entry = |i: usize, j: usize| {
            mean(&|draw| (draw.point[i] - means[i]) * (draw.point[j] - means[j]))
        };
        (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Draw, mirrored_normal, sample};

    #[test]
    fn a_mirrored_kernel_loses_nothing_at_the_walls() {
        for center in [-1.0, -0.7, 0.1, 0.95] {
            let parts = 4000;
            let sum: f64 = (0..parts)
                .map(|i| {
                    mirrored_normal(
                        2.0 * (f64::from(i) + 0.5) / f64::from(parts) - 1.0,
                        center,
                        0.4,
                    )
                })
                .sum();
            let area = sum * 2.0 / f64::from(parts);
            assert!((area - 1.0).abs() < 1e-4, "{center}: {area}"); // measured 1.6e-6
        }
    }

    #[test]
    fn a_narrow_slanted_normal_is_found() {
        // x ~ N(0.3, 0.05), y given x ~ N(-x, 0.1): moments known in closed form.
        let log =
            |x: f64, y: f64| -0.5 * ((x - 0.3) / 0.05).powi(2) - 0.5 * ((y + x) / 0.1).powi(2);
        let found = sample(2, 2000, 3, |draws| {
            draws.iter().map(|draw| log(draw.point[0], draw.point[1])).collect()
        })
        .unwrap();
        let covariance = found.covariance();
        assert!(found.effective() > 500.0, "{}", found.effective());
        assert!((found.quantile(0, 0.5) - 0.3).abs() < 0.01);
        assert!((found.quantile(1, 0.5) + 0.3).abs() < 0.02);
        assert!((covariance[0][0].sqrt() - 0.05).abs() < 0.005, "{covariance:?}");
        let slant = covariance[0][1] / (covariance[0][0] * covariance[1][1]).sqrt();
        assert!((slant + 1.0 / 5.0_f64.sqrt()).abs() < 0.06, "{slant}");
    }

    #[test]
    fn a_likelihood_that_says_nothing_leaves_the_box() {
        let found = sample(1, 400, 1, |draws| vec![0.0; draws.len()]).unwrap();
        assert!((found.quantile(0, 0.025) + 0.95).abs() < 0.04);
        assert!((found.quantile(0, 0.975) - 0.95).abs() < 0.04);
        assert!(sample(1, 50, 1, |draws| vec![f64::NEG_INFINITY; draws.len()]).is_none());
    }

    #[test]
    fn too_few_draws_flatten_the_likelihood_and_what_cannot_be_weighs_nothing() {
        // Fifteen samples in the first round, fewer than a result needs, half of them impossible.
        let possible = |x: f64| if x < 0.0 { 0.0 } else { f64::NEG_INFINITY };
        let found = sample(1, 50, 1, |draws| draws.iter().map(|d| possible(d.point[0])).collect());
        let found = found.unwrap();
        assert!((0.0..1.0).contains(&found.power), "{}", found.power);
        let sum: f64 = found.weights.iter().sum();
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        let impossible = |(draw, _): &(&Draw, &f64)| draw.point[0] >= 0.0;
        let mut weights = found.draws.iter().zip(&found.weights).filter(impossible);
        assert!(weights.all(|(_, weight)| *weight == 0.0));
        assert!(sample(1, 0, 1, |draws| vec![0.0; draws.len()]).is_some());
    }
}
