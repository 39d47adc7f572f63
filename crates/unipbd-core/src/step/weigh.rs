//! The start of liquids that rest: their weight compresses them before time 0, so that their pressure is there in the
//! first frame. Else they would first fall, and swing about their rest.
//!
//! Substeps of the first frame are run with damped velocities until the liquid stands still. The same compression found in
//! another way, as by the momentum method of settling, is that of another arrangement: it swings by a tenth of the weight.

use super::integrate;
use super::level::{Resting, Start, resting};
use super::substeps::Choice;
use super::world::World;
use crate::math::{Real, Vector, larger, wide};
use crate::particles::displaced;
use crate::phase::Phase;
use std::f64::consts::PI;

/// A liquid stands still once what carries it differs from its weight by this part, and damping takes no more.
const STILL: f64 = 0.01;
/// For this many substeps: a liquid that swings, or is noisy, looks still in one.
const CALM: u32 = 10;
/// Substeps for each layer of a liquid: the least, in which its slowest wave dies, and the most, ...
const LEAST_PER_LAYER: f64 = 1.0;
const MOST_PER_LAYER: f64 = 4.0;
/// ...and those that are added: gaps beside bodies fill slowly, in shallow liquids too.
const MOST_BESIDE: f64 = 200.0;
/// Compression at the bottom up to which a liquid starts with its weight: beyond it the substeps are too few to carry it.
const COMPRESSION: f64 = 0.15;
/// Strain of a liquid over that of the law, which is of the worst particle, not of the mean.
const STRAIN: f64 = 0.8;
/// Least part of a velocity that is kept in a substep.
const LEAST_KEPT: f64 = 0.5;

impl World {
    /// The liquids of the start that rest under their weight.
    pub(super) fn resting(&mut self) -> Resting {
        if self.is_endless_along_gravity() {
            return Resting::default();
        }
        self.find_neighbors_if_listed();
        let parts = &self.parts;
        let now = World::now(parts, &self.rows, &self.clock);
        let Some(density) = parts.groups.iter().find_map(|group| group.as_density()) else { return Resting::default() };
        let errors = density.measure_density(now);
        let (forces, gravity, spacing) = (&parts.forces, parts.gravity, parts.spacing as Real);
        let found = resting(&Start { now, errors: &errors, forces, gravity, spacing });
        let dt = self.first_substep();
        let compression = self.fall_in(dt) * self.strain() * f64::from(found.depth());
        if compression > COMPRESSION { Resting::default() } else { found }
    }

    /// Whether nothing can rest: without gravity, and where the domain repeats along it.
    fn is_endless_along_gravity(&self) -> bool {
        let (gravity, periodic) = (self.parts.gravity, self.parts.neighbors.periodic());
        let falls_for_ever = (periodic.x.is_some() && gravity.x != 0.0) || (periodic.y.is_some() && gravity.y != 0.0);
        falls_for_ever || gravity == Vector::ZERO
    }

    /// Length of a substep of the first frame \[s].
    fn first_substep(&mut self) -> f64 {
        let events = self.events.len();
        let substeps = self.choose_substeps();
        // The first frame chooses again, and reports its warnings itself.
        self.events.truncate(events);
        self.choice = Choice::default();
        self.parts.frame_time / f64::from(substeps)
    }

    /// Growth of the way of a fall in a substep \[m].
    fn fall_in(&self, dt: f64) -> f64 {
        f64::from(self.parts.gravity.length()) * dt * dt
    }

    /// Way of sound in a substep \[spacings].
    fn sound(&self) -> f64 {
        self.parts.substeps.sound()
    }

    /// Compression by the weight of a layer, over its thickness and the fall in a substep [1/m^2].
    fn strain(&self) -> f64 {
        let way = self.parts.spacing * self.sound();
        1.0 / (way * way)
    }

    /// Compresses liquids that rest by their weight, in `most` substeps at most.
    pub(super) fn settle_under_weight(&mut self, resting: &Resting, most: Option<u32>) {
        self.clock.dt = self.first_substep();
        let (layers, fall) = (f64::from(resting.depth()) / self.parts.spacing, self.fall_in(self.clock.dt));
        // The critical damping of the slowest wave, of which a quarter is as long as the liquid is deep.
        let kept = (1.0 - PI * self.sound() / layers).max(LEAST_KEPT);
        let least = (LEAST_PER_LAYER * layers) as u32;
        let most = most.unwrap_or((MOST_BESIDE + MOST_PER_LAYER * layers) as u32);
        self.lower(resting, STRAIN * fall * self.strain());
        let (mut before, mut calm) = (0.0_f64, 0);
        for substep in 1..=most {
            let way = self.damped_substep(resting, kept) / fall;
            let (uncarried, damped) = (way - kept * before, (1.0 - kept) * way);
            before = way;
            calm = if damped.abs().max(uncarried.abs()) <= STILL { calm + 1 } else { 0 };
            if substep > least && calm >= CALM {
                break;
            }
        }
        self.stop(resting);
    }

    /// Lowers pools as their weight does: they are strained by this much per way of depth [1/m].
    fn lower(&mut self, resting: &Resting, strain: f64) {
        let (particles, down) = (&mut self.parts.particles, self.parts.gravity.normalize_or_zero());
        let (ids, dense) = (&particles.id, particles.dense());
        self.parts.parallelism.update(&mut particles.position[..dense], |row, position| {
            if let Some([bottom, top]) = resting.pool(ids[row]) {
                let height = larger(-position.dot(down) - bottom, 0.0);
                *position += down * (strain as Real * height * (top - bottom - 0.5 * height));
            }
        });
    }

    /// Runs a substep of what rests, keeps this part of its velocities, and returns its mean way along gravity \[m].
    fn damped_substep(&mut self, resting: &Resting, kept: f64) -> f64 {
        self.let_fall(resting);
        self.find_neighbors_if_listed();
        self.project_start();
        self.parts.rigid.iter_mut().for_each(|rigid| rigid.bodies.hold());
        let (particles, parallelism) = (&mut self.parts.particles, self.parts.parallelism);
        let (ids, displacement, dense) = (&particles.id, &particles.displacement, particles.dense());
        let part = (kept / self.clock.dt) as Real;
        parallelism.update(&mut particles.velocity[..dense], |row, velocity| {
            if resting.has(ids[row]) {
                *velocity = displacement[row] * part;
            }
        });
        integrate::carry_remainders(particles, parallelism);
        integrate::wrap(particles, self.parts.neighbors.periodic(), parallelism);
        let down = wide(self.parts.gravity.normalize_or_zero());
        let way = |row: usize| match resting.has(particles.id[row]) {
            true => wide(particles.displacement[row]).dot(down),
            false => 0.0,
        };
        parallelism.sum(dense, way) / resting.rests as f64
    }

    /// Predicts what rests as a substep does; nothing else moves.
    fn let_fall(&mut self, resting: &Resting) {
        let (parts, dt) = (&mut self.parts, self.clock.dt as Real);
        let (particles, forces, parallelism) = (&mut parts.particles, &parts.forces, parts.parallelism);
        let (ids, material, dense) = (&particles.id, &particles.material, particles.dense());
        let rests = |row: usize| row < dense && resting.has(ids[row]);
        parallelism.update(&mut particles.velocity, |row, velocity| {
            if rests(row) {
                *velocity += forces[usize::from(material[row])].acceleration * dt;
            }
        });
        let (velocity, phase) = (&particles.velocity, &particles.phase);
        parallelism.update(&mut particles.displacement, |row, displacement| {
            if phase[row] != Phase::Smoke {
                *displacement = if rests(row) { velocity[row] * dt } else { Vector::ZERO };
            }
        });
        particles.start.copy_from_slice(&particles.position);
        let (displacement, remainder) = (&particles.displacement, &particles.remainder);
        parallelism.update(&mut particles.position, |row, position| {
            if rests(row) {
                *position = displaced(*position, displacement[row], remainder[row]);
            }
        });
    }

    fn stop(&mut self, resting: &Resting) {
        let particles = &mut self.parts.particles;
        for row in 0..particles.dense() {
            if resting.has(particles.id[row]) {
                particles.velocity[row] = Vector::ZERO;
            }
        }
    }
}
