//! Columns that do not start where all others do.

use crate::bytes::held;
use std::ops::{Deref, DerefMut};

/// A column for results. Large columns all start at one and the same place of a page of memory, and a load waits for
/// a store shortly before it that has the same place in another page: the density pass, which reads positions and
/// writes gradients of the same size, loses a tenth to a seventh of its time to that. This one starts later.
#[derive(Clone, Debug, Default)]
pub struct Staggered<T> {
    /// The column, behind [`LEAD`] bytes that nobody reads.
    values: Vec<T>,
}

/// Bytes before the column: about a third of a page, on the border of a cache line.
const LEAD: usize = 1280;

impl<T: Copy + Default> Staggered<T> {
    const ROWS: usize = LEAD / size_of::<T>();

    /// A column of this many rows of zero.
    pub fn new(rows: usize) -> Self {
        Staggered { values: vec![T::default(); Self::ROWS + rows] }
    }

    /// Cuts or lengthens the column; what is new is zero.
    pub fn resize(&mut self, rows: usize) {
        self.values.resize(Self::ROWS + rows, T::default());
    }

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.values)
    }
}

impl<T: Copy + Default> Deref for Staggered<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        self.values.get(Self::ROWS..).unwrap_or_default()
    }
}

impl<T: Copy + Default> DerefMut for Staggered<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.values.get_mut(Self::ROWS..).unwrap_or_default()
    }
}
