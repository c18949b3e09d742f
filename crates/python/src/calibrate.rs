//! Fits contact parameters to tests, recorded responses and observed collapses.

use std::path::Path;

use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_calibration::collapse::{Errors, Observations, Settings};
use barrelstack_calibration::drop::{GRAVITY, Striker};
use barrelstack_calibration::shares::{Height, Statements, levels, shares};
use barrelstack_calibration::{
    CalibrateError, Calibration, Parameter, Table, collapse, drop, friction, response, stiffness,
};
use barrelstack_input::names::advice;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;

use crate::errors;
use crate::interruptible::run_interruptible;
use crate::page::Page;
use crate::scenario::Scenario;

fn page(found: Result<Calibration, CalibrateError>, of: Option<&Scenario>) -> PyResult<Page> {
    let found = found.map_err(|error| match (error, of) {
        (CalibrateError::Stopped, _) => PyKeyboardInterrupt::new_err(()),
        (CalibrateError::Run(failure), Some(scenario)) => errors::run(&failure, &scenario.inner),
        (other, _) => errors::general(other),
    })?;
    let mut document = found.document();
    document.warnings.clone_from(&found.warnings);
    Page::of(&found.to_document(), document)
}

fn table(name: &str, text: &str) -> PyResult<Table> {
    Table::parse(name, text).map_err(errors::general)
}

/// Parses a positive quantity, and converts it to SI units.
fn positive(name: &str, text: &str, dimension: Dimension) -> PyResult<f64> {
    let value = Quantity::parse_as(text, &[dimension]).map(|quantity| quantity.value);
    let example = dimension.example();
    match value {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        Ok(_) | Err(_) => Err(PyValueError::new_err(format!(
            "{name}: expected {dimension} above zero such as \"{example}\", found \"{text}\""
        ))),
    }
}

/// Parses the names of parameters, each of which may be given once.
fn parameters(fit: &[String]) -> PyResult<Vec<Parameter>> {
    let known = Parameter::NAMES.map(|(word, _)| word).join(", ");
    let mut found = Vec::new();
    for word in fit {
        let parameter = Parameter::NAMES.iter().find(|(name, _)| name == word);
        let Some((_, parameter)) = parameter.filter(|(_, one)| !found.contains(one)) else {
            return Err(PyValueError::new_err(format!(
                "fit: expected one or more of {known}, each at most once, found \"{word}\""
            )));
        };
        found.push(*parameter);
    }
    Ok(found)
}

/// Fits the stiffness to a press test.
#[pyfunction]
pub(crate) fn calibrate_stiffness(
    name: &str,
    text: &str,
    nodes: u32,
    interface: &str,
) -> PyResult<Page> {
    page(stiffness::stiffness(&table(name, text)?, nodes, interface), None)
}

/// Fits restitution and damping to drop tests.
#[pyfunction]
pub(crate) fn calibrate_drop(
    name: &str,
    text: &str,
    striker: Option<(String, String)>,
    nodes: u32,
    interface: &str,
) -> PyResult<Page> {
    let striker = match striker {
        Some((mass, stiffness)) => Some(Striker {
            mass: positive("mass", &mass, Dimension::MASS)?,
            stiffness: positive("stiffness", &stiffness, Dimension::STIFFNESS)?,
            nodes,
            gravity: GRAVITY,
        }),
        None => None,
    };
    page(drop::drop(&table(name, text)?, striker, interface), None)
}

/// Fits friction to pull or tilt tests.
#[pyfunction]
pub(crate) fn calibrate_friction(name: &str, text: &str, interface: &str) -> PyResult<Page> {
    page(friction::friction(&table(name, text)?, interface), None)
}

/// Fits parameters to the recorded response of a shaken stack.
#[pyfunction]
pub(crate) fn calibrate_response(
    py: Python<'_>,
    scenario: &Scenario,
    name: &str,
    text: &str,
    fit: Vec<String>,
    until: Option<&str>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let parameters = parameters(&fit)?;
    let until = until.map(|until| positive("until", until, Dimension::TIME)).transpose()?;
    let table = table(name, text)?;
    let found = run_interruptible(py, progress, |state| {
        response::response(&scenario.inner, &table, &parameters, until, &|done| {
            state.report(done as f64, f64::NAN, "simulations")
        })
    })?;
    page(found, Some(scenario))
}

/// Fits parameters to observed collapses.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python function")]
pub(crate) fn calibrate_collapse(
    py: Python<'_>,
    scenario: &Scenario,
    others: Vec<(String, PyRef<'_, Scenario>)>,
    statements: Vec<String>,
    name: &str,
    text: &str,
    fit: Vec<String>,
    within: f64,
    timing: &str,
    placement: &str,
    simulations: usize,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Page> {
    let parameters = parameters(&fit)?;
    if !(within > 1.0 && within <= 100.0) {
        return Err(PyValueError::new_err(format!(
            "within: expected a factor between 1 and 100 such as 2, found {within}"
        )));
    }
    let reading = positive("timing", timing, Dimension::TIME)?;
    let settings = Settings {
        within,
        placement: positive("placement", placement, Dimension::LENGTH)?,
        errors: Errors { reading, ..Errors::default() },
        simulations,
        seed,
        lanes: None,
    };
    if Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let read = Statements::read(name, text).map_err(errors::general)?;
        let (earthquake, chosen) = read.chosen(&statements).map_err(errors::general)?;
        let mut heights = Vec::new();
        for levels in levels(&chosen) {
            let changed = scenario.changed(vec![format!("stack.levels={levels}")])?;
            heights.push(Height { levels, scenario: (*changed.inner).clone() });
        }
        let found = run_interruptible(py, progress, |state| {
            shares(earthquake, &chosen, &heights, &parameters, &settings, &|done, of| {
                state.report(done as f64, of as f64, "runs")
            })
        })?;
        return page(found, Some(scenario));
    }
    let observations =
        Observations::read(&table(name, text)?, &settings.errors).map_err(errors::general)?;
    let mut scenarios = Vec::new();
    for named in observations.scenarios() {
        let Some(named) = named else {
            scenarios.push((*scenario.inner).clone());
            continue;
        };
        let found = others.iter().find(|(name, _)| name == named);
        let (_, found) = found.ok_or_else(|| {
            let known: Vec<&str> = others.iter().map(|(name, _)| name.as_str()).collect();
            let next = if known.is_empty() {
                "give it as an argument".to_owned()
            } else {
                advice(named, &known)
            };
            PyValueError::new_err(format!("no scenario named \"{named}\" was given; {next}"))
        })?;
        scenarios.push((*found.inner).clone());
    }
    let found = run_interruptible(py, progress, |state| {
        collapse::collapse(&observations, &scenarios, &parameters, &settings, &|done, of| {
            state.report(done as f64, of as f64, "runs")
        })
    })?;
    page(found, Some(scenario))
}
