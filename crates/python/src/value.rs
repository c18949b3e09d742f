//! Converts Python values to values of a scenario.

use barrelstack::scenario::tree::{Entry, Node, Origin, Table, Value};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

fn node(value: Value) -> Node {
    Node { origin: Origin::Default, value }
}

/// Converts a dict to the TOML [`Table`] of a scenario.
pub(crate) fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    let mut entries = Vec::new();
    for (key, value) in dict {
        let key: String = key.extract().map_err(|_| {
            PyTypeError::new_err(format!("keys of a scenario must be texts, found {key:?}"))
        })?;
        entries.push(Entry { origin: Origin::Default, node: node(of(&value, &key)?), key });
    }
    Ok(Table { entries })
}

fn of(value: &Bound<'_, PyAny>, key: &str) -> PyResult<Value> {
    if let Ok(dict) = value.cast::<PyDict>() {
        return table(dict).map(Value::Table);
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.map(|item| Ok(node(of(&item?, key)?)));
        return items.collect::<PyResult<_>>().map(Value::Array);
    }
    // Tests for bool first, because bool is a subclass of int in Python.
    if value.is_instance_of::<PyBool>() {
        return value.extract().map(Value::Flag);
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract().ok()));
    }
    if value.is_instance_of::<PyFloat>() {
        return value.extract().map(Value::Float);
    }
    if value.is_instance_of::<PyString>() {
        return value.extract().map(Value::Text);
    }
    Err(PyTypeError::new_err(format!(
        "`{key}` has the type {}; a scenario can contain only texts, numbers, booleans, lists and dicts",
        value.get_type().name()?
    )))
}
