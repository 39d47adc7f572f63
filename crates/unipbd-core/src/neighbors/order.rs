//! A stable, parallel counting sort of rows by cell. The stable order is unique, so it does not
//! depend on how the work is shared.

use super::cells::{Cell, Cells};
use crate::bytes::held;
use crate::math::Vector;
use crate::parallel::{Aabb, CHUNK_ROWS, Parallelism};
use std::ops::Range;

/// The bounding box of the occupied cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub first: Cell,
    pub last: Cell,
}

impl Extent {
    const EMPTY: Extent =
        Extent { first: Cell { row: i32::MAX, bin: i32::MAX }, last: Cell { row: i32::MIN, bin: i32::MIN } };

    fn including(self, cell: Cell) -> Extent {
        self.joined(Extent { first: cell, last: cell })
    }

    fn joined(self, other: Extent) -> Extent {
        let first = Cell { row: self.first.row.min(other.first.row), bin: self.first.bin.min(other.first.bin) };
        let last = Cell { row: self.last.row.max(other.last.row), bin: self.last.bin.max(other.last.bin) };
        Extent { first, last }
    }

    pub fn of(positions: &[Vector], cells: &Cells, parallelism: Parallelism) -> Extent {
        if cells.keep_order() && !positions.is_empty() {
            let spread = Aabb::of(positions, parallelism);
            if spread.is_finite() {
                let (low, high) = spread.corners();
                return Extent { first: cells.cell(low), last: cells.cell(high) };
            }
        }
        parallelism.reduce(
            positions.len(),
            |rows| positions[rows].iter().fold(Extent::EMPTY, |extent, &x| extent.including(cells.cell(x))),
            Extent::joined,
        )
    }

    /// Bins in one row, and in all rows.
    pub fn bins(&self) -> (u64, u64) {
        if self.first.row > self.last.row {
            return (0, 0);
        }
        let along = (i64::from(self.last.bin) - i64::from(self.first.bin) + 1) as u64;
        let rows = (i64::from(self.last.row) - i64::from(self.first.row) + 1) as u64;
        (along, along * rows)
    }
}

/// Buckets of the coarse count that shares the work out.
const COARSE: usize = 512;

/// A range of cells to be sorted, and the rows that are in it.
struct Band<'a> {
    first_key: u32,
    first_row: u32,
    ends: &'a mut [u32],
    order: &'a mut [u32],
}

impl<'a> Band<'a> {
    fn split(self, cells: usize, rows: usize) -> (Band<'a>, Band<'a>) {
        let (order, order_right) = self.order.split_at_mut(rows);
        let (ends, ends_right) = self.ends.split_at_mut(cells);
        let left = Band { first_key: self.first_key, first_row: self.first_row, ends, order };
        let (first_key, first_row) = (self.first_key + cells as u32, self.first_row + rows as u32);
        (left, Band { first_key, first_row, ends: ends_right, order: order_right })
    }
}

/// Scratch of the sort, kept between calls.
#[derive(Default)]
pub(super) struct CountingSort {
    keys: Vec<u32>,
    /// Smallest and largest key of each chunk: lets a band skip the chunks that hold none of its keys.
    key_ranges: Vec<(u32, u32)>,
}

impl CountingSort {
    /// Writes to `order` the rows of `positions` sorted by cell, and to `ends` where each cell of
    /// `extent` ends in that order.
    pub fn sort(
        &mut self,
        positions: &[Vector],
        cells: &Cells,
        extent: &Extent,
        order: &mut [u32],
        ends: &mut Vec<u32>,
        parallelism: Parallelism,
    ) {
        let (along, all) = extent.bins();
        ends.resize(all as usize, 0);
        self.find_keys(positions, cells, extent.first, along as u32, parallelism);
        let band = Band { first_key: 0, first_row: 0, ends, order };
        if parallelism.pays(positions.len()) {
            let shift = (all / COARSE as u64).checked_ilog2().map_or(0, |bits| bits + 1);
            let tally = self.coarse_tally(shift);
            let least = positions.len() / (4 * rayon::current_num_threads());
            self.sort_halves(band, 0..COARSE, &tally, shift, least);
        } else {
            self.sort_band(band);
        }
    }

    /// Keys count the bins of `extent` row by row.
    fn find_keys(&mut self, positions: &[Vector], cells: &Cells, first: Cell, along: u32, parallelism: Parallelism) {
        self.keys.resize(positions.len(), 0);
        parallelism.fill(&mut self.keys, |row| {
            let cell = cells.cell(positions[row]);
            (cell.row - first.row) as u32 * along + (cell.bin - first.bin) as u32
        });
        self.key_ranges.resize(positions.len().div_ceil(CHUNK_ROWS), (0, 0));
        let keys = &self.keys;
        parallelism.each(positions.len(), &mut self.key_ranges, |chunk, range| {
            let chunk = &keys[chunk * CHUNK_ROWS..keys.len().min((chunk + 1) * CHUNK_ROWS)];
            *range = chunk.iter().fold((u32::MAX, 0), |(low, high), &key| (low.min(key), high.max(key)));
        });
    }

    /// Halves a band until it has few rows, and sorts the parts in parallel.
    fn sort_halves(&self, band: Band<'_>, buckets: Range<usize>, tally: &[u32; COARSE], shift: u32, least: usize) {
        if band.order.len() <= least || buckets.len() < 2 {
            return self.sort_band(band);
        }
        let (mut rows, mut middle) = (0, buckets.start);
        while middle + 1 < buckets.end && rows < band.order.len() / 2 {
            rows += tally[middle] as usize;
            middle += 1;
        }
        let cells = ((middle - buckets.start) << shift).min(band.ends.len());
        let (left, right) = band.split(cells, rows);
        rayon::join(
            || self.sort_halves(left, buckets.start..middle, tally, shift, least),
            || self.sort_halves(right, middle..buckets.end, tally, shift, least),
        );
    }

    fn coarse_tally(&self, shift: u32) -> [u32; COARSE] {
        Parallelism::Pool.reduce(
            self.keys.len(),
            |rows| {
                let mut tally = [0; COARSE];
                self.keys[rows].iter().for_each(|&key| tally[(key >> shift) as usize] += 1);
                tally
            },
            |mut a, b| {
                a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
                a
            },
        )
    }

    fn sort_band(&self, band: Band<'_>) {
        let (from, to) = (band.first_key, band.first_key + band.ends.len() as u32);
        band.ends.fill(0);
        self.for_each_in(from, to, |_, slot| band.ends[slot] += 1);
        let mut total = 0;
        for end in band.ends.iter_mut() {
            let count = *end;
            *end = total;
            total += count;
        }
        // Each cell's cursor starts at its first slot and stops at its end.
        self.for_each_in(from, to, |row, slot| {
            let cursor = &mut band.ends[slot];
            band.order[*cursor as usize] = row;
            *cursor += 1;
        });
        if band.first_row > 0 {
            band.ends.iter_mut().for_each(|end| *end += band.first_row);
        }
    }

    /// Calls `visit(row, key - from)` for all keys in `from..to`, in row order.
    #[inline(always)]
    fn for_each_in(&self, from: u32, to: u32, mut visit: impl FnMut(u32, usize)) {
        for (chunk, &(low, high)) in self.key_ranges.iter().enumerate() {
            if high < from || low >= to {
                continue;
            }
            let first = chunk * CHUNK_ROWS;
            let keys = &self.keys[first..self.keys.len().min(first + CHUNK_ROWS)];
            let whole = low >= from && high < to;
            for (k, &key) in keys.iter().enumerate() {
                if whole || (key >= from && key < to) {
                    visit((first + k) as u32, (key - from) as usize);
                }
            }
        }
    }

    pub fn memory_bytes(&self) -> usize {
        held(&self.keys) + held(&self.key_ranges)
    }
}
