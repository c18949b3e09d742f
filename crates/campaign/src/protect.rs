//! Ranking of protections by benefit and cost: fewer levels, other racks, devices, single and in pairs.
//!
//! All are shaken by the same motions with the same quantiles of friction, so that differences are those of the
//! protections and not of sampling.
//! The first round tries everything, later ones only the contenders, under further motions.
//! A round of a protection in one direction is a study in a folder of its own, so that an interrupted ranking resumes.

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
use barrelstack_report::{Block, Document};

use crate::decision::{DecisionError, SiteHazard};
use crate::ground::GroundError;
use crate::run::RunFailure;
use crate::scenario::{MotionSource, Scenario, ScenarioError, View};
use crate::study::{RunOptions, StudyError};

pub use json::ProtectDocument;
pub use options::{Kind, Protection};
pub(crate) use options::{changed, slug};
pub(crate) use plan::{NAPA, shaken};
pub use rank::Estimate;

use rank::{FALLEN, Runs, weights};
use search::{Search, Trial};

/// Default levels of peak ground velocity (m/s).
pub const VELOCITIES: [f64; 3] = [0.25, 0.50, 0.75];

/// Default levels where a hazard curve weights them.
const SITE_VELOCITIES: [f64; 4] = [0.15, 0.30, 0.60, 1.20];

/// Strength of shaking.
#[derive(Clone, Debug, PartialEq)]
pub enum Shaking {
    /// These levels of peak ground velocity (m/s), equally weighted.
    Levels(Vec<f64>),
    /// The hazard of a site, over peak ground velocity.
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

/// Request for a ranking.
#[derive(Clone, Debug)]
pub struct Request {
    /// The stack.
    pub scenario: Scenario,
    /// Strength of its shaking.
    pub shaking: Shaking,
    /// Files of the motions, in place of the bundled and synthetic ones.
    pub records: Vec<PathBuf>,
    /// A folder of such files.
    pub folder: Option<PathBuf>,
    /// Number of motions of a round where none are named.
    pub motions: u32,
    /// Number of rounds.
    pub rounds: u32,
    /// Upper limit of the cost of a protection for a stack (US$, the middle of its range).
    pub budget: Option<f64>,
    /// Seed of everything that is drawn.
    pub seed: u32,
}

/// Results of a protection.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The protection.
    pub protection: Protection,
    /// Share of the runs that collapse, over equally weighted levels of shaking; at a site, the number of collapses per
    /// year.
    pub collapse: Estimate,
    /// Barrels of a stack that fall, likewise.
    pub fallen: Estimate,
    /// Barrels of a stack that burst under the central assumption, likewise.
    pub burst: Estimate,
    /// Reduction of fallen barrels against the stack as it is, under the same motions; `None` for itself.
    pub saved: Option<Estimate>,
    /// The same reduction with an interval that holds for all tried protections simultaneously, since the best of many
    /// is reported.
    pub saved_together: Option<Estimate>,
    /// The direction of shaking in which more barrels fall.
    pub direction: View,
    /// Motions under which it was run.
    pub motions: usize,
    /// Runs in both directions.
    pub runs: usize,
    /// Runs without a verdict.
    pub left_out: usize,
    /// Runs whose stack fell under its own weight, before it was shaken.
    pub fallen_at_rest: usize,
    /// The last round in which it was run, counted from 1.
    pub round: u32,
    /// `true` if no tried protection costs no more and loses less.
    pub on_front: bool,
    /// Its worst state of maintenance, and the barrels that then fall; `None` where not tried.
    pub worn: Option<(String, Estimate)>,
}

impl Ranked {
    /// Returns the middle of its cost for a stack (US$).
    pub fn cost(&self) -> f64 {
        middle(&self.protection)
    }
}

/// Ranking of protections.
#[derive(Clone, Debug)]
pub struct Ranking {
    /// The request.
    pub request: Request,
    /// Every protection that was tried, sorted by its last round, the latest first, then by the mean number of fallen
    /// barrels.
    pub all: Vec<Ranked>,
    /// Protections that were not tried, with reasons.
    pub not_tried: Vec<(String, String)>,
    /// Runs in all.
    pub runs: usize,
    /// The page.
    pub document: Document,
}

impl Ranking {
    /// Returns the stack as it is.
    pub fn as_it_is(&self) -> Option<&Ranked> {
        self.all.iter().find(|one| one.protection.kind == Kind::AsItIs)
    }

    /// Returns the number of protections tried, besides the stack as it is.
    pub fn tries(&self) -> usize {
        self.all.len().saturating_sub(1)
    }

    /// Returns the protection that saves most barrels for its cost, of those that went through all rounds and whose
    /// saving is significant by an interval that holds for all tried protections simultaneously.
    pub fn best(&self) -> Option<&Ranked> {
        let last = self.all.iter().map(|one| one.round).max();
        let worth = |one: &Ranked| one.saved.map_or(0.0, |saved| saved.mean / one.cost());
        let helps = self.all.iter().filter(|one| {
            Some(one.round) == last && one.saved_together.is_some_and(|saved| saved.low > 0.0)
        });
        // Of equals the first, under which fewer fall.
        helps.reduce(|best, one| if worth(one) > worth(best) { one } else { best })
    }

    /// Returns the numbers for programs, in SI units.
    pub fn to_document(&self) -> ProtectDocument {
        ProtectDocument::of(self)
    }

    /// Runs the stack as it is and with the best protection under the motion of the scenario, and shows them side by
    /// side on the page; returns `true` if these runs finished.
    ///
    /// # Errors
    /// When one of them cannot be run.
    pub fn show_before_and_after(
        &mut self,
        report: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<bool, ProtectError> {
        let Some(best) = self.best() else { return Ok(true) };
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

/// Error of a ranking.
#[derive(Debug, thiserror::Error)]
pub enum ProtectError {
    /// A free scene has no levels, racks or devices.
    #[error(
        "\"{0}\" is a free scene, and protections are those of stacks of barrels on racks: take the scenario of a stack"
    )]
    NoStack(String),
    /// The hazard is over another measure.
    #[error(
        "the hazard in {file} is over {measure}, but motions are scaled by peak ground velocity; give the hazard over pgv"
    )]
    Hazard {
        /// The file.
        file: String,
        /// The measure of the hazard.
        measure: String,
    },
    /// The scenario does not read back.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Its motion cannot be read.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A protected stack cannot be built, or does not stand.
    #[error(transparent)]
    Stack(#[from] RunFailure),
    /// A study cannot be run.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Its cases do not support a decision.
    #[error(transparent)]
    Decision(#[from] DecisionError),
}

/// Progress: runs of a round.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    /// The round, counted from 1; worn devices are tried in one more.
    pub round: u32,
    /// Number of finished runs.
    pub done: u64,
    /// Number of all runs.
    pub of: u64,
}

/// Tries all protections of a stack, in folders below `folder`, and resumes earlier runs.
///
/// `report` receives the progress, from several threads, and may cancel.
///
/// # Errors
/// When the scenario has no stack, a record cannot be read, or a folder cannot be written.
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
    // The studies set the motions.
    let mut base = request.scenario.clone();
    base.motion.source = MotionSource::None;
    let (levels, weights) = (request.shaking.levels(), request.shaking.weights());
    let mut search =
        Search { request, base: &base, folder, options, report, levels, not_tried: Vec::new() };
    let mut singles = options::singles(&base);
    // The stack as it is has to stand before anything else is tried.
    let mut trials = vec![Trial::new(&base, singles.remove(0))?];
    trials.extend(search.trials(singles));
    let mut open: Vec<usize> = (0..trials.len()).collect();
    for round in 0..request.rounds {
        search.round(&mut trials, &open, round)?;
        open = contenders(&trials, &open, &weights);
        if round == 0 && request.rounds > 1 {
            let pairs = pairs(&base, &best_of_kinds(&trials, &open, &weights));
            let first = trials.len();
            trials.extend(search.trials(pairs));
            let added: Vec<usize> = (first..trials.len()).collect();
            // They run under the motions of the first round, as the others did, and half of all continue.
            search.round(&mut trials, &added, 0)?;
            open.extend(added);
            open = contenders(&trials, &open, &weights);
        }
    }
    let tries = trials.len() - 1;
    let mut all: Vec<Ranked> =
        trials.iter().map(|trial| ranked(trial, &trials[0], &weights, tries)).collect();
    mark_front(&mut all);
    search.worn(&trials, &mut all, &weights)?;
    // Trials that were dropped early have run under fewer motions, so that their means do not compare.
    all.sort_by(|a, b| {
        let by_mean = a.fallen.mean.total_cmp(&b.fallen.mean).then(a.cost().total_cmp(&b.cost()));
        b.round.cmp(&a.round).then(by_mean)
    });
    let runs = all.iter().map(|one| one.runs).sum();
    let not_tried = search.not_tried;
    let mut ranking =
        Ranking { request: request.clone(), all, not_tried, runs, document: Document::default() };
    ranking.document = page::document(&ranking, Vec::new());
    Ok(ranking)
}

/// Returns the open trials that continue.
fn contenders(trials: &[Trial], open: &[usize], weights: &[f64]) -> Vec<usize> {
    let judged = |at: &usize| {
        let trial = &trials[*at];
        (&trial.runs[trial.worse(weights)], middle(&trial.protection))
    };
    let judged: Vec<(&Runs, f64)> = open.iter().map(judged).collect();
    let most = trials.first().map_or(0.0, Trial::barrels);
    let kept = rank::contenders(&judged, weights, most);
    kept.into_iter().map(|at| open[at]).collect()
}

/// Returns the two protections of each kind under which fewest barrels fall.
fn best_of_kinds<'a>(trials: &'a [Trial], open: &[usize], weights: &[f64]) -> Vec<&'a Protection> {
    let fallen =
        |trial: &Trial| trial.runs[trial.worse(weights)].estimate(FALLEN, weights, 1.0).mean;
    let mut sorted: Vec<&Trial> = open.iter().map(|at| &trials[*at]).collect();
    sorted.sort_by(|a, b| fallen(a).total_cmp(&fallen(b)));
    let mut best: Vec<&Protection> = Vec::new();
    for protection in sorted.into_iter().map(|trial| &trial.protection) {
        if best.iter().filter(|known| known.kind == protection.kind).count() < 2 {
            best.push(protection);
        }
    }
    best
}

/// Returns all pairs of some protections.
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

fn ranked(trial: &Trial, base: &Trial, weights: &[f64], tries: usize) -> Ranked {
    let worse = trial.worse(weights);
    let view = &trial.stacks[worse].0;
    let runs = &trial.runs[worse];
    let most = trial.barrels();
    let before = &base.runs[base.worse(weights)];
    let saved = |tries: usize| {
        let changed = trial.protection.kind != Kind::AsItIs;
        let range = (weights, most.max(base.barrels()));
        changed.then(|| runs.less_than(before, FALLEN, range, tries)).flatten()
    };
    Ranked {
        protection: trial.protection.clone(),
        collapse: runs.estimate(|run| run.collapsed, weights, 1.0),
        fallen: runs.estimate(FALLEN, weights, most),
        burst: runs.estimate(|run| run.burst, weights, most),
        saved: saved(1),
        saved_together: saved(tries),
        direction: *view,
        motions: runs.motions(),
        runs: trial.runs.iter().map(|runs| runs.count).sum(),
        left_out: trial.runs.iter().map(|runs| runs.left_out).sum(),
        fallen_at_rest: trial.runs.iter().map(|runs| runs.fallen_at_rest).sum(),
        round: trial.round,
        on_front: false,
        worn: None,
    }
}

/// Marks the Pareto front of cost and fallen barrels, among those that went through all rounds.
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
