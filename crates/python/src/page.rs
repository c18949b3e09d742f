//! Results with numbers and a page: comparisons, rankings, calibrations, and decisions of a study.

use std::path::PathBuf;

use barrelstack::export::Folder;
use barrelstack_report::{Document, Paper, described, document_pdf, html};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors;
use crate::scenario::bytes;

/// A result: its numbers as JSON, and its page.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Page {
    numbers: String,
    document: Document,
}

impl Page {
    /// Creates a page with the numbers that the command prints as JSON.
    pub(crate) fn of<N: serde::Serialize>(numbers: &N, document: Document) -> PyResult<Self> {
        let numbers = described::to_json(numbers).map_err(errors::general)?;
        Ok(Self { numbers, document })
    }
}

#[pymethods]
impl Page {
    #[getter]
    fn numbers(&self) -> &str {
        &self.numbers
    }

    #[getter]
    fn headline(&self) -> &str {
        &self.document.verdict.headline
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.document.warnings.clone()
    }

    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| html(&self.document))
    }

    fn pdf<'py>(&self, py: Python<'py>, paper: &str) -> PyResult<Bound<'py, PyBytes>> {
        let paper = paper_of(paper)?;
        Ok(bytes(py, &py.detach(|| document_pdf(&self.document, paper))))
    }

    /// Writes `report.html`, `report.md` and `figures/`.
    fn write(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<()> {
        let written = py.detach(|| {
            let folder = Folder::prepare(&folder, overwrite)?;
            folder.write_page(&self.document)
        });
        written.map_err(errors::general)
    }
}

/// Returns the paper size of a name.
pub(crate) fn paper_of(name: &str) -> PyResult<Paper> {
    match name {
        "a4" => Ok(Paper::A4),
        "letter" => Ok(Paper::Letter),
        other => {
            let said = format!("paper: expected \"a4\" or \"letter\", found \"{other}\"");
            Err(PyValueError::new_err(said))
        }
    }
}
