//! The box of cells around the liquid, and the interpolation weights of its nodes.

use super::images::Images;
use super::spans::BLOCK;
use crate::math::{Real, Vector, Vector64, wide};
use crate::parallel::{Aabb, Parallelism};
use crate::particles::Particles;
use crate::periodic::{Periodic, PeriodicAxis};
use crate::walls::Walls;
use std::ops::Range;

/// Edges of the box lie on multiples of this many cells, so that it seldom changes.
const STEP: i32 = 8;
/// Cells beyond those that hold particles.
const MARGIN: i32 = 1;
/// Maximum number of cells per particle, and additional cells.
const CELLS_PER_ROW: f64 = 8.0;
const CELLS_BESIDE: f64 = 65_536.0;
/// Farthest cell from the origin with a distinct index.
const FARTHEST_CELL: Real = 1e8;

/// Cells `0..width` x `0..height` of a grid fixed in space, in rows with at least one more cell around.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lattice {
    /// Width of a cell \[m].
    pub cell: Real,
    /// A corner of cells, on walls where that can be \[m].
    origin: Vector,
    /// Cells from the origin to the first cell of the box.
    lower: Vector,
    /// Cells along x.
    pub width: usize,
    /// Cells along y.
    pub height: usize,
    /// Periodic axes.
    pub images: Images,
    /// Where they start, and the farthest place on them, in cells; infinite along others.
    start: Vector,
    farthest: Vector,
}

/// The four nodes of one kind around a place: the number of the first, and how far the place lies on the way to its
/// right and its upper neighbour, from 0 to 1.
#[derive(Clone, Copy)]
pub(super) struct Nodes {
    pub first: usize,
    pub right: Real,
    pub up: Real,
}

impl Nodes {
    /// The weights of the first node, its right, its upper and its upper right neighbour.
    pub fn weights(&self) -> [Real; 4] {
        let (left, right, low, high) = (1.0 - self.right, self.right, 1.0 - self.up, self.up);
        [left * low, right * low, left * high, right * high]
    }
}

/// The nodes around a place: left faces, lower faces and centres of cells.
pub(super) struct Around {
    pub left: Nodes,
    pub lower: Nodes,
    pub centre: Nodes,
}

impl Lattice {
    /// Cells of this width \[m], as many in a period as `periods` says.
    pub fn new(cell: Real, (periods, periodic): ([usize; 2], Periodic)) -> Self {
        let start = |axis: Option<PeriodicAxis>| axis.map_or(0.0, |axis| axis.from);
        let farthest = |cells: usize| if cells > 0 { (cells as Real).next_down() } else { Real::INFINITY };
        Lattice {
            cell,
            images: Images { periods },
            start: Vector::new(start(periodic.x), start(periodic.y)),
            farthest: Vector::new(farthest(periods[0]), farthest(periods[1])),
            ..Lattice::default()
        }
    }

    /// Longest side \[m].
    pub fn longest(&self) -> f64 {
        f64::from(self.cell) * self.width.max(self.height) as f64
    }

    /// Cells from one row to the next.
    pub fn stride(&self) -> usize {
        stride(self.width)
    }

    /// Cells in all, with those around.
    pub fn len(&self) -> usize {
        self.stride() * (self.height + 2)
    }

    /// The cells of each row, without the rim.
    pub fn rows(&self) -> impl Iterator<Item = Range<usize>> {
        let (stride, width) = (self.stride(), self.width);
        (1..=self.height).map(move |row| row * stride + 1..row * stride + width + 1)
    }

    /// Lower left corner of a cell, given by its number \[m].
    pub fn corner(&self, cell: usize) -> Vector {
        let (i, j) = (cell % self.stride(), cell / self.stride());
        self.origin + (self.lower + Vector::new(i as Real, j as Real) - Vector::ONE) * self.cell
    }

    /// Lower left corner of the box \[m].
    pub fn lowest(&self) -> Vector64 {
        wide(self.origin) + wide(self.lower) * f64::from(self.cell)
    }

    /// Places the box around all dense particles.
    pub fn cover(&mut self, particles: &Particles, walls: &Walls, parallelism: Parallelism) {
        self.origin = walls.anchor();
        for axis in (0..2).filter(|&axis| self.images.periods[axis] > 0) {
            self.origin[axis] = self.start[axis];
        }
        let rows = particles.dense();
        let (low, high) = Aabb::of(&particles.start[..rows], parallelism).corners();
        let cells = |at: Real, axis: usize| {
            ((at - self.origin[axis]) / self.cell).floor().clamp(-FARTHEST_CELL, FARTHEST_CELL) as i32
        };
        let range = |axis: usize| {
            let period = self.images.periods[axis];
            if period > 0 {
                return (0, period as i32);
            }
            let (low, high) = (cells(low[axis], axis) - MARGIN, cells(high[axis], axis) + 1 + MARGIN);
            (low.div_euclid(STEP) * STEP, (high + STEP - 1).div_euclid(STEP) * STEP)
        };
        let (x, y) = (range(0), range(1));
        let (mut width, mut height) = (f64::from(x.1 - x.0), f64::from(y.1 - y.0));
        let limit = CELLS_PER_ROW * rows as f64 + CELLS_BESIDE;
        // Particles far from the rest are in free fall: the box covers only the particles near the lower left.
        if width * height > limit {
            let free = self.images.periods.map(|period| period == 0);
            height = if free[1] { height.min((limit / width).max(limit.sqrt())) } else { height };
            width = if free[0] { width.min(limit / height) } else { width };
        }
        let even = |cells: f64| 2 * (0.5 * cells) as usize;
        self.lower = Vector::new(x.0 as Real, y.0 as Real);
        (self.width, self.height) = (even(width), even(height));
    }

    /// A place in cells from the lower left corner of the box.
    #[inline(always)]
    pub fn place(&self, x: Vector) -> Vector {
        ((x - self.origin) * (1.0 / self.cell) - self.lower).min(self.farthest)
    }

    /// Whether a place, in cells, has all its nodes, however it is rounded.
    #[inline(always)]
    pub fn holds(&self, place: Vector) -> bool {
        let [along_x, along_y] = self.images.periods.map(|period| period > 0);
        // Along a periodic axis the rim holds images: all of the period is inside, and a rounding more.
        let inside = |repeats: bool, at: Real, cells: usize| {
            let rim = if repeats { -0.25 } else { 0.5 };
            at > rim && at < cells as Real - rim
        };
        inside(along_x, place.x, self.width) && inside(along_y, place.y, self.height)
    }

    /// The cell that holds a place, in cells, if it is one of the box.
    pub fn cell_at(&self, place: Vector) -> Option<usize> {
        let inside = place.x >= 0.0 && place.y >= 0.0;
        let (i, j) = (place.x as usize, place.y as usize);
        (inside && i < self.width && j < self.height).then(|| (j + 1) * self.stride() + i + 1)
    }

    /// The cell this way from another one, in cells along each axis, if it is one of the box.
    pub fn cell_beside(&self, cell: usize, way: [i32; 2]) -> Option<usize> {
        let along = |at: usize, way: i32, cells: usize, repeats: bool| {
            let at = at as i32 - 1 + way;
            let at = if repeats { at.rem_euclid(cells as i32) } else { at };
            (0..cells as i32).contains(&at).then(|| at as usize + 1)
        };
        let [repeats_x, repeats_y] = self.images.periods.map(|period| period > 0);
        let i = along(cell % self.stride(), way[0], self.width, repeats_x)?;
        Some(along(cell / self.stride(), way[1], self.height, repeats_y)? * self.stride() + i)
    }

    /// Corners of the box \[m].
    pub fn bounds(&self) -> [Vector; 2] {
        let low = self.origin + self.lower * self.cell;
        [low, low + Vector::new(self.width as Real, self.height as Real) * self.cell]
    }

    /// The nodes around a place, in cells.
    #[inline(always)]
    pub fn around(&self, place: Vector) -> Around {
        let split = |at: Real| {
            let node = at as i32;
            (node as usize, at - node as Real)
        };
        // Faces lie at integers across their direction, all other nodes at half-integers; the rim is one cell wide.
        let (across, half) = (place + Vector::ONE, place + Vector::splat(0.5));
        let (face, centre) = ([split(across.x), split(across.y)], [split(half.x), split(half.y)]);
        let nodes =
            |(i, right): (usize, Real), (j, up): (usize, Real)| Nodes { first: j * self.stride() + i, right, up };
        Around {
            left: nodes(face[0], centre[1]),
            lower: nodes(centre[0], face[1]),
            centre: nodes(centre[0], centre[1]),
        }
    }

    /// The indices of all cells with nodes around points between two heights, in cells. It has one extra row:
    /// a point just below a cell's border may be rounded onto it.
    pub fn cells_between(&self, low: Real, high: Real) -> Range<usize> {
        let rows = (high as usize + 4).min(self.height + 2);
        low as usize * self.stride()..rows * self.stride()
    }
}

/// Cells from one row of `width` to the next: one more on each side, and as many blocks as hold them.
pub(super) fn stride(width: usize) -> usize {
    (width + 2).next_multiple_of(BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_beyond_a_period_or_that_are_no_numbers_are_not_held() {
        let lattice = Lattice { width: 8, height: 8, images: Images { periods: [8, 0] }, ..Lattice::default() };
        for at in [0.0, 3.0, Real::from(8u8).next_down()] {
            assert!(lattice.holds(Vector::new(at, 4.0)), "{at}");
        }
        for at in [-5332.0, 9.0, 1e30, Real::NAN, Real::NEG_INFINITY] {
            assert!(!lattice.holds(Vector::new(at, 4.0)), "{at}");
        }
        assert!(!lattice.holds(Vector::new(4.0, 0.2)), "a rim without images holds no place");
    }
}
