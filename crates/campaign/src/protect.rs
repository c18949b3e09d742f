//! Ranking of protections of a stack by benefit and cost.
//!
//! A protection is a lower stack, another rack, a device, or a pair of these. All protections are run under the same
//! motions and with the same quantiles of friction, so that differences between their results come from the protections
//! and not from sampling. The first round tries all protections; later rounds try only the contenders, under further
//! motions. Each round of a protection in one direction is a study in its own folder, so that an interrupted ranking
//! resumes from there.

mod json;
mod options;
mod page;
mod plan;
mod rank;
mod search;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack::compare;
use barrelstack::variants::{Advance, RunChoice, answer};
use barrelstack_fragility::share_less;
use barrelstack_report::{Block, Document};

use crate::decision::{DecisionError, SiteHazard};
use crate::direction::Direction;
use crate::ground::GroundError;
use crate::pool;
use crate::run::RunFailure;
use crate::scenario::{MotionSource, Scenario, ScenarioError};
use crate::study::{RunOptions, StudyError};

pub use json::ProtectDocument;
pub use options::{Kind, Protection};
pub(crate) use options::{changed, singles, slug};
pub(crate) use plan::{NAPA, shaken};
pub use rank::Estimate;

use rank::{FALLEN, Runs, weights};
use search::{Candidate, Search};

/// Default levels of peak ground velocity (m/s).
pub const VELOCITIES: [f64; 3] = [0.25, 0.50, 0.75];

/// Default levels of peak ground velocity (m/s) if a hazard curve determines the weights of the levels.
const SITE_VELOCITIES: [f64; 4] = [0.15, 0.30, 0.60, 1.20];

/// Levels of shaking and their weights.
#[derive(Clone, Debug, PartialEq)]
pub enum Shaking {
    /// Levels of peak ground velocity (m/s), equally weighted.
    Levels(Vec<f64>),
    /// Hazard curve of a site for peak ground velocity, from which the weights of the levels follow.
    Site(SiteHazard),
}

impl Shaking {
    /// Returns the levels of peak ground velocity (m/s).
    fn levels(&self) -> &[f64] {
        match self {
            Self::Levels(levels) => levels,
            Self::Site(_) => &SITE_VELOCITIES,
        }
    }

    fn weights(&self) -> Vec<f64> {
        match self {
            Self::Levels(levels) => weights(levels, None),
            Self::Site(site) => weights(&SITE_VELOCITIES, Some(&site.hazard)),
        }
    }
}

/// Inputs of a ranking.
#[derive(Clone, Debug)]
pub struct Request {
    /// Scenario of the stack.
    pub scenario: Scenario,
    /// Levels of shaking, or the hazard curve of the site.
    pub shaking: Shaking,
    /// Record files that replace the bundled record and the synthetic motions.
    pub records: Vec<PathBuf>,
    /// Folder of record files, which replace the bundled record and the synthetic motions.
    pub folder: Option<PathBuf>,
    /// Number of motions in each round if no records are given.
    pub motions: u32,
    /// Number of rounds.
    pub rounds: u32,
    /// Maximum cost (US$) of a protection of one stack; `None` for no limit. A protection whose cost range has a
    /// higher midpoint is not tried.
    pub budget: Option<f64>,
    /// Seed of all random numbers.
    pub seed: u32,
}

/// Results of one protection.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// Protection to which the results belong.
    pub protection: Protection,
    /// Probability of collapse, averaged over the levels of shaking; for a site, the mean number of collapses
    /// per year.
    pub collapse: Estimate,
    /// Number of barrels that fall, averaged over the levels of shaking; for a site, the mean number per
    /// year.
    pub fallen: Estimate,
    /// Number of barrels that burst, averaged over the levels of shaking; for a site, the mean number per year.
    ///
    /// The number follows from the central one of the three assumptions about breakage
    /// ([`Breakage::RANGE`](barrelstack::breakage::Breakage::RANGE)).
    pub burst: Estimate,
    /// Reduction of the number of fallen barrels compared with the unprotected stack, under the same motions.
    /// `None` for the unprotected stack, or if fewer than two motions are common to both stacks.
    pub saved: Option<Estimate>,
    /// The same reduction as in `saved`, but with an interval that holds for all tried protections simultaneously,
    /// because the best of many protections is reported. `None` if `saved` is `None`.
    pub saved_together: Option<Estimate>,
    /// Direction of shaking in which more barrels fall.
    pub direction: Direction,
    /// Number of motions under which the protection was run.
    pub motions: usize,
    /// Number of runs, in both directions.
    pub runs: usize,
    /// Number of runs that are left out because they have no verdict, for example because they failed.
    pub left_out: usize,
    /// Number of runs whose stack fell under its own weight, before it was shaken.
    pub fallen_at_rest: usize,
    /// Last round in which the protection was run, counted from 1.
    pub round: u32,
    /// `true` if the protection is on the Pareto front: no other protection that was run in all rounds costs
    /// at most as much and loses fewer barrels.
    pub on_front: bool,
    /// Description of the worn state in which the most barrels fall, and the number of barrels that fall in it; `None`
    /// if no worn state was tried.
    pub worn: Option<(String, Estimate)>,
    /// Range that contains, with a probability of 95 %, the probability of collapse (for a site, the annual rate of
    /// collapse), given the uncertain constants of the seats and the sampling error. `None` if it is unknown, or if the
    /// protection was not run in all rounds.
    pub range: Option<[f64; 2]>,
    /// Numbers of barrels that fall, one for each draw of the uncertain constants and the regression coefficients.
    /// Draws with the same index have the same constants for all protections. Empty if `range` is `None` or if there
    /// are no uncertain constants.
    pub draws: Vec<f64>,
    /// Share of the draws of the uncertain constants in which fewer barrels fall than with the unprotected stack; a
    /// draw with equal numbers counts as one half. `None` for the unprotected stack, or if `draws` is empty for either
    /// stack.
    pub better_than_as_it_is: Option<f64>,
    /// Share of the draws of the uncertain constants in which fewer barrels fall than with the next protection in the
    /// ranking; a draw with equal numbers counts as one half. `None` for the last protection, or if `draws` is empty
    /// for either protection.
    pub better_than_next: Option<f64>,
}

impl Ranked {
    /// Returns the midpoint of the cost range for one stack (US$).
    pub fn cost(&self) -> f64 {
        middle(&self.protection)
    }
}

/// Ranking of all protections of a stack.
#[derive(Clone, Debug)]
pub struct Ranking {
    /// Inputs of the ranking.
    pub request: Request,
    /// Results of every protection that was tried. They are sorted by last round (the latest first), and then
    /// by the mean number of fallen barrels.
    pub all: Vec<Ranked>,
    /// Names of the protections that were not tried, each with the reason.
    pub not_tried: Vec<(String, String)>,
    /// Total number of runs.
    pub runs: usize,
    /// Report page.
    pub document: Document,
}

impl Ranking {
    /// Returns the results of the unprotected stack; `None` if [`Ranking::all`] does not contain them.
    pub fn as_it_is(&self) -> Option<&Ranked> {
        self.all.iter().find(|one| one.protection.kind == Kind::AsItIs)
    }

    /// Returns the number of protections that were tried, excluding the unprotected stack.
    pub fn tries(&self) -> usize {
        self.all.len().saturating_sub(1)
    }

    /// Returns the protection that saves the most barrels per dollar of its cost; `None` if no protection helps
    /// significantly.
    ///
    /// Only protections that were run in all rounds are considered, and a saving is significant if the
    /// interval that holds for all tried protections simultaneously excludes zero.
    pub fn best(&self) -> Option<&Ranked> {
        let last = self.all.iter().map(|one| one.round).max();
        let worth = |one: &Ranked| one.saved.map_or(0.0, |saved| saved.mean / one.cost());
        let helps = self.all.iter().filter(|one| {
            Some(one.round) == last && one.saved_together.is_some_and(|saved| saved.low > 0.0)
        });
        // Of equally good protections the first is kept, because fewer barrels fall with it.
        helps.reduce(|best, one| if worth(one) > worth(best) { one } else { best })
    }

    /// Returns the results as a machine-readable document, in SI units.
    pub fn to_document(&self) -> ProtectDocument {
        ProtectDocument::of(self)
    }

    /// Runs the stack unprotected and with the best protection under the motion of the scenario, and shows both runs
    /// side by side on the page. Three-dimensional stacks are not shown.
    ///
    /// Returns `true` if both runs finished.
    ///
    /// # Errors
    /// If one of the two stacks cannot be run.
    pub fn show_before_and_after(
        &mut self,
        report: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<bool, ProtectError> {
        // The animations of the page show planes only.
        let Some(best) = self.best().filter(|best| best.direction != Direction::Space) else {
            return Ok(true);
        };
        let own = &self.request.scenario;
        let protected = best.protection.on(own)?;
        let mut answers = Vec::new();
        for (name, scenario) in [("as it is", own), (&*best.protection.name, &protected)] {
            let answer = answer(scenario, RunChoice::Typical, report)?;
            if answer.is_stopped() {
                return Ok(false);
            }
            answers.push((name.to_owned(), answer));
        }
        let answers = compare::aligned(answers, report)?;
        if answers.iter().any(|(_, answer)| answer.decides.run.interrupted) {
            return Ok(false);
        }
        let compared = compare::document(&compare::sides(answers));
        let players = compared.blocks.into_iter().filter(|one| matches!(one, Block::Players(_)));
        self.document = page::document(self, players.collect());
        Ok(true)
    }
}

/// Reason why a ranking fails.
#[derive(Debug, thiserror::Error)]
pub enum ProtectError {
    /// The scenario is a free scene, which has no levels, racks or devices.
    #[error(
        "\"{0}\" is a free scene, but protections are for stacks of barrels on racks: use the scenario of a stack"
    )]
    NoStack(String),
    /// The hazard curve is for an intensity measure other than peak ground velocity.
    #[error(
        "the hazard curve in {file} is for {measure}, but motions are scaled by peak ground velocity; give a hazard curve for pgv"
    )]
    Hazard {
        /// Name of the file of the hazard curve.
        file: String,
        /// Intensity measure of the hazard curve.
        measure: String,
    },
    /// The scenario is not valid after a protection has been applied.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The motion of the scenario cannot be read.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A stack cannot be built, or does not stand under its own weight.
    #[error(transparent)]
    Stack(#[from] RunFailure),
    /// A study cannot be run.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The cases of a study cannot be evaluated.
    #[error(transparent)]
    Decision(#[from] DecisionError),
}

/// Progress of a ranking: runs of the current round.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    /// Current round, counted from 1.
    pub round: u32,
    /// Number of finished runs of the round.
    pub done: u64,
    /// Number of runs of the round.
    pub of: u64,
}

/// Tries all protections of a stack and ranks them.
///
/// The studies are stored in folders below `folder`, so that an interrupted ranking resumes from there.
/// `report` receives the progress and is called from several threads. It cancels the ranking by returning
/// [`ControlFlow::Break`].
///
/// # Errors
/// If the scenario has no stack, a record cannot be read, or a folder cannot be written.
pub fn protect(
    request: &Request,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(Reached) -> ControlFlow<()> + Sync),
) -> Result<Ranking, ProtectError> {
    if request.scenario.stack().is_none() {
        return Err(ProtectError::NoStack(request.scenario.title.clone()));
    }
    if let Shaking::Site(site) = &request.shaking
        && site.measure != "pgv"
    {
        let (file, measure) = (site.file.clone(), site.measure.clone());
        return Err(ProtectError::Hazard { file, measure });
    }
    // The motion of the scenario is removed, since the studies set their own.
    let mut base = request.scenario.clone();
    base.motion.source = MotionSource::None;
    let (levels, weights) = (request.shaking.levels(), request.shaking.weights());
    let mut search =
        Search { request, base: &base, folder, options, report, levels, not_tried: Vec::new() };
    let mut singles = singles(&base);
    // The unprotected stack must stand; otherwise no protection is tried.
    let mut candidates = vec![Candidate::new(&base, singles.remove(0))?];
    candidates.extend(search.candidates(singles));
    let mut open: Vec<usize> = (0..candidates.len()).collect();
    for round in 0..request.rounds {
        search.round(&mut candidates, &open, round)?;
        open = contenders(&candidates, &open, &weights);
        if round == 0 && request.rounds > 1 {
            let pairs = pairs(&base, &best_of_kinds(&candidates, &open, &weights));
            let first = candidates.len();
            candidates.extend(search.candidates(pairs));
            let added: Vec<usize> = (first..candidates.len()).collect();
            // Pairs run under the motions of the first round, as the single protections did, and half of all candidates
            // continue.
            search.round(&mut candidates, &added, 0)?;
            open.extend(added);
            open = contenders(&candidates, &open, &weights);
        }
    }
    let tries = candidates.len() - 1;
    let mut all: Vec<Ranked> = candidates
        .iter()
        .map(|candidate| ranked(candidate, &candidates[0], &weights, tries))
        .collect();
    mark_front(&mut all);
    let most = candidates.iter().map(Candidate::barrels).fold(0.0, f64::max);
    over_constants(&mut all, &candidates, levels, &weights, most);
    search.worn(&candidates, &mut all, &weights)?;
    // Candidates that were dropped early ran under fewer motions, so that their means cannot be compared with the others.
    all.sort_by(|a, b| {
        let by_mean = a.fallen.mean.total_cmp(&b.fallen.mean).then(a.cost().total_cmp(&b.cost()));
        b.round.cmp(&a.round).then(by_mean)
    });
    compare_draws(&mut all);
    let runs = all.iter().map(|one| one.runs).sum();
    let not_tried = search.not_tried;
    let mut ranking =
        Ranking { request: request.clone(), all, not_tried, runs, document: Document::default() };
    ranking.document = page::document(&ranking, Vec::new());
    Ok(ranking)
}

/// Selects the candidates that continue in the next round from the candidates with the indices `open`, and returns
/// their indices.
fn contenders(candidates: &[Candidate], open: &[usize], weights: &[f64]) -> Vec<usize> {
    let judged = |at: &usize| {
        let candidate = &candidates[*at];
        (&candidate.runs[candidate.worse(weights)], middle(&candidate.protection))
    };
    let judged: Vec<(&Runs, f64)> = open.iter().map(judged).collect();
    let most = candidates.first().map_or(0.0, Candidate::barrels);
    let kept = rank::contenders(&judged, weights, most);
    kept.into_iter().map(|at| open[at]).collect()
}

/// Returns, for each kind of protection, the two protections with which the fewest barrels fall.
fn best_of_kinds<'a>(
    candidates: &'a [Candidate],
    open: &[usize],
    weights: &[f64],
) -> Vec<&'a Protection> {
    let fallen = |candidate: &Candidate| {
        candidate.runs[candidate.worse(weights)].estimate(FALLEN, weights, 1.0).mean
    };
    let mut sorted: Vec<&Candidate> = open.iter().map(|at| &candidates[*at]).collect();
    sorted.sort_by(|a, b| fallen(a).total_cmp(&fallen(b)));
    let mut best: Vec<&Protection> = Vec::new();
    for protection in sorted.into_iter().map(|candidate| &candidate.protection) {
        if best.iter().filter(|known| known.kind == protection.kind).count() < 2 {
            best.push(protection);
        }
    }
    best
}

/// Returns all pairs of the given protections that can be combined on a stack.
fn pairs(base: &Scenario, of: &[&Protection]) -> Vec<Protection> {
    let all = of.iter().enumerate();
    all.flat_map(|(at, one)| {
        of[at + 1..].iter().filter_map(|other| options::pair(base, one, other))
    })
    .collect()
}

fn middle(protection: &Protection) -> f64 {
    0.5 * (protection.cost[0] + protection.cost[1])
}

fn ranked(candidate: &Candidate, base: &Candidate, weights: &[f64], tries: usize) -> Ranked {
    let worse = candidate.worse(weights);
    let view = &candidate.stacks[worse].0;
    let runs = &candidate.runs[worse];
    let most = candidate.barrels();
    let before = &base.runs[base.worse(weights)];
    let saved = |tries: usize| {
        let changed = candidate.protection.kind != Kind::AsItIs;
        let range = (weights, most.max(base.barrels()));
        changed.then(|| runs.less_than(before, FALLEN, range, tries)).flatten()
    };
    Ranked {
        protection: candidate.protection.clone(),
        collapse: runs.estimate(|run| run.collapsed, weights, 1.0),
        fallen: runs.estimate(FALLEN, weights, most),
        burst: runs.estimate(|run| run.burst, weights, most),
        saved: saved(1),
        saved_together: saved(tries),
        direction: *view,
        motions: runs.motions(),
        runs: candidate.runs.iter().map(|runs| runs.count).sum(),
        left_out: candidate.runs.iter().map(|runs| runs.left_out).sum(),
        fallen_at_rest: candidate.runs.iter().map(|runs| runs.fallen_at_rest).sum(),
        round: candidate.round,
        on_front: false,
        worn: None,
        range: None,
        draws: Vec::new(),
        better_than_as_it_is: None,
        better_than_next: None,
    }
}

/// Computes the effect of the uncertain constants on the protections that were run in all rounds, and stores it in
/// [`Ranked::range`] and [`Ranked::draws`].
fn over_constants(
    all: &mut [Ranked],
    candidates: &[Candidate],
    levels: &[f64],
    weights: &[f64],
    most: f64,
) {
    let last = candidates.iter().map(|candidate| candidate.round).max();
    let finalists: Vec<usize> =
        (0..candidates.len()).filter(|at| Some(candidates[*at].round) == last).collect();
    let over = |at: &usize| {
        let candidate = &candidates[*at];
        candidate.runs[candidate.worse(weights)].over_constants(levels, weights, most)
    };
    let found = pool::map(&finalists, over, &|_| ());
    for (at, over) in finalists.into_iter().zip(found) {
        (all[at].range, all[at].draws) = (over.range, over.fallen);
    }
}

/// Computes, for every protection, the shares of draws in which it is better than the unprotected stack and than the
/// next protection.
fn compare_draws(all: &mut [Ranked]) {
    let better = |one: &Ranked, other: &Ranked| {
        let known = !one.draws.is_empty() && one.draws.len() == other.draws.len();
        known.then(|| share_less(&one.draws, &other.draws))
    };
    let base = all.iter().position(|one| one.protection.kind == Kind::AsItIs);
    for at in 0..all.len() {
        let next = all.get(at + 1).and_then(|next| better(&all[at], next));
        let as_it_is =
            base.filter(|base| *base != at).and_then(|base| better(&all[at], &all[base]));
        (all[at].better_than_next, all[at].better_than_as_it_is) = (next, as_it_is);
    }
}

/// Marks the protections on the Pareto front of cost and fallen barrels, among those that were run in all
/// rounds.
fn mark_front(all: &mut [Ranked]) {
    let last = all.iter().map(|one| one.round).max();
    let mut finalists: Vec<&mut Ranked> =
        all.iter_mut().filter(|one| Some(one.round) == last).collect();
    let points: Vec<(f64, f64)> =
        finalists.iter().map(|one| (one.cost(), one.fallen.mean)).collect();
    for at in rank::front(&points) {
        finalists[at].on_front = true;
    }
}
