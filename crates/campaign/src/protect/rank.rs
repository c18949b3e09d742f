//! Statistics of a ranking: estimates, paired differences under the same motions, and selection for the next round.

use std::collections::BTreeMap;

use barrelstack::breakage::Breakage;
use barrelstack_fragility::{Hazard, Interval, Shape, grouped_mean, interval_of, mean_difference};

use crate::decision::{Cases, JudgedCase};
use crate::study::{Collected, Study};
use crate::uncertain::Sample;

/// Confidence level of all intervals.
pub(super) const LEVEL: f64 = 0.95;

/// Results of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outcome {
    pub(super) collapsed: f64,
    pub(super) fallen: f64,
    pub(super) burst: f64,
}

impl Outcome {
    fn of(case: &JudgedCase) -> Self {
        let burst: f64 = case.falls.iter().map(|fall| Breakage::RANGE[1].probability(*fall)).sum();
        Self {
            collapsed: f64::from(u8::from(case.collapsed)),
            fallen: f64::from(case.fallen()),
            burst,
        }
    }
}

/// Quantity by which protections are judged: the number of barrels that fall.
pub(super) const FALLEN: Quantity = |run| run.fallen;

/// All runs of a stack in one direction, by motion and level of shaking.
#[derive(Clone, Debug, Default)]
pub(super) struct Runs {
    by_motion: BTreeMap<String, Vec<Vec<Outcome>>>,
    pub(super) count: usize,
    pub(super) left_out: usize,
    /// Number of runs whose stack fell under its own weight, before it was shaken.
    pub(super) fallen_at_rest: usize,
    /// Drawn constants, motion, intensity and verdict of each run, from which the effect of the constants is estimated.
    sample: Sample,
    /// For each level, the number of runs in which the stack collapses, and the total number of barrels that fall in
    /// these runs.
    collapses: Vec<(f64, f64)>,
}

/// Effect of the uncertain constants on a stack.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Over {
    /// Range that contains, with a probability of 95 %, the probability of collapse or the annual rate of collapse;
    /// `None` if unknown.
    pub(super) range: Option<[f64; 2]>,
    /// Numbers of barrels that fall, one for each draw of the uncertain constants and the regression coefficients;
    /// empty if unknown.
    pub(super) fallen: Vec<f64>,
}

/// Mean of one quantity, with its interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean over all motions. For each motion, the results at the levels of shaking are weighted and added.
    pub mean: f64,
    /// Lower end of the 95 % interval. Runs under the same motion are not assumed to be independent.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
}

/// Function that returns a quantity of a run.
pub(super) type Quantity = fn(&Outcome) -> f64;

impl Runs {
    /// Adds the cases of a round; `levels` are the levels of shaking (m/s).
    pub(super) fn add(
        &mut self,
        (study, collected): (&Study, &Collected),
        cases: &Cases,
        levels: &[f64],
    ) {
        self.sample.add(study, collected, cases);
        if cases.left_out > 0 {
            self.sample.lacks_a_verdict();
        }
        self.collapses.resize(levels.len(), (0.0, 0.0));
        self.left_out += cases.left_out;
        self.fallen_at_rest += cases.fallen_at_rest();
        self.count += cases.all.len() + cases.left_out;
        for case in &cases.all {
            let Some(velocity) = case.intensity(cases.main) else { continue };
            // Motions were scaled to levels that were rounded when written as text, so the comparison needs a
            // tolerance.
            let off = |level: &f64| (velocity / level - 1.0).abs();
            let nearest =
                (0..levels.len()).min_by(|a, b| off(&levels[*a]).total_cmp(&off(&levels[*b])));
            let Some(at) = nearest.filter(|at| off(&levels[*at]) < 1e-3) else { continue };
            let motion = cases.records[case.record as usize].clone();
            let of = self.by_motion.entry(motion).or_insert_with(|| vec![Vec::new(); levels.len()]);
            of[at].push(Outcome::of(case));
            if case.collapsed {
                let (count, fallen) = &mut self.collapses[at];
                (*count, *fallen) = (*count + 1.0, *fallen + f64::from(case.fallen()));
            }
        }
    }

    /// Returns the effect of the uncertain constants on collapse and on the number of fallen barrels. The results at
    /// the levels (m/s) are weighted and added.
    ///
    /// For each draw of the constants, the regression gives the share of collapses at each level. To obtain the number
    /// of fallen barrels, this share is multiplied by the mean number of barrels that fall in a collapse at that level.
    /// If no stack collapses at that level, the mean over the collapses at all levels is used instead. If no stack
    /// collapses at any level, the largest possible number `most` is used. The number of barrels per collapse is
    /// assumed not to depend on the constants.
    pub(super) fn over_constants(&self, levels: &[f64], weights: &[f64], most: f64) -> Over {
        let certain =
            self.sample.is_certain().then(|| self.estimate(|run| run.collapsed, weights, 1.0));
        let unknown = Over { range: certain.map(|all| [all.low, all.high]), fallen: Vec::new() };
        let Some(fit) = self.sample.fit(Shape::Levels) else { return unknown };
        let near = |level: f64| {
            let found = self.sample.intensities().find(|known| (known / level - 1.0).abs() < 1e-3);
            Some(fit.at(found?)?.shares())
        };
        let Some(shares) = levels.iter().map(|level| near(*level)).collect::<Option<Vec<_>>>()
        else {
            return unknown;
        };
        let (count, sum) = self
            .collapses
            .iter()
            .fold((0.0, 0.0), |(n, sum), (count, fallen)| (n + count, sum + fallen));
        let whole = if count > 0.0 { sum / count } else { most };
        let each = |at: usize| match self.collapses[at] {
            (0.0, _) => whole,
            (count, fallen) => fallen / count,
        };
        let weighted = |draw: usize, factor: &dyn Fn(usize) -> f64| -> f64 {
            (0..levels.len()).map(|at| weights[at] * factor(at) * shares[at][draw]).sum()
        };
        let draws = 0..shares.first().map_or(0, Vec::len);
        let collapses: Vec<f64> = draws.clone().map(|draw| weighted(draw, &|_| 1.0)).collect();
        let Interval { low, high } = interval_of(&collapses, LEVEL);
        let fallen = draws.map(|draw| weighted(draw, &each)).collect();
        Over { range: Some([low, high]), fallen }
    }

    /// Averages a quantity over the runs at each level, and returns the weighted sum of these averages for each motion.
    /// Motions that lack a run at some level are left out.
    fn by_motion(&self, quantity: Quantity, weights: &[f64]) -> BTreeMap<&str, f64> {
        let weighted = |levels: &Vec<Vec<Outcome>>| {
            let mean = |runs: &Vec<Outcome>| {
                let sum: f64 = runs.iter().map(quantity).sum();
                (!runs.is_empty()).then(|| sum / runs.len() as f64)
            };
            levels
                .iter()
                .zip(weights)
                .map(|(runs, weight)| Some(weight * mean(runs)?))
                .sum::<Option<f64>>()
        };
        let motions = self.by_motion.iter();
        motions.filter_map(|(name, levels)| Some((name.as_str(), weighted(levels)?))).collect()
    }

    /// Returns the number of motions that have a run at every level.
    pub(super) fn motions(&self) -> usize {
        self.by_motion.values().filter(|levels| levels.iter().all(|runs| !runs.is_empty())).count()
    }

    /// Estimates the mean of a quantity over the weighted levels; `most` is the largest possible value of the
    /// quantity in one run.
    pub(super) fn estimate(&self, quantity: Quantity, weights: &[f64], most: f64) -> Estimate {
        let values: Vec<f64> = self.by_motion(quantity, weights).into_values().collect();
        let scale = most * weights.iter().sum::<f64>();
        if values.is_empty() || scale <= 0.0 {
            return Estimate { mean: f64::NAN, low: 0.0, high: scale };
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let shares: Vec<(f64, f64)> = values.iter().map(|value| (value / scale, 1.0)).collect();
        let Interval { low, high } = grouped_mean(&shares, LEVEL);
        Estimate { mean, low: scale * low, high: scale * high }
    }

    /// Estimates by how much a quantity is smaller in these runs than in the runs `other`, under the same motions.
    ///
    /// Returns the mean of the differences and its 95 % interval ([`mean_difference`]). The interval is widened so that
    /// it holds for `tries` comparisons simultaneously. `most` is the largest possible value of the quantity in one
    /// run. Returns `None` if fewer than two motions occur in both sets of runs.
    pub(super) fn less_than(
        &self,
        other: &Self,
        quantity: Quantity,
        (weights, most): (&[f64], f64),
        tries: usize,
    ) -> Option<Estimate> {
        let (own, other) = (self.by_motion(quantity, weights), other.by_motion(quantity, weights));
        let most = most * weights.iter().sum::<f64>();
        // A difference that is due to rounding counts as zero.
        let exact = |less: f64| if less.abs() > 1e-12 * most { less } else { 0.0 };
        let differences: Vec<f64> =
            own.iter().filter_map(|(name, value)| Some(exact(other.get(name)? - value))).collect();
        let Interval { low, high } = mean_difference(&differences, most, LEVEL, tries)?;
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        Some(Estimate { mean, low, high })
    }
}

/// Returns the weights of levels of shaking (m/s): the annual rate that each level represents, or equal weights without
/// a hazard curve.
///
/// The weights assume that results are linear in the logarithm of the shaking between two levels and constant
/// above the highest level. Below the lowest level, results are assumed to decrease to zero at half of that
/// level.
pub(super) fn weights(levels: &[f64], hazard: Option<&Hazard>) -> Vec<f64> {
    let Some(hazard) = hazard else { return vec![1.0 / levels.len() as f64; levels.len()] };
    let share = |at: usize, x: f64| {
        let below = if at == 0 { 0.5 * levels[0] } else { levels[at - 1] };
        let rising = |from: f64, to: f64| libm::log(x / from) / libm::log(to / from);
        if x <= below {
            0.0
        } else if x <= levels[at] {
            rising(below, levels[at])
        } else if let Some(above) = levels.get(at + 1) {
            (1.0 - rising(levels[at], *above)).max(0.0)
        } else {
            1.0
        }
    };
    (0..levels.len()).map(|at| hazard.expected(1.0, |x| share(at, x)).low).collect()
}

/// Returns the indices of the candidates that continue in the next round.
///
/// The first candidate, the unprotected stack, always continues. Another candidate is dropped if it is significantly
/// worse than a candidate that costs at most as much. Of the candidates other than the first, at most half (rounded up)
/// continue, or four if that is more: those with the smallest mean numbers of fallen barrels. The tests of significance
/// hold for all pairs of candidates simultaneously.
///
/// Each candidate is given by its runs and the midpoint of its cost range. `most` is the largest possible number of
/// fallen barrels in one run.
pub(super) fn contenders(all: &[(&Runs, f64)], weights: &[f64], most: f64) -> Vec<usize> {
    const LEAST: usize = 4;
    let mean = |at: usize| all[at].0.estimate(FALLEN, weights, 1.0).mean;
    let pairs = all.len() * all.len().saturating_sub(1) / 2;
    let beaten = |at: usize| {
        all.iter().any(|(runs, cost)| {
            let less = runs.less_than(all[at].0, FALLEN, (weights, most), pairs);
            *cost <= all[at].1 && less.is_some_and(|less| less.low > 0.0)
        })
    };
    let mut left: Vec<usize> = (1..all.len()).filter(|at| !beaten(*at)).collect();
    left.sort_by(|a, b| mean(*a).total_cmp(&mean(*b)).then(a.cmp(b)));
    left.truncate((all.len() - 1).div_ceil(2).max(LEAST));
    left.insert(0, 0);
    left.sort_unstable();
    left
}

/// Returns the indices of the points on the Pareto front, the cheapest first. A point is a cost and the mean number of
/// fallen barrels; smaller is better for both.
pub(super) fn front(all: &[(f64, f64)]) -> Vec<usize> {
    let better = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    let mut front: Vec<usize> =
        (0..all.len()).filter(|at| !all.iter().any(|other| better(*other, all[*at]))).collect();
    front.sort_by(|a, b| all[*a].0.total_cmp(&all[*b].0).then(all[*a].1.total_cmp(&all[*b].1)));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(motions: &[(&str, &[f64])]) -> Runs {
        let outcome = |fallen: &f64| vec![Outcome { collapsed: 0.0, fallen: *fallen, burst: 0.0 }];
        let of = |(name, levels): &(&str, &[f64])| {
            ((*name).to_owned(), levels.iter().map(outcome).collect())
        };
        Runs { by_motion: motions.iter().map(of).collect(), ..Runs::default() }
    }

    #[test]
    fn a_difference_under_the_same_motions_is_surer_than_the_means_are() {
        // The scatter between motions is much larger than the difference of the two stacks.
        let (mild, hard): (Vec<f64>, Vec<f64>) = ((0..6).map(f64::from).collect(), vec![]);
        assert!(hard.is_empty());
        let names = ["a", "b", "c", "d", "e", "f"];
        let one: Vec<[f64; 1]> = mild.iter().map(|x| [*x]).collect();
        let other: Vec<[f64; 1]> =
            mild.iter().enumerate().map(|(i, x)| [x + 1.0 + 0.1 * i as f64]).collect();
        let of = |values: &[[f64; 1]]| {
            let rows: Vec<(&str, &[f64])> =
                names.iter().zip(values).map(|(name, value)| (*name, &value[..])).collect();
            runs(&rows)
        };
        let (one, other) = (of(&one), of(&other));
        let less = one.less_than(&other, FALLEN, (&[1.0], 8.0), 1).unwrap();
        assert!((less.mean - 1.25).abs() < 1e-12, "{less:?}");
        let [a, b] = [&one, &other].map(|runs| runs.estimate(FALLEN, &[1.0], 8.0));
        // Six motions are too few to exclude that a seventh has the opposite effect.
        assert!(less.low < 0.0 && less.high - less.low < a.high - a.low + b.high - b.low);
        assert!(a.high > b.low, "{a:?} {b:?}");
    }

    #[test]
    fn near_equal_records_claim_nothing_and_more_tries_claim_less() {
        let of = |falls: &[f64]| {
            let names = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];
            let rows: Vec<[f64; 1]> = falls.iter().map(|x| [*x]).collect();
            let rows: Vec<(&str, &[f64])> =
                names.iter().zip(&rows).map(|(name, value)| (*name, &value[..])).collect();
            runs(&rows)
        };
        let less = |own: &[f64], other: &[f64], tries: usize| {
            of(own).less_than(&of(other), FALLEN, (&[1.0], 8.0), tries).unwrap()
        };
        // Two equal differences must not count as significant.
        let two = less(&[2.0, 2.0], &[4.0, 4.0], 1);
        assert!(two.mean == 2.0 && two.low < 0.0 && two.high > 4.0, "{two:?}");
        // A difference due to rounding counts as zero, and zero has no sign.
        let same = less(&[0.1 + 0.2, 0.3], &[0.3, 0.3], 1);
        assert!(same.mean == 0.0 && same.mean.is_sign_positive(), "{same:?}");
        let falls = [0.0, 1.0, 2.0, 0.0, 3.0, 1.0, 0.0, 2.0, 4.0, 0.0, 1.0, 2.0];
        let all = [8.0, 6.0, 4.0, 6.0, 7.0, 5.0, 4.0, 8.0, 8.0, 4.0, 2.0, 5.0];
        let [one, many] = [1, 60].map(|tries| less(&falls, &all, tries));
        assert!(one.mean == many.mean && many.low <= one.low && one.high < many.high);
        assert!(many.low > 0.0, "{many:?}");
    }

    #[test]
    fn weights_of_a_site_are_the_rate_at_which_something_happens_that_always_does() {
        // An intensity x is exceeded once in x² × 10⁴ years.
        let rows: Vec<(f64, f64)> =
            (0..60).map(|i| 0.01 * 1.1_f64.powi(i)).map(|x| (x, 1e-4 / (x * x))).collect();
        let hazard = Hazard::new(&rows).unwrap();
        let levels = [0.1, 0.2, 0.4];
        let found = weights(&levels, Some(&hazard));
        // Shaking above the lowest level counts fully. Below it, the effect decreases to zero at half of that level.
        let above: f64 = found.iter().sum();
        let exact = hazard.expected(1.0, |x| {
            if x >= 0.1 { 1.0 } else { (x / 0.05).ln().max(0.0) / 2.0_f64.ln() }
        });
        assert!((above / exact.low - 1.0).abs() < 1e-3, "{above} {exact:?}");
        assert!(found[0] > found[1] && found[1] > found[2]);
        assert_eq!(weights(&levels, None), [1.0 / 3.0; 3]);
    }

    #[test]
    fn the_front_holds_what_nothing_beats_in_both() {
        assert_eq!(
            front(&[(0.0, 5.0), (10.0, 5.0), (20.0, 1.0), (5.0, 3.0), (30.0, 1.0)]),
            [0, 3, 2]
        );
    }

    #[test]
    fn what_a_cheaper_one_beats_beyond_doubt_is_dropped_and_the_stack_as_it_is_stays() {
        let of = |falls: [f64; 4], motions: usize| {
            let names: Vec<String> = (0..motions).map(|at| at.to_string()).collect();
            let rows: Vec<[f64; 1]> = (0..motions).map(|at| [falls[at % 4]]).collect();
            let rows: Vec<(&str, &[f64])> =
                names.iter().zip(&rows).map(|(name, value)| (name.as_str(), &value[..])).collect();
            runs(&rows)
        };
        for (motions, expected) in [(4, vec![0, 1, 2]), (24, vec![0, 2])] {
            let base = of([8.0, 8.0, 7.0, 8.0], motions);
            let good = of([1.0, 0.0, 1.0, 0.0], motions);
            let dear = of([6.0, 7.0, 6.0, 6.0], motions);
            let all = [(&base, 0.0), (&dear, 90.0), (&good, 10.0)];
            assert_eq!(contenders(&all, &[1.0], 8.0), expected, "{motions} motions");
        }
    }
}
