//! From scene arguments to a solver.

use std::path::Path;

use unipbd_core::BuildOptions;

use crate::args::{SceneChanges, is_log, log_is_no_scene};
use crate::exit::{Exit, Failure, Label};
use crate::scene_file::{self, InvalidOverride, LoadedScene, SceneFileError};
use crate::simulation::Simulation;

/// Reads a scene and changes it.
pub(super) fn load(path: &Path, changes: &SceneChanges) -> Result<LoadedScene, Failure> {
    if is_log(path) {
        return Err(Failure::usage(log_is_no_scene(path)));
    }
    Ok(scene_file::load(path, &changes.all()?)?)
}

impl From<SceneFileError> for Failure {
    fn from(error: SceneFileError) -> Self {
        let exit = match error {
            SceneFileError::Io { .. } => Exit::Io,
            SceneFileError::Invalid { .. } => Exit::InvalidScene,
        };
        let message = error.styled().to_string().trim_end().to_owned();
        Failure { exit, message, label: Label::Own }
    }
}

impl From<InvalidOverride> for Failure {
    fn from(error: InvalidOverride) -> Self {
        Failure::usage(error.to_string())
    }
}

/// Builds the scene.
pub(super) fn build(loaded: &LoadedScene, options: BuildOptions) -> Result<Simulation, Failure> {
    Simulation::new(&loaded.scene, options)
        .map_err(|problems| Failure::new(Exit::InvalidScene, format!("{}:\n{problems}", loaded.path.display())))
}
