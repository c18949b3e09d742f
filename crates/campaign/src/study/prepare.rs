//! Computes the rows of a chunk: builds, runs and tabulates its cases.

use std::sync::Arc;

use crate::scenario::reader::Reader;
use crate::scenario::{Scenario, ScenarioError, Scene};

use super::design::{Design, PlannedCase, seed_of};
use super::error::StudyError;
use super::ida::{Hunt, LevelResult};
use super::motions::{Motion, MotionCache, Shaken, Shaking, Synthetic};
use super::setting::Setting;
use super::space::FinishedCase;
use super::table::StudyTable;
use super::{Study, Value};
use crate::ensemble::{Audience, CaseResult, Prepared, Width, simulate_in};
use crate::ground::Ground;
use crate::outcome::Outcome;

/// Maximum number of cases that are built at once: enough to run in lockstep, and few enough for their
/// motions to fit in memory.
const BATCH: usize = 128;

/// Resources for running a chunk.
pub(super) struct Resources<'a> {
    pub(super) cache: &'a MotionCache,
    /// SIMD vector width with which the cases are run.
    pub(super) lanes: Width,
    /// Callback that receives the result of each case.
    pub(super) report: &'a mut dyn FnMut(&CaseResult),
    /// Callback that returns `true` to cancel.
    pub(super) stop: &'a dyn Fn() -> bool,
}

/// A case with its motion, ready to run, or else the reason why the case cannot run.
struct Built {
    shaken: Option<Shaken>,
    prepared: Result<Prepared, String>,
}

impl Study {
    /// Computes the rows of a chunk; returns `None` if canceled.
    pub(super) fn compute(
        &self,
        chunk: usize,
        resources: &mut Resources<'_>,
    ) -> Result<Option<StudyTable>, StudyError> {
        let numbers = self.chunks.numbers(chunk);
        let mut table = StudyTable::empty(&self.columns());
        if let Design::Ida(hunt) = &self.design {
            let Some(rows) = self.hunts(hunt, &numbers, chunk, resources) else { return Ok(None) };
            for row in rows {
                table.push(row)?;
            }
            return Ok(Some(table));
        }
        for numbers in numbers.chunks(BATCH) {
            let cases: Vec<PlannedCase> =
                numbers.iter().map(|number| self.cases.case(self, *number)).collect();
            let Some(done) = self.shake(&cases, resources) else { return Ok(None) };
            for (case, (shaken, finished)) in cases.iter().zip(done) {
                table.push(self.row(case, chunk, shaken.as_ref(), &finished))?;
            }
        }
        Ok(Some(table))
    }

    /// Runs several hunts in parallel, one level of each hunt at a time, and returns their rows; `None` if
    /// canceled.
    fn hunts(
        &self,
        hunt: &Hunt,
        numbers: &[u64],
        chunk: usize,
        resources: &mut Resources<'_>,
    ) -> Option<Vec<Vec<Option<Value>>>> {
        let hunts: Vec<PlannedCase> =
            numbers.iter().map(|number| self.cases.case(self, *number)).collect();
        let mut results: Vec<Vec<LevelResult>> = vec![Vec::new(); hunts.len()];
        let mut rows: Vec<(u64, Vec<Option<Value>>)> = Vec::new();
        loop {
            let mut round: Vec<(usize, PlannedCase)> = Vec::new();
            for (index, (base, results)) in hunts.iter().zip(&results).enumerate() {
                if let Some(level) = hunt.next(results) {
                    let number = base.number * u64::from(hunt.runs) + results.len() as u64;
                    let id = seed_of(base.id, &crate::scenario::quantity::plain(level));
                    round.push((
                        index,
                        PlannedCase { number, id, level: Some(level), ..base.clone() },
                    ));
                }
            }
            if round.is_empty() {
                break;
            }
            for part in round.chunks(BATCH) {
                let cases: Vec<PlannedCase> = part.iter().map(|(_, case)| case.clone()).collect();
                for ((index, case), (shaken, finished)) in
                    part.iter().zip(self.shake(&cases, resources)?)
                {
                    let fell = match &finished.result.outcome {
                        Ok(Outcome::Collapse { .. }) => Some(true),
                        Ok(Outcome::Stable) => Some(false),
                        Ok(Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. })
                        | Err(_) => None,
                    };
                    results[*index].push((case.level.unwrap_or(0.0), fell));
                    rows.push((case.number, self.row(case, chunk, shaken.as_ref(), &finished)));
                }
            }
        }
        rows.sort_by_key(|(number, _)| *number);
        Some(rows.into_iter().map(|(_, row)| row).collect())
    }

    /// Builds and runs cases, and returns the motion and the result of each case; `None` if canceled.
    ///
    /// Cases in a plane run in lockstep. Cases that cannot be built have a result with the reason.
    fn shake(
        &self,
        cases: &[PlannedCase],
        resources: &mut Resources<'_>,
    ) -> Option<Vec<(Option<Shaken>, FinishedCase)>> {
        let built = self.build(cases, resources.cache);
        let ready = built.iter().filter_map(|built| built.prepared.as_ref().ok());
        let ready: Vec<Prepared> =
            ready.filter(|prepared| !prepared.scenario.is_spatial()).cloned().collect();
        let mut audience = Audience { on_case: &mut *resources.report, stop: resources.stop };
        let mut results = simulate_in(resources.lanes, &ready, &mut audience)?.into_iter();
        let mut done = Vec::with_capacity(cases.len());
        for (case, Built { shaken, prepared }) in cases.iter().zip(built) {
            let finished = match prepared {
                Ok(Prepared { scenario, .. }) if scenario.is_spatial() => {
                    let factor = shaken.as_ref().map_or(1.0, |shaken| shaken.factor);
                    self.run_in_space(case, &scenario, factor, resources)?
                }
                Ok(_) => results.next()?.into(),
                Err(reason) => {
                    let result = CaseResult::failed(reason);
                    (resources.report)(&result);
                    result.into()
                }
            };
            done.push((shaken, finished));
        }
        Some(done)
    }

    fn build(&self, cases: &[PlannedCase], cache: &MotionCache) -> Vec<Built> {
        let mut built: Vec<Built> = Vec::with_capacity(cases.len());
        // Cases with the same values share a scenario; cases with the same motion and level also share the scaled motion.
        let mut scenarios: Vec<(&PlannedCase, Result<Arc<Scenario>, String>)> = Vec::new();
        let mut shakings: Vec<(&PlannedCase, *const Scenario, Shaken)> = Vec::new();
        for case in cases {
            let known = scenarios.iter().find(|(other, _)| other.settings == case.settings);
            let scenario = if let Some((_, scenario)) = known {
                scenario.clone()
            } else {
                let scenario = self.scenario(&case.settings);
                let scenario = scenario.map(Arc::new).map_err(|error| error.sentence());
                scenarios.push((case, scenario.clone()));
                scenario
            };
            let scenario = match scenario {
                Ok(scenario) => scenario,
                Err(reason) => {
                    built.push(Built { shaken: None, prepared: Err(reason) });
                    continue;
                }
            };
            let same = |(other, at, _): &&(&PlannedCase, *const Scenario, Shaken)| {
                other.motion == case.motion
                    && other.level == case.level
                    && *at == Arc::as_ptr(&scenario)
            };
            let shaken = match shakings.iter().find(same) {
                Some((_, _, shaken)) => Ok(shaken.clone()),
                None => self.shaken(case, &scenario, cache),
            };
            built.push(match shaken {
                Ok(shaken) => {
                    shakings.push((case, Arc::as_ptr(&scenario), shaken.clone()));
                    let ground = Arc::clone(&shaken.ground);
                    Built {
                        shaken: Some(shaken),
                        prepared: Ok(Prepared::shaken_by(scenario, ground)),
                    }
                }
                Err(error) => Built { shaken: None, prepared: Err(error.to_string()) },
            });
        }
        built
    }

    /// Returns the base scenario with the factors set to the given values. A factor without a value is left as it is
    /// in the base scenario.
    pub(super) fn scenario(&self, settings: &[Option<Setting>]) -> Result<Scenario, ScenarioError> {
        let changes = self.factors.iter().zip(settings).flat_map(|(factor, setting)| {
            let fields = factor.fields.iter().map(String::as_str);
            fields.zip(std::iter::repeat(setting)).filter_map(|(field, setting)| {
                setting.as_ref().map(|setting| (field, &setting.node))
            })
        });
        let mut scenario = self.template.with(changes)?;
        for file in scenario.motion.files_mut() {
            let held = self.held.iter().find(|held| held.resolve() == file.resolve());
            *file = held.unwrap_or(file).clone();
        }
        Ok(scenario)
    }

    /// Returns the names and the unscaled motions of the study.
    ///
    /// # Errors
    /// If a motion cannot be read or generated; the error names the first such motion.
    pub fn grounds(&self) -> Result<Vec<(String, Arc<Ground>)>, StudyError> {
        let (cache, base) = (MotionCache::default(), self.scenario(&[])?);
        let ground = |motion: &Motion| {
            let shaken = cache.unscaled(motion, &base.motion, base.run.similitude)?;
            Ok((motion.name.clone(), Arc::clone(&shaken.ground)))
        };
        self.motions.iter().map(ground).collect()
    }

    /// Returns the scaled motion of a case.
    fn shaken(
        &self,
        case: &PlannedCase,
        scenario: &Scenario,
        cache: &MotionCache,
    ) -> Result<Shaken, StudyError> {
        let level = self.intensity.as_ref().map(|intensity| intensity.measure).zip(case.level);
        let motion = &self.motions[case.motion];
        cache.at_level(motion, &scenario.motion, scenario.run.similitude, level)
    }

    /// Reads every motion before any run, so that an invalid file is reported early.
    ///
    /// # Errors
    /// If a motion cannot be read or generated; the error names the first such motion.
    pub(super) fn try_motions(&self, cache: &MotionCache) -> Result<(), StudyError> {
        let scenario = self.scenario(&[])?;
        let mut tried: Option<&Synthetic> = None;
        for motion in &self.motions {
            // Realizations of an ensemble differ only in their seeds, so it is enough to generate the first.
            if let Shaking::Synthetic(synthetic) = &motion.shaking {
                if tried.is_some_and(|tried| {
                    Synthetic { seed: tried.seed, ..(**synthetic).clone() } == *tried
                }) {
                    continue;
                }
                tried = Some(synthetic);
            }
            cache.unscaled(motion, &scenario.motion, scenario.run.similitude)?;
            if self.in_space {
                cache.in_space(motion, &scenario.motion, scenario.run.similitude)?;
            }
        }
        Ok(())
    }
}

/// Returns an error for scenarios that a study cannot run: a stack that is simulated in two planes (across and along
/// the barrels), and a three-dimensional free scene.
pub(super) fn runs(top: &Reader<'_>, scenario: &Scenario) -> Result<(), ScenarioError> {
    let message = match (&scenario.scene, scenario.stack()) {
        (Scene::Spatial(_), _) => {
            "a study runs stacks, and free scenes in a plane, but not three-dimensional free scenes: use another base"
                .to_owned()
        }
        (_, Some(stack)) => {
            let Some(along) = stack.columns_along else { return Ok(()) };
            format!(
                "a study simulates a stack in one plane or in three dimensions, but not in both planes. Leave \
                 `base.stack.columns_along` out \
                 and make a study for each plane of this stack: one with `base.stack.view = \"transverse\"` and \
                 `base.stack.columns = {}`, the other with `base.stack.view = \"longitudinal\"` and \
                 `base.stack.columns = {along}`, shaken by the other horizontal component of each record; or set \
                 `base.stack.view` to \"spatial\"",
                stack.columns
            )
        }
        _ => return Ok(()),
    };
    Err(top.inconsistent("base", message))
}
