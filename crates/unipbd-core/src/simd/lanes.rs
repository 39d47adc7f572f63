//! Eight lanes of f32: what the lane forms of the passes are written in.
#![allow(unsafe_code)]

use super::records::Record;
use super::shapes::Number;
use crate::neighbors::LANES;
use glam::Vec2;

/// An entry of the neighbour list, relative to the first row of its block.
pub(super) trait Entry: Copy {
    fn offset(self) -> isize;
}

impl Entry for i16 {
    #[inline(always)]
    fn offset(self) -> isize {
        self as isize
    }
}

impl Entry for i32 {
    #[inline(always)]
    fn offset(self) -> isize {
        self as isize
    }
}

/// Eight numbers in the registers of one instruction set.
///
/// Values come into being only through the unsafe functions, whose caller vouches that the machine
/// has the instruction set; so the safe operations, which need a value, are sound.
pub(super) trait Lanes: Number {
    /// Eight counts, to be compared with a column number.
    type Counts: Copy;

    /// One number in all lanes.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn splat(value: f32) -> Self;

    /// Eight numbers in a row.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn load(values: &[f32; LANES]) -> Self;

    /// The numbers at `base` plus each offset of a column.
    ///
    /// # Safety
    /// The machine has the instruction set, and all eight places are within one slice.
    unsafe fn gather<E: Entry>(base: *const f32, column: &[E; LANES]) -> Self;

    /// The coordinates of the vectors at `base` plus each offset of a column.
    ///
    /// # Safety
    /// As for [`gather`](Self::gather).
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, column: &[E; LANES]) -> (Self, Self);

    /// The coordinates of both vectors of the records at `base` plus each offset of a column.
    ///
    /// # Safety
    /// As for [`gather`](Self::gather).
    unsafe fn gather_records<E: Entry>(base: *const Record, column: &[E; LANES]) -> ((Self, Self), (Self, Self));

    /// Counts, ready to be compared.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts;

    /// The value in lanes that count more than `column`, zero in the others.
    fn where_counted(self, counts: Self::Counts, column: u32) -> Self;

    /// The eight numbers.
    fn to_array(self) -> [f32; LANES];
}
