//! Order and statistics of the sequential search for a remedy.
//!
//! The search does not depend on how variants are run, so whole searches can be simulated in tests.
//!
//! Variants are counted in whole blocks, in the order of their numbers. Counting runs as they
//! finish would be biased towards collapses, because runs that collapse end early. A change is
//! rejected after the first block that brings it above the admissible number of failures. The
//! failure share of a rejected change is unknown: the counted variants are a biased sample, because
//! counting stopped due to their failures. If all variants of a change were counted, its failure
//! share has a confidence interval. These intervals hold simultaneously for all changes and planes
//! of the search (Bonferroni), so choosing among the changes does not invalidate them.

use std::ops::{ControlFlow, Range};

use barrelstack_fragility::{Interval, clopper_pearson};

use super::super::spread::LEVEL;
use super::Attempt;

/// Share (%) of variants that must stand in every plane.
pub const ENOUGH: u32 = 95;

/// Number of variants in the first block of a change: as many as one core computes side by side in SIMD lanes.
const FIRST: u32 = 8;

/// Number of variants in every later block.
const BLOCK: u32 = 16;

/// Candidates of a search, and the number of variants that are simulated for each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Number of changes of height. They are the first changes of the plan, from the highest to the lowest
    /// stack, and are tried until one suffices.
    pub(super) heights: usize,
    /// Number of strap pretensions. In the plan, they follow the changes of height, from loose to tight.
    pub(super) straps: usize,
    /// Number of variants that are simulated for each change.
    pub(super) variants: u32,
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
            of: self.variants as usize * self.planes,
            things: if self.planes == 1 { "variants" } else { "runs" },
        }
    }

    /// Returns the confidence level of a single interval, chosen so that all intervals hold simultaneously with the
    /// confidence [`LEVEL`].
    pub(super) fn level(&self) -> f64 {
        1.0 - (1.0 - LEVEL) / (self.changes() * self.planes).max(1) as f64
    }

    /// Returns the indices of the block of variants that follows the first `ran` variants; index 0 is the variant with
    /// the number 1.
    fn block(&self, ran: u32) -> Range<u32> {
        let size = if ran == 0 { FIRST } else { BLOCK };
        ran..ran.saturating_add(size).min(self.variants)
    }
}

/// Numbers of counted and of failed variants of a change that was tried, with the verdicts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Number of counted variants; these are the variants with the lowest numbers.
    pub(super) ran: u32,
    /// Number of counted variants that failed, in the plane with the most failures.
    pub(super) failed: u32,
    /// Verdicts of the counted variants.
    pub(super) verdicts: Verdicts,
}

impl Counts {
    fn new(planes: usize) -> Self {
        Self { ran: 0, failed: 0, verdicts: vec![Vec::new(); planes] }
    }

    fn add(&mut self, block: &Range<u32>, verdicts: Verdicts) {
        self.ran = block.end;
        for (all, more) in self.verdicts.iter_mut().zip(verdicts) {
            all.extend(more);
        }
        let failed = |all: &Vec<_>| all.iter().filter(|one| **one != Some(false)).count();
        let most = self.verdicts.iter().map(failed).max().unwrap_or(0);
        self.failed = u32::try_from(most).unwrap_or(u32::MAX);
    }

    /// `true` if the number of failures already exceeds the number that is admissible among all
    /// variants.
    fn rejected(&self, plan: &Plan) -> bool {
        !may_fail(self.failed, plan.variants)
    }

    /// `true` if all variants were counted, so that they are an unbiased sample.
    pub(super) fn whole(&self, plan: &Plan) -> bool {
        plan.variants > 0 && self.ran == plan.variants
    }

    pub(super) fn suffices(&self, plan: &Plan) -> bool {
        self.whole(plan) && !self.rejected(plan)
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

/// For each plane, whether each variant collapses, in the order of their numbers. A variant without a verdict is `None`
/// and also counts as a failure.
pub type Verdicts = Vec<Vec<Option<bool>>>;

/// Verdicts of a block of variants, or `Break` if the block was canceled.
pub type Judged = ControlFlow<(), Verdicts>;

/// Function that runs a block of variants of one change. Its arguments are the index of the change and the indices of
/// the variants; index 0 is the variant with the number 1.
type RunBlock<'a, E> = dyn FnMut(usize, Range<u32>) -> Result<Judged, E> + 'a;

/// Tries changes until the highest sufficient stack and the loosest sufficient straps are found.
pub(super) fn search<E>(plan: &Plan, run: &mut RunBlock<'_, E>) -> Result<Found, E> {
    let mut all = Search { plan, counts: vec![None; plan.changes()], run };
    let complete = all.heights()?.is_continue() && all.straps()?.is_continue();
    Ok(Found { counts: all.counts, complete })
}

struct Search<'a, 'b, E> {
    plan: &'a Plan,
    counts: Vec<Option<Counts>>,
    run: &'a mut RunBlock<'b, E>,
}

impl<E> Search<'_, '_, E> {
    /// Runs blocks of a change until the given number of variants is counted or the change is
    /// rejected.
    fn try_change(&mut self, change: usize, until: u32) -> Result<ControlFlow<(), Counts>, E> {
        let mut counts =
            self.counts[change].take().unwrap_or_else(|| Counts::new(self.plan.planes));
        while counts.ran < until.min(self.plan.variants) && !counts.rejected(self.plan) {
            let block = self.plan.block(counts.ran);
            match (self.run)(change, block.clone())? {
                ControlFlow::Continue(verdicts) => counts.add(&block, verdicts),
                // A canceled block does not count.
                ControlFlow::Break(()) => {
                    self.counts[change] = Some(counts);
                    return Ok(ControlFlow::Break(()));
                }
            }
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
            let ControlFlow::Continue(counts) = self.try_change(middle, FIRST)? else {
                return Ok(ControlFlow::Break(()));
            };
            if counts.rejected(self.plan) { from = middle + 1 } else { to = middle }
        }
        self.first_of(from..self.plan.changes())
    }
}

/// `true` if the number of failures is at most `100 − ENOUGH` percent of the number of variants.
fn may_fail(failed: u32, of: u32) -> bool {
    u64::from(failed) * 100 <= u64::from(of) * u64::from(100 - ENOUGH)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

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
        let plan = Plan { heights: 4, straps: 5, variants: 64, planes: 2 };
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
            // Lower stacks and tighter straps fail less.
            for part in [0..plan.heights, plan.heights..plan.changes()] {
                chances[part].sort_by(|a, b| b[0].max(b[1]).total_cmp(&a[0].max(a[1])));
            }
            let mut run = |change: usize, block: Range<u32>| {
                let planes: [f64; 2] = chances[change];
                let verdicts = planes
                    .map(|chance| block.clone().map(|_| Some(random.uniform() < chance)).collect());
                Ok::<_, Infallible>(ControlFlow::Continue(verdicts.to_vec()))
            };
            let Ok(all) = search(&plan, &mut run);
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

    #[test]
    fn a_rejected_change_has_counts_of_whole_blocks_and_no_share() {
        let plan = Plan { heights: 1, straps: 0, variants: 64, planes: 2 };
        let mut blocks = Vec::new();
        let mut run = |_, block: Range<u32>| {
            // In both planes, the first variant collapses; in the second plane, the second variant has no verdict.
            let mut verdicts = vec![vec![Some(false); block.len()]; 2];
            (verdicts[0][0], verdicts[1][0], verdicts[1][1]) = (Some(true), Some(true), None);
            blocks.push(block);
            Ok::<_, Infallible>(ControlFlow::Continue(verdicts))
        };
        let Ok(found) = search(&plan, &mut run);
        let counts = found.counts[0].clone().unwrap_or_else(|| panic!("it was tried"));
        assert_eq!(blocks, [0..8, 8..24]);
        assert_eq!((counts.ran, counts.failed, counts.interval(&plan)), (24, 4, None));
        assert!(!counts.suffices(&plan));
    }

    #[test]
    fn a_block_that_is_broken_off_does_not_count() {
        let plan = Plan { heights: 0, straps: 2, variants: 64, planes: 1 };
        let mut run = |_, block: Range<u32>| {
            let over = block.start > 0;
            Ok::<_, Infallible>(if over {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(vec![vec![Some(false); block.len()]])
            })
        };
        let Ok(found) = search(&plan, &mut run);
        assert!(!found.complete);
        assert!(
            found.counts.iter().flatten().all(|counts| counts.ran == 8 && !counts.suffices(&plan))
        );
    }
}
