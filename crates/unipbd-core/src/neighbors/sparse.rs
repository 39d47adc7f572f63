//! The index of a domain too wide for a table of all its cells: the occupied cells alone, sorted.

use super::cells::{Cell, Cells};
use super::cursor::Cursor;
use crate::bytes::held;
use crate::math::Vector;
use crate::parallel::Parallelism;
use rayon::prelude::*;
use std::ops::Range;

/// Occupied cells in order, and where the rows of each start.
#[derive(Default)]
pub(super) struct SparseIndex {
    /// Keys of the occupied cells, ascending.
    keys: Vec<u64>,
    /// First row of each occupied cell, and the number of rows at the end.
    starts: Vec<u32>,
    /// Scratch of the sort: key and row.
    pairs: Vec<(u64, u32)>,
}

/// Orders cells by row, then bin.
#[inline(always)]
fn key(row: i32, bin: i32) -> u64 {
    let ordered = |number: i32| u64::from(number as u32 ^ 0x8000_0000);
    ordered(row) << 32 | ordered(bin)
}

impl SparseIndex {
    /// Sorts the rows of `positions` into `order`, by cell and then by row.
    pub fn sort(&mut self, positions: &[Vector], cells: &Cells, order: &mut [u32], parallelism: Parallelism) {
        self.pairs.resize(positions.len(), (0, 0));
        parallelism.fill(&mut self.pairs, |row| {
            let Cell { row: cell_row, bin } = cells.cell(positions[row]);
            (key(cell_row, bin), row as u32)
        });
        // The row in the pair makes the order unique, so an unstable sort does.
        if parallelism.pays(positions.len()) {
            self.pairs.par_sort_unstable();
        } else {
            self.pairs.sort_unstable();
        }
        for (slot, &(_, row)) in order.iter_mut().zip(&self.pairs) {
            *slot = row;
        }
    }

    /// Indexes the cells of the last sort.
    pub fn index(&mut self) {
        self.keys.clear();
        self.starts.clear();
        for (row, &(key, _)) in self.pairs.iter().enumerate() {
            if self.keys.last() != Some(&key) {
                self.keys.push(key);
                self.starts.push(row as u32);
            }
        }
        self.starts.push(self.pairs.len() as u32);
    }

    /// Rows in the bins `first..=last` of a row of cells.
    #[inline]
    pub fn run(&self, row: i32, first: i32, last: i32, cursor: &mut Cursor) -> Range<u32> {
        let hints = &mut cursor.hints[(row & 3) as usize];
        hints.0 = self.seek(hints.0, key(row, first));
        hints.1 = self.seek(hints.1.max(hints.0), key(row, last) + 1);
        self.starts[hints.0 as usize]..self.starts[hints.1 as usize]
    }

    /// All rows in the rows of cells `first..=last`.
    pub fn whole_rows(&self, first: i32, last: i32) -> Range<u32> {
        let (low, high) = (self.seek(0, key(first, i32::MIN)), self.seek(0, key(last, i32::MAX)));
        self.starts[low as usize]..self.starts[high as usize]
    }

    /// Index of the first key not below `key`, found by growing steps from `hint`.
    #[inline]
    fn seek(&self, hint: u32, key: u64) -> u32 {
        let hint = (hint as usize).min(self.keys.len());
        let (mut low, mut high, mut stride) = (hint, hint, 1);
        while low > 0 && self.keys[low - 1] >= key {
            high = low - 1;
            low = high.saturating_sub(stride);
            stride *= 2;
        }
        if low == hint {
            while high < self.keys.len() && self.keys[high] < key {
                low = high + 1;
                high = (low + stride).min(self.keys.len());
                stride *= 2;
            }
        }
        (low + self.keys[low..high].partition_point(|&k| k < key)) as u32
    }

    pub fn memory_bytes(&self) -> usize {
        held(&self.keys) + held(&self.starts) + held(&self.pairs)
    }
}
