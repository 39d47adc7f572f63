//! The particles of one moment within a substep, as hooks and groups see them.

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use unipbd_core::math::{Vector64, vector};
use unipbd_core::particles::Particles as CoreParticles;
use unipbd_core::{MaterialIndex, Phase, Real, Vector};

use crate::{arrays, order};

/// Particles of one moment. Arrays are in the order of ids.
#[pyclass(frozen, subclass, module = "unipbd._native")]
pub struct Particles {
    pub time: f64,
    pub dt: f64,
    /// Rows in the order of their ids.
    rows: Vec<u32>,
    positions: Vec<Vector>,
    velocities: Vec<Vector>,
    ids: Vec<u32>,
    phases: Vec<Phase>,
    materials: Vec<MaterialIndex>,
    inverse_masses: Vec<Real>,
}

impl Particles {
    pub fn new(time: f64, dt: f64, of: &CoreParticles) -> Self {
        Particles {
            time,
            dt,
            rows: order::by_id(of.ids()),
            positions: of.positions().to_vec(),
            velocities: of.velocities().to_vec(),
            ids: of.ids().to_vec(),
            phases: of.phases().to_vec(),
            materials: of.materials().to_vec(),
            inverse_masses: of.inverse_masses().to_vec(),
        }
    }

    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// A column of another moment of the same substep, in the order of ids.
    pub fn ordered<'py>(&self, py: Python<'py>, column: &[Vector]) -> PyResult<Bound<'py, PyArray2<f32>>> {
        arrays::vectors(py, column, &self.rows)
    }

    /// The row of a particle.
    pub fn row(&self, id: u32) -> Option<u32> {
        self.rows.binary_search_by_key(&id, |&row| self.ids[row as usize]).ok().map(|place| self.rows[place])
    }

    /// Hands each row its value of a column in the order of ids.
    pub fn scatter(&self, values: &[Vector64], mut take: impl FnMut(usize, Vector)) {
        for (&row, &value) in self.rows.iter().zip(values) {
            take(row as usize, vector(value));
        }
    }
}

#[pymethods]
impl Particles {
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
        self.ordered(py, &self.positions)
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.ordered(py, &self.velocities)
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

    #[getter]
    fn inverse_masses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        arrays::gathered(py, &self.inverse_masses, &self.rows, arrays::single)
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
