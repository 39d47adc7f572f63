//! Rigid bodies: one quantity, or all as a dict.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_core::math::Vector64;
use unipbd_core::rigid::{Body, BodyKind};

use crate::{arrays, errors};

/// All quantities, those that change from frame to frame last.
const QUANTITIES: [&str; 21] = [
    "name",
    "kind",
    "mass",
    "inertia",
    "friction",
    "restitution",
    "gravity_factor",
    "sensor",
    "user_data",
    "radius",
    "outline",
    "samples",
    "position",
    "angle",
    "velocity",
    "angular_velocity",
    "asleep",
    "fluid_force",
    "fluid_torque",
    "contact_force",
    "contact_torque",
];

/// All quantities of a body by name.
pub fn quantities<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for name in QUANTITIES {
        dict.set_item(name, quantity(py, body, name)?)?;
    }
    Ok(dict)
}

/// One quantity of a body.
pub fn quantity<'py>(py: Python<'py>, body: &Body, name: &str) -> PyResult<Bound<'py, PyAny>> {
    match name {
        "name" => (&body.name).into_bound_py_any(py),
        "kind" => kind(body.kind).into_bound_py_any(py),
        "mass" => body.mass.into_bound_py_any(py),
        "inertia" => body.inertia.into_bound_py_any(py),
        "friction" => body.surface.static_friction.into_bound_py_any(py),
        "restitution" => body.surface.restitution.into_bound_py_any(py),
        "gravity_factor" => body.gravity_factor.into_bound_py_any(py),
        "sensor" => body.sensor.into_bound_py_any(py),
        "user_data" => body.user_data.into_bound_py_any(py),
        "radius" => body.radius.into_bound_py_any(py),
        "outline" => points(py, &body.outline),
        "samples" => points(py, &body.samples),
        "position" => Ok(pair(py, body.position)),
        "angle" => body.angle.into_bound_py_any(py),
        "velocity" => Ok(pair(py, body.velocity)),
        "angular_velocity" => body.angular_velocity.into_bound_py_any(py),
        "asleep" => body.asleep.into_bound_py_any(py),
        "fluid_force" => Ok(pair(py, body.fluid_force)),
        "fluid_torque" => body.fluid_torque.into_bound_py_any(py),
        "contact_force" => Ok(pair(py, body.contact_force)),
        "contact_torque" => body.contact_torque.into_bound_py_any(py),
        _ => Err(errors::other(py, &format!("a body has no {name}"))),
    }
}

/// The word for a kind of body.
pub fn kind(kind: BodyKind) -> &'static str {
    match kind {
        BodyKind::Dynamic => "dynamic",
        BodyKind::Kinematic => "kinematic",
        BodyKind::Static => "static",
    }
}

fn pair(py: Python<'_>, vector: Vector64) -> Bound<'_, PyAny> {
    arrays::fixed(py, vec![vector.x, vector.y]).into_any()
}

/// Points as an (N, 2) array.
pub fn points<'py>(py: Python<'py>, points: &[Vector64]) -> PyResult<Bound<'py, PyAny>> {
    Ok(arrays::matrix(py, points.iter().flat_map(|point| [point.x, point.y]).collect())?.into_any())
}
