//! The `unipbd` command line as a library: scene files, runs, logs, pictures.

pub mod read;
pub mod record;
pub mod render;
pub mod scene_file;
pub mod snapshot;
