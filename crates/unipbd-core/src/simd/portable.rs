//! Lanes as plain arrays, for machines without their own implementation.
#![allow(unsafe_code)]

use super::LANES;
use super::Number;
use super::Record;
use super::lanes::{Entry, Lanes};
use glam::Vec2;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// An array of eight.
#[derive(Clone, Copy)]
pub(crate) struct Portable([f32; LANES]);

macro_rules! lane_by_lane {
    ($($operation:ident $name:ident)*) => {$(
        impl $operation for Portable {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Portable(from_fn(|k| self.0[k].$name(other.0[k])))
            }
        }
    )*};
}
lane_by_lane!(Add add Sub sub Mul mul Div div);

impl Number for Portable {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        Portable([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Portable(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Portable(from_fn(|k| self.0[k].larger(other.0[k])))
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Portable(from_fn(|k| self.0[k].where_below(limit.0[k], yes.0[k], no.0[k])))
    }
}

impl Lanes for Portable {
    type Counts = [i32; LANES];

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        Portable([value; LANES])
    }
    #[inline(always)]
    unsafe fn load(values: &[f32; LANES]) -> Self {
        Portable(*values)
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, column: &[E; LANES]) -> Self {
        // SAFETY: the caller vouches that all places lie within one slice.
        Portable(column.map(|entry| unsafe { *base.offset(entry.offset()) }))
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, column: &[E; LANES]) -> (Self, Self) {
        // SAFETY: as for `gather`.
        let vectors = column.map(|entry| unsafe { *base.offset(entry.offset()) });
        (Portable(vectors.map(|v| v.x)), Portable(vectors.map(|v| v.y)))
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(base: *const Record, column: &[E; LANES]) -> ((Self, Self), (Self, Self)) {
        // SAFETY: as for `gather`.
        let records = column.map(|entry| unsafe { *base.offset(entry.offset()) });
        let of = |which: usize| (Portable(records.map(|r| r[which].x)), Portable(records.map(|r| r[which].y)));
        (of(0), of(1))
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        counts.map(|count| count as i32)
    }
    #[inline(always)]
    unsafe fn two_less(counts: Self::Counts) -> Self::Counts {
        counts.map(|count| count - 2)
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts, column: i32) -> Self {
        Portable(from_fn(|k| if counts[k] > column { self.0[k] } else { 0.0 }))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        self.0
    }
}
