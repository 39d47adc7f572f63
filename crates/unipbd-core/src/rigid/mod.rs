//! Rigid bodies: poses, masses, prescribed motions, static walls, and the solver of their contacts and joints.

mod body_set;
mod change;
pub mod contact;
mod derived;
mod describe;
mod mobility;
mod motion;
mod query;
mod saved;
mod specification;
mod wall;

pub use crate::scene::BodyKind;
pub use body_set::Bodies;
pub use change::BodyChange;
pub use contact::{ContactEvent, ContactPair, ContactPoint, JointState};
#[doc(hidden)]
pub use derived::InverseMass;
pub(crate) use describe::{joint, specification, strength, waypoints};
pub(crate) use mobility::{HeldRow, Mobilities, Mobility};
pub(crate) use motion::along_curve;
pub use motion::{Motion, Repeat, Waypoint};
pub(crate) use query::{Outline, rectangle as box_outline};
pub use specification::{BodySpec, CollisionFilter, Damping, Elasticity, MassSpec, Rotation, Surface};
pub use wall::{Boundary, Wall};

use crate::math::{Vector64, direction};

/// Place and orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pose {
    /// Place \[m].
    pub position: Vector64,
    /// Rotation, counter-clockwise \[rad].
    pub angle: f64,
}

impl Pose {
    /// Body coordinates to world coordinates.
    pub fn apply(&self, point: Vector64) -> Vector64 {
        self.position + direction(self.angle).rotate(point)
    }

    /// World coordinates to body coordinates.
    pub fn apply_inverse(&self, point: Vector64) -> Vector64 {
        direction(-self.angle).rotate(point - self.position)
    }
}

/// A linear and an angular part: a velocity, a displacement, or an impulse with its moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Twist {
    /// Linear part, of the centre of mass.
    pub linear: Vector64,
    /// Angular part, counter-clockwise.
    pub angular: f64,
}

impl Twist {
    /// No motion.
    pub const ZERO: Twist = Twist { linear: Vector64::ZERO, angular: 0.0 };

    /// The linear part at a point with this arm from the centre of mass.
    pub fn at(&self, arm: Vector64) -> Vector64 {
        self.linear + arm.perp() * self.angular
    }

    /// The same motion, referred to the point at this arm.
    pub(crate) fn moved_to(&self, arm: Vector64) -> Twist {
        Twist { linear: self.at(arm), angular: self.angular }
    }

    /// All parts times a factor.
    pub fn scaled(&self, factor: f64) -> Twist {
        Twist { linear: self.linear * factor, angular: self.angular * factor }
    }
}

impl std::ops::AddAssign for Twist {
    fn add_assign(&mut self, other: Twist) {
        self.linear += other.linear;
        self.angular += other.angular;
    }
}

impl std::ops::SubAssign for Twist {
    fn sub_assign(&mut self, other: Twist) {
        self.linear -= other.linear;
        self.angular -= other.angular;
    }
}

/// Readable state of a rigid body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Body {
    /// Name given in the scene.
    pub name: String,
    /// Type of motion.
    pub kind: BodyKind,
    /// Centre of mass \[m].
    pub position: Vector64,
    /// Rotation, counter-clockwise \[rad].
    pub angle: f64,
    /// Velocity of the centre of mass [m/s].
    pub velocity: Vector64,
    /// Angular velocity, counter-clockwise [rad/s].
    pub angular_velocity: f64,
    /// Mass \[kg].
    pub mass: f64,
    /// Moment of inertia about the centre of mass [kg m^2].
    pub inertia: f64,
    /// Outline in body coordinates, counter-clockwise \[m]; a disc has none.
    pub outline: Vec<Vector64>,
    /// Radius of a disc, 0 for a polygon \[m].
    pub radius: f64,
    /// Lattice samples in body coordinates \[m].
    pub samples: Vec<Vector64>,
    /// Area per sample [m^2].
    pub sample_area: f64,
    /// Friction and restitution.
    pub surface: Surface,
    /// Collision filter.
    pub filter: CollisionFilter,
    /// Whether it reports what it touches and pushes nothing.
    pub sensor: bool,
    /// A number of the caller's own.
    pub user_data: u64,
    /// Factor on gravity.
    pub gravity_factor: f64,
    /// Whether it was taken away: its number is not given to another.
    pub removed: bool,
    /// Whether it is asleep: held still until it is woken.
    pub asleep: bool,
    /// Force of the fluid over the last frame, mean \[N].
    pub fluid_force: Vector64,
    /// Torque of the fluid about the centre of mass over the last frame, mean [N m].
    pub fluid_torque: f64,
    /// Force of contacts and joints over the last frame, mean \[N].
    pub contact_force: Vector64,
    /// Torque of contacts and joints about the centre of mass over the last frame, mean [N m].
    pub contact_torque: f64,
}

impl Default for Body {
    fn default() -> Self {
        Body {
            name: String::new(),
            kind: BodyKind::Static,
            position: Vector64::ZERO,
            angle: 0.0,
            velocity: Vector64::ZERO,
            angular_velocity: 0.0,
            mass: 0.0,
            inertia: 0.0,
            outline: Vec::new(),
            radius: 0.0,
            samples: Vec::new(),
            sample_area: 0.0,
            surface: Surface::default(),
            filter: CollisionFilter::default(),
            sensor: false,
            user_data: 0,
            gravity_factor: 1.0,
            removed: false,
            asleep: false,
            fluid_force: Vector64::ZERO,
            fluid_torque: 0.0,
            contact_force: Vector64::ZERO,
            contact_torque: 0.0,
        }
    }
}
