//! Bodies made of particles, drawn back to their shapes: their visible state follows their samples.

use super::RigidBodies;
use super::outlined::shape;
use crate::constraints::Member;
use crate::math::{Vector64, angle_of, direction, vector, wide};
use crate::particles::Particles;
use crate::rigid::{BodyKind, Pose, Twist};
use crate::rows::RowIndex;

/// Distance of the corners between which the outline of a soft body may bend \[spacings].
const PIECE: f64 = 2.0;

/// A body whose shape is matched.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Matched {
    body: u32,
    /// Outline at rest, finely divided \[m].
    outline: Vec<Vector64>,
    /// How far from a corner samples count for it \[m].
    reach: f64,
}

impl RigidBodies {
    pub(super) fn list_matched(&mut self, spacing: f64) {
        for (id, view) in self.bodies.views().iter().enumerate() {
            if self.bodies.elasticity(id).is_some() {
                let outline = divided(&view.outline, PIECE * spacing);
                self.matched.push(Matched { body: id as u32, outline, reach: 1.5 * spacing });
            }
        }
    }

    /// Whether the shape of any body is matched.
    pub(crate) fn any_matched(&self) -> bool {
        !self.matched.is_empty()
    }

    /// The bodies as particles, for the group that matches their shapes.
    pub(crate) fn members(&self) -> Vec<Member> {
        let member = |(id, view): (usize, &crate::rigid::Body)| {
            let shape = shape(view);
            let mass = if view.kind == BodyKind::Dynamic { view.mass } else { f64::INFINITY };
            let (first, elasticity) = (self.sample_ids[id].0, self.bodies.elasticity(id));
            Member::new(first, view.samples.clone(), &shape, mass, elasticity, view.surface, view.filter)
        };
        self.bodies.views().iter().enumerate().map(member).collect()
    }

    /// Brings pose, velocity and outline of bodies that are particles up to date.
    pub(crate) fn follow_particles(&mut self, particles: &Particles, rows: &RowIndex) {
        for matched in &self.matched {
            let id = matched.body as usize;
            let rest = &self.bodies.views()[id].samples;
            let found = self.samples_of(matched.body).filter_map(|id| rows.row(id));
            let found: Vec<usize> = found.map(|row| row as usize).collect();
            let places: Vec<Vector64> = found.iter().map(|&row| wide(particles.position[row])).collect();
            let count = places.len().max(1) as f64;
            let center = places.iter().sum::<Vector64>() / count;
            let linear = found.iter().map(|&row| wide(particles.velocity[row])).sum::<Vector64>() / count;
            let (mut turned, mut spin, mut inertia) = (Vector64::ZERO, 0.0, 0.0);
            for ((place, r), &row) in places.iter().zip(rest).zip(&found) {
                let arm = *place - center;
                turned += Vector64::new(r.dot(arm), r.perp_dot(arm));
                spin += arm.perp_dot(wide(particles.velocity[row]) - linear);
                inertia += arm.length_squared();
            }
            let pose = Pose { position: center, angle: angle_of(turned) };
            let angular = if inertia > 0.0 { spin / inertia } else { 0.0 };
            let soft = self.bodies.elasticity(id).is_some_and(|how| how.compliance > 0.0);
            let outline = soft.then(|| matched.deformed(&places, rest, pose));
            self.bodies.follow(id, pose, Twist { linear, angular }, outline);
        }
    }

    /// Gives the samples of bodies that are particles the velocities of their bodies.
    pub(crate) fn set_sample_velocities(&self, bodies: &[(u32, Twist)], particles: &mut Particles, rows: &RowIndex) {
        for &(body, velocity) in bodies.iter().filter(|(body, _)| self.bodies.elasticity(*body as usize).is_some()) {
            let center = self.bodies.pose(body).position;
            for row in self.samples_of(body).filter_map(|id| rows.row(id)).map(|row| row as usize) {
                particles.velocity[row] = vector(velocity.at(wide(particles.position[row]) - center));
            }
        }
    }
}

impl Matched {
    /// The outline moved as the samples near it were, in body coordinates.
    fn deformed(&self, places: &[Vector64], rest: &[Vector64], pose: Pose) -> Vec<Vector64> {
        let back = direction(-pose.angle);
        let moved = |corner: &Vector64| {
            let (mut sum, mut weights) = (Vector64::ZERO, 1e-12);
            for (place, r) in places.iter().zip(rest) {
                let weight = (1.0 - (*r - *corner).length_squared() / (self.reach * self.reach)).max(0.0);
                sum += (back.rotate(*place - pose.position) - *r) * weight;
                weights += weight;
            }
            *corner + sum / weights
        };
        self.outline.iter().map(moved).collect()
    }
}

/// The same outline with corners no farther apart than this.
fn divided(outline: &[Vector64], piece: f64) -> Vec<Vector64> {
    let mut divided = Vec::new();
    for (k, &from) in outline.iter().enumerate() {
        let to = outline[(k + 1) % outline.len()];
        let steps = ((to - from).length() / piece).ceil().max(1.0);
        divided.extend((0..steps as u64).map(|step| from.lerp(to, step as f64 / steps)));
    }
    divided
}
