//! Edits from Python: arrays in, checked as a whole.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use unipbd_core::Edit;
use unipbd_core::edit::Points;
use unipbd_core::math::Vector64;
use unipbd_core::scene::PointMotion;

use crate::{arrays, errors};

/// Values for some particles.
#[derive(FromPyObject)]
pub enum Values<'py> {
    #[pyo3(transparent)]
    Vectors(PyReadonlyArray2<'py, f64>),
    #[pyo3(transparent)]
    Numbers(PyReadonlyArray1<'py, f64>),
    #[pyo3(transparent)]
    Word(String),
}

/// Particles to add.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Addition<'py> {
    material: String,
    positions: PyReadonlyArray2<'py, f64>,
    velocities: PyReadonlyArray2<'py, f64>,
    temperature: f64,
    motion: String,
}

/// The edit that the lists of Python describe.
pub fn edit(
    py: Python<'_>,
    changes: Vec<(String, Vec<u32>, Values<'_>)>,
    removals: Vec<u32>,
    additions: Vec<Addition<'_>>,
    bodies: Vec<(u32, [f64; 2], f64)>,
) -> PyResult<Edit> {
    let mut edit = Edit::new().remove(removals);
    for (kind, ids, values) in changes {
        edit = match (&kind[..], values) {
            ("positions", Values::Vectors(values)) => edit.set_positions(ids, arrays::rows(&values)),
            ("velocities", Values::Vectors(values)) => edit.set_velocities(ids, arrays::rows(&values)),
            ("temperatures", Values::Numbers(values)) => {
                edit.set_temperatures(ids, values.as_array().iter().copied().collect::<Vec<_>>())
            }
            ("motion", Values::Word(word)) => edit.set_motion(ids, motion(py, &word)?),
            _ => return Err(errors::edit_message(py, &format!("no such change: {kind}"))),
        };
    }
    for (body, velocity, angular_velocity) in bodies {
        edit = edit.set_body_velocity(body, velocity.into(), angular_velocity);
    }
    for addition in additions {
        edit = edit.add_points(Points {
            material: addition.material,
            positions: arrays::rows(&addition.positions),
            velocity: Vector64::ZERO,
            velocities: arrays::rows(&addition.velocities),
            temperature: addition.temperature,
            motion: motion(py, &addition.motion)?,
        });
    }
    Ok(edit)
}

fn motion(py: Python<'_>, word: &str) -> PyResult<PointMotion> {
    match word {
        "free" => Ok(PointMotion::Free),
        "kinematic" => Ok(PointMotion::Kinematic),
        _ => Err(errors::edit_message(py, &format!("motion is \"free\" or \"kinematic\", not \"{word}\""))),
    }
}
