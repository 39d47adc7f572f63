//! Lanes in the registers of x86-64: SSE2, which every such machine has, and AVX2.
//!
//! Safety of the whole file: an intrinsic is sound if the machine has its instruction set. A
//! value of [`Avx2`] is made only by an unsafe function of [`Lanes`], and the caller of that function
//! guarantees AVX2; so operations on values are sound. SSE2 is part of the x86-64 baseline.
#![allow(unsafe_code)]

use super::LANES;
use super::Number;
use super::Record;
use super::lanes::{Entry, Lanes};
use glam::Vec2;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Two vectors of four.
#[derive(Clone, Copy)]
pub(crate) struct Sse2(__m128, __m128);

/// One vector of eight.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(pub(crate) __m256);

macro_rules! operations {
    ($($operation:ident $name:ident $half:ident $whole:ident)*) => {$(
        impl $operation for Sse2 {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: SSE2 is in the baseline.
                unsafe { Sse2($half(self.0, other.0), $half(self.1, other.1)) }
            }
        }
        impl $operation for Avx2 {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: a value of this type proves AVX2.
                unsafe { Avx2($whole(self.0, other.0)) }
            }
        }
    )*};
}
operations!(
    Add add _mm_add_ps _mm256_add_ps
    Sub sub _mm_sub_ps _mm256_sub_ps
    Mul mul _mm_mul_ps _mm256_mul_ps
    Div div _mm_div_ps _mm256_div_ps
);

/// `yes` where the mask is set, else `no`.
#[inline(always)]
fn select(mask: __m128, yes: __m128, no: __m128) -> __m128 {
    // SAFETY: SSE2 is in the baseline.
    unsafe { _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no)) }
}

/// Two vectors side by side in one register.
///
/// # Safety
/// Both places are readable vectors.
#[inline(always)]
pub(crate) unsafe fn pair<E: Entry>(base: *const Vec2, low: E, high: E) -> __m128 {
    // SAFETY: a Vec2 is two f32 without padding, so 64 bits may be read at each place; the loads ask
    // for no alignment.
    unsafe {
        let low = _mm_load_sd(base.offset(low.offset()).cast());
        _mm_castpd_ps(_mm_loadh_pd(low, base.offset(high.offset()).cast()))
    }
}

/// One record.
///
/// # Safety
/// The place is a readable record.
#[inline(always)]
pub(crate) unsafe fn record<E: Entry>(base: *const Record, entry: E) -> __m128 {
    // SAFETY: a record is four f32 without padding; the load asks for no alignment.
    unsafe { _mm_loadu_ps(base.offset(entry.offset()).cast()) }
}

/// Four records as the four numbers of each.
#[inline(always)]
fn transposed([a, b, c, d]: [__m128; 4]) -> [__m128; 4] {
    // SAFETY: SSE2 is in the baseline.
    unsafe {
        let (ab, cd) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
        let (ab_high, cd_high) = (_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
        [_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab), _mm_movelh_ps(ab_high, cd_high), _mm_movehl_ps(cd_high, ab_high)]
    }
}

impl Number for Sse2 {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        // SAFETY: SSE2 is in the baseline.
        unsafe { Sse2(_mm_set1_ps(value), _mm_set1_ps(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: SSE2 is in the baseline.
        unsafe { Sse2(_mm_sqrt_ps(self.0), _mm_sqrt_ps(self.1)) }
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: SSE2 is in the baseline.
        unsafe { Sse2(_mm_max_ps(self.0, other.0), _mm_max_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        // SAFETY: SSE2 is in the baseline.
        let (low, high) = unsafe { (_mm_cmplt_ps(self.0, limit.0), _mm_cmplt_ps(self.1, limit.1)) };
        Sse2(select(low, yes.0, no.0), select(high, yes.1, no.1))
    }
}

impl Lanes for Sse2 {
    type Counts = (__m128i, __m128i);

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        // SAFETY: SSE2 is in the baseline.
        unsafe { Sse2(_mm_set1_ps(value), _mm_set1_ps(value)) }
    }
    #[inline(always)]
    unsafe fn load(values: &[f32; LANES]) -> Self {
        // SAFETY: both loads are within the array and ask for no alignment.
        unsafe { Sse2(_mm_loadu_ps(values.as_ptr()), _mm_loadu_ps(values.as_ptr().add(4))) }
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, column: &[E; LANES]) -> Self {
        // SAFETY: the caller vouches that all places lie within one slice.
        let at = |k: usize| unsafe { *base.offset(column[k].offset()) };
        // SAFETY: SSE2 is in the baseline.
        unsafe { Sse2(_mm_setr_ps(at(0), at(1), at(2), at(3)), _mm_setr_ps(at(4), at(5), at(6), at(7))) }
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, column: &[E; LANES]) -> (Self, Self) {
        // SAFETY: the caller vouches that all places lie within one slice.
        unsafe {
            let (a, b) = (pair(base, column[0], column[1]), pair(base, column[2], column[3]));
            let (c, d) = (pair(base, column[4], column[5]), pair(base, column[6], column[7]));
            (
                Sse2(_mm_shuffle_ps::<0x88>(a, b), _mm_shuffle_ps::<0x88>(c, d)),
                Sse2(_mm_shuffle_ps::<0xdd>(a, b), _mm_shuffle_ps::<0xdd>(c, d)),
            )
        }
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(base: *const Record, column: &[E; LANES]) -> ((Self, Self), (Self, Self)) {
        // SAFETY: the caller vouches that all places lie within one slice.
        let of = |k: usize| unsafe { record(base, column[k]) };
        let (low, high) = (transposed([of(0), of(1), of(2), of(3)]), transposed([of(4), of(5), of(6), of(7)]));
        let [x, y, u, v]: [Sse2; 4] = std::array::from_fn(|n| Sse2(low[n], high[n]));
        ((x, y), (u, v))
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        // SAFETY: both loads are within the array and ask for no alignment.
        unsafe { (_mm_loadu_si128(counts.as_ptr().cast()), _mm_loadu_si128(counts.as_ptr().add(4).cast())) }
    }
    #[inline(always)]
    unsafe fn two_less(counts: Self::Counts) -> Self::Counts {
        // SAFETY: SSE2 is in the baseline.
        unsafe { (_mm_sub_epi32(counts.0, _mm_set1_epi32(2)), _mm_sub_epi32(counts.1, _mm_set1_epi32(2))) }
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts, column: i32) -> Self {
        // SAFETY: SSE2 is in the baseline.
        unsafe {
            let column = _mm_set1_epi32(column);
            let (low, high) = (_mm_cmpgt_epi32(counts.0, column), _mm_cmpgt_epi32(counts.1, column));
            Sse2(_mm_and_ps(self.0, _mm_castsi128_ps(low)), _mm_and_ps(self.1, _mm_castsi128_ps(high)))
        }
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        let mut out = [0.0; LANES];
        // SAFETY: both stores are within the array and ask for no alignment.
        unsafe {
            _mm_storeu_ps(out.as_mut_ptr(), self.0);
            _mm_storeu_ps(out.as_mut_ptr().add(4), self.1);
        }
        out
    }
}

impl Number for Avx2 {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        // SAFETY: a value of this type proves AVX2.
        unsafe { Avx2(_mm256_set1_ps(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: a value of this type proves AVX2.
        unsafe { Avx2(_mm256_sqrt_ps(self.0)) }
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: a value of this type proves AVX2.
        unsafe { Avx2(_mm256_max_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        // SAFETY: a value of this type proves AVX2.
        unsafe { Avx2(_mm256_blendv_ps(no.0, yes.0, _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, limit.0))) }
    }
}

/// The halves of a vector, joined.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn joined(low: __m128, high: __m128) -> __m256 {
    // SAFETY: the caller vouches for AVX2.
    unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(low), high) }
}

impl Lanes for Avx2 {
    type Counts = __m256i;

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        // SAFETY: the caller vouches for AVX2.
        unsafe { Avx2(_mm256_set1_ps(value)) }
    }
    #[inline(always)]
    unsafe fn load(values: &[f32; LANES]) -> Self {
        // SAFETY: the load is within the array and asks for no alignment; the caller vouches for AVX2.
        unsafe { Avx2(_mm256_loadu_ps(values.as_ptr())) }
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, column: &[E; LANES]) -> Self {
        // SAFETY: the caller vouches that all places lie within one slice.
        let at = |k: usize| unsafe { *base.offset(column[k].offset()) };
        // SAFETY: the caller vouches for AVX2.
        unsafe { Avx2(_mm256_setr_ps(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7))) }
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, column: &[E; LANES]) -> (Self, Self) {
        // SAFETY: the caller vouches for AVX2, and that all places lie within one slice.
        unsafe {
            // Shuffles stay within half a register: lanes 0-3 in the low halves, 4-7 in the high ones.
            let first = joined(pair(base, column[0], column[1]), pair(base, column[4], column[5]));
            let second = joined(pair(base, column[2], column[3]), pair(base, column[6], column[7]));
            (Avx2(_mm256_shuffle_ps::<0x88>(first, second)), Avx2(_mm256_shuffle_ps::<0xdd>(first, second)))
        }
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(base: *const Record, column: &[E; LANES]) -> ((Self, Self), (Self, Self)) {
        // SAFETY: the caller vouches for AVX2, and that all places lie within one slice.
        unsafe {
            let of = |low: usize, high: usize| joined(record(base, column[low]), record(base, column[high]));
            // As `transposed`, in both halves: lanes 0-3 in the low ones, 4-7 in the high ones.
            let (a, b, c, d) = (of(0, 4), of(1, 5), of(2, 6), of(3, 7));
            let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let first = (_mm256_shuffle_ps::<0x44>(ab, cd), _mm256_shuffle_ps::<0xee>(ab, cd));
            let (ab, cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            let second = (_mm256_shuffle_ps::<0x44>(ab, cd), _mm256_shuffle_ps::<0xee>(ab, cd));
            ((Avx2(first.0), Avx2(first.1)), (Avx2(second.0), Avx2(second.1)))
        }
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        // SAFETY: the load is within the array and asks for no alignment; the caller vouches for AVX2.
        unsafe { _mm256_loadu_si256(counts.as_ptr().cast()) }
    }
    #[inline(always)]
    unsafe fn two_less(counts: Self::Counts) -> Self::Counts {
        // SAFETY: the caller vouches for AVX2.
        unsafe { _mm256_sub_epi32(counts, _mm256_set1_epi32(2)) }
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts, column: i32) -> Self {
        // SAFETY: a value of this type proves AVX2.
        unsafe {
            let counted = _mm256_cmpgt_epi32(counts, _mm256_set1_epi32(column));
            Avx2(_mm256_and_ps(self.0, _mm256_castsi256_ps(counted)))
        }
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        let mut out = [0.0; LANES];
        // SAFETY: the store is within the array and asks for no alignment; a value proves AVX2.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
}

impl Avx2 {
    /// The coordinates of eight vectors in a row.
    ///
    /// # Safety
    /// The machine has AVX2, and eight vectors may be read.
    #[inline(always)]
    pub(crate) unsafe fn deinterleaved(vectors: *const Vec2) -> (Self, Self) {
        // SAFETY: passed on to the caller; the loads ask for no alignment.
        unsafe {
            let (first, second) = (_mm256_loadu_ps(vectors.cast()), _mm256_loadu_ps(vectors.add(4).cast()));
            // Shuffles stay within halves: the pairs come out in the order 0 2 1 3.
            let x = _mm256_castps_pd(_mm256_shuffle_ps::<0x88>(first, second));
            let y = _mm256_castps_pd(_mm256_shuffle_ps::<0xdd>(first, second));
            let (x, y) = (_mm256_permute4x64_pd::<0xd8>(x), _mm256_permute4x64_pd::<0xd8>(y));
            (Avx2(_mm256_castpd_ps(x)), Avx2(_mm256_castpd_ps(y)))
        }
    }

    /// A bit for each lane below `limit`.
    #[inline(always)]
    pub(crate) fn bits_below(self, limit: Self) -> u32 {
        // SAFETY: a value of this type proves AVX2.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, limit.0)) as u32 }
    }
}
