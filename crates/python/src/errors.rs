//! Converts errors of the Rust crates to exceptions of the Python package, with the position of each error.

use std::path::Path;

use barrelstack::RunFailure;
use barrelstack::ground::GroundError;
use barrelstack::scenario::{Place, Scenario, ScenarioError};
use barrelstack_campaign::study::StudyError;
use barrelstack_motion::{MotionError, ReadError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Position of an error; unknown parts are `None`.
#[derive(Default)]
struct Spot {
    path: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    /// The override that contains the error, as `field=value`; `None` if the error is in a file.
    value: Option<String>,
}

impl Spot {
    fn at(path: &Path) -> Self {
        Self { path: Some(path.display().to_string()), ..Self::default() }
    }

    fn of(place: &Place) -> Self {
        match place {
            Place::File { file, line, column, .. } => Self {
                path: Some(file.clone()),
                line: Some(*line),
                column: Some(*column),
                value: None,
            },
            Place::Whole { file } => Self { path: Some(file.clone()), ..Self::default() },
            Place::Override { text } => Self { value: Some(text.clone()), ..Self::default() },
            Place::Unknown => Self::default(),
        }
    }
}

/// Creates an exception of the package; `class` is the name of its class in `barrelstack._errors`.
fn raise(class: &str, message: String, spot: Spot) -> PyErr {
    Python::attach(|py| {
        let made = py.import("barrelstack._errors").and_then(|errors| {
            let Spot { path, line, column, value } = spot;
            errors.getattr(class)?.call1((message, path, line, column, value))
        });
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

/// Converts an error from reading a scenario to a `ScenarioError`.
pub(crate) fn scenario(error: &ScenarioError) -> PyErr {
    raise("ScenarioError", error.to_string(), Spot::of(error.place()))
}

/// Creates a `ScenarioError` without a position, for a valid scenario that the called function does not accept.
pub(crate) fn inconsistent(message: String) -> PyErr {
    raise("ScenarioError", message, Spot::default())
}

/// Converts an error from reading a record file to a `RecordError`.
pub(crate) fn read(error: &ReadError) -> PyErr {
    let path = Some(error.file.clone());
    let (line, column) = (error.line, error.column);
    raise("RecordError", error.to_string(), Spot { path, line, column, value: None })
}

/// Converts an error from an operation on a record, such as an unknown component, to a `RecordError`.
pub(crate) fn motion(error: MotionError) -> PyErr {
    raise("RecordError", error.to_string(), Spot::default())
}

/// Converts an error from reading or generating a ground motion to a `RecordError`.
pub(crate) fn ground(error: &GroundError) -> PyErr {
    match error {
        GroundError::Read(error) => read(error),
        GroundError::Unreadable { path, .. } => {
            raise("RecordError", error.to_string(), Spot::at(path))
        }
        GroundError::Motion(_)
        | GroundError::Vertical { .. }
        | GroundError::UnknownBundled { .. }
        | GroundError::Unit { .. } => raise("RecordError", error.to_string(), Spot::default()),
    }
}

/// Converts the failure of a run to a `RunError`, with the position of the responsible field in the scenario. An error
/// from the ground motion is converted to a `RecordError`.
pub(crate) fn run(failure: &RunFailure, scenario: &Scenario) -> PyErr {
    if let RunFailure::Ground(error) = failure {
        return ground(error);
    }
    match scenario.place_of(&failure.fields()) {
        Some(place) => raise("RunError", format!("{place}: {failure}"), Spot::of(&place)),
        None => raise("RunError", failure.to_string(), Spot::default()),
    }
}

/// Converts an error from planning, running or collecting a study. The exception is a `ScenarioError` for an invalid
/// input file, a `RecordError` for a motion, a `KeyboardInterrupt` for a stopped study, and otherwise a `StudyError`.
pub(crate) fn study(error: StudyError) -> PyErr {
    match &error {
        StudyError::File(error) => scenario(error),
        StudyError::Motion { error: motion, .. } => {
            let spot = match &**motion {
                GroundError::Unreadable { path, .. } => Spot::at(path),
                GroundError::Read(error) => Spot::at(Path::new(&error.file)),
                GroundError::Motion(_)
                | GroundError::Vertical { .. }
                | GroundError::UnknownBundled { .. }
                | GroundError::Unit { .. } => Spot::default(),
            };
            raise("RecordError", error.to_string(), spot)
        }
        StudyError::System { path, .. }
        | StudyError::Shard { path, .. }
        | StudyError::Folder { folder: path, .. } => {
            raise("StudyError", error.to_string(), Spot::at(path))
        }
        // Only a signal stops a study; `run_interruptible` raises the exception of the signal.
        StudyError::Stopped => PyKeyboardInterrupt::new_err(()),
        StudyError::BuiltIn(_) | StudyError::Table(_) | StudyError::Chunk(_) => {
            raise("StudyError", error.to_string(), Spot::default())
        }
    }
}

/// Converts an error from an analysis that is based on studies, such as a decision or an export, to a `StudyError`.
pub(crate) fn study_result<E: ToString>(error: E) -> PyErr {
    raise("StudyError", error.to_string(), Spot::default())
}

/// Converts an error of any other kind, such as a table that cannot be read or a file that cannot be written, to an
/// `Error`.
pub(crate) fn general<E: ToString>(error: E) -> PyErr {
    raise("Error", error.to_string(), Spot::default())
}
