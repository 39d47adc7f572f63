//! The three passes of one density iteration.

use super::places::Points;
use super::{Density, DensityMaterial};
use crate::constraints::{Corrections, Substep};
use crate::kernel::Shape;
use crate::math::{Real, Vector, larger, smaller, wide};
use crate::neighbors::near::{self, Near, Work};
use crate::neighbors::weigh::{At, Weighed};
use crate::parallel::CHUNK_ROWS;
use crate::passes::{self, DensityInput, DensityOutput, Weights};
use crate::phase::{Phase, uniform};
use crate::simd::Level;
use crate::simd::space::{Open, Space, Wrapped};
use crate::walls::{Coverage, Moment};
use std::ops::Range;

impl<K: Shape> Density<K> {
    /// Pass 1: sums of the kernel, its gradient and the response of the neighbours.
    pub(super) fn sum_kernels(&mut self, now: Substep<'_>) {
        let points = self.places.iteration(now).pairs;
        let input = DensityInput {
            positions: points.value,
            gradient_positions: points.other_gradient(),
            weights: match self.settings.uniform_inverse_mass {
                Some(inverse_mass) if !now.particles.any_kinematic() => Weights::Uniform(inverse_mass),
                _ => Weights::Column(now.particles.inverse_masses()),
            },
            unit: self.settings.unit,
        };
        let sums = &mut self.sums;
        let out = DensityOutput { value: &mut sums.value, gradient: &mut sums.gradient, response: &mut sums.response };
        passes::density(now.pairs(), self.kernel.shape(), input, out);
    }

    /// Pass 2: density errors and the relaxed step of each multiplier.
    pub(super) fn step_multipliers(&mut self, now: Substep<'_>) {
        let volume = self.settings.volume;
        let behind_walls = BehindWalls { now, coverage: &self.coverage, points: self.places.iteration(now).world };
        let terms = Terms {
            volume,
            volume_in_units: volume / self.settings.unit,
            to_step: 1.0 / self.settings.step_unit,
            own: self.kernel.value(0.0) * volume - 1.0,
            stiffness: now.stiffness,
            limit: now.pressure_limit * now.dt * now.dt,
        };
        let (sums, materials) = (&self.sums, &self.settings.materials);
        let (inverse_mass, material_of) = (now.particles.inverse_masses(), now.particles.materials());
        let (error, wall, step, multiplier) =
            (&mut self.error, &mut self.wall_gradient, &mut self.step, &mut self.multiplier);
        let step = &mut step[..error.len()];
        now.parallelism.chunks4(error, wall, step, multiplier, |first, error, wall, step, multiplier| {
            behind_walls.fill(first, error, wall);
            let rows = first..first + error.len();
            let mut rows = Relaxed {
                value: &sums.value[rows.clone()],
                gradient: &sums.gradient[rows.clone()],
                response: &sums.response[rows.clone()],
                inverse_mass: &inverse_mass[rows.clone()],
                wall,
                error,
                step,
                multiplier,
            };
            let material_of = &material_of[first..first + rows.error.len()];
            match uniform(material_of) {
                // The numbers of the material stay in registers, and rows fill the vectors of the machine.
                Some(material) => {
                    let material = materials[usize::from(material)];
                    rows.relax(terms, |_| material);
                }
                None => rows.relax(terms, |k| materials[usize::from(material_of[k])]),
            }
        });
    }

    /// Evens out the arrangement: the moves that one pressure everywhere would bring about, without the
    /// velocities (Adami et al. 2013). Run before [`correct`](Self::correct), which overwrites the sums.
    pub(super) fn shift(&self, now: Substep<'_>, out: &mut Corrections) {
        let Some(farthest) = self.settings.farthest_shift else { return };
        let (sums, walls, errors) = (&self.sums.gradient, &self.wall_gradient, &self.error);
        let (materials, material_of) = (&self.settings.materials, now.particles.materials());
        let (volume, inverse_masses) = (self.settings.volume, now.particles.inverse_masses());
        let velocities = now.particles.velocities();
        let fastest = now.parallelism.max(errors.len(), |i| velocities[i].length_squared()).sqrt();
        let part = smaller(fastest * now.dt / self.settings.whole_shift, 1.0);
        now.parallelism.update(&mut out.shifts_mut()[..errors.len()], |i, shift| {
            if inverse_masses[i] > 0.0 {
                let strength = materials[usize::from(material_of[i])].shift(errors[i]) * part;
                let gradient = sums[i] * volume + walls[i];
                // Beside a wall only along it: across, rows keep a gradient at rest, and what pushed them back
                // against it in each substep would read as a speed.
                let gradient = if walls[i] == Vector::ZERO { gradient } else { gradient.reject_from(walls[i]) };
                *shift = at_most(gradient * -strength, farthest);
            }
        });
    }

    /// Pass 3: displacements, gathered per row, so that momentum is kept with unequal masses too.
    pub(super) fn correct(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let positions = self.places.iteration(now).pairs.gradient;
        let (sums, records) = (&mut self.sums.gradient, &mut self.records);
        passes::correction(now.pairs(), self.kernel.shape(), positions, &self.step, records, sums);
        let (sums, steps, walls) = (&self.sums.gradient, &self.step, &self.wall_gradient);
        let (volume, inverse_masses) = (self.settings.volume, now.particles.inverse_masses());
        let (rows, unit) = (now.particles.listed(), self.settings.step_unit);
        // The admitted pressures accelerate to this speed at most (Bernoulli). The limit cuts the displacements of a
        // crushed heap where the step is too long for them.
        let farthest = (2.0 * now.pressure_limit).sqrt() * now.dt;
        now.parallelism.chunks(&mut out.displacements_mut()[..rows], |first, displacements| {
            let rows = first..first + displacements.len();
            let (sums, walls) = (&sums[rows.clone()], &walls[rows.clone()]);
            let (steps, inverse_masses) = (&steps[rows.clone()], &inverse_masses[rows]);
            for k in 0..displacements.len() {
                let step = unit * inverse_masses[k] * (sums[k] * volume + walls[k] * steps[k]);
                displacements[k] -= at_most(step, farthest);
            }
        });
        self.share(now, out);
    }

    /// Lets velocities follow a part of the displacements alone.
    fn share(&self, now: Substep<'_>, out: &mut Corrections) {
        let share = self.settings.velocity_share;
        if share == 1.0 {
            return;
        }
        let rows = now.particles.listed();
        let (displacements, shifts) = out.both_mut();
        now.parallelism.chunks2(&mut displacements[..rows], &mut shifts[..rows], |_, displacements, shifts| {
            for (displacement, shift) in displacements.iter_mut().zip(shifts) {
                *shift += *displacement * (1.0 - share);
                *displacement *= share;
            }
        });
    }

    /// The forces of the same multipliers on the samples of bodies. Run after [`correct`](Self::correct).
    pub(super) fn load_bodies(&self, now: Substep<'_>, out: &mut Corrections) {
        let (sums, volume, phases) = (&self.sums.gradient, self.settings.volume, now.particles.phases());
        let share = self.settings.velocity_share * self.settings.step_unit;
        now.parallelism.update(out.loads_mut(), |i, load| {
            if phases[i] == Phase::Rigid {
                *load -= sums[i] * (volume * share);
            }
        });
    }

    /// The forces of the same multipliers on the measured walls.
    pub(super) fn load_walls(&self, now: Substep<'_>, out: &mut Corrections) {
        if out.wall_loads().is_empty() {
            return;
        }
        let positions = self.places.iteration(now).world.gradient;
        let (steps, inverse_masses) = (&self.step, now.particles.inverse_masses());
        let share = self.settings.velocity_share * self.settings.step_unit;
        for (row, &position) in positions.iter().enumerate() {
            if steps[row] != 0.0 && inverse_masses[row] > 0.0 {
                now.walls.shares(position, &self.coverage, |wall, slope| {
                    out.wall_loads_mut()[usize::from(wall)] += wide(slope * (steps[row] * share));
                });
            }
        }
    }

    /// The forces of the same multipliers on bodies that are walls by their outlines.
    pub(super) fn load_outlines(&self, now: Substep<'_>, out: &mut Corrections) {
        if out.outline_loads().is_empty() {
            return;
        }
        let points = self.places.iteration(now).world;
        let moment = if points.other_gradient().is_some() { Moment::Start } else { Moment::End };
        let (steps, inverse_masses) = (&self.step, now.particles.inverse_masses());
        let share = self.settings.velocity_share * self.settings.step_unit;
        // Chunk by chunk: most outlines are far from all points of one.
        for (number, points) in points.gradient[..self.wall_gradient.len()].chunks(CHUNK_ROWS).enumerate() {
            now.outlines.each_seen(points, moment, |k, near| {
                let row = number * CHUNK_ROWS + k;
                if steps[row] != 0.0 && inverse_masses[row] > 0.0 {
                    let arm = now.outlines.arm(near.outline, points[k], moment);
                    out.outline_loads_mut()[near.outline].add(wide(near.gradient * (steps[row] * share)), arm);
                }
            });
        }
    }

    /// Keeps gas particles apart: below 0.8 spacings a pair gives back a part of its overlap.
    pub(super) fn repel(&mut self, now: Substep<'_>, out: &mut Corrections) {
        let Some(reach) = self.settings.repulsion else { return };
        let (materials, material_of) = (&self.settings.materials, now.particles.materials());
        self.strength.resize(now.particles.dense(), 0.0);
        now.parallelism.fill(&mut self.strength, |i| materials[usize::from(material_of[i])].repulsion);
        let positions = self.places.iteration(now).pairs.gradient;
        let strengths = Weights::Column(&self.strength);
        passes::repulsion(now.pairs(), reach, positions, strengths, &mut self.sums.gradient);
        let (sums, strength) = (&self.sums.gradient, &self.strength);
        let inverse_masses = now.particles.inverse_masses();
        now.parallelism.update(&mut out.displacements_mut()[..sums.len()], |i, displacement| {
            *displacement += sums[i] * (strength[i] * inverse_masses[i]);
        });
    }
}

impl<K: Shape> Density<K> {
    /// Density errors at the positions as they are now, by a search of their own: the list may be
    /// made for other positions.
    pub(super) fn measure(&self, now: Substep<'_>) -> Vec<Real> {
        let (periodic, fine) = (now.neighbors.periodic(), &*self.places.measured(now));
        let mut errors = vec![0.0; now.particles.len()];
        now.parallelism.chunks(&mut errors[..fine.len()], |first, out| {
            if periodic.any() {
                let space = Wrapped::new(periodic);
                near::dispatch(Level::best(), Measured { density: self, now, fine, space, first, out });
            } else {
                near::dispatch(Level::best(), Measured { density: self, now, fine, space: Open, first, out });
            }
        });
        errors
    }
}

/// Density errors of the rows from `first` on, measured by one task.
struct Measured<'a, S, K> {
    density: &'a Density<K>,
    now: Substep<'a>,
    /// Positions whose differences are exact.
    fine: &'a [Vector],
    space: S,
    first: usize,
    out: &'a mut [Real],
}

impl<S: Space, K: Shape> Work for Measured<'_, S, K> {
    #[inline(always)]
    fn run<N: Near>(self, near: N) {
        let Measured { density, now, fine, space, first, out } = self;
        let (particles, shape) = (now.particles, density.kernel.shape());
        let scale = density.settings.volume * shape.value_scale();
        for (row, out) in (first..).zip(out) {
            if !particles.phases()[row].is_fluid() {
                continue;
            }
            let point = particles.positions()[row];
            // Only the weights are asked for: any column will do for the vectors.
            let at = At { space, kernel: shape, point: fine[row], positions: fine, vectors: fine };
            let mut sums = Weighed::default();
            // No closure here: it would miss the instruction set.
            for run in now.neighbors.runs_near(point).iter() {
                near.weigh(&at, run, &mut sums);
            }
            let covered = now.walls.coverage(point, &density.coverage).0 + now.outlines.coverage(point, Moment::End).0;
            *out = scale * sums.weight() + covered - 1.0;
        }
    }
}

/// The part of the kernel inside walls, row by row.
struct BehindWalls<'a> {
    now: Substep<'a>,
    coverage: &'a Coverage,
    points: Points<'a>,
}

impl BehindWalls<'_> {
    /// The parts where the density is taken, and their gradients where gradients are taken [1/m].
    fn fill(&self, first: usize, parts: &mut [Real], slopes: &mut [Vector]) {
        let walls = self.now.walls;
        parts.fill(0.0);
        slopes.fill(Vector::ZERO);
        let rows = first..first + parts.len();
        if !walls.is_empty() {
            self.fill_walls(first, parts, slopes);
        }
        if !self.now.outlines.is_empty() {
            self.add_outlines(rows, parts, slopes);
        }
    }

    fn fill_walls(&self, first: usize, parts: &mut [Real], slopes: &mut [Vector]) {
        let (walls, coverage) = (self.now.walls, self.coverage);
        let (rows, reach) = (first..first + parts.len(), coverage.radius());
        let mut distances = [0.0; CHUNK_ROWS];
        let mut near = |points: &[Vector], visit: &mut dyn FnMut(usize, (Real, Vector))| {
            let distances = &mut distances[..points.len()];
            walls.distances(points, distances);
            for (k, _) in distances.iter().enumerate().filter(|(_, distance)| **distance < reach) {
                visit(k, walls.coverage(points[k], coverage));
            }
        };
        near(&self.points.value[rows.clone()], &mut |k, behind| (parts[k], slopes[k]) = behind);
        if let Some(positions) = self.points.other_gradient() {
            slopes.fill(Vector::ZERO);
            near(&positions[rows], &mut |k, behind| slopes[k] = behind.1);
        }
    }

    fn add_outlines(&self, rows: Range<usize>, parts: &mut [Real], slopes: &mut [Vector]) {
        let outlines = self.now.outlines;
        let elsewhere = self.points.other_gradient();
        outlines.each_seen(&self.points.value[rows.clone()], Moment::End, |k, near| {
            parts[k] += near.part;
            if elsewhere.is_none() {
                slopes[k] += near.gradient;
            }
        });
        if let Some(positions) = elsewhere {
            outlines.each_seen(&positions[rows], Moment::Start, |k, near| slopes[k] += near.gradient);
        }
    }
}

/// Terms common to all rows.
#[derive(Clone, Copy)]
struct Terms {
    /// Weight of one neighbour [m^2].
    volume: Real,
    /// The same over the unit of the responses.
    volume_in_units: Real,
    /// From a change of a multiplier to a step in its unit.
    to_step: Real,
    /// Contribution of a row itself to its density error, less the rest density.
    own: Real,
    /// Part of the relaxation that counts.
    stiffness: Real,
    /// Largest pressure over density times dt^2 [m^2].
    limit: Real,
}

/// Some rows whose multipliers are to be relaxed.
struct Relaxed<'a> {
    value: &'a [Real],
    gradient: &'a [Vector],
    response: &'a [Real],
    inverse_mass: &'a [Real],
    wall: &'a [Vector],
    /// The part behind walls; becomes the density error.
    error: &'a mut [Real],
    step: &'a mut [Real],
    multiplier: &'a mut [Real],
}

impl Relaxed<'_> {
    #[inline(always)]
    fn relax(&mut self, terms: Terms, material: impl Fn(usize) -> DensityMaterial) {
        let Terms { volume, volume_in_units, to_step, own, stiffness, limit } = terms;
        let rows = self.error.len();
        let (value, gradient, response) = (&self.value[..rows], &self.gradient[..rows], &self.response[..rows]);
        let (inverse_mass, wall) = (&self.inverse_mass[..rows], &self.wall[..rows]);
        let (error, step, multiplier) = (&mut self.error[..rows], &mut self.step[..rows], &mut self.multiplier[..rows]);
        for k in 0..rows {
            error[k] += volume * value[k] + own;
            let gradient = gradient[k] * volume + wall[k];
            let response =
                inverse_mass[k] * gradient.length_squared() + volume_in_units * volume_in_units * response[k];
            let new = material(k).multiplier(multiplier[k], error[k], response, inverse_mass[k], stiffness, limit);
            step[k] = (new - multiplier[k]) * to_step;
            multiplier[k] = new;
        }
    }
}

/// A step, cut to a length. Without a branch, so that rows fill the vectors of the machine.
#[inline(always)]
fn at_most(step: Vector, length: Real) -> Vector {
    let square = step.length_squared();
    let cut = length * (step / square.sqrt());
    if square > length * length { cut } else { step }
}

impl DensityMaterial {
    /// The multiplier after one relaxed step. `limit` is the largest pressure over density times dt^2.
    #[inline(always)]
    pub(super) fn multiplier(
        &self,
        old: Real,
        error: Real,
        response: Real,
        inverse_mass: Real,
        stiffness: Real,
        limit: Real,
    ) -> Real {
        // A kinematic particle may push, never pull: its own response is missing from the
        // denominator.
        let kinematic = inverse_mass == 0.0;
        let least = if kinematic { 0.0 } else { self.multiplier_min };
        let floor = if kinematic { self.kinematic_response_min } else { self.response_min };
        let new = self.unbounded(old, error, larger(response, floor), stiffness);
        // A confined particle must not push harder the shorter the substep is.
        let limit = limit * self.mass;
        let new = smaller(larger(larger(new, least), -limit), limit);
        if error < self.gate || self.relaxation == 0.0 { old } else { new }
    }

    /// The same without its bounds.
    #[inline(always)]
    pub(super) fn unbounded(&self, old: Real, error: Real, response: Real, stiffness: Real) -> Real {
        old + stiffness * self.relaxation * error / response
    }
}
