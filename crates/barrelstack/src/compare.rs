//! Comparison of two or more runs: their differing inputs and their results.

mod labels;
mod page;
mod paired;
mod tables;

use std::ops::ControlFlow;

use barrelstack_report::{History, Pane, described};

use crate::assemble::PartKind;
use crate::ensemble::CaseResult;
use crate::outcome::Outcome;
use crate::report;
use crate::run::{Run, RunFailure};
use crate::scenario::{Scenario, Setting, View};
use crate::summary::{AnySummary, Summary};
use crate::variants::{Advance, Answer, Shown, Spread, common_number};

pub use labels::{labels, labels_by};
pub use page::document;
pub use paired::Paired;
pub use tables::inputs;

/// One run of a comparison, in a plane or in three dimensions.
#[derive(Clone, Debug)]
pub struct Side {
    /// Name of the run, short enough for a column heading.
    pub name: String,
    /// Summary of the run.
    pub summary: AnySummary,
    /// The scenario as stated.
    pub stated: Scenario,
    /// The scenario that was run; it may be a variant of the stated scenario.
    pub scenario: Scenario,
    /// The plane of the run; `None` for a three-dimensional model and for a free scene.
    pub view: Option<View>,
    /// Outcome of the run.
    pub outcome: Outcome,
    /// Simulated time (s) that the run reached.
    pub end_time: f64,
    /// Duration (s) of the ground motion that remained when `run.duration` ended the run; `None` if nothing remained.
    pub cut: Option<f64>,
    /// Time (s) of the first loss of a seat; `None` if no seat is lost.
    pub collapse_time: Option<f64>,
    /// Animated scene of the run, as a pane of the player.
    pub pane: Pane,
    /// Histories of the ground motion, the first of which is an acceleration.
    pub ground: Vec<History>,
    /// Histories to be plotted, each with its times (s) and values.
    pub traced: Vec<(Traced, [Vec<f64>; 2])>,
    /// Provenance of the result, as pairs of name and value.
    pub provenance: Vec<(String, String)>,
    /// Results in the plane that is not shown, if the scenario has both planes.
    pub other: Option<OtherPlane>,
    /// Verdicts of the variants in each plane (the shown plane first) or in three dimensions. Each entry has the name
    /// of the plane and one verdict per variant, in the order of the variant numbers: `true` if the variant collapses,
    /// `None` if it has no verdict.
    pub collapsed: Vec<(Option<&'static str>, Vec<Option<bool>>)>,
}

/// A history that a comparison plots for all runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Traced {
    /// Displacement (cm) of the top left barrel in the plane of the model, relative to the ground.
    Top,
    /// Displacement (cm) of the top left barrel of a three-dimensional model, across the barrels.
    TopAcross,
    /// Displacement (cm) of the top left barrel of a three-dimensional model, along the barrels.
    TopAlong,
    /// Slip (cm) of the bottom rack in the plane of the model.
    Base,
    /// Slip (cm) of the bottom rack of a three-dimensional model, across the barrels.
    BaseAcross,
    /// Slip (cm) of the bottom rack of a three-dimensional model, along the barrels.
    BaseAlong,
    /// Vertical force (kN) between the bottom rack and the ground.
    BaseForce,
}

/// Results of a scenario, in planes or in three dimensions, which can be compared with those of other scenarios.
pub trait Comparable: Sized {
    /// Returns the scenario.
    fn scenario(&self) -> &Scenario;

    /// Returns the number of the shown variant.
    fn variant(&self) -> u32;

    /// Returns the results of all variants, in each plane or in three dimensions; `None` where no variants were run.
    fn results(&self) -> Vec<Option<Vec<CaseResult>>>;

    /// Runs the variant `number`, and returns these results with that variant as the shown run.
    ///
    /// The observer receives the progress and may cancel.
    ///
    /// # Errors
    /// When that variant cannot be run.
    fn with_variant(
        &self,
        number: u32,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure>;

    /// Returns the share of variants that collapse (0 or 1 for a single run) in the plane in which this share is
    /// largest, and this plane. The plane is `None` for a three-dimensional model and for a free scene.
    fn worst(&self) -> (f64, Option<View>);

    /// Returns these results as one side of a comparison, shown in the given plane if the scenario has it.
    fn side(self, name: String, plane: Option<View>) -> Side;
}

/// Makes all results in `answers` show the same variant: the one that is most typical over all of them (the medoid).
///
/// Only variants that run under the same horizontal component of the motion in all answers are eligible. If the nominal
/// cases already differ in this component, all variants are eligible.
///
/// In every answer that shows another variant, the medoid is run and then shown; the observer receives the progress and
/// may cancel. Answers are returned unchanged if any of them has no variants.
///
/// # Errors
/// When the common variant cannot be run.
pub fn aligned<A: Comparable>(
    answers: Vec<(String, A)>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Vec<(String, A)>, RunFailure> {
    let all: Vec<&A> = answers.iter().map(|(_, answer)| answer).collect();
    let Some(number) = common_number(&all)? else { return Ok(answers) };
    let align = |(name, answer): (String, A)| {
        if answer.variant() == number {
            return Ok((name, answer));
        }
        Ok((name, answer.with_variant(number, observer)?))
    };
    answers.into_iter().map(align).collect()
}

/// Converts each answer, given with its name, to one side of a comparison.
///
/// If all answers have both planes, every side shows the same plane: the governing plane of the answer with the largest
/// share of collapses.
pub fn sides<A: Comparable>(answers: Vec<(String, A)>) -> Vec<Side> {
    let all = answers.iter().map(|(_, answer)| answer.worst());
    let worst = all.reduce(|worst, one| if one.0 > worst.0 { one } else { worst });
    let plane = worst.and_then(|(_, plane)| plane);
    answers.into_iter().map(|(name, answer)| answer.side(name, plane)).collect()
}

impl Comparable for Answer {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn variant(&self) -> u32 {
        self.decides.summary.variant
    }

    fn results(&self) -> Vec<Option<Vec<CaseResult>>> {
        let variants = self.shown().map(|shown| shown.variants.as_ref());
        variants.map(|variants| variants.map(|found| found.results.clone())).collect()
    }

    fn with_variant(
        &self,
        number: u32,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure> {
        self.showing(number, observer)
    }

    fn worst(&self) -> (f64, Option<View>) {
        let Shown { run, summary, .. } = &self.decides;
        let share = share_of(summary.ensemble.as_ref(), &run.outcome);
        (share, run.assembly.view)
    }

    fn side(self, name: String, plane: Option<View>) -> Side {
        let Self { decides, other, .. } = self;
        let collapsed = |shown: &Shown| {
            let results = shown.variants.as_ref()?.results.get(1..)?;
            let view = shown.run.assembly.view.map(View::name);
            Some((view, results.iter().map(CaseResult::collapsed).collect()))
        };
        let (shown, other) = match other {
            Some(other) if other.run.assembly.view == plane => (other, Some(decides)),
            other => (decides, other),
        };
        let collapsed = std::iter::once(&shown).chain(&other).filter_map(collapsed).collect();
        let summary = Summary { other_plane: None, ..shown.summary };
        let other = other.and_then(|Shown { run, summary, .. }| {
            let (outcome, spread) = (run.outcome, summary.ensemble);
            Some(OtherPlane { view: run.assembly.view?, outcome, spread })
        });
        Side { other, collapsed, ..Side::of_run(name, &shown.run, summary) }
    }
}

/// Returns the share of variants that collapse; for a single run, 0 or 1.
pub fn share_of(ensemble: Option<&Spread>, outcome: &Outcome) -> f64 {
    match ensemble {
        Some(spread) => spread.share.unwrap_or(0.0),
        None => f64::from(u8::from(outcome.is_collapse())),
    }
}

impl Side {
    /// Creates one side of a comparison from a single planar run, without results of variants or of a second plane.
    pub fn of_run(name: String, run: &Run, summary: Summary) -> Self {
        let assembly = &run.assembly;
        let recorded = |values: Vec<f64>| [run.recording.times.clone(), values];
        // Displacement (cm) along x of the first body of a kind on a level.
        let displacement = |kind: PartKind, level: u32| {
            let body = assembly.of_kind(kind).find(|b| assembly.parts[*b].level == Some(level))?;
            let channel = run.recording.displacement(&assembly.parts[body].name)?;
            Some(recorded(channel.values.iter().map(|v| 100.0 * v).collect()))
        };
        let force = run.recording.joints.first();
        let force = force.map(|base| recorded(base.vertical.iter().map(|v| 1e-3 * v).collect()));
        let traced = [
            (Traced::Top, displacement(PartKind::Barrel, assembly.levels)),
            (Traced::Base, displacement(PartKind::Rack, 1)),
            (Traced::BaseForce, force),
        ];
        Self {
            name,
            stated: (*run.stated).clone(),
            scenario: run.scenario.clone(),
            view: assembly.view,
            outcome: run.outcome.clone(),
            end_time: run.end_time,
            cut: run.cut(),
            collapse_time: run.fates.collapse_time(),
            pane: Pane {
                mark: String::new(),
                name: String::new(),
                verdict: report::headline(run, &summary),
                tone: report::tone(run, &summary),
                scene: report::scene(run),
                traces: report::traces(run),
            },
            ground: report::ground_histories(run),
            traced: traced.into_iter().filter_map(|(what, of)| Some((what, of?))).collect(),
            provenance: report::provenance(run, &summary),
            summary: AnySummary::Planar(Box::new(summary)),
            other: None,
            collapsed: Vec::new(),
        }
    }

    /// `true` for a run of a three-dimensional model.
    fn is_spatial(&self) -> bool {
        matches!(self.summary, AnySummary::Spatial(_))
    }
}

/// Results of a stack in the plane that is not shown.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherPlane {
    /// Plane in which these results were computed.
    pub view: View,
    /// Outcome of the run in this plane, for the same variant number as the shown run.
    pub outcome: Outcome,
    /// Statistics of the variants; `None` if no variants were run.
    pub spread: Option<Spread>,
}

/// Reason why runs cannot be compared.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CompareError {
    /// Fewer than two runs; the value is their number.
    #[error("a comparison needs at least two runs, found {0}")]
    TooFew(usize),
    /// More runs than a page can show.
    #[error("a comparison shows at most {most} runs side by side, found {found}: leave some out")]
    TooMany {
        /// Number of requested runs.
        found: usize,
        /// Maximum number of runs.
        most: usize,
    },
    /// Two runs have equal inputs.
    #[error("{first} and {second} are the same run: all their inputs are equal")]
    Identical {
        /// Name of the first of the two runs.
        first: String,
        /// Name of the second of the two runs.
        second: String,
    },
}

/// Maximum number of runs in a comparison; a seventh run would repeat a color.
pub const MOST: usize = 6;

/// Checks a comparison before any work is done.
///
/// # Errors
/// When there are too few or too many runs, or two runs have equal inputs.
pub fn check(scenarios: &[(String, Scenario)]) -> Result<(), CompareError> {
    let print = |(name, scenario): &(String, Scenario)| (name.clone(), scenario.fingerprint());
    check_distinct(&scenarios.iter().map(print).collect::<Vec<_>>(), MOST)
}

/// Checks that there are two to `most` runs, given by name and fingerprint, and that no two are equal.
///
/// # Errors
/// As for [`check`].
pub fn check_distinct(runs: &[(String, u64)], most: usize) -> Result<(), CompareError> {
    match runs.len() {
        found @ 0..=1 => return Err(CompareError::TooFew(found)),
        found if found > most => return Err(CompareError::TooMany { found, most }),
        _ => {}
    }
    for (at, (second, print)) in runs.iter().enumerate() {
        if let Some((first, _)) = runs[..at].iter().find(|(_, other)| other == print) {
            return Err(CompareError::Identical { first: first.clone(), second: second.clone() });
        }
    }
    Ok(())
}

described! {
    /// Two or more runs side by side.
    #[derive(Clone, Debug)]
    pub struct Comparison of sides: &[Side], unfinished: Vec<String> {
        /// Name and version of the format of this document.
        pub schema: &'static str ["comparison/1"] = "comparison/1",
        /// The runs, in order.
        pub runs: Vec<Compared> = sides.iter().map(Compared::of).collect(),
        /// Comparisons of the first run with every other run, variant by variant: first in the plane that is shown,
        /// then in the other plane.
        pub paired: Vec<Paired> = pairs(sides),
        /// Names of the runs that were stopped early or never started; they are not compared.
        pub unfinished: Vec<String> = unfinished,
        /// The inputs that differ between the runs.
        pub differences: Vec<Difference> = differences(sides.iter().map(|side| &side.stated)),
    }

    /// One run of a comparison.
    #[derive(Clone, Debug)]
    pub struct Compared of side: &Side {
        /// Name of the run.
        pub name: String = side.name.clone(),
        /// Summary of the run.
        pub summary: AnySummary = side.summary.clone(),
        /// Statistics of the variants in the plane that is not shown; null if the scenario has only one plane.
        pub ensemble_of_other_plane: Option<Spread> =
            side.other.as_ref().and_then(|other| other.spread.clone()),
        /// Outcome in the plane that is not shown; null if the scenario has only one plane.
        pub outcome_of_other_plane: Option<&'static str>
            ["stable", "collapse", "not-judged", "interrupted", "invalid"] =
            side.other.as_ref().map(|other| other.outcome.kind()),
    }

    /// An input whose value is not the same in all runs.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct Difference {
        /// Path of the input in the scenario, such as `stack.levels`.
        pub path: String,
        /// Meaning of the input.
        pub help: &'static str,
        /// Value of the input in each run; null for a run that has no such input.
        pub values: Vec<Option<String>>,
    }
}

/// Returns the inputs that differ between scenarios, in the order of the scenario file.
pub fn differences<'a>(scenarios: impl IntoIterator<Item = &'a Scenario>) -> Vec<Difference> {
    differing(&scenarios.into_iter().map(Scenario::settings).collect::<Vec<_>>())
}

/// Returns the inputs that differ between runs, in the order of the settings; `all` holds all settings of each run.
pub fn differing(all: &[Vec<Setting>]) -> Vec<Difference> {
    let mut list: Vec<Difference> = Vec::new();
    for setting in all.iter().flatten() {
        if list.iter().any(|known| known.path == setting.path) {
            continue;
        }
        let value = |settings: &Vec<Setting>| {
            settings.iter().find(|s| s.path == setting.path).map(|s| s.value.clone())
        };
        list.push(Difference {
            path: setting.path.clone(),
            help: setting.help,
            values: all.iter().map(value).collect(),
        });
    }
    list.retain(|one| one.values.iter().any(|value| *value != one.values[0]));
    list
}

/// Compares the first run with every other run, in every plane that both have.
fn pairs(sides: &[Side]) -> Vec<Paired> {
    let Some((first, others)) = sides.split_first() else { return Vec::new() };
    others.iter().flat_map(|other| Paired::of(first, other)).collect()
}

/// Returns the letter of a run by its position: A for the first.
fn letter(at: usize) -> char {
    char::from(b'A' + u8::try_from(at).unwrap_or(0))
}
