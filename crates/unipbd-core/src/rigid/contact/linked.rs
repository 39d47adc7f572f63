//! Joints in the solver.
//!
//! Equality constraints J u = 0 in the same sweeps as the contacts. Impulses act at the
//! anchors at the start of a substep, and stop the motion of the anchors at its middle. As in leapfrog
//! schemes (SHAKE, Ryckaert et al. 1977), this conserves the energy of a rotating body on a hinge. The remaining drift
//! is removed from the positions alone. A distance with compliance is a spring, solved as in Macklin et al. 2016.
//! Hinges with limits, welds, sliders and pulleys are blocks of equations ([`super::block`]).

use super::block::Block;
use super::bounds::NONE;
use super::joint::{DistanceRule, Joint, JointKind, Motor, Strength};
use super::manifold::entry;
use super::rows::Row;
use crate::math::{Vector64, direction};
use crate::rigid::{InverseMass, Pose, Twist};

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
    /// Position of the first body's anchor relative to the second body's anchor, at the start of the substep \[m].
    offset: Vector64,
    split: (InverseMass, InverseMass),
    dt: f64,
    /// Equations of a kind that is solved as a block.
    block: Block,
    /// Way of an anchor in the world over the substep: a script carries it \[m].
    pub carried: Vector64,
    pub status: Status,
    pub strength: Strength,
    /// Sums of force and torque times time since the start of the frame, and their means over the last frame.
    pub sums: Load,
    pub means: Load,
    /// Name given in the scene.
    pub name: String,
    /// Whether the bodies it joins collide.
    pub collide: bool,
}

/// Whether a joint acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Status {
    /// It does.
    #[default]
    Live,
    /// It waits until its anchor in the world is held.
    Loose,
    /// Its load has broken it.
    Broken,
    /// It was taken away.
    Removed,
}

/// Force \[N] and torque [N m] on the first body at its anchor.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Load {
    pub force: Vector64,
    pub torque: f64,
}

impl Linked {
    pub fn new(joint: Joint) -> Linked {
        let (impulse, offset, arms) = (Vector64::ZERO, Vector64::ZERO, Default::default());
        Linked {
            joint,
            impulse,
            motor: 0.0,
            arms,
            middle: arms,
            offset,
            split: Default::default(),
            dt: 0.0,
            block: Block::default(),
            carried: Vector64::ZERO,
            status: Status::Live,
            strength: Strength::BOUNDLESS,
            sums: Load::default(),
            means: Load::default(),
            name: String::new(),
            collide: false,
        }
    }

    /// Whether it acts on its bodies.
    pub fn is_live(&self) -> bool {
        self.status == Status::Live
    }

    /// Whether it is broken or taken away.
    pub fn is_over(&self) -> bool {
        matches!(self.status, Status::Broken | Status::Removed)
    }

    /// Takes it out of the solver.
    pub fn end(&mut self, status: Status) {
        self.status = status;
        (self.impulse, self.motor) = (Vector64::ZERO, 0.0);
        self.block.clear();
    }

    /// Whether the impulses that last from substep to substep are finite.
    pub fn is_finite(&self) -> bool {
        let loads = [&self.sums, &self.means];
        let loaded = loads.into_iter().all(|load| load.force.is_finite() && load.torque.is_finite());
        self.impulse.is_finite()
            && self.motor.is_finite()
            && self.block.is_finite()
            && self.carried.is_finite()
            && loaded
            && self.strength.force >= 0.0
            && self.strength.torque >= 0.0
    }

    pub fn bodies(&self) -> (u32, u32) {
        (self.joint.body, self.joint.other.unwrap_or(NONE))
    }

    /// Computes anchors and arms at these poses of the bodies.
    fn place(&mut self, a: Pose, b: Pose) {
        let arm = |pose: Pose, anchor: Vector64| direction(pose.angle).rotate(anchor);
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
        let turned = |angle: f64, anchor: Vector64| direction(angle).rotate(anchor);
        self.middle = (turned(half(of_a, a), self.joint.anchor), turned(half(of_b, b), self.joint.other_anchor));
        (self.split, self.dt) = ((entry(split, a), entry(split, b)), dt);
        self.impulse *= scale;
        self.motor *= scale;
        let (poses, offset) = ((of_a, of_b), self.offset);
        self.block.prepare(&self.joint, poses, (self.arms, self.middle), offset, scale);
    }

    /// The pushes of the impulses of the last substep, or of this one so far.
    pub fn kept_pushes(&self) -> (Twist, Twist) {
        if self.block.is_used() { self.block.kept_pushes() } else { self.pushes(self.force(), self.motor) }
    }

    /// The pushes to start a substep with.
    pub fn start(&self) -> (Twist, Twist) {
        if self.is_live() { self.kept_pushes() } else { Default::default() }
    }

    /// Visits the rows in which it holds its bodies in this substep, with the softness of each: at most four.
    pub(super) fn each_held(&self, mut visit: impl FnMut(Row, f64)) {
        if !self.is_live() {
            return;
        }
        if self.block.is_used() {
            return self.block.each_held(&self.joint, self.dt, visit);
        }
        let point = |along: Vector64| Row::point(along, self.arms, self.arms);
        match self.joint.kind {
            JointKind::Hinge { motor, .. } => {
                visit(point(Vector64::X), 0.0);
                visit(point(Vector64::Y), 0.0);
                if motor.is_some_and(|motor| motor.holds(self.motor, self.dt)) {
                    visit(Row::turn(), 0.0);
                }
            }
            JointKind::Distance { compliance, damping, rule, .. }
                if rule == DistanceRule::Exact || self.impulse.x < 0.0 =>
            {
                visit(point(self.direction()), self.softness(compliance, damping).0);
            }
            _ => (),
        }
    }

    /// Way per impulse of a spring beside a damper, and the factor by which the damper holds up its way.
    fn softness(&self, compliance: f64, damping: f64) -> (f64, f64) {
        let damped = 1.0 + compliance * damping / self.dt;
        (compliance / (self.dt * self.dt) / damped, damped)
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
        entry(motion, a).at(self.middle.0) - entry(motion, b).at(self.middle.1) - self.carried
    }

    /// One iteration from the given displacements: pushes to add to the first body and to subtract from the second.
    pub fn solve(&mut self, displacements: &[Twist]) -> (Twist, Twist) {
        if !self.is_live() {
            return (Twist::ZERO, Twist::ZERO);
        }
        if self.block.is_used() {
            let (a, b) = self.bodies();
            let motion = (entry(displacements, a), entry(displacements, b));
            return self.block.solve(&self.joint, motion, &self.split, self.dt);
        }
        match self.joint.kind {
            JointKind::Hinge { motor, .. } => {
                let added = -self.solve_point(self.relative(displacements));
                self.impulse += added;
                let moment = motor.map_or(0.0, |motor| self.drive(motor, displacements));
                self.pushes(added, moment)
            }
            JointKind::Distance { length, compliance, damping, rule } => {
                self.solve_distance(length, (compliance, damping), rule, displacements)
            }
            _ => (Twist::ZERO, Twist::ZERO),
        }
    }

    /// Implicit Euler of a spring beside a damper, F = -C/alpha - beta v: the displacement u along the line satisfies
    /// u + (part of C) + softness lambda = 0 with softness = 1/(dt^2/alpha + beta dt).
    fn solve_distance(
        &mut self,
        length: f64,
        (compliance, damping): (f64, f64),
        rule: DistanceRule,
        displacements: &[Twist],
    ) -> (Twist, Twist) {
        let stretch = self.offset.length() - length;
        let (softness, damped) = self.softness(compliance, damping);
        let bias = match rule {
            DistanceRule::AtMost => stretch.min(0.0) + if softness > 0.0 { stretch.max(0.0) / damped } else { 0.0 },
            DistanceRule::Exact => {
                if softness > 0.0 {
                    stretch / damped
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
        if !self.is_live() {
            return (Twist::ZERO, Twist::ZERO);
        }
        let mut of_b = pose(b);
        of_b.position += self.carried;
        if self.block.is_used() {
            return self.block.separate(&self.joint, (pose(a), of_b), &self.split);
        }
        self.place(pose(a), of_b);
        match self.joint.kind {
            JointKind::Hinge { .. } => self.pushes(-self.solve_point(self.offset * 0.5), 0.0),
            JointKind::Distance { length, compliance, rule, .. } => {
                let stretch = self.offset.length() - length;
                if compliance > 0.0 || (rule == DistanceRule::AtMost && stretch < 0.0) {
                    return (Twist::ZERO, Twist::ZERO);
                }
                let along = self.direction();
                self.pushes(along * (-0.5 * stretch / self.weight(along)), 0.0)
            }
            _ => (Twist::ZERO, Twist::ZERO),
        }
    }
}

impl Linked {
    /// Whether a motor wants it to turn or slide.
    pub fn is_driven(&self) -> bool {
        self.is_live() && self.joint.motor().is_some_and(|motor| motor.speed != 0.0 && motor.max_torque > 0.0)
    }

    /// The impulse on the first body as a vector [kg m].
    pub fn force(&self) -> Vector64 {
        if self.block.is_used() {
            return self.block.kept_pushes().0.linear;
        }
        match self.joint.kind {
            JointKind::Distance { .. } => self.direction() * self.impulse.x,
            _ => self.impulse,
        }
    }

    /// The moment of the impulses on the first body about its anchor [kg m^2].
    pub fn moment(&self) -> f64 {
        if self.block.is_used() {
            let push = self.block.kept_pushes().0;
            return push.angular - self.arms.0.perp_dot(push.linear);
        }
        self.motor
    }

    /// Adds force and torque of the substep to the sums of the frame.
    pub fn load(&mut self) {
        if self.is_live() && self.dt > 0.0 {
            self.sums.force += self.force() / self.dt;
            self.sums.torque += self.moment() / self.dt;
        }
    }

    /// Ends a frame: mean loads; whether they have broken it just now.
    pub fn finish_frame(&mut self, frame_time: f64) -> bool {
        let sums = std::mem::take(&mut self.sums);
        self.means = Load { force: sums.force / frame_time, torque: sums.torque / frame_time };
        let torn = self.means.force.length() > self.strength.force || self.means.torque.abs() > self.strength.torque;
        if self.is_live() && torn {
            self.end(Status::Broken);
            return true;
        }
        false
    }
}
