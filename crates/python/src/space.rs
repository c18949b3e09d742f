//! Three-dimensional runs: summaries, trajectories of the bodies, pages and files.

use std::path::PathBuf;
use std::sync::Arc;

use barrelstack::export::Folder;
use barrelstack::render::Rendering;
use barrelstack_report::Format;
use barrelstack_space::drawing::coarse_scene;
use barrelstack_space::report::{document, player};
use barrelstack_space::run::Frames;
use barrelstack_space::{Answer, columns, export, words};
use numpy::{PyArray1, PyArray3, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors;
use crate::page::{html_in, language_of, paper_of, pdf_in};
use crate::run::{animated, chosen, rendered};
use crate::table::Table;
use crate::view::{Numbers, view};

/// Results of a three-dimensional scenario.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct SpatialRun {
    answer: Arc<Answer>,
}

impl SpatialRun {
    pub(crate) fn of(answer: Answer) -> Self {
        Self { answer: Arc::new(answer) }
    }

    fn frames(&self) -> &Frames {
        &self.answer.run.frames
    }

    /// Combines numbers that are given per frame and body into one array.
    fn stacked<'py, const N: usize>(
        &self,
        py: Python<'py>,
        frames: &[Vec<[f64; N]>],
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let flat = PyArray1::from_iter(py, frames.iter().flatten().flatten().copied());
        flat.reshape([frames.len(), self.answer.run.stack.parts.len(), N])
    }
}

#[pymethods]
impl SpatialRun {
    #[getter]
    fn headline(&self) -> String {
        words::headline(&self.answer.run, &self.answer.summary)
    }

    fn summary(&self) -> String {
        self.answer.summary.to_json()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.answer.run.warnings.clone()
    }

    #[getter]
    fn toml(&self) -> String {
        self.answer.run.scenario.to_resolved_toml()
    }

    /// Returns name and kind of every body, in the order of the poses.
    fn bodies(&self) -> Vec<(String, &'static str)> {
        let parts = self.answer.run.stack.parts.iter();
        parts.map(|part| (part.name.clone(), part.kind.name())).collect()
    }

    fn frame_times<'py>(slf: &Bound<'py, Self>) -> PyResult<Numbers<'py>> {
        view(slf.as_any(), &slf.get().frames().times)
    }

    /// Returns position (m) and quaternion `w`, `x`, `y`, `z` for every frame and body.
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, &self.frames().poses)
    }

    /// Returns velocity (m/s) and angular velocity (rad/s) for every frame and body.
    fn twists<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, &self.frames().twists)
    }

    /// Returns a table with one row for the nominal case and for each variant; `None` if no
    /// variants were run.
    fn variants(&self) -> Option<Table> {
        let cases = &self.answer.cases;
        if cases.is_empty() {
            return None;
        }
        Some(Table { columns: columns::variants(cases) })
    }

    #[pyo3(signature = (language = "en"))]
    fn html(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        html_in(py, language, || document(&self.answer))
    }

    fn pdf<'py>(
        &self,
        py: Python<'py>,
        paper: &str,
        language: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        pdf_in(py, (paper, language), || document(&self.answer))
    }

    /// Returns a page that contains only an animation of the run.
    fn animation(&self, py: Python<'_>, rate: f64, between: Option<[f64; 2]>) -> PyResult<String> {
        let run = &self.answer.run;
        let of_run = (run.scenario.title.as_str(), run.end_time);
        let across = || Arc::new(coarse_scene(run));
        animated(py, of_run, (rate, between), across, |scene| player(run, scene))
    }

    /// Writes the requested parts of the rendering, such as figures or an animation. Returns, for each part,
    /// its folder or file and the number of files written.
    #[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python function")]
    fn render(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        parts: Vec<String>,
        formats: Vec<String>,
        dpi: f64,
        paper: &str,
        rate: f64,
        between: Option<[f64; 2]>,
        largest: u32,
        overwrite: bool,
        language: &str,
    ) -> PyResult<Vec<(PathBuf, usize)>> {
        let formats = chosen("format", &formats, Format::ALL, Format::extension)?;
        let (paper, language) = (paper_of(paper)?, language_of(language)?);
        let how = Rendering { formats, dpi, paper, rate, between, largest, language };
        rendered(py, (&folder, &parts, overwrite), (&how, self.answer.run.end_time), |folder| {
            export::render(&self.answer, folder, &how)
        })
    }

    /// Writes the same files as a run on the command line. `stated` is the content of `scenario.toml`.
    fn write(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        stated: &str,
        overwrite: bool,
        language: &str,
    ) -> PyResult<()> {
        let language = language_of(language)?;
        let written = py.detach(|| {
            let folder = Folder::prepare(&folder, overwrite)?;
            folder.write_files(&export::files(&self.answer, stated, language))
        });
        written.map_err(errors::general)
    }
}
