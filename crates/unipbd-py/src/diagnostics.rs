//! Diagnostics as dicts with the same keys, whether of a run or from a log.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_core::Phase;
use unipbd_core::observe::{Diagnostics, Entry, Table, Value};

/// Diagnostics of a run.
pub fn running<'py>(py: Python<'py>, of: &Diagnostics) -> PyResult<Bound<'py, PyDict>> {
    let dict = quantities(py, of)?;
    add_list(&dict, &of.materials)?;
    add_list(&dict, &of.groups)?;
    add_list(&dict, &of.walls)?;
    add_list(&dict, &of.gauges)?;
    Ok(dict)
}

/// Diagnostics from a log, with the hash of the state.
pub fn recorded<'py>(py: Python<'py>, of: &Diagnostics, state_hash: Option<u64>) -> PyResult<Bound<'py, PyDict>> {
    let dict = running(py, of)?;
    dict.set_item("state_hash", state_hash)?;
    Ok(dict)
}

fn add_list<T: Entry>(dict: &Bound<'_, PyDict>, entries: &[T]) -> PyResult<()> {
    let by_name = PyDict::new(dict.py());
    for entry in entries {
        by_name.set_item(entry.name(), quantities(dict.py(), entry)?)?;
    }
    dict.set_item(T::LIST, by_name)
}

fn quantities<'py, T: Table>(py: Python<'py>, table: &T) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for quantity in T::QUANTITIES {
        match (quantity.read)(table) {
            Value::Count(count) => dict.set_item(quantity.name, count)?,
            Value::Number(number) => dict.set_item(quantity.name, number)?,
            Value::Vector(vector) => dict.set_item(quantity.name, (vector.x, vector.y))?,
            Value::Word(word) => dict.set_item(quantity.name, word)?,
            Value::ByPhase(by_phase) => dict.set_item(quantity.name, counts(py, by_phase)?)?,
        }
    }
    Ok(dict)
}

/// Particles by the name of their phase.
pub fn counts(py: Python<'_>, by_phase: [u64; Phase::ALL.len()]) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (phase, count) in Phase::ALL.into_iter().zip(by_phase) {
        dict.set_item(phase.name(), count)?;
    }
    Ok(dict)
}
