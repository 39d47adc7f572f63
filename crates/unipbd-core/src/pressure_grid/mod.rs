//! The pressure grid: before the particle pass, a grid of cells two spacings wide carries the smooth part of the
//! pressure of fluids and bodies, and the multipliers of the particles hold only the remainder. The number of substeps
//! then follows from the speed alone, not from the depth.
//!
//! A staggered grid (Harlow & Welch 1965) gives changes of velocity to the particles (Brackbill & Ruppel 1986), with
//! ghost pressures at the free surface (Gibou et al. 2002) and parts of faces at walls (Batty et al. 2007). A second
//! solution of the same system moves particles, without their velocities, out of cells that are too full. Nothing is
//! kept from one substep to the next: a saved run goes on bit for bit.

mod air;
mod bound;
mod chords;
mod components;
mod couplings;
mod felt;
mod flow;
mod images;
mod lattice;
mod level;
mod mixture;
mod momentum;
mod multigrid;
mod openings;
mod readings;
mod solids;
mod spans;
mod surface;
mod system;
mod transfer;

use crate::bytes::held;
use crate::constraints::GRID_VELOCITY_SHARE;
use crate::math::{Real, Vector, Vector64, vector, wide};
use crate::parallel::Parallelism;
use crate::particles::{Particles, displaced};
use crate::periodic::{Periodic, PeriodicAxis};
use crate::rigid::{Bodies, Twist};
use crate::scene::CELL;
use crate::walls::{Moment, Outlines, Walls};
pub(crate) use bound::PressureBound;
use components::Components;
use couplings::Couplings;
use lattice::Lattice;
use level::Level;
pub(crate) use mixture::Mixture;
use momentum::{momentum, slow_down};
pub(crate) use multigrid::Accuracy;
use multigrid::{Multigrid, Problem};
use openings::Openings;
pub(crate) use solids::Immersed;
use solids::{Solids, Units, twist};
use system::System;
use transfer::Transfer;

/// Part of the density error of a cell that the grid takes away in one frame, by moves alone.
const DENSITY_RELAXATION: f64 = 0.06;
/// Tolerance of the moves over that of the pressure: they are small, and the residual is left to the next substep. With
/// one step the residual changes the momentum (2e-5 of that of a drop drawn out).
const LOOSER_MOVES: f64 = 5.0;
/// Places per cell at which the pressure on a wall is read.
const STEPS_PER_CELL: Real = 4.0;
/// Limit of the displacement by the grid in one substep \[spacings].
const FARTHEST: Real = 0.1;

/// The pressure grid of a scene.
pub(crate) struct PressureGrid {
    spacing: Real,
    mixture: Mixture,
    accuracy: Accuracy,
    frame_time: f64,
    lattice: Lattice,
    openings: Openings,
    transfer: Transfer,
    system: System,
    multigrid: Multigrid,
    components: Components,
    solids: Solids,
    /// Couplings of the fluid, without those that stand for bodies: only where there are bodies.
    fluid: Couplings,
    /// Places of matter that is no particle: each fills the square of a spacing.
    filled: Vec<Vector>,
}

impl PressureGrid {
    /// For particles of this spacing \[m], with this accuracy of the pressure, and frames of this length \[s]. Along periodic
    /// axes there are `periods` cells.
    pub(crate) fn new(
        spacing: Real,
        (periods, periodic): ([usize; 2], Periodic),
        (mixture, accuracy): (Mixture, Accuracy),
        frame_time: f64,
    ) -> Self {
        let of_period = |axis: Option<PeriodicAxis>, cells: usize| axis.map(|axis| axis.length / cells as Real);
        let cell =
            of_period(periodic.x, periods[0]).or(of_period(periodic.y, periods[1])).unwrap_or(CELL as Real * spacing);
        PressureGrid {
            spacing,
            mixture,
            accuracy,
            frame_time,
            lattice: Lattice::new(cell, (periods, periodic)),
            openings: Openings::default(),
            transfer: Transfer::default(),
            system: System::default(),
            multigrid: Multigrid::default(),
            components: Components::default(),
            solids: Solids::default(),
            fluid: Couplings::default(),
            filled: Vec::new(),
        }
    }

    /// Mass of a cell that the heaviest fluid fills \[kg].
    fn cell_mass(&self) -> Real {
        let width = self.lattice.cell / self.spacing;
        width * width * self.mixture.heaviest
    }

    /// The places of matter in bodies that are no particles, to be written before a projection \[m].
    pub(crate) fn filled_mut(&mut self) -> &mut Vec<Vector> {
        &mut self.filled
    }

    /// Changes the velocities of predicted particles and bodies by the pressure of the grid, and moves them along; nothing
    /// where there are bodies and the pressure exceeds its bound. Whether it was done.
    pub(crate) fn project(
        &mut self,
        particles: &mut Particles,
        (walls, outlines, bodies): (&Walls, &Outlines, Option<Immersed<'_>>),
        (dt, bound): (f64, PressureBound),
        parallelism: Parallelism,
    ) -> bool {
        self.assemble(particles, (walls, outlines, bodies.as_ref()), dt, parallelism);
        self.solve(self.accuracy, true, parallelism);
        if self.solids.any() && self.largest(parallelism) / dt > bound.limit(self.lattice.longest(), dt) {
            return false;
        }
        self.solve(Accuracy { tolerance: LOOSER_MOVES * self.accuracy.tolerance, ..self.accuracy }, false, parallelism);
        let (system, multigrid) = (&mut self.system, &mut self.multigrid);
        if !self.mixture.fills {
            let liquid = (multigrid.spans(), self.lattice.stride());
            system.end_suction(&self.openings, &self.components, liquid, parallelism);
        }
        system.join_solutions(&self.lattice);
        system.difference(&self.lattice, &self.openings, multigrid.spans(), parallelism);
        if self.openings.boundless && self.system.is_full(&self.lattice) {
            self.system.keep_momentum(&self.lattice, self.transfer.fields());
        }
        let alone = walls.is_empty() && outlines.is_empty() && self.components.are_one();
        let free = |of: &Immersed<'_>| of.mobilities.are_free(of.bodies.inverse_masses());
        let kept = (alone && bodies.as_ref().is_none_or(free)).then(|| momentum(particles, parallelism));
        self.push(particles, dt as Real, parallelism);
        let mut pushed = Vector64::ZERO;
        if let Some(immersed) = bodies {
            pushed = self.push_bodies(immersed.bodies, particles.asleep() > 0, dt);
        }
        if let Some((before, mass)) = kept.filter(|(_, mass)| *mass > 0.0) {
            let gained = momentum(particles, parallelism).0 + pushed - before;
            slow_down(particles, vector(gained / mass), dt as Real, parallelism);
        }
        self.system.set_constants(&self.lattice, &self.openings, &self.components);
        self.system.join_solutions(&self.lattice);
        true
    }

    /// Solves for the pressure, or for the moves.
    fn solve(&mut self, accuracy: Accuracy, of_pressure: bool, parallelism: Parallelism) {
        let system = &mut self.system;
        let mut solution = std::mem::take(if of_pressure { &mut system.pressure } else { &mut system.potential });
        let right_side = if of_pressure { &system.divergence } else { &system.excess };
        let problem =
            Pressed { accuracy, system, components: &self.components, solids: &self.solids, fluid: &self.fluid };
        self.multigrid.solve(right_side, &mut solution, &problem, parallelism);
        *(if of_pressure { &mut system.pressure } else { &mut system.potential }) = solution;
    }

    /// Largest pressure over density, times the substep [m^2/s].
    fn largest(&self, parallelism: Parallelism) -> f64 {
        let pressure = &self.system.pressure;
        f64::from(parallelism.max(pressure.len(), |cell| pressure[cell].abs()) * self.lattice.cell)
    }

    /// Sets up both systems.
    fn assemble(
        &mut self,
        particles: &Particles,
        (walls, outlines, bodies): (&Walls, &Outlines, Option<&Immersed<'_>>),
        dt: f64,
        parallelism: Parallelism,
    ) {
        let area = self.spacing * self.spacing;
        self.lattice.cover(particles, walls, parallelism);
        if self.openings.measure(&self.lattice, (walls, outlines), parallelism) {
            self.multigrid.allocate(&self.lattice, &self.openings, parallelism);
            self.system.allocate(&self.openings);
        } else {
            self.system.clear(self.multigrid.spans());
        }
        let (lattice, openings, stride) = (&self.lattice, &self.openings, self.lattice.stride());
        self.transfer.gather(lattice, particles, (&self.mixture, area), parallelism);
        self.transfer.fill(lattice, &self.filled, area);
        self.transfer.join_images(lattice);
        let fields = self.transfer.fields();
        let cell_mass = f64::from(self.cell_mass());
        let (system, multigrid, solids) = (&mut self.system, &mut self.multigrid, &mut self.solids);
        if let Some(immersed) = bodies {
            solids.find(lattice, immersed, Units { cell_mass, dt });
            system.cover(openings, solids, stride);
        }
        system.read_surface(lattice, openings, (fields, self.mixture.fills), parallelism);
        multigrid.find(&system.depth);
        system.join_surface(lattice);
        system.read_flow(lattice, (fields, &self.mixture), multigrid.spans(), parallelism);
        if solids.any() && !self.mixture.fills {
            system.lighten(openings, fields, (lattice.cell * lattice.cell) / area);
        }
        let (spans, couplings) = multigrid.finest_couplings();
        system.couple(lattice, openings, (spans, couplings), parallelism);
        multigrid.add_up(parallelism);
        let (_, couplings) = multigrid.finest_couplings();
        if solids.any() {
            self.fluid.take(couplings);
        }
        system.mask((solids, fields), stride, &self.fluid, couplings);
        if solids.any() {
            multigrid.add_up(parallelism);
        }
        let (spans, couplings) = multigrid.finest_couplings();
        self.components.find(couplings, spans, (lattice.images, stride));
        multigrid.coarsen(parallelism);
        let taken_back = (DENSITY_RELAXATION * dt / self.frame_time) as Real;
        let rates = (dt as Real, taken_back);
        system.assemble_right_side(lattice, openings, fields, rates, (solids, multigrid.spans()), parallelism);
    }

    /// Loads the bodies with the pressure of the grid, and moves them with the fluid around them. Bodies that sleep with
    /// their fluid keep their load. Returns the momentum that they gained [kg m/s].
    fn push_bodies(&mut self, bodies: &mut Bodies, with_fluid: bool, dt: f64) -> Vector64 {
        let mut gained = Vector64::ZERO;
        let (solids, system, stride) = (&self.solids, &self.system, self.lattice.stride());
        let cell_mass = f64::from(self.cell_mass());
        let farthest = f64::from(FARTHEST * self.spacing);
        for solid in &solids.solids {
            let sleeps = with_fluid && bodies.is_asleep(solid.body);
            if solid.covers() && !sleeps {
                let [x, y, turn] = solids.load(solid, &system.pressure, stride).map(|load| load * cell_mass / dt);
                bodies.load(solid.body, Vector64::new(x, y), turn, dt);
                gained += Vector64::new(x, y) * dt;
            }
            let Twist { linear, angular } = twist(solids.change(solid, &system.potential, stride));
            bodies.shift(solid.body, linear.clamp_length_max(farthest), angular);
        }
        gained
    }

    /// Takes the changes of the faces to the particles.
    fn push(&self, particles: &mut Particles, dt: Real, parallelism: Parallelism) {
        let (lattice, system, farthest) = (&self.lattice, &self.system, FARTHEST * self.spacing);
        let (inverse_masses, starts) = (&particles.inverse_mass, &particles.start);
        let rows = particles.awake();
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

    /// Adds the pressure of the grid to that part of the multipliers that changes velocities, in their unit:
    /// `per_pressure` each, over the inverse mass. The rest moves particles alone, and is no pressure.
    pub(crate) fn add_pressure(
        &self,
        particles: &mut Particles,
        dt: Real,
        per_pressure: Real,
        parallelism: Parallelism,
    ) {
        let (lattice, openings, system) = (&self.lattice, &self.openings, &self.system);
        let starts = &particles.start;
        // Rows that sleep keep their pressure.
        let (rows, inverse_masses) = (particles.listed(), &particles.inverse_mass);
        let factor = per_pressure * lattice.cell / dt * self.mixture.heaviest;
        parallelism.update(&mut particles.multiplier[..rows], |row, multiplier| {
            if inverse_masses[row] > 0.0 {
                let of_grid = system.pressure_at(lattice, openings, starts[row]) * factor;
                *multiplier = GRID_VELOCITY_SHARE * *multiplier + of_grid;
            }
        });
    }

    /// Impulse of the grid pressure on the measured walls in this substep [kg m/s].
    pub(crate) fn push_walls(&self, walls: &Walls, impulses: &mut [Vector64]) {
        let (lattice, openings, system) = (&self.lattice, &self.openings, &self.system);
        let mass_per_length = self.cell_mass() / lattice.cell;
        walls.measured_surfaces(lattice.bounds(), |surface| {
            let [from, to] = surface.ends;
            let steps = (STEPS_PER_CELL * (to - from).length() / lattice.cell).ceil();
            let step = (to - from) / steps;
            let sum = (0..steps as usize).filter_map(|k| {
                let middle = from + step * (k as Real + 0.5);
                system.pressure_at_wall(lattice, openings, (middle, surface.normal))
            });
            let push = sum.map(f64::from).sum::<f64>() * f64::from(step.length() * mass_per_length);
            impulses[usize::from(surface.wall)] -= wide(surface.normal) * push;
        });
    }

    /// Loads the bodies of the outlines that are walls of the grid with its pressure.
    pub(crate) fn push_outlines(&self, outlines: &Outlines, bodies: &mut Bodies, dt: f64) {
        let (lattice, openings, system) = (&self.lattice, &self.openings, &self.system);
        let mass_per_length = self.cell_mass() / lattice.cell;
        outlines.fixed_surfaces(lattice.bounds(), lattice.cell / STEPS_PER_CELL, |surface| {
            let [from, to] = surface.ends;
            let steps = (STEPS_PER_CELL * (to - from).length() / lattice.cell).ceil().max(1.0);
            let step = (to - from) / steps;
            let per_pressure = f64::from(step.length() * mass_per_length) / dt;
            let (mut force, mut torque) = (Vector64::ZERO, 0.0);
            for k in 0..steps as usize {
                let middle = from + step * (k as Real + 0.5);
                let read = system.pressure_at_wall(lattice, openings, (middle, surface.normal));
                let push = -wide(surface.normal) * (f64::from(read.unwrap_or(0.0)) * per_pressure);
                force += push;
                torque += outlines.arm(surface.outline, middle, Moment::End).perp_dot(push);
            }
            if force != Vector64::ZERO || torque != 0.0 {
                bodies.load(outlines.body(surface.outline), force, torque, dt);
            }
        });
    }

    /// Memory held \[bytes].
    pub(crate) fn memory_bytes(&self) -> usize {
        self.openings.memory_bytes()
            + self.transfer.memory_bytes()
            + self.system.memory_bytes()
            + self.multigrid.memory_bytes()
            + self.components.memory_bytes()
            + self.solids.memory_bytes()
            + self.fluid.memory_bytes()
            + held(&self.filled)
    }
}

/// The system of a substep as the solver takes it.
struct Pressed<'a> {
    accuracy: Accuracy,
    system: &'a System,
    components: &'a Components,
    solids: &'a Solids,
    fluid: &'a Couplings,
}

impl Problem for Pressed<'_> {
    fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    fn constrain(&self, column: &mut [Real]) {
        if self.solids.any() {
            self.system.clear_masked(column);
        }
        self.components.remove_means(column, |cell| self.system.counts(cell));
    }

    fn image(&self, finest: &Level, (x, out): (&[Real], &mut [Real]), parallelism: Parallelism) {
        if !self.solids.any() {
            return finest.couplings.image(x, out, finest.size(), parallelism);
        }
        self.fluid.image(x, out, finest.size(), parallelism);
        self.system.clear_masked(out);
        self.solids.respond(x, out, finest.stride(), |cell| self.system.counts(cell));
    }
}

/// Makes a column of this many cells, all zero.
fn renew<T: Default + Clone>(column: &mut Vec<T>, cells: usize) {
    column.clear();
    column.resize(cells, T::default());
}

/// Memory held by columns \[bytes].
fn held_by(columns: &[&Vec<Real>]) -> usize {
    columns.iter().map(|column| held(column)).sum()
}
