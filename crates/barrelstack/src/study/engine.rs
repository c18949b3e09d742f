//! The engine: from prepared cases to what became of them. All simulation of a study is behind [`simulate`].

use std::sync::Arc;

use barrelstack_dynamics::{Simulation, simulate as integrate};

use crate::assemble::PartKind;
use crate::ground::Ground;
use crate::outcome::Outcome;
use crate::run::{RunFailure, Standing, conclude, end_time, method, stand, thresholds};
use crate::scenario::Scenario;
use crate::summary::{Demands, demands};
use crate::watch::FateWatch;

/// Version of what the engine computes: raised whenever the same case may give other bits, so that shards of two
/// engines never stand in one folder.
pub(super) const VERSION: u32 = 1;

/// A case that is ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The scenario; its own motion is not looked at.
    pub scenario: Arc<Scenario>,
    /// What shakes it, shared by all cases of one motion and level.
    pub ground: Arc<Ground>,
}

/// What became of a case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// What happened, or why the case could not run.
    pub outcome: Result<Outcome, String>,
    /// When (s) the first barrel had fallen.
    pub first_fall: Option<f64>,
    /// How many barrels there are.
    pub barrels: usize,
    /// Largest drop (m) of each barrel that fell, in the order of the barrels.
    pub fall_heights: Vec<f64>,
    /// Demands on the stack; all none where it could not run or broke down.
    pub demands: Demands,
    /// Largest displacement (m) of a barrel along x against the ground, left at the end.
    pub residual_displacement: Option<f64>,
    /// Time (s) that the run reached.
    pub end_time: Option<f64>,
    /// Accepted steps.
    pub steps: Option<u64>,
    /// Energy missing from the books over the energy that went through.
    pub energy_residual_ratio: Option<f64>,
    /// What the reader of the result should know.
    pub warnings: Vec<String>,
}

impl CaseResult {
    /// A case that could not run.
    pub fn failed(reason: String) -> Self {
        Self {
            outcome: Err(reason),
            first_fall: None,
            barrels: 0,
            fall_heights: Vec::new(),
            demands: Demands::default(),
            residual_displacement: None,
            end_time: None,
            steps: None,
            energy_residual_ratio: None,
            warnings: Vec::new(),
        }
    }
}

/// Runs cases and gives what became of each, in their order; none when asked to stop.
///
/// Which cases stand together changes nothing about any of them.
/// `tell` hears of each case that is done, in any order; `stop` is asked now and then.
pub fn simulate(
    cases: &[Prepared],
    tell: &mut dyn FnMut(&CaseResult),
    stop: &dyn Fn() -> bool,
) -> Option<Vec<CaseResult>> {
    let mut results = Vec::with_capacity(cases.len());
    // Cases that differ in their motion alone start from the same rest.
    let mut rest: Option<(&Arc<Scenario>, Standing)> = None;
    for case in cases {
        let result = match one(case, &mut rest, stop) {
            Ok(Some(result)) => result,
            Ok(None) => return None,
            Err(failure) => CaseResult::failed(failure.to_string()),
        };
        tell(&result);
        results.push(result);
    }
    Some(results)
}

/// Runs a case from the rest of the one before, where that is the same.
fn one<'a>(
    case: &'a Prepared,
    rest: &mut Option<(&'a Arc<Scenario>, Standing)>,
    stop: &dyn Fn() -> bool,
) -> Result<Option<CaseResult>, RunFailure> {
    let scenario = &*case.scenario;
    let time_scale = scenario.run.similitude.sqrt();
    let end_time = end_time(scenario, &case.ground, time_scale)?;
    let known = rest.as_ref().is_some_and(|(before, _)| Arc::ptr_eq(before, &case.scenario));
    if !known {
        *rest = Some((&case.scenario, stand(scenario, end_time)?));
    }
    let Some((_, standing)) = rest else { return Ok(None) };
    let Standing { assembly, state, scratch, step, .. } = &*standing;
    let (mut state, mut scratch) = (state.clone(), scratch.clone());
    let simulation = Simulation { method: method(scenario), time_step: *step, end_time };
    let after = scenario.run.stop_after_collapse.map(|after| after * time_scale);
    let mut watch = FateWatch::new(assembly, &state, thresholds(scenario), after, stop);
    let ground = &*case.ground;
    let ended =
        integrate(&assembly.model, ground, &mut state, &mut scratch, &simulation, &mut watch);
    let FateWatch { fates, interrupted, .. } = watch;
    if interrupted {
        return Ok(None);
    }
    let verdict = conclude(assembly, ground, &fates, ended, state.time, false);
    let sound = !matches!(verdict.outcome, Outcome::Invalid { .. });
    let barrels: Vec<usize> = assembly.of_kind(PartKind::Barrel).collect();
    let fallen = barrels.iter().map(|body| fates.fate(*body)).filter(|fate| fate.fell_at.is_some());
    let residual = barrels.iter().map(|body| fates.fate(*body).residual_displacement);
    let largest = |most: f64, value: f64| if value.abs() > most.abs() { value } else { most };
    Ok(Some(CaseResult {
        first_fall: fates.first_fall().filter(|_| sound),
        barrels: barrels.len(),
        fall_heights: if sound { fallen.map(|fate| fate.drop).collect() } else { Vec::new() },
        demands: if sound { demands(assembly, &fates, None) } else { Demands::default() },
        residual_displacement: (sound && !barrels.is_empty()).then(|| residual.fold(0.0, largest)),
        end_time: Some(state.time),
        steps: Some(verdict.steps),
        energy_residual_ratio: verdict.energy.map(|energy| energy.residual_ratio()),
        warnings: verdict.warnings,
        outcome: Ok(verdict.outcome),
    }))
}
