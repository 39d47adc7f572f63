//! Settling: relaxes the start of a run to its rest density, without gravity and without velocities.
//!
//! Each projection starts with a fraction of the last displacement, if the push has the same direction (momentum
//! method). Relaxation of a deep liquid then takes a number of projections linear in the layers, not quadratic.
//!
//! Liquids that rest are settled with gravity instead, where particles alone carry their weight.

use super::clock::Clock;
use super::integrate;
use super::level::Resting;
use super::pipeline::Stage;
use super::world::World;
use crate::math::{Real, Vector, larger};
use crate::parallel::Parallelism;
use crate::particles::{Particles, displaced};
use crate::phase::Phase;

/// Settling ends when no particle moves farther than this many spacings in one projection. (Ended at half of the target
/// compression, in a third of the time, it leaves ramps 1 % too fast.)
const SETTLED: f64 = 1e-5;
/// Projections that settle a shallow start (measured on columns of 10 to 30 layers).
const PROJECTIONS: f64 = 100.0;
/// Projections per layer of a liquid that is at most [`NARROW`] wide.
const PROJECTIONS_PER_LAYER: f64 = 3.0;
/// Width up to which walls lift a whole column \[spacings]: the density of the rows next to walls is too high.
const NARROW: f64 = 16.0;
/// Skin of the neighbour list while particles settle \[spacings]: they move less than half of it in ten projections or
/// more, and a new list costs more than the projection itself.
const SKIN: f64 = 0.3;
/// Part of a displacement that the next projection starts with.
const MOMENTUM: Real = 0.9;
/// The stages of a substep that a projection runs.
const PROJECTION: [Stage; 4] = [Stage::BeginGroups, Stage::Project, Stage::KeepOutOfWalls, Stage::StoreDensity];

impl World {
    /// Brings the start to its rest density. `most` is the largest number of projections; left out, it follows from the
    /// size of the liquid. Where liquids `weigh`, those that rest end compressed by their weight.
    pub fn settle(&mut self, most: Option<u32>, weigh: bool) {
        let projections = most.unwrap_or_else(|| self.projections_to_settle());
        self.clock.dt = self.parts.frame_time;
        self.clock.pressure_limit = self.pressure_limit();
        (self.clock.stiffness, self.clock.settling) = (1.0, true);
        if self.parts.particles.dense() > 0 {
            let still = SETTLED * self.parts.spacing;
            let usual = self.parts.neighbors.keep_skin((SKIN * self.parts.spacing) as Real);
            let resting = if weigh && projections > 0 { self.resting() } else { Resting::default() };
            // Where all rests, the weight settles it too.
            if !resting.is_all() {
                (0..projections).find(|_| self.relax_once() <= still);
                zero_displacements(&mut self.parts.particles);
            }
            if resting.rests > 0 {
                self.settle_under_weight(&resting, most);
                zero_displacements(&mut self.parts.particles);
            }
            self.parts.neighbors.keep_skin(usual);
        }
        // The start can be observed like any other moment.
        self.find_neighbors_if_listed();
        self.clock = Clock { generation: self.clock.generation, ..Clock::default() };
    }

    fn projections_to_settle(&self) -> u32 {
        let [width, layers] = self.extent().map(|extent| extent / self.parts.spacing);
        (PROJECTIONS_PER_LAYER * layers * (NARROW / width).min(1.0)).max(PROJECTIONS) as u32
    }

    /// Runs one projection and returns how far it moved any particle \[m].
    fn relax_once(&mut self) -> f64 {
        start_projection(&mut self.parts.particles, self.parts.parallelism);
        self.find_neighbors_if_listed();
        let carried = take_carried(&mut self.parts.particles);
        self.project_start();
        integrate::carry_remainders(&mut self.parts.particles, self.parts.parallelism);
        let farthest = carry_momentum(&mut self.parts.particles, &carried, self.parts.parallelism);
        integrate::wrap(&mut self.parts.particles, self.parts.neighbors.periodic(), self.parts.parallelism);
        farthest
    }

    /// Runs the stages of a projection, none of which fails.
    pub(super) fn project_start(&mut self) {
        for index in 0..self.plan.substep.len() {
            let stage = self.plan.substep[index];
            if PROJECTION.contains(&stage) {
                let _ = self.run(stage);
            }
        }
    }
}

/// Moves particles by the fraction of their last displacement kept by [`carry_momentum`]. The column of displacements
/// holds it until [`take_carried`].
fn start_projection(particles: &mut Particles, parallelism: Parallelism) {
    let Particles { position, start, remainder, displacement, phase, .. } = particles;
    parallelism.chunks3(position, start, remainder, |first, position, start, remainder| {
        for (k, x) in position.iter_mut().enumerate() {
            let row = first + k;
            if phase[row] != Phase::Smoke {
                let place = displaced(*x, displacement[row], remainder[k]);
                remainder[k] = integrate::left_over(displacement[row], remainder[k], place - *x);
                *x = place;
            }
            start[k] = *x;
        }
    });
}

/// Takes the displacements out of their column, which from here on holds those of the projection.
fn take_carried(particles: &mut Particles) -> Vec<Vector> {
    let carried = particles.displacement.clone();
    zero_displacements(particles);
    carried
}

/// Keeps a fraction of the displacement of a projection for the next one, if its push has the same direction. Returns
/// the largest displacement \[m].
fn carry_momentum(particles: &mut Particles, carried: &[Vector], parallelism: Parallelism) -> f64 {
    let (displacement, phase) = (&mut particles.displacement, &particles.phase);
    let way = |row: usize, displacement: Vector| match phase[row] {
        Phase::Smoke => Vector::ZERO,
        _ => carried[row] + displacement,
    };
    let farthest = parallelism.max(displacement.len(), |row| way(row, displacement[row]).length_squared());
    parallelism.update(displacement, |row, displacement| {
        if phase[row] != Phase::Smoke {
            let way = way(row, *displacement);
            let pushed = displacement.dot(way) > 0.0;
            *displacement = if pushed { way * MOMENTUM } else { Vector::ZERO };
        }
    });
    f64::from(larger(farthest, 0.0)).sqrt()
}

fn zero_displacements(particles: &mut Particles) {
    for (displacement, phase) in particles.displacement.iter_mut().zip(&particles.phase) {
        if *phase != Phase::Smoke {
            *displacement = Vector::ZERO;
        }
    }
}
