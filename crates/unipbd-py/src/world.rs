//! A run and what Python has hung onto it.

use std::path::Path;

use pyo3::prelude::*;
use unipbd_cli::live::Live;
use unipbd_cli::record::Header;
use unipbd_cli::simulation::Simulation;
use unipbd_cli::snapshot::Setting;
use unipbd_core::observe::{Event, Severity};
use unipbd_core::scene::CheckedScene;

use crate::group::Failure;
use crate::{errors, order};

/// A run and what belongs to it.
pub struct World {
    pub running: Simulation,
    pub scene: CheckedScene,
    /// Viewers that watch.
    pub live: Option<Live>,
    /// Events that viewers have, and Python does not.
    pub untold: Vec<Event>,
    /// Events that no log has yet.
    pub unrecorded: Vec<Event>,
    pub has_groups: bool,
    pub failure: Failure,
    /// Rows in the order of their ids, until they change.
    pub order: Option<Vec<u32>>,
}

impl World {
    /// Constant data of the run.
    pub fn setting(&self) -> Setting {
        self.running.setting(&self.scene, Path::new("simulation"))
    }

    /// The header of a log with this many frames per second [1/s].
    pub fn header(&self, py: Python<'_>, fps: f64) -> PyResult<Header> {
        Ok(Header {
            setting: self.setting(),
            scene_text: self.scene_text(py)?,
            overrides: Vec::new(),
            seed: self.running.solver.seed(),
            fps,
            gravity: self.scene.gravity,
            gauges: self.scene.gauge.iter().map(|gauge| gauge.name.clone()).collect(),
        })
    }

    /// The scene as TOML text.
    pub fn scene_text(&self, py: Python<'_>) -> PyResult<String> {
        toml::to_string(&self.scene).map_err(|error| errors::other(py, &error.to_string()))
    }

    /// Rows in the order of their ids.
    pub fn order(&mut self) -> &[u32] {
        let ids = self.running.solver.ids();
        self.order.get_or_insert_with(|| order::by_id(ids))
    }
}

/// The word for how grave an event is.
pub fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "info",
        Severity::Warning => "warning",
    }
}
