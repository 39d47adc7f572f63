//! Arguments of `bench`.

use std::path::PathBuf;

use clap::Args;

use super::SceneChanges;

const AFTER_HELP: &str = "\
Examples:
  unipbd bench scenes/dam_break.toml
  unipbd bench my_scene.toml --threads 1,2,4 --frames 60 --set spacing=0.01
  unipbd bench my_scene.toml --json | jq '.stages'

The numbers of threads take turns, frame by frame, so that a slow moment of the machine hits all
alike: compare them with each other, not with those of another day.";

/// Arguments of `bench`.
#[derive(Clone, Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct BenchArgs {
    /// The scene file (.toml)
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: SceneChanges,
    /// Numbers of threads to compare, such as 1,2,4 [default: 1 and all]
    #[arg(long, value_name = "N,...", value_delimiter = ',', help_heading = "Running", value_parser = super::run::thread_count)]
    pub threads: Vec<usize>,
    /// Frames that are timed
    #[arg(long, value_name = "N", default_value_t = 30, help_heading = "Running", value_parser = clap::value_parser!(u64).range(1..))]
    pub frames: u64,
    /// Frames that are run before, untimed
    #[arg(long, value_name = "N", default_value_t = 2, help_heading = "Running")]
    pub warm_up: u64,
}
