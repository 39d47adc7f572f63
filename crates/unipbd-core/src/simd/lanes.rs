//! Lanes of f32: eight rows, and eight rows by two columns, which passes run in.
#![allow(unsafe_code)]

use super::LANES;
use super::Number;
use super::Record;
use glam::Vec2;
use std::ops::{Add, Div, Mul, Sub};

/// An entry of the neighbour list, relative to the first row of its block.
pub(crate) trait Entry: Copy {
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
/// Values are made only by the unsafe functions, and their caller guarantees that the machine
/// has the instruction set; so the safe operations, which need a value, are sound.
pub(crate) trait Lanes: Number {
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

    /// The counts, each less by two.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn two_less(counts: Self::Counts) -> Self::Counts;

    /// The value in lanes that count more than `column`, zero in the others.
    fn where_counted(self, counts: Self::Counts, column: i32) -> Self;

    /// The eight numbers.
    fn to_array(self) -> [f32; LANES];
}

/// The entries of two columns of the list.
pub(crate) type ColumnPair<E> = [[E; LANES]; 2];

/// The numbers of one iteration of the loop over columns: one for each of eight rows in each of two columns.
/// Loads and sums form a long dependency chain, and two columns overlap better than one.
///
/// As for [`Lanes`], a value proves the instruction set.
pub(crate) trait Turn: Number {
    /// The eight sums of the rows.
    type Sums: Lanes;
    /// Eight counts of the remaining neighbours.
    type Counts: Copy;

    /// Numbers in a row.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn load(values: &ColumnPair<f32>) -> Self;

    /// The numbers at `base` plus each offset of two columns.
    ///
    /// # Safety
    /// The machine has the instruction set, and all places are within one slice.
    unsafe fn gather<E: Entry>(base: *const f32, columns: &ColumnPair<E>) -> Self;

    /// The coordinates of the vectors at `base` plus each offset of two columns.
    ///
    /// # Safety
    /// As for [`gather`](Self::gather).
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, columns: &ColumnPair<E>) -> (Self, Self);

    /// The coordinates of both vectors of the records at `base` plus each offset of two columns.
    ///
    /// # Safety
    /// As for [`gather`](Self::gather).
    unsafe fn gather_records<E: Entry>(base: *const Record, columns: &ColumnPair<E>) -> ((Self, Self), (Self, Self));

    /// Counts, ready to be compared.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts;

    /// The counts for the next two columns.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn next(counts: Self::Counts) -> Self::Counts;

    /// The value in lanes that still count these columns, zero in the others.
    fn where_counted(self, counts: Self::Counts) -> Self;

    /// `sums` and the first column, and then the second: as one column after the other adds up.
    fn added_to(self, sums: Self::Sums) -> Self::Sums;
}

/// A turn as two vectors of lanes.
#[derive(Clone, Copy)]
pub(crate) struct Two<F>(F, F);

macro_rules! column_by_column {
    ($($operation:ident $name:ident)*) => {$(
        impl<F: Lanes> $operation for Two<F> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Two(self.0.$name(other.0), self.1.$name(other.1))
            }
        }
    )*};
}
column_by_column!(Add add Sub sub Mul mul Div div);

impl<F: Lanes> Number for Two<F> {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        Two(self.0.like(value), self.1.like(value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Two(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Two(self.0.larger(other.0), self.1.larger(other.1))
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Two(self.0.where_below(limit.0, yes.0, no.0), self.1.where_below(limit.1, yes.1, no.1))
    }
}

impl<F: Lanes> Turn for Two<F> {
    type Sums = F;
    type Counts = F::Counts;

    #[inline(always)]
    unsafe fn load([first, second]: &ColumnPair<f32>) -> Self {
        // SAFETY: passed on to the caller.
        unsafe { Two(F::load(first), F::load(second)) }
    }
    #[inline(always)]
    unsafe fn gather<E: Entry>(base: *const f32, [first, second]: &ColumnPair<E>) -> Self {
        // SAFETY: passed on to the caller.
        unsafe { Two(F::gather(base, first), F::gather(base, second)) }
    }
    #[inline(always)]
    unsafe fn gather_vectors<E: Entry>(base: *const Vec2, [first, second]: &ColumnPair<E>) -> (Self, Self) {
        // SAFETY: passed on to the caller.
        let ((x, y), (other_x, other_y)) = unsafe { (F::gather_vectors(base, first), F::gather_vectors(base, second)) };
        (Two(x, other_x), Two(y, other_y))
    }
    #[inline(always)]
    unsafe fn gather_records<E: Entry>(
        base: *const Record,
        [first, second]: &ColumnPair<E>,
    ) -> ((Self, Self), (Self, Self)) {
        // SAFETY: passed on to the caller.
        let (one, other) = unsafe { (F::gather_records(base, first), F::gather_records(base, second)) };
        let (((x, y), (u, v)), ((other_x, other_y), (other_u, other_v))) = (one, other);
        ((Two(x, other_x), Two(y, other_y)), (Two(u, other_u), Two(v, other_v)))
    }
    #[inline(always)]
    unsafe fn counts(counts: &[u32; LANES]) -> Self::Counts {
        // SAFETY: passed on to the caller.
        unsafe { F::counts(counts) }
    }
    #[inline(always)]
    unsafe fn next(counts: Self::Counts) -> Self::Counts {
        // SAFETY: passed on to the caller.
        unsafe { F::two_less(counts) }
    }
    #[inline(always)]
    fn where_counted(self, counts: Self::Counts) -> Self {
        Two(self.0.where_counted(counts, 0), self.1.where_counted(counts, 1))
    }
    #[inline(always)]
    fn added_to(self, sums: F) -> F {
        (sums + self.0) + self.1
    }
}
