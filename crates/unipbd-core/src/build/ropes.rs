//! Ropes: rows of points, and the constraints between them.

use crate::constraints::{Batch, ConstraintGroup, Distance, Tether};
use crate::math::{Vector64, real, vector};
use crate::particles::{NewParticle, Particles};
use crate::phase::MaterialIndex;
use crate::scene::{Link, Rope, Scene, Tethers};

/// The ropes of a scene.
#[derive(Default)]
pub(super) struct Ropes {
    tethers: Vec<Tether>,
    distances: Vec<Distance>,
    /// Ends that are fixed to bodies: id, name of the body, place.
    pub tied: Vec<(u32, String, Vector64)>,
    /// Ids of the first and last point of each rope.
    pub ends: Vec<[u32; 2]>,
}

impl Ropes {
    /// Adds the points of all ropes.
    pub fn lay(scene: &Scene, particles: &mut Particles) -> Ropes {
        let mut ropes = Ropes::default();
        scene.rope.iter().for_each(|rope| ropes.lay_one(rope, scene, particles));
        ropes
    }

    fn lay_one(&mut self, rope: &Rope, scene: &Scene, particles: &mut Particles) {
        let Some((index, material)) = scene.material(&rope.material) else { return };
        let pieces = rope.pieces(scene.spacing) as usize;
        let inverse_mass = real(1.0 / material.particle_mass(scene.spacing));
        let [from, to] = [rope.from, rope.to].map(Vector64::from);
        let held = [rope.held.first() || rope.from_body.is_some(), rope.held.last() || rope.body.is_some()];
        let mut point = |number: usize| {
            let fixed = number == 0 && held[0] || number == pieces && held[1];
            particles.push(NewParticle {
                position: from + (to - from) * (number as f64 / pieces as f64),
                velocity: vector(Vector64::ZERO),
                inverse_mass: if fixed { 0.0 } else { inverse_mass },
                material: index as MaterialIndex,
                phase: material.phase(),
                temperature: 0.0,
            })
        };
        let ids: Vec<u32> = (0..=pieces).map(&mut point).collect();
        self.tied.extend(rope.body.iter().map(|body| (ids[pieces], body.clone(), to)));
        self.tied.extend(rope.from_body.iter().map(|body| (ids[0], body.clone(), from)));
        self.ends.push([ids[0], ids[pieces]]);
        let piece = rope.full_length() / pieces as f64;
        let (length, compliance) = (real(piece), real(rope.compliance));
        for pair in ids.windows(2) {
            let particles = [pair[0], pair[1]];
            match rope.link {
                Link::Rope => self.tethers.push(Tether { particles, length, compliance }),
                Link::Rod => self.distances.push(Distance { particles, length, compliance }),
            }
        }
        if rope.tethers == Tethers::All {
            for end in [0, pieces].into_iter().filter(|&end| held[usize::from(end > 0)]) {
                for (number, &id) in ids.iter().enumerate().filter(|(number, _)| number.abs_diff(end) > 1) {
                    let count = number.abs_diff(end) as f64;
                    let (length, compliance) = (real(piece * count), real(rope.compliance * count));
                    self.tethers.push(Tether { particles: [ids[end], id], length, compliance });
                }
            }
        }
    }

    /// The constraints between the points.
    pub fn groups(self) -> Vec<Box<dyn ConstraintGroup>> {
        let mut groups: Vec<Box<dyn ConstraintGroup>> = Vec::new();
        if !self.distances.is_empty() {
            groups.push(Box::new(Batch::new(self.distances)));
        }
        if !self.tethers.is_empty() {
            groups.push(Box::new(Batch::new(self.tethers)));
        }
        groups
    }
}
