//! Analyses of several runs or records: comparisons, safe heights, protections, scores, record sets, and
//! the reproduction of Candia, de la Llera and Almazán (2008).

use std::ops::ControlFlow;
use std::path::PathBuf;

use barrelstack::RunFailure;
use barrelstack::compare::{Comparison, aligned, check, document, labels, sides};
use barrelstack::variants::RunChoice;
use barrelstack_campaign::decision::SiteHazard;
use barrelstack_campaign::heights::{
    HeightsError, Request as HeightsRequest, heights as all_heights,
};
use barrelstack_campaign::protect::{
    ProtectError, Reached, Request as ProtectRequest, Shaking, VELOCITIES, protect as rank,
};
use barrelstack_campaign::score::{Protocol, ScoreError, score as score_of};
use barrelstack_campaign::study::RunOptions;
use barrelstack_motion::TargetSpectrum;
use barrelstack_reproduction::{ReproduceError, reproduce as run_all};
use barrelstack_selection::{Candidate, Choosing, Condition, SelectionTarget, select as choose};
use barrelstack_space::AnyAnswer;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use serde_json::json;

use crate::errors;
use crate::interruptible::run_interruptible;
use crate::page::Page;
use crate::scenario::{Scenario, report_advance, with_variants};

/// Runs scenarios and compares them; scenarios without a name are named by their differences.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    scenarios: Vec<(String, PyRef<'_, Scenario>)>,
    named: bool,
    variants: Option<u32>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let mut all = Vec::new();
    for (name, scenario) in &scenarios {
        all.push((name.clone(), with_variants(&scenario.inner, variants)?.0));
    }
    check(&all).map_err(errors::general)?;
    if !named {
        let found = labels(&all);
        all.iter_mut().zip(found).for_each(|((name, _), label)| *name = label);
    }
    let compared = run_interruptible(py, progress, |state| {
        let mut answers = Vec::new();
        for (at, (name, scenario)) in all.iter().enumerate() {
            let answer =
                AnyAnswer::of(scenario, RunChoice::Typical, &mut |now| report_advance(state, now));
            answers.push((name.clone(), answer.map_err(|failure| (failure, at))?));
            if state.stopped() {
                break;
            }
        }
        let answers = aligned(answers, &mut |now| report_advance(state, now))
            .map_err(|failure| (failure, 0))?;
        Ok(sides(answers))
    })?;
    let compared =
        compared.map_err(|(failure, at): (RunFailure, usize)| errors::run(&failure, &all[at].1))?;
    py.detach(|| Page::of(&Comparison::of(&compared, Vec::new()), document(&compared)))
}

/// Computes the probability of collapse of stacks by height, direction and strength of shaking.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python function")]
pub(crate) fn heights(
    py: Python<'_>,
    folder: PathBuf,
    rack: String,
    barrel: String,
    records: Vec<PathBuf>,
    synthetic: u32,
    seed: u32,
    highest: u32,
    in_space: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let request = HeightsRequest { rack, barrel, records, synthetic, seed, highest, in_space };
    let found = run_interruptible(py, progress, |state| {
        all_heights(&request, &folder, &RunOptions::default(), &|done, of| {
            state.report(done as f64, of as f64, "runs")
        })
    })?;
    let found = found.map_err(|error| match error {
        HeightsError::Study(error) => errors::study(error),
        other @ (HeightsError::Rack(..)
        | HeightsError::Barrel(..)
        | HeightsError::Levels(_)
        | HeightsError::Stack(_)
        | HeightsError::Decision(_)) => errors::study_result(other),
    })?;
    let mut document = found.document.clone();
    document.warnings.clone_from(&found.warnings);
    Page::of(&found.to_document(), document)
}

/// Ranks protections of a stack, such as other racks and devices, by benefit and cost. The shaking is given by the
/// hazard curve in the file `site` or by the peak ground velocities `velocities` (m/s).
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python function")]
pub(crate) fn protect(
    py: Python<'_>,
    scenario: &Scenario,
    folder: PathBuf,
    site: Option<PathBuf>,
    velocities: Option<Vec<f64>>,
    records: Vec<PathBuf>,
    motions: Option<PathBuf>,
    count: u32,
    rounds: u32,
    budget: Option<f64>,
    seed: u32,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let shaking = match (site, velocities) {
        (Some(file), _) => Shaking::Site(SiteHazard::load(&file).map_err(errors::study_result)?),
        (None, Some(velocities)) => Shaking::Levels(velocities),
        (None, None) => Shaking::Levels(VELOCITIES.to_vec()),
    };
    let request = ProtectRequest {
        scenario: (*scenario.inner).clone(),
        shaking,
        records,
        folder: motions,
        motions: count,
        rounds,
        budget,
        seed,
    };
    let found = run_interruptible(py, progress, |state| {
        let report = |Reached { done, of, .. }| state.report(done as f64, of as f64, "runs");
        let mut found = rank(&request, &folder, &RunOptions::default(), &report)?;
        found.show_before_and_after(&mut |now| report_advance(state, now))?;
        Ok(found)
    })?;
    let found = found.map_err(|error| match error {
        ProtectError::Study(error) => errors::study(error),
        ProtectError::Scenario(error) => errors::scenario(&error),
        ProtectError::Ground(error) => errors::ground(&error),
        ProtectError::Stack(failure) => errors::run(&failure, &request.scenario),
        other @ (ProtectError::NoStack(_)
        | ProtectError::Hazard { .. }
        | ProtectError::Decision(_)) => errors::study_result(other),
    })?;
    Page::of(&found.to_document(), found.document)
}

/// Computes the RockScore of the rack and the devices of a stack.
#[pyfunction]
pub(crate) fn score(
    py: Python<'_>,
    scenario: &Scenario,
    folder: PathBuf,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let sheet = run_interruptible(py, progress, |state| {
        let report = |done: u64, of: u64| state.report(done as f64, of as f64, "runs");
        let protocol = Protocol::rockscore();
        score_of(&scenario.inner, &protocol, &folder, &RunOptions::default(), &report)
    })?;
    let sheet = sheet.map_err(|error| match error {
        ScoreError::Study(error) => errors::study(error),
        ScoreError::Ground(error) => errors::ground(&error),
        ScoreError::Stack(failure) => errors::run(&failure, &scenario.inner),
        ScoreError::State { ref source, .. } => errors::study_result(format!("{error}: {source}")),
        ScoreError::Curve { ref source, .. } => errors::study_result(format!("{error}: {source}")),
        other @ (ScoreError::NoStack(_) | ScoreError::Decision(_)) => errors::study_result(other),
    })?;
    Page::of(&sheet.to_document(), sheet.document)
}

/// A set of records: indices and scale factors of the selected records; mean and standard deviation
/// of ln Sa, first of the target and then of the set; number of candidates.
type SetFacts = (Vec<(usize, f64)>, [Vec<f64>; 4], usize);

/// Selects spectra (m/s²) that together match the mean and the standard deviation of a target. The
/// spectra are given at the periods (s) of the target.
///
/// The target is the name of a code, or medians (m/s²) and standard deviations of ln Sa. `given` is
/// a period (s) with the pseudo-acceleration (m/s²) at that period.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python function")]
pub(crate) fn select(
    py: Python<'_>,
    periods: Vec<f64>,
    target: &Bound<'_, PyAny>,
    given: Option<(f64, f64)>,
    candidates: Vec<(String, Vec<f64>, String)>,
    count: usize,
    scale: [f64; 2],
    most_of_group: Option<usize>,
    seed: u64,
) -> PyResult<SetFacts> {
    let target = if let Ok(code) = target.extract::<String>() {
        let spectrum: TargetSpectrum = code.parse().map_err(errors::motion)?;
        SelectionTarget::of_spectrum(&spectrum, &periods)
    } else {
        let (median, deviation): (Vec<f64>, Vec<f64>) = target.extract()?;
        let given = given.map(|(period, acceleration)| Condition { period, acceleration });
        SelectionTarget::new(&periods, &median, &deviation, given)
    };
    let target = target.map_err(errors::motion)?;
    let candidate = |(name, spectrum, group)| Candidate { name, spectrum, group };
    let candidates: Vec<Candidate> = candidates.into_iter().map(candidate).collect();
    let choosing = Choosing { count, scale, most_of_group, seed };
    let set = py.detach(|| choose(&target, &candidates, &choosing)).map_err(errors::motion)?;
    let chosen = set.chosen.iter().map(|one| (one.candidate, one.scale)).collect();
    let (mean, deviation) = (target.mean().to_vec(), target.deviation().to_vec());
    Ok((chosen, [mean, deviation, set.mean, set.deviation], set.eligible))
}

/// Reproduces the numbers and figures of Candia, de la Llera and Almazán (2008).
#[pyfunction]
pub(crate) fn reproduce(
    py: Python<'_>,
    record: Option<PathBuf>,
    studies: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let found = run_interruptible(py, progress, |state| {
        run_all(record.as_deref(), studies, &|done, of| -> ControlFlow<()> {
            state.report(done as f64, of as f64, "runs")
        })
    })?;
    let found = found.map_err(|error| match error {
        ReproduceError::Scenario(error) => errors::scenario(&error),
        ReproduceError::Record(error) => errors::ground(&error),
        ReproduceError::Stopped { .. } => PyKeyboardInterrupt::new_err(()),
        other @ (ReproduceError::Run { .. } | ReproduceError::Lost { .. }) => {
            errors::general(other)
        }
    })?;
    let row = |one: &barrelstack_reproduction::Comparison| {
        json!({
            "place": one.place,
            "quantity": one.quantity,
            "published": one.published,
            "ours": one.ours,
            "difference": one.difference,
            "band": one.band,
            "verdict": one.agreement.words(),
            "why": one.why,
        })
    };
    let rows: Vec<_> = found.comparisons.iter().map(row).collect();
    Page::of(&rows, found.document)
}
