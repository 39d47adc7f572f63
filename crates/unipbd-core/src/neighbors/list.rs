//! The neighbour list, laid out for eight lanes (SELL-8: sliced ELLPACK with slices of eight rows).
//!
//! Eight consecutive rows make a block. The k-th neighbours of the eight lie side by side, so that
//! one load brings all of them, and they are stored relative to the first row of the block, in 16
//! bits where that is enough. Rows with fewer neighbours than the longest of their block are padded
//! with themselves; the padding is told by the counts, never by the distance, so that coincident
//! particles remain neighbours. Blocks are kept in chunks that are built and read in parallel.

use super::grid::{Cursor, Grid};
use super::periodic::Periodic;
use crate::math::{Real, Vector};
use crate::parallel::{CHUNK_ROWS, Parallelism};

/// Rows in a block.
pub const LANES: usize = 8;

/// The list of one block.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Neighbours of each row; 0 for rows beyond the last.
    pub counts: [u32; LANES],
    /// Smallest count: in this many columns no lane is padded.
    pub full: u32,
    /// Largest count: the number of columns.
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
        let search = Search { grid, positions, radius, periodic: grid.periodic() };
        if grid.periodic().any() {
            parallelism.each(self.rows, &mut self.chunks, |c, chunk| search.build_chunk::<true>(c, chunk));
        } else {
            parallelism.each(self.rows, &mut self.chunks, |c, chunk| search.build_chunk::<false>(c, chunk));
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
}

impl Scratch {
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
    periodic: Periodic,
}

impl Search<'_> {
    fn build_chunk<const PERIODIC: bool>(&self, number: usize, chunk: &mut Chunk) {
        let first = number * CHUNK_ROWS;
        let last = self.positions.len().min(first + CHUNK_ROWS);
        chunk.blocks.clear();
        chunk.narrow.clear();
        chunk.wide.clear();
        chunk.pairs = 0;
        let mut cursor = Cursor::default();
        for base in (first..last).step_by(LANES) {
            let mut counts = [0; LANES];
            for (lane, count) in counts.iter_mut().enumerate().take(last - base) {
                *count = self.find::<PERIODIC>(base + lane, lane, &mut chunk.scratch, &mut cursor);
            }
            chunk.push(base, counts, self.positions.len());
        }
    }

    /// Collects the neighbours of `row` in its lane of the scratch.
    #[inline(always)]
    fn find<const PERIODIC: bool>(&self, row: usize, lane: usize, scratch: &mut Scratch, cursor: &mut Cursor) -> u32 {
        let center = self.positions[row];
        let limit = self.radius * self.radius;
        let mut count = 0;
        self.grid.for_each_run(center, self.radius, cursor, |run| {
            if count + run.len() > scratch.room {
                scratch.grow(count + run.len());
            }
            let found = &mut scratch.found[lane * scratch.room..(lane + 1) * scratch.room];
            let (start, end) = (run.start as usize, run.end as usize);
            for (j, &other) in (start..end).zip(&self.positions[start..end]) {
                let mut apart = center - other;
                if PERIODIC {
                    apart = self.periodic.min_image(apart);
                }
                // Written always, kept if near: a branch here would be guessed wrong half the time.
                found[count] = j as u32;
                count += usize::from((apart.length_squared() < limit) & (j != row));
            }
        });
        count as u32
    }
}

impl Chunk {
    /// Transposes the lanes of the scratch into columns.
    fn push(&mut self, base: usize, counts: [u32; LANES], rows: usize) {
        let (full, depth) = (counts.into_iter().min().unwrap_or(0), counts.into_iter().max().unwrap_or(0));
        self.pairs += counts.iter().map(|&count| u64::from(count)).sum::<u64>();
        let fits = self.lanes(&counts).flatten().all(|&row| i16::try_from(row as i64 - base as i64).is_ok());
        // A lane beyond the last row is padded with the last row.
        let padding: [i32; LANES] = std::array::from_fn(|lane| (base + lane).min(rows - 1) as i32 - base as i32);
        let columns = depth as usize;
        let (start, width) = if fits {
            let start = self.narrow.len();
            self.narrow.resize(start + columns, padding.map(|offset| offset as i16));
            for lane in 0..LANES {
                let found = &self.scratch.found[lane * self.scratch.room..][..counts[lane] as usize];
                for (column, &row) in self.narrow[start..].iter_mut().zip(found) {
                    column[lane] = (row as i64 - base as i64) as i16;
                }
            }
            (start, Width::Narrow)
        } else {
            let start = self.wide.len();
            self.wide.resize(start + columns, padding);
            for lane in 0..LANES {
                let found = &self.scratch.found[lane * self.scratch.room..][..counts[lane] as usize];
                for (column, &row) in self.wide[start..].iter_mut().zip(found) {
                    column[lane] = (row as i64 - base as i64) as i32;
                }
            }
            (start, Width::Wide)
        };
        self.blocks.push(Block { counts, full, depth, start: start as u32, width });
    }

    fn lanes(&self, counts: &[u32; LANES]) -> impl Iterator<Item = &[u32]> {
        let room = self.scratch.room;
        counts.iter().enumerate().map(move |(lane, &count)| &self.scratch.found[lane * room..][..count as usize])
    }
}
