use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use unipbd_cli::record::{Fields, Header, Recorder as LogRecorder};

use crate::errors;
use crate::solver::Solver;

/// Writes frames of a simulation to a log.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Recorder {
    fields: Fields,
    /// `None` once the log is complete.
    recorder: Mutex<Option<LogRecorder>>,
}

#[pymethods]
impl Recorder {
    /// Starts a log of this simulation; a file that is there is replaced.
    #[new]
    fn new(py: Python<'_>, path: PathBuf, simulation: &Solver, fps: f64, fields: &str) -> PyResult<Self> {
        let fields: Fields = fields
            .parse()
            .map_err(|error: unipbd_cli::record::UnknownField| PyValueError::new_err(error.to_string()))?;
        let header = {
            let world = simulation.lock(py)?;
            Header {
                setting: world.setting(),
                scene_text: world.scene_text(py)?,
                overrides: Vec::new(),
                seed: world.running.solver.seed(),
                fps,
                gravity: world.scene.gravity,
            }
        };
        let recorder = LogRecorder::create(&path, &header, fields).map_err(|error| errors::record(py, &error))?;
        Ok(Recorder { fields, recorder: Mutex::new(Some(recorder)) })
    }

    /// Adds the present frame.
    fn record(&self, py: Python<'_>, simulation: &Solver) -> PyResult<()> {
        let mut world = simulation.lock(py)?;
        let world = &mut *world;
        let mut recorder = self.recorder.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(recorder) = &mut *recorder else { return Err(errors::other(py, "the recording is finished")) };
        let recorded = py.detach(|| {
            let events = std::mem::take(&mut world.unrecorded);
            let snapshot = world.running.snapshot(self.fields);
            let solver = &world.running.solver;
            recorder.record(&snapshot, Some(&solver.diagnostics()), Some(solver.state_hash()), &events)
        });
        recorded.map_err(|error| errors::record(py, &error))
    }

    /// Completes the log; returns its number of frames and its size in bytes.
    fn finish(&self, py: Python<'_>) -> PyResult<(u64, u64)> {
        let recorder = self.recorder.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(recorder) = recorder else { return Ok((0, 0)) };
        let summary = py.detach(|| recorder.finish()).map_err(|error| errors::record(py, &error))?;
        Ok((summary.frames, summary.bytes))
    }
}
