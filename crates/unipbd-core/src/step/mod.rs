//! The solver loop. [`pipeline`] is the page to read first: the stages of a substep and when they run.

mod access;
mod diagnose;
mod error;
mod integrate;
mod pipeline;
mod solver;
mod stages;
mod substeps;
mod timings;
mod world;

pub use error::SolverError;
pub use integrate::BodyForce;
pub use pipeline::Stage;
pub use solver::{FrameReport, Solver};
pub use substeps::{Choice, Demand, SubstepRule};
pub(crate) use world::Parts;
