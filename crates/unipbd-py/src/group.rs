//! Constraint groups written in Python.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use unipbd_core::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use unipbd_core::math::vector;
use unipbd_core::{Real, Vector};

use crate::{arrays, hook, order};

/// The first exception of any group, until the step is over.
#[derive(Clone, Default)]
pub struct Failure(Arc<Mutex<Option<PyErr>>>);

impl Failure {
    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn is_set(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    fn set(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// A group whose projection is a Python function.
pub struct PythonGroup {
    pub name: String,
    pub project: Py<PyAny>,
    pub failure: Failure,
}

/// One iteration as a Python group sees it. Arrays are in the order of ids.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Projection {
    time: f64,
    dt: f64,
    rows: Vec<u32>,
    positions: Vec<Vector>,
    starts: Vec<Vector>,
    ids: Vec<u32>,
    inverse_masses: Vec<Real>,
}

#[pymethods]
impl Projection {
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    #[getter]
    fn dt(&self) -> f64 {
        self.dt
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        arrays::vectors(py, &self.positions, &self.rows)
    }

    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        arrays::vectors(py, &self.starts, &self.rows)
    }

    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        arrays::gathered(py, &self.ids, &self.rows, |id| id)
    }

    #[getter]
    fn inverse_masses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        arrays::gathered(py, &self.inverse_masses, &self.rows, arrays::single)
    }
}

impl ConstraintGroup for PythonGroup {
    fn name(&self) -> &str {
        &self.name
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        if self.failure.is_set() {
            return;
        }
        let particles = now.particles;
        let view = Projection {
            time: now.time,
            dt: f64::from(now.dt),
            rows: order::by_id(particles.ids()),
            positions: particles.positions().to_vec(),
            starts: particles.starts().to_vec(),
            ids: particles.ids().to_vec(),
            inverse_masses: particles.inverse_masses().to_vec(),
        };
        if let Err(error) = Python::attach(|py| self.call(py, view, out)) {
            self.failure.set(error);
        }
    }
}

impl PythonGroup {
    fn call(&self, py: Python<'_>, view: Projection, out: &mut Corrections) -> PyResult<()> {
        let view = Py::new(py, view)?;
        let wanted = self.project.call1(py, (view.clone_ref(py),))?;
        if wanted.is_none(py) {
            return Ok(());
        }
        let rows = &view.get().rows;
        let wanted: PyReadonlyArray2<'_, f64> = wanted.extract(py)?;
        for (&row, step) in rows.iter().zip(hook::checked(&arrays::rows(&wanted), rows.len())?) {
            out.add(row as usize, vector(step));
        }
        Ok(())
    }
}
