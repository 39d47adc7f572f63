//! Where a pass reads its columns: at one row, or at eight rows in two columns of the neighbour list.

use crate::math::{Real, Vector};
use crate::simd::{Number, Record};

/// The rows whose values a formula takes.
pub(super) trait Rows: Copy {
    /// One number for each row.
    type Value: Number;

    /// The numbers of a column.
    fn numbers(self, column: &[Real]) -> Self::Value;

    /// The coordinates of a column of vectors.
    fn vectors(self, column: &[Vector]) -> (Self::Value, Self::Value);

    /// The coordinates of both vectors of [`Records`](super::Records): lanes read the packed records, a single row calls
    /// `unpacked`.
    #[allow(clippy::type_complexity)]
    fn records(
        self,
        packed: &[Record],
        unpacked: impl Fn(usize) -> Record,
    ) -> ((Self::Value, Self::Value), (Self::Value, Self::Value));

    /// Numbers that grow with the row, counted from near by.
    fn order(self) -> Self::Value;

    /// `value`, or zero where a lane holds no neighbour: those repeat the row itself.
    fn counted(self, value: Self::Value) -> Self::Value;
}

/// One row.
#[derive(Clone, Copy)]
pub(super) struct OneRow {
    pub row: usize,
    /// The row from which [`order`](Rows::order) counts.
    pub from: usize,
}

impl Rows for OneRow {
    type Value = Real;

    #[inline(always)]
    fn numbers(self, column: &[Real]) -> Real {
        column[self.row]
    }

    #[inline(always)]
    fn vectors(self, column: &[Vector]) -> (Real, Real) {
        column[self.row].into()
    }

    #[inline(always)]
    fn records(self, _packed: &[Record], unpacked: impl Fn(usize) -> Record) -> ((Real, Real), (Real, Real)) {
        let [first, second] = unpacked(self.row);
        (first.into(), second.into())
    }

    #[inline(always)]
    fn order(self) -> Real {
        (self.row as isize - self.from as isize) as Real
    }

    #[inline(always)]
    fn counted(self, value: Real) -> Real {
        value
    }
}
