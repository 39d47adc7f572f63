//! A unified 2D particle solver: liquids, gas, smoke and rigid bodies are particles with a phase,
//! held together by groups of constraints and solved by one position-based loop
//! (Macklin et al. 2014, "Unified particle physics for real-time applications").
//!
//! ```no_run
//! use unipbd_core::scene::Scene;
//! # fn scene() -> Scene { Scene::default() }
//! let mut solver = scene().build(Default::default())?;
//! while solver.time() < 1.0 {
//!     let report = solver.step_frame()?;
//!     println!("{:.3} s: {} substeps", solver.time(), report.substeps);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod build;
mod bytes;
pub mod constraints;
mod coupling;
pub mod edit;
pub mod effects;
pub mod kernel;
pub mod legacy;
pub mod math;
pub mod neighbors;
pub mod observe;
pub mod parallel;
pub mod particles;
pub mod passes;
pub mod periodic;
pub mod phase;
mod pressure_grid;
pub mod rigid;
#[doc(hidden)]
pub mod rng;
pub mod rows;
pub mod scene;
pub mod shapes;
pub mod simd;
mod sleep;
mod sources;
pub mod state;
pub mod step;
pub mod walls;

pub use build::BuildOptions;
pub use edit::{Edit, EditError};
pub use math::{Real, Vector, Vector64};
pub use phase::{MaterialIndex, Phase};
pub use state::{State, StateError};
pub use step::{FrameReport, Solver, SolverError, Stage, SubstepView};
