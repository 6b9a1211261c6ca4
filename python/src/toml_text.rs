//! Writes Python values as TOML, the language of scenes.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use toml::Value;

/// The largest depth of nested values. A value that contains itself exceeds it.
const MAX_DEPTH: usize = 64;

/// Returns a Python value as a TOML value in one line.
///
/// # Errors
/// `TypeError` for a value of another type than text, number, boolean, sequence or mapping.
#[pyfunction]
pub(crate) fn toml_value(value: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(read(value, 0)?.to_string())
}

/// Returns a Python mapping as the text of a TOML document.
///
/// # Errors
/// `TypeError` for a value of another type than text, number, boolean, sequence or mapping.
#[pyfunction]
pub(crate) fn toml_document(mapping: &Bound<'_, PyAny>) -> PyResult<String> {
    let value = read(mapping, 0)?;
    toml::to_string(&value).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn read(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > MAX_DEPTH {
        return Err(PyValueError::new_err("the value is nested too deeply"));
    }
    // A boolean is an integer, too.
    if let Ok(boolean) = value.cast::<PyBool>() {
        return Ok(Value::Boolean(boolean.is_true()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::String(text.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let mut table = toml::Table::new();
        for pair in mapping.items()?.iter() {
            let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract()?;
            let key: String =
                key.extract().map_err(|_| PyTypeError::new_err(format!("the key {key} is not a string")))?;
            table.insert(key, read(&value, depth + 1)?);
        }
        return Ok(Value::Table(table));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.map(|item| read(&item?, depth + 1));
        return Ok(Value::Array(items.collect::<PyResult<_>>()?));
    }
    // Arrays and numbers of numpy.
    if value.hasattr("tolist")? {
        return read(&value.call_method0("tolist")?, depth + 1);
    }
    if value.hasattr("__fspath__")? {
        return read(&value.call_method0("__fspath__")?, depth + 1);
    }
    let message = format!("a scene cannot hold a value of the type {}", value.get_type().name()?);
    Err(PyTypeError::new_err(message))
}
