//! Variance-based sensitivity: which input moves a result, alone and together with others.

use crate::math::quantile;
use crate::proportion::Interval;

/// What one input does to the variance of a result, with intervals by resampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// The share of the variance that goes when the input is known (Sobol' 1993).
    pub first: f64,
    /// Its interval.
    pub first_interval: Interval,
    /// The share that stays when everything but the input is known: what it does alone and in company.
    pub total: f64,
    /// Its interval.
    pub total_interval: Interval,
}

/// First and total indices of every input from blocks `[f(A), f(B), f(A with input 1 of B), …]`.
///
/// ```text
/// first  = mean(f(B) (f(AᵢB) − f(A))) / V        Saltelli et al. 2010, table 2 (b)
/// total  = mean((f(A) − f(AᵢB))²) / 2V           Jansen 1999
/// ```
///
/// `V` is the variance over all `f(A)` and `f(B)`, and results are taken about their mean. Intervals are
/// percentiles of `replicates` resamples of whole blocks. `None` for fewer than two blocks, blocks of
/// different length, and results that do not vary.
pub fn sobol_indices(
    blocks: &[Vec<f64>],
    replicates: usize,
    level: f64,
    mut uniform: impl FnMut() -> f64,
) -> Option<Vec<Index>> {
    let inputs = blocks.first()?.len().checked_sub(2).filter(|inputs| *inputs > 0)?;
    if blocks.len() < 2 || blocks.iter().any(|block| block.len() != inputs + 2) {
        return None;
    }
    let found = estimates(blocks, blocks.len(), |at| at)?;
    let mut drawn: Vec<Vec<(f64, f64)>> = vec![Vec::with_capacity(replicates); inputs];
    for _ in 0..replicates {
        let picked: Vec<usize> = blocks
            .iter()
            .map(|_| {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "below the count"
                )]
                let at = (uniform() * blocks.len() as f64) as usize;
                at.min(blocks.len() - 1)
            })
            .collect();
        // A resample in which nothing varies tells no shares.
        let Some(again) = estimates(blocks, blocks.len(), |at| picked[at]) else { continue };
        drawn.iter_mut().zip(again).for_each(|(of, pair)| of.push(pair));
    }
    let tail = 0.5 * (1.0 - level);
    let bounds = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let at = |share| if values.is_empty() { f64::NAN } else { quantile(&values, share) };
        Interval { low: at(tail), high: at(1.0 - tail) }
    };
    let index = |((first, total), drawn): ((f64, f64), Vec<(f64, f64)>)| Index {
        first,
        first_interval: bounds(drawn.iter().map(|pair| pair.0).collect()),
        total,
        total_interval: bounds(drawn.iter().map(|pair| pair.1).collect()),
    };
    Some(found.into_iter().zip(drawn).map(index).collect())
}

/// First and total index of every input; none where the results do not vary.
fn estimates(
    blocks: &[Vec<f64>],
    count: usize,
    pick: impl Fn(usize) -> usize,
) -> Option<Vec<(f64, f64)>> {
    let each = || (0..count).map(|at| &blocks[pick(at)]);
    let n = count as f64;
    let mean = each().map(|block| block[0] + block[1]).sum::<f64>() / (2.0 * n);
    let square = |x: f64| x * x;
    let variance =
        each().map(|b| square(b[0] - mean) + square(b[1] - mean)).sum::<f64>() / (2.0 * n - 1.0);
    // A spread that rounding alone explains is none.
    if variance <= 1e-24 * mean * mean || variance == 0.0 {
        return None;
    }
    let of = |input: usize| {
        let first = each().map(|b| (b[1] - mean) * (b[2 + input] - b[0])).sum::<f64>() / n;
        let total = each().map(|b| square(b[0] - b[2 + input])).sum::<f64>() / (2.0 * n);
        (first / variance, total / variance)
    };
    Some((0..blocks[0].len() - 2).map(of).collect())
}
