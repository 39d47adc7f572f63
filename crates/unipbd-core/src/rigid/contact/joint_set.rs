//! The joints of a run: added, changed, carried, broken and taken away.

use super::Contacts;
use super::joint::{Joint, JointKind, JointState, Strength};
use super::linked::{Linked, Status};
use crate::math::Vector64;
use crate::rigid::{Bodies, HeldRow};

/// Rows of a joint at most: three of a weld, or those of a hinge or slider with the one of its motor and limits.
const MOST_ROWS: usize = 4;

impl Contacts {
    /// Adds a joint and returns its index. Without `collide`, the bodies it links no longer collide with each other.
    pub fn add_joint(&mut self, joint: Joint, collide: bool) -> usize {
        let mut linked = Linked::new(joint);
        linked.collide = collide;
        self.joints.push(linked);
        self.exclude_joined();
        self.joints.len() - 1
    }

    /// Names a joint, and sets the loads that break it.
    pub(crate) fn describe_joint(&mut self, index: usize, name: &str, strength: Strength) {
        let linked = &mut self.joints[index];
        (linked.name, linked.strength) = (name.to_owned(), strength);
    }

    /// Changes the constraint of a joint, such as the speed of its motor.
    pub fn set_joint(&mut self, index: usize, kind: JointKind, bodies: &mut Bodies) {
        self.joints[index].joint.kind = kind;
        self.disturb(index, bodies);
    }

    /// Takes a joint away; its index stays its own.
    pub(crate) fn remove_joint(&mut self, index: usize, bodies: &mut Bodies) {
        self.disturb(index, bodies);
        self.joints[index].end(Status::Removed);
        self.exclude_joined();
    }

    /// The same, of a joint that may be over.
    pub(crate) fn end_joint(&mut self, index: usize, bodies: &mut Bodies) {
        if !self.joints[index].is_over() {
            self.remove_joint(index, bodies);
        }
    }

    /// Takes away the joints of a body.
    pub(crate) fn remove_joints_of(&mut self, body: u32, bodies: &mut Bodies) {
        let of_body = |linked: &Linked| linked.joint.body == body || linked.joint.other == Some(body);
        for index in (0..self.joints.len()).filter(|&index| of_body(&self.joints[index])).collect::<Vec<_>>() {
            self.remove_joint(index, bodies);
        }
    }

    fn disturb(&mut self, index: usize, bodies: &mut Bodies) {
        let joint = self.joints[index].joint;
        for body in std::iter::once(joint.body).chain(joint.other) {
            bodies.pushed[body as usize] = true;
        }
    }

    /// Where the anchor of a joint in the world is at the start of a substep, and its way in it \[m]; `None` where
    /// nothing holds it: then the joint does not act.
    pub(crate) fn carry(&mut self, index: usize, held: Option<(Vector64, Vector64)>, bodies: &mut Bodies) {
        let linked = &mut self.joints[index];
        match (linked.status, held) {
            (Status::Live | Status::Loose, Some((place, way))) => {
                let moves = way != Vector64::ZERO || place != linked.joint.other_anchor;
                (linked.status, linked.joint.other_anchor, linked.carried) = (Status::Live, place, way);
                if moves {
                    self.disturb(index, bodies);
                }
            }
            (Status::Live, None) => {
                linked.end(Status::Loose);
                self.disturb(index, bodies);
            }
            _ => {}
        }
    }

    /// Ends a frame: mean loads, and joints that they break.
    pub(super) fn finish_joints(&mut self, frame_time: f64) {
        self.broke.clear();
        for (linked, index) in self.joints.iter_mut().zip(0..) {
            if linked.finish_frame(frame_time) {
                self.broke.push(index);
            }
        }
        if !self.broke.is_empty() {
            self.exclude_joined();
        }
    }

    /// Joints that broke in the last frame, by index.
    pub(crate) fn broke(&self) -> &[u32] {
        &self.broke
    }

    fn exclude_joined(&mut self) {
        self.narrow_phase.exclude_only(apart(&self.joints));
    }

    /// Number of joints, those that are over included.
    pub(crate) fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// The joints that act, with the force on the first body \[N] and the torque about its anchor [N m] in the last
    /// substep.
    pub fn joint_loads(&self) -> impl Iterator<Item = (Joint, Vector64, f64)> + '_ {
        let square = self.dt * self.dt;
        let live = self.joints.iter().filter(|linked| linked.is_live());
        live.map(move |linked| (linked.joint, linked.force() / square, linked.moment() / square))
    }

    /// The rows in which joints hold bodies in this substep: call it when they were prepared.
    pub(crate) fn joint_rows(&self) -> impl Iterator<Item = HeldRow> + '_ {
        self.joints.iter().flat_map(|linked| {
            let (a, b) = linked.bodies();
            let (mut rows, mut count) = ([None; MOST_ROWS], 0);
            linked.each_held(|row, softness| {
                let on = |body: u32, sign: f64, along: Vector64, moment: f64| {
                    (body, [along.x, along.y, moment].map(|part| sign * part))
                };
                let sides = [on(a, 1.0, row.along.0, row.apply.0), on(b, -1.0, row.along.1, row.apply.1)];
                rows[count] = Some(HeldRow { sides, softness });
                count += 1;
            });
            rows.into_iter().flatten()
        })
    }

    /// All joints, those that are broken or taken away too, by index.
    pub fn joints(&self) -> impl Iterator<Item = JointState> + '_ {
        self.joints.iter().map(|linked| JointState {
            name: linked.name.clone(),
            joint: linked.joint,
            force: linked.means.force,
            torque: linked.means.torque,
            broken: linked.status == Status::Broken,
            removed: linked.status == Status::Removed,
        })
    }
}

/// The pairs of bodies that joints keep from colliding.
pub(super) fn apart(joints: &[Linked]) -> Vec<(u32, u32)> {
    let apart = joints.iter().filter(|linked| !linked.collide && linked.is_live());
    apart.filter_map(|linked| Some((linked.joint.body, linked.joint.other?))).collect()
}
