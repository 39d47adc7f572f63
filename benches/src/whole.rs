//! A whole step, sort and list included, against the same step in plain scalar code.

use unipbd_core::kernel::WendlandC2;
use unipbd_core::neighbors::{Grid, NeighborList};
use unipbd_core::parallel::Parallelism;
use unipbd_core::passes::{DensityInput, DensityOutput, Pairs, Records, Weights, correction, density, xsph};
use unipbd_core::periodic::Periodic;
use unipbd_core::{Real, Vector};

/// Density iterations per step.
const ITERATIONS: usize = 4;

/// Columns of a step.
pub struct Step {
    radius: Real,
    grid: Grid,
    list: NeighborList,
    x: Vec<Vector>,
    value: Vec<Real>,
    response: Vec<Real>,
    gradient: Vec<Vector>,
    records: Records,
    out: Vec<Vector>,
}

impl Step {
    /// Room for this many rows.
    pub fn new(rows: usize, radius: Real) -> Step {
        let (numbers, vectors) = (vec![0.0; rows], vec![Vector::ZERO; rows]);
        Step {
            radius,
            grid: Grid::new(Periodic::NONE),
            list: NeighborList::default(),
            x: vectors.clone(),
            value: numbers.clone(),
            response: numbers,
            gradient: vectors.clone(),
            records: Records::default(),
            out: vectors,
        }
    }

    /// Sort, list, iterations of density and correction, viscosity: by the passes of unipbd.
    pub fn ours(&mut self, x: &[Vector], v: &[Vector], parallelism: Parallelism) {
        let order = self.grid.order(x, x.len(), self.radius, parallelism);
        parallelism.gather(&mut self.x, x, order);
        self.list.build(&self.grid, &self.x, self.radius, parallelism);
        let pairs = Pairs::new(&self.list, Periodic::NONE, parallelism);
        let kernel = WendlandC2::new(f64::from(self.radius));
        for _ in 0..ITERATIONS {
            let input = DensityInput {
                positions: &self.x,
                gradient_positions: None,
                weights: Weights::Uniform(1.0),
                unit: 1.0,
            };
            let (value, gradient, response) = (&mut self.value[..], &mut self.gradient[..], &mut self.response[..]);
            density(pairs, kernel, input, DensityOutput { value, gradient, response });
            correction(pairs, kernel, &self.x, &self.value, &mut self.records, &mut self.out);
        }
        xsph(pairs, kernel, &self.x, v, Weights::Uniform(1.0), &mut self.records, &mut self.out);
    }
}

/// The same in scalar loops over vectors and a compressed list.
pub struct ScalarStep {
    radius: Real,
    ends: Vec<u32>,
    order: Vec<u32>,
    x: Vec<Vector>,
    starts: Vec<u32>,
    entries: Vec<u32>,
    value: Vec<Real>,
    response: Vec<Real>,
    gradient: Vec<Vector>,
    out: Vec<Vector>,
}

impl ScalarStep {
    /// Room for this many rows.
    pub fn new(rows: usize, radius: Real) -> ScalarStep {
        let (numbers, vectors) = (vec![0.0; rows], vec![Vector::ZERO; rows]);
        ScalarStep {
            radius,
            ends: Vec::new(),
            order: vec![0; rows],
            x: vectors.clone(),
            starts: Vec::new(),
            entries: Vec::new(),
            value: numbers.clone(),
            response: numbers,
            gradient: vectors.clone(),
            out: vectors,
        }
    }

    /// One step.
    pub fn run(&mut self, x: &[Vector], v: &[Vector]) {
        let columns = self.sort(x);
        self.list(columns);
        for _ in 0..ITERATIONS {
            self.density();
            self.correction();
        }
        self.xsph(v);
    }

    fn cell(&self, x: Vector) -> (usize, usize) {
        let at = |x: Real| (x / self.radius + 2.0).max(1.0) as usize;
        (at(x.x), at(x.y))
    }

    /// Counting sort by cells as wide as the radius; returns their number in a row.
    fn sort(&mut self, x: &[Vector]) -> usize {
        let (mut columns, mut rows) = (0, 0);
        for &x in x {
            let (column, row) = self.cell(x);
            (columns, rows) = (columns.max(column + 2), rows.max(row + 2));
        }
        self.ends.clear();
        self.ends.resize(columns * rows + 1, 0);
        for &x in x {
            let (column, row) = self.cell(x);
            self.ends[row * columns + column + 1] += 1;
        }
        for cell in 0..columns * rows {
            self.ends[cell + 1] += self.ends[cell];
        }
        for (row_of_x, &place) in x.iter().enumerate() {
            let (column, row) = self.cell(place);
            let slot = &mut self.ends[row * columns + column];
            self.order[*slot as usize] = row_of_x as u32;
            *slot += 1;
        }
        for (x_out, &from) in self.x.iter_mut().zip(&self.order) {
            *x_out = x[from as usize];
        }
        columns
    }

    fn list(&mut self, columns: usize) {
        self.starts.clear();
        self.entries.clear();
        self.starts.push(0);
        for (i, &x) in self.x.iter().enumerate() {
            let (column, row) = self.cell(x);
            for row in row - 1..=row + 1 {
                // `ends` has moved on by the sort: it holds the end of each cell.
                let first = row * columns + column - 1;
                let (from, to) = (if first == 0 { 0 } else { self.ends[first - 1] }, self.ends[first + 2]);
                for j in from..to {
                    let apart = x - self.x[j as usize];
                    if apart.length_squared() < self.radius * self.radius && j as usize != i {
                        self.entries.push(j);
                    }
                }
            }
            self.starts.push(self.entries.len() as u32);
        }
    }

    fn neighbors(&self, row: usize) -> &[u32] {
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    /// (1 - q) of a pair, its q and difference.
    #[inline(always)]
    fn pair(&self, i: usize, j: u32) -> (Real, Real, Vector) {
        let apart = self.x[i] - self.x[j as usize];
        let q = apart.length() * (1.0 / self.radius);
        ((1.0 - q).max(0.0), q, apart)
    }

    fn density(&mut self) {
        for i in 0..self.x.len() {
            let (mut s, mut g, mut q2) = (0.0, Vector::ZERO, 0.0);
            for &j in self.neighbors(i) {
                let (t, q, apart) = self.pair(i, j);
                let t3 = t * t * t;
                s += t3 * t * (1.0 + 4.0 * q);
                g += apart * t3;
                q2 += t3 * t3 * apart.length_squared();
            }
            (self.value[i], self.gradient[i], self.response[i]) = (s, g, q2);
        }
    }

    fn correction(&mut self) {
        for i in 0..self.x.len() {
            let mut sum = Vector::ZERO;
            for &j in self.neighbors(i) {
                let (t, _, apart) = self.pair(i, j);
                sum += apart * (t * t * t * (self.value[i] + self.value[j as usize]));
            }
            self.out[i] = sum;
        }
    }

    fn xsph(&mut self, v: &[Vector]) {
        for i in 0..self.x.len() {
            let mut sum = Vector::ZERO;
            for &j in self.neighbors(i) {
                let (t, q, _) = self.pair(i, j);
                sum += (v[j as usize] - v[i]) * ((t * t) * (t * t) * (1.0 + 4.0 * q));
            }
            self.out[i] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lattice;
    use unipbd_core::kernel::Shape;

    #[test]
    fn both_steps_list_the_same_pairs_and_find_the_same_densities() {
        let (rows, radius) = (2500, 2.0);
        let set = Lattice::new(rows, radius);
        let (mut ours, mut scalar) = (Step::new(rows, radius), ScalarStep::new(rows, radius));
        ours.ours(&set.x, &set.v, Parallelism::Serial);
        scalar.run(&set.x, &set.v);
        assert_eq!(ours.list.pairs() as usize, scalar.entries.len());
        let sum = |values: &[Real], scale: f64| values.iter().map(|&value| f64::from(value) * scale).sum::<f64>();
        let scale = f64::from(WendlandC2::new(f64::from(radius)).value_scale());
        let (found, expected) = (sum(&ours.value, 1.0), sum(&scalar.value, scale));
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} for {expected}");
    }
}
