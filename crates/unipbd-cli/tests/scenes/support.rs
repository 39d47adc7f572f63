use std::path::PathBuf;

use unipbd_cli::scene_file;
use unipbd_core::scene::CheckedScene;
use unipbd_core::{BuildOptions, Solver};

/// A solver for a scene given as TOML.
pub fn solver(text: &str) -> Solver {
    let loaded = scene_file::parse(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    loaded.scene.build(BuildOptions { threads: Some(1), seed: None })
}

/// Runs until this time [s].
pub fn run_until(solver: &mut Solver, time: f64) {
    while solver.time() < time - 1e-9 {
        solver.step_frame().unwrap();
    }
}

/// All scene files of the project with their scenes.
pub fn scenes() -> Vec<(PathBuf, String, CheckedScene)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folders = [root.clone(), root.join("seed")];
    let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    paths.sort();
    let load = |path: PathBuf| {
        let loaded = scene_file::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        (path, loaded.text, loaded.scene)
    };
    paths.into_iter().map(load).collect()
}
