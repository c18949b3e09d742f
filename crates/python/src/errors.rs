//! Converts errors of the library to exceptions of the package, with their positions.

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
    /// The value that contains the error, as `field=value`, if the value is not in a file.
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

/// Converts the error of a scenario that cannot be read.
pub(crate) fn scenario(error: &ScenarioError) -> PyErr {
    raise("ScenarioError", error.to_string(), Spot::of(error.place()))
}

/// Creates the error for a field of the scenario that contradicts the request.
pub(crate) fn inconsistent(message: String) -> PyErr {
    raise("ScenarioError", message, Spot::default())
}

/// Converts the error of a record file that cannot be read.
pub(crate) fn read(error: &ReadError) -> PyErr {
    let path = Some(error.file.clone());
    let (line, column) = (error.line, error.column);
    raise("RecordError", error.to_string(), Spot { path, line, column, value: None })
}

/// Converts the error of an operation that a record does not permit.
pub(crate) fn motion(error: MotionError) -> PyErr {
    raise("RecordError", error.to_string(), Spot::default())
}

/// Converts the error of a motion that cannot be read or generated.
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

/// Converts the error of a run, with its position in the scenario.
pub(crate) fn run(failure: &RunFailure, scenario: &Scenario) -> PyErr {
    if let RunFailure::Ground(error) = failure {
        return ground(error);
    }
    match scenario.place_of(&failure.fields()) {
        Some(place) => raise("RunError", format!("{place}: {failure}"), Spot::of(&place)),
        None => raise("RunError", failure.to_string(), Spot::default()),
    }
}

/// Converts the error of planning, running or collecting a study.
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

/// Converts the error of a study whose results do not permit a decision or cannot be written.
pub(crate) fn study_result<E: ToString>(error: E) -> PyErr {
    raise("StudyError", error.to_string(), Spot::default())
}

/// Converts the error of a table that cannot be read, or of a file that cannot be written.
pub(crate) fn general<E: ToString>(error: E) -> PyErr {
    raise("Error", error.to_string(), Spot::default())
}
