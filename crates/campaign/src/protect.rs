//! What protects a stack best for what it costs: fewer levels, other racks, devices, single and in pairs.
//!
//! All are shaken by the same motions with the same quantiles of friction, so that differences are those of the
//! protections and not of luck.
//! The first round tries everything, every later one only what may still be worth it, under further motions.
//! A round of a protection in one direction is a study in a folder of its own, so what is stopped goes on from there.

mod json;
mod options;
mod page;
mod plan;
mod rank;
mod search;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack::compare;
use barrelstack::variants::{Advance, Asked, answer};
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

/// Levels of peak ground velocity (m/s) that are shaken where nothing else is asked for.
pub const VELOCITIES: [f64; 3] = [0.25, 0.50, 0.75];

/// The same where a hazard says how often each is to be expected.
const SITE_VELOCITIES: [f64; 4] = [0.15, 0.30, 0.60, 1.20];

/// How hard stacks are shaken.
#[derive(Clone, Debug, PartialEq)]
pub enum Shaking {
    /// To these levels of peak ground velocity (m/s), all alike.
    Levels(Vec<f64>),
    /// As a site is, by its hazard over peak ground velocity.
    Site(SiteHazard),
}

impl Shaking {
    /// The levels of peak ground velocity (m/s).
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

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// The stack.
    pub scenario: Scenario,
    /// How hard it is shaken.
    pub shaking: Shaking,
    /// Files of the motions, in place of the bundled and synthetic ones.
    pub records: Vec<PathBuf>,
    /// A folder of such files.
    pub folder: Option<PathBuf>,
    /// Motions of a round where none are named.
    pub motions: u32,
    /// Rounds.
    pub rounds: u32,
    /// Most that a protection may cost for a stack (US$, the middle of its range).
    pub budget: Option<f64>,
    /// Seed of everything that is drawn.
    pub seed: u32,
}

/// What a protection came to.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The protection.
    pub protection: Protection,
    /// Share of the runs that collapse at the levels of shaking, all alike; at a site how often a year.
    pub collapse: Estimate,
    /// Barrels of a stack that fall, likewise.
    pub fallen: Estimate,
    /// Barrels of a stack that burst under the central assumption, likewise.
    pub burst: Estimate,
    /// How many fewer barrels fall than of the stack as it is, under the same motions; none for itself.
    pub saved: Option<Estimate>,
    /// The same with an interval that holds for all protections that were tried at once, since the best of many tries
    /// is looked at.
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
    /// Whether nothing that was tried costs no more and loses less.
    pub on_front: bool,
    /// What it is when worst kept, and the barrels that then fall; none where it was not tried so.
    pub worn: Option<(String, Estimate)>,
}

impl Ranked {
    /// The middle of what it costs for a stack (US$).
    pub fn cost(&self) -> f64 {
        middle(&self.protection)
    }
}

/// What protects a stack best.
#[derive(Clone, Debug)]
pub struct Ranking {
    /// What was asked for.
    pub request: Request,
    /// Every protection that was tried: those first that went furthest, of these the one under which fewest barrels
    /// fall.
    pub all: Vec<Ranked>,
    /// What was not tried, and why.
    pub not_tried: Vec<(String, String)>,
    /// Runs in all.
    pub runs: usize,
    /// The page.
    pub document: Document,
}

impl Ranking {
    /// The stack as it is.
    pub fn as_it_is(&self) -> Option<&Ranked> {
        self.all.iter().find(|one| one.protection.kind == Kind::AsItIs)
    }

    /// How many protections were tried, beside the stack as it is.
    pub fn tries(&self) -> usize {
        self.all.len().saturating_sub(1)
    }

    /// The one that saves most barrels for its cost, of those that went through all rounds and save some beyond doubt:
    /// by an interval that holds for all that were tried at once.
    pub fn best(&self) -> Option<&Ranked> {
        let last = self.all.iter().map(|one| one.round).max();
        let worth = |one: &Ranked| one.saved.map_or(0.0, |saved| saved.mean / one.cost());
        let helps = self.all.iter().filter(|one| {
            Some(one.round) == last && one.saved_together.is_some_and(|saved| saved.low > 0.0)
        });
        // Of equals the first, under which fewer fall.
        helps.reduce(|best, one| if worth(one) > worth(best) { one } else { best })
    }

    /// The numbers for programs, in SI units.
    pub fn to_document(&self) -> ProtectDocument {
        ProtectDocument::of(self)
    }

    /// Runs the stack as it is and with the best protection under the motion of the scenario, and shows them side by
    /// side on the page; whether these runs went to their ends.
    ///
    /// # Errors
    /// When one of them cannot be run.
    pub fn show_before_and_after(
        &mut self,
        tell: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<bool, ProtectError> {
        let Some(best) = self.best() else { return Ok(true) };
        let own = &self.request.scenario;
        let protected = best.protection.on(own)?;
        let mut answers = Vec::new();
        for (name, scenario) in [("as it is", own), (&*best.protection.name, &protected)] {
            let answer = answer(scenario, Asked::Typical, tell)?;
            if answer.is_stopped() {
                return Ok(false);
            }
            answers.push((name.to_owned(), answer));
        }
        let answers = compare::aligned(answers, tell)?;
        if answers.iter().any(|(_, answer)| answer.decides.run.interrupted) {
            return Ok(false);
        }
        let compared = compare::document(&compare::sides(answers));
        let players = compared.blocks.into_iter().filter(|one| matches!(one, Block::Players(_)));
        self.document = page::document(self, players.collect());
        Ok(true)
    }
}

/// Why there is no ranking.
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
        /// What it is over.
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
    /// Its cases decide nothing.
    #[error(transparent)]
    Decision(#[from] DecisionError),
}

/// How far it is: runs of a round.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    /// The round, counted from 1; one more than there are where worn devices are tried.
    pub round: u32,
    /// Runs that are done.
    pub done: u64,
    /// Of so many.
    pub of: u64,
}

/// Tries everything that can be done for a stack, in folders below `folder`, and goes on where an earlier run stopped.
///
/// `tell` hears how far it is, from several threads, and may stop it.
///
/// # Errors
/// When the scenario has no stack, a record cannot be read, or a folder cannot be written.
pub fn protect(
    request: &Request,
    folder: &Path,
    options: &RunOptions,
    tell: &(dyn Fn(Reached) -> ControlFlow<()> + Sync),
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
    // What shakes it is the business of the studies.
    let mut base = request.scenario.clone();
    base.motion.source = MotionSource::None;
    let (levels, weights) = (request.shaking.levels(), request.shaking.weights());
    let mut search =
        Search { request, base: &base, folder, options, tell, levels, not_tried: Vec::new() };
    let mut singles = options::singles(&base);
    // As it is it has to stand before anything else is asked.
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
            // They meet the motions that the others have met, and half of all goes on.
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
    // What was dropped early has met fewer motions, so its mean is another one.
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

/// Of the trials that are open those that go on.
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

/// Of each kind of protection the two under which fewest barrels fall.
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

/// All pairs of some protections.
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

/// Marks those that nothing beats in both cost and barrels that fall, of those that went through all rounds.
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
