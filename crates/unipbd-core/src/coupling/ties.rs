//! Ends of ropes on bodies.

use std::ops::Range;

use super::{Carried, RigidBodies, Tied};
use crate::math::{Vector64, direction, wide};
use crate::particles::Particles;
use crate::rigid::contact::{DistanceRule, Joint, JointKind};
use crate::rows::RowIndex;
use crate::scene::Rope;

impl RigidBodies {
    /// From now on a particle moves with the body of this name, from a place in the world \[m].
    pub(super) fn tie(&mut self, id: u32, body: &str, at: Vector64) {
        let Some(body) = self.bodies.find(body) else { return };
        let pose = self.bodies.pose(body);
        let place = direction(-pose.angle).rotate(at - pose.position);
        self.tied.push(Tied { id, body, place });
    }

    /// These particles no longer move with a body.
    pub(super) fn untie(&mut self, ids: Range<u32>) {
        self.tied.retain(|tied| !ids.contains(&tied.id));
    }

    /// Adds the distance joint that keeps bodies at the ends of a rope within the rope's length of its other end: another
    /// body, or the point that is held or carried there. `ends` are the ids of its first and last point.
    pub(super) fn join_rope(&mut self, rope: &Rope, ends: [u32; 2], spacing: f64) -> Option<u32> {
        let find = |name: &Option<String>| name.as_ref().and_then(|name| self.bodies.find(name));
        let (first, last) = (find(&rope.from_body), find(&rope.body));
        let (from, to) = (Vector64::from(rope.from), Vector64::from(rope.to));
        let (body, at) = last.map(|body| (body, to)).or(first.map(|body| (body, from)))?;
        let other = first.filter(|_| last.is_some());
        let (opposite, carrier) = if last.is_some() { (from, ends[0]) } else { (to, ends[1]) };
        let bodies = &self.bodies;
        let compliance = rope.compliance * rope.pieces(spacing);
        let length = rope.full_length();
        let kind = JointKind::Distance { length, compliance, damping: 0.0, rule: DistanceRule::AtMost };
        let other_anchor = other.map_or(opposite, |id| bodies.pose(id).apply_inverse(opposite));
        let joint = Joint { body, other, anchor: bodies.pose(body).apply_inverse(at), other_anchor, kind };
        let index = self.contacts.add_joint(joint, true) as u32;
        if other.is_none() {
            self.carried.push(Carried { joint: index, id: carrier });
        }
        Some(index)
    }

    /// Takes the joint of a rope away.
    pub(super) fn part_rope(&mut self, joint: u32) {
        self.carried.retain(|carried| carried.joint != joint);
        self.contacts.end_joint(joint as usize, &mut self.bodies);
    }

    /// Takes the anchors of joints to the particles that carry them, which are predicted for the substep.
    pub(crate) fn carry_anchors(&mut self, particles: &Particles, rows: &RowIndex) {
        for carried in &self.carried {
            let held = rows.row(carried.id).map(|row| row as usize).filter(|&row| particles.inverse_mass[row] == 0.0);
            let way = held.map(|row| {
                let start = wide(particles.start[row]);
                (start, wide(particles.position[row]) - start)
            });
            self.contacts.carry(carried.joint as usize, way, &mut self.bodies);
        }
    }
}
