//! Results that consist of numbers, serialized to JSON, and a page: comparisons, rankings, calibrations,
//! and decisions from studies.

use std::borrow::Borrow;
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

/// A result: its numbers as JSON, and the document from which its page and its files are made.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Page {
    numbers: String,
    document: Document,
}

impl Page {
    /// Creates a page from its document and its numbers, which are serialized to JSON.
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
        html_in(py, language, || &self.document)
    }

    fn pdf<'py>(
        &self,
        py: Python<'py>,
        paper: &str,
        language: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        pdf_in(py, (paper, language), || &self.document)
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

/// Returns the language with the given code.
pub(crate) fn language_of(code: &str) -> PyResult<Language> {
    code.parse().map_err(|error: UnknownLanguage| PyValueError::new_err(error.to_string()))
}

/// Returns a document as an HTML page in the language with the given code.
pub(crate) fn html_in<D: Borrow<Document>>(
    py: Python<'_>,
    language: &str,
    document: impl FnOnce() -> D + Send,
) -> PyResult<String> {
    let language = language_of(language)?;
    Ok(py.detach(|| html(&document().borrow().in_language(language))))
}

/// Returns a document as a PDF in the paper size with the given name and in the language with the given code.
pub(crate) fn pdf_in<'py, D: Borrow<Document>>(
    py: Python<'py>,
    (paper, language): (&str, &str),
    document: impl FnOnce() -> D + Send,
) -> PyResult<Bound<'py, PyBytes>> {
    let (paper, language) = (paper_of(paper)?, language_of(language)?);
    let pdf = py.detach(|| document_pdf(&document().borrow().in_language(language), paper));
    Ok(bytes(py, &pdf))
}

/// Returns the paper size with the given name.
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
