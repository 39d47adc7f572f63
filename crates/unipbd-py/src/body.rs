//! Rigid bodies as dicts.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_core::math::Vector64;
use unipbd_core::rigid::{Body, BodyKind};

use crate::arrays;

/// What changes about a body from frame to frame.
pub fn motion<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("position", pair(py, body.position))?;
    dict.set_item("angle", body.angle)?;
    dict.set_item("velocity", pair(py, body.velocity))?;
    dict.set_item("angular_velocity", body.angular_velocity)?;
    dict.set_item("asleep", body.asleep)?;
    dict.set_item("fluid_force", pair(py, body.fluid_force))?;
    dict.set_item("fluid_torque", body.fluid_torque)?;
    dict.set_item("contact_force", pair(py, body.contact_force))?;
    dict.set_item("contact_torque", body.contact_torque)?;
    Ok(dict)
}

/// What stays the same about a body.
pub fn shape<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", &body.name)?;
    dict.set_item("kind", kind(body.kind))?;
    dict.set_item("mass", body.mass)?;
    dict.set_item("inertia", body.inertia)?;
    dict.set_item("friction", body.surface.static_friction)?;
    dict.set_item("restitution", body.surface.restitution)?;
    dict.set_item("gravity_factor", body.gravity_factor)?;
    dict.set_item("sensor", body.sensor)?;
    dict.set_item("user_data", body.user_data)?;
    dict.set_item("radius", body.radius)?;
    dict.set_item("outline", points(py, &body.outline)?)?;
    dict.set_item("samples", points(py, &body.samples)?)?;
    Ok(dict)
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
