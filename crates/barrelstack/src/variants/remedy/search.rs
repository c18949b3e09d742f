//! Order and statistics of the sequential search for a remedy.
//!
//! The search does not depend on how variants are run, so whole searches can be simulated in tests.
//!
//! Variants are run in blocks. The variants that are most likely to fall come first: they are sorted by the number of
//! times that they fell with earlier changes of the same kind, the largest number first. Where these numbers are equal,
//! the variants that fell earliest without a change come first. A change is rejected after the first block with which
//! its failures exceed the number that is admissible among all variants. The order therefore does not affect which
//! changes suffice, but only the number of runs until a change is rejected. The failure share of a rejected change is
//! unknown, since the counted variants are a biased sample.
//!
//! If looser straps suffice, a pretension that was not rejected after its first block is not run further; it is then
//! unknown whether this pretension suffices. If all variants of a change were counted, its failure share has a
//! confidence interval. These intervals hold simultaneously for all changes and planes of the search (Bonferroni), so
//! choosing among the changes does not invalidate them.

use std::cmp::Reverse;
use std::ops::{ControlFlow, Range};

use barrelstack_fragility::{Interval, clopper_pearson};

use super::super::spread::LEVEL;
use super::Attempt;
use crate::pool;

/// Share (%) of variants that must stand in every plane.
pub const ENOUGH: u32 = 95;

/// Number of variants in every block after the first.
const BLOCK: u32 = 16;

/// Candidates of a search, and the number of variants that are simulated for each.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// Number of changes of height. They are the first changes of the plan, from the highest to the lowest
    /// stack, and are tried until one suffices.
    pub(super) heights: usize,
    /// Number of strap pretensions. In the plan, they follow the changes of height, from loose to tight.
    pub(super) straps: usize,
    /// Indices of the variants, those that fell earliest without a change first; index 0 is variant 1.
    /// All of these variants are simulated for each change that suffices.
    pub(super) order: Vec<u32>,
    /// Number of variants in the first block of a change. If that number could not reject a change, the block has as
    /// many variants as are needed to reject it.
    pub(super) first: u32,
    /// Number of planes; enough variants must stand in each.
    pub(super) planes: usize,
}

impl Plan {
    /// Returns the number of changes that may be tried.
    pub(super) fn changes(&self) -> usize {
        self.heights + self.straps
    }

    /// Returns the totals of the search, as the progress of a change that has no name and no finished runs yet.
    pub(super) fn attempt(&self) -> Attempt<'static> {
        Attempt {
            stack: "",
            number: 0,
            candidates: self.changes(),
            done: 0,
            of: self.order.len() * self.planes,
            things: if self.planes == 1 { "variants" } else { "runs" },
        }
    }

    /// Returns the confidence level of a single interval, chosen so that all intervals hold simultaneously with the
    /// confidence [`LEVEL`].
    pub(super) fn level(&self) -> f64 {
        1.0 - (1.0 - LEVEL) / (self.changes() * self.planes).max(1) as f64
    }

    /// Returns the number of variants with which a change is tried, if it is not rejected.
    pub(super) fn variants(&self) -> u32 {
        u32::try_from(self.order.len()).unwrap_or(u32::MAX)
    }

    /// Returns the largest number of variants that may fail with a change that suffices.
    fn admissible(&self) -> u32 {
        let most = u64::from(self.variants()) * u64::from(100 - ENOUGH) / 100;
        u32::try_from(most).unwrap_or(u32::MAX)
    }

    /// Returns the number of variants in the block of a change that follows the first `ran` variants.
    fn block(&self, ran: u32) -> usize {
        let size = if ran == 0 { self.first.max(self.admissible() + 1) } else { BLOCK };
        size as usize
    }
}

/// Numbers of counted and of failed variants of a change that was tried, with the verdicts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Number of counted variants.
    pub(super) ran: u32,
    /// Number of counted variants that failed, in the plane with the most failures.
    pub(super) failed: u32,
    /// For each plane, the verdicts of all variants in the order of their numbers; `None` for a variant that was not
    /// counted.
    verdicts: Vec<Vec<Option<Verdict>>>,
}

impl Counts {
    fn new(plan: &Plan) -> Self {
        Self { ran: 0, failed: 0, verdicts: vec![vec![None; plan.order.len()]; plan.planes] }
    }

    /// Returns `true` if a variant was counted.
    fn has(&self, variant: u32) -> bool {
        self.verdicts.iter().any(|all| all.get(variant as usize).is_some_and(Option::is_some))
    }

    fn add(&mut self, block: &[u32], verdicts: &Verdicts) {
        for (all, more) in self.verdicts.iter_mut().zip(verdicts) {
            for (variant, verdict) in block.iter().zip(more) {
                all[*variant as usize] = Some(*verdict);
            }
        }
        self.ran += u32::try_from(block.len()).unwrap_or(u32::MAX);
        let failures = |all: &Vec<Option<Verdict>>| {
            all.iter().flatten().filter(|verdict| failed(**verdict)).count()
        };
        let most = self.verdicts.iter().map(failures).max().unwrap_or(0);
        self.failed = u32::try_from(most).unwrap_or(u32::MAX);
    }

    /// Returns the verdicts in each plane, in the order of the numbers of the variants; `None` unless all variants were
    /// counted.
    pub(super) fn verdicts(&self, plan: &Plan) -> Option<Verdicts> {
        let all = |all: &Vec<Option<Verdict>>| all.iter().copied().collect();
        self.whole(plan).then(|| self.verdicts.iter().map(all).collect())?
    }

    /// `true` if the number of failures already exceeds the number that is admissible among all
    /// variants.
    fn rejected(&self, plan: &Plan) -> bool {
        self.failed > plan.admissible()
    }

    /// `true` if all variants were counted, so that they are an unbiased sample.
    pub(super) fn whole(&self, plan: &Plan) -> bool {
        self.ran > 0 && self.ran == plan.variants()
    }

    /// Returns whether the change suffices; `None` if that is not known, because not all variants were counted.
    pub(super) fn verdict(&self, plan: &Plan) -> Option<bool> {
        if self.rejected(plan) { Some(false) } else { self.whole(plan).then_some(true) }
    }

    fn suffices(&self, plan: &Plan) -> bool {
        self.verdict(plan) == Some(true)
    }

    /// Returns the confidence interval of the share of variants that fail, in the plane in which more variants fail;
    /// `None` unless all variants were counted.
    pub(super) fn interval(&self, plan: &Plan) -> Option<Interval> {
        self.whole(plan).then(|| clopper_pearson(self.failed, self.ran, plan.level()))
    }
}

/// Result of a search.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// Counts for every change of the plan; `None` for a change that was not tried.
    pub(super) counts: Vec<Option<Counts>>,
    /// `true` if the search was not canceled.
    pub(super) complete: bool,
}

/// Verdict on a variant: `true` if the variant collapses. A variant without a verdict is `None` and also counts as a
/// failure.
type Verdict = Option<bool>;

/// For each plane, the verdict of each variant.
pub type Verdicts = Vec<Vec<Verdict>>;

/// Verdicts of a block of variants, in its order, or `Break` if the block was canceled.
pub type Judged = ControlFlow<(), Verdicts>;

/// Function that runs a block of variants of one change. Its arguments are the index of the change and the indices of
/// the variants; index 0 is the variant with the number 1.
type RunBlock<'a, E> = dyn Fn(usize, &[u32]) -> Result<Judged, E> + Sync + 'a;

fn failed(verdict: Verdict) -> bool {
    verdict != Some(false)
}

/// Tries changes until the highest sufficient stack and the loosest sufficient straps are found.
///
/// Heights and straps are tried at the same time. Neither affects the order of the other, so the counts do not depend
/// on the number of threads.
pub(super) fn search<E: Send>(plan: &Plan, run: &RunBlock<'_, E>) -> Result<Found, E> {
    let half = |straps: &bool| {
        let (counts, failures) = (vec![None; plan.changes()], vec![0; plan.order.len()]);
        let mut half = Search { plan, counts, failures, run };
        let end = if *straps { half.straps() } else { half.heights() };
        end.map(|end| (half.counts, end.is_continue()))
    };
    let halves = pool::map(&[false, true], half, &|_| ());
    let halves = halves.into_iter().collect::<Result<Vec<_>, E>>()?;
    let mut found = Found { counts: vec![None; plan.changes()], complete: true };
    for (counts, complete) in halves {
        let both = found.counts.into_iter().zip(counts);
        found.counts = both.map(|(one, other)| one.or(other)).collect();
        found.complete &= complete;
    }
    Ok(found)
}

/// Search among the changes of height, or among the straps.
struct Search<'a, 'b, E> {
    plan: &'a Plan,
    counts: Vec<Option<Counts>>,
    /// For each variant, the number of planes and changes of this search in which it failed.
    failures: Vec<u32>,
    run: &'a RunBlock<'b, E>,
}

impl<E> Search<'_, '_, E> {
    /// Returns the variants of a change that are run next.
    fn next(&self, counts: &Counts) -> Vec<u32> {
        let order = self.plan.order.iter().copied();
        let mut left: Vec<u32> = order.filter(|variant| !counts.has(*variant)).collect();
        // The sort is stable, so the order of the plan decides where the numbers of failures are equal.
        left.sort_by_key(|variant| Reverse(self.failures[*variant as usize]));
        left.truncate(self.plan.block(counts.ran));
        left
    }

    /// Runs blocks of a change until the given number of variants is counted or the change is
    /// rejected.
    fn try_change(&mut self, change: usize, until: u32) -> Result<ControlFlow<(), Counts>, E> {
        let mut counts = self.counts[change].take().unwrap_or_else(|| Counts::new(self.plan));
        while counts.ran < until.min(self.plan.variants()) && !counts.rejected(self.plan) {
            let block = self.next(&counts);
            let ControlFlow::Continue(verdicts) = (self.run)(change, &block)? else {
                // A canceled block does not count.
                self.counts[change] = Some(counts);
                return Ok(ControlFlow::Break(()));
            };
            for verdicts in &verdicts {
                for (variant, verdict) in block.iter().zip(verdicts) {
                    self.failures[*variant as usize] += u32::from(failed(*verdict));
                }
            }
            counts.add(&block, &verdicts);
        }
        self.counts[change] = Some(counts.clone());
        Ok(ControlFlow::Continue(counts))
    }

    /// Tries changes in order until one suffices.
    fn first_of(&mut self, changes: Range<usize>) -> Result<ControlFlow<()>, E> {
        for change in changes {
            match self.try_change(change, u32::MAX)? {
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
                ControlFlow::Continue(counts) if counts.suffices(self.plan) => break,
                ControlFlow::Continue(_) => {}
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    fn heights(&mut self) -> Result<ControlFlow<()>, E> {
        self.first_of(0..self.plan.heights)
    }

    /// Finds the loosest straps that suffice.
    ///
    /// A bisection runs only the first block of variants for a pretension. If too many of these variants fail, this and
    /// all looser pretensions are rejected. The remaining pretensions are then tried with all variants, from loose to
    /// tight, until one suffices.
    fn straps(&mut self) -> Result<ControlFlow<()>, E> {
        let (mut from, mut to) = (self.plan.heights, self.plan.changes());
        while from < to {
            let middle = usize::midpoint(from, to);
            let ControlFlow::Continue(counts) = self.try_change(middle, 1)? else {
                return Ok(ControlFlow::Break(()));
            };
            if counts.rejected(self.plan) { from = middle + 1 } else { to = middle }
        }
        self.first_of(from..self.plan.changes())
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::sync::Mutex;

    use barrelstack_motion::Random;

    use super::*;

    /// Totals over simulated searches, in which the failure probability of every change is known.
    struct Simulated {
        stated: u32,
        covered: u32,
        searches_covered: u32,
        chosen: u32,
        chosen_covered: u32,
        /// Number of changes that are reported as sufficient although their true failure probability exceeds the limit.
        too_many_fall: u32,
    }

    /// Function that draws the failure probability of a change in a plane.
    type Chance = dyn Fn(&mut Random) -> f64;

    fn simulate(searches: u32, chance: &Chance) -> Simulated {
        let plan = Plan { heights: 4, straps: 5, order: (0..64).collect(), first: 8, planes: 2 };
        let mut found = Simulated {
            stated: 0,
            covered: 0,
            searches_covered: 0,
            chosen: 0,
            chosen_covered: 0,
            too_many_fall: 0,
        };
        for seed in 0..searches {
            let mut random = Random::new(u64::from(seed) + 1);
            let mut chances: Vec<[f64; 2]> =
                (0..plan.changes()).map(|_| [chance(&mut random), chance(&mut random)]).collect();
            // Lower stacks and tighter straps fail less often.
            for part in [0..plan.heights, plan.heights..plan.changes()] {
                chances[part].sort_by(|a, b| b[0].max(b[1]).total_cmp(&a[0].max(a[1])));
            }
            let mut draw = |chance: f64| (0..64).map(|_| random.uniform() < chance).collect();
            let fails: Vec<[Vec<bool>; 2]> =
                chances.iter().map(|planes| planes.map(&mut draw)).collect();
            let run = |change: usize, block: &[u32]| {
                let of = |fails: &Vec<bool>| {
                    block.iter().map(|variant| Some(fails[*variant as usize])).collect()
                };
                let verdicts = fails[change].iter().map(of).collect();
                Ok::<_, Infallible>(ControlFlow::Continue(verdicts))
            };
            let Ok(all) = search(&plan, &run);
            assert!(all.complete);
            let mut whole = true;
            for (counts, chance) in all.counts.iter().zip(&chances) {
                let Some(counts) = counts else { continue };
                let Some(interval) = counts.interval(&plan) else { continue };
                let truth = chance[0].max(chance[1]);
                let covers = interval.low <= truth && truth <= interval.high;
                whole &= covers;
                found.stated += 1;
                found.covered += u32::from(covers);
                if counts.suffices(&plan) {
                    found.chosen += 1;
                    found.chosen_covered += u32::from(covers);
                    found.too_many_fall +=
                        u32::from(100.0 * truth > f64::from(100 - ENOUGH) + 1e-9);
                }
            }
            found.searches_covered += u32::from(whole);
        }
        found
    }

    /// Checks the coverage of the intervals in simulated searches, and prints the table of `validation/mitigation.md`.
    #[test]
    #[expect(clippy::print_stdout, reason = "the rows of the table")]
    fn stated_shares_cover_the_truth_as_often_as_their_intervals_say() {
        let cases: [(&str, &Chance); 4] = [
            ("0 to 100 %, half of them below 13 %", &|random| {
                let x = random.uniform();
                x * x * x
            }),
            ("0 to 20 %", &|random| 0.2 * random.uniform()),
            ("all 5 %", &|_| 0.05),
            ("all 10 %", &|_| 0.10),
        ];
        for (name, chance) in cases {
            let found = simulate(2000, chance);
            let share = |of: u32, all: u32| 100.0 * f64::from(of) / f64::from(all.max(1));
            println!(
                "| {name} | {} | {:.1} % | {} | {:.1} % | {:.1} % | {} |",
                found.stated,
                share(found.covered, found.stated),
                found.chosen,
                share(found.chosen_covered, found.chosen),
                share(found.searches_covered, 2000),
                found.too_many_fall
            );
            assert!(found.stated > 100, "{name}");
            assert!(share(found.covered, found.stated) >= 95.0, "{name}");
            assert!(share(found.chosen_covered, found.chosen) >= 95.0, "{name}");
            assert!(share(found.searches_covered, 2000) >= 95.0, "{name}");
        }
    }

    /// Plan with one change of height, in two planes.
    fn one_change(variants: u32, first: u32) -> Plan {
        Plan { heights: 1, straps: 0, order: (0..variants).rev().collect(), first, planes: 2 }
    }

    #[test]
    fn a_rejected_change_has_counts_of_whole_blocks_and_no_share() {
        let plan = one_change(64, 8);
        let blocks = Mutex::new(Vec::new());
        let run = |_, block: &[u32]| {
            // In both planes, the first variant collapses; in the second plane, the second variant has no verdict.
            let mut verdicts = vec![vec![Some(false); block.len()]; 2];
            (verdicts[0][0], verdicts[1][0], verdicts[1][1]) = (Some(true), Some(true), None);
            blocks.lock().unwrap().push(block.to_vec());
            Ok::<_, Infallible>(ControlFlow::Continue(verdicts))
        };
        let Ok(found) = search(&plan, &run);
        let counts = found.counts[0].clone().unwrap_or_else(|| panic!("it was tried"));
        let expected: [Vec<u32>; 2] = [(56..64).rev().collect(), (40..56).rev().collect()];
        assert_eq!(blocks.into_inner().unwrap(), expected);
        assert_eq!((counts.ran, counts.failed, counts.interval(&plan)), (24, 4, None));
        assert!(!counts.suffices(&plan) && counts.verdicts(&plan).is_none());
    }

    #[test]
    fn a_block_that_is_broken_off_does_not_count() {
        let plan = Plan { heights: 0, straps: 2, order: (0..64).collect(), first: 8, planes: 1 };
        let run = |_, block: &[u32]| {
            let over = block[0] > 0;
            Ok::<_, Infallible>(if over {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(vec![vec![Some(false); block.len()]])
            })
        };
        let Ok(found) = search(&plan, &run);
        assert!(!found.complete);
        assert!(
            found
                .counts
                .iter()
                .flatten()
                .all(|counts| counts.ran == 8 && counts.verdict(&plan).is_none())
        );
    }

    /// If looser straps suffice, tighter straps that were not rejected are not run further.
    #[test]
    fn straps_that_were_not_run_to_the_end_are_neither_sufficient_nor_rejected() {
        let plan = Plan { heights: 0, straps: 5, order: (0..64).collect(), first: 8, planes: 1 };
        // One variant falls with every pretension, and all variants fall with the loosest straps.
        let fails = |change: usize, variant: u32| change == 0 || variant == 0;
        let run = |change: usize, block: &[u32]| {
            let verdicts = block.iter().map(|variant| Some(fails(change, *variant))).collect();
            Ok::<_, Infallible>(ControlFlow::Continue(vec![verdicts]))
        };
        let Ok(found) = search(&plan, &run);
        assert!(found.complete);
        let counts = |change: usize| found.counts[change].as_ref();
        let verdicts: Vec<Option<(u32, u32, Option<bool>)>> = (0..5)
            .map(|change| counts(change).map(|one| (one.ran, one.failed, one.verdict(&plan))))
            .collect();
        let expected =
            [Some((8, 8, Some(false))), Some((64, 1, Some(true))), Some((8, 1, None)), None, None];
        assert_eq!(verdicts, expected);
    }

    /// The first block has enough variants to reject a change, even if the plan states a smaller first block.
    #[test]
    fn the_first_block_is_large_enough_to_reject_a_change() {
        for (variants, admissible) in [(16, 0), (19, 0), (20, 1), (64, 3), (1000, 50)] {
            let plan = one_change(variants, 2);
            assert_eq!(plan.admissible(), admissible);
            let ran = Mutex::new(Vec::new());
            let run = |_, block: &[u32]| {
                ran.lock().unwrap().push(block.len());
                let all = vec![Some(true); block.len()];
                Ok::<_, Infallible>(ControlFlow::Continue(vec![all.clone(), all]))
            };
            let Ok(_) = search(&plan, &run);
            assert_eq!(ran.into_inner().unwrap(), [(admissible as usize + 1).max(2)]);
        }
    }

    /// Variants that failed with an earlier change are run first, and the verdicts keep the order of the numbers.
    #[test]
    fn variants_that_failed_before_come_first() {
        // Of four changes of height, each is rejected by one variant, except for the last.
        let plan = Plan { heights: 4, straps: 0, order: (0..16).collect(), first: 2, planes: 1 };
        let fails = |change: usize, variant: u32| change < 3 && variant == 13;
        let blocks = Mutex::new(Vec::new());
        let run = |change: usize, block: &[u32]| {
            blocks.lock().unwrap().push((change, block.to_vec()));
            let verdicts = block.iter().map(|variant| Some(fails(change, *variant))).collect();
            Ok::<_, Infallible>(ControlFlow::Continue(vec![verdicts]))
        };
        let Ok(found) = search(&plan, &run);
        let counts: Vec<(u32, u32)> =
            found.counts.iter().flatten().map(|counts| (counts.ran, counts.failed)).collect();
        assert_eq!(counts, [(16, 1), (2, 1), (2, 1), (16, 0)]);
        let blocks: Vec<_> = blocks
            .into_inner()
            .unwrap()
            .into_iter()
            .filter(|(_, block)| block.len() == 2)
            .collect();
        assert_eq!(blocks[0], (0, vec![0, 1]));
        assert_eq!(blocks[1..], [1, 2, 3].map(|change| (change, vec![13, 0])));
        let whole = found.counts[0].as_ref().and_then(|counts| counts.verdicts(&plan));
        let expected = (0..16).map(|variant| Some(fails(0, variant))).collect();
        assert_eq!(whole, Some(vec![expected]));
    }

    /// Whatever the order, the same changes suffice with the same numbers of failures.
    #[test]
    fn the_order_of_the_variants_does_not_affect_which_changes_suffice() {
        for seed in 1..200 {
            let mut random = Random::new(seed);
            let heights = 4;
            let chance = 0.15 * random.uniform();
            let fails: Vec<Vec<bool>> = (0..heights)
                .map(|_| (0..64).map(|_| random.uniform() < chance).collect())
                .collect();
            let mut sufficient = Vec::new();
            for (first, shift) in [(8, 0), (2, 17), (64, 40)] {
                let order = (0..64).map(|index| (index + shift) % 64).collect();
                let plan = Plan { heights, straps: 0, order, first, planes: 1 };
                let run = |change: usize, block: &[u32]| {
                    let fails = &fails[change];
                    let verdicts = block.iter().map(|one| Some(fails[*one as usize])).collect();
                    Ok::<_, Infallible>(ControlFlow::Continue(vec![verdicts]))
                };
                let Ok(found) = search(&plan, &run);
                let suffices = |counts: &Option<Counts>| {
                    let counts = counts.as_ref().filter(|counts| counts.suffices(&plan))?;
                    Some((counts.failed, counts.interval(&plan), counts.verdicts(&plan)))
                };
                sufficient.push(found.counts.iter().map(suffices).collect::<Vec<_>>());
            }
            assert!(sufficient.windows(2).all(|pair| pair[0] == pair[1]), "seed {seed}");
        }
    }
}
