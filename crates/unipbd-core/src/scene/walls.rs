use serde::{Deserialize, Serialize};

use super::bodies::FRICTION;

/// A static straight wall without end; particles stay on the side the normal points to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HalfPlane {
    /// Name under which the force of fluids and bodies on it is reported; left out, the force is not measured.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// A point on the wall [m].
    pub point: [f64; 2],
    /// Direction from the wall towards the particles; need not have length 1.
    pub normal: [f64; 2],
    /// Velocity at which the wall slides along itself: viscous fluids without slip and bodies with friction feel it
    /// [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Coulomb friction coefficient; left out, 0.5 for bodies and 0 for particles. A body on it has both coefficients
    /// combined by `contacts.friction_rule`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Whether a fluid with a kinematic viscosity slips along it.
    #[serde(default)]
    pub slip: Slip,
}

/// A static container: particles stay inside the rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tank {
    /// Name under which the force of fluids and bodies on it is reported; left out, the force is not measured; its sides are `NAME left` and so on.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Lower left corner [m].
    pub min: [f64; 2],
    /// Upper right corner [m].
    pub max: [f64; 2],
    /// Sides without a wall.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<Side>,
    /// Coulomb friction coefficient; left out, 0.5 for bodies and 0 for particles. A body on it has both coefficients
    /// combined by `contacts.friction_rule`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Whether a fluid with a kinematic viscosity slips along it.
    #[serde(default)]
    pub slip: Slip,
    /// Sides along which it does not slip, whatever `slip` says.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without_slip: Vec<Side>,
}

/// A static box: particles stay outside the rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Name under which the force of fluids and bodies on it is reported; left out, the force is not measured.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Lower left corner [m].
    pub min: [f64; 2],
    /// Upper right corner [m].
    pub max: [f64; 2],
    /// Coulomb friction coefficient; left out, 0.5 for bodies and 0 for particles. A body on it has both coefficients
    /// combined by `contacts.friction_rule`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Whether a fluid with a kinematic viscosity slips along it.
    #[serde(default)]
    pub slip: Slip,
}

/// The coefficient that bodies feel on a wall with this `friction`.
pub(crate) fn body_friction(friction: Option<f64>) -> f64 {
    friction.unwrap_or(FRICTION)
}

/// A side of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Smallest x.
    Left,
    /// Largest x.
    Right,
    /// Smallest y.
    Bottom,
    /// Largest y.
    Top,
}

impl Side {
    /// All sides.
    pub const ALL: [Side; 4] = [Side::Left, Side::Right, Side::Bottom, Side::Top];

    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Side::Left => "left",
            Side::Right => "right",
            Side::Bottom => "bottom",
            Side::Top => "top",
        }
    }
}

/// Whether a viscous fluid slips along a wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Slip {
    /// The wall exerts no shear.
    #[default]
    Free,
    /// The fluid at the wall moves with it.
    None,
}
