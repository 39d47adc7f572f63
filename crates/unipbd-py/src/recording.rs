use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

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
                gauges: world.scene.gauge.iter().map(|gauge| gauge.name.clone()).collect(),
            }
        };
        let recorder = LogRecorder::create(&path, &header, fields).map_err(|error| errors::record(py, &error))?;
        Ok(Recorder { fields, recorder: Mutex::new(Some(recorder)) })
    }

    /// Adds the present frame; nothing once the log is complete: another thread may have completed it since.
    fn record(&self, py: Python<'_>, simulation: &Solver) -> PyResult<()> {
        let mut world = simulation.lock(py)?;
        let world = &mut *world;
        let recorded = py.detach(|| {
            let mut recorder = self.lock();
            let Some(recorder) = &mut *recorder else { return Ok(()) };
            let events = std::mem::take(&mut world.unrecorded);
            let snapshot = world.running.snapshot(self.fields);
            let solver = &world.running.solver;
            recorder.record(&snapshot, Some(&solver.diagnostics()), Some(solver.state_hash()), &events)
        });
        recorded.map_err(|error| errors::record(py, &error))
    }

    /// Completes the log; returns its number of frames and its size in bytes.
    fn finish(&self, py: Python<'_>) -> PyResult<(u64, u64)> {
        let finished = py.detach(|| self.lock().take().map(LogRecorder::finish)).transpose();
        let summary = finished.map_err(|error| errors::record(py, &error))?;
        Ok(summary.map_or((0, 0), |summary| (summary.frames, summary.bytes)))
    }
}

impl Recorder {
    /// The log being written. Only without the interpreter's lock: who holds this one may be waiting for that one.
    fn lock(&self) -> MutexGuard<'_, Option<LogRecorder>> {
        self.recorder.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
