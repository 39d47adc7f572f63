//! The solver loop. `pipeline.rs` is the entry point for readers: the stages of a substep and their order.

mod access;
mod breaks;
mod budget;
mod clock;
mod density_watch;
mod diagnose;
mod error;
mod finite;
mod first_body;
mod fluid_parts;
mod gauges;
mod gravity;
mod grid;
mod integrate;
mod level;
mod pipeline;
mod query;
mod remove;
mod ropes;
mod settle;
mod sleep;
mod solver;
mod stages;
mod substeps;
mod threads;
mod timings;
mod view;
mod watched;
mod weigh;
mod within_budget;
mod world;

pub(crate) use clock::{Clock, Push};
pub use error::SolverError;
pub(crate) use fluid_parts::{FluidParts, Remake};
pub use integrate::BodyForce;
pub use pipeline::Stage;
pub use query::{NearestSolid, Query, RayHit, Solid};
pub use solver::{FrameReport, Solver};
pub(crate) use stages::ABSURD_SPEED;
#[doc(hidden)]
pub use substeps::{Choice, Demand, SubstepRule};
pub use threads::{MOST_THREADS, thread_count};
pub use view::SubstepView;
pub(crate) use world::{Parts, Population};
