//! The inner loops over runs of rows: which of them are near the rows of a block, the transposition
//! of the rows found into columns, and their kernel sums at a point.
#![cfg_attr(not(feature = "f64"), allow(unsafe_code))]

use super::weigh::{At, Weighed};
use crate::bytes::held;
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::simd::space::Space;
use crate::simd::{LANES, Level};
use std::ops::Range;

/// Slots kept free beyond the count of a lane: stores and loads go by eight.
const SPARE: usize = 16;

/// The rows found so far for the rows of one block.
#[derive(Default)]
pub(crate) struct Found {
    /// First row of the block.
    base: usize,
    /// The positions of its rows. Lanes beyond the last row repeat it, and are not searched for.
    pub centers: [Vector; LANES],
    /// How many were found for each.
    pub counts: [u32; LANES],
    /// `room` slots per lane.
    rows: Vec<u32>,
    room: usize,
}

impl Found {
    /// Starts on the block at row `base`.
    #[inline(always)]
    pub fn start(&mut self, base: usize, positions: &[Vector]) {
        self.base = base;
        self.centers = std::array::from_fn(|lane| positions[(base + lane).min(positions.len() - 1)]);
        self.counts = [0; LANES];
        self.reserve(0);
    }

    /// Makes room for `more` rows in each lane.
    #[inline(always)]
    fn reserve(&mut self, more: usize) {
        let most = self.counts.iter().fold(0, |most, &count| count.max(most));
        if most as usize + more + SPARE > self.room {
            self.grow(most as usize + more + SPARE);
        }
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self, room: usize) {
        let room = room.next_multiple_of(64);
        let mut rows = vec![0; room * LANES];
        for (lane, &count) in self.counts.iter().enumerate() {
            rows[lane * room..][..count as usize].copy_from_slice(self.list(lane, count));
        }
        (self.rows, self.room) = (rows, room);
    }

    #[inline(always)]
    fn list(&self, lane: usize, count: u32) -> &[u32] {
        &self.rows[lane * self.room..][..count as usize]
    }

    /// Appends `depth` columns of entries relative to the first row; `padding` fills up short lanes.
    #[inline(always)]
    pub fn transpose<E: Copy>(
        &self,
        depth: usize,
        padding: [E; LANES],
        entry: impl Fn(i32) -> E,
        out: &mut Vec<[E; LANES]>,
    ) {
        let start = out.len();
        out.resize(start + depth, padding);
        for (lane, &count) in self.counts.iter().enumerate() {
            for (column, &row) in out[start..].iter_mut().zip(self.list(lane, count)) {
                column[lane] = entry(row.wrapping_sub(self.base as u32) as i32);
            }
        }
    }

    pub fn memory_bytes(&self) -> usize {
        held(&self.rows)
    }
}

/// The list build in one instruction set.
pub(crate) trait Near: Copy {
    /// Appends to each lane of `lanes` the rows of `run` with |center - position|^2 < `limit`, the
    /// lane's own row left out, in order.
    fn find<S: Space>(
        self,
        space: S,
        limit: Real,
        positions: &[Vector],
        run: Range<usize>,
        lanes: Range<usize>,
        found: &mut Found,
    );

    /// Appends `depth` columns of the rows found, relative to the first row of the block, which all
    /// fit in 16 bits. Short lanes are filled up with `padding`.
    fn columns(self, found: &Found, depth: usize, padding: [i16; LANES], out: &mut Vec<[i16; LANES]>);

    /// Adds to `sums` the kernel sums of the rows of `run` at a point.
    fn weigh<S: Space, K: Shape>(self, at: &At<'_, S, K>, run: Range<usize>, sums: &mut Weighed);
}

/// Work that is done in the best instruction set of this machine.
pub(crate) trait Work {
    /// Does it. Must be inlined always, or it misses the instruction set it is dispatched to.
    fn run<N: Near>(self, near: N);
}

/// Runs `work` in this instruction set, or, where the build has no form for it, one point at a time.
/// The result does not depend on it.
pub(crate) fn dispatch(level: Level, work: impl Work) {
    match level {
        #[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
        Level::Avx2 | Level::Avx512
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("popcnt") =>
        {
            // SAFETY: the machine has AVX2 and popcnt.
            unsafe { avx2::run(work) }
        }
        _ => work.run(OneByOne),
    }
}

/// One point at a time.
#[derive(Clone, Copy)]
struct OneByOne;

impl Near for OneByOne {
    #[inline(always)]
    fn find<S: Space>(
        self,
        space: S,
        limit: Real,
        positions: &[Vector],
        run: Range<usize>,
        lanes: Range<usize>,
        found: &mut Found,
    ) {
        found.reserve(run.len());
        for lane in lanes {
            let (own, center) = (found.base + lane, found.centers[lane]);
            let rows = &mut found.rows[lane * found.room..(lane + 1) * found.room];
            let mut count = found.counts[lane] as usize;
            for (row, &other) in run.clone().zip(&positions[run.clone()]) {
                let (x, y) = space.shortest(center.x - other.x, center.y - other.y);
                // Written always, kept if near: a branch here would be guessed wrong half the time.
                rows[count] = row as u32;
                count += usize::from((x * x + y * y < limit) & (row != own));
            }
            found.counts[lane] = count as u32;
        }
    }

    #[inline(always)]
    fn columns(self, found: &Found, depth: usize, padding: [i16; LANES], out: &mut Vec<[i16; LANES]>) {
        found.transpose(depth, padding, |offset| offset as i16, out);
    }

    #[inline(always)]
    fn weigh<S: Space, K: Shape>(self, at: &At<'_, S, K>, run: Range<usize>, sums: &mut Weighed) {
        sums.add_one_by_one(at, run);
    }
}

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
mod avx2 {
    use super::{Found, LANES, Near, OneByOne, Real, SPARE, Space, Vector, Work};
    use crate::kernel::Shape;
    use crate::neighbors::weigh::{At, Weighed};
    use crate::simd::lanes::Lanes;
    use crate::simd::x86::Avx2;
    use std::arch::x86_64::*;
    use std::ops::Range;

    /// # Safety
    /// The machine has AVX2 and popcnt.
    #[target_feature(enable = "avx2,popcnt")]
    pub(super) unsafe fn run(work: impl Work) {
        work.run(EightAtATime(()));
    }

    /// Proof that the machine has AVX2: made only by [`run`].
    #[derive(Clone, Copy)]
    pub(super) struct EightAtATime(());

    /// For each set of eight bits, the numbers of the bits that are set, first to last.
    static SET_BITS: [[u8; 8]; 256] = set_bits();

    const fn set_bits() -> [[u8; 8]; 256] {
        let mut table = [[0; 8]; 256];
        let mut set = 0;
        while set < 256 {
            let (mut bit, mut count) = (0, 0);
            while bit < 8 {
                if set >> bit & 1 == 1 {
                    table[set][count] = bit as u8;
                    count += 1;
                }
                bit += 1;
            }
            set += 1;
        }
        table
    }

    impl Near for EightAtATime {
        #[inline(always)]
        fn find<S: Space>(
            self,
            space: S,
            limit: Real,
            positions: &[Vector],
            run: Range<usize>,
            lanes: Range<usize>,
            found: &mut Found,
        ) {
            assert!(run.start <= run.end && run.end <= positions.len() && lanes.end <= LANES);
            found.reserve(run.len());
            assert!(found.rows.len() >= LANES * found.room);
            let mut row = run.start;
            while row < run.end && row + 8 <= positions.len() {
                let valid = 0xff_u32 >> (row + 8).saturating_sub(run.end);
                // SAFETY: a value of this type proves AVX2; eight vectors from `row` are within the slice.
                let (other_x, other_y) = unsafe { Avx2::deinterleaved(positions.as_ptr().add(row)) };
                for lane in lanes.clone() {
                    let center = found.centers[lane];
                    let own = (found.base + lane).wrapping_sub(row);
                    let others = valid & !(u32::from(own < 8) << (own & 7));
                    let slot = lane * found.room + found.counts[lane] as usize;
                    // SAFETY: a value of this type proves AVX2. A lane holds at most its count before
                    // this run plus the rows of the run passed, for which room was made with more
                    // than eight slots to spare, so eight slots from `slot` are within its room.
                    unsafe {
                        let (x, y) = (Avx2::splat(center.x) - other_x, Avx2::splat(center.y) - other_y);
                        let (x, y) = space.shortest(x, y);
                        let near = (x * x + y * y).bits_below(Avx2::splat(limit)) & others;
                        let picked = _mm_loadl_epi64(SET_BITS.as_ptr().add(near as usize).cast());
                        let rows = _mm256_add_epi32(_mm256_cvtepu8_epi32(picked), _mm256_set1_epi32(row as i32));
                        _mm256_storeu_si256(found.rows.as_mut_ptr().add(slot).cast(), rows);
                        found.counts[lane] += near.count_ones();
                    }
                }
                row += 8;
            }
            if row < run.end {
                OneByOne.find(space, limit, positions, row..run.end, lanes, found);
            }
        }

        #[inline(always)]
        fn columns(self, found: &Found, depth: usize, padding: [i16; LANES], out: &mut Vec<[i16; LANES]>) {
            assert!(depth + SPARE <= found.room + LANES && found.rows.len() >= LANES * found.room);
            out.reserve(depth);
            for first in (0..depth).step_by(LANES) {
                // SAFETY: a value of this type proves AVX2. Depth is at most one more than the count of a
                // lane, which leaves more than eight slots to spare, so the loads are within its room.
                let columns = unsafe { eight_columns(found, first, padding) };
                out.extend_from_slice(&columns[..LANES.min(depth - first)]);
            }
        }

        #[inline(always)]
        fn weigh<S: Space, K: Shape>(self, at: &At<'_, S, K>, run: Range<usize>, sums: &mut Weighed) {
            // SAFETY: a value of this type proves AVX2.
            unsafe { sums.add_eight_at_a_time(at, run) }
        }
    }

    /// The entries `first..first + 8` of one lane.
    ///
    /// # Safety
    /// The machine has AVX2, and the lane has room for these entries.
    #[inline(always)]
    unsafe fn entries(found: &Found, first: usize, lane: usize, padding: i16) -> __m256i {
        // SAFETY: passed on to the caller; the load asks for no alignment.
        unsafe {
            let rows = _mm256_loadu_si256(found.rows.as_ptr().add(lane * found.room + first).cast());
            let numbers = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let held = _mm256_cmpgt_epi32(_mm256_set1_epi32(found.counts[lane] as i32 - first as i32), numbers);
            let offsets = _mm256_sub_epi32(rows, _mm256_set1_epi32(found.base as i32));
            _mm256_blendv_epi8(_mm256_set1_epi32(i32::from(padding)), offsets, held)
        }
    }

    /// The entries of two lanes in 16 bits, side by side: 0 1 2 3 of both in the low half, 4 5 6 7 in the high one.
    ///
    /// # Safety
    /// As for [`entries`], for `lane` and the next.
    #[inline(always)]
    unsafe fn two_lanes(found: &Found, first: usize, lane: usize, padding: [i16; LANES]) -> __m256i {
        // SAFETY: passed on to the caller.
        unsafe {
            let one = entries(found, first, lane, padding[lane]);
            let next = entries(found, first, lane + 1, padding[lane + 1]);
            #[rustfmt::skip]
            let zip = _mm256_setr_epi8(
                0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15,
                0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15,
            );
            _mm256_shuffle_epi8(_mm256_packs_epi32(one, next), zip)
        }
    }

    /// The columns `first..first + 8`.
    ///
    /// # Safety
    /// As for [`entries`], for every lane.
    #[inline(always)]
    unsafe fn eight_columns(found: &Found, first: usize, padding: [i16; LANES]) -> [[i16; LANES]; LANES] {
        let mut out = [[0; LANES]; LANES];
        // SAFETY: passed on to the caller; stores are within `out` and ask for no alignment.
        unsafe {
            let (a, b) = (two_lanes(found, first, 0, padding), two_lanes(found, first, 2, padding));
            let (c, d) = (two_lanes(found, first, 4, padding), two_lanes(found, first, 6, padding));
            let (ab_low, ab_high) = (_mm256_unpacklo_epi32(a, b), _mm256_unpackhi_epi32(a, b));
            let (cd_low, cd_high) = (_mm256_unpacklo_epi32(c, d), _mm256_unpackhi_epi32(c, d));
            let columns = [
                _mm256_unpacklo_epi64(ab_low, cd_low),
                _mm256_unpackhi_epi64(ab_low, cd_low),
                _mm256_unpacklo_epi64(ab_high, cd_high),
                _mm256_unpackhi_epi64(ab_high, cd_high),
            ];
            for (k, both) in columns.into_iter().enumerate() {
                _mm_storeu_si128(out[k].as_mut_ptr().cast(), _mm256_castsi256_si128(both));
                _mm_storeu_si128(out[k + 4].as_mut_ptr().cast(), _mm256_extracti128_si256::<1>(both));
            }
        }
        out
    }
}
