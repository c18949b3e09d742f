//! Errors of the library as the exceptions of the package, with the place where they are about.

use std::path::Path;

use barrelstack::RunFailure;
use barrelstack::ground::GroundError;
use barrelstack::scenario::{Place, Scenario, ScenarioError};
use barrelstack_campaign::study::StudyError;
use barrelstack_motion::{MotionError, ReadError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Where an error is about, as far as that is known.
#[derive(Default)]
struct Spot {
    path: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    /// The value that was given, as `field=value`, where it stands in no file.
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

/// An exception of the package, by the name of its class in `barrelstack._errors`.
fn raise(class: &str, message: String, spot: Spot) -> PyErr {
    Python::attach(|py| {
        let made = py.import("barrelstack._errors").and_then(|errors| {
            let Spot { path, line, column, value } = spot;
            errors.getattr(class)?.call1((message, path, line, column, value))
        });
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

/// A scenario that cannot be read.
pub(crate) fn scenario(error: &ScenarioError) -> PyErr {
    raise("ScenarioError", error.to_string(), Spot::of(error.place()))
}

/// A field that says something else than what is asked for.
pub(crate) fn inconsistent(message: String) -> PyErr {
    raise("ScenarioError", message, Spot::default())
}

/// A record that cannot be read.
pub(crate) fn read(error: &ReadError) -> PyErr {
    let path = Some(error.file.clone());
    let (line, column) = (error.line, error.column);
    raise("RecordError", error.to_string(), Spot { path, line, column, value: None })
}

/// A request about a record that cannot be met.
pub(crate) fn motion(error: MotionError) -> PyErr {
    raise("RecordError", error.to_string(), Spot::default())
}

/// A motion that cannot be had.
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

/// Why there is no run, with the place in the scenario that it is about.
pub(crate) fn run(failure: &RunFailure, scenario: &Scenario) -> PyErr {
    if let RunFailure::Ground(error) = failure {
        return ground(error);
    }
    match scenario.place_of(&failure.fields()) {
        Some(place) => raise("RunError", format!("{place}: {failure}"), Spot::of(&place)),
        None => raise("RunError", failure.to_string(), Spot::default()),
    }
}

/// Why a study cannot be planned, run or collected.
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
        // Only a signal stops it; the one that was heard is raised where it was.
        StudyError::Stopped => PyKeyboardInterrupt::new_err(()),
        StudyError::BuiltIn(_) | StudyError::Table(_) | StudyError::Chunk(_) => {
            raise("StudyError", error.to_string(), Spot::default())
        }
    }
}

/// What a study cannot decide or write, in the library's words.
pub(crate) fn told<E: ToString>(error: E) -> PyErr {
    raise("StudyError", error.to_string(), Spot::default())
}

/// A table that cannot be read, or a file that cannot be written.
pub(crate) fn general<E: ToString>(error: E) -> PyErr {
    raise("Error", error.to_string(), Spot::default())
}
