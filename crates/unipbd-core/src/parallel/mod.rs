//! Loops over rows, on one thread or on all of a pool, with results that never depend on how many.
//!
//! Outputs are written in fixed chunks, and reductions follow a fixed binary tree of chunks, so
//! that even floating-point sums come out the same on any number of threads.

mod aabb;

use crate::math::{Real, larger};
use rayon::prelude::*;
use std::ops::Range;

pub(crate) use aabb::{Aabb, GROUP};

/// Rows one task works on: small enough to balance, large enough to hide the cost of a task.
pub const CHUNK_ROWS: usize = 512;

/// Below this many rows waking a pool costs more than it saves.
pub const SERIAL_BELOW: usize = 4096;

/// Pieces of a loop for each thread.
const PIECES: usize = 8;

/// Whether loops may use a thread pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parallelism {
    /// Everything on the calling thread.
    #[default]
    Serial,
    /// On the rayon pool the caller runs in.
    Pool,
}

/// Loops over chunks of several columns of equal length.
macro_rules! chunks_of_columns {
    ($($(#[$doc:meta])* $name:ident($($column:ident: $type:ident),+))+) => {
        impl Parallelism {$(
            $(#[$doc])*
            pub fn $name<$($type: Send),+>(
                self,
                $($column: &mut [$type],)+
                work: impl Fn(usize, $(&mut [$type]),+) + Sync,
            ) {
                let rows = [$($column.len()),+];
                assert!(rows.iter().all(|&r| r == rows[0]), "columns of one particle set have one length");
                if self.pays(rows[0]) {
                    let columns = ($($column.par_chunks_mut(CHUNK_ROWS),)+).into_par_iter().enumerate();
                    let columns = columns.with_max_len(piece(rows[0].div_ceil(CHUNK_ROWS)));
                    columns.for_each(|(c, ($($column,)+))| work(c * CHUNK_ROWS, $($column),+));
                } else {
                    for first in (0..rows[0]).step_by(CHUNK_ROWS) {
                        let chunk = first..rows[0].min(first + CHUNK_ROWS);
                        work(first, $(&mut $column[chunk.clone()]),+);
                    }
                }
            }
        )+}
    };
}

chunks_of_columns! {
    /// As [`chunks`](Self::chunks), for two columns of equal length.
    chunks2(a: A, b: B)
    /// As [`chunks`](Self::chunks), for three columns of equal length.
    chunks3(a: A, b: B, c: C)
    /// As [`chunks`](Self::chunks), for four columns of equal length.
    chunks4(a: A, b: B, c: C, d: D)
}

impl Parallelism {
    /// Whether a loop over `rows` is worth spreading over the pool.
    #[inline]
    pub fn pays(self, rows: usize) -> bool {
        self == Parallelism::Pool && rows >= SERIAL_BELOW && rayon::current_num_threads() > 1
    }

    /// `out[row] = value(row)`.
    pub fn fill<T: Send>(self, out: &mut [T], value: impl Fn(usize) -> T + Sync) {
        self.chunks(out, |first, chunk| {
            for (k, slot) in chunk.iter_mut().enumerate() {
                *slot = value(first + k);
            }
        });
    }

    /// `change(row, &mut out[row])`.
    pub fn update<T: Send>(self, out: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
        self.chunks(out, |first, chunk| {
            for (k, slot) in chunk.iter_mut().enumerate() {
                change(first + k, slot);
            }
        });
    }

    /// `out[row] = source[order[row]]`.
    pub fn gather<T: Copy + Send + Sync>(self, out: &mut [T], source: &[T], order: &[u32]) {
        self.chunks(out, |first, chunk| {
            let count = chunk.len();
            for (slot, &from) in chunk.iter_mut().zip(&order[first..first + count]) {
                *slot = source[from as usize];
            }
        });
    }

    /// Hands `out` out in chunks of [`CHUNK_ROWS`], each with the row it starts at.
    pub fn chunks<T: Send>(self, out: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
        if self.pays(out.len()) {
            let chunks = out.par_chunks_mut(CHUNK_ROWS).enumerate();
            let most = piece(chunks.len());
            chunks.with_max_len(most).for_each(|(c, chunk)| work(c * CHUNK_ROWS, chunk));
        } else {
            out.chunks_mut(CHUNK_ROWS).enumerate().for_each(|(c, chunk)| work(c * CHUNK_ROWS, chunk));
        }
    }

    /// Runs `work` on each of a few large items (chunks of a list, bands of a sort) that stand for `rows` rows.
    pub fn each<T: Send>(self, rows: usize, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        if self.pays(rows) {
            let most = piece(items.len());
            items.par_iter_mut().enumerate().with_max_len(most).for_each(|(k, item)| work(k, item));
        } else {
            items.iter_mut().enumerate().for_each(|(k, item)| work(k, item));
        }
    }

    /// Combines `leaf` over fixed chunks of `0..rows` along a fixed tree. `leaf(0..0)` must be the neutral element.
    pub fn reduce<T: Send>(
        self,
        rows: usize,
        leaf: impl Fn(Range<usize>) -> T + Sync,
        combine: impl Fn(T, T) -> T + Sync,
    ) -> T {
        if self.pays(rows) { pool_tree(0..rows, &leaf, &combine) } else { serial_tree(0..rows, &leaf, &combine) }
    }

    /// Largest `value(row)`, or negative infinity without rows. NaN is passed over.
    pub fn max(self, rows: usize, value: impl Fn(usize) -> Real + Sync) -> Real {
        let of_chunk = |rows: Range<usize>| rows.map(&value).fold(Real::NEG_INFINITY, |most, next| larger(next, most));
        self.reduce(rows, of_chunk, larger)
    }

    /// Sum of `value(row)` in double precision, in an order that depends on `rows` alone.
    pub fn sum(self, rows: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
        self.reduce(rows, |range| range.map(&value).sum::<f64>(), |a, b| a + b)
    }

    /// Whether `test(row)` holds for every row.
    pub fn all(self, rows: usize, test: impl Fn(usize) -> bool + Sync) -> bool {
        self.reduce(rows, |mut range| range.all(&test), |a, b| a && b)
    }
}

/// Chunks that one thread takes at most in one piece: rayon left alone deals out quarters of a loop on two
/// threads, and at 10,000 rows one of them waits for the other a third of the time.
fn piece(chunks: usize) -> usize {
    (chunks / (PIECES * rayon::current_num_threads())).max(1)
}

/// The middle of a range, on a chunk border; `None` when the range is a leaf.
fn middle(range: &Range<usize>) -> Option<usize> {
    let chunks = range.len().div_ceil(CHUNK_ROWS);
    (chunks > 1).then(|| range.start + chunks.div_ceil(2) * CHUNK_ROWS)
}

fn serial_tree<T>(range: Range<usize>, leaf: &impl Fn(Range<usize>) -> T, combine: &impl Fn(T, T) -> T) -> T {
    match middle(&range) {
        None => leaf(range),
        Some(mid) => {
            let left = serial_tree(range.start..mid, leaf, combine);
            combine(left, serial_tree(mid..range.end, leaf, combine))
        }
    }
}

fn pool_tree<T: Send>(
    range: Range<usize>,
    leaf: &(impl Fn(Range<usize>) -> T + Sync),
    combine: &(impl Fn(T, T) -> T + Sync),
) -> T {
    match middle(&range) {
        None => leaf(range),
        Some(mid) => {
            let (left, right) =
                rayon::join(|| pool_tree(range.start..mid, leaf, combine), || pool_tree(mid..range.end, leaf, combine));
            combine(left, right)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_the_same_bits_on_any_number_of_threads() {
        let rows = 40_001;
        let value = |row: usize| 1.0 / (1.0 + row as f64);
        let serial = Parallelism::Serial.sum(rows, value);
        assert!((serial - 11.174).abs() < 1e-3, "{serial}");
        for threads in [1, 2, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let sum = pool.install(|| Parallelism::Pool.sum(rows, value));
            assert_eq!(sum.to_bits(), serial.to_bits());
        }
    }

    #[test]
    fn every_row_is_written_once_with_its_own_index() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        for rows in [0, 1, 511, 512, 513, 4096, 10_007] {
            let mut out = vec![0; rows];
            pool.install(|| Parallelism::Pool.update(&mut out, |row, slot| *slot += row));
            assert!(out.iter().enumerate().all(|(row, &value)| row == value));
        }
    }

    #[test]
    fn largest_value_passes_over_nan_and_knows_the_empty_set() {
        let values = [1.0, Real::NAN, 3.0, 2.0];
        assert_eq!(Parallelism::Serial.max(4, |row| values[row]), 3.0);
        assert_eq!(Parallelism::Serial.max(0, |row| values[row]), Real::NEG_INFINITY);
    }
}
