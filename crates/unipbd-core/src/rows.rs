//! The current row of a particle, by its id.

use crate::bytes::held;

/// Rows by id: a window of the ids of the living, or, where few of them live, a sorted list. So the index grows with the
/// living, not with the ids ever given.
#[derive(Clone, Debug, Default)]
pub struct RowIndex {
    first: u32,
    rows: Vec<u32>,
    /// Ids with their rows, in ascending order; empty where there is a window.
    scattered: Vec<(u32, u32)>,
}

const GONE: u32 = u32::MAX;
/// Places of the window for each particle...
const SPREAD: usize = 4;
/// ...and in any case.
const LEAST: usize = 1024;

impl RowIndex {
    /// The row of the particle with this id, if it exists.
    pub fn row(&self, id: u32) -> Option<u32> {
        if !self.scattered.is_empty() {
            let place = self.scattered.binary_search_by_key(&id, |&(id, _)| id).ok()?;
            return Some(self.scattered[place].1);
        }
        let row = *self.rows.get(id.checked_sub(self.first)? as usize)?;
        (row != GONE).then_some(row)
    }

    /// Rebuilds the index from the ids in row order.
    pub(crate) fn rebuild(&mut self, ids: &[u32]) {
        let first = ids.iter().copied().min().unwrap_or(0);
        let last = ids.iter().copied().max().unwrap_or(0);
        let span = if ids.is_empty() { 0 } else { (last - first) as usize + 1 };
        self.first = first;
        self.rows.clear();
        self.scattered.clear();
        if span > SPREAD * ids.len() + LEAST {
            self.rows.shrink_to(LEAST);
            self.scattered.extend(ids.iter().copied().zip(0..));
            self.scattered.sort_unstable();
            return;
        }
        self.rows.resize(span, GONE);
        for (row, &id) in ids.iter().enumerate() {
            self.rows[(id - first) as usize] = row as u32;
        }
    }

    /// Memory held \[bytes].
    pub(crate) fn memory_bytes(&self) -> usize {
        held(&self.rows) + held(&self.scattered)
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

    #[test]
    fn one_old_particle_among_young_ones_costs_no_room() {
        let ids: Vec<u32> = (0..500).rev().map(|k| 4_000_000_000 + 7 * k).chain([3]).collect();
        let mut index = RowIndex::default();
        index.rebuild(&ids);
        assert!(index.memory_bytes() < 10_000, "{} bytes", index.memory_bytes());
        for (row, &id) in ids.iter().enumerate() {
            assert_eq!(index.row(id), Some(row as u32));
            assert_eq!(index.row(id + 1), None);
        }
        index.rebuild(&[8, 9]);
        assert_eq!((index.row(9), index.row(3)), (Some(1), None));
    }
}
