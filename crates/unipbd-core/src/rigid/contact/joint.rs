//! Joints between two bodies, or a body and the world: hinges with motors, and distances.
//!
//! Equality constraints J u = 0 in the same split-Jacobi sweep as the contacts. Impulses act at the
//! anchors at the start of a substep, and stop the motion of the anchors at its middle. As in leapfrog
//! schemes (SHAKE, Ryckaert et al. 1977), this conserves the energy of a rotating body on a hinge. The remaining drift
//! is removed from the positions alone. A distance with compliance is a spring, solved as in Macklin et al. 2016.

use super::bounds::NONE;
use super::manifold::entry;
use crate::math::Vector64;
use crate::rigid::{InverseMass, Pose, Twist};

/// The constraint of a joint.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum JointKind {
    /// The anchors coincide; the bodies may rotate.
    Hinge {
        /// Optional motor for the relative angular velocity.
        motor: Option<Motor>,
    },
    /// The distance of the anchors is constant.
    Distance {
        /// Rest distance [m].
        length: f64,
        /// Inverse stiffness [m/N]; 0 is rigid.
        compliance: f64,
        /// Rod or rope.
        rule: DistanceRule,
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

/// The motor of a hinge.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Motor {
    /// Target angular velocity of the first body relative to the second [rad/s].
    pub speed: f64,
    /// Maximum torque [N m].
    pub max_torque: f64,
}

/// A joint; anchors are in body coordinates (from the centre of mass), or world coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Joint {
    /// First body.
    pub body: u32,
    /// Second body; `None` is the world.
    pub other: Option<u32>,
    /// Anchor on the first body [m].
    pub anchor: Vector64,
    /// Anchor on the second body, or in the world [m].
    pub other_anchor: Vector64,
    /// The constraint.
    pub kind: JointKind,
}

/// A joint with its state in the solver.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Linked {
    pub joint: Joint,
    /// Impulse on the first body: a vector for a hinge, or the component along the line in x [kg m].
    pub impulse: Vector64,
    /// Impulse of the motor [kg m^2].
    pub motor: f64,
    /// Arms of the anchors at the start of the substep (point of application of impulses) and at its middle.
    arms: (Vector64, Vector64),
    middle: (Vector64, Vector64),
    /// Position of the first body's anchor relative to the second body's anchor, at the start of the substep [m].
    offset: Vector64,
    split: (InverseMass, InverseMass),
    dt: f64,
}

impl Linked {
    pub fn new(joint: Joint) -> Linked {
        let (impulse, offset, arms) = (Vector64::ZERO, Vector64::ZERO, Default::default());
        Linked { joint, impulse, motor: 0.0, arms, middle: arms, offset, split: Default::default(), dt: 0.0 }
    }

    /// Whether the impulses that last from substep to substep are finite.
    pub fn is_finite(&self) -> bool {
        self.impulse.is_finite() && self.motor.is_finite()
    }

    pub fn bodies(&self) -> (u32, u32) {
        (self.joint.body, self.joint.other.unwrap_or(NONE))
    }

    /// Computes anchors and arms at these poses of the bodies.
    fn place(&mut self, a: Pose, b: Pose) {
        let arm = |pose: Pose, anchor: Vector64| Vector64::from_angle(pose.angle).rotate(anchor);
        self.arms = (arm(a, self.joint.anchor), arm(b, self.joint.other_anchor));
        self.middle = self.arms;
        self.offset = (a.position + self.arms.0) - (b.position + self.arms.1);
    }

    /// Prepares a substep: the arms at its start, and at its middle with the bodies rotated by half of `displacements`.
    pub fn prepare(&mut self, poses: &[Pose], displacements: &[Twist], split: &[InverseMass], dt: f64, scale: f64) {
        let (a, b) = self.bodies();
        let (of_a, of_b) = (entry(poses, a), entry(poses, b));
        self.place(of_a, of_b);
        let half = |pose: Pose, body: u32| pose.angle + 0.5 * entry(displacements, body).angular;
        let turned = |angle: f64, anchor: Vector64| Vector64::from_angle(angle).rotate(anchor);
        self.middle = (turned(half(of_a, a), self.joint.anchor), turned(half(of_b, b), self.joint.other_anchor));
        (self.split, self.dt) = ((entry(split, a), entry(split, b)), dt);
        self.impulse *= scale;
        self.motor *= scale;
    }

    /// The pushes of the impulses of the last substep, or of this one so far.
    pub fn kept_pushes(&self) -> (Twist, Twist) {
        self.pushes(self.force(), self.motor)
    }

    fn direction(&self) -> Vector64 {
        self.offset.try_normalize().unwrap_or(Vector64::Y)
    }

    fn pushes(&self, vector: Vector64, moment: f64) -> (Twist, Twist) {
        let on = |arm: Vector64| Twist { linear: vector, angular: arm.perp_dot(vector) + moment };
        (on(self.arms.0), on(self.arms.1))
    }

    fn relative(&self, motion: &[Twist]) -> Vector64 {
        let (a, b) = self.bodies();
        entry(motion, a).at(self.middle.0) - entry(motion, b).at(self.middle.1)
    }

    /// One iteration from the given displacements: pushes to add to the first body and to subtract from the second.
    pub fn solve(&mut self, displacements: &[Twist]) -> (Twist, Twist) {
        match self.joint.kind {
            JointKind::Hinge { motor } => {
                let added = -self.solve_point(self.relative(displacements));
                self.impulse += added;
                let moment = motor.map_or(0.0, |motor| self.drive(motor, displacements));
                self.pushes(added, moment)
            }
            JointKind::Distance { length, compliance, rule } => {
                let stretch = self.offset.length() - length;
                let softness = compliance / (self.dt * self.dt);
                let bias = match rule {
                    DistanceRule::AtMost => stretch.min(0.0) + if softness > 0.0 { stretch.max(0.0) } else { 0.0 },
                    DistanceRule::Exact => {
                        if softness > 0.0 {
                            stretch
                        } else {
                            0.0
                        }
                    }
                };
                let along = self.direction();
                let excess = self.relative(displacements).dot(along) + bias + softness * self.impulse.x;
                let mut total = self.impulse.x - excess / (self.weight(along) + softness);
                if rule == DistanceRule::AtMost {
                    total = total.min(0.0);
                }
                let added = total - self.impulse.x;
                self.impulse.x = total;
                self.pushes(along * added, 0.0)
            }
        }
    }

    fn drive(&mut self, motor: Motor, displacements: &[Twist]) -> f64 {
        let (a, b) = self.bodies();
        let turn = entry(displacements, a).angular - entry(displacements, b).angular;
        let weight = self.split.0.angular + self.split.1.angular;
        let limit = motor.max_torque * self.dt * self.dt;
        let wanted = if weight > 0.0 { (motor.speed * self.dt - turn) / weight } else { 0.0 };
        let total = (self.motor + wanted).clamp(-limit, limit);
        total - std::mem::replace(&mut self.motor, total)
    }

    /// The impulse that would move the anchors apart by `apart` (2 x 2 system of the split masses).
    fn solve_point(&self, apart: Vector64) -> Vector64 {
        let (a, b) = self.split;
        let response = |unit: Vector64| {
            let moved = |arm: Vector64, middle: Vector64| middle.perp() * arm.perp_dot(unit);
            let turned = moved(self.arms.0, self.middle.0) * a.angular + moved(self.arms.1, self.middle.1) * b.angular;
            unit * (a.linear + b.linear) + turned
        };
        let (x, y) = (response(Vector64::X), response(Vector64::Y));
        let determinant = x.perp_dot(y);
        if determinant <= 0.0 {
            return Vector64::ZERO;
        }
        Vector64::new(apart.perp_dot(y), x.perp_dot(apart)) / determinant
    }

    fn weight(&self, along: Vector64) -> f64 {
        let (a, b) = self.split;
        let moment = |arm: Vector64, middle: Vector64| arm.perp_dot(along) * middle.perp_dot(along);
        let (at_a, at_b) = (moment(self.arms.0, self.middle.0), moment(self.arms.1, self.middle.1));
        (a.linear + b.linear + at_a * a.angular + at_b * b.angular).max(f64::MIN_POSITIVE)
    }

    /// Position-only pushes that remove half of the drift. The poses have moved by `displacements`, and move on
    /// to `motion`.
    pub fn separate(&mut self, poses: &[Pose], displacements: &[Twist], motion: &[Twist]) -> (Twist, Twist) {
        let (a, b) = self.bodies();
        let pose = |id: u32| {
            let (pose, was, is) = (entry(poses, id), entry(displacements, id), entry(motion, id));
            let angle = pose.angle + is.angular - was.angular;
            Pose { position: pose.position + is.linear - was.linear, angle }
        };
        self.place(pose(a), pose(b));
        match self.joint.kind {
            JointKind::Hinge { .. } => self.pushes(-self.solve_point(self.offset * 0.5), 0.0),
            JointKind::Distance { length, compliance, rule } => {
                let stretch = self.offset.length() - length;
                if compliance > 0.0 || (rule == DistanceRule::AtMost && stretch < 0.0) {
                    return (Twist::ZERO, Twist::ZERO);
                }
                let along = self.direction();
                self.pushes(along * (-0.5 * stretch / self.weight(along)), 0.0)
            }
        }
    }
}

impl Linked {
    /// Whether a motor wants it to turn.
    pub fn is_driven(&self) -> bool {
        matches!(self.joint.kind, JointKind::Hinge { motor: Some(motor) } if motor.speed != 0.0 && motor.max_torque > 0.0)
    }

    /// The impulse on the first body as a vector [kg m].
    pub fn force(&self) -> Vector64 {
        match self.joint.kind {
            JointKind::Hinge { .. } => self.impulse,
            JointKind::Distance { .. } => self.direction() * self.impulse.x,
        }
    }
}
