//! Neighbour search: particles sorted by cell, an index of the occupied cells, and a neighbour list
//! with a skin that outlives several substeps.
//!
//! 1. [`Grid::order`] sorts rows by cell (parallel, stable) and indexes the cells: densely while the
//!    bounding box is reasonable, by sorted keys otherwise, so that memory follows the particles.
//! 2. The caller permutes its columns by that order.
//! 3. [`NeighborList::build`] lists all pairs within a radius, eight rows to a block.
//! 4. [`SkinList`] keeps such a list while the particles have moved less than its skin.

mod cells;
mod cost;
mod cursor;
mod grid;
mod list;
pub(crate) mod near;
mod order;
mod search;
mod skin;
mod sparse;
pub(crate) mod weigh;

#[doc(hidden)]
pub use cost::ListCost;
#[doc(hidden)]
pub use cursor::Cursor;
#[doc(hidden)]
pub use grid::Grid;
pub use list::NeighborList;
#[doc(hidden)]
pub use list::{Block, Chunk, Entries};
pub use search::Neighbors;
pub(crate) use search::SavedList;
#[doc(hidden)]
pub use search::{Prepared, SearchPositions};
#[doc(hidden)]
pub use skin::{Motion, SkinList};
