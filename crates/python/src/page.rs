//! Results with numbers and a page: comparisons, rankings, calibrations, and decisions of a study.

use std::path::PathBuf;

use barrelstack::export::Folder;
use barrelstack_report::{
    Document, Language, Paper, UnknownLanguage, described, document_pdf, html,
};
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

    #[pyo3(signature = (language = "en"))]
    fn html(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        let language = language_of(language)?;
        Ok(py.detach(|| html(&self.document.in_language(language))))
    }

    fn pdf<'py>(
        &self,
        py: Python<'py>,
        paper: &str,
        language: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (paper, language) = (paper_of(paper)?, language_of(language)?);
        let pdf = py.detach(|| document_pdf(&self.document.in_language(language), paper));
        Ok(bytes(py, &pdf))
    }

    /// Writes `report.html`, `report.md` and `figures/`.
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
            folder.write_page(&self.document.in_language(language))
        });
        written.map_err(errors::general)
    }
}

/// Returns the language of a code.
pub(crate) fn language_of(code: &str) -> PyResult<Language> {
    code.parse().map_err(|error: UnknownLanguage| PyValueError::new_err(error.to_string()))
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
