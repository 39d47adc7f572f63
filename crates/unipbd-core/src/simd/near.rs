//! Which points of a run are near another: the inner loop of the list build.
#![cfg_attr(not(feature = "f64"), allow(unsafe_code))]

use super::space::Space;
use crate::math::{Real, Vector};
use std::ops::Range;

/// Slots that must be free beyond the last row found.
pub(crate) const SPARE: usize = 8;

/// Finds the rows near a point.
pub(crate) trait Near: Copy {
    /// Writes the rows of `run` with |center - position|^2 < `limit` to the start of `found`, in
    /// order, and returns how many; slots beyond hold anything. `found` has room for the run and [`SPARE`] more.
    fn find<S: Space>(
        self,
        space: S,
        center: Vector,
        limit: Real,
        positions: &[Vector],
        run: Range<usize>,
        found: &mut [u32],
    ) -> usize;
}

/// Work that is done with whatever finds rows fastest on this machine.
pub(crate) trait Work {
    /// Does it. Must be inlined always, or it misses the instruction set it is dispatched to.
    fn run<N: Near>(self, near: N);
}

/// Runs `work` with the best instruction set.
pub(crate) fn dispatch(work: impl Work) {
    #[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        return unsafe { avx2::run(work) };
    }
    work.run(OneByOne);
}

/// One point at a time.
#[derive(Clone, Copy)]
pub(crate) struct OneByOne;

impl Near for OneByOne {
    #[inline(always)]
    fn find<S: Space>(
        self,
        space: S,
        center: Vector,
        limit: Real,
        positions: &[Vector],
        run: Range<usize>,
        found: &mut [u32],
    ) -> usize {
        let mut count = 0;
        for (row, &other) in run.clone().zip(&positions[run]) {
            let (x, y) = space.shortest(center.x - other.x, center.y - other.y);
            // Written always, kept if near: a branch here would be guessed wrong half the time.
            found[count] = row as u32;
            count += usize::from(x * x + y * y < limit);
        }
        count
    }
}

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
mod avx2 {
    use super::super::lanes::Lanes;
    use super::super::x86::Avx2;
    use super::{Near, OneByOne, Real, SPARE, Space, Vector, Work};
    use std::arch::x86_64::*;
    use std::ops::Range;

    /// # Safety
    /// The machine has AVX2.
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
            center: Vector,
            limit: Real,
            positions: &[Vector],
            run: Range<usize>,
            found: &mut [u32],
        ) -> usize {
            assert!(run.start <= run.end && run.end <= positions.len() && found.len() >= run.len() + SPARE);
            let (mut row, mut count) = (run.start, 0);
            // SAFETY: a value of this type proves AVX2. Loads stay below `positions.len()`. Each turn
            // stores eight slots at `count`, which is at most the number of rows passed.
            unsafe {
                let (x, y, limit) = (Avx2::splat(center.x), Avx2::splat(center.y), Avx2::splat(limit));
                while row < run.end && row + 8 <= positions.len() {
                    let (other_x, other_y) = Avx2::deinterleaved(positions.as_ptr().add(row));
                    let (x, y) = space.shortest(x - other_x, y - other_y);
                    let near = (x * x + y * y).bits_below(limit) & (0xff >> (row + 8).saturating_sub(run.end).min(8));
                    let picked = _mm_loadl_epi64(SET_BITS[near as usize].as_ptr().cast());
                    let rows = _mm256_add_epi32(_mm256_cvtepu8_epi32(picked), _mm256_set1_epi32(row as i32));
                    _mm256_storeu_si256(found.as_mut_ptr().add(count).cast(), rows);
                    count += near.count_ones() as usize;
                    row += 8;
                }
            }
            if row < run.end {
                count += OneByOne.find(space, center, limit, positions, row..run.end, &mut found[count..]);
            }
            count
        }
    }
}
