//! Scene descriptions: read, checked, written.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Deserialize;
use toml::{Table, Value};
use unipbd_cli::scene_file::{self, SceneFileError};
use unipbd_core::scene::{CheckedScene, Scene};

use crate::convert;
use crate::errors::{self, Written};

/// The name of a scene that has no file, in messages.
const NO_FILE: &str = "scene";

/// The scene of a TOML text as a dict with all its defaults. Files that it names are read from the folder.
#[pyfunction]
#[pyo3(signature = (text, file_name="scene.toml", folder=PathBuf::new()))]
pub fn parse_scene<'py>(py: Python<'py>, text: &str, file_name: &str, folder: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let loaded = scene_file::parse_in(&folder, text, file_name, &[])
        .map_err(|error| errors::scene(py, error, Written::InFile))?;
    to_dict(py, &loaded.scene)
}

/// The scene of a file as a dict with all its defaults, and the text of the file.
#[pyfunction]
pub fn load_scene<'py>(py: Python<'py>, path: PathBuf) -> PyResult<(Bound<'py, PyDict>, String)> {
    let loaded = scene_file::load(path, &[]).map_err(|error| errors::scene(py, error, Written::InFile))?;
    Ok((to_dict(py, &loaded.scene)?, loaded.text))
}

/// The description with all defaults; raises `SceneError` where it makes no scene.
#[pyfunction]
pub fn check_scene<'py>(py: Python<'py>, description: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
    let scene = from_dict(py, description)?;
    to_dict(py, &scene)
}

/// The description as TOML text.
#[pyfunction]
pub fn scene_to_toml(py: Python<'_>, description: &Bound<'_, PyDict>) -> PyResult<String> {
    let scene = read(py, description)?;
    toml::to_string(&scene).map_err(|error| errors::other(py, &error.to_string()))
}

/// The JSON schema of a description, as text.
#[pyfunction]
pub fn scene_schema() -> String {
    scene_file::schema().to_string()
}

/// The hint for a key that the format no longer has.
#[pyfunction]
pub fn renamed_key_hint(key: &str) -> Option<String> {
    scene_file::renamed_key_hint(key)
}

/// A scene with nothing in it.
#[pyfunction]
pub fn default_scene(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    to_dict(py, &Scene::default())
}

/// What the scene would cost.
#[pyfunction]
pub fn estimate_scene<'py>(py: Python<'py>, description: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
    let estimate = from_dict(py, description)?.estimate();
    let dict = PyDict::new(py);
    dict.set_item("particles_at_start", estimate.particles_at_start)?;
    dict.set_item("emitted_per_second", estimate.emitted_per_second)?;
    dict.set_item("particles_at_peak", estimate.particles_at_peak)?;
    dict.set_item("substeps", estimate.substeps)?;
    dict.set_item("memory_bytes", estimate.memory_bytes)?;
    dict.set_item("cost_seconds", estimate.cost_seconds)?;
    Ok(dict)
}

fn to_dict<'py>(py: Python<'py>, scene: &Scene) -> PyResult<Bound<'py, PyDict>> {
    let table = Table::try_from(scene).map_err(|error| errors::other(py, &error.to_string()))?;
    convert::dict(py, &table)
}

/// The scene of a description, free of problems.
pub fn from_dict(py: Python<'_>, description: &Bound<'_, PyDict>) -> PyResult<CheckedScene> {
    let scene = read(py, description)?;
    let text = || Ok::<_, PyErr>(convert::table(description)?.to_string());
    if scene_file::names_files(&scene) {
        return parsed(py, &text()?);
    }
    scene.check().or_else(|_| parsed(py, &text()?))
}

/// The scene of a description that may still make no sense.
fn read(py: Python<'_>, description: &Bound<'_, PyDict>) -> PyResult<Scene> {
    let table = convert::table(description)?;
    Scene::deserialize(Value::Table(table)).or_else(|_| {
        let text = convert::table(description)?.to_string();
        parsed(py, &text).map(CheckedScene::into_scene)
    })
}

/// The scene of a description as text: what is wrong with it is named as for a file, and files that it names are read.
fn parsed(py: Python<'_>, text: &str) -> PyResult<CheckedScene> {
    match scene_file::parse(text, NO_FILE, &[]) {
        Ok(loaded) => Ok(loaded.scene),
        Err(error @ SceneFileError::Invalid { .. }) => Err(errors::scene(py, error, Written::FromDict)),
        Err(error) => Err(errors::other(py, &error.to_string())),
    }
}
