//! Helpers of the tests that look at the solver as a whole.
//!
//! Quick sizes always run; full sizes run with `UNIPBD_FULL=1`, else a line says that they were
//! skipped. Each bar prints what was measured, whether it holds or not.

mod bars;
#[cfg(doctest)]
mod documents;
mod groups;
mod measure;
mod scenes;
mod sources;

pub use bars::{Bars, bars, full_size, say};
pub use groups::{Kick, Prescribed};
pub use measure::{Spread, crowded, is_near, kinetic_energy, mean_of, of_phase};
pub use scenes::{build, load, repository, run, scene, shipped, water};
pub use sources::{code_of, rust_files};
