//! The neighbour list, laid out for eight lanes (SELL-8: sliced ELLPACK with slices of eight rows).
//!
//! Eight consecutive rows make a block. The k-th neighbours of the eight lie side by side, so that
//! one load brings all of them, and they are stored relative to the first row of the block, in 16
//! bits where that is enough. Rows with fewer neighbours than the longest of their block are padded
//! with themselves; the padding is told by the counts, never by the distance, so that coincident
//! particles remain neighbours. The number of columns is even: passes take two at a time. Blocks are kept in chunks that are built and read in parallel.

use super::grid::{Cursor, Grid};
use crate::math::{Real, Vector};
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::simd::near::{self, Near, SPARE, Work};
use crate::simd::space::{Open, Space, Wrapped};
use std::ops::Range;

/// Rows in a block.
pub const LANES: usize = 8;

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
        self.blocks.capacity() * size_of::<Block>()
            + self.narrow.capacity() * 16
            + self.wide.capacity() * 32
            + self.scratch.found.capacity() * 4
            + self.scratch.runs.capacity() * 8
    }
}

/// All pairs of rows within a radius, each pair in the lists of both rows.
#[derive(Default)]
pub struct NeighborList {
    chunks: Vec<Chunk>,
    rows: usize,
    radius: Real,
}

impl NeighborList {
    /// Lists all pairs with |x_i - x_j| < `radius` among the rows indexed by `grid`, which must have
    /// been ordered for this radius or a larger one. `positions` are those the grid was ordered by,
    /// permuted by that order. Within a list, neighbours come in the order in which the grid's runs come.
    pub fn build(&mut self, grid: &Grid, positions: &[Vector], radius: Real, parallelism: Parallelism) {
        let positions = &positions[..grid.rows()];
        self.rows = positions.len();
        self.radius = radius;
        self.chunks.resize_with(self.rows.div_ceil(CHUNK_ROWS), Chunk::default);
        let search = &Search { grid, positions, radius };
        if grid.periodic().any() {
            let space = Wrapped::new(grid.periodic());
            parallelism.each(self.rows, &mut self.chunks, |number, chunk| {
                near::dispatch(Build { search, space, number, chunk });
            });
        } else {
            parallelism.each(self.rows, &mut self.chunks, |number, chunk| {
                near::dispatch(Build { search, space: Open, number, chunk });
            });
        }
    }

    /// Number of rows with a list.
    #[inline]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The radius of the list [m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Number of listed pairs, each counted from both ends.
    pub fn pairs(&self) -> u64 {
        self.chunks.iter().map(|chunk| chunk.pairs).sum()
    }

    /// Number of slots, padding included: what a pass over the list computes.
    pub fn slots(&self) -> u64 {
        let blocks = self.chunks.iter().flat_map(|chunk| &chunk.blocks);
        blocks.map(|block| u64::from(block.depth) * LANES as u64).sum()
    }

    /// The chunks, in row order: chunk `c` holds the rows from `c *` [`CHUNK_ROWS`].
    #[inline]
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
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

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        self.chunks.capacity() * size_of::<Chunk>() + self.chunks.iter().map(Chunk::memory_bytes).sum::<usize>()
    }
}

#[inline(always)]
fn shifted(first: usize, offset: i32) -> usize {
    first.wrapping_add_signed(offset as isize)
}

/// The rows found for the eight lanes of one block, before they are transposed.
#[derive(Default)]
struct Scratch {
    found: Vec<u32>,
    /// Room per lane.
    room: usize,
    /// Where one row's neighbours may be.
    runs: Vec<Range<u32>>,
}

impl Scratch {
    fn list(&self, lane: usize, count: u32) -> &[u32] {
        &self.found[lane * self.room..][..count as usize]
    }

    /// Makes room for `room` rows per lane, keeping what lanes up to `lane` have found.
    #[cold]
    fn grow(&mut self, room: usize) {
        let room = room.next_multiple_of(64);
        let mut found = vec![0; room * LANES];
        if self.room > 0 {
            for (old, new) in self.found.chunks(self.room).zip(found.chunks_mut(room)) {
                new[..self.room].copy_from_slice(old);
            }
        }
        (self.found, self.room) = (found, room);
    }
}

struct Search<'a> {
    grid: &'a Grid,
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
        let last = search.positions.len().min(first + CHUNK_ROWS);
        chunk.blocks.clear();
        chunk.narrow.clear();
        chunk.wide.clear();
        chunk.pairs = 0;
        let mut cursor = Cursor::default();
        for base in (first..last).step_by(LANES) {
            let mut counts = [0; LANES];
            for (lane, count) in counts.iter_mut().enumerate().take(last - base) {
                *count = search.find(near, space, base + lane, lane, &mut chunk.scratch, &mut cursor);
            }
            chunk.push(base, counts, search.positions.len());
        }
    }
}

impl Search<'_> {
    /// Collects the neighbours of `row` in its lane of the scratch.
    #[inline(always)]
    fn find<N: Near, S: Space>(
        &self,
        near: N,
        space: S,
        row: usize,
        lane: usize,
        scratch: &mut Scratch,
        cursor: &mut Cursor,
    ) -> u32 {
        let center = self.positions[row];
        let limit = self.radius * self.radius;
        scratch.runs.clear();
        let own = row as u32;
        self.grid.for_each_run(center, self.radius, cursor, |run| {
            // The row itself is left out by searching before and after it.
            if run.contains(&own) {
                scratch.runs.extend([run.start..own, own + 1..run.end]);
            } else {
                scratch.runs.push(run);
            }
        });
        let mut count = 0;
        for k in 0..scratch.runs.len() {
            let run = scratch.runs[k].start as usize..scratch.runs[k].end as usize;
            if count + run.len() + SPARE > scratch.room {
                scratch.grow(count + run.len() + SPARE);
            }
            let found = &mut scratch.found[lane * scratch.room + count..(lane + 1) * scratch.room];
            count += near.find(space, center, limit, self.positions, run, found);
        }
        count as u32
    }
}

impl Chunk {
    /// Transposes the lanes of the scratch into columns.
    #[inline(always)]
    fn push(&mut self, base: usize, counts: [u32; LANES], rows: usize) {
        self.pairs += counts.iter().map(|&count| u64::from(count)).sum::<u64>();
        let depth = counts.into_iter().max().unwrap_or(0).next_multiple_of(2);
        let lists: [&[u32]; LANES] = std::array::from_fn(|lane| self.scratch.list(lane, counts[lane]));
        // A lane beyond the last row is padded with the last row.
        let padding: [i32; LANES] = std::array::from_fn(|lane| lane.min(rows - 1 - base) as i32);
        let (start, width) = if lists.iter().all(|list| fits_narrow(list, base)) {
            let start = self.narrow.len();
            self.narrow.resize(start + depth as usize, padding.map(|offset| offset as i16));
            transpose(&mut self.narrow[start..], lists, |row| relative(row, base) as i16);
            (start, Width::Narrow)
        } else {
            let start = self.wide.len();
            self.wide.resize(start + depth as usize, padding);
            transpose(&mut self.wide[start..], lists, |row| relative(row, base));
            (start, Width::Wide)
        };
        self.blocks.push(Block { counts, depth, start: start as u32, width });
    }
}

/// A row as seen from the first row of a block.
#[inline(always)]
fn relative(row: u32, base: usize) -> i32 {
    row.wrapping_sub(base as u32) as i32
}

#[inline(always)]
fn fits_narrow(list: &[u32], base: usize) -> bool {
    let (low, high) = list.iter().map(|&row| relative(row, base)).fold((0, 0), |(l, h), o| (o.min(l), o.max(h)));
    low >= i32::from(i16::MIN) && high <= i32::from(i16::MAX)
}

#[inline(always)]
fn transpose<E>(columns: &mut [[E; LANES]], lists: [&[u32]; LANES], entry: impl Fn(u32) -> E) {
    for (lane, list) in lists.into_iter().enumerate() {
        for (column, &row) in columns.iter_mut().zip(list) {
            column[lane] = entry(row);
        }
    }
}
