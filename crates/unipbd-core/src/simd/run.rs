//! The loop over blocks and columns that every lane form shares, and the dispatch to the machine.
#![allow(unsafe_code)]

use super::Level;
use super::lanes::{Entry, Lanes};
use super::passes::{Pass, Sink};
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Sse2};
use crate::neighbors::{Chunk, Entries, LANES};

/// The lane form of a pass that sums `N` numbers per row.
pub(super) trait LanePass<const N: usize>: Pass<N> {
    /// What it reads of the eight rows themselves.
    type Own<F: Lanes>: Copy;

    /// Reads the rows of a block: `column` holds their offsets from row `base`.
    ///
    /// # Safety
    /// The machine has the instruction set of `F`; `base` plus each offset is a row of the pass's columns.
    unsafe fn own<F: Lanes>(&self, base: usize, column: &[i16; LANES]) -> Self::Own<F>;

    /// What one neighbour of each row adds to the sums. `counted` clears the lanes that are padding.
    ///
    /// # Safety
    /// As for [`own`](Self::own).
    unsafe fn terms<F: Lanes, E: Entry>(
        &self,
        own: &Self::Own<F>,
        base: usize,
        column: &[E; LANES],
        counted: impl Fn(F) -> F,
    ) -> [F; N];
}

/// Runs a pass over the `rows` rows of a chunk, which starts at row `first`, and stores the sums of
/// each block under the numbers of its rows in the chunk.
///
/// # Safety
/// Every entry of the chunk plus its block's first row, and every row of the chunk, is a row of all
/// columns of the pass.
pub(super) unsafe fn run<P: LanePass<N>, const N: usize>(
    level: Level,
    pass: &P,
    chunk: &Chunk,
    first: usize,
    rows: usize,
    sink: &mut impl Sink<N>,
) {
    match level {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: this level is chosen only where the machine has AVX2.
        Level::Avx2 => unsafe { run_avx2(pass, chunk, first, rows, sink) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: SSE2 is in the baseline.
        Level::Sse2 => unsafe { run_chunk::<Sse2, P, N>(pass, chunk, first, rows, sink) },
        // SAFETY: plain arrays run anywhere.
        _ => unsafe { run_chunk::<Portable, P, N>(pass, chunk, first, rows, sink) },
    }
}

/// # Safety
/// As for [`run`], on a machine with AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn run_avx2<P: LanePass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    first: usize,
    rows: usize,
    sink: &mut impl Sink<N>,
) {
    // SAFETY: passed on to the caller.
    unsafe { run_chunk::<Avx2, P, N>(pass, chunk, first, rows, sink) }
}

/// # Safety
/// As for [`run`], on a machine with the instruction set of `F`.
#[inline(always)]
unsafe fn run_chunk<F: Lanes, P: LanePass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    first: usize,
    rows: usize,
    sink: &mut impl Sink<N>,
) {
    for (number, block) in chunk.blocks().iter().enumerate() {
        let row = number * LANES;
        let base = first + row;
        let valid = LANES.min(rows - row);
        // SAFETY: passed on to the caller.
        let sums = unsafe {
            let own = if valid == LANES {
                pass.own::<F>(base, &[0, 1, 2, 3, 4, 5, 6, 7])
            } else {
                // Lanes beyond the last row repeat it, as their padding does.
                pass.own::<F>(base, &std::array::from_fn(|lane| lane.min(valid - 1) as i16))
            };
            let counts = F::counts(&block.counts);
            match chunk.entries(block) {
                Entries::Narrow(columns) => sum(pass, &own, base, columns, counts),
                Entries::Wide(columns) => sum(pass, &own, base, columns, counts),
            }
        };
        let sums = pass.finish(sums).map(F::to_array);
        sink.store(row..row + valid, &sums);
    }
}

/// # Safety
/// As for [`run_chunk`].
#[inline(always)]
unsafe fn sum<F: Lanes, E: Entry, P: LanePass<N>, const N: usize>(
    pass: &P,
    own: &P::Own<F>,
    base: usize,
    columns: &[[E; LANES]],
    counts: F::Counts,
) -> [F; N] {
    // SAFETY: passed on to the caller.
    unsafe {
        let mut sums = [F::splat(0.0); N];
        // One loop, not a plain and a masked one: guessing the end of a second loop wrong costs more than the masks.
        // Two columns a turn: from loads to sums is a long chain, and two of them overlap better than one.
        for (k, pair) in (0..).step_by(2).zip(columns.as_chunks::<2>().0) {
            let first = pass.terms(own, base, &pair[0], |value: F| value.where_counted(counts, k));
            let second = pass.terms(own, base, &pair[1], |value: F| value.where_counted(counts, k + 1));
            for n in 0..N {
                sums[n] = (sums[n] + first[n]) + second[n];
            }
        }
        sums
    }
}
