//! Static walls: distances, and how much of a kernel lies inside them.

mod coverage;
mod geometry;

pub use coverage::Coverage;
pub use geometry::{Hit, Shear, Walls};
