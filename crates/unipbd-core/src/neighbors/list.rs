//! The neighbour list, laid out for eight lanes (SELL-8: sliced ELLPACK with slices of eight rows).
//!
//! Eight consecutive rows make a block. The k-th neighbours of the eight lie side by side, so that
//! one load brings all of them, and they are stored relative to the first row of the block, in 16
//! bits where that is enough. Rows with fewer neighbours than the longest of their block are padded
//! with themselves; the padding is told by the counts, never by the distance, so that coincident
//! particles remain neighbours. The number of columns is even: passes take two at a time. Blocks are kept in chunks that are built and read in parallel.

use super::{Cursor, Grid};
use crate::bytes::held;
use crate::math::{Real, Vector};
use crate::neighbors::near::{self, Found, Near, Work};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::simd::space::{Open, Space, Wrapped};
use crate::simd::{LANES, Level};
use std::ops::Range;

/// The list of one block.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Neighbours of each row; 0 for rows beyond the last.
    pub counts: [u32; LANES],
    /// Number of columns: the largest count, rounded up to an even number.
    pub depth: u32,
    start: u32,
    width: Width,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    Narrow,
    Wide,
}

/// The columns of one block: per neighbour number, the rows of the eight neighbours less the first
/// row of the block.
#[derive(Clone, Copy, Debug)]
pub enum Entries<'a> {
    /// All fit in 16 bits.
    Narrow(&'a [[i16; LANES]]),
    /// Some do not.
    Wide(&'a [[i32; LANES]]),
}

/// The lists of up to [`CHUNK_ROWS`] consecutive rows.
#[derive(Default)]
pub struct Chunk {
    blocks: Vec<Block>,
    narrow: Vec<[i16; LANES]>,
    wide: Vec<[i32; LANES]>,
    scratch: Scratch,
    pairs: u64,
}

impl Chunk {
    /// The blocks, in row order: the first row of block `b` is the chunk's first row plus `8 b`.
    #[inline(always)]
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The columns of one of its blocks.
    #[inline(always)]
    pub fn entries(&self, block: &Block) -> Entries<'_> {
        let columns = block.start as usize..(block.start + block.depth) as usize;
        match block.width {
            Width::Narrow => Entries::Narrow(&self.narrow[columns]),
            Width::Wide => Entries::Wide(&self.wide[columns]),
        }
    }

    fn memory_bytes(&self) -> usize {
        held(&self.blocks)
            + held(&self.narrow)
            + held(&self.wide)
            + self.scratch.found.memory_bytes()
            + held(&self.scratch.runs)
    }
}

/// All pairs of rows within a radius, each pair in the lists of both rows.
#[derive(Default)]
pub struct NeighborList {
    chunks: Vec<Chunk>,
    rows: usize,
    reach: usize,
    radius: Real,
}

impl NeighborList {
    /// Lists all pairs with |x_i - x_j| < `radius` among the rows indexed by `grid`, which must have
    /// been ordered for this radius or a larger one. `positions` are those the grid was ordered by,
    /// permuted by that order. Within a list, neighbours come in the order in which the grid's runs come.
    pub fn build(&mut self, grid: &Grid, positions: &[Vector], radius: Real, parallelism: Parallelism) {
        self.build_at(Level::best(), (grid, &[]), &positions[..grid.rows()], radius, parallelism);
    }

    /// As [`build`](Self::build), with rows behind those of `grid`, indexed by two more: those of the
    /// first have a list too, those of the second are neighbours alone.
    pub(super) fn build_beside(
        &mut self,
        grid: &Grid,
        behind: &[Grid; 2],
        positions: &[Vector],
        radius: Real,
        parallelism: Parallelism,
    ) {
        let rows = grid.rows() + behind.iter().map(Grid::rows).sum::<usize>();
        self.build_at(Level::best(), (grid, behind), &positions[..rows], radius, parallelism);
    }

    fn build_at(
        &mut self,
        level: Level,
        (grid, behind): (&Grid, &[Grid]),
        positions: &[Vector],
        radius: Real,
        parallelism: Parallelism,
    ) {
        self.rows = grid.rows() + behind.first().map_or(0, Grid::rows);
        self.reach = positions.len();
        self.radius = radius;
        let used = self.rows.div_ceil(CHUNK_ROWS);
        // Chunks beyond the last row keep their memory for when there are more rows again.
        self.chunks.resize_with(used.max(self.chunks.len()), Chunk::default);
        self.chunks[used..].iter_mut().for_each(Chunk::clear);
        let search = &Search { grid, behind, rows: self.rows, positions, radius };
        if grid.periodic().any() {
            let space = Wrapped::new(grid.periodic());
            parallelism.each(self.rows, &mut self.chunks[..used], |number, chunk| {
                near::dispatch(level, Build { search, space, number, chunk });
            });
        } else {
            parallelism.each(self.rows, &mut self.chunks[..used], |number, chunk| {
                near::dispatch(level, Build { search, space: Open, number, chunk });
            });
        }
    }

    /// Number of rows with a list.
    #[inline]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Every neighbour is below this row: columns that are read at neighbours have as many.
    #[inline]
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// The radius of the list \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Number of listed pairs, each counted from both ends.
    pub fn pairs(&self) -> u64 {
        self.chunks.iter().map(|chunk| chunk.pairs).sum()
    }

    /// Number of slots, padding included: the work of a pass over the list.
    pub fn slots(&self) -> u64 {
        let blocks = self.chunks.iter().flat_map(|chunk| &chunk.blocks);
        blocks.map(|block| u64::from(block.depth) * LANES as u64).sum()
    }

    /// The chunks, in row order: chunk `c` holds the rows from `c *` [`CHUNK_ROWS`].
    #[inline]
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks[..self.rows.div_ceil(CHUNK_ROWS)]
    }

    #[inline]
    fn block(&self, row: usize) -> (&Chunk, &Block) {
        let chunk = &self.chunks[row / CHUNK_ROWS];
        (chunk, &chunk.blocks[row % CHUNK_ROWS / LANES])
    }

    /// Number of neighbours of a row.
    #[inline]
    pub fn count(&self, row: usize) -> usize {
        self.block(row).1.counts[row % LANES] as usize
    }

    /// Visits the neighbours of a row in the order of its list.
    #[inline]
    pub fn for_each(&self, row: usize, mut visit: impl FnMut(usize)) {
        let (chunk, block) = self.block(row);
        let (lane, first) = (row % LANES, row / LANES * LANES);
        let count = block.counts[lane] as usize;
        match chunk.entries(block) {
            Entries::Narrow(columns) => columns[..count].iter().for_each(|c| visit(shifted(first, c[lane].into()))),
            Entries::Wide(columns) => columns[..count].iter().for_each(|c| visit(shifted(first, c[lane]))),
        }
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.chunks) + self.chunks.iter().map(Chunk::memory_bytes).sum::<usize>()
    }
}

#[inline(always)]
fn shifted(first: usize, offset: i32) -> usize {
    first.wrapping_add_signed(offset as isize)
}

/// A block whose rows are spread over more than this many radii searches for each row by itself.
const TOGETHER: Real = 4.0;

/// Input of a list build.
struct Search<'a> {
    grid: &'a Grid,
    /// Indexes of the rows behind those of `grid`, one after the other.
    behind: &'a [Grid],
    /// Rows with a list.
    rows: usize,
    /// Positions of the rows of all.
    positions: &'a [Vector],
    radius: Real,
}

/// One chunk to be built.
struct Build<'a, S> {
    search: &'a Search<'a>,
    space: S,
    number: usize,
    chunk: &'a mut Chunk,
}

impl<S: Space> Work for Build<'_, S> {
    #[inline(always)]
    fn run<N: Near>(self, near: N) {
        let Build { search, space, number, chunk } = self;
        let first = number * CHUNK_ROWS;
        let rows = search.rows;
        let last = rows.min(first + CHUNK_ROWS);
        chunk.clear();
        let mut cursors: [Cursor; 3] = std::array::from_fn(|_| Cursor::default());
        for base in (first..last).step_by(LANES) {
            chunk.scratch.found.start(base, &search.positions[..rows]);
            let lanes = LANES.min(last - base);
            let together = search.extent(&chunk.scratch.found.centers);
            chunk.scratch.reach = base as u32..base as u32;
            // One search per turn: for all rows, or for each.
            for turn in 0..if together.is_some() { 1 } else { lanes } {
                let (low, high, lanes) = match together {
                    Some((low, high)) => (low, high, 0..lanes),
                    None => (search.positions[base + turn], search.positions[base + turn], turn..turn + 1),
                };
                chunk.scratch.find_runs(search, low, high, &mut cursors);
                for k in 0..chunk.scratch.runs.len() {
                    let run = chunk.scratch.runs[k].start as usize..chunk.scratch.runs[k].end as usize;
                    let limit = search.radius * search.radius;
                    near.find(space, limit, search.positions, run, lanes.clone(), &mut chunk.scratch.found);
                }
            }
            chunk.push(near, base, rows);
        }
    }
}

impl Search<'_> {
    /// The bounding box of the rows of a block, unless it is so large that they are better searched one by one.
    #[inline(always)]
    fn extent(&self, centers: &[Vector; LANES]) -> Option<(Vector, Vector)> {
        let periodic = self.grid.periodic();
        let wrapped = centers.map(|center| periodic.wrap(center));
        // Comparisons pass over NaN, except in the first lane, where it ends in `None`.
        let (mut low, mut high) = (wrapped[0], wrapped[0]);
        for x in wrapped {
            low = Vector::new(if x.x < low.x { x.x } else { low.x }, if x.y < low.y { x.y } else { low.y });
            high = Vector::new(if x.x > high.x { x.x } else { high.x }, if x.y > high.y { x.y } else { high.y });
        }
        let size = high - low;
        (size.x <= TOGETHER * self.radius && size.y <= TOGETHER * self.radius).then_some((low, high))
    }
}

/// Space to build a block in.
#[derive(Default)]
struct Scratch {
    found: Found,
    /// Where neighbours may be.
    runs: Vec<Range<u32>>,
    /// From the first to the last row of all runs of the block.
    reach: Range<u32>,
}

impl Scratch {
    /// Collects the runs around a box.
    #[inline(always)]
    fn find_runs(&mut self, search: &Search<'_>, low: Vector, high: Vector, cursors: &mut [Cursor; 3]) {
        self.runs.clear();
        let (cursor, cursors) = cursors.split_at_mut(1);
        let mut keep = |run: Range<u32>| {
            self.reach = self.reach.start.min(run.start)..self.reach.end.max(run.end);
            self.runs.push(run);
        };
        search.grid.for_each_run_around(low, high, search.radius, &mut cursor[0], &mut keep);
        let mut first = search.grid.rows() as u32;
        for (grid, cursor) in search.behind.iter().zip(cursors) {
            grid.for_each_run_around(low, high, search.radius, cursor, |run| {
                keep(run.start + first..run.end + first);
            });
            first += grid.rows() as u32;
        }
    }
}

impl Chunk {
    fn clear(&mut self) {
        self.blocks.clear();
        self.narrow.clear();
        self.wide.clear();
        self.pairs = 0;
    }

    /// Transposes the rows found for a block into columns.
    #[inline(always)]
    fn push(&mut self, near: impl Near, base: usize, rows: usize) {
        let (found, reach) = (&self.scratch.found, &self.scratch.reach);
        let counts = found.counts;
        self.pairs += counts.iter().map(|&count| u64::from(count)).sum::<u64>();
        let depth = counts.into_iter().fold(0, u32::max).next_multiple_of(2);
        // A lane beyond the last row is padded with the last row.
        let padding: [i16; LANES] = std::array::from_fn(|lane| lane.min(rows - 1 - base) as i16);
        let narrow = base - reach.start as usize <= 1 << 15 && reach.end as usize - base <= 1 << 15;
        let (start, width) = if narrow {
            let start = self.narrow.len();
            make_room(&mut self.narrow, depth as usize);
            near.columns(found, depth as usize, padding, &mut self.narrow);
            (start, Width::Narrow)
        } else {
            let start = self.wide.len();
            make_room(&mut self.wide, depth as usize);
            found.transpose(depth as usize, padding.map(i32::from), |offset| offset, &mut self.wide);
            (start, Width::Wide)
        };
        self.blocks.push(Block { counts, depth, start: start as u32, width });
    }
}

/// Room for some more columns, and an eighth of all: lists take most of the memory of a particle, and doubling
/// would leave half of it empty.
fn make_room<T>(columns: &mut Vec<T>, more: usize) {
    if columns.capacity() - columns.len() < more {
        columns.reserve_exact(more.max(columns.len() / 8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodic::{Periodic, PeriodicAxis};

    fn columns(list: &NeighborList) -> Vec<([u32; LANES], Vec<[i32; LANES]>)> {
        let blocks = list.chunks.iter().flat_map(|chunk| chunk.blocks.iter().map(move |block| (chunk, block)));
        let wide = |(chunk, block): (&Chunk, &Block)| match chunk.entries(block) {
            Entries::Narrow(columns) => (block.counts, columns.iter().map(|c| c.map(i32::from)).collect()),
            Entries::Wide(columns) => (block.counts, columns.to_vec()),
        };
        blocks.map(wide).collect()
    }

    #[test]
    fn every_level_builds_the_same_list() {
        let axis = Some(PeriodicAxis { from: 0.0, length: 30.0 });
        let mut state = 3u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as Real / (1u64 << 24) as Real * 30.0
        };
        for periodic in [Periodic::NONE, Periodic { x: axis, y: None }, Periodic { x: axis, y: axis }] {
            for (rows, squeeze) in [(0, 1.0), (1, 1.0), (7, 1.0), (9, 0.1), (50, 0.05), (700, 1.0), (1500, 1.0)] {
                let mut points: Vec<_> = (0..rows).map(|_| Vector::new(random() * squeeze, random())).collect();
                if rows > 1000 {
                    (points[500].x, points[900]) = (Real::NAN, Vector::splat(1e30));
                }
                let mut grid = Grid::new(periodic);
                let order = grid.order(&points, rows, 1.5, Parallelism::Serial);
                let sorted: Vec<_> = order.iter().map(|&row| points[row as usize]).collect();
                let mut oracle = NeighborList::default();
                oracle.build_at(Level::Scalar, (&grid, &[]), &sorted, 1.5, Parallelism::Serial);
                for level in Level::available() {
                    let mut list = NeighborList::default();
                    list.build_at(level, (&grid, &[]), &sorted, 1.5, Parallelism::Serial);
                    assert!(columns(&list) == columns(&oracle), "{level:?}, {rows} rows, {periodic:?}");
                }
            }
        }
    }
}
