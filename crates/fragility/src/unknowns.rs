//! Regression of the share of failures on constants of the structure that have not been measured, such as friction
//! coefficients.

use crate::math::{exp, ln, normal, normal_quantile, quantile};
use crate::proportion::Interval;
use crate::sobol;

/// Minimum number of runs to which a [`Conditional`] share is fitted.
pub const FEWEST_RUNS: usize = 16;

/// Number of draws of the constants over which a share is averaged.
const AVERAGED: usize = 32;

/// Stride through the kept samples: [`Conditional::difference`] and [`Conditional::at`] use every sixth sample.
const THINNED: usize = 6;

/// Number of discarded (burn-in) samples and number of kept samples of the posterior distribution.
const SAMPLES: [usize; 2] = [400, 3000];

/// Degrees of freedom of Student's t distribution, which is the prior distribution of the coefficients `g`, `aⱼ`,
/// `cᵢⱼ` and `bₓ`. Its heavy tail permits a single constant to decide the result.
const FREEDOM: f64 = 3.0;

/// Scale of the prior distribution of the coefficients `g` (the two halves of the runs) and `aⱼ` (the constants).
///
/// A typical constant has a coefficient as large as the scale. With a scale of 0.6, the share then increases from 17 to
/// 83 % when this constant increases from 1.6 standard deviations below its median to 1.6 above it, while all other
/// terms are 0.
const PRIOR: f64 = 0.6;

/// Scale of the prior distribution of `cᵢⱼ`, the coefficients of the squares and products of the constants.
const PRIOR_SECOND: f64 = 0.2;

/// Scale of the prior distribution of `σ`, the standard deviation of the coefficients of the motions.
const PRIOR_GROUPS: f64 = 0.6;

/// Standard deviation of the normal prior distribution of `b₁`, the coefficient of the logarithm of the intensity.
const PRIOR_SLOPE: f64 = 4.0;

/// Scale of the prior distribution of `bₓ`, the departure of the share at a single intensity from the lognormal curve.
const PRIOR_LEVELS: f64 = 0.3;

/// Index of the constant term `b` of the regression in a sample of [`Conditional`].
const MIDDLE: usize = 1;

/// Standard deviation of the normal prior distribution of the constant term, which is `b` in [`Conditional`] and `b₀`
/// in [`Intensities`]. The mean of this distribution is 0.
const PRIOR_MIDDLE: f64 = 2.5;

/// A run with randomly drawn constants.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnRun {
    /// Values of the unknown constants, as standard normal deviates.
    pub deviates: Vec<f64>,
    /// `true` if the run belongs to the second half of the runs. The halves may differ on purpose, for example if the
    /// horizontal components of the motion are exchanged in the second half.
    pub second_half: bool,
    /// `true` if the structure failed in the run.
    pub failed: bool,
}

/// Share of failures for given constants. The uncertainty due to a finite number of runs is represented by
/// samples of the posterior distribution of a probit regression.
///
/// ```text
/// share(z) = ½ [Φ(η(z) + g) + Φ(η(z) − g)]
/// η(z)     = b + Σ aⱼ zⱼ + Σ cᵢⱼ (zᵢ zⱼ − δᵢⱼ),  i ≤ j
/// ```
///
/// `z` holds the constants as standard normal deviates, and `±g` distinguishes the two halves of the runs. Squares and
/// products are needed, as a test with a stack of three levels and 24 sets of true constants shows. Without them, the
/// computed range contained the true share of 10 of the 24 sets. With them, it contains the true share of 19 sets, and
/// of all 24 if the sampling error of the true shares is allowed for (`validation/statistics.md`). The posterior
/// distribution is sampled by the method of Albert and Chib (1993).
#[derive(Clone, Debug)]
pub struct Conditional {
    /// For each sample, the coefficients `g`, `b`, `aⱼ` and `cᵢⱼ`.
    samples: Vec<Vec<f64>>,
    /// For each sample, the values of the constants that are drawn with it, as standard normal deviates.
    points: Vec<Vec<f64>>,
    /// Correlation matrix of the deviates.
    correlations: Vec<Vec<f64>>,
}

/// Influence of one constant on the share of failures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// Total Sobol' index: the part of the variance of the share that remains if all other constants are known, as a
    /// fraction of the whole variance. It includes the interactions of this constant with the others.
    pub total: f64,
    /// Width of the credible interval of the share if this constant is known exactly and all other constants are
    /// unknown. The width depends on the value of this constant; this field is the mean of the width over these
    /// values.
    pub width_if_known: f64,
}

/// Fits the share of failures as a function of the unknown constants. Returns `None` if there are fewer than
/// [`FEWEST_RUNS`] runs, if there are no constants, or if runs differ in the number of their constants.
///
/// `uniform` returns random numbers between 0 (inclusive) and 1 (exclusive).
pub fn conditional(runs: &[DrawnRun], mut uniform: impl FnMut() -> f64) -> Option<Conditional> {
    // The value is never 0, so that its logarithm is finite.
    let mut uniform = || 1.0 - uniform();
    let unknowns = runs.first()?.deviates.len();
    if runs.len() < FEWEST_RUNS
        || unknowns == 0
        || runs.iter().any(|run| run.deviates.len() != unknowns)
    {
        return None;
    }
    let halves = runs.iter().any(|run| run.second_half != runs[0].second_half);
    let side = |run: &DrawnRun| match (halves, run.second_half) {
        (false, _) => 0.0,
        (true, false) => -1.0,
        (true, true) => 1.0,
    };
    let rows: Vec<Vec<f64>> = runs
        .iter()
        .map(|run| std::iter::once(side(run)).chain(terms(&run.deviates)).collect())
        .collect();
    let failed: Vec<bool> = runs.iter().map(|run| run.failed).collect();
    let mut priors = vec![Prior::Student(PRIOR), Prior::Normal(PRIOR_MIDDLE)];
    priors.extend(priors_of_constants(unknowns));
    let samples = posterior(&rows, &failed, &priors, &mut uniform);
    Some(Conditional::new(samples, independent(unknowns)))
}

/// Returns the correlation matrix of independent constants, which is the identity matrix.
fn independent(unknowns: usize) -> Vec<Vec<f64>> {
    let row = |i| (0..unknowns).map(|j| f64::from(u8::from(i == j))).collect();
    (0..unknowns).map(row).collect()
}

/// Prior distribution of a coefficient, with mean 0.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Prior {
    /// Normal distribution with this standard deviation.
    Normal(f64),
    /// Student's t distribution with [`FREEDOM`] degrees of freedom and this scale.
    Student(f64),
    /// Normal distribution whose standard deviation is common to all coefficients with this prior distribution. The
    /// standard deviation is sampled together with the coefficients; [`PRIOR_GROUPS`] is the scale of its own prior
    /// distribution.
    Group,
}

/// Returns the prior distributions of `aⱼ` and `cᵢⱼ`.
fn priors_of_constants(unknowns: usize) -> impl Iterator<Item = Prior> {
    let second = unknowns * (unknowns + 1) / 2;
    let first = std::iter::repeat_n(Prior::Student(PRIOR), unknowns);
    first.chain(std::iter::repeat_n(Prior::Student(PRIOR_SECOND), second))
}

/// Draws samples of the coefficients of a probit regression from their posterior distribution. Coefficients with the
/// prior distribution [`Prior::Group`] are not part of a sample; if there are any, the last value of the sample is
/// their common standard deviation.
fn posterior(
    rows: &[Vec<f64>],
    failed: &[bool],
    priors: &[Prior],
    uniform: &mut impl FnMut() -> f64,
) -> Vec<Vec<f64>> {
    let size = priors.len();
    let mut squares = vec![vec![0.0; size]; size];
    for row in rows {
        for (i, line) in squares.iter_mut().enumerate().filter(|(i, _)| row[*i] != 0.0) {
            for (j, cell) in line.iter_mut().enumerate() {
                *cell += row[i] * row[j];
            }
        }
    }
    let groups = priors.iter().filter(|prior| **prior == Prior::Group).count();
    let own = size - groups;
    let mut of_groups = PRIOR_GROUPS * PRIOR_GROUPS;
    let mut coefficients = vec![0.0; size];
    let mut samples = Vec::with_capacity(SAMPLES[1]);
    for step in 0..SAMPLES[0] + SAMPLES[1] {
        let mut sums = vec![0.0; size];
        for (row, failed) in rows.iter().zip(failed) {
            let middle = dot(&coefficients, row);
            let latent = if *failed {
                middle + above(-middle, uniform)
            } else {
                middle - above(middle, uniform)
            };
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += value * latent;
            }
        }
        let mut precision = squares.clone();
        for (i, line) in precision.iter_mut().enumerate() {
            let variance = match priors[i] {
                Prior::Normal(deviation) => deviation * deviation,
                Prior::Student(scale) => {
                    let rate = 0.5 * (FREEDOM * scale * scale + coefficients[i] * coefficients[i]);
                    // The sum of two exponential deviates has the gamma distribution of shape 2 = (3 + 1) / 2.
                    rate / -(ln(uniform()) + ln(uniform()))
                }
                Prior::Group => of_groups,
            };
            line[i] += 1.0 / variance;
        }
        coefficients = sampled(precision, &sums, uniform);
        if groups > 0 {
            let squared: f64 = coefficients[own..].iter().map(|value| value * value).sum();
            let scaled = FREEDOM * PRIOR_GROUPS * PRIOR_GROUPS + squared;
            // The variance has a scaled inverse χ² distribution. Its degrees of freedom are the number of groups plus
            // the three of the prior distribution.
            let chi: f64 = (0..groups + 3).map(|_| deviate(uniform)).map(|z| z * z).sum();
            of_groups = scaled / chi;
        }
        if step >= SAMPLES[0] {
            let mut sample = coefficients[..own].to_vec();
            sample.extend((groups > 0).then(|| of_groups.sqrt()));
            samples.push(sample);
        }
    }
    samples
}

/// A run with randomly drawn constants, under one of several motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaken {
    /// Values of the unknown constants, as standard normal deviates.
    pub deviates: Vec<f64>,
    /// Number that identifies the motion. The outcomes of runs under the same motion are correlated, whatever the
    /// constants are.
    pub motion: usize,
    /// Intensity of the motion (> 0).
    pub intensity: f64,
    /// `true` if the structure failed in the run.
    pub failed: bool,
}

/// Assumption about how the share of failures depends on the intensity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// The share at each intensity may depart from a lognormal curve, so that it need not grow with the intensity.
    Levels,
    /// The share is a lognormal function of the intensity.
    Lognormal,
}

/// Share of failures as a function of intensity and constants, over all motions.
///
/// ```text
/// share(z, x) = Φ[(b(x) + Σ aⱼ zⱼ + Σ cᵢⱼ (zᵢ zⱼ − δᵢⱼ)) / √(1 + σ²)]
/// b(x)        = b₀ + b₁ ln(x/x₀) + bₓ
/// ```
///
/// `bₓ` is the departure of the share at the intensity `x` from the lognormal curve; it is 0 for [`Shape::Lognormal`].
/// In the regression, the runs under one motion have a common coefficient, so that they do not count as independent.
/// `σ` is the standard deviation of these coefficients. The effects of the constants are the same at all intensities.
/// The method is the same as in [`conditional`].
#[derive(Clone, Debug)]
pub struct Intensities {
    /// For each sample, the coefficients `b₀`, `b₁`, `bₓ` (one for each of `levels`), `aⱼ` and `cᵢⱼ`, and finally `σ`.
    samples: Vec<Vec<f64>>,
    /// Intensities at which the share may depart from the lognormal curve.
    levels: Vec<f64>,
    /// `x₀`: the geometric mean of the intensities of all runs.
    middle: f64,
    shape: Shape,
    /// Correlation matrix of the deviates.
    correlations: Vec<Vec<f64>>,
}

/// Fits the share of failures as a function of intensity and of the unknown constants. Returns `None` if there are
/// fewer than [`FEWEST_RUNS`] runs, if there are no constants, if runs differ in the number of their constants, or if
/// an intensity is not positive.
///
/// `uniform` returns random numbers between 0 (inclusive) and 1 (exclusive).
pub fn shaken(
    runs: &[Shaken],
    shape: Shape,
    mut uniform: impl FnMut() -> f64,
) -> Option<Intensities> {
    let mut uniform = || 1.0 - uniform();
    let unknowns = runs.first()?.deviates.len();
    if runs.len() < FEWEST_RUNS
        || unknowns == 0
        || runs.iter().any(|run| run.deviates.len() != unknowns || run.intensity <= 0.0)
    {
        return None;
    }
    let levels = match shape {
        Shape::Levels => sorted(runs.iter().map(|run| run.intensity)),
        Shape::Lognormal => Vec::new(),
    };
    let middle = exp(mean(runs.iter().map(|run| ln(run.intensity))));
    let mut motions: Vec<usize> = runs.iter().map(|run| run.motion).collect();
    motions.sort_unstable();
    motions.dedup();
    let row = |run: &Shaken| {
        let own = motions.iter().map(|motion| f64::from(u8::from(*motion == run.motion)));
        let known = known(&levels, middle, run.intensity);
        known.into_iter().chain(terms(&run.deviates).skip(1)).chain(own).collect()
    };
    let rows: Vec<Vec<f64>> = runs.iter().map(row).collect();
    let failed: Vec<bool> = runs.iter().map(|run| run.failed).collect();
    let mut priors = vec![Prior::Normal(PRIOR_MIDDLE), Prior::Normal(PRIOR_SLOPE)];
    priors.extend(levels.iter().map(|_| Prior::Student(PRIOR_LEVELS)));
    priors.extend(priors_of_constants(unknowns));
    priors.extend(motions.iter().map(|_| Prior::Group));
    let samples = posterior(&rows, &failed, &priors, &mut uniform);
    Some(Intensities { samples, levels, middle, shape, correlations: independent(unknowns) })
}

/// Returns the regressors of the coefficients of `b(x)`: 1 for `b₀`, `ln(x/x₀)` for `b₁`, and, for the `bₓ` of each
/// level, 1 at that level and 0 at all other intensities.
fn known(levels: &[f64], middle: f64, intensity: f64) -> Vec<f64> {
    let own = levels.iter().map(|level| f64::from(u8::from(*level == intensity)));
    [1.0, ln(intensity / middle)].into_iter().chain(own).collect()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

impl Intensities {
    /// Returns this share with the given correlation matrix of the deviates, like [`Conditional::correlated`].
    #[must_use]
    pub fn correlated(self, correlations: Vec<Vec<f64>>) -> Self {
        Self { correlations, ..self }
    }

    /// Returns the share of failures at an intensity as a function of the constants. Returns `None` for an intensity
    /// without runs, unless the share follows a lognormal curve.
    pub fn at(&self, intensity: f64) -> Option<Conditional> {
        if self.shape == Shape::Levels && !self.levels.contains(&intensity) {
            return None;
        }
        let terms = known(&self.levels, self.middle, intensity);
        let of = |sample: &Vec<f64>| {
            let (own, rest) = sample.split_at(terms.len());
            let (constants, deviation) = rest.split_at(rest.len() - 1);
            let scale = 1.0 / (1.0 + deviation[0] * deviation[0]).sqrt();
            let middle = dot(own, &terms);
            let factors = std::iter::once(&middle).chain(constants).map(|factor| scale * factor);
            std::iter::once(0.0).chain(factors).collect()
        };
        Some(Conditional::new(self.samples.iter().map(of).collect(), self.correlations.clone()))
    }

    /// Returns, for every draw of [`Conditional::shares`], the intensity between `low` and `high` at which the share of
    /// failures is `share`. The intensity is 0 if the share of failures exceeds `share` already at `low`, and `high` if
    /// the share of failures does not exceed `share` even at `high`. Returns `None` unless the share follows a
    /// lognormal curve.
    pub fn intensities(&self, share: f64, [low, high]: [f64; 2]) -> Option<Vec<f64>> {
        let [below, above] = [self.at(low)?.shares(), self.at(high)?.shares()];
        let quantile = normal_quantile(share);
        let between = |(below, above): (&f64, &f64)| {
            if *below > share {
                return 0.0;
            }
            if *above <= share {
                return high;
            }
            // The quantile of the share is linear in the logarithm of the intensity.
            let [from, to] = [*below, *above]
                .map(|share| normal_quantile(share.clamp(f64::MIN_POSITIVE, 1.0 - 1e-16)));
            let part = if to > from { (quantile - from) / (to - from) } else { 0.5 };
            low * exp(part.clamp(0.0, 1.0) * ln(high / low))
        };
        (self.shape == Shape::Lognormal).then(|| below.iter().zip(&above).map(between).collect())
    }
}

/// Returns the central interval that contains the fraction `level` of the draws.
pub fn interval_of(draws: &[f64], level: f64) -> Interval {
    let mut ascending = draws.to_vec();
    ascending.sort_by(f64::total_cmp);
    ends(&ascending, level)
}

/// Returns the share of draws in which the first quantity is less than the second. A draw in which they are equal
/// counts as one half.
pub fn share_less(first: &[f64], second: &[f64]) -> f64 {
    let less = |(a, b): (&f64, &f64)| match a.total_cmp(b) {
        std::cmp::Ordering::Less => 1.0,
        std::cmp::Ordering::Equal => 0.5,
        std::cmp::Ordering::Greater => 0.0,
    };
    mean(first.iter().zip(second).map(less))
}

impl Conditional {
    /// Creates the share from samples of its coefficients, and draws one set of values of the constants for each
    /// sample.
    ///
    /// A set depends only on the index of the sample and on the correlations. Two shares with the same correlations
    /// therefore have the same sets.
    fn new(samples: Vec<Vec<f64>>, correlations: Vec<Vec<f64>>) -> Self {
        let lower = cholesky(correlations.clone());
        let point = |point| {
            let own: Vec<f64> = (0..lower.len())
                .map(|axis| normal_quantile(sobol::padded(axis, point, 0)))
                .collect();
            lower.iter().map(|row| dot(row, &own)).collect()
        };
        let points = (0_u32..).zip(&samples).map(|(number, _)| point(number)).collect();
        Self { samples, points, correlations }
    }

    /// Returns this share with the given correlation matrix of the deviates. The matrix is positive definite and has
    /// ones on its diagonal. By default, the constants are independent of each other.
    #[must_use]
    pub fn correlated(self, correlations: Vec<Vec<f64>>) -> Self {
        Self::new(self.samples, correlations)
    }

    /// Returns the values of all constants in `point`, but with one constant set to `deviate`. If this shifts that
    /// constant by `Δ`, each other constant is shifted by `ρ Δ`, where `ρ` is the correlation of the two constants.
    fn fixed(&self, point: &[f64], unknown: usize, deviate: f64) -> Vec<f64> {
        let change = deviate - point[unknown];
        let moved = point.iter().zip(&self.correlations[unknown]);
        let mut fixed: Vec<f64> = moved.map(|(value, along)| value + along * change).collect();
        fixed[unknown] = deviate;
        fixed
    }

    /// Returns the share in every draw. A draw combines a sample of the posterior distribution with values of the
    /// constants. Two shares that have the same constants, in the same order and with the same correlations, use the
    /// same values in each draw.
    pub fn shares(&self) -> Vec<f64> {
        let draws = self.samples.iter().zip(&self.points);
        draws.map(|(sample, point)| share(sample, point)).collect()
    }

    /// Returns the share for given constants (as standard normal deviates), computed with one sample of the
    /// coefficients. The index of the sample is `number` modulo the number of samples.
    ///
    /// # Panics
    /// If there are fewer deviates than constants.
    pub fn in_sample(&self, number: usize, deviates: &[f64]) -> f64 {
        share(&self.samples[number % self.samples.len()], deviates)
    }

    /// Returns the credible interval that contains the share of failures with the probability `level`.
    ///
    /// The interval accounts for two uncertainties: the constants are drawn from their distributions, and the
    /// coefficients from their posterior distribution. The ends are rounded outward to hundredths.
    pub fn range(&self, level: f64) -> Interval {
        let Interval { low, high } = self.range_given(level, None);
        Interval { low: (100.0 * low).floor() / 100.0, high: (100.0 * high).ceil() / 100.0 }
    }

    /// Returns the posterior mean of the share with all constants at their medians.
    pub fn at_medians(&self) -> f64 {
        let none = vec![0.0; self.correlations.len()];
        mean(self.samples.iter().map(|sample| share(sample, &none)))
    }

    /// Returns the influence of every constant. `level` is the probability of the credible intervals whose widths are
    /// returned.
    pub fn influences(&self, level: f64) -> Vec<Influence> {
        let totals = self.totals();
        let of = |(unknown, total): (usize, f64)| {
            let width = |step: u32| {
                let deviate = normal_quantile((f64::from(step) + 0.5) / 9.0);
                let Interval { low, high } = self.range_given(level, Some((unknown, deviate)));
                high - low
            };
            Influence { total, width_if_known: mean((0..9).map(width)) }
        };
        totals.into_iter().enumerate().map(of).collect()
    }

    /// Returns the credible interval of a difference: the share with one constant at the second deviate, minus the
    /// share with that constant at the first deviate. All other constants are drawn from their distributions.
    pub fn difference(&self, unknown: usize, deviates: [f64; 2], level: f64) -> Interval {
        let [from, to] = deviates.map(|deviate| self.shares_at(unknown, deviate));
        let mut differences: Vec<f64> = to.iter().zip(&from).map(|(b, a)| b - a).collect();
        differences.sort_by(f64::total_cmp);
        ends(&differences, level)
    }

    /// Returns the mean share, and its credible interval, with one constant fixed at a given deviate and all other
    /// constants unknown.
    pub fn at(&self, unknown: usize, deviate: f64, level: f64) -> (f64, Interval) {
        let mut shares = self.shares_at(unknown, deviate);
        shares.sort_by(f64::total_cmp);
        (mean(shares.iter().copied()), ends(&shares, level))
    }

    /// Returns, for every [`THINNED`]th sample of the coefficients, the share with one constant at a deviate, averaged
    /// over all other constants.
    fn shares_at(&self, unknown: usize, deviate: f64) -> Vec<f64> {
        let points = self.points[..AVERAGED].iter();
        let points: Vec<_> = points.map(|point| self.fixed(point, unknown, deviate)).collect();
        let of = |sample: &Vec<f64>| mean(points.iter().map(|point| share(sample, point)));
        self.samples.iter().step_by(THINNED).map(of).collect()
    }

    fn range_given(&self, level: f64, known: Option<(usize, f64)>) -> Interval {
        let sampled = self.samples.iter().zip(&self.points);
        let mut shares: Vec<f64> = match known {
            None => self.shares(),
            Some((unknown, deviate)) => sampled
                .map(|(sample, point)| share(sample, &self.fixed(point, unknown, deviate)))
                .collect(),
        };
        shares.sort_by(f64::total_cmp);
        ends(&shares, level)
    }

    /// Returns the total Sobol' index of every constant for the posterior mean of the share (Jansen 1999).
    fn totals(&self) -> Vec<f64> {
        const POINTS: u32 = 128;
        let thinned = self.samples.len().div_ceil(64);
        let mean_share = |deviates: &[f64]| {
            mean(self.samples.iter().step_by(thinned).map(|sample| share(sample, deviates)))
        };
        let unknowns = self.correlations.len();
        let other = |unknown: usize, point: u32| {
            normal_quantile(sobol::padded(unknowns + unknown, point, 0))
        };
        let points = &self.points[..POINTS as usize];
        let shares: Vec<f64> = points.iter().map(|point| mean_share(point)).collect();
        let middle = mean(shares.iter().copied());
        let variance = mean(shares.iter().map(|share| (share - middle) * (share - middle)));
        let total = |unknown: usize| {
            // The constant is drawn anew while all others are known. It comes last in this order, so that the last row
            // of the Cholesky factor states how it depends on the others.
            let order: Vec<usize> =
                (0..unknowns).filter(|at| *at != unknown).chain([unknown]).collect();
            let row = |i: &usize| order.iter().map(|j| self.correlations[*i][*j]).collect();
            let lower = cholesky(order.iter().map(row).collect());
            let squares = (0..POINTS).zip(points).zip(&shares).map(|((point, deviates), share)| {
                let mut changed = deviates.clone();
                let known: Vec<f64> =
                    order[..unknowns - 1].iter().map(|at| deviates[*at]).collect();
                let last = &lower[unknowns - 1];
                changed[unknown] = dot(last, &forward(&lower, &known))
                    + last[unknowns - 1] * other(unknown, point);
                let change = mean_share(&changed) - share;
                0.5 * change * change
            });
            if variance > 0.0 { (mean(squares) / variance).min(1.0) } else { 0.0 }
        };
        (0..unknowns).map(total).collect()
    }
}

/// Returns the regressors of `b`, `aⱼ` and `cᵢⱼ`: 1, the deviates `zⱼ`, and `zᵢ zⱼ − δᵢⱼ` for `i ≤ j`.
fn terms(deviates: &[f64]) -> impl Iterator<Item = f64> {
    let second = move |i: usize| {
        let square = std::iter::once(deviates[i] * deviates[i] - 1.0);
        square.chain(deviates[i + 1..].iter().map(move |other| deviates[i] * other))
    };
    let first = std::iter::once(1.0).chain(deviates.iter().copied());
    first.chain((0..deviates.len()).flat_map(second))
}

fn share(sample: &[f64], deviates: &[f64]) -> f64 {
    let (side, rest) = (sample[0], &sample[MIDDLE..]);
    let middle: f64 = terms(deviates).zip(rest).map(|(term, factor)| term * factor).sum();
    if side == 0.0 {
        return normal(middle);
    }
    0.5 * (normal(middle + side) + normal(middle - side))
}

fn ends(ascending: &[f64], level: f64) -> Interval {
    let rest = 0.5 * (1.0 - level);
    Interval { low: quantile(ascending, rest), high: quantile(ascending, 1.0 - rest) }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn deviate(uniform: &mut impl FnMut() -> f64) -> f64 {
    // Box and Muller 1958.
    (-2.0 * ln(uniform())).sqrt() * libm::cos(std::f64::consts::TAU * uniform())
}

/// Draws a standard normal deviate that exceeds a bound (Robert 1995).
fn above(bound: f64, uniform: &mut impl FnMut() -> f64) -> f64 {
    if bound < 0.5 {
        loop {
            let value = deviate(uniform);
            if value > bound {
                return value;
            }
        }
    }
    let rate = 0.5 * (bound + (bound * bound + 4.0).sqrt());
    loop {
        let value = bound - ln(uniform()) / rate;
        if uniform() <= exp(-0.5 * (value - rate) * (value - rate)) {
            return value;
        }
    }
}

/// Draws from the normal distribution with the precision matrix `P` and the mean `P⁻¹ s`, by Cholesky
/// factorization of `P`.
fn sampled(precision: Vec<Vec<f64>>, sums: &[f64], uniform: &mut impl FnMut() -> f64) -> Vec<f64> {
    let size = sums.len();
    let lower = cholesky(precision);
    let mut forward = forward(&lower, sums);
    for value in &mut forward {
        *value += deviate(uniform);
    }
    let mut found = vec![0.0; size];
    for i in (0..size).rev() {
        let known: f64 = (i + 1..size).map(|k| lower[k][i] * found[k]).sum();
        found[i] = (forward[i] - known) / lower[i][i];
    }
    found
}

/// Returns the lower triangular matrix `L` with `L Lᵀ = M`, for a symmetric positive definite matrix `M`. The elements
/// of `L` above the diagonal are 0.
fn cholesky(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for j in 0..matrix.len() {
        for i in j..matrix.len() {
            let known: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - known;
            matrix[i][j] = if i == j { rest.sqrt() } else { rest / matrix[j][j] };
        }
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i + 1..].fill(0.0);
    }
    matrix
}

/// Solves `L x = s` for lower triangular `L`. If `s` is shorter than `L`, only the first rows of `L` are used.
fn forward(lower: &[Vec<f64>], sums: &[f64]) -> Vec<f64> {
    let mut found = Vec::with_capacity(sums.len());
    for (row, sum) in lower.iter().zip(sums) {
        let known = dot(row, &found);
        found.push((sum - known) / row[found.len()]);
    }
    found
}
