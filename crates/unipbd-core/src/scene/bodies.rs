use serde::{Deserialize, Serialize};

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Moved by forces and contacts.
    Dynamic,
    /// Moved by a script, whatever pushes it.
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
    /// Part of its deformation that a body with `solver = "shape_matching"` takes back in a 60th of a second, 0 to 1:
    /// 1 is rigid.
    #[serde(default = "one")]
    pub stiffness: f64,
    /// Part of its wobble that such a body loses in a 60th of a second, 0 to 1.
    #[serde(default = "tenth")]
    pub damping: f64,
    /// Radius of a disc [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Width and height of a box [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
    /// Corners of a polygon, convex or not, seen from `position` [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Vec<[f64; 2]>>,
    /// Where the origin of the outline starts (the centre of a disc or box) [m].
    pub position: [f64; 2],
    /// Rotation at the start, counter-clockwise [degrees].
    #[serde(default)]
    pub angle_deg: f64,
    /// Velocity of the centre of mass at the start [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Angular velocity at the start, counter-clockwise [degrees/s].
    #[serde(default)]
    pub spin_deg: f64,
    /// Mass per area [kg/m^2].
    #[serde(default = "water_density")]
    pub density: f64,
    /// Mass, instead of the density [kg].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Coulomb friction coefficient, 0.5 by default; walls have 0. Two surfaces have the root of the product of theirs,
    /// the larger restitution, the larger rolling friction.
    #[serde(default = "half")]
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
    /// Collision layers the body is in, 0 to 31.
    #[serde(default = "first_layer")]
    pub layers: Vec<u8>,
    /// Collision layers it collides with; left out, all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u8>>,
    /// Whether it turns.
    #[serde(default)]
    pub rotation: RotationRule,
    /// Factor on gravity.
    #[serde(default = "one")]
    pub gravity_factor: f64,
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
    /// stiffness is below 1. Its contacts are those of particles, with normals of the signed distance.
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

/// Script of a kinematic body: the given motions add up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MotionDescription {
    /// Constant velocity [m/s].
    pub velocity: [f64; 2],
    /// Constant angular velocity, counter-clockwise [degrees/s].
    pub spin_deg: f64,
    /// Largest displacement of an oscillation [m].
    pub amplitude: [f64; 2],
    /// Largest rotation of an oscillation [degrees].
    pub swing_deg: f64,
    /// Frequency of the oscillation [1/s].
    pub frequency: f64,
    /// Phase of the oscillation at time 0 [degrees].
    pub phase_deg: f64,
    /// Stations of a path by increasing time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<Station>,
    /// Begins the path anew after its last station.
    pub repeat_path: bool,
}

/// A station of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// When [s].
    pub time: f64,
    /// Displacement from the start [m].
    #[serde(default)]
    pub offset: [f64; 2],
    /// Rotation from the start [degrees].
    #[serde(default)]
    pub turn_deg: f64,
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
    /// From one body of a row to the next, and from one row to the next [m].
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

/// A joint between two bodies, or a body and the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// Hinge, rod or rope.
    pub kind: JointRule,
    /// Name of the first body.
    pub body: String,
    /// Name of the second body; left out, the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other: Option<String>,
    /// Anchor on the first body, where the scene starts [m].
    pub at: [f64; 2],
    /// Anchor on the second body or in the world, where the scene starts; left out, `at` [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other_at: Option<[f64; 2]>,
    /// Length of a rod or rope; left out, the distance of its anchors [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Inverse stiffness of a rod or rope, 0 is rigid [m/N].
    #[serde(default)]
    pub compliance: f64,
    /// Angular velocity that the motor of a hinge wants [degrees/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor_speed_deg: Option<f64>,
    /// Largest torque of the motor [N m].
    #[serde(default = "boundless")]
    pub motor_torque: f64,
    /// Whether the two bodies collide with each other; left out, those at a rope do, and others do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collide_connected: Option<bool>,
}

impl JointDescription {
    /// A joint between a body and the world at a point [m].
    pub fn new(kind: JointRule, body: &str, at: [f64; 2]) -> Self {
        JointDescription {
            kind,
            body: body.to_owned(),
            other: None,
            at,
            other_at: None,
            length: None,
            compliance: 0.0,
            motor_speed_deg: None,
            motor_torque: boundless(),
            collide_connected: None,
        }
    }

    /// Whether the two bodies collide with each other.
    pub fn collide_connected(&self) -> bool {
        self.collide_connected.unwrap_or(self.kind == JointRule::Rope)
    }
}

/// What a joint keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum JointRule {
    /// The anchors coincide.
    Hinge,
    /// The anchors keep their distance.
    Rod,
    /// The anchors never come farther apart than the length.
    Rope,
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

fn half() -> f64 {
    0.5
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

fn boundless() -> f64 {
    1e30
}
