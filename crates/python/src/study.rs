//! Studies, which can be planned, run in chunks, collected and evaluated.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use barrelstack::ensemble::Width;
use barrelstack::ground::Ground;
use barrelstack_campaign::decision::{Request, SiteHazard, decide_folder, export as exported};
use barrelstack_campaign::study::{
    self, ChunkRun, Collected, Progress, RunOptions, StudyError, collect,
};
use pyo3::prelude::*;

use crate::errors;
use crate::interruptible::{ProgressState, run_interruptible};
use crate::page::Page;
use crate::record::{Record, of_motion};
use crate::table::Table;

/// Python handle of a `barrelstack_campaign::study::Study`.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Study {
    inner: Arc<study::Study>,
}

/// Name and content of a file.
type NamedText = (&'static str, String);

/// A chunk: its number, its number of cases, its first case and its last case.
type ChunkFacts = (usize, usize, u64, u64);

impl Study {
    fn of(read: Result<study::Study, StudyError>) -> PyResult<Self> {
        read.map(|inner| Self { inner: Arc::new(inner) }).map_err(errors::study)
    }
}

#[pymethods]
impl Study {
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        Self::of(study::Study::load(&path))
    }

    #[staticmethod]
    fn parse(name: &str, text: &str) -> PyResult<Self> {
        Self::of(study::Study::parse(name, text))
    }

    #[staticmethod]
    fn builtin(name: &str) -> PyResult<Self> {
        Self::of(study::Study::built_in(name))
    }

    #[getter]
    fn title(&self) -> &str {
        &self.inner.title
    }

    #[getter]
    fn design(&self) -> &'static str {
        self.inner.design.name()
    }

    #[getter]
    fn fingerprint(&self) -> String {
        format!("{:016x}", self.inner.hash())
    }

    #[getter]
    fn cases(&self) -> u64 {
        self.inner.cases()
    }

    #[getter]
    fn motions(&self) -> usize {
        self.inner.motions()
    }

    fn chunks(&self) -> Vec<ChunkFacts> {
        self.inner
            .plan()
            .map(|chunk| (chunk.number, chunk.cases, chunk.first, chunk.last))
            .collect()
    }

    /// Runs the chunks of the study whose shards are missing from a folder.
    fn run(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        threads: Option<NonZero<usize>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let options = RunOptions { threads, lanes: None };
        let done = run_interruptible(py, progress, |state| {
            self.inner.run_all(&folder, &options, &|now| report_cases(state, now))?;
            collect(&folder, &mut |_, _| Ok(())).map(drop)
        })?;
        done.map_err(errors::study)
    }

    /// Runs one chunk, unless its shard exists; returns `true` if the chunk was run.
    fn run_chunk(&self, py: Python<'_>, folder: PathBuf, chunk: usize) -> PyResult<bool> {
        let done = run_interruptible(py, None, |state| {
            self.inner.run_chunk(&folder, chunk, Width::widest(), &|| state.stopped())
        })?;
        Ok(done.map_err(errors::study)? != ChunkRun::Before)
    }

    /// Returns the motions of the study by name, unscaled.
    fn records(&self, py: Python<'_>) -> PyResult<Vec<(String, Record)>> {
        let grounds = py.detach(|| self.inner.grounds()).map_err(errors::study)?;
        let record = |(name, ground): (String, Arc<Ground>)| {
            let motion = ground.motion.as_ref()?;
            Some(of_motion(motion).map(|record| (name, record)))
        };
        grounds.into_iter().filter_map(record).collect()
    }

    /// Runs the study in memory, without a folder, and returns the table of its results.
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        let table = py.detach(|| self.inner.table()).map_err(errors::study)?;
        Ok(Table { columns: table.columns().to_vec() })
    }
}

fn report_cases(state: &ProgressState, now: &Progress) -> ControlFlow<()> {
    state.report((now.before + now.now) as f64, now.cases as f64, "cases")
}

/// Returns the name and the content of each bundled study.
#[pyfunction]
pub(crate) fn studies() -> Vec<(&'static str, &'static str)> {
    study::builtin_names().filter_map(|name| Some((name, study::builtin(name)?))).collect()
}

/// Returns the finished rows of the study in a folder. If `write` is `true`, also writes the rows into the folder, as
/// tables.
#[pyfunction]
pub(crate) fn read_table(py: Python<'_>, folder: PathBuf, write: bool) -> PyResult<Table> {
    let read = py.detach(|| {
        if write {
            collect(&folder, &mut |_, _| Ok(()))?;
        }
        Collected::read(&folder)
    });
    Ok(Table { columns: read.map_err(errors::study)?.table.columns().to_vec() })
}

/// Returns the provenance of the rows in a folder as JSON, and the missing chunks.
#[pyfunction]
pub(crate) fn provenance(py: Python<'_>, folder: PathBuf) -> PyResult<(String, Vec<usize>)> {
    let status = py.detach(|| Collected::status(&folder)).map_err(errors::study)?;
    let made = serde_json::to_string(&status.provenance).map_err(errors::general)?;
    Ok((made, status.missing))
}

fn request(hazard: Option<&Path>, years: Option<f64>) -> PyResult<Request> {
    let hazard = hazard.map(SiteHazard::load).transpose().map_err(errors::study_result)?;
    Ok(Request { hazard, years })
}

/// Evaluates the study in a folder, finished or not. Returns the page with its curves, losses and rates.
#[pyfunction]
pub(crate) fn decision(
    py: Python<'_>,
    folder: PathBuf,
    hazard: Option<PathBuf>,
    years: Option<f64>,
) -> PyResult<Page> {
    let request = request(hazard.as_deref(), years)?;
    let (decision, _) =
        py.detach(|| decide_folder(&folder, &request)).map_err(errors::study_result)?;
    Page::of(&decision.to_document(), decision.document)
}

/// Exports the fragility curves of the study that `folder` contains, in formats of other programs.
/// Returns the name and the content of each file, and a list of the parts that cannot be exported.
#[pyfunction]
pub(crate) fn export(
    py: Python<'_>,
    folder: PathBuf,
    asset: &str,
) -> PyResult<(Vec<NamedText>, Vec<String>)> {
    let decided = py.detach(|| decide_folder(&folder, &Request::default()));
    let (decision, made) = decided.map_err(errors::study_result)?;
    let found = exported(&decision, &made, asset).map_err(errors::study_result)?;
    Ok((found.files, found.notes))
}
