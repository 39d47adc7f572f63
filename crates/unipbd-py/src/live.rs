//! Viewers that watch a simulation while Python steps it.

use std::time::{Duration, Instant};

use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use unipbd_cli::live::{InvalidAddress, Live, LiveOptions, speed as checked_speed};
use unipbd_cli::record::{Fields, UnknownField};

use crate::solver::Solver;
use crate::world::World;

/// Starts to listen; returns where.
#[pyfunction]
pub fn start_live(
    py: Python<'_>,
    simulation: &Solver,
    address: &str,
    speed: f64,
    paused: bool,
    fields: &str,
) -> PyResult<String> {
    let place: LiveOptions =
        address.parse().map_err(|error: InvalidAddress| PyValueError::new_err(error.to_string()))?;
    let speed = checked_speed(speed).map_err(|reason| PyValueError::new_err(format!("speed: {reason}")))?;
    let fields: Fields = fields.parse().map_err(|error: UnknownField| PyValueError::new_err(error.to_string()))?;
    let options = LiveOptions { speed, paused, ..place };
    let mut world = simulation.lock(py)?;
    if world.live.is_some() {
        return Err(PyRuntimeError::new_err("the simulation is live already"));
    }
    let header = world.header(py, 1.0 / world.running.solver.frame_time())?;
    let world = &mut *world;
    let live = py.detach(|| Live::start(&options, &header, fields, &world.running)).map_err(PyOSError::new_err)?;
    Ok(world.live.insert(live).url())
}

/// Viewers that are connected; none where nobody can be.
#[pyfunction]
pub fn live_viewers(py: Python<'_>, simulation: &Solver) -> PyResult<usize> {
    Ok(simulation.lock(py)?.live.as_ref().map_or(0, Live::viewers))
}

/// Answers viewers between two steps: for some seconds, or until they have left.
#[pyfunction]
pub fn hold_live(py: Python<'_>, simulation: &Solver, seconds: Option<f64>) -> PyResult<()> {
    let end = match seconds.map(Duration::try_from_secs_f64) {
        Some(Ok(seconds)) => Instant::now().checked_add(seconds),
        Some(Err(error)) => return Err(PyValueError::new_err(format!("seconds: {error}"))),
        None => None,
    };
    loop {
        let mut world = simulation.lock(py)?;
        let World { live: Some(live), running, .. } = &mut *world else { return Ok(()) };
        let over = match end {
            Some(end) => Instant::now() >= end,
            None => seconds.is_none() && live.viewers() == 0,
        };
        if over {
            return Ok(());
        }
        py.detach(|| live.hold(running));
        drop(world);
        py.check_signals()?;
    }
}

/// Tells viewers that the run is over, and closes.
#[pyfunction]
pub fn stop_live(py: Python<'_>, simulation: &Solver) -> PyResult<()> {
    let mut world = simulation.lock(py)?;
    let world = &mut *world;
    py.detach(|| {
        world.hear_viewers();
        if let Some(mut live) = world.live.take() {
            live.end(&world.running);
        }
    });
    Ok(())
}

impl World {
    /// Whether the next frame is due; waits a moment where it is not.
    pub fn is_due(&mut self) -> bool {
        self.live.as_mut().is_none_or(|live| live.is_due(&mut self.running))
    }

    /// Shows a frame to those who watch.
    pub fn show(&mut self) {
        let old = self.untold.len();
        self.hear_viewers();
        let Some(live) = &mut self.live else { return };
        self.untold.extend(self.running.solver.take_events());
        live.frame(&self.running, None, &self.untold[old..]);
    }

    /// Notes what viewers have changed.
    pub fn hear_viewers(&mut self) {
        self.untold.extend(self.live.as_mut().map(Live::take_events).unwrap_or_default());
    }
}
