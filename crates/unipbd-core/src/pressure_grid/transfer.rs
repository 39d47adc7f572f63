//! Transfer from particles to grid nodes, and interpolation from grid nodes to any point.

use super::lattice::{Lattice, Nodes};
use super::mixture::Mixture;
use super::{held_by, renew};
use crate::bytes::held;
use crate::math::{Quad, Real, Vector, larger, smaller};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::particles::Particles;
use crate::phase::Phase;
use std::ops::Range;

/// Rows per task, and the maximum number of tasks: fixed, so that sums do not depend on the number of threads.
const TASK_ROWS: usize = 16 * CHUNK_ROWS;
const MOST_TASKS: usize = 32;

/// Sums of the particles at the nodes of a grid: a value times weights, and the weights.
pub(super) type Sums = Vec<[Real; 2]>;

/// Weighted sums of the particles at the grid nodes.
#[derive(Default)]
pub(super) struct Transfer {
    tasks: Vec<Task>,
    fields: Fields,
}

/// Sums by cell.
#[derive(Default)]
pub(super) struct Fields {
    /// Velocity along x at left faces; the weights are masses over that of the heaviest fluid.
    pub left: Sums,
    /// Velocity along y at lower faces.
    pub lower: Sums,
    /// Density error at centres; the weights are the filled fraction of the cell.
    pub centre: Sums,
    /// Number of particles at left and lower faces; empty where all have one mass.
    pub number: [Vec<Real>; 2],
    /// Filled fraction of the cell by fluids that fill their domain, less that by fluids with a surface; empty where
    /// all have one.
    pub filling: Vec<Real>,
}

/// Rows that are spread by one task, and the sums in the cells they reach.
#[derive(Default)]
struct Task {
    rows: Range<usize>,
    cells: Range<usize>,
    fields: Fields,
}

impl Transfer {
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// Spreads velocities, density errors and areas [m^2] of all dense particles.
    pub fn gather(
        &mut self,
        lattice: &Lattice,
        particles: &Particles,
        (mixture, area): (&Mixture, Real),
        parallelism: Parallelism,
    ) {
        let rows = particles.dense();
        let tasks = rows.div_ceil(TASK_ROWS).clamp(1, MOST_TASKS);
        let per_task = rows.div_ceil(tasks);
        self.tasks.resize_with(tasks, Task::default);
        for (k, task) in self.tasks.iter_mut().enumerate() {
            task.rows = (k * per_task).min(rows)..((k + 1) * per_task).min(rows);
        }
        let filled = area / (lattice.cell * lattice.cell);
        if let [alone] = &mut self.tasks[..] {
            alone.spread(lattice, 0..lattice.len(), particles, (mixture, filled));
            return std::mem::swap(&mut alone.fields, &mut self.fields);
        }
        parallelism.each(rows, &mut self.tasks, |_, task| {
            let cells = task.reached(lattice, particles);
            task.spread(lattice, cells, particles, (mixture, filled));
        });
        let (tasks, fields) = (&self.tasks, &mut self.fields);
        for sums in [&mut fields.left, &mut fields.lower, &mut fields.centre] {
            sums.resize(lattice.len(), [0.0; 2]);
        }
        let (left, lower, centre) = (&mut fields.left, &mut fields.lower, &mut fields.centre);
        parallelism.chunks3(left, lower, centre, |first, left, lower, centre| {
            add_up(tasks, first, left, |fields| &fields.left);
            add_up(tasks, first, lower, |fields| &fields.lower);
            add_up(tasks, first, centre, |fields| &fields.centre);
        });
        if !mixture.simple {
            fields.add_up_mixture(tasks, lattice.len(), parallelism);
        }
    }

    /// Adds matter that is no particle and brings no velocity: squares of this area at some places \[m], [m^2].
    pub fn fill(&mut self, lattice: &Lattice, places: &[Vector], area: Real) {
        let (stride, filled) = (lattice.stride(), area / (lattice.cell * lattice.cell));
        for &x in places {
            let place = lattice.place(x);
            if lattice.holds(place) {
                add(&mut self.fields.centre, 0, stride, lattice.around(place).centre, [0.0, filled]);
            }
        }
    }

    /// Adds the sums on both sides of periodic axes.
    pub fn join_images(&mut self, lattice: &Lattice) {
        let (images, stride, fields) = (lattice.images, lattice.stride(), &mut self.fields);
        [&mut fields.left, &mut fields.lower, &mut fields.centre]
            .into_iter()
            .for_each(|sums| images.fold(sums, stride));
        let [left, lower] = &mut fields.number;
        let of_mixture = [left, lower, &mut fields.filling].into_iter().filter(|column| !column.is_empty());
        of_mixture.for_each(|column| images.fold(column, stride));
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        self.tasks.iter().map(|task| task.fields.memory_bytes()).sum::<usize>() + self.fields.memory_bytes()
    }
}

/// Adds up the sums of all tasks for the cells from `first` on.
fn add_up<T: Default + Copy + Add>(tasks: &[Task], first: usize, out: &mut [T], of: impl Fn(&Fields) -> &[T]) {
    out.fill(T::default());
    for task in tasks {
        let (start, end) = (task.cells.start.max(first), task.cells.end.min(first + out.len()));
        if start < end {
            let found = &of(&task.fields)[start - task.cells.start..end - task.cells.start];
            for (sum, found) in out[start - first..end - first].iter_mut().zip(found) {
                *sum = sum.plus(*found);
            }
        }
    }
}

/// A value type of columns of sums.
pub(super) trait Add {
    fn plus(self, other: Self) -> Self;
}

impl Add for Real {
    fn plus(self, other: Self) -> Self {
        self + other
    }
}

impl Add for [Real; 2] {
    fn plus(self, other: Self) -> Self {
        [self[0] + other[0], self[1] + other[1]]
    }
}

impl Fields {
    /// Makes all columns of this many cells, all zero; those of a mixture only where there is one.
    fn renew(&mut self, cells: usize, mixed: bool) {
        [&mut self.left, &mut self.lower, &mut self.centre].into_iter().for_each(|sums| renew(sums, cells));
        let [left, lower] = &mut self.number;
        let cells = if mixed { cells } else { 0 };
        [left, lower, &mut self.filling].into_iter().for_each(|column| renew(column, cells));
    }

    /// Adds up the columns of a mixture.
    fn add_up_mixture(&mut self, tasks: &[Task], cells: usize, parallelism: Parallelism) {
        let ([left, lower], filling) = (&mut self.number, &mut self.filling);
        [&mut *left, &mut *lower, &mut *filling].into_iter().for_each(|column| column.resize(cells, 0.0));
        parallelism.chunks3(left, lower, filling, |first, left, lower, filling| {
            add_up(tasks, first, left, |fields| &fields.number[0]);
            add_up(tasks, first, lower, |fields| &fields.number[1]);
            add_up(tasks, first, filling, |fields| &fields.filling);
        });
    }

    fn memory_bytes(&self) -> usize {
        held(&self.left)
            + held(&self.lower)
            + held(&self.centre)
            + held_by(&[&self.number[0], &self.number[1], &self.filling])
    }
}

impl Task {
    /// The cells that can receive contributions from its rows.
    fn reached(&self, lattice: &Lattice, particles: &Particles) -> Range<usize> {
        let (mut low, mut high) = (lattice.height as Real, 0.0);
        for x in &particles.start[self.rows.clone()] {
            let y = lattice.place(*x).y;
            (low, high) = (smaller(y, low), larger(y, high));
        }
        let (low, high) = (larger(low, 0.0), smaller(high, lattice.height as Real - 1.0));
        if low <= high { lattice.cells_between(low, high) } else { 0..0 }
    }

    fn spread(
        &mut self,
        lattice: &Lattice,
        cells: Range<usize>,
        particles: &Particles,
        (mixture, filled): (&Mixture, Real),
    ) {
        self.fields.renew(cells.len(), !mixture.simple);
        self.cells = cells;
        match mixture.simple {
            true => self.spread_simple(lattice, particles, (mixture, filled)),
            false => self.spread_mixed(lattice, particles, (mixture, filled)),
        }
    }

    /// All rows have one mass and a free surface.
    fn spread_simple(&mut self, lattice: &Lattice, particles: &Particles, (mixture, filled): (&Mixture, Real)) {
        let (places, velocities) = (&particles.start[self.rows.clone()], &particles.velocity[self.rows.clone()]);
        let errors = &particles.density_error[self.rows.clone()];
        let (fields, first, stride) = (&mut self.fields, self.cells.start, lattice.stride());
        let (lattice, role) = (*lattice, mixture.roles[0]);
        let [left, lower, centre] = [&mut fields.left, &mut fields.lower, &mut fields.centre].map(Vec::as_mut_slice);
        for ((&x, velocity), &error) in places.iter().zip(velocities).zip(errors) {
            let place = lattice.place(x);
            if lattice.holds(place) {
                let around = lattice.around(place);
                add(left, first, stride, around.left, [velocity.x, 1.0]);
                add(lower, first, stride, around.lower, [velocity.y, 1.0]);
                add(centre, first, stride, around.centre, [role.error(error) * filled, filled]);
            }
        }
    }

    /// Rows of several masses; samples of rigid bodies fill their cells, and bring no velocity.
    fn spread_mixed(&mut self, lattice: &Lattice, particles: &Particles, (mixture, filled): (&Mixture, Real)) {
        let (first, stride, lattice) = (self.cells.start, lattice.stride(), *lattice);
        let Fields { left, lower, centre, number: [number_left, number_lower], filling } = &mut self.fields;
        for row in self.rows.clone() {
            let place = lattice.place(particles.start[row]);
            if !lattice.holds(place) {
                continue;
            }
            let around = lattice.around(place);
            let (inverse_mass, velocity) = (particles.inverse_mass[row], particles.velocity[row]);
            let role = mixture.roles[usize::from(particles.material[row])];
            if particles.phase[row] == Phase::Rigid && inverse_mass == 0.0 {
                add(centre, first, stride, around.centre, [0.0, filled]);
                continue;
            }
            let mass = match particles.phase[row] {
                Phase::Rigid => 1.0 / (inverse_mass * mixture.heaviest),
                _ => role.mass,
            };
            let error = role.error(particles.density_error[row]);
            add(left, first, stride, around.left, [mass * velocity.x, mass]);
            add(lower, first, stride, around.lower, [mass * velocity.y, mass]);
            add(centre, first, stride, around.centre, [error * filled, filled]);
            count(number_left, first, stride, around.left, 1.0);
            count(number_lower, first, stride, around.lower, 1.0);
            count(filling, first, stride, around.centre, filled * role.filling);
        }
    }
}

/// Adds a weight to the four nodes around a place.
#[inline(always)]
fn count(sums: &mut [Real], first: usize, stride: usize, nodes: Nodes, weight: Real) {
    let at = nodes.first - first;
    let parts = nodes.weights();
    for (node, part) in [at, at + 1, at + stride, at + stride + 1].into_iter().zip(parts) {
        sums[node] += part * weight;
    }
}

/// Adds a value and its weight to the four nodes around a place.
#[inline(always)]
fn add(sums: &mut [[Real; 2]], first: usize, stride: usize, nodes: Nodes, [value, weight]: [Real; 2]) {
    let (at, left) = (nodes.first - first, 1.0 - nodes.right);
    let added = Quad::new(left, left, nodes.right, nodes.right) * Quad::new(value, weight, value, weight);
    let mut pair = |at: usize, part: Real| {
        let pair = sums[at..at + 2].as_flattened_mut();
        (Quad::from_slice(pair) + added * part).write_to_slice(pair);
    };
    pair(at, 1.0 - nodes.up);
    pair(at + stride, nodes.up);
}

/// The weighted mean at a node; 0 if the weight is zero.
#[inline(always)]
pub(super) fn mean([value, weight]: [Real; 2]) -> Real {
    if weight > 0.0 { value / weight } else { 0.0 }
}

/// A field at a place.
#[inline(always)]
pub(super) fn interpolate(field: &[Quad], stride: usize, nodes: Nodes) -> Quad {
    let along = |at: usize| {
        let pair = &field[at..at + 2];
        pair[0] * (1.0 - nodes.right) + pair[1] * nodes.right
    };
    along(nodes.first) * (1.0 - nodes.up) + along(nodes.first + stride) * nodes.up
}
