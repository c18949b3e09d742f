//! Paired comparison of two runs, variant by variant.

use barrelstack_fragility::wilson;
use barrelstack_report::described;

use super::Side;
use crate::variants::LEVEL;

described! {
    /// Comparison of two runs in one plane or in three dimensions: each variant of the first run is compared with the
    /// same variant of the second run, under the same motion.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Paired {
        /// The plane of the model, or "spatial" for a three-dimensional model; null for a free scene.
        pub view: Option<&'static str> ["transverse", "longitudinal", "spatial"],
        /// Name of the first run.
        pub first: String,
        /// Name of the second run.
        pub second: String,
        /// Number of variants that collapse in both runs.
        pub both: u32,
        /// Number of variants that collapse in the first run only.
        pub only_first: u32,
        /// Number of variants that collapse in the second run only.
        pub only_second: u32,
        /// Number of variants that collapse in neither run.
        pub neither: u32,
        /// Number of variants without a verdict in at least one of the two runs; the other counts do not include them.
        pub without_verdict: u32,
        /// Share of variants that collapse in the first run, minus the share that collapse in the second run. Only
        /// variants with a verdict in both runs are counted.
        pub reduction: f64 as "1",
        /// 95 % interval of `reduction` (Newcombe 1998, for paired samples).
        pub interval: [f64; 2] as "1",
    }
}

impl Paired {
    /// Compares two runs in every plane that both have, or in three dimensions.
    pub(super) fn of(first: &Side, second: &Side) -> Vec<Self> {
        let pair = |(view, own): &(Option<&'static str>, Vec<Option<bool>>)| {
            let (_, other) = second.collapsed.iter().find(|(known, _)| known == view)?;
            Self::counted((first, second), *view, (own, other))
        };
        first.collapsed.iter().filter_map(pair).collect()
    }

    fn counted(
        (first, second): (&Side, &Side),
        view: Option<&'static str>,
        (own, other): (&[Option<bool>], &[Option<bool>]),
    ) -> Option<Self> {
        let mut counts = [0_u32; 5];
        for pair in own.iter().zip(other) {
            counts[match pair {
                (Some(true), Some(true)) => 0,
                (Some(true), Some(false)) => 1,
                (Some(false), Some(true)) => 2,
                (Some(false), Some(false)) => 3,
                (None, _) | (_, None) => 4,
            }] += 1;
        }
        let [both, only_first, only_second, neither, without_verdict] = counts;
        let (reduction, interval) = newcombe([both, only_first, only_second, neither])?;
        Some(Self {
            view,
            first: first.name.clone(),
            second: second.name.clone(),
            both,
            only_first,
            only_second,
            neither,
            without_verdict,
            reduction,
            interval,
        })
    }

    /// Returns the number of paired variants, which have a verdict in both runs.
    pub fn pairs(&self) -> u32 {
        self.both + self.only_first + self.only_second + self.neither
    }

    /// Returns how many of the paired variants collapse in the first run, and how many collapse in the second run.
    pub fn collapsed(&self) -> [u32; 2] {
        [self.both + self.only_first, self.both + self.only_second]
    }

    /// `true` if the 95 % interval of the difference between the two shares of collapses excludes zero.
    pub fn is_clear(&self) -> bool {
        self.interval[0] > 0.0 || self.interval[1] < 0.0
    }
}

/// Returns the difference between two shares of the same cases, and the interval of the difference;
/// `None` if there are no cases.
///
/// `[a, b, c, d]` counts the cases that collapse in both runs, only in the first, only in the
/// second, and in neither. The interval combines Wilson's half-intervals, corrected for their
/// correlation (method 10 of Newcombe 1998, with his correction for continuity).
fn newcombe([a, b, c, d]: [u32; 4]) -> Option<(f64, [f64; 2])> {
    let n = a + b + c + d;
    if n == 0 {
        return None;
    }
    let share = |count: u32| f64::from(count) / f64::from(n);
    let (one, other) = (share(a + b), share(a + c));
    let [own, its] = [a + b, a + c].map(|count| wilson(count, n, LEVEL));
    let [a, b, c, d] = [a, b, c, d].map(f64::from);
    let product = (a + b) * (c + d) * (a + c) * (b + d);
    let apart = a * d - b * c;
    let corrected = if apart > 0.0 { (apart - 0.5 * f64::from(n)).max(0.0) } else { apart };
    let phi = if product > 0.0 { corrected / product.sqrt() } else { 0.0 };
    let half = |x: f64, y: f64| (x * x - 2.0 * phi * x * y + y * y).max(0.0).sqrt();
    let difference = one - other;
    let low = difference - half(one - own.low, its.high - other);
    let high = difference + half(own.high - one, other - its.low);
    Some((difference, [low, high]))
}

#[cfg(test)]
mod tests {
    use super::newcombe;

    #[test]
    fn the_interval_of_paired_shares_covers_their_difference() {
        // Probabilities of the four outcomes of a pair, with 4,000 samples of 32 pairs each.
        for chances in [[0.4, 0.5, 0.0, 0.1], [0.3, 0.2, 0.1, 0.4], [0.1, 0.05, 0.05, 0.8]] {
            let truth = chances[1] - chances[2];
            let mut random = barrelstack_motion::Random::new(7);
            let mut covered = 0;
            for _ in 0..4000 {
                let mut counts = [0_u32; 4];
                for _ in 0..32 {
                    let mut left = random.uniform();
                    let mut at = 0;
                    while at < 3 && left >= chances[at] {
                        left -= chances[at];
                        at += 1;
                    }
                    counts[at] += 1;
                }
                let (_, [low, high]) = newcombe(counts).unwrap_or_default();
                covered += u32::from(low <= truth && truth <= high);
            }
            // A share of 95 % of 4,000 samples has a standard deviation of 0.3 %.
            assert!(f64::from(covered) >= 0.94 * 4000.0, "{chances:?}: {covered}");
        }
        // Between two equal runs, the difference is zero and its interval is symmetric about zero.
        let (difference, [low, high]) = newcombe([5, 0, 0, 5]).unwrap_or_default();
        assert!(difference == 0.0 && low < 0.0 && (low + high).abs() < 1e-12, "{low} {high}");
        assert_eq!(newcombe([0; 4]), None);
    }
}
