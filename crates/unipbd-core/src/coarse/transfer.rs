//! From particles to the nodes of the grid, and back to any place.

use super::lattice::{CENTRES, LEFT_FACES, LOWER_FACES, Lattice, Nodes};
use crate::bytes::held;
use crate::math::{Real, larger, smaller};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::particles::Particles;
use std::ops::Range;

/// Rows that one task spreads, and most tasks: fixed, so that sums do not depend on the number of threads.
const TASK_ROWS: usize = 16 * CHUNK_ROWS;
const MOST_TASKS: usize = 32;
/// Density errors below this are those of a surface, not of a gap.
const SURFACE: Real = -0.04;

/// Sums of the particles at the nodes of a grid: a value times weights, and the weights.
pub(super) type Sums = Vec<[Real; 2]>;

/// What the particles give to the grid.
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
    /// Density error at centres; the weights are what of the cell is filled.
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
        parallelism.each(rows, &mut self.tasks, |_, task| task.spread(lattice, particles, filled));
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

/// Adds up what all tasks found for the cells from `first` on.
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
    fn spread(&mut self, lattice: &Lattice, particles: &Particles, filled: Real) {
        let (places, velocities) = (&particles.start[self.rows.clone()], &particles.velocity[self.rows.clone()]);
        let errors = &particles.density_error[self.rows.clone()];
        let (mut low, mut high) = (lattice.height as Real, 0.0);
        for x in places {
            let y = lattice.place(*x).y;
            (low, high) = (smaller(y, low), larger(y, high));
        }
        let (low, high) = (larger(low, 0.0), smaller(high, lattice.height as Real - 1.0));
        self.cells = if low <= high { lattice.cells_between(low, high) } else { 0..0 };
        let (fields, first, stride) = (&mut self.fields, self.cells.start, lattice.stride());
        for sums in [&mut fields.left, &mut fields.lower, &mut fields.centre] {
            sums.clear();
            sums.resize(self.cells.len(), [0.0; 2]);
        }
        for ((&x, velocity), &error) in places.iter().zip(velocities).zip(errors) {
            let place = lattice.place(x);
            if lattice.holds(place) {
                let error = if error > SURFACE { error } else { 0.0 };
                add(&mut fields.left, first, stride, lattice.nodes(place, LEFT_FACES), [velocity.x, 1.0]);
                add(&mut fields.lower, first, stride, lattice.nodes(place, LOWER_FACES), [velocity.y, 1.0]);
                add(&mut fields.centre, first, stride, lattice.nodes(place, CENTRES), [error * filled, filled]);
            }
        }
    }
}

/// Adds a value and its weight to the four nodes around a place.
#[inline(always)]
fn add(sums: &mut [[Real; 2]], first: usize, stride: usize, nodes: Nodes, value: [Real; 2]) {
    let at = nodes.first - first;
    let [a, b, c, d] = nodes.weights;
    let mut pair = |at: usize, left: Real, right: Real| {
        let pair: &mut [[Real; 2]] = &mut sums[at..at + 2];
        pair[0] = [pair[0][0] + left * value[0], pair[0][1] + left * value[1]];
        pair[1] = [pair[1][0] + right * value[0], pair[1][1] + right * value[1]];
    };
    pair(at, a, b);
    pair(at + stride, c, d);
}

/// The weighted mean at a node; 0 where nothing weighs.
#[inline(always)]
pub(super) fn mean([value, weight]: [Real; 2]) -> Real {
    if weight > 0.0 { value / weight } else { 0.0 }
}

/// A field at a place.
#[inline(always)]
pub(super) fn interpolate(field: &[[Real; 4]], stride: usize, nodes: Nodes) -> [Real; 4] {
    let (low, high) = (&field[nodes.first..][..2], &field[nodes.first + stride..][..2]);
    let [a, b, c, d] = nodes.weights;
    let mut out = [0.0; 4];
    for n in 0..4 {
        out[n] = (low[0][n] * a + low[1][n] * b) + (high[0][n] * c + high[1][n] * d);
    }
    out
}
