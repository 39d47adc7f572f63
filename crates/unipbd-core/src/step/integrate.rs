//! Prediction, application of corrections, and velocities from displacements.
//!
//! A substep works on the displacement u since its start, not on the difference of two positions:
//! x = x_n + (u + rem); the rounding error of x is carried in rem. In f32 this stays accurate
//! out to 10^5 spacings from the origin, where x - x_n would lose gravity altogether.

use crate::constraints::Corrections;
use crate::math::{Real, Vector, Vector64, vector, wide};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::particles::{Particles, displaced};
use crate::periodic::Periodic;
use crate::phase::{Phase, uniform};
use crate::walls::{Hit, Walls};
use std::ops::Range;

/// Acceleration of a material by body forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyForce {
    /// Acceleration [m/s^2].
    pub acceleration: Vector,
    /// Factor on gravity.
    pub factor: f64,
    /// Whether it is multiplied by the particle's temperature (Boussinesq buoyancy).
    pub thermal: bool,
}

impl BodyForce {
    /// Gravity [m/s^2] times a factor.
    pub fn new(gravity: Vector64, factor: f64, thermal: bool) -> BodyForce {
        BodyForce { acceleration: vector(gravity * factor), factor, thermal }
    }

    /// Factor on it at a row: the temperature, or 1.
    pub(in crate::step) fn factor_at(&self, row: usize, temperatures: &[Real]) -> Real {
        if self.thermal { temperatures[row] } else { 1.0 }
    }
}

/// Gives sleeping rows the velocity of a fall over the substep, as those awake have it: on a grid they press so.
pub(super) fn let_sleepers_fall(particles: &mut Particles, forces: &[BodyForce], dt: Real) {
    for row in particles.awake()..particles.dense() {
        if particles.inverse_mass[row] > 0.0 {
            particles.velocity[row] = forces[usize::from(particles.material[row])].acceleration * dt;
        }
    }
}

/// Takes it from them again.
pub(super) fn stop_sleepers(particles: &mut Particles) {
    let sleeping = particles.awake()..particles.dense();
    particles.velocity[sleeping].fill(Vector::ZERO);
}

/// u = dt v + dt^2 a, x = x_n + u, for every row that has inertia; kinematic rows keep their velocity.
pub(super) fn predict(particles: &mut Particles, forces: &[BodyForce], dt: Real, parallelism: Parallelism) {
    let bands = particles.bands();
    let (material, phase, inverse_mass) = (&particles.material, &particles.phase, &particles.inverse_mass);
    let (temperature, acceleration) = (&particles.temperature, &particles.acceleration);
    let remainder = &particles.remainder;
    let pull = |row: usize| {
        let force = &forces[usize::from(material[row])];
        let pull = force.acceleration * (force.factor_at(row, temperature) * dt);
        match acceleration.get(row) {
            Some(&acceleration) => pull + acceleration * dt,
            None => pull,
        }
    };
    // The acceleration of all rows of a chunk, if it is uniform.
    let common = |rows: Range<usize>| {
        let material = uniform(&material[rows.clone()])?;
        (acceleration.is_empty() && !forces[usize::from(material)].thermal).then(|| pull(rows.start))
    };
    for rows in bands {
        let band = rows.start;
        let (velocity, start) = (&mut particles.velocity[rows.clone()], &mut particles.start[rows.clone()]);
        let (displacement, position) = (&mut particles.displacement[rows.clone()], &mut particles.position[rows]);
        parallelism.chunks4(
            velocity,
            start,
            displacement,
            position,
            |first, velocity, start, displacement, position| {
                let first = band + first;
                let rows = first..first + velocity.len();
                start.copy_from_slice(position);
                let (phase, inverse_mass) = (&phase[rows.clone()], &inverse_mass[rows.clone()]);
                let plain = are_plain(phase, inverse_mass);
                match common(rows.clone()).filter(|_| plain) {
                    Some(pull) => velocity.iter_mut().for_each(|velocity| *velocity += pull),
                    None => accelerate(velocity, inverse_mass, |k| pull(first + k)),
                }
                let moving = Moving { phase, start, remainder: &remainder[rows], plain };
                moving.shift(displacement, position, |k, _| velocity[k] * dt);
            },
        );
    }
}

/// Whether no row is smoke or kinematic: then a loop over the rows needs no branch and uses full vectors of the
/// machine. There is no early return here, for the same reason.
#[inline(always)]
fn are_plain(phase: &[Phase], inverse_mass: &[Real]) -> bool {
    let smoke = phase.iter().fold(false, |any, &phase| any | (phase == Phase::Smoke));
    !inverse_mass.iter().fold(smoke, |any, &inverse_mass| any | (inverse_mass == 0.0))
}

/// Adds to the velocities of rows that have inertia.
#[inline(always)]
fn accelerate(velocity: &mut [Vector], inverse_mass: &[Real], pull: impl Fn(usize) -> Vector) {
    for (k, (velocity, &inverse_mass)) in velocity.iter_mut().zip(inverse_mass).enumerate() {
        if inverse_mass > 0.0 {
            *velocity += pull(k);
        }
    }
}

/// Rows whose displacements change.
struct Moving<'a> {
    phase: &'a [Phase],
    start: &'a [Vector],
    remainder: &'a [Vector],
    /// The result of [`are_plain`].
    plain: bool,
}

impl Moving<'_> {
    /// Sets the displacements and moves the positions of all rows except smoke.
    #[inline(always)]
    fn shift(&self, displacement: &mut [Vector], position: &mut [Vector], new: impl Fn(usize, Vector) -> Vector) {
        let rows = displacement.len();
        let (phase, start, remainder) = (&self.phase[..rows], &self.start[..rows], &self.remainder[..rows]);
        let position = &mut position[..rows];
        let mut shift = |k: usize| {
            displacement[k] = new(k, displacement[k]);
            position[k] = displaced(start[k], displacement[k], remainder[k]);
        };
        if self.plain {
            (0..rows).for_each(shift);
        } else {
            (0..rows).filter(|&k| phase[k] != Phase::Smoke).for_each(&mut shift);
        }
    }

    /// The position of a row with this displacement: x = x_n + (u + rem).
    fn place(&self, k: usize, displacement: Vector) -> Vector {
        displaced(self.start[k], displacement, self.remainder[k])
    }
}

/// Applies position-only moves: they go into the remainders, not into the displacements.
pub(super) fn shift(particles: &mut Particles, corrections: &Corrections, parallelism: Parallelism) {
    let shifts = corrections.shifts();
    for rows in particles.bands() {
        let shifts = shifts.get(rows.clone()).unwrap_or_default();
        parallelism.update(&mut particles.remainder[rows][..shifts.len()], |row, remainder| *remainder += shifts[row]);
    }
}

/// Adds corrections to the displacements, keeps particles out of walls, moves positions along.
pub(super) fn apply(particles: &mut Particles, corrections: &Corrections, walls: &Walls, parallelism: Parallelism) {
    let (steps, bands) = (corrections.displacements(), particles.bands());
    let (phase, start) = (&particles.phase, &particles.start);
    let (inverse_mass, remainder) = (&particles.inverse_mass, &particles.remainder);
    // A path longer than the thickness of a box may have passed through the box.
    let thinnest = walls.thinnest() * walls.thinnest();
    let boxes = thinnest.is_finite();
    let again = turns_out_again(corrections, walls);
    for rows in bands {
        let band = rows.start;
        let (displacement, position) = (&mut particles.displacement[rows.clone()], &mut particles.position[rows]);
        parallelism.chunks2(displacement, position, |first, displacement, position| {
            let rows = band + first..band + first + displacement.len();
            let (inverse_mass, steps) = (&inverse_mass[rows.clone()], &steps[rows.clone()]);
            let (start, remainder) = (&start[rows.clone()], &remainder[rows.clone()]);
            let plain = are_plain(&phase[rows.clone()], inverse_mass);
            let moving = Moving { phase: &phase[rows], start, remainder, plain };
            if plain {
                moving.shift(displacement, position, |k, displacement| displacement + steps[k]);
            } else {
                moving.shift(displacement, position, |k, displacement| match inverse_mass[k] {
                    0.0 => displacement,
                    _ => displacement + steps[k],
                });
            }
            if walls.is_empty() {
                return;
            }
            let mut distances = [0.0; CHUNK_ROWS];
            walls.distances(position, &mut distances[..position.len()]);
            for k in 0..position.len() {
                let meets = distances[k] < 0.0 || (boxes && displacement[k].length_squared() >= thinnest);
                if meets && inverse_mass[k] > 0.0 && moving.phase[k] != Phase::Smoke {
                    meet_walls(&mut displacement[k], (moving.start[k], position[k]), walls, again, |_, _| {});
                    position[k] = moving.place(k, displacement[k]);
                }
            }
        });
    }
}

/// Whether a particle that was pushed out of a wall may be in another wall. Friction stops a displacement, but not a
/// shift: in a corner it could let one wall undo the push of the other.
fn turns_out_again(corrections: &Corrections, walls: &Walls) -> bool {
    walls.are_crowded() || corrections.any_shifted()
}

/// The load of [`apply`] on the measured walls: minus the momentum change of the particles, times dt [kg m].
pub(super) fn load_walls(particles: &Particles, corrections: &mut Corrections, walls: &Walls) {
    let again = turns_out_again(corrections, walls);
    for row in particles.bands().into_iter().flatten() {
        let inverse_mass = particles.inverse_mass[row];
        if inverse_mass == 0.0 || particles.phase[row] == Phase::Smoke {
            continue;
        }
        let mut displacement = particles.displacement[row] + corrections.displacements()[row];
        let place = displaced(particles.start[row], displacement, particles.remainder[row]);
        meet_walls(&mut displacement, (particles.start[row], place), walls, again, |hit, push| {
            if let Some(wall) = hit.measured {
                corrections.wall_loads_mut()[usize::from(wall)] -= wide(push) / f64::from(inverse_mass);
            }
        });
    }
}

/// Turns a displacement from `start` to `place` out of all walls, and reports the push of each wall.
#[inline]
fn meet_walls(
    displacement: &mut Vector,
    (start, place): (Vector, Vector),
    walls: &Walls,
    again: bool,
    mut feel: impl FnMut(&Hit, Vector),
) {
    let (mut touches, before) = (false, *displacement);
    for hit in walls.hits(start, place) {
        let push = hit.normal * hit.depth;
        *displacement += push;
        feel(&hit, push);
        touches = true;
    }
    // Friction is applied after all walls: in a corner one wall must not undo the push of the other.
    if touches {
        for hit in walls.hits(start, place) {
            let held = held_back(*displacement, &hit);
            *displacement -= held;
            feel(&hit, -held);
        }
        if again {
            let place = place + (*displacement - before);
            walls.turn_out_again(start, place, |hit, push| {
                *displacement += push;
                feel(hit, push);
            });
        }
    }
}

/// The part of a displacement along a wall that Coulomb friction removes.
#[inline]
fn held_back(displacement: Vector, hit: &Hit) -> Vector {
    let tangential = displacement - hit.normal * displacement.dot(hit.normal);
    let length = tangential.length();
    if hit.friction == 0.0 || length == 0.0 {
        return Vector::ZERO;
    }
    tangential * (hit.friction * hit.depth / length).min(1.0)
}

/// v = u/dt, and the new remainders and ages; positions on a periodic axis return into the domain.
pub(super) fn update_velocities(particles: &mut Particles, dt: Real, periodic: Periodic, parallelism: Parallelism) {
    let (inverse_dt, bands) = (1.0 / dt, particles.bands());
    let (phase, inverse_mass) = (&particles.phase, &particles.inverse_mass);
    let (displacement, start, position) = (&particles.displacement, &particles.start, &particles.position);
    for rows in bands {
        let band = rows.start;
        let (velocity, remainder) = (&mut particles.velocity[rows.clone()], &mut particles.remainder[rows]);
        parallelism.chunks2(velocity, remainder, |first, velocity, remainder| {
            let rows = band + first..band + first + velocity.len();
            let (phase, inverse_mass) = (&phase[rows.clone()], &inverse_mass[rows.clone()]);
            let (displacement, start) = (&displacement[rows.clone()], &start[rows.clone()]);
            let (position, remainder) = (&position[rows], &mut remainder[..velocity.len()]);
            if are_plain(phase, inverse_mass) {
                for k in 0..velocity.len() {
                    velocity[k] = displacement[k] * inverse_dt;
                    remainder[k] = left_over(displacement[k], remainder[k], position[k] - start[k]);
                }
                return;
            }
            for k in (0..velocity.len()).filter(|&k| phase[k] != Phase::Smoke) {
                if inverse_mass[k] > 0.0 {
                    velocity[k] = displacement[k] * inverse_dt;
                }
                remainder[k] = left_over(displacement[k], remainder[k], position[k] - start[k]);
            }
        });
    }
    parallelism.update(&mut particles.age, |_, age| *age += dt);
    wrap(particles, periodic, parallelism);
}

/// Stores the rounding errors of the positions.
pub(super) fn carry_remainders(particles: &mut Particles, parallelism: Parallelism) {
    let (phases, displacements) = (&particles.phase, &particles.displacement);
    let (starts, positions) = (&particles.start, &particles.position);
    parallelism.update(&mut particles.remainder, |row, remainder| {
        if phases[row] != Phase::Smoke {
            *remainder = left_over(displacements[row], *remainder, positions[row] - starts[row]);
        }
    });
}

/// The part of a displacement and of the old remainder that was lost in the rounding of a position.
#[inline(always)]
pub(super) fn left_over(displacement: Vector, remainder: Vector, moved: Vector) -> Vector {
    (displacement + remainder) - moved
}

/// Brings positions on periodic axes back into the domain.
pub(super) fn wrap(particles: &mut Particles, periodic: Periodic, parallelism: Parallelism) {
    if periodic.any() {
        for rows in particles.bands() {
            parallelism.update(&mut particles.position[rows], |_, position| *position = periodic.wrap(*position));
        }
    }
}
