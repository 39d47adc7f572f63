//! Lanes in the registers of AVX-512: the two columns of a turn in one vector of sixteen.
//!
//! Safety of the whole file: as in the file of the other x86-64 sets, a value of [`Avx512`] is made only by an
//! unsafe function of [`Turn`], and the caller of that function guarantees AVX2, AVX-512F and AVX-512VL.
#![allow(unsafe_code)]

use super::LANES;
use super::Number;
use super::Record;
use super::lanes::{ColumnPair, Entry, Turn};
use super::x86::{Avx2, pair, record};
use glam::Vec2;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// The first column in the low half, the second in the high one.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512);

macro_rules! operations {
    ($($operation:ident $name:ident $whole:ident)*) => {$(
        impl $operation for Avx512 {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: a value of this type proves AVX-512.
                unsafe { Avx512($whole(self.0, other.0)) }
            }
        }
    )*};
}
operations!(Add add _mm512_add_ps Sub sub _mm512_sub_ps Mul mul _mm512_mul_ps Div div _mm512_div_ps);

impl Number for Avx512 {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { Avx512(_mm512_set1_ps(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { Avx512(_mm512_sqrt_ps(self.0)) }
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { Avx512(_mm512_max_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { Avx512(_mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, limit.0), no.0, yes.0)) }
    }
}

/// Four quarters of a vector.
///
/// # Safety
/// The machine has AVX-512F.
#[inline(always)]
unsafe fn joined([a, b, c, d]: [__m128; 4]) -> __m512 {
    // SAFETY: the caller vouches for AVX-512F.
    unsafe {
        let low = _mm512_castps256_ps512(_mm256_insertf128_ps::<1>(_mm256_castps128_ps256(a), b));
        let high = _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(c), d);
        _mm512_castpd_ps(_mm512_insertf64x4::<1>(_mm512_castps_pd(low), _mm256_castps_pd(high)))
    }
}

impl Turn for Avx512 {
    type Sums = Avx2;
    /// The counts, and those less by one.
    type Counts = __m512i;

    #[inline(always)]
    unsafe fn load([first, second]: &ColumnPair<f32>) -> Self {
        // SAFETY: the loads are within the arrays and ask for no alignment; the caller vouches for AVX-512.
        unsafe {
            let (low, high) = (_mm256_loadu_ps(first.as_ptr()), _mm256_loadu_ps(second.as_ptr()));
            let low = _mm512_castps_pd(_mm512_castps256_ps512(low));
            Avx512(_mm512_castpd_ps(_mm512_insertf64x4::<1>(low, _mm256_castps_pd(high))))
        }
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, [first, second]: &ColumnPair<E>) -> Self {
        // SAFETY: the caller vouches for AVX-512, and that all places lie within one slice.
        unsafe {
            let of = |column: &[E; LANES], k: usize| {
                let at = |k: usize| *base.offset(column[k].offset());
                _mm_setr_ps(at(k), at(k + 1), at(k + 2), at(k + 3))
            };
            Avx512(joined([of(first, 0), of(first, 4), of(second, 0), of(second, 4)]))
        }
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, [first, second]: &ColumnPair<E>) -> (Self, Self) {
        // SAFETY: the caller vouches for AVX-512, and that all places lie within one slice.
        unsafe {
            let of = |column: &[E; LANES], k: usize| pair(base, column[k], column[k + 1]);
            // Shuffles stay within a quarter of a register: each holds a half of the lanes of one column.
            let low = joined([of(first, 0), of(first, 4), of(second, 0), of(second, 4)]);
            let high = joined([of(first, 2), of(first, 6), of(second, 2), of(second, 6)]);
            (Avx512(_mm512_shuffle_ps::<0x88>(low, high)), Avx512(_mm512_shuffle_ps::<0xdd>(low, high)))
        }
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(
        base: *const Record,
        [first, second]: &ColumnPair<E>,
    ) -> ((Self, Self), (Self, Self)) {
        // SAFETY: the caller vouches for AVX-512, and that all places lie within one slice.
        unsafe {
            let of = |k: usize| {
                let at = |column: &[E; LANES], k: usize| record(base, column[k]);
                joined([at(first, k), at(first, k + 4), at(second, k), at(second, k + 4)])
            };
            let (a, b, c, d) = (of(0), of(1), of(2), of(3));
            let (ab, cd) = (_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d));
            let first = (_mm512_shuffle_ps::<0x44>(ab, cd), _mm512_shuffle_ps::<0xee>(ab, cd));
            let (ab, cd) = (_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d));
            let second = (_mm512_shuffle_ps::<0x44>(ab, cd), _mm512_shuffle_ps::<0xee>(ab, cd));
            ((Avx512(first.0), Avx512(first.1)), (Avx512(second.0), Avx512(second.1)))
        }
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        // SAFETY: the load is within the array and asks for no alignment; the caller vouches for AVX-512.
        unsafe {
            let counts = _mm512_broadcast_i64x4(_mm256_loadu_si256(counts.as_ptr().cast()));
            _mm512_sub_epi32(counts, _mm512_setr_epi32(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1))
        }
    }
    #[inline(always)]
    unsafe fn next(counts: Self::Counts) -> Self::Counts {
        // SAFETY: the caller vouches for AVX-512.
        unsafe { _mm512_sub_epi32(counts, _mm512_set1_epi32(2)) }
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { Avx512(_mm512_maskz_mov_ps(_mm512_cmpgt_epi32_mask(counts, _mm512_setzero_si512()), self.0)) }
    }
    #[inline(always)]
    fn added_to(self, sums: Avx2) -> Avx2 {
        // SAFETY: a value of this type proves AVX-512.
        unsafe {
            let second = _mm512_extractf64x4_pd::<1>(_mm512_castps_pd(self.0));
            (sums + Avx2(_mm512_castps512_ps256(self.0))) + Avx2(_mm256_castpd_ps(second))
        }
    }
}
