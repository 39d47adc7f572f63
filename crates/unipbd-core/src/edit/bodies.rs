//! Application of changes of bodies, joints and gravity that passed their checks.

use super::world::WorldChange;
use crate::math::{Vector, real};
use crate::rigid::contact::{JointKind, Motor};
use crate::rigid::{Pose, joint, specification, strength};
use crate::rows::RowIndex;
use crate::scene::{BodyDescription, JointDescription};
use crate::step::Solver;

/// Effects of the changes of an edit on their surroundings.
#[derive(Default)]
pub(super) struct Felt {
    /// Places where something came or went.
    pub places: Vec<Vector>,
    /// Samples of bodies that are gone, by id.
    samples: Vec<u32>,
    bodies_changed: bool,
    plan_changed: bool,
}

impl Solver {
    /// Makes the changes in their order; the rows of gone samples are removed last.
    pub(super) fn change_world(&mut self, changes: &[WorldChange]) -> Felt {
        let mut felt = Felt::default();
        changes.iter().for_each(|change| self.change_one(change, &mut felt));
        let mut rows = RowIndex::default();
        rows.rebuild(self.ids());
        let mut gone: Vec<u32> = felt.samples.iter().filter_map(|&id| rows.row(id)).collect();
        gone.sort_unstable();
        self.world.parts.particles.remove_rows(&gone);
        if felt.bodies_changed {
            rows.rebuild(self.ids());
            let parts = &mut self.world.parts;
            if let Some(rigid) = &mut parts.rigid {
                rigid.changed(&mut parts.particles, &rows);
            }
        }
        if felt.bodies_changed || felt.plan_changed {
            self.world.replan();
        }
        felt
    }

    fn change_one(&mut self, change: &WorldChange, felt: &mut Felt) {
        match change {
            WorldChange::Gravity(gravity) => self.world.set_gravity(*gravity),
            WorldChange::AddBody(body) => self.add_bodies(body, felt),
            WorldChange::AddJoint(joint) => self.add_joint(joint),
            WorldChange::AddEmitter(_) | WorldChange::ChangeEmitter { .. } | WorldChange::RemoveEmitter(_) => {
                felt.places.extend(self.change_emitters(change));
                felt.plan_changed = true;
            }
            WorldChange::AddRope(_) | WorldChange::CutRope { .. } | WorldChange::RemoveRope(_) => {
                let (places, gone) = self.change_ropes(change);
                felt.places.extend(places);
                felt.samples.extend(gone);
                // Joints of ropes may have come or gone.
                felt.bodies_changed = true;
            }
            _ => self.change_known(change, felt),
        }
    }

    /// Changes of bodies and joints that exist.
    fn change_known(&mut self, change: &WorldChange, felt: &mut Felt) {
        let mut rows = RowIndex::default();
        rows.rebuild(self.ids());
        let (time, parts) = (self.world.clock.time, &mut self.world.parts);
        let Some(rigid) = &mut parts.rigid else { return };
        match *change {
            WorldChange::RemoveBody(body) => {
                felt.places.extend(rigid.places_of(body, &parts.particles, &rows));
                let (samples, loose) = rigid.remove_body(body);
                felt.samples.extend(samples);
                for row in loose.into_iter().filter_map(|id| rows.row(id)).map(|row| row as usize) {
                    let density = parts.materials[usize::from(parts.particles.material[row])].density;
                    parts.particles.inverse_mass[row] = real(1.0 / (density * parts.spacing * parts.spacing));
                }
            }
            WorldChange::MoveBody { body, position, angle } => {
                felt.places.extend(rigid.places_of(body, &parts.particles, &rows));
                rigid.place_body(body, Pose { position, angle }, time);
                rigid.settle_samples(&mut parts.particles, &rows);
                felt.places.extend(rigid.places_of(body, &parts.particles, &rows));
            }
            WorldChange::ChangeBody { body, ref change } => {
                felt.places.extend(rigid.places_of(body, &parts.particles, &rows));
                if change.shape.is_none() {
                    rigid.change_body(body, change, time);
                } else {
                    let material = parts.sample_material;
                    let old = rigid.reshape_body(body, change, time, &mut parts.particles, material);
                    felt.samples.extend(old);
                    let new = rigid.samples_of(body).len();
                    felt.places.extend_from_slice(&parts.particles.position[parts.particles.len() - new..]);
                }
            }
            WorldChange::Strike { body, impulse, point } => rigid.strike_body(body, impulse, point),
            WorldChange::RemoveJoint(joint) => rigid.contacts.remove_joint(joint as usize, &mut rigid.bodies),
            WorldChange::Motor { joint, motor } => {
                let known = rigid.contacts.joints().nth(joint as usize).map(|state| state.joint.kind);
                if let Some(kind) = known {
                    rigid.contacts.set_joint(joint as usize, with_motor(kind, motor), &mut rigid.bodies);
                }
            }
            _ => {}
        }
        felt.bodies_changed = true;
    }

    fn add_bodies(&mut self, description: &BodyDescription, felt: &mut Felt) {
        self.world.await_bodies();
        let (time, parts) = (self.world.clock.time, &mut self.world.parts);
        let rigid = parts.rigid.get_or_insert_with(|| parts.no_bodies.clone());
        let number = rigid.views().len();
        for (name, position) in description.instances(number) {
            let spec = specification(description, name, position);
            let first = parts.particles.len();
            rigid.add_body(spec, (time, parts.spacing), &mut parts.particles, parts.sample_material);
            felt.places.extend_from_slice(&parts.particles.position[first.min(parts.particles.len())..]);
        }
        felt.bodies_changed = true;
    }

    fn add_joint(&mut self, description: &JointDescription) {
        let Some(rigid) = &mut self.world.parts.rigid else { return };
        if let Some(joint) = joint(description, &rigid.bodies) {
            let index = rigid.contacts.add_joint(joint, description.collide_connected());
            rigid.contacts.describe_joint(index, &description.name, strength(description));
            for body in std::iter::once(joint.body).chain(joint.other) {
                rigid.contacts.wake(&mut rigid.bodies, body);
            }
        }
    }
}

fn with_motor(kind: JointKind, motor: Option<Motor>) -> JointKind {
    match kind {
        JointKind::Hinge { limits, .. } => JointKind::Hinge { motor, limits },
        JointKind::Slider { axis, angle, limits, .. } => JointKind::Slider { axis, angle, motor, limits },
        other => other,
    }
}
