//! Distribution of the largest rotations under an ensemble of records, compared with the distribution computed by the
//! rigid-block integrator.
//!
//! Individual rocking histories are too sensitive for a comparison, but the distribution of their maxima can be
//! compared.

use std::f64::consts::TAU;

use barrelstack_dynamics::math::{cos, exp};

use crate::drive::Sampled;
use crate::oracle::Rocker;
use crate::problem::{absolute, setting};
use crate::rocking::RockingBlock;
use crate::tumble::Random;
use crate::{Effort, Failure, GRAVITY, Outcome, Problem, theory};

use super::housner::firm;

const SOURCE: &str = "ensembles of maxima, as in Bachmann et al. 2018";
const ALPHA: f64 = 0.25;
const RADIUS: f64 = 1.0;

/// Sampling interval (s) of the records.
const SAMPLE: f64 = 0.01;

/// Returns a synthetic record: the sum of 24 sine waves between 0.4 Hz and 6 Hz with random phases, multiplied by an
/// envelope.
///
/// Its peak is between 0.26 g and 0.5 g, so that fewer than half of the records overturn the block.
fn record(seed: u64) -> Sampled {
    let mut random = Random(seed);
    let peak = random.within(0.26, 0.5) * GRAVITY;
    let waves: Vec<(f64, f64)> = (0..24)
        .map(|i| {
            let from = 0.4 * 15.0_f64.powf(f64::from(i) / 24.0);
            let frequency = from * 15.0_f64.powf(random.within(0.0, 1.0 / 24.0));
            (TAU * frequency, random.within(0.0, TAU))
        })
        .collect();
    let shape: Vec<f64> = (0..=1000)
        .map(|i| {
            let t = f64::from(i) * SAMPLE;
            let envelope = (t / 2.0).min(1.0).powi(2) * exp(-0.35 * (t - 4.0).max(0.0));
            // Low frequencies dominate, as in ground acceleration above its corner frequency.
            let sum: f64 = waves.iter().map(|(w, p)| cos(w * t + p) / (1.0 + w / 15.0)).sum();
            let end = ((10.0 - t) / 0.5).clamp(0.0, 1.0);
            envelope * sum * end
        })
        .collect();
    let largest = shape.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    Sampled::new(SAMPLE, shape.iter().map(|a| a * peak / largest).collect())
}

/// Returns, for every record, the peak rotation divided by α, as computed by the contact code and by the rigid-block
/// integrator.
///
/// The value is 2 if the block overturned.
fn maxima(effort: Effort) -> Result<(Vec<f64>, Vec<f64>), Failure> {
    let block: RockingBlock = firm(effort, RADIUS, ALPHA);
    let rigid: Rocker = block.rigid(theory::housner_restitution(ALPHA));
    let count = if effort == Effort::Full { 200 } else { 10 };
    let (mut ours, mut exact) = (vec![], vec![]);
    for seed in 1..=count {
        let record = record(seed);
        let ride = block.ride(&record, record.duration(), 8.0)?;
        ours.push(if ride.overturned { 2.0 } else { ride.peak / ALPHA });
        let ride = rigid.ride(|t| record.acceleration(t), record.duration(), 5e-4, 8.0);
        exact.push(if ride.overturned { 2.0 } else { ride.peak / ALPHA });
    }
    Ok((ours, exact))
}

/// Returns the largest vertical distance between two empirical distribution functions with equal numbers of samples.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let share =
        |of: &[f64], at: f64| of.iter().filter(|x| **x <= at).count() as f64 / of.len() as f64;
    a.iter().chain(b).map(|at| (share(a, *at) - share(b, *at)).abs()).fold(0.0, f64::max)
}

fn median(of: &[f64]) -> f64 {
    let mut sorted = of.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    0.5 * (sorted[half] + sorted[(sorted.len() - 1) / 2])
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        setting(
            "statistics/maxima",
            "block of α = 0.25, R = 1 m under 200 synthetic records (10 in the fast form)",
            SOURCE,
        )
        // Two samples of 200 from the same distribution differ by at least this much in one case of twenty.
        .quantity(
            "Kolmogorov–Smirnov distance between the maxima and those of the rigid block",
            "",
            absolute(0.0, 0.136).fast(0.3),
        )
        .by(|effort| {
            let (ours, exact) = maxima(effort)?;
            let fell = |of: &[f64]| of.iter().filter(|x| **x > 1.9).count();
            let alike = ours
                .iter()
                .zip(&exact)
                .filter(|(a, b)| (*a - *b).abs() < 0.02 * b.max(0.05))
                .count();
            Ok(Outcome::of(distance(&ours, &exact)).noted(format!(
                "overturned {} and {}, medians {:.3} and {:.3}, {alike} of {} records within 2 %",
                fell(&ours),
                fell(&exact),
                median(&ours),
                median(&exact),
                ours.len()
            )))
        }),
    ]
}
