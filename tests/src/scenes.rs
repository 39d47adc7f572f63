//! Scenes for tests: from text, or those of the repository.

use std::path::{Path, PathBuf};

use unipbd_cli::scene_file::{self, LoadedScene};
use unipbd_core::scene::Scene;
use unipbd_core::{BuildOptions, Solver};

/// The root of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in the repository").to_owned()
}

/// A scene written as TOML.
#[track_caller]
pub fn load(text: &str) -> LoadedScene {
    scene_file::parse(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene written as TOML, without its text.
#[track_caller]
pub fn scene(text: &str) -> Scene {
    load(text).scene.into_scene()
}

/// A scene of `scenes/`.
#[track_caller]
pub fn shipped(name: &str) -> LoadedScene {
    scene_file::load(repository().join("scenes").join(name), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A solver of a scene on this many threads.
#[track_caller]
pub fn build(scene: &Scene, threads: usize) -> Solver {
    let options = BuildOptions { threads: Some(threads), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems:?}"))
}

/// Runs this many frames and looks at the state after each.
#[track_caller]
pub fn run(solver: &mut Solver, frames: u64, mut look: impl FnMut(&Solver)) {
    for _ in 0..frames {
        solver.step_frame().unwrap_or_else(|error| panic!("{error}"));
        look(solver);
    }
}

/// Water on the floor, a block of this width and depth from the origin, and more tables.
#[track_caller]
pub fn water(width: f64, depth: f64, spacing: f64, rest: &str) -> Scene {
    scene(&format!(
        r#"
        spacing = {spacing}
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [{width}, {depth}]
        {rest}
        "#
    ))
}
