//! Conjugate gradients, with a cycle through ever coarser grids as the preconditioner.

use super::held_by;
use super::lattice::Lattice;
use super::system::Couplings;
use crate::bytes::held;
use crate::math::Real;
use crate::parallel::{CHUNK_ROWS, Parallelism};
use std::ops::Range;

/// Relaxation of the Jacobi sweeps: evens out best what the next grid cannot see.
const RELAXATION: Real = 0.8;
/// Sweeps before and after each coarser grid.
const SWEEPS: usize = 2;
/// Sweeps on the coarsest grid, and how many cells it has along an axis at most.
const LAST_SWEEPS: usize = 24;
const COARSEST: usize = 4;

/// Solves the system of one substep.
#[derive(Default)]
pub(super) struct Multigrid {
    levels: Vec<Level>,
    direction: Vec<Real>,
    image: Vec<Real>,
}

/// One grid.
#[derive(Default)]
struct Level {
    width: usize,
    height: usize,
    couplings: Couplings,
    /// Sum of all couplings of a cell; and the relaxation over it, 0 where there is no liquid.
    total: Vec<Real>,
    relax: Vec<Real>,
    /// One over the weights of the coarser cells with room around a cell; 0 where there is no liquid.
    scale: Vec<Real>,
    /// Which chunks of cells hold any liquid: all others stay zero.
    liquid: Vec<bool>,
    right_side: Vec<Real>,
    x: Vec<Real>,
    other: Vec<Real>,
}

impl Multigrid {
    /// The couplings of the finest grid, to be set.
    pub fn finest(&mut self, lattice: &Lattice) -> &mut Couplings {
        let (mut width, mut height, mut count) = (lattice.width, lattice.height, 1);
        while width.max(height) > COARSEST {
            (width, height, count) = (coarser(width), coarser(height), count + 1);
        }
        self.levels.resize_with(count, Level::default);
        (width, height) = (lattice.width, lattice.height);
        for level in &mut self.levels {
            level.resize(width, height);
            (width, height) = (coarser(width), coarser(height));
        }
        self.direction.resize(lattice.len(), 0.0);
        self.image.resize(lattice.len(), 0.0);
        &mut self.levels[0].couplings
    }

    /// Makes all coarser grids.
    pub fn coarsen(&mut self, parallelism: Parallelism) {
        self.levels[0].add_up(parallelism);
        for fine in 0..self.levels.len() - 1 {
            let (finer, coarser) = self.levels.split_at_mut(fine + 1);
            let (finer, coarser) = (&mut finer[fine], &mut coarser[0]);
            coarser.couple(finer, parallelism);
            coarser.add_up(parallelism);
            finer.weigh(coarser, parallelism);
        }
    }

    /// Solves by this many steps of conjugate gradients from zero.
    pub fn solve(&mut self, right_side: &[Real], solution: &mut [Real], steps: u32, parallelism: Parallelism) {
        solution.fill(0.0);
        // The right side of the finest grid is the residual all along.
        self.levels[0].right_side.copy_from_slice(right_side);
        let mut before = 0.0;
        for step in 0..steps {
            self.cycle(0, parallelism);
            let finest = &mut self.levels[0];
            let (found, residual) = (&finest.x, &finest.right_side);
            let fit = dot(found, residual, parallelism);
            if fit <= 0.0 {
                break;
            }
            let kept = if step == 0 { 0.0 } else { (fit / before) as Real };
            before = fit;
            match step {
                0 => self.direction.copy_from_slice(found),
                _ => parallelism.update(&mut self.direction, |k, p| *p = found[k] + kept * *p),
            }
            finest.image(&self.direction, &mut self.image, parallelism);
            let (direction, image) = (&self.direction, &self.image);
            let length = (fit / dot(direction, image, parallelism)) as Real;
            parallelism.chunks2(solution, &mut finest.right_side, |first, solution, residual| {
                let (direction, image) = (&direction[first..][..solution.len()], &image[first..][..solution.len()]);
                for k in 0..solution.len() {
                    solution[k] += length * direction[k];
                    residual[k] -= length * image[k];
                }
            });
        }
    }

    /// Solves the right side of a level roughly, by all coarser ones.
    fn cycle(&mut self, level: usize, parallelism: Parallelism) {
        let last = level + 1 == self.levels.len();
        self.levels[level].sweep_from_zero(if last { LAST_SWEEPS } else { SWEEPS }, parallelism);
        if last {
            return;
        }
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        let (fine, coarse) = (&mut finer[level], &mut coarser[0]);
        fine.residual(parallelism);
        fine.restrict(coarse, parallelism);
        self.cycle(level + 1, parallelism);
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        finer[level].prolong(&coarser[0], parallelism);
        finer[level].sweep(SWEEPS, parallelism);
    }

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        self.levels.iter().map(Level::memory_bytes).sum::<usize>() + held_by(&[&self.direction, &self.image])
    }
}

impl Level {
    fn stride(&self) -> usize {
        self.width + 2
    }

    fn index(&self, i: usize, j: usize) -> usize {
        (j + 1) * self.stride() + i + 1
    }

    fn resize(&mut self, width: usize, height: usize) {
        if (self.width, self.height) == (width, height) {
            return;
        }
        (self.width, self.height) = (width, height);
        let cells = (width + 2) * (height + 2);
        let couplings = &mut self.couplings;
        for column in [
            &mut couplings.right,
            &mut couplings.upper,
            &mut couplings.air,
            &mut couplings.room,
            &mut self.total,
            &mut self.relax,
            &mut self.scale,
            &mut self.right_side,
            &mut self.x,
            &mut self.other,
        ] {
            column.clear();
            column.resize(cells, 0.0);
        }
    }

    /// Couplings between cells of four: half of what couples their parts, as they are twice as far apart.
    fn couple(&mut self, fine: &Level, parallelism: Parallelism) {
        let (stride, of) = (self.stride(), &fine.couplings);
        let (width, height) = (self.width, self.height);
        let parts = |k: usize, use_of: &dyn Fn([usize; 4]) -> Real| {
            let (i, j) = (k % stride, k / stride);
            if i == 0 || j == 0 || i > width || j > height {
                return 0.0;
            }
            let (i, j) = (2 * (i - 1), 2 * (j - 1));
            // Grids are even: the last cells may lie beyond the finer one, whose rim is empty.
            let at = |i: usize, j: usize| fine.index(i.min(fine.width), j.min(fine.height));
            use_of([at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)])
        };
        let couplings = &mut self.couplings;
        parallelism.fill(&mut couplings.right, |k| parts(k, &|[_, b, _, d]| 0.5 * (of.right[b] + of.right[d])));
        parallelism.fill(&mut couplings.upper, |k| parts(k, &|[_, _, c, d]| 0.5 * (of.upper[c] + of.upper[d])));
        let sum = |column: &[Real], four: [usize; 4]| four.into_iter().map(|k| column[k]).sum::<Real>();
        parallelism.fill(&mut couplings.air, |k| parts(k, &|four| 0.5 * sum(&of.air, four)));
        parallelism.fill(&mut couplings.room, |k| parts(k, &|four| sum(&of.room, four).min(1.0)));
    }

    fn add_up(&mut self, parallelism: Parallelism) {
        let (stride, of) = (self.stride(), &self.couplings);
        parallelism.fill(&mut self.total, |k| {
            let before = |column: &[Real], back: usize| if k >= back { column[k - back] } else { 0.0 };
            of.right[k] + before(&of.right, 1) + of.upper[k] + before(&of.upper, stride) + of.air[k]
        });
        let total = &self.total;
        parallelism.fill(&mut self.relax, |k| if total[k] > 0.0 { RELAXATION / total[k] } else { 0.0 });
        self.liquid.clear();
        self.liquid.extend(total.chunks(CHUNK_ROWS).map(|chunk| chunk.iter().any(|&total| total > 0.0)));
    }

    /// Cells of the coarser grid around a cell, and their weights (bilinear).
    fn around(&self, coarse: &Level, k: usize) -> [(usize, Real); 4] {
        let (i, j) = (k % self.stride() - 1, k / self.stride() - 1);
        let at = coarse.index(i / 2, j / 2);
        let beside = if i % 2 == 1 { at + 1 } else { at - 1 };
        let (far, near) = if j % 2 == 1 { (coarse.stride(), 0) } else { (0, coarse.stride()) };
        let over = |k: usize| k + far - near;
        [(at, 0.5625), (beside, 0.1875), (over(at), 0.1875), (over(beside), 0.0625)]
    }

    fn weigh(&mut self, coarse: &Level, parallelism: Parallelism) {
        let mut scale = std::mem::take(&mut self.scale);
        parallelism.fill(&mut scale, |k| {
            if self.total[k] == 0.0 {
                return 0.0;
            }
            let weights = self.around(coarse, k).map(|(at, weight)| weight * coarse.couplings.room[at]);
            1.0 / weights.into_iter().sum::<Real>()
        });
        self.scale = scale;
    }

    /// Adds what the coarser grid found.
    fn prolong(&mut self, coarse: &Level, parallelism: Parallelism) {
        let mut x = std::mem::take(&mut self.x);
        parallelism.update(&mut x, |k, x| {
            if self.scale[k] > 0.0 {
                let parts = self.around(coarse, k).map(|(at, weight)| weight * coarse.x[at]);
                *x += self.scale[k] * ((parts[0] + parts[1]) + (parts[2] + parts[3]));
            }
        });
        self.x = x;
    }

    /// Gives the residual, which [`residual`](Self::residual) left scaled in `other`, to the coarser grid: the
    /// transpose of [`prolong`](Self::prolong).
    fn restrict(&self, coarse: &mut Level, parallelism: Parallelism) {
        let (stride, coarse_stride, relax) = (self.stride(), coarse.stride(), &coarse.relax);
        let along_row = |first: usize| {
            let four = &self.other[first..first + 4];
            0.25 * (four[0] + four[3]) + 0.75 * (four[1] + four[2])
        };
        parallelism.fill(&mut coarse.right_side, |k| {
            if relax[k] == 0.0 {
                return 0.0;
            }
            let (i, j) = (k % coarse_stride - 1, k / coarse_stride - 1);
            let first = 2 * (j * stride + i);
            let (outer, inner) = ([first, first + 3 * stride], [first + stride, first + 2 * stride]);
            let [a, b, c, d] = [outer[0], outer[1], inner[0], inner[1]].map(along_row);
            0.25 * (a + b) + 0.75 * (c + d)
        });
    }

    /// What the couplings make of a field.
    fn image(&self, x: &[Real], out: &mut [Real], parallelism: Parallelism) {
        self.stencil(x, out, parallelism, |_, x, total, coupled| total * x - coupled);
    }

    /// What is left of the right side, scaled for the coarser grid, into `other`.
    fn residual(&mut self, parallelism: Parallelism) {
        let mut other = std::mem::take(&mut self.other);
        let (right_side, scale) = (&self.right_side, &self.scale);
        self.stencil(&self.x, &mut other, parallelism, |k, x, total, coupled| {
            scale[k] * (right_side[k] - (total * x - coupled))
        });
        self.other = other;
    }

    fn sweep_from_zero(&mut self, sweeps: usize, parallelism: Parallelism) {
        let (relax, right_side) = (&self.relax, &self.right_side);
        parallelism.fill(&mut self.x, |k| relax[k] * right_side[k]);
        self.sweep(sweeps - 1, parallelism);
    }

    fn sweep(&mut self, sweeps: usize, parallelism: Parallelism) {
        for _ in 0..sweeps {
            let mut other = std::mem::take(&mut self.other);
            let (relax, right_side) = (&self.relax, &self.right_side);
            self.stencil(&self.x, &mut other, parallelism, |k, x, total, coupled| {
                x + relax[k] * (right_side[k] - (total * x - coupled))
            });
            self.other = std::mem::replace(&mut self.x, other);
        }
    }

    /// `out[k] = value(k, x[k], total[k], sum of couplings times neighbours)` within the rim, 0 on it.
    #[inline(always)]
    fn stencil(
        &self,
        x: &[Real],
        out: &mut [Real],
        parallelism: Parallelism,
        value: impl Fn(usize, Real, Real, Real) -> Real + Sync,
    ) {
        let (stride, cells) = (self.stride(), x.len());
        let (right, upper, total) = (&self.couplings.right, &self.couplings.upper, &self.total);
        parallelism.chunks(out, |first, out| {
            let (low, high) = (stride.max(first), (cells - stride).min(first + out.len()));
            if low >= high || !self.liquid[first / CHUNK_ROWS] {
                out.fill(0.0);
                return;
            }
            let count = high - low;
            out[..low - first].fill(0.0);
            out[high - first..].fill(0.0);
            let out = &mut out[low - first..high - first];
            let (xc, xr, xl) = (&x[low..][..count], &x[low + 1..][..count], &x[low - 1..][..count]);
            let (xu, xd) = (&x[low + stride..][..count], &x[low - stride..][..count]);
            let (cr, cl) = (&right[low..][..count], &right[low - 1..][..count]);
            let (cu, cd) = (&upper[low..][..count], &upper[low - stride..][..count]);
            let total = &total[low..][..count];
            for k in 0..count {
                let coupled = (cr[k] * xr[k] + cl[k] * xl[k]) + (cu[k] * xu[k] + cd[k] * xd[k]);
                out[k] = value(low + k, xc[k], total[k], coupled);
            }
        });
    }

    fn memory_bytes(&self) -> usize {
        let couplings = &self.couplings;
        held_by(&[&couplings.right, &couplings.upper, &couplings.air, &couplings.room])
            + held_by(&[&self.total, &self.relax, &self.scale, &self.right_side, &self.x, &self.other])
            + held(&self.liquid)
    }
}

/// Cells of the next grid along an axis of this many: as even a number, so that all cells have their parts.
fn coarser(cells: usize) -> usize {
    (cells / 2 + 1) & !1
}

/// The sum of products, in an order that depends on nothing but the length.
fn dot(a: &[Real], b: &[Real], parallelism: Parallelism) -> f64 {
    const LANES: usize = 8;
    let of_chunk = |rows: Range<usize>| {
        let (a, b) = (a[rows.clone()].chunks_exact(LANES), b[rows].chunks_exact(LANES));
        let rest = a.remainder().iter().zip(b.remainder()).map(|(a, b)| f64::from(a * b)).sum::<f64>();
        let mut sums = [0.0; LANES];
        for (a, b) in a.zip(b) {
            for lane in 0..LANES {
                sums[lane] += a[lane] * b[lane];
            }
        }
        sums.into_iter().map(f64::from).sum::<f64>() + rest
    };
    parallelism.reduce(a.len(), of_chunk, |a, b| a + b)
}
