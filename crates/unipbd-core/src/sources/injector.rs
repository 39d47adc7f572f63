//! Injectors: particles at random places of a region.

use crate::math::{Real, Vector, Vector64, real, vector, wide};
use crate::neighbors::Neighbors;
use crate::particles::{NewParticle, Particles};
use crate::phase::{MaterialIndex, Phase};
use crate::rng::Rng;
use crate::scene::{Injector, Region, Scene};

/// Fluid is added only if no particle centre lies within this many spacings.
const ROOM: f64 = 0.9;
/// Stream of random places, one per injector.
const INJECTOR_STREAM: u64 = 5 << 32;

/// Integers up to a count that grows with time. The end of one substep and the start of the next
/// differ only by rounding: they must give the same number.
pub(super) fn due_until(count: f64) -> u64 {
    (count + 1e-6).floor() as u64
}

/// An injector of a scene. It has no state: the release time of a particle follows from the time, and
/// its position from its number and the seed.
pub(super) struct RegionInjector {
    region: Region,
    rate: f64,
    start: f64,
    stop: f64,
    capacity: usize,
    velocity: Vector,
    temperature: Real,
    material: MaterialIndex,
    phase: Phase,
    inverse_mass: Real,
    room: Real,
    seed: u64,
    stream: u64,
}

impl RegionInjector {
    /// `None` if the material is unknown, which `Scene::validate` refuses.
    pub fn new(injector: &Injector, scene: &Scene, seed: u64, number: usize) -> Option<Self> {
        let (index, material) = scene.material(&injector.material)?;
        let mass = material.particle_mass(scene.spacing);
        Some(RegionInjector {
            region: injector.region.clone(),
            rate: injector.rate,
            start: injector.start,
            stop: injector.stop.unwrap_or(f64::INFINITY),
            capacity: injector.capacity.map_or(usize::MAX, |capacity| capacity as usize),
            velocity: vector(injector.velocity.into()),
            temperature: real(injector.temperature),
            material: index as MaterialIndex,
            phase: material.phase(),
            inverse_mass: if material.phase().is_passive() { 0.0 } else { real(1.0 / mass) },
            room: real(ROOM * scene.spacing),
            seed,
            stream: INJECTOR_STREAM + ((number as u64) << 33),
        })
    }

    /// Numbers of the particles that are due between two times.
    fn due(&self, time: f64, dt: f64) -> std::ops::Range<u64> {
        let until = |time: f64| due_until((time.min(self.stop) - self.start).max(0.0) * self.rate);
        until(time)..until(time + dt)
    }

    /// Whether any is due.
    pub fn will_change(&self, time: f64, dt: f64) -> bool {
        !self.due(time, dt).is_empty()
    }

    /// Adds the particles that are due.
    pub fn advance(&self, time: f64, dt: f64, particles: &mut Particles, neighbors: &Neighbors) {
        let due = self.due(time, dt);
        if due.is_empty() {
            return;
        }
        let mut count = particles.materials().iter().filter(|&&material| material == self.material).count();
        let mut added: Vec<Vector> = Vec::new();
        for number in due {
            let position = vector(self.place(number));
            if count >= self.capacity || !self.has_room(position, &added, particles, neighbors) {
                continue;
            }
            particles.push(NewParticle {
                position: wide(position),
                velocity: self.velocity,
                inverse_mass: self.inverse_mass,
                material: self.material,
                phase: self.phase,
                temperature: self.temperature,
            });
            added.push(position);
            count += 1;
        }
    }

    /// A random point of the region.
    fn place(&self, number: u64) -> Vector64 {
        let mut rng = Rng::new(self.seed, self.stream + number);
        let [min, max] = self.region.bounds().map(Vector64::from);
        loop {
            let point = min + (max - min) * Vector64::new(rng.unit(), rng.unit());
            if self.region.contains(point.into()) {
                return point;
            }
        }
    }

    fn has_room(&self, position: Vector, added: &[Vector], particles: &Particles, neighbors: &Neighbors) -> bool {
        if self.phase.is_passive() {
            return true;
        }
        let near = |other: Vector| neighbors.periodic().min_image(other - position).length() < self.room;
        let mut free = !added.iter().any(|&other| near(other));
        if neighbors.is_current() {
            // Rows that were just added are not in the grid yet; they are in `added` or far away.
            neighbors.for_each_near(position, self.room, |row| free &= !near(particles.positions()[row]));
        } else {
            // Rows were removed before this substep: the rows in the grid are no longer valid.
            free &= !particles.positions()[..particles.dense()].iter().any(|&other| near(other));
        }
        free
    }
}
