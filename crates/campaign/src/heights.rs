//! Safe heights: probability of collapse of stacks by height, direction and strength of shaking.
//!
//! Stacks of two or more levels on one kind of rack are shaken by the bundled record of South Napa, by synthetic
//! motions and by the user's own records. All motions are scaled to the same levels of peak ground velocity. Friction,
//! stiffness and damping of the seats are drawn at random for each run. The stacks are shaken in the planes across and
//! along their barrels, or in three dimensions.

mod field;
mod json;
mod margin;
mod page;
mod plan;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack::variants::{Fitted, Unknown};
use barrelstack_fragility::{Interval, Stripe, clopper_pearson};
use barrelstack_report::Document;

use crate::decision::{Cases, DecisionError, JudgedCase, LimitCurve, LimitState};
use crate::direction::{Direction, check};
use crate::pool;
use crate::run::RunFailure;
use crate::scenario::View;
use crate::study::{Collected, Progress, RunOptions, Study, StudyError, Value};
use crate::system;
use crate::uncertain::Sample;

pub use json::HeightsDocument;
pub use plan::{HIGHEST, LOWEST, VELOCITIES};
pub(crate) use plan::{quoted, synthetic};

/// Inputs of a study of safe heights.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Name of the rack in the catalog.
    pub rack: String,
    /// Name of the barrel in the catalog.
    pub barrel: String,
    /// Paths of the user's own records, in addition to the bundled record.
    pub records: Vec<PathBuf>,
    /// Number of synthetic motions, in addition to the bundled record.
    pub synthetic: u32,
    /// Seed of all random numbers.
    pub seed: u32,
    /// Number of levels of the highest stacks, from [`LOWEST`] to [`HIGHEST`].
    pub highest: u32,
    /// `true` if the stacks are shaken in three dimensions, in a horizontal direction that is drawn for every run;
    /// `false` for the planes across and along the barrels.
    pub in_space: bool,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            rack: "two-barrel".to_owned(),
            barrel: "bordeaux-225".to_owned(),
            records: Vec::new(),
            synthetic: 22,
            seed: 1,
            highest: HIGHEST,
            in_space: false,
        }
    }
}

impl Request {
    /// Returns the numbers of levels of the stacks, from [`LOWEST`] to `highest`.
    pub fn heights(&self) -> impl Iterator<Item = u32> + use<> {
        LOWEST..=self.highest
    }

    /// Returns the directions in which the stacks are shaken.
    pub fn directions(&self) -> Vec<Direction> {
        if self.in_space {
            return vec![Direction::Space];
        }
        View::ALL.into_iter().map(Direction::Plane).collect()
    }
}

/// Results of stacks of one height, shaken in one direction.
#[derive(Clone, Debug)]
pub struct Height {
    /// Number of levels of the stack.
    pub levels: u32,
    /// Direction of the shaking.
    pub direction: Direction,
    /// Fragility of collapse against peak ground velocity (PGV).
    pub by_velocity: LimitCurve,
    /// Fragility of collapse against peak ground acceleration (PGA).
    pub by_acceleration: LimitCurve,
    /// Mean share of the barrels that fall, for each stripe of `by_velocity`.
    pub fallen: Vec<f64>,
    /// Static margin (m/s²): the largest steady horizontal acceleration that the stack withstands, with the friction
    /// and the seats from the catalog; `None` if the stack stands even at 1 g. For three-dimensional shaking, it is the
    /// smaller of the margins across and along the barrels.
    pub static_margin: Option<f64>,
    /// Effect of the uncertain constants of the seats on the share of collapses, for each stripe of `by_velocity`; `None`
    /// if a run has no verdict, or if there are too few runs.
    pub effects: Vec<Option<Fitted>>,
}

/// Results of stacks of one height, shaken in one direction at one level of PGV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtLevel {
    /// Numbers of runs and of collapses.
    pub stripe: Stripe,
    /// Bounds of the probability of collapse; each is a one-sided bound with 95 % confidence (Clopper and
    /// Pearson).
    pub interval: Interval,
    /// Mean share of the barrels that fall.
    pub fallen: f64,
    /// 95 % interval of the probability of collapse. It accounts for the uncertain constants of the seats and for the
    /// sampling error. `None` if a run has no verdict, or if there are too few runs.
    pub range: Option<[f64; 2]>,
}

/// Returns the lower and upper bound of the probability of collapse, each with 95 % confidence.
///
/// The bounds are one-sided, so that a headline can state the upper bound alone.
fn known(stripe: &Stripe) -> Interval {
    clopper_pearson(stripe.failures, stripe.cases, 0.90)
}

impl Height {
    /// Returns the results at a level of PGV (m/s), such as one of [`VELOCITIES`]; `None` if no run at that level has a
    /// verdict.
    pub fn at(&self, velocity: f64) -> Option<AtLevel> {
        let curve = &self.by_velocity;
        // Levels are rounded when written as text in cm/s.
        let same = |stripe: &Stripe| (stripe.intensity / velocity - 1.0).abs() < 1e-9;
        let at = curve.stripes.iter().position(same)?;
        Some(AtLevel {
            stripe: curve.stripes[at],
            interval: known(&curve.stripes[at]),
            fallen: *self.fallen.get(at)?,
            range: self.effects.get(at)?.as_ref().map(|effect| effect.range),
        })
    }

    /// Returns the uncertain constant with the largest effect on the share of collapses at a given PGV (m/s); `None` if
    /// no constant is decisive there ([`Fitted::decisive`]).
    pub fn decisive(&self, velocity: f64) -> Option<&Unknown> {
        let same = |stripe: &Stripe| (stripe.intensity / velocity - 1.0).abs() < 1e-9;
        let at = self.by_velocity.stripes.iter().position(same)?;
        self.effects.get(at)?.as_ref()?.decisive()
    }
}

/// Run of a stack under the unscaled bundled record.
#[derive(Clone, Debug, PartialEq)]
pub struct AsRecorded {
    /// Number of levels of the stack.
    pub levels: u32,
    /// Direction of the shaking.
    pub direction: Direction,
    /// Name of the motion, which consists of one horizontal component of the bundled record and the vertical component.
    pub motion: String,
    /// `true` if the stack collapsed.
    pub collapsed: bool,
    /// Share of the barrels that fell.
    pub fallen: f64,
    /// Peak ground velocity (m/s).
    pub velocity: f64,
    /// Peak ground acceleration (m/s²).
    pub acceleration: f64,
}

/// Results of a study of safe heights.
#[derive(Clone, Debug)]
pub struct Heights {
    /// Inputs of the study.
    pub request: Request,
    /// Results of every height in every direction.
    pub heights: Vec<Height>,
    /// Runs under the unscaled bundled record.
    pub recorded: Vec<AsRecorded>,
    /// Number of motions under which every stack was run.
    pub motions: usize,
    /// Total number of runs.
    pub runs: usize,
    /// Number of runs without a verdict.
    pub left_out: usize,
    /// Number of runs whose stack fell under its own weight, before it was shaken.
    pub fallen_at_rest: usize,
    /// Warnings about runs that ended before everything had come to rest.
    pub ends: Vec<String>,
    /// Warnings for the reader.
    pub warnings: Vec<String>,
    /// Report page.
    pub document: Document,
}

impl Heights {
    /// Returns the results of stacks with a number of levels in a direction; `None` if such stacks were not
    /// run.
    pub fn of(&self, levels: u32, direction: Direction) -> Option<&Height> {
        let same = |height: &&Height| height.levels == levels && height.direction == direction;
        self.heights.iter().find(same)
    }

    /// Returns the results as a machine-readable document, in SI units.
    pub fn to_document(&self) -> HeightsDocument {
        HeightsDocument::of(self)
    }
}

/// Reason why a study of safe heights fails.
#[derive(Debug, thiserror::Error)]
pub enum HeightsError {
    /// The rack is not in the catalog. The strings are its name and the advice to name another rack.
    #[error("there is no rack `{0}`; {1}")]
    Rack(String, String),
    /// The barrel is not in the catalog. The strings are its name and the advice to name another barrel.
    #[error("there is no barrel `{0}`; {1}")]
    Barrel(String, String),
    /// The highest stack has too few levels, or too many.
    #[error("the highest stack cannot have {0} levels; state {LOWEST} to {HIGHEST}")]
    Levels(u32),
    /// A study cannot be run.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A stack cannot be built, or does not come to rest.
    #[error(transparent)]
    Stack(RunFailure),
    /// The cases of a study cannot be evaluated.
    #[error(transparent)]
    Decision(#[from] DecisionError),
}

/// Runs the studies of every height in every direction and evaluates them.
///
/// The studies are stored in folders below `folder`, so that an interrupted run resumes from there. `report`
/// receives the number of finished runs and the total number of runs. It cancels the runs by returning
/// [`ControlFlow::Break`].
///
/// # Errors
/// If the rack, the barrel or the height is unknown, the rack is not supported in three dimensions, a record cannot be
/// read, or a folder cannot be written.
pub fn heights(
    request: &Request,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(u64, u64) -> ControlFlow<()> + Sync),
) -> Result<Heights, HeightsError> {
    if !(LOWEST..=HIGHEST).contains(&request.highest) {
        return Err(HeightsError::Levels(request.highest));
    }
    let mut studies: Vec<(Direction, bool, Study)> = Vec::new();
    for direction in request.directions() {
        if direction == Direction::Space {
            // Not every rack is supported in three dimensions.
            check(&plan::at_rest(request, direction, LOWEST)?).map_err(HeightsError::Stack)?;
        }
        for recorded in [false, true] {
            let name = plan::name(direction, recorded);
            let study = Study::written(&name, &plan::text(request, direction, recorded)?)?;
            studies.push((direction, recorded, study));
        }
    }
    let all: u64 = studies.iter().map(|(.., study)| study.cases()).sum();
    let mut before = 0;
    let mut found = Vec::new();
    for (direction, recorded, study) in &studies {
        let overall = |progress: &Progress| report(before + progress.tally.cases, all);
        let name = plan::name(*direction, *recorded);
        let place = folder.join(&name);
        system::folder_below(folder, Path::new(&name))
            .map_err(StudyError::system("create the folder", &place))?;
        found.push((*direction, study, study.run(&place, options, &overall)?));
        before += study.cases();
    }
    let directions = request.directions().into_iter();
    let stacks: Vec<(u32, Direction)> = directions
        .flat_map(|direction| request.heights().map(move |levels| (levels, direction)))
        .collect();
    let margins = margin::margins(request, &stacks, &|| report(all, all))?;
    let mut found = gather(request, &found, &|| report(all, all))?;
    for height in &mut found.heights {
        let at = stacks.iter().position(|of| *of == (height.levels, height.direction));
        height.static_margin = at.and_then(|at| margins[at]);
    }
    found.document = page::document(&found);
    Ok(found)
}

/// Evaluates the tables of the studies; `stop` cancels the evaluation by returning [`ControlFlow::Break`].
fn gather(
    request: &Request,
    found: &[(Direction, &Study, Collected)],
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Heights, HeightsError> {
    let (mut heights, mut recorded, mut samples) = (Vec::new(), Vec::new(), Vec::new());
    let (mut runs, mut left_out, mut fallen_at_rest, mut motions) = (0, 0, 0, 0);
    let mut ends = Vec::new();
    for (direction, study, collected) in found {
        let cases = Cases::read(collected)?;
        runs += collected.table.rows();
        left_out += cases.left_out;
        fallen_at_rest += cases.fallen_at_rest();
        ends.extend(cases.endings.sentences());
        if !cases.leveled {
            recorded.extend(recorded_runs(&cases, collected, *direction));
            continue;
        }
        motions = cases.records.len();
        for levels in request.heights() {
            let of = cases.only(|case| levels_of(collected, case.row) == Some(levels));
            let mut sample = Sample::default();
            sample.add(study, collected, &of);
            let rows = (0..collected.table.rows()).filter_map(|row| u32::try_from(row).ok());
            if rows.filter(|row| levels_of(collected, *row) == Some(levels)).count() > of.all.len()
            {
                sample.lacks_a_verdict();
            }
            samples.push(sample);
            heights.push(height(&of, levels, *direction));
        }
    }
    let work: Vec<(&Height, Sample)> = heights.iter().zip(samples).collect();
    let effects = |(height, sample): &(&Height, Sample)| {
        let going = stop().is_continue();
        going.then(|| sample.at_levels(&height.by_velocity.stripes, known))
    };
    let effects = pool::map(&work, effects, &|_| ());
    for (height, effects) in heights.iter_mut().zip(effects) {
        height.effects = effects.ok_or(StudyError::Stopped)?;
    }
    let mut all = Heights {
        request: request.clone(),
        heights,
        recorded,
        motions,
        runs,
        left_out,
        fallen_at_rest,
        ends,
        warnings: Vec::new(),
        document: Document::default(),
    };
    all.warnings = page::warnings(&all);
    Ok(all)
}

fn height(cases: &Cases, levels: u32, direction: Direction) -> Height {
    let pga = cases.measures.iter().position(|measure| measure.name == "pga");
    let levels_of_shaking = cases.groups(cases.main);
    let fallen = levels_of_shaking
        .iter()
        .map(|(_, of)| of.iter().map(|case| case.fallen_share()).sum::<f64>() / of.len() as f64);
    Height {
        levels,
        direction,
        fallen: fallen.collect(),
        static_margin: None,
        effects: Vec::new(),
        by_velocity: LimitCurve::of(cases, LimitState::SeatLost, cases.main),
        by_acceleration: LimitCurve::of(cases, LimitState::SeatLost, pga.unwrap_or(cases.main)),
    }
}

fn levels_of(collected: &Collected, row: u32) -> Option<u32> {
    match collected.table.column("levels")?.values.get(row as usize)? {
        Value::Integer(levels) => u32::try_from(levels).ok(),
        Value::Number(_) | Value::Text(_) => None,
    }
}

fn recorded_runs(cases: &Cases, collected: &Collected, direction: Direction) -> Vec<AsRecorded> {
    let intensity = |name: &str, case: &JudgedCase| {
        let at = cases.measures.iter().position(|measure| measure.name == name)?;
        case.intensity(at)
    };
    let run = |case: &JudgedCase| {
        Some(AsRecorded {
            levels: levels_of(collected, case.row)?,
            direction,
            motion: cases.records[case.record as usize].clone(),
            collapsed: case.collapsed,
            fallen: case.fallen_share(),
            velocity: intensity("pgv", case)?,
            acceleration: intensity("pga", case)?,
        })
    };
    cases.all.iter().filter_map(|case| run(case)).collect()
}
