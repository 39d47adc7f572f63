//! What a hook is given: the particles at the start of a substep.

use std::sync::{Mutex, PoisonError};

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use unipbd_core::math::{Vector64, vector};
use unipbd_core::{MaterialIndex, Phase, SubstepView, Vector};

use crate::{arrays, errors, order};

/// The simulation at the start of a substep. Arrays are in the order of ids.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Substep {
    time: f64,
    dt: f64,
    step: u64,
    /// Rows in the order of their ids.
    rows: Vec<u32>,
    positions: Vec<Vector>,
    velocities: Vec<Vector>,
    ids: Vec<u32>,
    phases: Vec<Phase>,
    materials: Vec<MaterialIndex>,
    /// What the hook asks for; `None` once the hook has returned.
    wishes: Mutex<Option<Wishes>>,
}

/// What a hook asks for, in the order of ids.
#[derive(Default)]
pub struct Wishes {
    accelerations: Vec<Vector64>,
    velocities: Vec<(u32, Vector64)>,
}

impl Substep {
    pub fn new(view: &SubstepView<'_>) -> Self {
        Substep {
            time: view.time(),
            dt: view.dt(),
            step: view.step(),
            rows: order::by_id(view.ids()),
            positions: view.positions().to_vec(),
            velocities: view.velocities().to_vec(),
            ids: view.ids().to_vec(),
            phases: view.particles().phases().to_vec(),
            materials: view.particles().materials().to_vec(),
            wishes: Mutex::new(Some(Wishes::default())),
        }
    }

    /// Carries out what the hook asked for.
    pub fn finish(&self, view: &mut SubstepView<'_>) {
        let Some(wishes) = self.wishes.lock().unwrap_or_else(PoisonError::into_inner).take() else { return };
        if !wishes.accelerations.is_empty() {
            let accelerations = view.accelerations_mut();
            for (&row, &wanted) in self.rows.iter().zip(&wishes.accelerations) {
                accelerations[row as usize] += vector(wanted);
            }
        }
        for (row, velocity) in wishes.velocities {
            view.set_velocity(row as usize, vector(velocity));
        }
    }

    fn with_wishes<T>(&self, py: Python<'_>, change: impl FnOnce(&mut Wishes) -> T) -> PyResult<T> {
        let mut wishes = self.wishes.lock().unwrap_or_else(PoisonError::into_inner);
        match &mut *wishes {
            Some(wishes) => Ok(change(wishes)),
            None => Err(errors::other(py, "the substep is over: use it within the hook only")),
        }
    }
}

#[pymethods]
impl Substep {
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    #[getter]
    fn dt(&self) -> f64 {
        self.dt
    }

    #[getter]
    fn step(&self) -> u64 {
        self.step
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        arrays::vectors(py, &self.positions, &self.rows)
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        arrays::vectors(py, &self.velocities, &self.rows)
    }

    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        arrays::gathered(py, &self.ids, &self.rows, |id| id)
    }

    #[getter]
    fn phases<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        arrays::gathered(py, &self.phases, &self.rows, |phase| phase as u8)
    }

    #[getter]
    fn material_indices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u16>> {
        arrays::gathered(py, &self.materials, &self.rows, |material| material)
    }

    /// Adds one acceleration for each particle.
    fn add_accelerations(&self, py: Python<'_>, accelerations: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let wanted = checked(&arrays::rows(&accelerations), self.rows.len())?;
        self.with_wishes(py, |wishes| {
            wishes.accelerations.resize(wanted.len(), Vector64::ZERO);
            wishes.accelerations.iter_mut().zip(&wanted).for_each(|(sum, &wanted)| *sum += wanted);
        })
    }

    /// Adds the same acceleration for every particle.
    fn add_uniform_acceleration(&self, py: Python<'_>, x: f64, y: f64) -> PyResult<()> {
        let wanted = checked(&[Vector64::new(x, y)], 1)?[0];
        self.with_wishes(py, |wishes| {
            wishes.accelerations.resize(self.rows.len(), Vector64::ZERO);
            wishes.accelerations.iter_mut().for_each(|sum| *sum += wanted);
        })
    }

    /// Sets the velocities of these particles: how those moved by a script are moved.
    fn set_velocities(&self, py: Python<'_>, ids: Vec<u32>, velocities: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let velocities = checked(&arrays::rows(&velocities), ids.len())?;
        let mut wanted = Vec::with_capacity(ids.len());
        for (id, velocity) in ids.into_iter().zip(velocities) {
            let found = self.rows.binary_search_by_key(&id, |&row| self.ids[row as usize]);
            let place = found.map_err(|_| errors::edit_message(py, &format!("there is no particle with id {id}")))?;
            wanted.push((self.rows[place], velocity));
        }
        self.with_wishes(py, |wishes| wishes.velocities.extend(wanted))
    }
}

/// Vectors of the right number that the particles' precision can hold.
pub fn checked(values: &[Vector64], count: usize) -> PyResult<Vec<Vector64>> {
    if values.len() != count {
        return Err(PyValueError::new_err(format!("{} rows are given for {count} particles", values.len())));
    }
    match values.iter().position(|value| !vector(*value).is_finite()) {
        Some(index) => Err(PyValueError::new_err(format!("row {index} is not finite"))),
        None => Ok(values.to_vec()),
    }
}
