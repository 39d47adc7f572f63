//! Stepping: without the interpreter's lock, with hooks, and with an ear for Ctrl-C.

use std::time::{Duration, Instant};

use pyo3::prelude::*;
use unipbd_core::{FrameReport, SolverError};

use crate::world::World;
use crate::{errors, hook};

/// Longest time without a look for Ctrl-C, where substeps are shorter.
pub const DEAF: Duration = Duration::from_millis(50);

/// From this many particles on a frame may take long.
const LONG: usize = 10_000;

/// Why a frame was not finished.
pub enum Stop {
    Python(PyErr),
    Solver(SolverError),
}

impl From<SolverError> for Stop {
    fn from(error: SolverError) -> Self {
        Stop::Solver(error)
    }
}

impl Stop {
    pub fn into_error(self, py: Python<'_>) -> PyErr {
        match self {
            Stop::Python(error) => error,
            Stop::Solver(error) => errors::solver(py, &error),
        }
    }
}

impl World {
    /// One frame, where no hook has to be called.
    pub fn advance(&mut self) -> Result<FrameReport, SolverError> {
        let report = self.running.solver.step_frame();
        self.note_order(&report);
        report
    }

    /// Rows change places when a list is built, and when particles come or go.
    fn note_order<E>(&mut self, report: &Result<FrameReport, E>) {
        if !report.as_ref().is_ok_and(|report| report.list_builds == 0 && report.emitted == 0 && report.removed == 0) {
            self.order = None;
        }
    }

    /// One frame with everything that Python has hung into it.
    fn frame(&mut self, hooks: &[Py<PyAny>]) -> Result<FrameReport, Stop> {
        if hooks.is_empty() && !self.has_groups && self.running.solver.ids().len() < LONG {
            return Ok(self.advance()?);
        }
        let failure = self.failure.clone();
        let failed = || failure.take().map_or(Ok(()), |error| Err(Stop::Python(error)));
        let mut heard = Instant::now();
        let report = self.running.solver.step_frame_with(|view| {
            failed()?;
            if heard.elapsed() > DEAF {
                Python::attach(|py| py.check_signals()).map_err(Stop::Python)?;
                heard = Instant::now();
            }
            if hooks.is_empty() {
                return Ok(());
            }
            let mut calls = |py: Python<'_>| hooks.iter().try_for_each(|hook| hook::call(py, hook, view));
            Python::attach(&mut calls).map_err(Stop::Python)
        });
        self.note_order(&report);
        failed()?;
        report
    }

    /// This many frames.
    pub fn frames(&mut self, py: Python<'_>, frames: u64, hooks: &[Py<PyAny>]) -> PyResult<()> {
        let mut left = frames;
        while left > 0 {
            let done = py.detach(|| {
                let begin = Instant::now();
                let mut done = 0;
                while done < left && self.is_due() {
                    self.frame(hooks)?;
                    self.show();
                    done += 1;
                    if begin.elapsed() > DEAF {
                        break;
                    }
                }
                Ok(done)
            });
            left -= done.map_err(|stop: Stop| stop.into_error(py))?;
            py.check_signals()?;
        }
        Ok(())
    }
}
