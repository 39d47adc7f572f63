//! The loop over blocks and columns that every lane form shares, and the dispatch to the machine.
#![allow(unsafe_code)]

use super::{Pass, Sink};
use crate::neighbors::{Chunk, Entries};
use crate::simd::LANES;
use crate::simd::Level;
#[cfg(target_arch = "x86_64")]
use crate::simd::avx512::Avx512;
use crate::simd::lanes::{ColumnPair, Entry, Lanes, Turn, Two};
use crate::simd::portable::Portable;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use crate::simd::wasm::Simd128;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86::{Avx2, Sse2};
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

/// The lane form of a pass that sums `N` numbers per row.
pub(super) trait LanePass<const N: usize>: Pass<N> {
    /// The values of the eight rows themselves.
    type Own<F: Turn>: Copy;

    /// Reads the rows of a block: `entries` holds their offsets from row `base`, twice.
    ///
    /// # Safety
    /// The machine has the instruction set of `F`; `base` plus each offset is a row of the pass's columns.
    unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F>;

    /// The contributions of two neighbours of each row to the sums. `counted` clears the lanes that are padding.
    ///
    /// # Safety
    /// As for [`own`](Self::own).
    unsafe fn terms<F: Turn, E: Entry>(
        &self,
        own: &Self::Own<F>,
        base: usize,
        entries: &ColumnPair<E>,
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
        // SAFETY: this level is chosen only where the machine has these sets.
        Level::Avx512 => unsafe { run_avx512(pass, chunk, first, rows, sink) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: this level is chosen only where the machine has AVX2.
        Level::Avx2 => unsafe { run_avx2(pass, chunk, first, rows, sink) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: SSE2 is in the baseline.
        Level::Sse2 => unsafe { run_chunk::<Two<Sse2>, P, N>(pass, chunk, first, rows, sink) },
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        // SAFETY: the build has these registers.
        Level::Simd128 => unsafe { run_chunk::<Two<Simd128>, P, N>(pass, chunk, first, rows, sink) },
        // SAFETY: plain arrays run anywhere.
        _ => unsafe { run_chunk::<Two<Portable>, P, N>(pass, chunk, first, rows, sink) },
    }
}

/// Bytes of the entries of a chunk that are fetched early; those after them follow by themselves.
#[cfg(target_arch = "x86_64")]
const FETCHED_ENTRIES: usize = 512;

/// Asks for the start of a chunk's list. Chunks lie anywhere, so the machine cannot guess where the next one starts.
pub(super) fn prefetch(chunk: &Chunk) {
    #[cfg(target_arch = "x86_64")]
    {
        let blocks = chunk.blocks();
        fetch(blocks.as_ptr().cast(), size_of_val(blocks));
        if let Some(Entries::Narrow(columns)) = blocks.first().map(|block| chunk.entries(block)) {
            fetch(columns.as_ptr().cast(), FETCHED_ENTRIES);
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = chunk; // Stable Rust has no way to ask here.
}

#[cfg(target_arch = "x86_64")]
fn fetch(from: *const i8, bytes: usize) {
    const LINE: usize = 64;
    for offset in (0..bytes).step_by(LINE) {
        // SAFETY: SSE is in the baseline, and a prefetch may name any address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.wrapping_add(offset)) };
    }
}

/// # Safety
/// As for [`run`], on a machine with AVX2, AVX-512F and AVX-512VL.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512vl")]
unsafe fn run_avx512<P: LanePass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    first: usize,
    rows: usize,
    sink: &mut impl Sink<N>,
) {
    // SAFETY: passed on to the caller.
    unsafe { run_chunk::<Avx512, P, N>(pass, chunk, first, rows, sink) }
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
    unsafe { run_chunk::<Two<Avx2>, P, N>(pass, chunk, first, rows, sink) }
}

/// # Safety
/// As for [`run`], on a machine with the instruction set of `F`.
#[inline(always)]
unsafe fn run_chunk<F: Turn, P: LanePass<N>, const N: usize>(
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
                pass.own::<F>(base, &[[0, 1, 2, 3, 4, 5, 6, 7]; 2])
            } else {
                // Lanes beyond the last row repeat it, as their padding does.
                pass.own::<F>(base, &[std::array::from_fn(|lane| lane.min(valid - 1) as i16); 2])
            };
            let counts = F::counts(&block.counts);
            match chunk.entries(block) {
                Entries::Narrow(columns) => sum(pass, &own, base, columns, counts),
                Entries::Wide(columns) => sum(pass, &own, base, columns, counts),
            }
        };
        let sums = pass.finish(sums).map(F::Sums::to_array);
        sink.store(row..row + valid, &sums);
    }
}

/// # Safety
/// As for [`run_chunk`].
#[inline(always)]
unsafe fn sum<F: Turn, E: Entry, P: LanePass<N>, const N: usize>(
    pass: &P,
    own: &P::Own<F>,
    base: usize,
    columns: &[[E; LANES]],
    mut counts: F::Counts,
) -> [F::Sums; N] {
    // SAFETY: passed on to the caller.
    unsafe {
        let mut sums = [F::Sums::splat(0.0); N];
        // One loop, not a plain and a masked one: guessing the end of a second loop wrong costs more than the masks.
        for pair in columns.as_chunks::<2>().0 {
            let terms = pass.terms(own, base, pair, |value: F| value.where_counted(counts));
            for n in 0..N {
                sums[n] = terms[n].added_to(sums[n]);
            }
            counts = F::next(counts);
        }
        sums
    }
}
