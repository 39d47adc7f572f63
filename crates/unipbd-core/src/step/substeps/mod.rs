//! The number of substeps of a frame: statistics of the fluids, the demand that follows from them, and the controller.

mod controller;
mod demand;
mod statistics;

pub use controller::{Choice, Demand, SubstepRule};
