//! The current row of a particle, by its id.

use crate::bytes::held;

/// Rows by id. Ids are given in ascending order and never reused, so the index is a window that
/// moves along with the living ids.
#[derive(Clone, Debug, Default)]
pub struct RowIndex {
    first: u32,
    rows: Vec<u32>,
}

const GONE: u32 = u32::MAX;

impl RowIndex {
    /// The row of the particle with this id, if it exists.
    pub fn row(&self, id: u32) -> Option<u32> {
        let row = *self.rows.get(id.checked_sub(self.first)? as usize)?;
        (row != GONE).then_some(row)
    }

    /// Rebuilds the index from the ids in row order.
    pub(crate) fn rebuild(&mut self, ids: &[u32]) {
        let first = ids.iter().copied().min().unwrap_or(0);
        let last = ids.iter().copied().max().unwrap_or(0);
        self.first = first;
        self.rows.clear();
        self.rows.resize(if ids.is_empty() { 0 } else { (last - first) as usize + 1 }, GONE);
        for (row, &id) in ids.iter().enumerate() {
            self.rows[(id - first) as usize] = row as u32;
        }
    }

    /// Memory held [bytes].
    pub(crate) fn memory_bytes(&self) -> usize {
        held(&self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_living_ids_only() {
        let mut index = RowIndex::default();
        index.rebuild(&[7, 5, 9]);
        assert_eq!(index.row(7), Some(0));
        assert_eq!(index.row(5), Some(1));
        assert_eq!(index.row(9), Some(2));
        for id in [0, 6, 8, 10, u32::MAX] {
            assert_eq!(index.row(id), None);
        }
        index.rebuild(&[]);
        assert_eq!(index.row(0), None);
    }
}
