//! Planar runs: outcomes, histories, pages and files. NumPy arrays of histories share memory with the run.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use barrelstack::ensemble;
use barrelstack::export::{ExportError, Folder};
use barrelstack::render::{Part, RenderFolder, Rendered, Rendering};
use barrelstack::report;
use barrelstack::variants::{Answer, Shown};
use barrelstack::watch::{Joint, StressEnvelope};
use barrelstack_input::names::advice;
use barrelstack_report::{Format, Player, Scene, player_html};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods as _};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors;
use crate::page::{html_in, language_of, paper_of, pdf_in};
use crate::table::Table;
use crate::view::{Numbers, Rows, rows, view};

/// Results of a scenario in one plane. If the scenario has two planes, this is either the governing plane, in which
/// more variants collapse, or the other plane.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Run {
    answer: Arc<Answer>,
    /// `true` for the results in the plane that does not govern, [`Answer::other`].
    beside: bool,
}

/// The largest forces between two bodies: vertical (N) and its time (s), horizontal (N) and its
/// time (s).
type Peaks = ((f64, f64), (f64, f64));

/// Forces between two bodies: name, force at rest (N), largest forces until the first loss of a seat,
/// and over the whole run.
type JointFacts = (String, f64, Peaks, Peaks);

impl Run {
    pub(crate) fn of(answer: Answer) -> Self {
        Self { answer: Arc::new(answer), beside: false }
    }

    fn shown(&self) -> &Shown {
        match &self.answer.other {
            Some(other) if self.beside => other,
            _ => &self.answer.decides,
        }
    }

    fn run(&self) -> &barrelstack::Run {
        &self.shown().run
    }

    fn envelope(&self, at: usize) -> PyResult<&StressEnvelope> {
        self.run().stresses.envelopes.get(at).ok_or_else(|| missing("envelope"))
    }
}

/// Returns the items of `all` whose names are in `names`, in the order of `all`. Returns all items if
/// `names` is empty. `what` is the word for an item in error messages.
///
/// # Errors
/// If one of the names does not belong to any item of `all`.
pub(crate) fn chosen<T: Copy, const N: usize>(
    what: &str,
    names: &[String],
    all: [T; N],
    name: impl Fn(T) -> &'static str,
) -> PyResult<Vec<T>> {
    if let Some(other) = names.iter().find(|given| !all.iter().any(|one| name(*one) == **given)) {
        let next = advice(other, &all.map(&name));
        return Err(PyValueError::new_err(format!("there is no {what} {other:?}; {next}")));
    }
    let requested = |one: &T| names.is_empty() || names.iter().any(|given| *given == name(*one));
    Ok(all.into_iter().filter(requested).collect())
}

/// Writes the requested parts of the rendering of a run, such as its figures or its animation. `end_time`
/// (s) is the end of the run. Returns, for each part, its folder or file and the number of files
/// written.
pub(crate) fn rendered(
    py: Python<'_>,
    (folder, parts, overwrite): (&Path, &[String], bool),
    (how, end_time): (&Rendering, f64),
    write: impl FnOnce(&RenderFolder) -> Result<Vec<Rendered>, ExportError> + Send,
) -> PyResult<Vec<(PathBuf, usize)>> {
    let parts = chosen("part", parts, Part::ALL, Part::name)?;
    how.check(end_time).map_err(PyValueError::new_err)?;
    let written = py.detach(|| {
        RenderFolder::prepare(folder, &parts, overwrite).and_then(|folder| write(&folder))
    });
    let written = written.map_err(errors::general)?;
    Ok(written.into_iter().map(|one| (one.place, one.files)).collect())
}

/// Returns a page that contains only an animation of a scene, which shows the time interval `between`
/// (s) with `rate` frames per second of simulated time.
pub(crate) fn animated(
    py: Python<'_>,
    (title, end_time): (&str, f64),
    (rate, between): (f64, Option<[f64; 2]>),
    scene: impl FnOnce() -> Arc<Scene> + Send,
    player: impl FnOnce(Scene) -> Player + Send,
) -> PyResult<String> {
    let how = Rendering { rate, between, ..Rendering::default() };
    how.check(end_time).map_err(PyValueError::new_err)?;
    Ok(py.detach(|| {
        let [from, to] = between.unwrap_or([0.0, f64::INFINITY]);
        player_html(title, &player(scene().between(from, to).thinned(rate)))
    }))
}

fn missing(what: &str) -> PyErr {
    PyIndexError::new_err(format!("there is no such {what}"))
}

#[pymethods]
impl Run {
    /// Returns the results in the other plane; `None` if the scenario has only one plane.
    fn other(&self) -> Option<Self> {
        let answer = Arc::clone(&self.answer);
        self.answer.other.as_ref().map(|_| Self { answer, beside: !self.beside })
    }

    #[getter]
    fn headline(&self) -> String {
        report::sentences(self.run(), &self.shown().summary).swap_remove(0)
    }

    fn summary(&self) -> String {
        self.shown().summary.to_json()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.run().warnings.clone()
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.run().interrupted
    }

    #[getter]
    fn toml(&self) -> String {
        self.run().scenario.to_resolved_toml()
    }

    /// Returns the times (s) of the samples of all histories.
    fn times<'py>(slf: &Bound<'py, Self>) -> PyResult<Numbers<'py>> {
        view(slf.as_any(), &slf.get().run().recording.times)
    }

    /// Returns the name and the unit of every history.
    fn channels(&self) -> Vec<(String, &'static str)> {
        let channels = self.run().recording.channels.iter();
        channels.map(|channel| (channel.name.clone(), channel.unit)).collect()
    }

    fn channel<'py>(slf: &Bound<'py, Self>, at: usize) -> PyResult<Numbers<'py>> {
        let channels = &slf.get().run().recording.channels;
        view(slf.as_any(), &channels.get(at).ok_or_else(|| missing("history"))?.values)
    }

    fn joints(&self) -> Vec<JointFacts> {
        let joints = self.run().recording.joints.iter();
        let facts = |joint: &barrelstack::watch::JointForces| {
            let Joint { at_rest, until_loss, whole_run, .. } = &joint.joint;
            let peaks = [until_loss, whole_run].map(|peaks| (peaks.vertical, peaks.horizontal));
            (joint.name.clone(), *at_rest, peaks[0], peaks[1])
        };
        joints.map(facts).collect()
    }

    /// Returns the histories of the vertical and the horizontal force (N) on the upper body of joint `at`.
    fn joint<'py>(slf: &Bound<'py, Self>, at: usize) -> PyResult<(Numbers<'py>, Numbers<'py>)> {
        let joint = slf.get().run().recording.joints.get(at).ok_or_else(|| missing("joint"))?;
        Ok((view(slf.as_any(), &joint.vertical)?, view(slf.as_any(), &joint.horizontal)?))
    }

    /// Returns name and kind of every body, in the order of the poses.
    fn bodies(&self) -> Vec<(String, &'static str)> {
        let parts = self.run().assembly.parts.iter();
        parts.map(|part| (part.name.clone(), part.kind.name())).collect()
    }

    fn frame_times<'py>(slf: &Bound<'py, Self>) -> PyResult<Numbers<'py>> {
        view(slf.as_any(), &slf.get().run().recording.frames.times)
    }

    /// Returns `x` (m), `z` (m) and angle (rad) for every frame and body.
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let poses = &self.run().recording.frames.poses;
        let bodies = self.run().assembly.parts.len();
        let flat = PyArray1::from_iter(py, poses.iter().flatten().flatten().copied());
        flat.reshape([poses.len(), bodies, 3])
    }

    /// Returns the largest contact stress (N/m) for every frame and body.
    fn frame_stresses<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let stresses = &self.run().recording.frames.stresses;
        let bodies = self.run().assembly.parts.len();
        PyArray1::from_iter(py, stresses.iter().flatten().copied())
            .reshape([stresses.len(), bodies])
    }

    /// Returns the contact forces of a frame, one row each: `x` (m), `z` (m), and the components
    /// (N) of the force on the contactor, the body of the pair whose nodes touch the other body.
    fn frame_forces<'py>(&self, py: Python<'py>, frame: usize) -> PyResult<Rows<'py>> {
        let forces =
            self.run().recording.frames.forces.get(frame).ok_or_else(|| missing("frame"))?;
        rows(py, forces.iter().copied())
    }

    /// Returns the bodies with an envelope of contact stresses, each with `true` if its boundary is
    /// closed.
    fn envelopes(&self) -> Vec<(String, bool)> {
        let name = |body: usize| self.run().assembly.parts[body].name.clone();
        self.run().stresses.envelopes.iter().map(|one| (name(one.body), one.closed)).collect()
    }

    /// Returns the boundary points of an envelope: `x` (m), `z` (m), coordinate along the boundary
    /// (rad or m), and length of the boundary (m) that the point represents.
    fn envelope_points<'py>(&self, py: Python<'py>, at: usize) -> PyResult<Rows<'py>> {
        let envelope = self.envelope(at)?;
        let points = envelope.points.iter().zip(&envelope.lengths);
        rows(py, points.map(|(p, length)| [p.position.x, p.position.z, p.coordinate, *length]))
    }

    /// Returns three stresses (N/m) for every point of an envelope: at rest, the largest until the first loss of a
    /// seat, and the largest over the whole run.
    fn envelope_stresses<'py>(
        slf: &Bound<'py, Self>,
        at: usize,
    ) -> PyResult<(Numbers<'py>, Numbers<'py>, Numbers<'py>)> {
        let envelope = slf.get().envelope(at)?;
        let numbers = |values| view(slf.as_any(), values);
        let peaks = (numbers(&envelope.peak)?, numbers(&envelope.peak_whole_run)?);
        Ok((numbers(&envelope.at_rest)?, peaks.0, peaks.1))
    }

    /// Returns a table with one row for the nominal case and for each variant; `None` if no
    /// variants were run.
    fn variants(&self) -> Option<Table> {
        let results = &self.shown().variants.as_ref()?.results;
        Some(Table { columns: ensemble::variants(results.iter()) })
    }

    #[pyo3(signature = (language = "en"))]
    fn html(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        html_in(py, language, || report::answer_document(&self.answer))
    }

    fn pdf<'py>(
        &self,
        py: Python<'py>,
        paper: &str,
        language: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        pdf_in(py, (paper, language), || report::answer_document(&self.answer))
    }

    /// Returns a page that contains only an animation of the run.
    fn animation(&self, py: Python<'_>, rate: f64, between: Option<[f64; 2]>) -> PyResult<String> {
        let run = self.run();
        let of_run = (run.scenario.title.as_str(), run.end_time);
        animated(
            py,
            of_run,
            (rate, between),
            || report::scene(run),
            |scene| report::player(run, &Arc::new(scene)),
        )
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
        let (run, summary) = (self.run(), &self.shown().summary);
        rendered(py, (&folder, &parts, overwrite), (&how, run.end_time), |folder| {
            folder.write(run, summary, &how)
        })
    }

    /// Writes the same files as a run on the command line.
    fn write(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        overwrite: bool,
        language: &str,
    ) -> PyResult<()> {
        let language = language_of(language)?;
        let written = py.detach(|| {
            let folder = Folder::prepare(&folder, overwrite)?;
            folder.write(&self.answer, language)
        });
        written.map_err(errors::general)
    }
}

/// State of a run, passed to an observer.
///
/// Examples
/// --------
/// >>> times = list()
/// >>> run = Scenario.load("sliding-block").observe(lambda glance: times.append(glance.time), every=50)
/// >>> assert min(times) == 0 and len(times) > 10
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Glance {
    #[pyo3(get)]
    time: f64,
    #[pyo3(get)]
    steps: u64,
    poses: Py<PyArray2<f64>>,
    twists: Py<PyArray2<f64>>,
}

impl Glance {
    pub(crate) fn of(py: Python<'_>, glance: &barrelstack::watch::Glance<'_>) -> PyResult<Self> {
        let poses = glance.state.poses.iter();
        let poses = rows(py, poses.map(|p| [p.position.x, p.position.z, p.orientation]))?.unbind();
        let twists = glance.state.twists.iter();
        let twists = rows(py, twists.map(|t| [t.linear.x, t.linear.z, t.angular]))?.unbind();
        Ok(Self { time: glance.time, steps: glance.steps, poses, twists })
    }
}

#[pymethods]
impl Glance {
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> Rows<'py> {
        self.poses.bind(py).clone()
    }

    #[getter]
    fn twists<'py>(&self, py: Python<'py>) -> Rows<'py> {
        self.twists.bind(py).clone()
    }
}
