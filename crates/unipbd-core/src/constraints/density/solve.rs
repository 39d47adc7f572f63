//! The three passes of one density iteration.

use super::{Density, DensityMaterial};
use crate::constraints::{Corrections, Substep};
use crate::math::{Real, Vector};

/// Pairs closer than this many spacings repel each other where their material says so.
const REPULSION_REACH: Real = 0.8;

impl Density {
    /// Pass 1: sums of the kernel, its gradient and the response of the neighbours.
    pub(super) fn sum_kernels(&mut self, now: Substep<'_>) {
        let (kernel, list) = (self.kernel, now.neighbors);
        let positions = &now.particles.positions()[..now.particles.dense()];
        let gradient_positions = self.gradient_positions(now);
        let inverse_masses = now.particles.inverse_masses();
        let sums = &mut self.sums;
        now.parallelism.chunks3(&mut sums.value, &mut sums.gradient, &mut sums.response, |first, s, g, q| {
            for k in 0..s.len() {
                let i = first + k;
                let (mut value, mut gradient, mut response) = (0.0, Vector::ZERO, 0.0);
                list.for_each(i, |j| {
                    value += kernel.value((positions[i] - positions[j]).length());
                    let difference = gradient_positions[i] - gradient_positions[j];
                    let step = difference * kernel.slope(difference.length());
                    gradient += step;
                    response += inverse_masses[j] * step.length_squared();
                });
                (s[k], g[k], q[k]) = (value, gradient, response);
            }
        });
    }

    /// Pass 2: density errors and the relaxed step of each multiplier.
    pub(super) fn step_multipliers(&mut self, now: Substep<'_>) {
        let volume = self.settings.volume;
        let own = volume * self.kernel.value(0.0);
        let (sums, coverage, materials) = (&self.sums, &self.coverage, &self.settings.materials);
        let positions = now.particles.positions();
        let gradient_positions = self.gradient_positions(now);
        let (errors, walls) = (&mut self.error, &mut self.wall_gradient);
        now.parallelism.chunks2(errors, walls, |first, errors, walls| {
            for k in 0..errors.len() {
                let i = first + k;
                let fluid = volume * sums.value[i] + own - 1.0;
                if now.walls.is_empty() {
                    errors[k] = fluid;
                } else {
                    errors[k] = fluid + now.walls.coverage(positions[i], coverage).0;
                    walls[k] = now.walls.coverage(gradient_positions[i], coverage).1;
                }
            }
        });
        let (errors, walls) = (&self.error, &self.wall_gradient);
        let inverse_masses = now.particles.inverse_masses();
        let material_of = now.particles.materials();
        now.parallelism.chunks2(&mut self.step, &mut self.multiplier, |first, steps, multipliers| {
            for k in 0..steps.len() {
                let i = first + k;
                let gradient = sums.gradient[i] * volume + walls[i];
                let response = inverse_masses[i] * gradient.length_squared() + volume * volume * sums.response[i];
                let material = &materials[usize::from(material_of[i])];
                let new = material.multiplier(multipliers[k], errors[i], response, inverse_masses[i]);
                steps[k] = new - multipliers[k];
                multipliers[k] = new;
            }
        });
    }

    /// Pass 3: displacements, gathered per row, so that momentum is kept with unequal masses too.
    pub(super) fn correct(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let (kernel, volume, list) = (self.kernel, self.settings.volume, now.neighbors);
        let reach = REPULSION_REACH * self.settings.spacing as Real;
        let positions = self.gradient_positions(now);
        let inverse_masses = now.particles.inverse_masses();
        let (material_of, materials) = (now.particles.materials(), &self.settings.materials);
        let (steps, walls) = (&self.step, &self.wall_gradient);
        let rows = now.particles.dense();
        now.parallelism.update(&mut out.displacements_mut()[..rows], |i, displacement| {
            let repulsion = materials[usize::from(material_of[i])].repulsion;
            let (mut sum, mut push) = (Vector::ZERO, Vector::ZERO);
            list.for_each(i, |j| {
                let difference = positions[i] - positions[j];
                let r = difference.length();
                sum += difference * (kernel.slope(r) * (steps[i] + steps[j]));
                if r < reach && repulsion > 0.0 {
                    push +=
                        direction(difference, r, i < j) * ((reach - r) * share(inverse_masses[i], inverse_masses[j]));
                }
            });
            *displacement -= inverse_masses[i] * (sum * volume + walls[i] * steps[i]);
            *displacement += push * repulsion;
        });
    }
}

impl Density {
    /// Density errors at the positions as they are now, by a search of their own: the list may be
    /// made for other positions.
    pub(super) fn measure(&self, now: Substep<'_>) -> Vec<Real> {
        let particles = now.particles;
        let (positions, periodic) = (particles.positions(), now.neighbors.periodic());
        let (radius, volume) = (self.kernel.radius(), self.settings.volume);
        let mut errors = vec![0.0; particles.len()];
        now.parallelism.update(&mut errors[..particles.dense()], |row, error| {
            if !particles.phases()[row].is_fluid() {
                return;
            }
            let x = positions[row];
            let mut sum = 0.0;
            now.neighbors.for_each_near(x, radius, |other| {
                sum += self.kernel.value(periodic.min_image(x - positions[other]).length());
            });
            *error = volume * sum + now.walls.coverage(x, &self.coverage).0 - 1.0;
        });
        errors
    }
}

impl DensityMaterial {
    /// The multiplier after one relaxed step.
    #[inline]
    fn multiplier(&self, old: Real, error: Real, response: Real, inverse_mass: Real) -> Real {
        if error < self.gate || self.relaxation == 0.0 {
            return old;
        }
        // A particle moved by a script may push, never pull: its own response is missing from the
        // denominator.
        let least = if inverse_mass == 0.0 { 0.0 } else { self.multiplier_min };
        (old + self.relaxation * error / response.max(self.response_min)).max(least)
    }
}

/// From the second point to the first; coincident points part along x, the lower row to the left.
#[inline]
fn direction(difference: Vector, r: Real, first: bool) -> Vector {
    if r > 0.0 {
        difference / r
    } else if first {
        -Vector::X
    } else {
        Vector::X
    }
}

/// Part of a pair's displacement that the first of two particles takes.
#[inline]
fn share(own: Real, other: Real) -> Real {
    if own + other > 0.0 { 2.0 * own / (own + other) } else { 0.0 }
}
