//! Prediction, the taking up of corrections, and velocities from displacements.
//!
//! A substep works on the displacement u since its start, not on the difference of two positions:
//! x = x_n + (u + rem), and what rounding keeps out of x is carried in rem. In f32 this stays accurate
//! out to 10^5 spacings from the origin, where x - x_n would lose gravity altogether.

use crate::constraints::Corrections;
use crate::math::{Real, Vector};
use crate::neighbors::Periodic;
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::phase::Phase;
use crate::walls::Walls;

/// Acceleration of a material by body forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyForce {
    /// Acceleration [m/s^2].
    pub acceleration: Vector,
    /// Whether it is multiplied by the particle's temperature (Boussinesq buoyancy).
    pub thermal: bool,
}

/// u = dt v + dt^2 a, x = x_n + u, for every row that has inertia; rows moved by a script keep their velocity.
pub(super) fn predict(particles: &mut Particles, forces: &[BodyForce], dt: Real, parallelism: Parallelism) {
    let (materials, phases) = (&particles.material, &particles.phase);
    let (inverse_masses, temperatures) = (&particles.inverse_mass, &particles.temperature);
    let accelerations = &particles.acceleration;
    parallelism.update(&mut particles.velocity, |row, velocity| {
        if inverse_masses[row] == 0.0 {
            return;
        }
        let force = &forces[usize::from(materials[row])];
        let factor = if force.thermal { temperatures[row] } else { 1.0 };
        *velocity += force.acceleration * (factor * dt);
        if let Some(&acceleration) = accelerations.get(row) {
            *velocity += acceleration * dt;
        }
    });
    particles.start.copy_from_slice(&particles.position);
    let velocities = &particles.velocity;
    parallelism.update(&mut particles.displacement, |row, displacement| {
        if phases[row] != Phase::Smoke {
            *displacement = velocities[row] * dt;
        }
    });
    move_to_displacement(particles, parallelism);
}

/// x = x_n + (u + rem).
fn move_to_displacement(particles: &mut Particles, parallelism: Parallelism) {
    let (phases, starts) = (&particles.phase, &particles.start);
    let (displacements, remainders) = (&particles.displacement, &particles.remainder);
    parallelism.update(&mut particles.position, |row, position| {
        if phases[row] != Phase::Smoke {
            *position = starts[row] + (displacements[row] + remainders[row]);
        }
    });
}

/// Adds corrections to the displacements, keeps particles out of walls, moves positions along.
pub(super) fn apply(particles: &mut Particles, corrections: &Corrections, walls: &Walls, parallelism: Parallelism) {
    let steps = corrections.displacements();
    let (phases, starts) = (&particles.phase, &particles.start);
    let (inverse_masses, remainders) = (&particles.inverse_mass, &particles.remainder);
    parallelism.update(&mut particles.displacement, |row, displacement| {
        if phases[row] == Phase::Smoke || inverse_masses[row] == 0.0 {
            return;
        }
        *displacement += steps[row];
        let position = starts[row] + (*displacement + remainders[row]);
        for hit in walls.hits(position) {
            *displacement += out_of_wall(*displacement, hit.normal, hit.depth, hit.friction);
        }
    });
    move_to_displacement(particles, parallelism);
}

/// The way out of a wall, with Coulomb friction on the tangential part of the displacement.
#[inline]
fn out_of_wall(displacement: Vector, normal: Vector, depth: Real, friction: Real) -> Vector {
    let tangential = displacement - normal * displacement.dot(normal);
    let length = tangential.length();
    if friction == 0.0 || length == 0.0 {
        return normal * depth;
    }
    normal * depth - tangential * (friction * depth / length).min(1.0)
}

/// v = u/dt, and the new remainders; positions on a periodic axis return into the domain.
pub(super) fn update_velocities(particles: &mut Particles, dt: Real, periodic: Periodic, parallelism: Parallelism) {
    let inverse_dt = 1.0 / dt;
    let (phases, inverse_masses) = (&particles.phase, &particles.inverse_mass);
    let displacements = &particles.displacement;
    parallelism.update(&mut particles.velocity, |row, velocity| {
        if phases[row] != Phase::Smoke && inverse_masses[row] > 0.0 {
            *velocity = displacements[row] * inverse_dt;
        }
    });
    carry_remainders(particles, parallelism);
    wrap(particles, periodic, parallelism);
}

/// What rounding kept out of the positions.
pub(super) fn carry_remainders(particles: &mut Particles, parallelism: Parallelism) {
    let (phases, displacements) = (&particles.phase, &particles.displacement);
    let (starts, positions) = (&particles.start, &particles.position);
    parallelism.update(&mut particles.remainder, |row, remainder| {
        if phases[row] != Phase::Smoke {
            *remainder = (displacements[row] + *remainder) - (positions[row] - starts[row]);
        }
    });
}

/// Brings positions on periodic axes back into the domain.
pub(super) fn wrap(particles: &mut Particles, periodic: Periodic, parallelism: Parallelism) {
    if periodic.any() {
        parallelism.update(&mut particles.position, |_, position| *position = periodic.wrap(*position));
    }
}

/// A substep without motion: what moves from here on is the projection's doing.
pub(super) fn hold(particles: &mut Particles) {
    particles.start.copy_from_slice(&particles.position);
    for (displacement, phase) in particles.displacement.iter_mut().zip(&particles.phase) {
        if *phase != Phase::Smoke {
            *displacement = Vector::ZERO;
        }
    }
}
