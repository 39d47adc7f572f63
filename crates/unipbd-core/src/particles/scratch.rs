//! Room in which columns are reordered.

use crate::bytes::held;
use crate::math::{Real, Vector};
use crate::parallel::Parallelism;
use crate::phase::{MaterialIndex, Phase};

/// Buffers for reordering columns, one for each element size.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    vectors: Vec<Vector>,
    reals: Vec<Real>,
    ids: Vec<u32>,
    materials: Vec<MaterialIndex>,
    phases: Vec<Phase>,
}

impl Scratch {
    pub(crate) fn memory_bytes(&self) -> usize {
        held(&self.vectors) + held(&self.reals) + held(&self.ids) + held(&self.materials) + held(&self.phases)
    }
}

/// Finds the buffer of an element type.
pub(crate) trait Buffer<T> {
    fn buffer(&mut self) -> &mut Vec<T>;
}

macro_rules! buffers {
    ($($type:ty => $field:ident),*) => {
        $( impl Buffer<$type> for Scratch {
            fn buffer(&mut self) -> &mut Vec<$type> { &mut self.$field }
        } )*
    };
}
buffers!(Vector => vectors, Real => reals, u32 => ids, MaterialIndex => materials, Phase => phases);

/// Brings the rows from `first` on into a new order.
pub(super) fn gather<T: Copy + Send + Sync>(
    column: &mut Vec<T>,
    first: usize,
    order: &[u32],
    parallelism: Parallelism,
    buffer: &mut Vec<T>,
) {
    if column.is_empty() {
        return;
    }
    // Both buffers grow with the column, so a steady step allocates nothing.
    buffer.reserve(column.capacity().saturating_sub(buffer.len()));
    buffer.clear();
    let rows = &mut column[first..first + order.len()];
    buffer.extend_from_slice(rows);
    parallelism.gather(rows, buffer, order);
}
