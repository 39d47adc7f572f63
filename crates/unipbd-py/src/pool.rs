//! Many worlds at once, each on one thread.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use unipbd_core::SolverError;

use crate::errors;
use crate::solver::Solver;
use crate::step::DEAF;
use crate::world::World;

/// Threads for a batch: made late, and anew in a forked child.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Pool {
    threads: usize,
    made: Mutex<Option<(u32, ThreadPool)>>,
}

#[pymethods]
impl Pool {
    #[new]
    fn new(threads: Option<usize>) -> Self {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        Pool { threads: threads.unwrap_or(all).max(1), made: Mutex::new(None) }
    }

    #[getter]
    fn threads(&self) -> usize {
        self.threads
    }

    /// Steps every world by this many frames. A world that fails does not stop the others; the index
    /// and the error of the first that did is raised.
    fn step(&self, py: Python<'_>, worlds: Vec<Py<Solver>>, frames: u64) -> PyResult<()> {
        let worlds: Vec<&Solver> = worlds.iter().map(|world| world.get()).collect();
        let mut locked = Vec::with_capacity(worlds.len());
        for world in &worlds {
            locked.push(world.lock(py)?);
        }
        let mut worlds: Vec<&mut World> = locked.iter_mut().map(|world| &mut **world).collect();
        let mut failed: Vec<Option<SolverError>> = vec![None; worlds.len()];
        // Frames between two looks for Ctrl-C.
        let (mut left, mut stretch) = (frames, 1);
        while left > 0 {
            stretch = left.min(stretch);
            left -= stretch;
            let begin = Instant::now();
            py.detach(|| {
                self.install(|| {
                    let running = worlds.par_iter_mut().zip(&mut failed).filter(|(_, failed)| failed.is_none());
                    running.for_each(|(world, failed)| {
                        *failed = (0..stretch).try_for_each(|_| world.advance().map(drop)).err();
                    });
                });
            });
            py.check_signals()?;
            stretch = if begin.elapsed() < DEAF { 2 * stretch } else { (stretch / 2).max(1) };
        }
        match failed.iter().enumerate().find_map(|(world, failed)| Some((world, failed.as_ref()?))) {
            Some((world, error)) => {
                let error = errors::solver(py, error);
                error.value(py).setattr("world", world)?;
                Err(error)
            }
            None => Ok(()),
        }
    }
}

impl Pool {
    fn install(&self, work: impl FnOnce() + Send) {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let process = std::process::id();
        if made.as_ref().is_none_or(|(of, _)| *of != process) {
            let pool = ThreadPoolBuilder::new().num_threads(self.threads).build();
            // What a fork left has no threads to join.
            let inherited = std::mem::replace(&mut *made, pool.ok().map(|pool| (process, pool)));
            std::mem::forget(inherited);
        }
        match &*made {
            Some((_, pool)) => pool.install(work),
            None => work(),
        }
    }
}
