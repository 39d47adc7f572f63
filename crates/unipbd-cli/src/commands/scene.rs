//! From scene arguments to a scene.

use std::path::Path;

use crate::args::{SceneChanges, is_log, log_is_no_scene};
use crate::exit::{Exit, Failure, Label};
use crate::scene_file::{self, InvalidOverride, LoadedScene, SceneFileError};

/// Reads a scene and changes it.
pub(super) fn load(path: &Path, changes: &SceneChanges) -> Result<LoadedScene, Failure> {
    Ok(read(path, changes)??)
}

/// The same, with the problems of the scene as they are.
pub(super) fn read(path: &Path, changes: &SceneChanges) -> Result<Result<LoadedScene, SceneFileError>, Failure> {
    if is_log(path) {
        return Err(Failure::usage(log_is_no_scene(path)));
    }
    Ok(scene_file::load(path, &changes.all()?))
}

/// The number of threads of a run: the argument, or what the environment says.
pub(super) fn threads(given: Option<usize>) -> Result<Option<usize>, Failure> {
    match given {
        Some(count) => Ok(Some(count)),
        None => crate::threads::wanted(None).map_err(Failure::usage),
    }
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
