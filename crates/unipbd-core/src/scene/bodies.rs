use super::{MotionDescription, Slip};
use serde::{Deserialize, Serialize};

/// Coulomb friction coefficient of bodies and walls by default.
pub(crate) const FRICTION: f64 = 0.5;

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Moved by forces and contacts.
    Dynamic,
    /// Moved along a prescribed path, whatever pushes it.
    Kinematic,
    /// Never moves.
    Static,
}

/// A rigid body. Its outline is one of `radius`, `size` and `outline`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BodyDescription {
    /// Name by which joints, results and logs refer to it; left out, the body's number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Dynamic, kinematic or static.
    #[serde(default = "dynamic")]
    pub kind: BodyKind,
    /// How a dynamic body moves: as a rigid pose, or as particles drawn back to its shape.
    #[serde(default)]
    pub solver: BodySolver,
    /// Compliance of a body with `solver = "shape_matching"`: displacement of its samples from its shape per force, for a
    /// force spread over all of them; 0 is rigid [m/N].
    #[serde(default)]
    pub compliance: f64,
    /// Part of its wobble that such a body loses in a 60th of a second, 0 to 1.
    #[serde(default = "tenth")]
    pub damping: f64,
    /// Radius of a disc \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Width and height of a box \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
    /// Corners of a polygon, convex or not, seen from `position` \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Vec<[f64; 2]>>,
    /// Where the origin of the outline starts (the centre of a disc or box) \[m].
    pub position: [f64; 2],
    /// Rotation at the start, counter-clockwise \[degrees].
    #[serde(default)]
    pub angle_deg: f64,
    /// Velocity of the centre of mass at the start; a kinematic body without `motion` keeps it [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Angular velocity at the start, counter-clockwise; a kinematic body without `motion` keeps it [degrees/s].
    #[serde(default)]
    pub spin_deg: f64,
    /// Mass per area [kg/m^2].
    #[serde(default = "water_density")]
    pub density: f64,
    /// Mass, instead of the density \[kg].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Coulomb friction coefficient, 0.5 by default as for walls. Two surfaces have both combined by
    /// `contacts.friction_rule` (by default the root of the product), the larger restitution, the larger rolling friction.
    #[serde(default = "friction")]
    pub friction: f64,
    /// Friction coefficient while sliding; left out, the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinetic_friction: Option<f64>,
    /// Rolling resistance of a disc: largest moment over (normal force x radius).
    #[serde(default)]
    pub rolling_friction: f64,
    /// Rebound speed over impact speed, 0 to 1.
    #[serde(default)]
    pub restitution: f64,
    /// Speed of the surface along the outline, counter-clockwise: a conveyor belt, for other bodies [m/s].
    #[serde(default)]
    pub surface_speed: f64,
    /// Whether a fluid with a kinematic viscosity slips along it; along a soft body it does.
    #[serde(default)]
    pub slip: Slip,
    /// Collision layers the body is in, 0 to 31.
    #[serde(default = "first_layer")]
    pub layers: Vec<u8>,
    /// Collision layers it collides with; left out, all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u8>>,
    /// Collision group: bodies of the same group above 0 always collide, below 0 never, whatever their layers; 0 is none.
    #[serde(default)]
    pub collision_group: i32,
    /// Whether it is a sensor: it reports what it touches and pushes nothing. It must not be dynamic.
    #[serde(default)]
    pub sensor: bool,
    /// A number of your own, handed back with the body.
    #[serde(default)]
    pub user_data: u64,
    /// Whether it turns.
    #[serde(default)]
    pub rotation: RotationRule,
    /// Factor on gravity.
    #[serde(default = "one")]
    pub gravity_factor: f64,
    /// Rate at which the velocity decays, as by a resistance of linear_damping x mass [1/s].
    #[serde(default)]
    pub linear_damping: f64,
    /// Rate at which the angular velocity decays [1/s].
    #[serde(default)]
    pub angular_damping: f64,
    /// Script of a kinematic body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionDescription>,
    /// More of the same body, in rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Copies>,
}

/// How a dynamic body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BodySolver {
    /// A place and an angle: exact contacts, stacks that stand.
    #[default]
    Pose,
    /// Every lattice sample is a particle, drawn back to the shape (Macklin et al. 2014): soft where its
    /// compliance is above 0. Its contacts are those of particles, with normals of the signed distance.
    ShapeMatching,
}

/// Whether a body turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RotationRule {
    /// It turns freely.
    #[default]
    Free,
    /// It keeps its angle.
    Locked,
}

/// More of the same body, in rows; `name` gets a number behind it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Copies {
    /// Bodies in a row.
    pub columns: u32,
    /// Rows.
    #[serde(default = "one_row")]
    pub rows: u32,
    /// From one body of a row to the next, and from one row to the next \[m].
    pub step: [f64; 2],
    /// Shape of the heap.
    #[serde(default)]
    pub heap: Heap,
}

/// Shape of a heap of bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Heap {
    /// All rows alike.
    #[default]
    Grid,
    /// Every second row half a step aside.
    Brick,
    /// Each row one shorter than the last, and centred on it.
    Pyramid,
}

fn dynamic() -> BodyKind {
    BodyKind::Dynamic
}

fn water_density() -> f64 {
    1000.0
}

fn tenth() -> f64 {
    0.1
}

fn friction() -> f64 {
    FRICTION
}

fn one() -> f64 {
    1.0
}

fn one_row() -> u32 {
    1
}

fn first_layer() -> Vec<u8> {
    vec![0]
}
