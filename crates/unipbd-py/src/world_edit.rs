//! Changes of bodies, joints and gravity from Python: dicts in, one for each change.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Deserialize;
use toml::Value;
use unipbd_core::edit::{BodyChange, EmitterChange};
use unipbd_core::rigid::contact::Motor;
use unipbd_core::scene::{BodyDescription, BodyKind, Emitter, JointDescription, Rope};
use unipbd_core::shapes::Shape;
use unipbd_core::{Edit, Vector64};

use crate::{convert, errors};

/// One change, named by its key `change`.
#[derive(Deserialize)]
#[serde(tag = "change", rename_all = "snake_case", deny_unknown_fields)]
enum Request {
    Gravity { gravity: [f64; 2] },
    AddBody { body: Box<BodyDescription> },
    RemoveBody { body: u32 },
    MoveBody { body: u32, position: [f64; 2], angle: f64 },
    ChangeBody { body: u32, values: Box<Values> },
    PushBody { body: u32, impulse: [f64; 2], point: [f64; 2] },
    AddJoint { joint: Box<JointDescription> },
    RemoveJoint { joint: u32 },
    SetMotor { joint: u32, speed: Option<f64>, limit: Option<f64> },
    AddEmitter { emitter: Box<Emitter> },
    ChangeEmitter { emitter: u32, speed: Option<f64>, temperature: Option<f64>, on: Option<bool> },
    RemoveEmitter { emitter: u32 },
    AddRope { rope: Box<Rope> },
    CutRope { rope: u32, piece: u32 },
    RemoveRope { rope: u32 },
}

/// Properties of a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Values {
    kind: Option<BodyKind>,
    mass: Option<f64>,
    friction: Option<f64>,
    rolling_friction: Option<f64>,
    restitution: Option<f64>,
    surface_speed: Option<f64>,
    gravity_factor: Option<f64>,
    linear_damping: Option<f64>,
    angular_damping: Option<f64>,
    layers: Option<Vec<u8>>,
    collides_with: Option<Vec<u8>>,
    collision_group: Option<i32>,
    user_data: Option<u64>,
    radius: Option<f64>,
    size: Option<[f64; 2]>,
    outline: Option<Vec<[f64; 2]>>,
}

impl Values {
    /// The new shape, if one is given.
    fn shape(&self, py: Python<'_>) -> PyResult<Option<Shape>> {
        match (self.radius, self.size, &self.outline) {
            (None, None, None) => Ok(None),
            (Some(radius), None, None) => Ok(Some(Shape::Disc { radius })),
            (None, Some([width, height]), None) => Ok(Some(Shape::rectangle(width, height))),
            (None, None, Some(outline)) => {
                Ok(Some(Shape::Polygon(outline.iter().copied().map(Vector64::from).collect())))
            }
            _ => Err(errors::edit_message(py, "a shape is one of radius, size and outline")),
        }
    }

    fn change(self, py: Python<'_>) -> PyResult<BodyChange> {
        let mask = |list: Vec<u8>| list.iter().fold(0, |mask, &layer| mask | 1_u32 << (layer & 31));
        Ok(BodyChange {
            shape: self.shape(py)?,
            kind: self.kind,
            mass: self.mass,
            friction: self.friction,
            rolling_friction: self.rolling_friction,
            restitution: self.restitution,
            surface_speed: self.surface_speed,
            gravity_factor: self.gravity_factor,
            linear_damping: self.linear_damping,
            angular_damping: self.angular_damping,
            layers: self.layers.map(mask),
            collides_with: self.collides_with.map(mask),
            collision_group: self.collision_group,
            user_data: self.user_data,
        })
    }
}

/// The edit with these changes.
pub fn with_changes(py: Python<'_>, mut edit: Edit, changes: Vec<Bound<'_, PyDict>>) -> PyResult<Edit> {
    for dict in changes {
        let value = Value::Table(convert::table(&dict)?);
        let change = Request::deserialize(value).map_err(|error| errors::edit_message(py, error.message()))?;
        edit = match change {
            Request::Gravity { gravity } => edit.set_gravity(gravity.into()),
            Request::AddBody { body } => edit.add_body(*body),
            Request::RemoveBody { body } => edit.remove_body(body),
            Request::MoveBody { body, position, angle } => edit.move_body(body, position.into(), angle),
            Request::ChangeBody { body, values } => edit.change_body(body, values.change(py)?),
            Request::PushBody { body, impulse, point } => edit.push_body(body, impulse.into(), Vector64::from(point)),
            Request::AddJoint { joint } => edit.add_joint(*joint),
            Request::RemoveJoint { joint } => edit.remove_joint(joint),
            Request::SetMotor { joint, speed, limit } => {
                let motor = speed.map(|speed| Motor { speed, max_torque: limit.unwrap_or(1e30) });
                edit.set_motor(joint, motor)
            }
            Request::AddEmitter { emitter } => edit.add_emitter(*emitter),
            Request::ChangeEmitter { emitter, speed, temperature, on } => {
                edit.change_emitter(emitter, EmitterChange { speed, temperature, on })
            }
            Request::RemoveEmitter { emitter } => edit.remove_emitter(emitter),
            Request::AddRope { rope } => edit.add_rope(*rope),
            Request::CutRope { rope, piece } => edit.cut_rope(rope, piece),
            Request::RemoveRope { rope } => edit.remove_rope(rope),
        };
    }
    Ok(edit)
}
