//! Static walls: distances, and the part of a kernel inside them.

mod coverage;
mod geometry;

pub use coverage::Coverage;
pub use geometry::{Hit, Shear, Walls};
