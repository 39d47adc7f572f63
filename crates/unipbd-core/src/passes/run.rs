//! The loop over blocks and columns of the list in lanes, and the dispatch to the instruction set of the machine.
#![allow(unsafe_code)]

use super::{Pass, Rows, Sink};
use crate::math::Vector;
use crate::neighbors::{Chunk, Entries};
#[cfg(target_arch = "x86_64")]
use crate::simd::avx512::Avx512;
use crate::simd::lanes::{ColumnPair, Entry, Lanes, Turn, Two};
use crate::simd::portable::Portable;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use crate::simd::wasm::Simd128;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86::{Avx2, Sse2};
use crate::simd::{LANES, Level, Record};
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
use std::ops::Range;

/// Runs a pass over the `rows` of a chunk and stores the sums of each block under the numbers of its rows in the chunk.
///
/// # Safety
/// Every entry of the chunk plus its block's first row, and every row of the chunk, is below `reach`.
pub(super) unsafe fn run<P: Pass<N>, const N: usize>(
    level: Level,
    pass: &P,
    chunk: &Chunk,
    rows: Range<usize>,
    reach: usize,
    sink: &mut impl Sink<N>,
) {
    match level {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: this level is chosen only where the machine has these sets.
        Level::Avx512 => unsafe { run_avx512(pass, chunk, rows, reach, sink) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: this level is chosen only where the machine has AVX2.
        Level::Avx2 => unsafe { run_avx2(pass, chunk, rows, reach, sink) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: SSE2 is in the baseline.
        Level::Sse2 => unsafe { run_chunk::<Two<Sse2>, P, N>(pass, chunk, rows, reach, sink) },
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        // SAFETY: the build has these registers.
        Level::Simd128 => unsafe { run_chunk::<Two<Simd128>, P, N>(pass, chunk, rows, reach, sink) },
        // SAFETY: plain arrays run anywhere.
        _ => unsafe { run_chunk::<Two<Portable>, P, N>(pass, chunk, rows, reach, sink) },
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
unsafe fn run_avx512<P: Pass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    rows: Range<usize>,
    reach: usize,
    sink: &mut impl Sink<N>,
) {
    // SAFETY: passed on to the caller.
    unsafe { run_chunk::<Avx512, P, N>(pass, chunk, rows, reach, sink) }
}

/// # Safety
/// As for [`run`], on a machine with AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn run_avx2<P: Pass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    rows: Range<usize>,
    reach: usize,
    sink: &mut impl Sink<N>,
) {
    // SAFETY: passed on to the caller.
    unsafe { run_chunk::<Two<Avx2>, P, N>(pass, chunk, rows, reach, sink) }
}

/// # Safety
/// As for [`run`], on a machine with the instruction set of `F`.
#[inline(always)]
unsafe fn run_chunk<F: Turn, P: Pass<N>, const N: usize>(
    pass: &P,
    chunk: &Chunk,
    rows: Range<usize>,
    reach: usize,
    sink: &mut impl Sink<N>,
) {
    for (number, block) in chunk.blocks().iter().enumerate() {
        let row = number * LANES;
        let base = rows.start + row;
        let valid = LANES.min(rows.len() - row);
        // SAFETY: passed on to the caller.
        let sums = unsafe {
            let counts = F::counts(&block.counts);
            // Lanes beyond the last row repeat it, as their padding does.
            let lanes = if valid == LANES { ALL } else { std::array::from_fn(|lane| lane.min(valid - 1) as i16) };
            let own = pass.own(BlockRows::<F, i16> { base, entries: &[lanes; 2], counts, reach });
            match chunk.entries(block) {
                Entries::Narrow(columns) => sum::<F, _, P, N>(pass, &own, base, columns, counts, reach),
                Entries::Wide(columns) => sum::<F, _, P, N>(pass, &own, base, columns, counts, reach),
            }
        };
        let sums = pass.finish(sums).map(F::Sums::to_array);
        sink.store(row..row + valid, &sums);
    }
}

/// Offsets of all rows of a block.
const ALL: [i16; LANES] = [0, 1, 2, 3, 4, 5, 6, 7];

/// # Safety
/// As for [`run_chunk`].
#[inline(always)]
unsafe fn sum<F: Turn, E: Entry, P: Pass<N>, const N: usize>(
    pass: &P,
    own: &P::Own<F>,
    base: usize,
    columns: &[[E; LANES]],
    mut counts: F::Counts,
    reach: usize,
) -> [F::Sums; N] {
    // SAFETY: passed on to the caller.
    unsafe {
        let mut sums = [F::Sums::splat(0.0); N];
        // One loop, not a plain and a masked one: guessing the end of a second loop wrong costs more than the masks.
        for entries in columns.as_chunks::<2>().0 {
            let terms = pass.terms(own, BlockRows { base, entries, counts, reach });
            for n in 0..N {
                sums[n] = terms[n].added_to(sums[n]);
            }
            counts = F::next(counts);
        }
        sums
    }
}

/// Eight rows of a block, by two columns of its list. Whoever makes one vouches that the machine has the instruction set
/// of `F` and that `base` plus each entry is below `reach`.
struct BlockRows<'a, F: Turn, E> {
    base: usize,
    entries: &'a ColumnPair<E>,
    counts: F::Counts,
    /// Rows that every column must have.
    reach: usize,
}

impl<F: Turn, E> Clone for BlockRows<'_, F, E> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: Turn, E> Copy for BlockRows<'_, F, E> {}

impl<F: Turn, E> BlockRows<'_, F, E> {
    /// The first row of the block in a column.
    #[inline(always)]
    fn start<T>(self, column: &[T]) -> *const T {
        assert!(column.len() >= self.reach, "a column has as many rows as the list reaches");
        column.as_ptr().wrapping_add(self.base)
    }
}

impl<F: Turn, E: Entry> Rows for BlockRows<'_, F, E> {
    type Value = F;

    #[inline(always)]
    fn numbers(self, column: &[f32]) -> F {
        // SAFETY: the maker of `self` vouches for it, and the column is long enough.
        unsafe { F::gather(self.start(column), self.entries) }
    }

    #[inline(always)]
    fn vectors(self, column: &[Vector]) -> (F, F) {
        // SAFETY: as above.
        unsafe { F::gather_vectors(self.start(column), self.entries) }
    }

    #[inline(always)]
    fn records(self, packed: &[Record], _: impl Fn(usize) -> Record) -> ((F, F), (F, F)) {
        // SAFETY: as above.
        unsafe { F::gather_records(self.start(packed), self.entries) }
    }

    #[inline(always)]
    fn order(self) -> F {
        // SAFETY: the maker of `self` vouches for the instruction set.
        unsafe { F::load(&self.entries.map(|column| column.map(|entry| entry.offset() as f32))) }
    }

    #[inline(always)]
    fn counted(self, value: F) -> F {
        value.where_counted(self.counts)
    }
}
