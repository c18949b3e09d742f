//! NumPy arrays: read-only views of memory that Rust objects own, and new two-dimensional arrays.

use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A one-dimensional array.
pub(crate) type Numbers<'py> = Bound<'py, PyArray1<f64>>;

/// A two-dimensional array.
pub(crate) type Rows<'py> = Bound<'py, PyArray2<f64>>;

/// Returns numbers owned by a frozen object as a read-only array that keeps its owner alive.
#[expect(unsafe_code, reason = "an array over memory owned by another object")]
pub(crate) fn view<'py>(owner: &Bound<'py, PyAny>, values: &[f64]) -> PyResult<Numbers<'py>> {
    // SAFETY: all callers pass numbers that a `#[pyclass(frozen)]` owns behind an `Arc` and never
    // changes. They stay in place as long as `owner` lives; the array holds `owner` and cannot be
    // written.
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(values), owner.clone()) };
    let flags = PyDict::new(owner.py());
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array)
}

/// Returns rows of numbers as a new array.
pub(crate) fn rows<const N: usize>(
    py: Python<'_>,
    rows: impl ExactSizeIterator<Item = [f64; N]>,
) -> PyResult<Rows<'_>> {
    let count = rows.len();
    PyArray1::from_iter(py, rows.flatten()).reshape([count, N])
}
