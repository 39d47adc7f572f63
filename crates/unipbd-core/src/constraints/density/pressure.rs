//! The pressure that the multipliers exert, read from the momentum they carry.
//!
//! The multiplier of a particle alone misleads near walls: a wall has no multiplier of its own and carries no
//! gradient along itself, so those beside it must be larger to hold the same weight, and disorder lowers the
//! gradient that a multiplier brings about. The momentum determines the stress (Irving & Kirkwood 1950): the
//! pair force F_ij = -(lambda_i + lambda_j) V g x_ij/dt^2 along x_ij, half for each of both, and the push of a
//! wall -lambda_i G_wall/dt^2 over the distance to it,
//!
//! V sigma_i = 1/2 sum_j F_ij x_ij + sum_walls F_w s_w.
//!
//! The pressure is half the trace of sigma. Beside a wall only the part across it is complete: there the
//! pressure is the stress across the wall, of several walls their mean, weighed by how much kernel they hold.

use super::Density;
use crate::constraints::Substep;
use crate::kernel::Shape;
use crate::math::{Real, Vector, larger};
use crate::phase::Phase;

/// The largest pressure is looked for where a multiplier over its mass is at least this part of the largest one:
/// beside walls they read up to a third high, and where they are much smaller no pressure is large.
const CANDIDATE_PART: Real = 0.6;
/// Among at most this many.
const CANDIDATES: usize = 256;

/// Stress of a particle times volume, substep squared and so on, and the directions in which it counts.
#[derive(Clone, Copy, Default)]
struct Stress {
    pairs: Tensor,
    walls: Tensor,
    /// Sum of |G| n n over walls and bodies, n across them.
    across: Tensor,
}

/// A symmetric tensor of the plane.
#[derive(Clone, Copy, Default)]
struct Tensor {
    xx: Real,
    xy: Real,
    yy: Real,
}

impl Tensor {
    fn add(&mut self, factor: Real, a: Vector, b: Vector) {
        self.xx += factor * a.x * b.x;
        self.xy += factor * 0.5 * (a.x * b.y + a.y * b.x);
        self.yy += factor * a.y * b.y;
    }

    fn trace(self) -> Real {
        self.xx + self.yy
    }

    fn dot(self, other: Tensor) -> Real {
        self.xx * other.xx + 2.0 * self.xy * other.xy + self.yy * other.yy
    }
}

impl Stress {
    fn pressure(self) -> Real {
        let all = Tensor {
            xx: self.pairs.xx + self.walls.xx,
            xy: self.pairs.xy + self.walls.xy,
            yy: self.pairs.yy + self.walls.yy,
        };
        let weight = self.across.trace();
        if weight > 0.0 { all.dot(self.across) / weight } else { 0.5 * all.trace() }
    }
}

/// Whether a row is of a fluid that moves.
fn is_pressed(now: Substep<'_>, row: usize) -> bool {
    now.particles.phases()[row].is_fluid() && now.particles.inverse_masses()[row] > 0.0
}

impl<K: Shape> Density<K> {
    /// Pressure over density by row [m^2/s^2]; 0 for rows that are no fluid.
    pub(super) fn read_pressures(&self, now: Substep<'_>) -> Vec<Real> {
        let particles = now.particles;
        let mut pressures = vec![0.0; particles.len()];
        now.parallelism.update(&mut pressures[..particles.dense()], |row, pressure| {
            if is_pressed(now, row) {
                *pressure = self.pressure(now, row);
            }
        });
        pressures
    }

    /// The largest pressure over density [m^2/s^2]: neighbours are visited at [`CANDIDATES`] rows at most, those with
    /// large multipliers.
    pub(super) fn read_largest_pressure(&self, now: Substep<'_>) -> Real {
        let particles = now.particles;
        let (multipliers, inverse_masses) = (&particles.multiplier, particles.inverse_masses());
        let single = |row: usize| if is_pressed(now, row) { multipliers[row] * inverse_masses[row] } else { 0.0 };
        let least = CANDIDATE_PART * now.parallelism.max(particles.dense(), single);
        if least <= 0.0 {
            return 0.0;
        }
        let mut rows: Vec<usize> = (0..particles.dense()).filter(|&row| single(row) >= least).collect();
        if rows.len() > CANDIDATES {
            let larger_first = |a: &usize, b: &usize| single(*b).total_cmp(&single(*a)).then(a.cmp(b));
            rows.select_nth_unstable_by(CANDIDATES, larger_first);
            rows.truncate(CANDIDATES);
        }
        rows.into_iter().map(|row| self.pressure(now, row)).fold(0.0, larger)
    }

    /// Pressure over density of a fluid particle [m^2/s^2].
    fn pressure(&self, now: Substep<'_>, row: usize) -> Real {
        self.stress(now, row).pressure() * now.particles.inverse_masses()[row] / (now.dt * now.dt)
    }

    fn stress(&self, now: Substep<'_>, row: usize) -> Stress {
        let (positions, phases) = (now.particles.positions(), now.particles.phases());
        let (multipliers, periodic) = (&now.particles.multiplier, now.neighbors.periodic());
        let (point, own, volume) = (positions[row], multipliers[row], self.settings.volume);
        let radius = self.kernel.radius();
        let mut stress = Stress::default();
        let mut body = Vector::ZERO;
        for other in now.neighbors.runs_near(point).iter().flatten() {
            let apart = periodic.min_image(point - positions[other]);
            let distance = apart.length();
            if other == row || distance >= radius {
                continue;
            }
            let slope = volume * self.kernel.slope(distance);
            if phases[other] == Phase::Rigid {
                body += apart * slope;
            }
            stress.pairs.add(-0.5 * slope * (own + multipliers[other]), apart, apart);
        }
        let mut across = |gradient: Vector| {
            let size = gradient.length();
            if size > 0.0 {
                stress.across.add(1.0 / size, gradient, gradient);
            }
        };
        across(body);
        now.walls.pushes(point, &self.coverage, |gradient, from_wall| {
            across(gradient);
            stress.walls.add(-own, gradient, from_wall);
        });
        now.outlines.pushes(point, |gradient, from_edge| {
            across(gradient);
            stress.walls.add(-own, gradient, from_edge);
        });
        stress
    }
}
