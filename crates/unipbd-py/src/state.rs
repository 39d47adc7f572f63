use pyo3::prelude::*;
use pyo3::types::PyBytes;
use unipbd_core::State as CoreState;

use crate::errors;

/// A saved moment of a simulation.
#[pyclass(frozen, module = "unipbd._native")]
pub struct State {
    pub state: CoreState,
}

#[pymethods]
impl State {
    #[staticmethod]
    fn from_bytes(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let state = py.detach(|| CoreState::from_bytes(data)).map_err(|error| errors::state(py, &error))?;
        Ok(State { state })
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let bytes = py.detach(|| self.state.to_bytes());
        PyBytes::new(py, &bytes)
    }

    #[getter]
    fn time(&self) -> f64 {
        self.state.time()
    }

    #[getter]
    fn frame(&self) -> u64 {
        self.state.frame()
    }

    #[getter]
    fn step(&self) -> u64 {
        self.state.step()
    }

    #[getter]
    fn particles(&self) -> usize {
        self.state.particles()
    }
}
