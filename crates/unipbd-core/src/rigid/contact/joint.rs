//! Joints between two bodies, or a body and the world, as they are described and read.

use crate::math::Vector64;

/// Part of the torque of a motor beyond which it may be too weak to hold its speed.
const WITH_STRENGTH: f64 = 0.9;

/// The constraint of a joint.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum JointKind {
    /// The anchors coincide; the bodies may rotate.
    Hinge {
        /// Optional motor for the relative angular velocity.
        motor: Option<Motor>,
        /// Range of the angle of the first body minus that of the second \[rad].
        limits: Option<Limits>,
    },
    /// The distance of the anchors is constant.
    Distance {
        /// Rest distance \[m].
        length: f64,
        /// Inverse stiffness [m/N]; 0 is rigid.
        compliance: f64,
        /// Force per speed at which the anchors part, beside the stiffness [N s/m]; without compliance it has no effect.
        damping: f64,
        /// Rod or rope.
        rule: DistanceRule,
    },
    /// The anchors coincide, and the bodies keep their angle.
    Weld {
        /// Angle of the first body minus that of the second \[rad].
        angle: f64,
    },
    /// The first anchor stays on a line through the second, and the bodies keep their angle.
    Slider {
        /// Direction of the line, of length 1, in the coordinates of the second body, or of the world.
        axis: Vector64,
        /// Angle of the first body minus that of the second \[rad].
        angle: f64,
        /// Optional motor along the line, for the speed of the first anchor away from the second [m/s], \[N].
        motor: Option<Motor>,
        /// Range of the place on the line \[m].
        limits: Option<Limits>,
    },
    /// A rope over two fixed wheels without mass: distance of the first anchor from the first wheel plus `ratio` times
    /// that of the second anchor from the second never exceeds a length.
    Pulley {
        /// Places of the wheels in the world \[m].
        wheels: [Vector64; 2],
        /// Length of the rope beside the stretch between the wheels \[m].
        length: f64,
        /// Purchase: what the second side counts for.
        ratio: f64,
    },
}

/// Lower limit of a distance joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum DistanceRule {
    /// A rod: fixed distance.
    Exact,
    /// A rope: maximum distance.
    AtMost,
}

/// The motor of a hinge or a slider.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Motor {
    /// Target velocity of the first body relative to the second [rad/s], [m/s].
    pub speed: f64,
    /// Maximum torque [N m], or force \[N].
    pub max_torque: f64,
}

impl Motor {
    /// Whether it holds its speed with this impulse over a substep, and has some strength left.
    pub(super) fn holds(&self, impulse: f64, dt: f64) -> bool {
        impulse.abs() < WITH_STRENGTH * self.max_torque * dt * dt
    }

    /// Whether its numbers are sound.
    pub(super) fn is_sound(&self) -> bool {
        self.speed.is_finite() && self.max_torque >= 0.0
    }
}

/// A range.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
}

/// A joint; anchors are in body coordinates (from the centre of mass), or world coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Joint {
    /// First body.
    pub body: u32,
    /// Second body; `None` is the world.
    pub other: Option<u32>,
    /// Anchor on the first body \[m].
    pub anchor: Vector64,
    /// Anchor on the second body, or in the world \[m].
    pub other_anchor: Vector64,
    /// The constraint.
    pub kind: JointKind,
}

impl Joint {
    /// The motor, if it has one.
    pub fn motor(&self) -> Option<Motor> {
        match self.kind {
            JointKind::Hinge { motor, .. } | JointKind::Slider { motor, .. } => motor,
            _ => None,
        }
    }
}

/// Loads from which on a joint breaks: means over a frame.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Strength {
    /// Largest force \[N].
    pub force: f64,
    /// Largest torque about the anchor [N m].
    pub torque: f64,
}

impl Strength {
    /// It never breaks.
    pub const BOUNDLESS: Strength = Strength { force: f64::INFINITY, torque: f64::INFINITY };
}

/// Readable state of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// Name given in the scene; empty without one.
    pub name: String,
    /// The joint itself.
    pub joint: Joint,
    /// Force on the first body at its anchor over the last frame, mean \[N].
    pub force: Vector64,
    /// Torque on the first body about its anchor over the last frame, mean [N m].
    pub torque: f64,
    /// Whether its load has broken it.
    pub broken: bool,
    /// Whether it was taken away.
    pub removed: bool,
}
