//! Static walls: distances, and the part of a kernel inside them.

mod coverage;
mod edges;
mod geometry;
mod outlines;

pub use coverage::Coverage;
pub use edges::EdgeTables;
pub use geometry::{Hit, Shear, Walls};
pub use outlines::{Moment, OutlineShear, OutlineSpec, Outlines, Place};
