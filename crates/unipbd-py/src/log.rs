//! Recorded runs, read back.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use unipbd_cli::read::{Frame, Frames, Log};

use crate::world::severity;
use crate::{arrays, body, diagnostics, errors};

/// The frames of a log, one after the other.
#[pyclass(frozen, module = "unipbd._native")]
pub struct LogReader {
    log: Log,
    frames: Mutex<Frames>,
}

#[pymethods]
impl LogReader {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let log = Log::open(&path).map_err(|error| errors::log(py, &error))?;
        let frames = Mutex::new(log.frames().map_err(|error| errors::log(py, &error))?);
        Ok(LogReader { log, frames })
    }

    /// What the log says once.
    fn header<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (header, dict) = (self.log.header(), PyDict::new(py));
        let materials = PyList::empty(py);
        for material in &header.setting.materials {
            let entry = PyDict::new(py);
            entry.set_item("name", &material.name)?;
            entry.set_item("phase", material.phase as u8)?;
            entry.set_item("color", material.color.map(u16::from))?;
            materials.append(entry)?;
        }
        dict.set_item("name", &header.setting.name)?;
        dict.set_item("spacing", header.setting.spacing)?;
        dict.set_item("scene", &header.scene_text)?;
        dict.set_item("overrides", &header.overrides)?;
        dict.set_item("seed", header.seed)?;
        dict.set_item("fps", header.fps)?;
        dict.set_item("gravity", header.gravity)?;
        dict.set_item("version", self.log.version())?;
        dict.set_item("fields", self.log.fields().to_string())?;
        dict.set_item("materials", materials)?;
        dict.set_item("frames", self.log.totals().map(|totals| totals.frames))?;
        Ok(dict)
    }

    /// The next frame as a dict; None after the last.
    fn next_frame<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let next = py.detach(|| self.frames.lock().unwrap_or_else(PoisonError::into_inner).next());
        match next {
            None => Ok(None),
            Some(Ok(frame)) => Ok(Some(frame_dict(py, frame)?)),
            Some(Err(error)) => Err(errors::log(py, &error)),
        }
    }

    /// Whether the frames ended where the log is cut off.
    fn truncated(&self) -> bool {
        self.frames.lock().unwrap_or_else(PoisonError::into_inner).truncated()
    }
}

fn frame_dict(py: Python<'_>, frame: Frame) -> PyResult<Bound<'_, PyDict>> {
    let (dict, snapshot) = (PyDict::new(py), frame.snapshot);
    let pairs = |pairs: Vec<[f32; 2]>| arrays::matrix(py, pairs.into_flattened());
    dict.set_item("time", snapshot.time)?;
    dict.set_item("positions", pairs(snapshot.positions)?)?;
    dict.set_item("ids", arrays::fixed(py, snapshot.ids))?;
    dict.set_item("phases", arrays::fixed(py, snapshot.phases.iter().map(|&phase| phase as u8).collect()))?;
    dict.set_item("material_indices", arrays::fixed(py, snapshot.materials))?;
    dict.set_item("velocities", snapshot.velocities.map(pairs).transpose()?)?;
    dict.set_item("density_errors", snapshot.density_errors.map(|errors| arrays::fixed(py, errors)))?;
    dict.set_item("temperatures", snapshot.temperatures.map(|values| arrays::fixed(py, values)))?;
    let bodies = PyList::empty(py);
    for recorded in snapshot.bodies.iter().filter(|body| !body.removed) {
        bodies.append(body::quantities(py, recorded)?)?;
    }
    dict.set_item("bodies", bodies)?;
    let events = frame.events.iter().map(|event| (event.time, severity(event.severity), event.message.clone()));
    dict.set_item("events", PyList::new(py, events)?)?;
    let recorded = |numbers| diagnostics::recorded(py, &numbers, frame.state_hash);
    dict.set_item("diagnostics", frame.diagnostics.map(recorded).transpose()?)?;
    Ok(dict)
}
