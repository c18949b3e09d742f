//! Simulations that advance step by step: one alone, or many at once on all cores.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use barrelstack::dynamics::element::Memory;
use barrelstack::dynamics::forces::{Scratch, contact_force};
use barrelstack::dynamics::{
    Applied, EnergySummary, Model, Planar, Space, Spatial, State, Vec2, Vec3,
};
use barrelstack::ground::from_disk;
use barrelstack::variants::{Answer, Plane, Shown, planes};
use barrelstack::{RunFailure, Summary, pool};
use barrelstack_input::names::advice;
use barrelstack_space::Ground;
use numpy::{PyArray1, PyArray3, PyArrayMethods as _, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;

use crate::errors;
use crate::interruptible::POLL;
use crate::run::Run;
use crate::scenario::{Scenario, with_variants};
use crate::space::SpatialRun;
use crate::view::{Numbers, Rows};

/// Number of steps between two checks of the elapsed time.
const PORTION: u64 = 64;

/// Computing time (s) of a call below which threads are not worth starting.
const SHORT: f64 = 1e-4;

/// A planar or three-dimensional simulation.
#[derive(Clone)]
enum Running {
    Plane(Box<barrelstack::Simulation>),
    Space(Box<barrelstack_space::Simulation>),
}

/// Evaluates an expression with the simulation, whether planar or three-dimensional.
macro_rules! each {
    ($running:expr, $one:ident => $work:expr) => {
        match $running {
            Running::Plane($one) => $work,
            Running::Space($one) => $work,
        }
    };
}

/// Conversion of planar or three-dimensional vectors from and to lists of numbers.
trait Listed: Space<Real = f64> {
    /// Names of the components of a vector, for error messages.
    const AXES: &'static str;
    /// Names of the components of a moment, for error messages.
    const TURNS: &'static str;
    fn vector(numbers: &[f64]) -> Option<Self::Vector>;
    fn spin(numbers: &[f64]) -> Option<Self::Spin>;
    fn list(vector: Self::Vector) -> Vec<f64>;
}

impl Listed for Planar {
    const AXES: &'static str = "two components, x and z";
    const TURNS: &'static str = "one component, positive from x to z";

    fn vector(numbers: &[f64]) -> Option<Vec2> {
        let [x, z] = *numbers else { return None };
        Some(Vec2::new(x, z))
    }

    fn spin(numbers: &[f64]) -> Option<f64> {
        let [moment] = *numbers else { return None };
        Some(moment)
    }

    fn list(vector: Vec2) -> Vec<f64> {
        vec![vector.x, vector.z]
    }
}

impl Listed for Spatial {
    const AXES: &'static str = "three components, x, y and z";
    const TURNS: &'static str = "three components, about x, y and z";

    fn vector(numbers: &[f64]) -> Option<Vec3> {
        let [x, y, z] = *numbers else { return None };
        Some(Vec3::new(x, y, z))
    }

    fn spin(numbers: &[f64]) -> Option<Vec3> {
        Self::vector(numbers)
    }

    fn list(vector: Vec3) -> Vec<f64> {
        vec![vector.x, vector.y, vector.z]
    }
}

/// Creates an applied force from its components, its point of application and an additional moment. An empty list for
/// the point or the moment means zero.
fn applied<S: Listed>(
    body: usize,
    force: &[f64],
    at: &[f64],
    moment: &[f64],
) -> PyResult<Applied<S>> {
    let wrong = |what: &str, parts: &str, found: &[f64]| {
        PyValueError::new_err(format!(
            "{what} must have {parts}; the number of values found is {}",
            found.len()
        ))
    };
    let zero = |numbers: &[f64]| numbers.is_empty();
    let point = if zero(at) { Some(S::Vector::default()) } else { S::vector(at) };
    let turn = if zero(moment) { Some(S::Spin::default()) } else { S::spin(moment) };
    Ok(Applied {
        body,
        force: S::vector(force).ok_or_else(|| wrong("a force", S::AXES, force))?,
        point: point.ok_or_else(|| wrong("a point", S::AXES, at))?,
        moment: turn.ok_or_else(|| wrong("a moment", S::TURNS, moment))?,
    })
}

/// All contacts: the names of the two bodies of each contact, the number of values per row, and the values of all rows.
///
/// Each row holds the point of a contact, the force on the first body, and the penetration.
type Contacts = (Vec<(String, String)>, usize, Vec<f64>);

fn contacts<S: Listed>(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Contacts {
    let (mut pairs, mut rows, mut width) = (Vec::new(), Vec::new(), 1);
    for contact in &scratch.contacts {
        let pair = model.pair(contact.pair);
        let name = |body: usize| model.bodies()[body].name.clone();
        let (force, point) = contact_force(model, state, scratch, contact);
        let mut row = S::list(point);
        row.extend(S::list(force));
        row.push(contact.penetration);
        width = row.len();
        pairs.push((name(pair.contactor), name(pair.target)));
        rows.extend(row);
    }
    (pairs, width, rows)
}

/// A force element: its name, its force (N), and `true` if it is broken.
type Element = (String, f64, bool);

fn elements<S: Listed>(
    model: &Model<S>,
    scratch: &Scratch<S>,
    memory: &[Memory<S>],
) -> Vec<Element> {
    let all = model.elements().iter().zip(&scratch.loads).zip(memory);
    all.map(|((element, load), memory)| (element.link().name.clone(), load.force, memory.broken))
        .collect()
}

impl Running {
    /// Returns the number of coordinates of a pose and of a twist.
    fn widths(&self) -> [usize; 2] {
        match self {
            Self::Plane(_) => [3, 3],
            Self::Space(_) => [7, 6],
        }
    }

    fn bodies(&self) -> usize {
        each!(self, one => one.state().poses.len())
    }

    fn poses(&self, out: &mut Vec<f64>) {
        match self {
            Self::Plane(one) => {
                for pose in &one.state().poses {
                    out.extend([pose.position.x, pose.position.z, pose.orientation]);
                }
            }
            Self::Space(one) => {
                for pose in &one.state().poses {
                    let (p, q) = (pose.position, pose.orientation);
                    out.extend([p.x, p.y, p.z, q.w, q.v.x, q.v.y, q.v.z]);
                }
            }
        }
    }

    fn twists(&self, out: &mut Vec<f64>) {
        match self {
            Self::Plane(one) => {
                for twist in &one.state().twists {
                    out.extend([twist.linear.x, twist.linear.z, twist.angular]);
                }
            }
            Self::Space(one) => {
                for twist in &one.state().twists {
                    let (v, w) = (twist.linear, twist.angular);
                    out.extend([v.x, v.y, v.z, w.x, w.y, w.z]);
                }
            }
        }
    }

    fn body(&self, name: &str) -> PyResult<usize> {
        let found = match self {
            Self::Plane(one) => one.assembly().model.body_named(name),
            Self::Space(one) => one.stack().model.body_named(name),
        };
        found.ok_or_else(|| {
            let names: Vec<String> = self.names().into_iter().map(|(name, _)| name).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            PyKeyError::new_err(format!("there is no body {name:?}; {}", advice(name, &names)))
        })
    }

    fn names(&self) -> Vec<(String, &'static str)> {
        match self {
            Self::Plane(one) => {
                let parts = one.assembly().parts.iter();
                parts.map(|part| (part.name.clone(), part.kind.name())).collect()
            }
            Self::Space(one) => {
                let parts = one.stack().parts.iter();
                parts.map(|part| (part.name.clone(), part.kind.name())).collect()
            }
        }
    }

    fn apply(&mut self, body: usize, force: &[f64], at: &[f64], moment: &[f64]) -> PyResult<()> {
        let done = match self {
            Self::Plane(one) => one.apply(applied(body, force, at, moment)?),
            Self::Space(one) => one.apply(applied(body, force, at, moment)?),
        };
        done.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Sets the state to that of `to`, which must be a copy of this simulation.
    fn reset(&mut self, to: &Self) -> PyResult<()> {
        let same = match (&*self, to) {
            (Self::Plane(own), Self::Plane(other)) => own.is_clone_of(other),
            (Self::Space(own), Self::Space(other)) => own.is_clone_of(other),
            (Self::Plane(_), Self::Space(_)) | (Self::Space(_), Self::Plane(_)) => false,
        };
        if !same {
            return Err(PyValueError::new_err(
                "the state belongs to another simulation; give a state that was copied from this simulation",
            ));
        }
        self.clone_from(to);
        Ok(())
    }
}

fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Builds and settles the variants of a scenario that have the given numbers, on all cores; number 0 is the nominal
/// stack. If `plane` is `None`, uses the first plane. The inner error is that the scenario has no such plane.
fn started(
    scenario: &barrelstack::Scenario,
    plane: Option<&str>,
    numbers: &[u32],
) -> Result<PyResult<(barrelstack::Scenario, Vec<Running>)>, RunFailure> {
    let scenario = scenario.with_event()?.with_records(&mut from_disk)?;
    let all = planes(&scenario)?;
    let view = |plane: &Plane| plane.view().map_or("", |view| view.name());
    let chosen = all.iter().find(|one| plane.is_none_or(|name| view(one) == name));
    let Some(chosen) = chosen.filter(|_| plane.is_none() || !scenario.is_spatial()) else {
        let known: Vec<&str> = all.iter().map(view).filter(|_| !scenario.is_spatial()).collect();
        return Ok(Err(PyValueError::new_err(format!(
            "the scenario has no plane {:?}; it has {}",
            plane.unwrap_or_default(),
            if known.concat().is_empty() { "none".to_owned() } else { known.join(" and ") }
        ))));
    };
    let start = |number: &u32| -> Result<Running, RunFailure> {
        let variant = chosen.variant(*number);
        if scenario.is_spatial() {
            let ground = Ground::of(&chosen.scenario)?;
            return Ok(Running::Space(Box::new(barrelstack_space::Simulation::new(
                &variant, ground,
            )?)));
        }
        let ground = variant.ground()?;
        Ok(Running::Plane(Box::new(barrelstack::Simulation::new(&variant, ground)?)))
    };
    let running = pool::map(numbers, start, &|_| {}).into_iter().collect::<Result<_, _>>()?;
    Ok(Ok((scenario, running)))
}

/// A simulation that advances step by step.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Simulation {
    running: Mutex<Running>,
    scenario: barrelstack::Scenario,
    number: u32,
}

#[pymethods]
impl Simulation {
    /// Builds and settles variant `number` of a scenario; number 0 is the nominal stack. If `plane` is `None`, uses the
    /// first plane.
    #[staticmethod]
    fn start(py: Python<'_>, of: &Scenario, plane: Option<&str>, number: u32) -> PyResult<Self> {
        let (_, count) = with_variants(&of.inner, None)?;
        if number > count {
            return Err(PyValueError::new_err(format!(
                "there is no variant {number}: variants are numbered from 1 to {count}, and 0 is the stack as stated"
            )));
        }
        let found = py.detach(|| started(&of.inner, plane, &[number]));
        let (scenario, mut running) = found.map_err(|error| errors::run(&error, &of.inner))??;
        Ok(Self { running: Mutex::new(running.remove(0)), scenario, number })
    }

    #[getter]
    fn is_spatial(&self) -> bool {
        matches!(*lock(&self.running), Running::Space(_))
    }

    #[getter]
    fn time(&self) -> f64 {
        each!(&*lock(&self.running), one => one.time())
    }

    #[getter]
    fn end_time(&self) -> f64 {
        each!(&*lock(&self.running), one => one.end_time())
    }

    #[getter]
    fn steps(&self) -> u64 {
        each!(&*lock(&self.running), one => one.steps())
    }

    #[getter]
    fn ending(&self) -> Option<&'static str> {
        each!(&*lock(&self.running), one => one.ending()).map(barrelstack::watch::Ending::name)
    }

    /// Time (s) of the first loss of a seat; `None` if no body has left its seat.
    #[getter]
    fn collapse(&self) -> Option<f64> {
        match &*lock(&self.running) {
            Running::Plane(one) => one.fates().collapse_time(),
            Running::Space(one) => one.fates().collapse().map(|(time, _)| time),
        }
    }

    /// Returns name and kind of every body.
    fn bodies(&self) -> Vec<(String, &'static str)> {
        lock(&self.running).names()
    }

    /// Returns the mass (kg) of every body.
    fn masses<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        let running = lock(&self.running);
        let masses: Vec<f64> = match &*running {
            Running::Plane(one) => {
                one.assembly().model.bodies().iter().map(|body| body.mass).collect()
            }
            Running::Space(one) => {
                one.stack().model.bodies().iter().map(|body| body.mass).collect()
            }
        };
        PyArray1::from_vec(py, masses)
    }

    /// Takes `count` steps, or fewer if the run ends. Returns the number of steps taken.
    fn step(&self, py: Python<'_>, count: u64) -> PyResult<u64> {
        let mut taken = 0;
        loop {
            let ended = py.detach(|| {
                let mut running = lock(&self.running);
                let start = (count > PORTION).then(Instant::now);
                loop {
                    let portion = (count - taken).min(PORTION);
                    let now = each!(&mut *running, one => one.step(portion));
                    taken += now;
                    if now < portion || taken == count {
                        return true;
                    }
                    if start.is_some_and(|start| start.elapsed() > POLL) {
                        return false;
                    }
                }
            });
            if ended {
                return Ok(taken);
            }
            py.check_signals()?;
        }
    }

    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let running = lock(&self.running);
        let mut all = Vec::new();
        running.poses(&mut all);
        PyArray1::from_vec(py, all).reshape([running.bodies(), running.widths()[0]])
    }

    fn twists<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let running = lock(&self.running);
        let mut all = Vec::new();
        running.twists(&mut all);
        PyArray1::from_vec(py, all).reshape([running.bodies(), running.widths()[1]])
    }

    /// Returns the names of the two bodies of every contact, and one row per contact: point (m), force (N) on the first
    /// body, and penetration (m).
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<(Vec<(String, String)>, Rows<'py>)> {
        let (pairs, width, rows) = match &*lock(&self.running) {
            Running::Plane(one) => contacts(&one.assembly().model, one.state(), one.scratch()),
            Running::Space(one) => contacts(&one.stack().model, one.state(), one.scratch()),
        };
        let count = pairs.len();
        Ok((pairs, PyArray1::from_vec(py, rows).reshape([count, width])?))
    }

    /// Returns the name of each pair of touching bodies, such as "R1 on ground", and the force (N) on the body that is
    /// named first.
    fn forces<'py>(&self, py: Python<'py>) -> Vec<(String, Numbers<'py>)> {
        match &*lock(&self.running) {
            Running::Plane(one) => {
                let name = |body: usize| one.assembly().parts[body].name.as_str();
                let listed = one.forces().into_iter();
                listed
                    .map(|f| (f.named(name), PyArray1::from_vec(py, Planar::list(f.force))))
                    .collect()
            }
            Running::Space(one) => {
                let name = |body: usize| one.stack().parts[body].name.as_str();
                let listed = one.forces().into_iter();
                listed
                    .map(|f| (f.named(name), PyArray1::from_vec(py, Spatial::list(f.force))))
                    .collect()
            }
        }
    }

    /// Returns the name and the force (N, positive in tension) of every force element, and `true` if the element is
    /// broken.
    fn elements(&self) -> Vec<Element> {
        match &*lock(&self.running) {
            Running::Plane(one) => {
                elements(&one.assembly().model, one.scratch(), &one.state().memory)
            }
            Running::Space(one) => elements(&one.stack().model, one.scratch(), &one.state().memory),
        }
    }

    /// Returns the terms of the energy balance (J), in the order of the fields of `EnergySummary` below.
    fn energy(&self) -> [f64; 11] {
        let EnergySummary {
            kinetic,
            potential,
            elastic,
            stick,
            damped,
            friction,
            viscous,
            ground_work,
            applied_work,
            residual,
            throughput,
        } = each!(&*lock(&self.running), one => one.energy());
        [
            kinetic,
            potential,
            elastic,
            stick,
            damped,
            friction,
            viscous,
            ground_work,
            applied_work,
            residual,
            throughput,
        ]
    }

    fn apply(&self, body: &str, force: Vec<f64>, at: Vec<f64>, moment: Vec<f64>) -> PyResult<()> {
        let mut running = lock(&self.running);
        let body = running.body(body)?;
        running.apply(body, &force, &at, &moment)
    }

    fn copy(&self) -> Self {
        let running = Mutex::new(lock(&self.running).clone());
        Self { running, scenario: self.scenario.clone(), number: self.number }
    }

    /// Sets the state to that of `to`, which must be a copy of this simulation.
    fn reset(&self, to: &Self) -> PyResult<()> {
        let to = lock(&to.running).clone();
        lock(&self.running).reset(&to)
    }

    /// Returns the result so far; `None` if the simulation is three-dimensional.
    fn result(&self, py: Python<'_>) -> Option<Run> {
        let Running::Plane(one) = lock(&self.running).clone() else { return None };
        py.detach(|| {
            let run = one.finish();
            let mut summary = Summary::of(&run, None);
            summary.variant = self.number;
            let decides = Shown { run, summary, variants: None, stopped: None };
            Some(Run::of(Answer { scenario: self.scenario.clone(), decides, other: None }))
        })
    }

    /// Returns the result so far; `None` if the simulation is planar.
    fn result_in_space(&self, py: Python<'_>) -> Option<SpatialRun> {
        let Running::Space(one) = lock(&self.running).clone() else { return None };
        py.detach(|| {
            let (run, scenario) = (one.finish(), self.scenario.clone());
            let mut summary = barrelstack_space::summary::of(&run, &scenario);
            summary.variant = self.number;
            let answer = barrelstack_space::Answer { scenario, run, summary, cases: Vec::new() };
            Some(SpatialRun::of(answer))
        })
    }
}

/// Simulations of variants of one stack, which advance together on all cores.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Simulations {
    all: Vec<Mutex<Running>>,
    scenario: barrelstack::Scenario,
    numbers: Vec<u32>,
    /// Computing time (s) of one step of one simulation, measured in the last call.
    pace: Mutex<f64>,
}

impl Simulations {
    fn numbers_of<'py>(&self, py: Python<'py>, of: impl Fn(&Running) -> f64) -> Numbers<'py> {
        PyArray1::from_vec(py, self.all.iter().map(|one| of(&lock(one))).collect())
    }

    /// Returns an array of shape (simulations, bodies, `width`). `pick` appends the values of all bodies of one
    /// simulation.
    fn stacked<'py>(
        &self,
        py: Python<'py>,
        width: usize,
        pick: impl Fn(&Running, &mut Vec<f64>),
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let mut all = Vec::new();
        for one in &self.all {
            pick(&lock(one), &mut all);
        }
        let bodies = self.all.first().map_or(0, |one| lock(one).bodies());
        PyArray1::from_vec(py, all).reshape([self.all.len(), bodies, width])
    }

    fn widths(&self) -> [usize; 2] {
        self.all.first().map_or([0, 0], |one| lock(one).widths())
    }

    fn one(&self, at: usize) -> PyResult<&Mutex<Running>> {
        self.all.get(at).ok_or_else(|| {
            PyKeyError::new_err(format!(
                "there is no simulation {at}; there are {}, counted from 0",
                self.all.len()
            ))
        })
    }
}

#[pymethods]
impl Simulations {
    /// Builds and settles the variants 1 to `count` of a stack. A free scene has no variants; it is built once and
    /// copied to give `count` simulations.
    #[staticmethod]
    fn start(py: Python<'_>, of: &Scenario, plane: Option<&str>, count: u32) -> PyResult<Self> {
        let free = of.inner.imperfections().is_none();
        let (stated, _) = with_variants(&of.inner, Some(count).filter(|_| !free))?;
        let numbers: Vec<u32> = (1..=count).collect();
        let first = if free { vec![0] } else { numbers.clone() };
        let found = py.detach(|| started(&stated, plane, &first));
        let (scenario, mut running) = found.map_err(|error| errors::run(&error, &stated))??;
        if let (true, Some(one)) = (free, running.first().cloned()) {
            running.resize(numbers.len(), one);
        }
        let all = running.into_iter().map(Mutex::new).collect();
        Ok(Self { all, scenario, numbers, pace: Mutex::new(f64::INFINITY) })
    }

    fn __len__(&self) -> usize {
        self.all.len()
    }

    #[getter]
    fn numbers(&self) -> Vec<u32> {
        self.numbers.clone()
    }

    fn bodies(&self) -> Vec<(String, &'static str)> {
        self.all.first().map_or_else(Vec::new, |one| lock(one).names())
    }

    /// Takes `count` steps of every simulation, or fewer if its run ends. Returns the number of steps that each
    /// simulation took.
    fn step(&self, py: Python<'_>, count: u64) -> PyResult<Vec<u64>> {
        let mut taken = vec![0; self.all.len()];
        let mut left = count;
        while left > 0 {
            // Steps of few simulations with few bodies take less time than the start of a thread.
            let pace = *lock(&self.pace);
            let portion = left.min(PORTION);
            let now = py.detach(|| {
                let start = Instant::now();
                let step = |one: &Mutex<Running>| each!(&mut *lock(one), one => one.step(portion));
                let work = pace * portion as f64 * self.all.len() as f64;
                let now: Vec<u64> = if work < SHORT {
                    self.all.iter().map(step).collect()
                } else {
                    pool::map(&self.all, step, &|_| {})
                };
                let steps = now.iter().sum::<u64>().max(1) as f64;
                *lock(&self.pace) = start.elapsed().as_secs_f64() / steps;
                now
            });
            for (taken, now) in taken.iter_mut().zip(&now) {
                *taken += now;
            }
            left -= portion;
            if now.iter().all(|now| *now == 0) {
                break;
            }
            py.check_signals()?;
        }
        Ok(taken)
    }

    fn times<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        self.numbers_of(py, |one| each!(one, one => one.time()))
    }

    /// Returns the time (s) of the first loss of a seat in every simulation; NaN for a simulation without one.
    fn collapses<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        self.numbers_of(py, |one| {
            let time = match one {
                Running::Plane(one) => one.fates().collapse_time(),
                Running::Space(one) => one.fates().collapse().map(|(time, _)| time),
            };
            time.unwrap_or(f64::NAN)
        })
    }

    fn endings(&self) -> Vec<Option<&'static str>> {
        let ending = |one: &Mutex<Running>| each!(&*lock(one), one => one.ending());
        self.all.iter().map(|one| ending(one).map(barrelstack::watch::Ending::name)).collect()
    }

    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, self.widths()[0], Running::poses)
    }

    fn twists<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, self.widths()[1], Running::twists)
    }

    /// Sets the force on a body in every simulation, from one row of numbers for each simulation.
    fn apply(
        &self,
        body: &str,
        forces: PyReadonlyArray2<'_, f64>,
        at: Vec<f64>,
        moments: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let rows = forces.as_array();
        let turns = moments.as_array();
        for ((one, force), moment) in self.all.iter().zip(rows.rows()).zip(turns.rows()) {
            let mut one = lock(one);
            let body = one.body(body)?;
            one.apply(body, &force.to_vec(), &at, &moment.to_vec())?;
        }
        Ok(())
    }

    fn copy(&self) -> Self {
        Self {
            all: self.all.iter().map(|one| Mutex::new(lock(one).clone())).collect(),
            scenario: self.scenario.clone(),
            numbers: self.numbers.clone(),
            pace: Mutex::new(*lock(&self.pace)),
        }
    }

    /// Sets the state of each marked simulation to that of the corresponding simulation in `to`, which must be a copy
    /// of these simulations.
    fn reset(&self, to: &Self, marked: Vec<bool>) -> PyResult<()> {
        let all = self.all.iter().zip(&to.all).zip(marked);
        for ((own, other), _) in all.filter(|(_, marked)| *marked) {
            let other = lock(other).clone();
            lock(own).reset(&other)?;
        }
        Ok(())
    }

    /// Returns a copy of one simulation.
    fn get(&self, at: usize) -> PyResult<Simulation> {
        let running = Mutex::new(lock(self.one(at)?).clone());
        let number = self.numbers[at];
        Ok(Simulation { running, scenario: self.scenario.clone(), number })
    }
}
