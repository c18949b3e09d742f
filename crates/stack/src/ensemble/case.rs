//! A case of an ensemble and its result.

use std::sync::Arc;

use crate::assemble::{Assembly, PartKind};
use crate::demand::{Demands, Span};
use crate::ground::{Ground, GroundError};
use crate::outcome::{CollapseMode, Outcome};
use crate::run::{CUT, Verdict};
use crate::scenario::Scenario;
use crate::watch::{Ending, Fates, Joint, Joints, Stresses};

use super::trail::Trail;

/// A case that is ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The scenario; `ground` is used instead of its own motion.
    pub scenario: Arc<Scenario>,
    /// Ground motion, shared by all cases with the same motion and intensity.
    pub ground: Arc<Ground>,
    /// `false` to record no contact stresses, so that the demands that are computed from stresses are `None`.
    ///
    /// Recording stresses takes up to a fifth of the time of a run. It affects no other result.
    pub records_stresses: bool,
}

impl Prepared {
    /// Creates a case from a scenario, with the ground motion that the scenario specifies.
    ///
    /// # Errors
    /// If the motion cannot be read.
    pub fn new(scenario: Scenario) -> Result<Self, GroundError> {
        let ground = Arc::new(scenario.ground()?);
        Ok(Self::shaken_by(Arc::new(scenario), ground))
    }

    /// Creates a case from a scenario and a ground motion that is used instead of the scenario's own motion.
    pub fn shaken_by(scenario: Arc<Scenario>, ground: Arc<Ground>) -> Self {
        Self { scenario, ground, records_stresses: true }
    }
}

/// Result of a case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// Outcome, or the reason why the case could not run.
    pub outcome: Result<Outcome, String>,
    /// Time (s) at which the first barrel counted as fallen; `None` if no barrel fell, or if the case was stopped,
    /// could not run or is invalid.
    pub first_fall: Option<f64>,
    /// Number of barrels.
    pub barrels: usize,
    /// Name of each barrel and the time (s) at which it counted as fallen, in the order of the barrels; `None` for a
    /// barrel that did not fall.
    pub falls: Vec<(String, Option<f64>)>,
    /// Largest drop (m) of each fallen barrel, in the order of the barrels.
    pub fall_heights: Vec<f64>,
    /// Largest force (N) on each fallen barrel from the time at which it counts as fallen, including its impact.
    pub fall_forces: Vec<f64>,
    /// Volume of wine (m³) in each fallen barrel.
    pub fall_wine: Vec<f64>,
    /// Volume of wine (m³) in all barrels of the stack.
    pub wine: f64,
    /// Demands on the stack until the first loss of a seat; all `None` if the case could not run or is invalid.
    pub demands: Demands,
    /// Demands over the whole run.
    pub demands_whole_run: Demands,
    /// Pairs of bodies of which one supports the other, and pairs that have touched during the run: the name of each
    /// pair, its force at rest, and its largest forces. Empty if the stack was not shaken, or if the case was stopped
    /// or is invalid.
    pub joints: Vec<(String, Joint)>,
    /// Largest displacement (m) of a barrel relative to the ground at the end of the run: along x in a planar model,
    /// horizontal in a three-dimensional model. `None` if the stack has no barrels or was not shaken, or if the case
    /// was stopped or is invalid.
    pub residual_displacement: Option<f64>,
    /// Reason for the end of the run; `None` if the case was stopped or could not run.
    pub ending: Option<Ending>,
    /// Duration (s) of the ground motion that remained when the run ended; zero if the run ended at rest or covered the
    /// whole motion. `None` if the case was stopped or could not run.
    pub cut: Option<f64>,
    /// Simulated time (s) that the run reached; `None` if the case was stopped or could not run.
    pub end_time: Option<f64>,
    /// Number of accepted time steps; `None` if the case was stopped or could not run.
    pub steps: Option<u64>,
    /// Residual of the energy balance divided by the energy that passed through the system; `None` after a numerical
    /// breakdown, and if the stack was not shaken or the case was stopped.
    pub energy_residual_ratio: Option<f64>,
    /// Warnings that concern the result.
    pub warnings: Vec<String>,
    /// Barrel positions over time; empty if the case could not run or is invalid.
    pub trail: Trail,
}

/// Observations of a case from which its result is made.
pub(super) struct Observed<'a> {
    pub(super) fates: &'a Fates,
    pub(super) stresses: &'a Stresses,
    pub(super) joints: &'a Joints,
    pub(super) trail: Trail,
}

impl CaseResult {
    /// Creates the result of a case that was stopped before its end, or not started.
    pub fn interrupted() -> Self {
        Self { outcome: Ok(Outcome::Interrupted), ..Self::failed(String::new()) }
    }

    /// Returns `true` if the case was stopped before its end, or not started.
    pub fn is_interrupted(&self) -> bool {
        matches!(self.outcome, Ok(Outcome::Interrupted))
    }

    /// Creates the result of a case that ended at `time` (s), from its verdict and its observations.
    pub(super) fn of(
        assembly: &Assembly,
        ground: &Ground,
        observed: Observed<'_>,
        verdict: Verdict,
        time: f64,
    ) -> Self {
        let Observed { fates, stresses, joints, trail } = observed;
        let sound = !matches!(verdict.outcome, Outcome::Invalid { .. });
        let barrels: Vec<usize> = assembly.of_kind(PartKind::Barrel).collect();
        let all = || barrels.iter().map(|body| fates.fate(*body));
        let fall = |body: &usize| (assembly.parts[*body].name.clone(), fates.fate(*body).fell_at);
        let fallen = || all().filter(|fate| fate.fell_at.is_some());
        let named = |joint: &Joint| (joint.name(assembly), joint.clone());
        let demands = |span: Span| Demands::of(assembly, fates, stresses, joints, span);
        let residual = all().map(|fate| fate.residual_displacement);
        let largest = |most: f64, value: f64| if value.abs() > most.abs() { value } else { most };
        let left = ground.end() - time;
        let common = Self {
            outcome: Ok(verdict.outcome),
            barrels: barrels.len(),
            wine: barrels.iter().map(|body| assembly.parts[*body].wine).sum(),
            ending: Some(verdict.ending),
            cut: Some(if verdict.ending == Ending::Rest || left <= CUT { 0.0 } else { left }),
            end_time: Some(time),
            steps: Some(verdict.steps),
            energy_residual_ratio: verdict.energy.map(|energy| energy.residual_ratio()),
            warnings: verdict.warnings,
            ..Self::failed(String::new())
        };
        if !sound {
            return common;
        }
        Self {
            first_fall: fates.first_fall(),
            falls: barrels.iter().map(fall).collect(),
            fall_heights: fallen().map(|fate| fate.drop).collect(),
            fall_forces: fallen().filter_map(|fate| fate.fall_force).collect(),
            fall_wine: barrels
                .iter()
                .filter(|body| fates.fate(**body).fell_at.is_some())
                .map(|body| assembly.parts[*body].wine)
                .collect(),
            demands: demands(Span::UntilLoss),
            demands_whole_run: demands(Span::WholeRun),
            joints: joints.listed().into_iter().map(named).collect(),
            residual_displacement: (!barrels.is_empty()).then(|| residual.fold(0.0, largest)),
            trail,
            ..common
        }
    }

    /// Creates the result of a case whose stack falls under its own weight before it is shaken.
    ///
    /// The first argument is the name and the level of the lowest unsupported body. The result is a collapse, at time
    /// zero, of this level and all levels above, and all barrels of these levels count as fallen. `barrels` lists all
    /// barrels of the stack, each with its name, its level, its height (m) above the floor, and its wine (m³). The
    /// height counts as the drop of the barrel.
    pub fn fallen_at_rest(
        (first, from_level): (&str, u32),
        levels: u32,
        barrels: &[(String, u32, f64, f64)],
        reason: String,
    ) -> Self {
        let falls = |(_, level, ..): &&(String, u32, f64, f64)| *level >= from_level;
        let outcome = Outcome::Collapse {
            mode: CollapseMode::Gravity,
            time: 0.0,
            first: first.to_owned(),
            from_level,
            to_level: levels,
        };
        let fallen = || barrels.iter().filter(falls);
        Self {
            outcome: Ok(outcome),
            first_fall: fallen().next().map(|_| 0.0),
            barrels: barrels.len(),
            falls: barrels
                .iter()
                .map(|barrel| (barrel.0.clone(), falls(&barrel).then_some(0.0)))
                .collect(),
            fall_heights: fallen().map(|(.., height, _)| *height).collect(),
            fall_wine: fallen().map(|(.., wine)| *wine).collect(),
            wine: barrels.iter().map(|(.., wine)| wine).sum(),
            ending: Some(Ending::NotShaken),
            cut: Some(0.0),
            end_time: Some(0.0),
            steps: Some(0),
            warnings: vec![reason],
            ..Self::failed(String::new())
        }
    }

    /// Returns whether the stack collapsed; `None` if there is no verdict.
    pub fn collapsed(&self) -> Option<bool> {
        match self.outcome {
            Ok(Outcome::Stable) => Some(false),
            Ok(Outcome::Collapse { .. }) => Some(true),
            Ok(Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. }) | Err(_) => {
                None
            }
        }
    }

    /// Returns `true` if the stack fell under its own weight before it was shaken.
    pub fn fell_at_rest(&self) -> bool {
        self.outcome.as_ref().is_ok_and(Outcome::fell_at_rest)
    }

    /// Creates the result of a case that could not run.
    pub fn failed(reason: String) -> Self {
        Self {
            outcome: Err(reason),
            first_fall: None,
            barrels: 0,
            falls: Vec::new(),
            fall_heights: Vec::new(),
            fall_forces: Vec::new(),
            fall_wine: Vec::new(),
            wine: 0.0,
            demands: Demands::default(),
            demands_whole_run: Demands::default(),
            joints: Vec::new(),
            residual_displacement: None,
            ending: None,
            cut: None,
            end_time: None,
            steps: None,
            energy_residual_ratio: None,
            warnings: Vec::new(),
            trail: Trail::default(),
        }
    }
}
