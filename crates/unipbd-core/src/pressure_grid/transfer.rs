//! Transfer from particles to grid nodes, and interpolation from grid nodes to any point.

use super::lattice::{Lattice, Nodes};
use super::renew;
use crate::bytes::held;
use crate::math::{Quad, Real, larger, smaller};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::particles::Particles;
use std::ops::Range;

/// Rows per task, and the maximum number of tasks: fixed, so that sums do not depend on the number of threads.
const TASK_ROWS: usize = 16 * CHUNK_ROWS;
const MOST_TASKS: usize = 32;
/// Lower density errors than this belong to a free surface, not to a gap.
const SURFACE: Real = -0.04;

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
    /// Velocity along x at left faces.
    pub left: Sums,
    /// Velocity along y at lower faces.
    pub lower: Sums,
    /// Density error at centres; the weights are the filled fraction of the cell.
    pub centre: Sums,
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
    pub fn gather(&mut self, lattice: &Lattice, particles: &Particles, area: Real, parallelism: Parallelism) {
        let rows = particles.dense();
        let tasks = rows.div_ceil(TASK_ROWS).clamp(1, MOST_TASKS);
        let per_task = rows.div_ceil(tasks);
        self.tasks.resize_with(tasks, Task::default);
        for (k, task) in self.tasks.iter_mut().enumerate() {
            task.rows = (k * per_task).min(rows)..((k + 1) * per_task).min(rows);
        }
        let filled = area / (lattice.cell * lattice.cell);
        if let [alone] = &mut self.tasks[..] {
            alone.spread(lattice, 0..lattice.len(), particles, filled);
            return std::mem::swap(&mut alone.fields, &mut self.fields);
        }
        parallelism.each(rows, &mut self.tasks, |_, task| {
            let cells = task.reached(lattice, particles);
            task.spread(lattice, cells, particles, filled);
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
    }

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        self.tasks.iter().map(|task| task.fields.memory_bytes()).sum::<usize>() + self.fields.memory_bytes()
    }
}

/// Adds up the sums of all tasks for the cells from `first` on.
fn add_up(tasks: &[Task], first: usize, out: &mut [[Real; 2]], of: impl Fn(&Fields) -> &Sums) {
    out.fill([0.0; 2]);
    for task in tasks {
        let (start, end) = (task.cells.start.max(first), task.cells.end.min(first + out.len()));
        if start < end {
            let found = &of(&task.fields)[start - task.cells.start..end - task.cells.start];
            for (sum, found) in out[start - first..end - first].iter_mut().zip(found) {
                *sum = [sum[0] + found[0], sum[1] + found[1]];
            }
        }
    }
}

impl Fields {
    fn memory_bytes(&self) -> usize {
        held(&self.left) + held(&self.lower) + held(&self.centre)
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

    fn spread(&mut self, lattice: &Lattice, cells: Range<usize>, particles: &Particles, filled: Real) {
        self.cells = cells;
        let (places, velocities) = (&particles.start[self.rows.clone()], &particles.velocity[self.rows.clone()]);
        let errors = &particles.density_error[self.rows.clone()];
        let (fields, first, stride) = (&mut self.fields, self.cells.start, lattice.stride());
        for sums in [&mut fields.left, &mut fields.lower, &mut fields.centre] {
            renew(sums, self.cells.len());
        }
        let lattice = *lattice;
        let [left, lower, centre] = [&mut fields.left, &mut fields.lower, &mut fields.centre].map(Vec::as_mut_slice);
        for ((&x, velocity), &error) in places.iter().zip(velocities).zip(errors) {
            let place = lattice.place(x);
            if lattice.holds(place) {
                let error = if error > SURFACE { error } else { 0.0 };
                let around = lattice.around(place);
                add(left, first, stride, around.left, [velocity.x, 1.0]);
                add(lower, first, stride, around.lower, [velocity.y, 1.0]);
                add(centre, first, stride, around.centre, [error * filled, filled]);
            }
        }
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
