//! A hint for searches in the sparse index.

/// Remembers where the last search in a sparse index ended: neighbouring searches end nearby.
/// It changes the cost of a search, never its result.
#[derive(Clone, Debug, Default)]
pub struct Cursor {
    pub(super) hints: [(u32, u32); 4],
}
