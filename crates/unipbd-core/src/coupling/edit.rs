//! Bodies and joints that come, change and go between two frames.

use std::ops::Range;

use super::{RigidBodies, is_outlined, near};
use crate::math::{Vector, Vector64, vector};
use crate::particles::{NewParticle, Particles};
use crate::phase::{MaterialIndex, Phase};
use crate::rigid::{BodyChange, BodySpec, Pose};
use crate::rng::mix;
use crate::rows::RowIndex;

impl RigidBodies {
    /// Adds a body, and its samples to the particles where a fluid is to see them. A script begins where the body is put.
    pub(crate) fn add_body(
        &mut self,
        spec: BodySpec,
        (time, spacing): (f64, f64),
        particles: &mut Particles,
        material: Option<MaterialIndex>,
    ) {
        let Ok(body) = self.bodies.add(spec) else { return };
        self.bodies.rebase(body, time);
        let ids = self.add_samples(body, particles, material);
        self.sample_ids.push(ids);
        self.near.push(near(&self.bodies.views()[body as usize], self.seen, spacing));
        self.find_met();
    }

    /// Adds the samples of a body where a fluid is to see them; returns their ids, from the first to one past the last.
    fn add_samples(&self, body: u32, particles: &mut Particles, material: Option<MaterialIndex>) -> (u32, u32) {
        let first = particles.ids_given();
        let outlined = self.outlines && is_outlined(&self.bodies.views()[body as usize], self.spacing);
        if let Some(material) = material.filter(|_| self.seen && !outlined) {
            let pose = self.bodies.pose(body);
            for &sample in self.bodies.samples(body) {
                let place = pose.apply(sample);
                particles.push(NewParticle {
                    position: place,
                    velocity: vector(self.bodies.velocity_at(body, place)),
                    inverse_mass: 0.0,
                    material,
                    phase: Phase::Rigid,
                    temperature: 0.0,
                });
            }
        }
        (first, particles.ids_given())
    }

    /// Takes a body away with its joints; returns the ids of its samples, to be removed, and of the ends of ropes that
    /// were fixed to it.
    pub(crate) fn remove_body(&mut self, body: u32) -> (Vec<u32>, Vec<u32>) {
        self.contacts.wake_neighbors(&mut self.bodies, body);
        self.contacts.remove_joints_of(body, &mut self.bodies);
        let samples: Vec<u32> = self.samples_of(body).collect();
        let first = self.sample_ids[body as usize].0;
        self.sample_ids[body as usize] = (first, first);
        let loose = self.tied.iter().filter(|tied| tied.body == body).map(|tied| tied.id).collect();
        self.tied.retain(|tied| tied.body != body);
        self.bodies.remove(body);
        self.find_met();
        (samples, loose)
    }

    /// A number by which bodies and joints of a scene are told from those of another.
    pub(crate) fn mark(&self) -> u64 {
        let text = format!("{:?}", (self.bodies.specifications(), self.contacts.joints().collect::<Vec<_>>()));
        text.bytes().fold(0, |mark, byte| mix(mark.rotate_left(5) ^ u64::from(byte)))
    }

    /// Puts a body somewhere else; bodies that slept on it wake.
    pub(crate) fn place_body(&mut self, body: u32, pose: Pose, time: f64) {
        self.contacts.wake_neighbors(&mut self.bodies, body);
        self.bodies.place(body, pose, time);
    }

    /// Changes properties of a body; bodies that slept with it wake.
    pub(crate) fn change_body(&mut self, body: u32, change: &BodyChange, time: f64) {
        self.contacts.wake_neighbors(&mut self.bodies, body);
        self.bodies.change(body, change, time);
        self.find_met();
    }

    /// The same with another shape: adds the samples of the new one, and returns the ids of the old ones, to be removed.
    pub(crate) fn reshape_body(
        &mut self,
        body: u32,
        change: &BodyChange,
        time: f64,
        particles: &mut Particles,
        material: Option<MaterialIndex>,
    ) -> Range<u32> {
        // Contacts of the old outline end.
        self.contacts.wake_neighbors(&mut self.bodies, body);
        self.bodies.hollow(body);
        self.contacts.bodies_changed(&mut self.bodies);
        self.bodies.change(body, change, time);
        let old = self.samples_of(body);
        self.sample_ids[body as usize] = self.add_samples(body, particles, material);
        self.near[body as usize] = near(&self.bodies.views()[body as usize], self.seen, self.spacing);
        self.find_met();
        old
    }

    /// Pushes a body by an impulse [N s] at a point \[m].
    pub(crate) fn strike_body(&mut self, body: u32, impulse: Vector64, point: Vector64) {
        self.bodies.strike(body, impulse, point);
    }

    /// Bodies were added, changed, moved or taken away.
    pub(crate) fn changed(&mut self, particles: &mut Particles, rows: &RowIndex) {
        self.contacts.bodies_changed(&mut self.bodies);
        self.bodies.refresh_views();
        self.settle_samples(particles, rows);
    }

    /// Places of the samples of a body.
    pub(crate) fn places_of(&self, body: u32, particles: &Particles, rows: &RowIndex) -> Vec<Vector> {
        self.samples_of(body).filter_map(|id| rows.row(id)).map(|row| particles.position[row as usize]).collect()
    }
}
