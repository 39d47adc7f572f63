//! The three passes of one density iteration.

use super::{Density, DensityMaterial};
use crate::constraints::{Corrections, Substep};
use crate::math::Real;
use crate::phase::Phase;
use crate::scene::GradientPoint;
use crate::simd::{self, DensityInput, DensityOutput, Tensile, Weights};

impl Density {
    /// Pass 1: sums of the kernel, its gradient and the response of the neighbours.
    pub(super) fn sum_kernels(&mut self, now: Substep<'_>) {
        let gradients = self.settings.gradients;
        let input = DensityInput {
            positions: Density::value_positions(gradients, &self.middle, now),
            gradient_positions: match gradients {
                GradientPoint::Predicted | GradientPoint::Middle => None,
                GradientPoint::Start => Some(now.particles.starts()),
            },
            weights: match self.settings.uniform_inverse_mass {
                Some(inverse_mass) if !now.particles.any_scripted() => Weights::Uniform(inverse_mass),
                _ => Weights::Column(now.particles.inverse_masses()),
            },
        };
        let sums = &mut self.sums;
        let out = DensityOutput { value: &mut sums.value, gradient: &mut sums.gradient, response: &mut sums.response };
        match self.kernel.alternative() {
            None => simd::density(now.pairs(), self.kernel.shape(), input, out),
            Some(other) => simd::density(now.pairs(), other, input, out),
        }
    }

    /// Pass 2: density errors and the relaxed step of each multiplier.
    pub(super) fn step_multipliers(&mut self, now: Substep<'_>) {
        let volume = self.settings.volume;
        let own = volume * self.kernel.value(0.0);
        let (sums, coverage, materials) = (&self.sums, &self.coverage, &self.settings.materials);
        let gradients = self.settings.gradients;
        let positions = Density::value_positions(gradients, &self.middle, now);
        let gradient_positions = Density::gradient_positions(gradients, &self.middle, now);
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
        let limit = now.pressure_limit * now.dt * now.dt;
        now.parallelism.chunks2(&mut self.step, &mut self.multiplier, |first, steps, multipliers| {
            for k in 0..steps.len() {
                let i = first + k;
                let gradient = sums.gradient[i] * volume + walls[i];
                let response = inverse_masses[i] * gradient.length_squared() + volume * volume * sums.response[i];
                let material = &materials[usize::from(material_of[i])];
                let new = material.multiplier(multipliers[k], errors[i], response, inverse_masses[i], limit);
                steps[k] = new - multipliers[k];
                multipliers[k] = new;
            }
        });
    }

    /// Pass 3: displacements, gathered per row, so that momentum is kept with unequal masses too.
    pub(super) fn correct(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let positions = Density::gradient_positions(self.settings.gradients, &self.middle, now);
        let sums = &mut self.sums.gradient;
        match self.kernel.alternative() {
            None => simd::correction(now.pairs(), self.kernel.shape(), positions, &self.step, sums),
            Some(other) => simd::correction(now.pairs(), other, positions, &self.step, sums),
        }
        let (sums, steps, walls) = (&self.sums.gradient, &self.step, &self.wall_gradient);
        let (volume, inverse_masses) = (self.settings.volume, now.particles.inverse_masses());
        let rows = now.particles.dense();
        now.parallelism.update(&mut out.displacements_mut()[..rows], |i, displacement| {
            *displacement -= inverse_masses[i] * (sums[i] * volume + walls[i] * steps[i]);
        });
    }

    /// The forces of the same multipliers on the samples of bodies. Run after [`correct`](Self::correct).
    pub(super) fn load_bodies(&self, now: Substep<'_>, out: &mut Corrections) {
        let (sums, volume, phases) = (&self.sums.gradient, self.settings.volume, now.particles.phases());
        now.parallelism.update(out.loads_mut(), |i, load| {
            if phases[i] == Phase::Rigid {
                *load -= sums[i] * volume;
            }
        });
    }

    /// Keeps gas particles apart: below 0.8 spacings a pair gives back a part of its overlap.
    pub(super) fn repel(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let Some(repulsion) = self.settings.repulsion else { return };
        let (materials, material_of) = (&self.settings.materials, now.particles.materials());
        self.strength.resize(now.particles.dense(), 0.0);
        now.parallelism.fill(&mut self.strength, |i| materials[usize::from(material_of[i])].repulsion);
        let positions = Density::gradient_positions(self.settings.gradients, &self.middle, now);
        let (reach, strengths) = (repulsion.reach, Weights::Column(&self.strength));
        simd::repulsion(now.pairs(), reach, positions, strengths, &mut self.sums.gradient);
        let (sums, strength) = (&self.sums.gradient, &self.strength);
        let inverse_masses = now.particles.inverse_masses();
        now.parallelism.update(&mut out.displacements_mut()[..strength.len()], |i, displacement| {
            *displacement += sums[i] * (strength[i] * inverse_masses[i]);
        });
    }

    /// The artificial pressure of Macklin & Müller 2013 (equations 13 and 14): liquids alone.
    pub(super) fn press_apart(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let pressure = self.settings.artificial_pressure;
        if pressure == 0.0 {
            return;
        }
        let (inverse_masses, phases) = (now.particles.inverse_masses(), now.particles.phases());
        now.parallelism.fill(&mut self.step, |i| match phases[i] {
            Phase::Liquid if inverse_masses[i] > 0.0 => 0.5 * pressure / inverse_masses[i],
            _ => 0.0,
        });
        let positions = Density::gradient_positions(self.settings.gradients, &self.middle, now);
        let (sums, reference) = (&mut self.sums.gradient, 0.2 * self.settings.kernel_radius);
        match self.kernel.alternative() {
            None => {
                simd::correction(now.pairs(), Tensile::new(self.kernel.shape(), reference), positions, &self.step, sums)
            }
            Some(other) => simd::correction(now.pairs(), Tensile::new(other, reference), positions, &self.step, sums),
        }
        let (sums, volume) = (&self.sums.gradient, self.settings.volume);
        now.parallelism.update(&mut out.displacements_mut()[..now.particles.dense()], |i, displacement| {
            *displacement -= sums[i] * (volume * inverse_masses[i]);
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
    /// The multiplier after one relaxed step. `limit` is the largest pressure over density times dt^2.
    #[inline]
    fn multiplier(&self, old: Real, error: Real, response: Real, inverse_mass: Real, limit: Real) -> Real {
        if error < self.gate || self.relaxation == 0.0 {
            return old;
        }
        // A particle moved by a script may push, never pull: its own response is missing from the
        // denominator.
        let least = if inverse_mass == 0.0 { 0.0 } else { self.multiplier_min };
        let new = (old + self.relaxation * error / (response.max(self.response_min) + self.mixing)).max(least);
        // What is squeezed in with no way out must not push harder the shorter the substep is.
        if self.limited_mass > 0.0 { new.clamp(-limit * self.limited_mass, limit * self.limited_mass) } else { new }
    }
}
