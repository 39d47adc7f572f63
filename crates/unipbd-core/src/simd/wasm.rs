//! Lanes in the registers of WebAssembly, for builds with `-C target-feature=+simd128`. The intrinsics that touch no
//! memory are safe there.
#![allow(unsafe_code)]

use super::LANES;
use super::Number;
use super::Record;
use super::lanes::{Entry, Lanes};
use glam::Vec2;
use std::arch::wasm32::*;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// Two vectors of four.
#[derive(Clone, Copy)]
pub(crate) struct Simd128(v128, v128);

macro_rules! operations {
    ($($operation:ident $name:ident $half:ident)*) => {$(
        impl $operation for Simd128 {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Simd128($half(self.0, other.0), $half(self.1, other.1))
            }
        }
    )*};
}
operations!(Add add f32x4_add Sub sub f32x4_sub Mul mul f32x4_mul Div div f32x4_div);

/// Two vectors side by side in one register.
///
/// # Safety
/// Both places are readable vectors.
#[inline(always)]
unsafe fn pair<E: Entry>(base: *const Vec2, low: E, high: E) -> v128 {
    // SAFETY: a Vec2 is two f32 without padding; the loads ask for no alignment.
    unsafe {
        let low = v128_load64_zero(base.offset(low.offset()).cast());
        v128_load64_lane::<1>(low, base.offset(high.offset()).cast())
    }
}

/// Four records as the four numbers of each.
#[inline(always)]
fn transposed([a, b, c, d]: [v128; 4]) -> [v128; 4] {
    let (ab, cd) = (i32x4_shuffle::<0, 4, 1, 5>(a, b), i32x4_shuffle::<0, 4, 1, 5>(c, d));
    let (ab_high, cd_high) = (i32x4_shuffle::<2, 6, 3, 7>(a, b), i32x4_shuffle::<2, 6, 3, 7>(c, d));
    [
        i32x4_shuffle::<0, 1, 4, 5>(ab, cd),
        i32x4_shuffle::<2, 3, 6, 7>(ab, cd),
        i32x4_shuffle::<0, 1, 4, 5>(ab_high, cd_high),
        i32x4_shuffle::<2, 3, 6, 7>(ab_high, cd_high),
    ]
}

impl Number for Simd128 {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        Simd128(f32x4_splat(value), f32x4_splat(value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Simd128(f32x4_sqrt(self.0), f32x4_sqrt(self.1))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // The second operand where it is the larger one, else the first.
        Simd128(f32x4_pmax(other.0, self.0), f32x4_pmax(other.1, self.1))
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        let (low, high) = (f32x4_lt(self.0, limit.0), f32x4_lt(self.1, limit.1));
        Simd128(v128_bitselect(yes.0, no.0, low), v128_bitselect(yes.1, no.1, high))
    }
}

impl Lanes for Simd128 {
    type Counts = (v128, v128);

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        Simd128(f32x4_splat(value), f32x4_splat(value))
    }
    #[inline(always)]
    unsafe fn load(values: &[f32; LANES]) -> Self {
        // SAFETY: both loads are within the array and ask for no alignment.
        unsafe { Simd128(v128_load(values.as_ptr().cast()), v128_load(values.as_ptr().add(4).cast())) }
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, column: &[E; LANES]) -> Self {
        // SAFETY: the caller vouches that all places lie within one slice.
        let at = |k: usize| unsafe { *base.offset(column[k].offset()) };
        Simd128(f32x4(at(0), at(1), at(2), at(3)), f32x4(at(4), at(5), at(6), at(7)))
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, column: &[E; LANES]) -> (Self, Self) {
        // SAFETY: the caller vouches that all places lie within one slice.
        let two = |k: usize| unsafe { pair(base, column[k], column[k + 1]) };
        let (a, b, c, d) = (two(0), two(2), two(4), two(6));
        (
            Simd128(i32x4_shuffle::<0, 2, 4, 6>(a, b), i32x4_shuffle::<0, 2, 4, 6>(c, d)),
            Simd128(i32x4_shuffle::<1, 3, 5, 7>(a, b), i32x4_shuffle::<1, 3, 5, 7>(c, d)),
        )
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(base: *const Record, column: &[E; LANES]) -> ((Self, Self), (Self, Self)) {
        // SAFETY: the caller vouches that all places lie within one slice; a record is four f32 without padding.
        let of = |k: usize| unsafe { v128_load(base.offset(column[k].offset()).cast()) };
        let (low, high) = (transposed([of(0), of(1), of(2), of(3)]), transposed([of(4), of(5), of(6), of(7)]));
        let [x, y, u, v]: [Simd128; 4] = from_fn(|n| Simd128(low[n], high[n]));
        ((x, y), (u, v))
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        // SAFETY: both loads are within the array and ask for no alignment.
        unsafe { (v128_load(counts.as_ptr().cast()), v128_load(counts.as_ptr().add(4).cast())) }
    }
    #[inline(always)]
    unsafe fn two_less(counts: Self::Counts) -> Self::Counts {
        (i32x4_sub(counts.0, i32x4_splat(2)), i32x4_sub(counts.1, i32x4_splat(2)))
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts, column: i32) -> Self {
        let column = i32x4_splat(column);
        Simd128(v128_and(self.0, i32x4_gt(counts.0, column)), v128_and(self.1, i32x4_gt(counts.1, column)))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        let mut out = [0.0; LANES];
        // SAFETY: both stores are within the array and ask for no alignment.
        unsafe {
            v128_store(out.as_mut_ptr().cast(), self.0);
            v128_store(out.as_mut_ptr().add(4).cast(), self.1);
        }
        out
    }
}
