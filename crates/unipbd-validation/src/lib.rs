//! Cases with a known answer: each a scene made in code, its error against the truth, its band and
//! its cost. `cargo run --release -p unipbd-validation -- --help` says what can be run.

#[cfg(feature = "f64")]
extern crate unipbd_core_f64 as unipbd_core;

pub mod case;
pub mod cases;
pub mod chart;
pub mod compression;
pub mod document;
pub mod exact;
mod notes;
pub mod plan;
pub mod precision;
pub mod report;
pub mod runner;
pub mod scenes;
pub mod stamp;
pub mod stress;
pub mod sweep;

pub use case::{Band, Case, Figure, Outcome, Trial};
pub use runner::{Cost, Failure, Runner};
