//! Scenarios, which can be read, changed and run.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use barrelstack::ground::from_disk;
use barrelstack::scenario::{Scene, builtin, reference as fields_of, schema as schema_of};
use barrelstack::variants::{self, Advance, Answer, Attempt, RunChoice, Shown};
use barrelstack::verify::verify;
use barrelstack::watch::Pace;
use barrelstack::{RunFailure, Summary};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors;
use crate::interruptible::{POLL, ProgressState, run_interruptible};
use crate::record::{Record, of_motion};
use crate::run::{Glance, Run};
use crate::space::SpatialRun;
use crate::value;

/// Python handle of a `barrelstack::Scenario`.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Scenario {
    pub(crate) inner: Arc<barrelstack::Scenario>,
}

impl Scenario {
    fn of(
        read: Result<barrelstack::Scenario, barrelstack::scenario::ScenarioError>,
    ) -> PyResult<Self> {
        read.map(|inner| Self { inner: Arc::new(inner) }).map_err(|error| errors::scenario(&error))
    }
}

#[pymethods]
impl Scenario {
    #[staticmethod]
    fn load(path: PathBuf, changes: Vec<String>) -> PyResult<Self> {
        Self::of(barrelstack::Scenario::load(&path, &changes))
    }

    #[staticmethod]
    fn parse(name: &str, text: &str, changes: Vec<String>) -> PyResult<Self> {
        Self::of(barrelstack::Scenario::parse(name, text, &changes))
    }

    #[staticmethod]
    fn builtin(name: &str, changes: Vec<String>) -> PyResult<Self> {
        Self::of(barrelstack::Scenario::builtin(name, &changes))
    }

    #[staticmethod]
    fn from_tree(name: &str, tree: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::of(barrelstack::Scenario::from_tree(name, value::table(tree)?))
    }

    pub(crate) fn changed(&self, changes: Vec<String>) -> PyResult<Self> {
        Self::of(self.inner.with(&changes))
    }

    fn with_record(&self, record: &Record) -> PyResult<Self> {
        let inner = self.inner.with_record(&record.inner).map_err(errors::motion)?;
        Ok(Self { inner: Arc::new(inner) })
    }

    #[getter]
    fn title(&self) -> &str {
        &self.inner.title
    }

    #[getter]
    fn fingerprint(&self) -> String {
        format!("{:016x}", self.inner.fingerprint())
    }

    fn to_toml(&self) -> String {
        self.inner.to_resolved_toml()
    }

    /// Returns path, value and meaning of every field.
    fn settings(&self) -> Vec<(String, String, &'static str)> {
        let settings = self.inner.settings().into_iter();
        settings.map(|setting| (setting.path, setting.value, setting.help)).collect()
    }

    /// Returns the ground motion as a record; `None` if the scenario has no motion.
    fn ground(&self, py: Python<'_>) -> PyResult<Option<Record>> {
        let ground = py.detach(|| self.inner.ground()).map_err(|error| errors::ground(&error))?;
        ground.motion.as_ref().map(of_motion).transpose()
    }

    /// Checks the scenario in each of its planes. Returns the findings for each plane as JSON.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let found = py.detach(|| {
            let spatial = self.inner.is_spatial();
            let one = if spatial { barrelstack_space::check } else { barrelstack::check };
            let planes = variants::planes(&self.inner)?;
            planes.iter().map(|plane| one(&plane.scenario)).collect::<Result<Vec<_>, _>>()
        });
        let found = found.map_err(|error: RunFailure| errors::run(&error, &self.inner))?;
        found.iter().map(|one| serde_json::to_string(one).map_err(errors::general)).collect()
    }

    #[pyo3(signature = (variants, variant, remedy, repeats, progress))]
    fn run(
        &self,
        py: Python<'_>,
        variants: Option<u32>,
        variant: Option<u32>,
        remedy: bool,
        repeats: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Run> {
        let (scenario, count) = with_variants(&self.inner, variants)?;
        let choice = run_choice(variant, count)?;
        let answer = run_interruptible(py, progress, |state| {
            let mut answer =
                variants::answer(&scenario, choice, &mut |now| report_advance(state, now))?;
            if remedy && !state.stopped() {
                let found = variants::remedy(&answer, &|attempt| report_attempt(state, attempt))?;
                answer.decides.summary.remedy = found;
            }
            if repeats && !state.stopped() {
                let found = verify(&answer.decides.run, &mut |now| {
                    state.report(now.time, now.end_time, "s of repeats")
                })?;
                answer.decides.summary.verification = Some(found);
            }
            Ok(answer)
        })?;
        answer.map(Run::of).map_err(|error: RunFailure| errors::run(&error, &scenario))
    }

    #[getter]
    fn is_spatial(&self) -> bool {
        self.inner.is_spatial()
    }

    #[pyo3(signature = (variants, variant, remedy, repeats, progress))]
    fn run_in_space(
        &self,
        py: Python<'_>,
        variants: Option<u32>,
        variant: Option<u32>,
        remedy: bool,
        repeats: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<SpatialRun> {
        let (scenario, count) = with_variants(&self.inner, variants)?;
        let choice = run_choice(variant, count)?;
        let answer = run_interruptible(py, progress, |state| {
            let mut answer = barrelstack_space::answer(&scenario, choice, &mut |now| {
                report_advance(state, now)
            })?;
            if remedy && !state.stopped() {
                answer.summary.remedy = barrelstack_space::variants::remedy(&answer, &|attempt| {
                    report_attempt(state, attempt)
                })?;
            }
            if repeats && !state.stopped() {
                let found = verify(&answer.run, &mut |now| {
                    state.report(now.time, now.end_time, "s of repeats")
                })?;
                answer.summary.verification = Some(found);
            }
            Ok(answer)
        })?;
        answer.map(SpatialRun::of).map_err(|error: RunFailure| errors::run(&error, &scenario))
    }

    /// Runs the scenario, without variants, in its first plane, and calls an observer function.
    ///
    /// The observer `look` is called at every step whose number is a multiple of `every`. A true return value stops
    /// the run.
    fn run_before(
        &self,
        py: Python<'_>,
        every: NonZero<u64>,
        look: &Bound<'_, PyAny>,
    ) -> PyResult<Run> {
        let look = look.clone().unbind();
        let mut raised = None;
        let done = py.detach(|| -> Result<Answer, RunFailure> {
            let scenario = self.inner.with_records(&mut from_disk)?;
            let plane = variants::planes(&scenario)?.remove(0);
            let stated = plane.scenario;
            let mut listened = Instant::now();
            let mut eye = |glance: barrelstack::watch::Glance<'_>| {
                let due = glance.steps.is_multiple_of(every.get());
                if !due && listened.elapsed() < POLL {
                    return ControlFlow::Continue(());
                }
                listened = Instant::now();
                let observed = Python::attach(|py| {
                    py.check_signals()?;
                    if !due {
                        return Ok(false);
                    }
                    let view = Bound::new(py, Glance::of(py, &glance)?)?;
                    look.bind(py).call1((view,))?.is_truthy()
                });
                match observed {
                    Ok(false) => ControlFlow::Continue(()),
                    Ok(true) => ControlFlow::Break(()),
                    Err(error) => {
                        raised = Some(error);
                        ControlFlow::Break(())
                    }
                }
            };
            // Called at every step, so that Ctrl-C is handled between two calls of the observer.
            let run =
                stated.run_before(stated.ground()?, Pace::Steps(NonZero::<u64>::MIN), &mut eye)?;
            let summary = Summary::of(&run, None);
            Ok(Answer {
                scenario,
                decides: Shown { run, summary, variants: None, stopped: None },
                other: None,
            })
        });
        match (raised, done) {
            (Some(error), _) => Err(error),
            (None, Ok(answer)) => Ok(Run::of(answer)),
            (None, Err(error)) => Err(errors::run(&error, &self.inner)),
        }
    }
}

/// Selects the run to show of a scenario with `count` variants: the run with the number `variant`, or the most
/// typical run if `variant` is `None`.
fn run_choice(variant: Option<u32>, count: u32) -> PyResult<RunChoice> {
    match variant {
        Some(number) if number > count => Err(PyValueError::new_err(format!(
            "there is no variant {number}: variants are numbered from 1 to {count}, and 0 is the stack as stated"
        ))),
        Some(number) => Ok(RunChoice::Number(number)),
        None => Ok(RunChoice::Typical),
    }
}

/// Returns a copy of the scenario with `variants` variants, and its number of variants. If `variants` is `None`, the
/// number of variants remains unchanged.
pub(crate) fn with_variants(
    of: &barrelstack::Scenario,
    variants: Option<u32>,
) -> PyResult<(barrelstack::Scenario, u32)> {
    let mut scenario = of.clone();
    let count = match &mut scenario.scene {
        Scene::Stack { imperfections, .. } => {
            imperfections.variants = variants.unwrap_or(imperfections.variants);
            imperfections.variants
        }
        Scene::Free(_) | Scene::Spatial(_) if variants.is_some_and(|count| count > 0) => {
            return Err(PyValueError::new_err(
                "a free scene has no variants, because it states no imperfections",
            ));
        }
        Scene::Free(_) | Scene::Spatial(_) => 0,
    };
    Ok((scenario, count))
}

/// Reports the progress of a run and its variants.
pub(crate) fn report_advance(state: &ProgressState, now: Advance) -> ControlFlow<()> {
    match now {
        Advance::Variants { done, of } => state.report(done as f64, of as f64, "variants"),
        Advance::First { .. } => ControlFlow::Continue(()),
        Advance::Run(now) => state.report(now.time, now.end_time, "s"),
    }
}

/// Reports the progress of a search for changes that keep the stack up.
fn report_attempt(state: &ProgressState, now: Attempt<'_>) -> ControlFlow<()> {
    state.report(now.done as f64, now.of as f64, now.counted())
}

/// Returns the name and the content of each bundled scenario.
#[pyfunction]
pub(crate) fn scenarios() -> Vec<(&'static str, &'static str)> {
    builtin::names().filter_map(|name| Some((name, builtin::get(name)?))).collect()
}

/// Returns the JSON Schema of scenario files, of study files, or of the summary.
#[pyfunction]
pub(crate) fn schema(of: &str) -> PyResult<String> {
    let schema = match of {
        "scenario" => schema_of::json_schema(),
        "study" => barrelstack_campaign::study::json_schema(),
        "summary" => barrelstack_report::described::document::<Summary>("summary"),
        other => {
            return Err(PyValueError::new_err(format!(
                "there is no schema of \"{other}\"; choose \"scenario\", \"study\" or \"summary\""
            )));
        }
    };
    serde_json::to_string(&schema).map_err(errors::general)
}

/// Returns the reference documentation of scenario files or of study files, in Markdown.
#[pyfunction]
pub(crate) fn reference(of: &str) -> PyResult<String> {
    match of {
        "scenario" => Ok(fields_of::markdown()),
        "study" => Ok(barrelstack_campaign::study::reference()),
        other => Err(PyValueError::new_err(format!(
            "there is no reference documentation for \"{other}\"; choose \"scenario\" or \"study\""
        ))),
    }
}

/// Returns path, unit and meaning of every key in the summary of a run.
#[pyfunction]
pub(crate) fn fields() -> Vec<(String, String, String)> {
    let schema = barrelstack_report::described::document::<Summary>("summary");
    let rows = barrelstack_report::described::dictionary(&schema);
    rows.into_iter().map(|[path, unit, meaning]| (path, unit, meaning)).collect()
}

/// Converts a byte slice to a Python `bytes` object.
pub(crate) fn bytes<'py>(py: Python<'py>, of: &[u8]) -> Bound<'py, PyBytes> {
    PyBytes::new(py, of)
}
