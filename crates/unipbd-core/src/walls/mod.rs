//! Static walls: distances, and the part of a kernel inside them.

mod coverage;
mod edges;
mod geometry;
mod outlines;

#[doc(hidden)]
pub use coverage::Coverage;
#[doc(hidden)]
pub use edges::EdgeTables;
#[doc(hidden)]
pub use geometry::Shear;
pub use geometry::{Hit, Walls};
pub use outlines::Outlines;
#[doc(hidden)]
pub use outlines::{Moment, OutlineShear, OutlineSpec, Place};
