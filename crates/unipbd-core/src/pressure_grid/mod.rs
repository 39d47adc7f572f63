//! A coarse projection before the particle pass: a grid of cells two spacings wide carries the smooth part of the
//! pressure, and the multipliers of the particles hold only the remainder. The number of substeps then follows from
//! the speed alone, not from the depth.
//!
//! A staggered grid (Harlow & Welch 1965) gives changes of velocity to the particles (Brackbill & Ruppel 1986), with
//! ghost pressures at the free surface (Gibou et al. 2002) and parts of faces at walls (Batty et al. 2007). A second
//! solution of the same system moves particles, without their velocities, out of cells that are too full. Nothing is
//! kept from one substep to the next: a saved run goes on bit for bit.

mod lattice;
mod level;
mod multigrid;
mod openings;
mod spans;
mod system;
mod transfer;

use crate::bytes::held;
use crate::math::{Real, Vector, Vector64, wide};
use crate::parallel::Parallelism;
use crate::particles::{Particles, displaced};
use crate::walls::{Hit, Walls};
use lattice::Lattice;
use multigrid::Multigrid;
use openings::Openings;
use system::System;
use transfer::Transfer;

/// Cells of the grid are this many spacings wide: four particles each.
const CELL: Real = 2.0;
/// Part of the density error of a cell that the grid takes away in one substep, by moves alone.
const DENSITY_RELAXATION: Real = 0.06;
/// Solver steps for the position correction. It is small, and the residual is left to the next substep. With one step
/// the residual changes the momentum (2e-5 of that of a drop drawn out).
const STEPS_OF_MOVES: u32 = 2;
/// Limit of the displacement by the grid in one substep [spacings].
const FARTHEST: Real = 0.1;

/// The coarse projection of a scene of one liquid.
pub(crate) struct PressureGrid {
    spacing: Real,
    /// Steps of the solver for the pressure.
    steps: u32,
    lattice: Lattice,
    openings: Openings,
    transfer: Transfer,
    system: System,
    multigrid: Multigrid,
}

impl PressureGrid {
    /// For particles of this spacing [m], with this many steps of the solver for the pressure.
    pub(crate) fn new(spacing: Real, steps: u32) -> Self {
        PressureGrid {
            spacing,
            steps,
            lattice: Lattice::new(CELL * spacing),
            openings: Openings::default(),
            transfer: Transfer::default(),
            system: System::default(),
            multigrid: Multigrid::default(),
        }
    }

    /// Changes the velocities of predicted particles by the pressure of the grid, and moves them along.
    pub(crate) fn project(&mut self, particles: &mut Particles, walls: &Walls, dt: Real, parallelism: Parallelism) {
        let area = self.spacing * self.spacing;
        self.lattice.cover(particles, walls, parallelism);
        if self.openings.measure(&self.lattice, walls, parallelism) {
            self.multigrid.allocate(&self.lattice, &self.openings, parallelism);
            self.system.allocate(self.lattice.len());
        } else {
            self.system.clear(self.multigrid.spans());
        }
        self.transfer.gather(&self.lattice, particles, area, parallelism);
        let (lattice, openings, fields) = (&self.lattice, &self.openings, self.transfer.fields());
        let (system, multigrid) = (&mut self.system, &mut self.multigrid);
        system.read_surface(lattice, openings, fields, parallelism);
        let finest = multigrid.finest(&system.depth);
        system.couple(lattice, openings, finest, parallelism);
        multigrid.coarsen(parallelism);
        system.read_flow(fields, multigrid.spans(), parallelism);
        system.assemble_right_side(lattice, openings, fields, (dt, DENSITY_RELAXATION), multigrid.spans(), parallelism);
        multigrid.solve(&system.divergence, &mut system.pressure, self.steps, parallelism);
        multigrid.solve(&system.excess, &mut system.potential, STEPS_OF_MOVES, parallelism);
        system.difference(lattice, openings, multigrid.spans(), parallelism);
        self.push(particles, dt, parallelism);
    }

    /// Takes the changes of the faces to the particles.
    fn push(&self, particles: &mut Particles, dt: Real, parallelism: Parallelism) {
        let (lattice, system, farthest) = (&self.lattice, &self.system, FARTHEST * self.spacing);
        let (inverse_masses, starts) = (&particles.inverse_mass, &particles.start);
        let rows = particles.dense();
        let (velocities, remainders) = (&mut particles.velocity[..rows], &mut particles.remainder[..rows]);
        let (displacements, positions) = (&mut particles.displacement[..rows], &mut particles.position[..rows]);
        parallelism.chunks4(velocities, remainders, displacements, positions, |first, velocity, remainder, u, x| {
            let (count, felt) = (velocity.len(), system.felt(lattice));
            let (inverse_masses, starts) = (&inverse_masses[first..][..count], &starts[first..][..count]);
            let (remainder, u, x) = (&mut remainder[..count], &mut u[..count], &mut x[..count]);
            for k in 0..count {
                let (change, shift) = felt.at(starts[k]);
                if inverse_masses[k] > 0.0 {
                    velocity[k] += change;
                    u[k] = velocity[k] * dt;
                    remainder[k] += shift.clamp(Vector::splat(-farthest), Vector::splat(farthest));
                    x[k] = displaced(starts[k], u[k], remainder[k]);
                }
            }
        });
    }

    /// Adds the pressure of the grid to the multipliers, in their unit: `per_pressure` each, over the inverse mass.
    pub(crate) fn add_pressure(
        &self,
        particles: &mut Particles,
        dt: Real,
        per_pressure: Real,
        parallelism: Parallelism,
    ) {
        let (lattice, openings, system) = (&self.lattice, &self.openings, &self.system);
        let starts = &particles.start;
        let (rows, inverse_masses) = (particles.dense(), &particles.inverse_mass);
        let factor = per_pressure * lattice.cell / dt;
        parallelism.update(&mut particles.multiplier[..rows], |row, multiplier| {
            if inverse_masses[row] > 0.0 {
                *multiplier += system.pressure_at(lattice, openings, starts[row]) * factor / inverse_masses[row];
            }
        });
    }

    /// Impulse of the grid pressure on the measured walls in this substep [kg m/s].
    pub(crate) fn push_walls(&self, particles: &Particles, walls: &Walls, impulses: &mut [Vector64]) {
        let Some(inverse_mass) = particles.inverse_mass[..particles.dense()].iter().find(|inverse| **inverse > 0.0)
        else {
            return;
        };
        let mass = CELL * CELL / inverse_mass;
        self.system.closed_faces(&self.lattice, &self.openings, |place, outward, push| {
            let facing = |hit: &Hit| -hit.normal.dot(outward);
            let walls = walls.touches(place, self.lattice.cell).filter(|hit| facing(hit) > 0.5);
            if let Some(wall) = walls.max_by(|a, b| facing(a).total_cmp(&facing(b))).and_then(|hit| hit.measured) {
                impulses[usize::from(wall)] += wide(outward * (push * mass));
            }
        });
    }

    /// Memory held [bytes].
    pub(crate) fn memory_bytes(&self) -> usize {
        self.openings.memory_bytes()
            + self.transfer.memory_bytes()
            + self.system.memory_bytes()
            + self.multigrid.memory_bytes()
    }
}

/// Makes a column of this many cells, all zero.
fn renew<T: Default + Clone>(column: &mut Vec<T>, cells: usize) {
    column.clear();
    column.resize(cells, T::default());
}

/// Memory held by columns [bytes].
fn held_by(columns: &[&Vec<Real>]) -> usize {
    columns.iter().map(|column| held(column)).sum()
}
