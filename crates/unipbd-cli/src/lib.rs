//! The `unipbd` command line as a library: scene files, runs, logs, pictures.

pub mod render;
pub mod snapshot;
