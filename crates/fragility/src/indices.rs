//! Variance-based sensitivity indices: the influence of each input by itself, and its influence including interactions
//! with other inputs.

use crate::math::{exp, student_quantile};
use crate::proportion::{Interval, unobserved};

/// Minimum number of blocks for which an interval is computed.
pub const FEWEST_BLOCKS: usize = 16;

/// Sensitivity indices of one input, with confidence intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// First-order index: the fraction of the variance that vanishes if the input is known (Sobol' 1993),
    /// clamped to the range from 0 to 1.
    pub first: f64,
    /// Confidence interval of the first-order index; 0 to 1 if there are fewer than [`FEWEST_BLOCKS`] blocks.
    pub first_interval: Interval,
    /// Total index: the fraction of the variance that remains if all other inputs are known, which includes
    /// interactions. It is clamped to the range from 0 to 1.
    pub total: f64,
    /// Confidence interval of the total index; 0 to 1 if there are fewer than [`FEWEST_BLOCKS`] blocks.
    pub total_interval: Interval,
}

/// Computes the first-order and the total index of every input from blocks of results
/// `[f(A), f(B), f(A₁B), f(A₂B), …]`.
///
/// In each block, `A` and `B` are two samples of all inputs, and `AᵢB` is `A` with input `i` replaced by input `i` of
/// `B`.
///
/// ```text
/// first  = mean(f(B) (f(AᵢB) − f(A))) / V        Saltelli et al. 2010, table 2 (b)
/// total  = mean((f(A) − f(AᵢB))²) / 2V           Jansen 1999
/// ```
///
/// `V` is the variance of all `f(A)` and `f(B)`. All results are centered on the mean of all `f(A)` and `f(B)`.
/// Intervals come from the delete-one jackknife over blocks and from Student's t distribution, with the number of
/// blocks minus one as degrees of freedom. For the total index, the upper bound is also computed on the
/// logarithmic scale, and the larger of the two upper bounds is used.
///
/// If an input changes the result in at most half of the blocks, the largest changes may be too rare to occur in any
/// block. The intervals therefore allow for a small proportion of such blocks, given by [`unobserved`]. They are
/// extended to the indices that would result if the change in these blocks were as large as the range of the results.
/// Finally, the bounds are clamped to the range from 0 to 1.
///
/// In simulations with 16 to 256 blocks, the coverage is at least 89 % for binary results, counts and continuous
/// results (`tests/claims.rs`).
///
/// Returns `None` for fewer than two blocks, for blocks of different lengths, and for constant results.
pub fn sobol_indices(blocks: &[Vec<f64>], level: f64) -> Option<Vec<Index>> {
    let inputs = blocks.first()?.len().checked_sub(2).filter(|inputs| *inputs > 0)?;
    if blocks.len() < 2 || blocks.iter().any(|block| block.len() != inputs + 2) {
        return None;
    }
    let count = blocks.len();
    let middle = blocks.iter().map(|block| block[0] + block[1]).sum::<f64>() / (2.0 * count as f64);
    let mut sums = Sums::empty(inputs);
    for block in blocks {
        sums.add(block, middle, 1.0);
    }
    let (variance, indices) = (sums.variance(middle)?, sums.indices(middle)?);
    // For each index, the sum over all blocks of the squared change of the index if the block is left out. `None` if
    // the results without a block are constant.
    let mut squares = Some(vec![[0.0; 2]; inputs]);
    for block in blocks {
        let mut others = sums.clone();
        others.add(block, middle, -1.0);
        let Some(without) = others.indices(middle) else {
            squares = None;
            break;
        };
        for (sum, (without, with)) in squares.iter_mut().flatten().zip(without.iter().zip(&indices))
        {
            for (sum, (without, with)) in sum.iter_mut().zip(without.iter().zip(with)) {
                *sum += (without - with) * (without - with);
            }
        }
    }
    let results = || blocks.iter().flatten();
    let range =
        results().copied().fold(f64::MIN, f64::max) - results().copied().fold(f64::MAX, f64::min);
    let (missed, reach) = (unobserved(count, level), student_quantile(level, count - 1));
    let interval = |input: usize, which: usize| {
        let whole = Interval { low: 0.0, high: 1.0 };
        let Some(squares) = squares.as_ref().filter(|_| count >= FEWEST_BLOCKS) else {
            return whole;
        };
        let here = indices[input][which];
        let error = (squares[input][which] * (count as f64 - 1.0) / count as f64).sqrt();
        let half = reach * error;
        let (mut low, mut high) = (here - half, here + half);
        if which == TOTAL && here > 0.0 {
            // The mean of squares over few blocks has a skewed distribution, so the upper bound is also computed on the
            // logarithmic scale.
            high = high.max(here * exp((half / here).min(50.0)));
        }
        let unchanged = blocks.iter().filter(|block| block[0] == block[2 + input]).count();
        if 2 * unchanged >= count {
            // Largest contribution of a block to an index, range²/(2 V). The contribution to the total index is a
            // squared change. The contribution to the first-order index is a change times a distance from the mean,
            // which is taken as half of the range.
            let most = range * range / (2.0 * variance);
            let (below, above) = if which == TOTAL { (0.0, most) } else { (-most, most) };
            low = low.min((1.0 - missed) * here + missed * below);
            high = high.max((1.0 - missed) * here + missed * above);
        }
        Interval { low: low.clamp(0.0, 1.0), high: high.clamp(0.0, 1.0) }
    };
    let index = |input: usize| Index {
        first: indices[input][FIRST].clamp(0.0, 1.0),
        first_interval: interval(input, FIRST),
        total: indices[input][TOTAL].clamp(0.0, 1.0),
        total_interval: interval(input, TOTAL),
    };
    Some((0..inputs).map(index).collect())
}

/// Position of the first-order index in a pair of indices.
const FIRST: usize = 0;

/// Position of the total index in a pair of indices.
const TOTAL: usize = 1;

/// Sums of centered results over blocks. A block can also be removed from the sums.
#[derive(Clone)]
struct Sums {
    count: f64,
    /// Sum of all `f(A)` and `f(B)`.
    results: f64,
    /// Sum of the squares of all `f(A)` and `f(B)`.
    squares: f64,
    /// For every input, three sums: of the change `f(AᵢB) − f(A)`, of the product of this change and `f(B)`, and of the
    /// square of this change.
    inputs: Vec<[f64; 3]>,
}

impl Sums {
    /// Creates the sums over an empty set of blocks; all sums are zero.
    fn empty(inputs: usize) -> Self {
        Self { count: 0.0, results: 0.0, squares: 0.0, inputs: vec![[0.0; 3]; inputs] }
    }

    /// Subtracts `middle` from the results of a block, and adds the block to the sums (`sign` 1) or removes it from
    /// them (`sign` −1).
    fn add(&mut self, block: &[f64], middle: f64, sign: f64) {
        let (a, b) = (block[0] - middle, block[1] - middle);
        self.count += sign;
        self.results += sign * (a + b);
        self.squares += sign * (a * a + b * b);
        for (sums, exchanged) in self.inputs.iter_mut().zip(&block[2..]) {
            let change = exchanged - block[0];
            sums[0] += sign * change;
            sums[1] += sign * change * b;
            sums[2] += sign * change * change;
        }
    }

    /// Returns the variance of the results; `None` if the variance is so small that it may consist of rounding errors
    /// only.
    fn variance(&self, middle: f64) -> Option<f64> {
        let mean = self.results / (2.0 * self.count);
        let variance = (self.squares - mean * self.results) / (2.0 * self.count - 1.0);
        let rounding = 1e-24 * middle * middle + 1e-15 * self.squares / self.count;
        (variance > rounding && variance > 0.0).then_some(variance)
    }

    /// Returns the first-order and the total index of every input; `None` for constant results.
    fn indices(&self, middle: f64) -> Option<Vec<[f64; 2]>> {
        let (variance, n) = (self.variance(middle)?, self.count);
        let mean = self.results / (2.0 * n);
        let of = |[change, product, square]: &[f64; 3]| {
            [(product - mean * change) / (n * variance), square / (2.0 * n * variance)]
        };
        Some(self.inputs.iter().map(of).collect())
    }
}
