//! The state of a run as one number.

use crate::math::{Real, Vector};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::rigid::Body;
use crate::rng::mix;
use crate::step::Solver;

impl Solver {
    /// Hash of the state: id, material, position, remainder, velocity, mass, temperature, age and sleep of every
    /// particle, pose and velocity of every body, and the number of substeps done. Independent of the order of rows, so
    /// the same on any number of threads; two states with the same hash continue identically.
    pub fn state_hash(&self) -> u64 {
        let particles = self.particles();
        let sum = Parallelism::Serial.reduce(
            particles.len(),
            |rows| rows.map(|row| particle_hash(particles, row)).fold(0, u64::wrapping_add),
            u64::wrapping_add,
        );
        let bodies = self.bodies().iter().fold(0, |hash: u64, body| mix(hash.rotate_left(7) ^ body_hash(body)));
        mix(sum ^ mix(self.step()) ^ bodies)
    }
}

fn body_hash(body: &Body) -> u64 {
    let pose = [body.position.x, body.position.y, body.angle];
    let velocity = [body.velocity.x, body.velocity.y, body.angular_velocity];
    let words = pose.into_iter().chain(velocity).map(f64::to_bits).chain([u64::from(body.asleep)]);
    words.fold(0, |hash, word| mix(hash.rotate_left(7) ^ word))
}

fn particle_hash(particles: &Particles, row: usize) -> u64 {
    let mut hash = mix(u64::from(particles.id[row]) ^ (u64::from(particles.material[row]) << 32));
    let mut add = |word: u64| hash = mix(hash.rotate_left(7) ^ word);
    for vector in [particles.position[row], particles.remainder[row], particles.velocity[row]] {
        bits(vector).into_iter().for_each(&mut add);
    }
    add(real_bits(particles.inverse_mass[row]));
    for column in [&particles.temperature, &particles.age] {
        if let Some(&value) = column.get(row) {
            add(real_bits(value));
        }
    }
    if let (Some(&anchor), Some(&rest)) = (particles.anchor.get(row), particles.rest.get(row)) {
        bits(anchor).into_iter().for_each(&mut add);
        add(real_bits(rest));
        add(u64::from((particles.awake()..particles.dense()).contains(&row)));
    }
    hash
}

fn bits(vector: Vector) -> [u64; 2] {
    [real_bits(vector.x), real_bits(vector.y)]
}

#[allow(clippy::unnecessary_cast)]
fn real_bits(value: Real) -> u64 {
    value.to_bits() as u64
}
