//! The momentum of a fluid that touches nothing fixed: pressure does not change it.

use crate::math::{Real, Vector, Vector64, wide};
use crate::parallel::Parallelism;
use crate::particles::{Particles, displaced};

/// Momentum and mass of the fluid.
pub(super) fn momentum(particles: &Particles, parallelism: Parallelism) -> (Vector64, f64) {
    let (velocities, inverse_masses) = (&particles.velocity, &particles.inverse_mass);
    let add = |(sum, mass): (Vector64, f64), (more, of_more): (Vector64, f64)| (sum + more, mass + of_more);
    let of_row = |row: usize| {
        let mass = if inverse_masses[row] > 0.0 { 1.0 / f64::from(inverse_masses[row]) } else { 0.0 };
        (wide(velocities[row]) * mass, mass)
    };
    let none = (Vector64::ZERO, 0.0);
    parallelism.reduce(particles.awake(), |rows| rows.map(of_row).fold(none, add), add)
}

/// Takes this velocity from all fluid.
pub(super) fn slow_down(particles: &mut Particles, by: Vector, dt: Real, parallelism: Parallelism) {
    let (inverse_masses, starts, remainders) = (&particles.inverse_mass, &particles.start, &particles.remainder);
    let rows = particles.awake();
    let (velocities, displacements) = (&mut particles.velocity[..rows], &mut particles.displacement[..rows]);
    parallelism.chunks3(velocities, displacements, &mut particles.position[..rows], |first, velocity, u, x| {
        for k in (0..velocity.len()).filter(|k| inverse_masses[first + k] > 0.0) {
            velocity[k] -= by;
            u[k] = velocity[k] * dt;
            x[k] = displaced(starts[first + k], u[k], remainders[first + k]);
        }
    });
}
