//! Scene descriptions between Python (dicts, lists, arrays) and TOML values.

use numpy::{PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

/// Deepest nesting of a description.
const DEEPEST: usize = 32;

/// A TOML table from a dict; entries that are None are left out.
pub fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    table_at(dict, 0)
}

fn table_at(dict: &Bound<'_, PyDict>, depth: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in dict {
        if !value.is_none() {
            let key: String = key.extract().map_err(|_| PyTypeError::new_err("keys of a scene are strings"))?;
            table.insert(key, value_at(&value, depth + 1)?);
        }
    }
    Ok(table)
}

fn value_at(object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(PyValueError::new_err("the scene is nested too deeply"));
    }
    if let Ok(dict) = object.cast::<PyDict>() {
        return Ok(Value::Table(table_at(dict, depth)?));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(Value::String(text.extract()?));
    }
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Boolean(flag.is_true()));
    }
    if object.is_instance_of::<PyInt>() {
        let number = object.extract::<i64>().map_err(|_| PyValueError::new_err(format!("{object} is too large")))?;
        return Ok(Value::Integer(number));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(object.extract()?));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let elements: PyResult<Vec<Value>> = object.try_iter()?.map(|item| value_at(&item?, depth + 1)).collect();
        return Ok(Value::Array(elements?));
    }
    if let Some(array) = array(object)? {
        return Ok(array);
    }
    // Numbers and arrays of NumPy know how to become Python's own.
    if let Ok(own) = object.call_method0("tolist") {
        return value_at(&own, depth + 1);
    }
    let kind = object.get_type().name()?;
    Err(PyTypeError::new_err(format!("a scene holds numbers, words, lists and tables, not {kind}")))
}

/// Arrays of doubles, the quick way: points of a scene may be many.
fn array(object: &Bound<'_, PyAny>) -> PyResult<Option<Value>> {
    if let Ok(array) = object.extract::<PyReadonlyArray2<'_, f64>>() {
        let rows = array.as_array().rows().into_iter().map(|row| floats(row.iter().copied())).collect();
        return Ok(Some(Value::Array(rows)));
    }
    let array = object.extract::<PyReadonlyArray1<'_, f64>>().ok();
    Ok(array.map(|array| floats(array.to_owned_array())))
}

fn floats(values: impl IntoIterator<Item = f64>) -> Value {
    Value::Array(values.into_iter().map(Value::Float).collect())
}

/// A dict from a TOML table.
pub fn dict<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, object(py, value)?)?;
    }
    Ok(dict)
}

fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        Value::Datetime(time) => time.to_string().into_pyobject(py)?.into_any(),
        Value::Array(elements) => {
            let list: PyResult<Vec<_>> = elements.iter().map(|element| object(py, element)).collect();
            PyList::new(py, list?)?.into_any()
        }
        Value::Table(table) => dict(py, table)?.into_any(),
    })
}
