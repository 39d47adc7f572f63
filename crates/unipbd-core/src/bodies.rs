//! Rigid bodies: poses, masses, and the loads the fluid puts on them.

use crate::math::Vector64;

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// Moved by forces and contacts.
    Dynamic,
    /// Moved by a script, whatever pushes it.
    Kinematic,
    /// Never moves.
    Static,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name given in the scene.
    pub name: String,
    /// How it moves.
    pub kind: BodyKind,
    /// Centre of mass [m].
    pub position: Vector64,
    /// Rotation, counter-clockwise [rad].
    pub angle: f64,
    /// Velocity of the centre of mass [m/s].
    pub velocity: Vector64,
    /// Angular velocity, counter-clockwise [rad/s].
    pub angular_velocity: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre of mass [kg m^2].
    pub inertia: f64,
    /// Outline in body coordinates, counter-clockwise [m]; a disc has none.
    pub outline: Vec<Vector64>,
    /// Radius of a disc, 0 for a polygon [m].
    pub radius: f64,
    /// Lattice samples in body coordinates [m].
    pub samples: Vec<Vector64>,
    /// Force of the fluid over the last frame, mean [N].
    pub fluid_force: Vector64,
    /// Torque of the fluid about the centre of mass over the last frame, mean [N m].
    pub fluid_torque: f64,
}
