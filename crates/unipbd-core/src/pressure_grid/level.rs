//! One grid of the cycle: its couplings, its sweeps, and the transfers to the next finer and coarser grid.

use super::couplings::Couplings;
use super::images::Images;
use super::lattice::stride;
use super::spans::{Spans, by_row};
use super::{held_by, renew};
use crate::math::{Real, larger};
use crate::parallel::Parallelism;

/// Relaxation of the Jacobi sweeps: chosen to damp the errors that the next coarser grid cannot resolve.
const RELAXATION: Real = 0.8;

/// One grid. All columns but those of the room are zero where there is no liquid.
#[derive(Default)]
pub(super) struct Level {
    pub width: usize,
    pub height: usize,
    pub images: Images,
    pub spans: Spans,
    pub couplings: Couplings,
    /// Relaxation over the sum of all couplings of a cell.
    relax: Vec<Real>,
    /// 1 where there is room for a fluid, 0 within walls.
    pub room: Vec<Real>,
    /// Inverse of the weights of the coarser cells with room around a cell; 0 if none has room.
    scale: Vec<Real>,
    pub right_side: Vec<Real>,
    pub x: Vec<Real>,
    other: Vec<Real>,
}

impl Level {
    pub fn stride(&self) -> usize {
        stride(self.width)
    }

    /// The cells that hold liquid, and those from one row to the next.
    pub fn size(&self) -> (&Spans, usize) {
        (&self.spans, self.stride())
    }

    pub fn cells(&self) -> usize {
        self.stride() * (self.height + 2)
    }

    fn index(&self, i: usize, j: usize) -> usize {
        (j + 1) * self.stride() + i + 1
    }

    /// Column and row of a cell, unless it is one of the rim.
    fn within(&self, cell: usize) -> Option<(usize, usize)> {
        let (i, j) = (cell % self.stride(), cell / self.stride());
        ((1..=self.width).contains(&i) && (1..=self.height).contains(&j)).then_some((i, j))
    }

    /// One row of a column.
    fn row<'a>(&self, column: &'a [Real], row: usize) -> &'a [Real] {
        &column[row * self.stride()..][..self.stride()]
    }

    /// The columns that hold data of the liquid.
    fn columns(&mut self) -> (&Spans, [&mut Vec<Real>; 8]) {
        let Couplings { right, upper, air, total } = &mut self.couplings;
        let of_solver = [&mut self.relax, &mut self.right_side, &mut self.x, &mut self.other];
        let [relax, right_side, x, other] = of_solver;
        (&self.spans, [right, upper, air, total, relax, right_side, x, other])
    }

    pub fn resize(&mut self, width: usize, height: usize, images: Images) {
        if (self.width, self.height, self.images) == (width, height, images) {
            return;
        }
        self.images = images;
        (self.width, self.height) = (width, height);
        let cells = self.cells();
        self.spans.forget();
        let (_, columns) = self.columns();
        columns.into_iter().for_each(|column| renew(column, cells));
        [&mut self.room, &mut self.scale].into_iter().for_each(|column| renew(column, cells));
    }

    /// Forgets the liquid.
    pub fn clear(&mut self) {
        let (spans, columns) = self.columns();
        columns.into_iter().for_each(|column| spans.clear(column));
    }

    /// Room in a coarse cell: set if any of its four children has room.
    pub fn make_room(&mut self, fine: &Level, parallelism: Parallelism) {
        let mut room = std::mem::take(&mut self.room);
        parallelism.fill(&mut room, |cell| {
            let Some((i, j)) = self.within(cell) else { return 0.0 };
            fine.parts(i - 1, j - 1).into_iter().map(|part| fine.room[part]).fold(0.0, larger)
        });
        self.images.copy(&mut room, self.stride());
        self.room = room;
    }

    /// The four children of a cell of the next grid. The last ones may lie outside this grid, whose rim is empty.
    fn parts(&self, i: usize, j: usize) -> [usize; 4] {
        let at = |i: usize, j: usize| self.index(i.min(self.width), j.min(self.height));
        let (i, j) = (2 * i, 2 * j);
        [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]
    }

    /// Couplings between coarse cells: half the couplings of their children, because the distance is doubled.
    pub fn couple(&mut self, fine: &Level, parallelism: Parallelism) {
        let (width, stride, of, images) = (self.width, self.stride(), &fine.couplings, self.images);
        let Couplings { right, upper, air, .. } = &mut self.couplings;
        self.spans.each3(&mut *right, &mut *upper, &mut *air, parallelism, |first, right, upper, air| {
            for part in by_row(first..first + right.len(), stride) {
                let row = part.row * stride;
                for column in part.column.max(1)..(part.column + part.cells.len()).min(width + 1) {
                    let (k, [a, b, c, d]) = (row + column - first, fine.parts(column - 1, part.row - 1));
                    right[k] = 0.5 * (of.right[b] + of.right[d]);
                    upper[k] = 0.5 * (of.upper[c] + of.upper[d]);
                    air[k] = 0.5 * (of.air[a] + of.air[b] + of.air[c] + of.air[d]);
                }
            }
        });
        images.couple([right, upper, air], stride);
    }

    /// Sums the couplings of each cell.
    pub fn add_up(&mut self, parallelism: Parallelism) {
        let stride = self.stride();
        let Couplings { right, upper, air, total } = &mut self.couplings;
        self.spans.each2(total, &mut self.relax, parallelism, |first, total, relax| {
            let count = total.len();
            let (r, l) = (&right[first..][..count], &right[first - 1..][..count]);
            let (u, d) = (&upper[first..][..count], &upper[first - stride..][..count]);
            let air = &air[first..][..count];
            for k in 0..count {
                let sum = r[k] + l[k] + u[k] + d[k] + air[k];
                (total[k], relax[k]) = (sum, if sum > 0.0 { RELAXATION / sum } else { 0.0 });
            }
        });
        [total, &mut self.relax].into_iter().for_each(|column| self.images.clear(column, stride));
    }

    /// Columns or rows of the coarser grid that contain a cell of this grid or are adjacent to it, including the rims.
    #[inline(always)]
    fn beside(place: usize) -> [usize; 2] {
        let at = place.div_ceil(2);
        [at, if place.is_multiple_of(2) { at + 1 } else { at - 1 }]
    }

    /// The bilinear sum around a column of two rows of the coarser grid, the near one and the far one.
    #[inline(always)]
    fn blend([near, far]: [&[Real]; 2], column: usize) -> Real {
        let [at, next] = Level::beside(column);
        (0.5625 * near[at] + 0.1875 * near[next]) + (0.1875 * far[at] + 0.0625 * far[next])
    }

    /// Sets the weights of the correction from the coarser grid, from its room.
    pub fn weigh(&mut self, coarse: &Level, parallelism: Parallelism) {
        let mut scale = std::mem::take(&mut self.scale);
        parallelism.fill(&mut scale, |cell| {
            let Some((i, j)) = self.within(cell) else { return 0.0 };
            let sum = Level::blend(Level::beside(j).map(|row| coarse.row(&coarse.room, row)), i);
            if sum > 0.0 { 1.0 / sum } else { 0.0 }
        });
        self.scale = scale;
    }

    /// Adds the correction from the coarser grid.
    pub fn prolong(&mut self, coarse: &mut Level, parallelism: Parallelism) {
        coarse.images.copy(&mut coarse.x, stride(coarse.width));
        let coarse = &*coarse;
        let (stride, scale, relax) = (self.stride(), &self.scale, &self.relax);
        self.spans.each(&mut self.x, parallelism, |first, x| {
            for part in by_row(first..first + x.len(), stride) {
                let start = part.row * stride;
                let rows = Level::beside(part.row).map(|row| coarse.row(&coarse.x, row));
                for cell in part.cells.filter(|&cell| relax[cell] > 0.0) {
                    x[cell - first] += scale[cell] * Level::blend(rows, cell - start);
                }
            }
        });
    }

    /// Takes over the residual that a finer grid left scaled in `other`: the transpose of
    /// [`prolong`](Self::prolong).
    pub fn restrict(&mut self, fine: &Level, parallelism: Parallelism) {
        let (stride, fine_stride, relax) = (self.stride(), fine.stride(), &self.relax);
        let along_row = |first: usize| {
            let four = &fine.other[first..][..4];
            0.25 * (four[0] + four[3]) + 0.75 * (four[1] + four[2])
        };
        self.spans.each(&mut self.right_side, parallelism, |first, out| {
            for part in by_row(first..first + out.len(), stride) {
                let (start, finer) = (part.row * stride, 2 * (part.row - 1) * fine_stride);
                for cell in part.cells.filter(|&cell| relax[cell] > 0.0) {
                    let at = finer + 2 * (cell - start - 1);
                    let rows = [at, at + fine_stride, at + 2 * fine_stride, at + 3 * fine_stride];
                    let [a, b, c, d] = rows.map(along_row);
                    out[cell - first] = 0.25 * (a + d) + 0.75 * (b + c);
                }
            }
        });
    }

    /// Writes the residual of the right side, scaled for the coarser grid, into `other`.
    pub fn residual(&mut self, parallelism: Parallelism) {
        let mut other = std::mem::take(&mut self.other);
        let left = |x: Real, total: Real, coupled: Real, [scale, right_side]: [Real; 2]| {
            scale * (right_side - (total * x - coupled))
        };
        self.images.copy(&mut self.x, stride(self.width));
        let (size, columns) = (self.size(), [&self.scale[..], &self.right_side]);
        self.couplings.stencil(&self.x, &mut other, size, parallelism, left, columns);
        // A coarser grid without images takes nothing from them.
        self.images.clear(&mut other, size.1);
        Images { periods: self.images.coarser().periods.map(|period| 2 * period) }.copy(&mut other, size.1);
        self.other = other;
    }

    pub fn sweep_from_zero(&mut self, sweeps: usize, parallelism: Parallelism) {
        let (relax, right_side) = (&self.relax, &self.right_side);
        self.spans.each(&mut self.x, parallelism, |first, x| {
            let (relax, right_side) = (&relax[first..][..x.len()], &right_side[first..][..x.len()]);
            for k in 0..x.len() {
                x[k] = relax[k] * right_side[k];
            }
        });
        self.sweep(sweeps - 1, parallelism);
    }

    pub fn sweep(&mut self, sweeps: usize, parallelism: Parallelism) {
        let better = |x: Real, total: Real, coupled: Real, [relax, right_side]: [Real; 2]| {
            x + relax * (right_side - (total * x - coupled))
        };
        for _ in 0..sweeps {
            let mut other = std::mem::take(&mut self.other);
            self.images.copy(&mut self.x, stride(self.width));
            let (size, columns) = (self.size(), [&self.relax[..], &self.right_side]);
            self.couplings.stencil(&self.x, &mut other, size, parallelism, better, columns);
            self.other = std::mem::replace(&mut self.x, other);
        }
    }

    pub fn memory_bytes(&self) -> usize {
        self.couplings.memory_bytes()
            + held_by(&[&self.room, &self.scale, &self.relax, &self.right_side, &self.x, &self.other])
            + self.spans.memory_bytes()
    }
}
