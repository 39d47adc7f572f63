//! Constraint groups written in Python.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use unipbd_core::Vector;
use unipbd_core::constraints::{ConstraintGroup, Corrections, Needs, Substep};

use crate::arrays;
use crate::particles::{Particles, checked};

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

/// One iteration as a Python group sees it.
#[pyclass(frozen, extends = Particles, module = "unipbd._native")]
pub struct Projection {
    starts: Vec<Vector>,
}

#[pymethods]
impl Projection {
    #[getter]
    fn starts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        slf.as_super().get().ordered(slf.py(), &slf.get().starts)
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
        if let Err(error) = Python::attach(|py| self.call(py, now, out)) {
            self.failure.set(error);
        }
    }
}

impl PythonGroup {
    fn call(&self, py: Python<'_>, now: Substep<'_>, out: &mut Corrections) -> PyResult<()> {
        let seen = Particles::new(now.time, f64::from(now.dt), now.particles);
        let view = Bound::new(py, (Projection { starts: now.particles.starts().to_vec() }, seen))?;
        let wanted = self.project.call1(py, (&view,))?;
        if wanted.is_none(py) {
            return Ok(());
        }
        let wanted: PyReadonlyArray2<'_, f64> = wanted.extract(py)?;
        let particles = view.as_super().get();
        let steps = checked(&arrays::rows(&wanted), particles.count())?;
        particles.scatter(&steps, |row, step| out.add(row, step));
        Ok(())
    }
}
