use serde::{Deserialize, Serialize};

use crate::math::{Real, real};

/// Particles at places given one by one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Points {
    /// Name of the material.
    pub material: String,
    /// Where the particles are \[m].
    pub positions: Vec<[f64; 2]>,
    /// Velocity of all of them [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Velocity of each of them, in place of `velocity` [m/s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocities: Vec<[f64; 2]>,
    /// Temperature at the start (gas).
    #[serde(default)]
    pub temperature: f64,
    /// Whether forces move them.
    #[serde(default)]
    pub motion: PointMotion,
}

/// What moves a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum PointMotion {
    /// Forces and constraints.
    #[default]
    Free,
    /// Its velocity alone, which only the caller changes.
    Kinematic,
}

impl PointMotion {
    /// The inverse mass of a particle of this mass [1/kg].
    pub(crate) fn inverse_mass(self, mass: f64) -> Real {
        match self {
            PointMotion::Kinematic => 0.0,
            PointMotion::Free if mass > 0.0 => real(1.0 / mass),
            PointMotion::Free => 0.0,
        }
    }
}
