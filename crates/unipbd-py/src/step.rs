//! Stepping: without the interpreter's lock, with hooks, and with an ear for Ctrl-C.

use std::time::{Duration, Instant};

use pyo3::prelude::*;
use unipbd_core::{FrameReport, SolverError};

use crate::errors;
use crate::hook::Substep;
use crate::solver::World;

/// Longest time without a look for Ctrl-C, where frames are shorter.
const DEAF: Duration = Duration::from_millis(50);

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
        self.running.solver.step_frame()
    }

    /// One frame with everything that Python has hung into it.
    fn frame(&mut self, hooks: &[Py<PyAny>]) -> Result<FrameReport, Stop> {
        if hooks.is_empty() && !self.has_groups {
            return Ok(self.advance()?);
        }
        let failure = self.failure.clone();
        let failed = || failure.take().map_or(Ok(()), |error| Err(Stop::Python(error)));
        let report = self.running.solver.step_frame_with(|view| {
            failed()?;
            for hook in hooks {
                let call = |py: Python<'_>| {
                    let substep = Py::new(py, Substep::new(view))?;
                    hook.call1(py, (substep.clone_ref(py),))?;
                    Ok(substep)
                };
                let substep = Python::attach(call).map_err(Stop::Python)?;
                substep.get().finish(view);
            }
            Ok(())
        });
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
                while done < left {
                    self.frame(hooks)?;
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
