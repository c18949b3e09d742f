//! Candidates of a ranking. A candidate is a stack with a protection. In each round, one study of a candidate is run
//! for each direction of shaking.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use barrelstack::variants::planes;

use super::options::a_level;
use super::rank::{FALLEN, Runs};
use super::{ProtectError, Protection, Ranked, Reached, Request, middle, plan};
use crate::decision::Cases;
use crate::direction::{Direction, check};
use crate::pool;
use crate::scenario::Scenario;
use crate::study::{RunOptions, Study, StudyError};
use crate::system;

/// A protection that is tried, with its stacks and runs.
pub(super) struct Candidate {
    pub(super) protection: Protection,
    /// For each direction, the scenario of the protected stack.
    pub(super) stacks: Vec<(Direction, Scenario)>,
    pub(super) runs: Vec<Runs>,
    pub(super) round: u32,
}

impl Candidate {
    pub(super) fn new(base: &Scenario, protection: Protection) -> Result<Self, ProtectError> {
        let changed = protection.on(base)?;
        let stacks: Vec<(Direction, Scenario)> = planes(&changed)?
            .into_iter()
            .filter_map(|plane| Some((Direction::of(&plane.scenario)?, plane.scenario)))
            .collect();
        // The stack must stand under its own weight in every direction.
        stacks.iter().try_for_each(|(_, stack)| check(stack).map(drop))?;
        let runs = stacks.iter().map(|_| Runs::default()).collect();
        Ok(Self { protection, stacks, runs, round: 0 })
    }

    /// Returns the number of barrels in the model of the stack; if there are two models, one for each direction, the
    /// larger number.
    pub(super) fn barrels(&self) -> f64 {
        let stacks = self.stacks.iter().filter_map(|(_, scenario)| scenario.stack());
        stacks.map(|stack| f64::from(stack.levels * a_level(stack))).fold(0.0, f64::max)
    }

    /// Returns the index of the direction in which more barrels fall.
    pub(super) fn worse(&self, weights: &[f64]) -> usize {
        let fallen = |at: usize| self.runs[at].estimate(FALLEN, weights, 1.0).mean;
        (0..self.runs.len()).max_by(|a, b| fallen(*a).total_cmp(&fallen(*b))).unwrap_or(0)
    }
}

/// State shared by all candidates of a search.
pub(super) struct Search<'a> {
    pub(super) request: &'a Request,
    pub(super) base: &'a Scenario,
    pub(super) folder: &'a Path,
    pub(super) options: &'a RunOptions,
    pub(super) report: &'a (dyn Fn(Reached) -> ControlFlow<()> + Sync),
    pub(super) levels: &'a [f64],
    pub(super) not_tried: Vec<(String, String)>,
}

impl Search<'_> {
    /// Returns candidates for the protections that can be built and do not exceed the budget; for all other
    /// protections, records why they were not tried.
    pub(super) fn candidates(&mut self, protections: Vec<Protection>) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        for protection in protections {
            let name = protection.name.clone();
            let cost = middle(&protection);
            if let Some(budget) = self.request.budget.filter(|budget| cost > *budget) {
                let reason = format!("costs US${cost:.0}, above the budget of US${budget:.0}");
                self.not_tried.push((name, reason));
                continue;
            }
            match Candidate::new(self.base, protection) {
                Ok(candidate) => candidates.push(candidate),
                // Only the first line is kept: the others state the location in a generated text, which is of no use to
                // the reader.
                Err(error) => {
                    let reason = error.to_string();
                    self.not_tried
                        .push((name, reason.lines().next().unwrap_or_default().to_owned()));
                }
            }
        }
        candidates
    }

    /// Runs one round of studies for the candidates with the indices `open`.
    pub(super) fn round(
        &self,
        candidates: &mut [Candidate],
        open: &[usize],
        round: u32,
    ) -> Result<(), ProtectError> {
        let mut studies = Vec::new();
        for at in open {
            for (direction, (shaken, stack)) in candidates[*at].stacks.iter().enumerate() {
                let study = plan::study(self.request, stack, self.levels, round)?;
                let below = Path::new(&candidates[*at].protection.key)
                    .join(plan::name(shaken.name(), round));
                let folder = self.folder.join(&below);
                system::folder_below(self.folder, &below)
                    .map_err(StudyError::system("create the folder", &folder))?;
                studies.push((*at, direction, folder, study));
            }
        }
        let of: u64 = studies.iter().map(|(.., study)| study.cases()).sum();
        let done = AtomicU64::new(0);
        // Each study runs on one thread, and as many studies run at once as there are cores.
        let options = RunOptions { threads: Some(NonZero::<usize>::MIN), ..*self.options };
        let work = |(.., folder, study): &(usize, usize, PathBuf, Study)| {
            let before = AtomicU64::new(0);
            let collected = study.run(folder, &options, &|progress| {
                let now = progress.tally.cases;
                let news = now.saturating_sub(before.fetch_max(now, Ordering::Relaxed));
                let done = done.fetch_add(news, Ordering::Relaxed) + news;
                (self.report)(Reached { round: round + 1, done, of })
            })?;
            let cases = Cases::read(&collected)?;
            Ok::<_, ProtectError>((collected, cases))
        };
        let found = pool::map(&studies, work, &|_| ());
        for ((at, direction, _, study), found) in studies.iter().zip(found) {
            let (collected, cases) = found?;
            candidates[*at].runs[*direction].add((study, &collected), &cases, self.levels);
            candidates[*at].round = round + 1;
        }
        Ok(())
    }

    /// Runs the protections on the Pareto front in their worn states, under the motions of the first round.
    pub(super) fn worn(
        &mut self,
        candidates: &[Candidate],
        all: &mut [Ranked],
        weights: &[f64],
    ) -> Result<(), ProtectError> {
        for (candidate, found) in candidates.iter().zip(all).filter(|(_, found)| found.on_front) {
            for (words, worn) in candidate.protection.worn() {
                let mut one = self.candidates(vec![worn]);
                let open: Vec<usize> = (0..one.len()).collect();
                self.round(&mut one, &open, 0)?;
                let Some(one) = one.first() else { continue };
                let most = one.stacks[0].1.stack().map_or(0, |stack| stack.levels * a_level(stack));
                let runs = &one.runs[one.worse(weights)];
                let fallen = runs.estimate(FALLEN, weights, f64::from(most));
                if found.worn.as_ref().is_none_or(|(_, worst)| worst.mean < fallen.mean) {
                    found.worn = Some((words.to_owned(), fallen));
                }
            }
        }
        Ok(())
    }
}
