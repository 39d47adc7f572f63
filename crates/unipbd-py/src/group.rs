//! Constraint groups written in Python.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::PyTraverseError;
use pyo3::exceptions::PyValueError;
use pyo3::gc::PyVisit;
use pyo3::prelude::*;
use unipbd_core::Vector;
use unipbd_core::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use unipbd_core::math::Vector64;

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

/// The function of a group. The solver holds it out of sight of Python's garbage collector; a second handle shows it
/// there, since it often refers to the simulation that holds it.
#[derive(Clone)]
pub struct Callable(Arc<Mutex<Option<Py<PyAny>>>>);

impl Callable {
    pub fn new(function: Py<PyAny>) -> Self {
        Callable(Arc::new(Mutex::new(Some(function))))
    }

    fn get(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|function| function.clone_ref(py))
    }

    /// Shows the function to the garbage collector, which must not wait.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self.0.try_lock() {
            Ok(function) => visit.call(&*function),
            Err(_) => Ok(()),
        }
    }

    /// Lets go of the function: the simulation is unreachable.
    pub fn clear(&self) {
        let function = self.0.try_lock().ok().and_then(|mut function| function.take());
        drop(function);
    }
}

/// A group whose projection is a Python function.
pub struct PythonGroup {
    pub name: String,
    pub project: Callable,
    pub failure: Failure,
    /// From this speed on a run counts as diverged [m/s].
    pub speed_limit: f64,
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
        let Some(project) = self.project.get(py) else { return Ok(()) };
        let wanted = project.call1(py, (&view,))?;
        if wanted.is_none(py) {
            return Ok(());
        }
        let wanted: PyReadonlyArray2<'_, f64> = wanted.extract(py)?;
        let particles = view.as_super().get();
        let steps = checked(&arrays::rows(&wanted), particles.count())?;
        let limit = self.speed_limit * particles.dt;
        if let Some(row) = steps.iter().position(|step| step.length() >= limit) {
            let (name, Vector64 { x, y }) = (&self.name, steps[row]);
            let message =
                format!("the group \"{name}\" moves row {row} by ({x:e}, {y:e}) m; the limit is {limit:.3e} m");
            return Err(PyValueError::new_err(message));
        }
        particles.scatter(&steps, |row, step| out.add(row, step));
        Ok(())
    }
}
