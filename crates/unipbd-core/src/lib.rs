#![doc = include_str!("../README.md")]
// Numbers of particles are f32 or, in unipbd-core-f64, f64 as all others.
#![cfg_attr(feature = "f64", allow(clippy::useless_conversion, clippy::unnecessary_cast, clippy::misnamed_getters))]

mod build;
mod bytes;
pub mod constraints;
mod coupling;
pub mod edit;
pub mod effects;
mod gauge_kind;
pub mod kernel;
#[doc(hidden)]
pub mod legacy;
pub mod math;
pub mod neighbors;
pub mod observe;
#[doc(hidden)]
pub mod parallel;
pub mod particles;
#[doc(hidden)]
pub mod passes;
#[doc(hidden)]
pub mod periodic;
pub mod phase;
mod pressure_grid;
pub mod rigid;
#[doc(hidden)]
pub mod rng;
#[doc(hidden)]
pub mod rows;
pub mod scene;
pub mod shapes;
#[doc(hidden)]
pub mod simd;
mod sleep;
mod sources;
pub mod state;
pub mod step;
mod union_find;
pub mod walls;

pub use build::BuildOptions;
pub use edit::{Edit, EditError};
pub use math::{Real, Vector, Vector64};
pub use phase::{MaterialIndex, Phase};
pub use state::{State, StateError};
pub use step::{FrameReport, Solver, SolverError, Stage, SubstepView};
