//! The box of cells around the liquid, and how a place weighs its nodes.

use crate::math::{Real, Vector, larger, smaller};
use crate::parallel::Parallelism;
use crate::particles::Particles;
use crate::walls::Walls;
use std::ops::Range;

/// Edges of the box lie on multiples of this many cells, so that it seldom changes.
const STEP: i32 = 4;
/// Cells beyond those that hold particles.
const MARGIN: i32 = 1;
/// Most cells for each particle, and beside.
const CELLS_PER_ROW: f64 = 8.0;
const CELLS_BESIDE: f64 = 65_536.0;
/// Farthest cell from the origin that is told from its neighbours.
const FARTHEST_CELL: Real = 1e8;

/// Cells `0..width` x `0..height` of a grid fixed in space, in rows with one more cell around.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lattice {
    /// Width of a cell [m].
    pub cell: Real,
    /// A corner of cells, on walls where that can be [m].
    origin: Vector,
    /// Cells from the origin to the first cell of the box.
    lower: Vector,
    /// Cells along x.
    pub width: usize,
    /// Cells along y.
    pub height: usize,
}

/// The four nodes around a place: the number of the first, and the weights of it, its right, its upper and its upper
/// right neighbour.
#[derive(Clone, Copy)]
pub(super) struct Nodes {
    pub first: usize,
    pub weights: [Real; 4],
}

impl Lattice {
    pub fn new(cell: Real) -> Self {
        Lattice { cell, ..Lattice::default() }
    }

    /// Cells from one row to the next.
    pub fn stride(&self) -> usize {
        self.width + 2
    }

    /// Cells in all, with those around.
    pub fn len(&self) -> usize {
        self.stride() * (self.height + 2)
    }

    /// Lower left corner of a cell, given by its number [m].
    pub fn corner(&self, cell: usize) -> Vector {
        let (i, j) = (cell % self.stride(), cell / self.stride());
        self.origin + (self.lower + Vector::new(i as Real, j as Real) - Vector::ONE) * self.cell
    }

    /// Lays the box around all that is dense.
    pub fn cover(&mut self, particles: &Particles, walls: &Walls, parallelism: Parallelism) {
        self.origin = walls.anchor();
        let rows = particles.dense();
        let (low, high) = extent(&particles.start[..rows], parallelism);
        let cells = |at: Real, axis: usize| {
            ((at - self.origin[axis]) / self.cell).floor().clamp(-FARTHEST_CELL, FARTHEST_CELL) as i32
        };
        let range = |axis: usize| {
            let (low, high) = (cells(low[axis], axis) - MARGIN, cells(high[axis], axis) + 1 + MARGIN);
            (low.div_euclid(STEP) * STEP, (high + STEP - 1).div_euclid(STEP) * STEP)
        };
        let (x, y) = (range(0), range(1));
        let (mut width, mut height) = (f64::from(x.1 - x.0), f64::from(y.1 - y.0));
        let limit = CELLS_PER_ROW * rows as f64 + CELLS_BESIDE;
        // What flew far off falls freely: the box stays around the lower left of the rest.
        if width * height > limit {
            height = height.min((limit / width).max(limit.sqrt()));
            width = width.min(limit / height);
        }
        let even = |cells: f64| 2 * (0.5 * cells) as usize;
        self.lower = Vector::new(x.0 as Real, y.0 as Real);
        (self.width, self.height) = (even(width), even(height));
    }

    /// A place in cells from the lower left corner of the box.
    #[inline(always)]
    pub fn place(&self, x: Vector) -> Vector {
        (x - self.origin) * (1.0 / self.cell) - self.lower
    }

    /// Whether a place, in cells, has all its nodes, however it is rounded.
    #[inline(always)]
    pub fn holds(&self, place: Vector) -> bool {
        let (right, top) = (self.width as Real - 0.5, self.height as Real - 0.5);
        place.x > 0.5 && place.y > 0.5 && place.x < right && place.y < top
    }

    /// The nodes around a place, in cells, of a grid whose first node lies at `offset`.
    #[inline(always)]
    pub fn nodes(&self, place: Vector, offset: Vector) -> Nodes {
        let at = place - offset + Vector::ONE;
        let (i, j) = (at.x as i32, at.y as i32);
        let (x, y) = (at.x - i as Real, at.y - j as Real);
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        Nodes { first: j as usize * self.stride() + i as usize, weights }
    }

    /// The numbers of all cells whose nodes places between two heights, in cells, may have. One row more than needed:
    /// a place just below a cell's border may be rounded onto it.
    pub fn cells_between(&self, low: Real, high: Real) -> Range<usize> {
        let rows = (high as usize + 4).min(self.height + 2);
        low as usize * self.stride()..rows * self.stride()
    }
}

/// Where the first node of each kind lies, in cells.
pub(super) const LEFT_FACES: Vector = Vector::new(0.0, 0.5);
pub(super) const LOWER_FACES: Vector = Vector::new(0.5, 0.0);
pub(super) const CENTRES: Vector = Vector::new(0.5, 0.5);

/// The corners of the box around all places.
fn extent(places: &[Vector], parallelism: Parallelism) -> (Vector, Vector) {
    let joined = |a: (Vector, Vector), b: (Vector, Vector)| {
        let low = Vector::new(smaller(b.0.x, a.0.x), smaller(b.0.y, a.0.y));
        (low, Vector::new(larger(b.1.x, a.1.x), larger(b.1.y, a.1.y)))
    };
    let none = (Vector::splat(Real::MAX), Vector::splat(Real::MIN));
    let of = |rows: Range<usize>| places[rows].iter().fold(none, |extent, &x| joined(extent, (x, x)));
    parallelism.reduce(places.len(), of, joined)
}
