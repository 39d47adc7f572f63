//! Two vectors of each row side by side, so that a pass fetches both of a neighbour by one load.

use crate::bytes::held;
use crate::simd::Record;

/// Room for the records of a pass: kept from step to step, filled by each pass anew.
#[derive(Clone, Debug, Default)]
pub struct Records(Vec<Record>);

impl Records {
    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.0)
    }

    pub(super) fn rows_mut(&mut self, rows: usize) -> &mut [Record] {
        self.0.resize(rows, Record::default());
        &mut self.0
    }
}
