//! Many worlds at once, each on one thread.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, channel};
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

    /// Starts a frame of a world that has no hooks, and returns at once: the world is busy until the ticket was waited for.
    fn begin(&self, py: Python<'_>, world: &Solver) -> PyResult<Ticket> {
        drop(world.lock(py)?);
        let (sender, outcome) = channel();
        let world = world.shared();
        let frame = move || {
            let mut world = world.lock().unwrap_or_else(PoisonError::into_inner);
            let outcome = catch_unwind(AssertUnwindSafe(|| world.advance().map(drop)));
            drop(world);
            // Nobody may be waiting any more.
            let _ = sender.send(outcome);
        };
        py.detach(|| {
            self.with(|pool| match pool {
                Some(pool) => pool.spawn_fifo(frame),
                None => frame(),
            });
        });
        Ok(Ticket { outcome: Mutex::new(outcome) })
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

/// How a frame ended: well, with an error, or with a panic.
type Outcome = Result<Result<(), SolverError>, Box<dyn Any + Send>>;

/// A frame under way.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Ticket {
    outcome: Mutex<Receiver<Outcome>>,
}

#[pymethods]
impl Ticket {
    /// Waits for the end of the frame; raises its error. A second call returns at once.
    fn wait(&self, py: Python<'_>) -> PyResult<()> {
        let outcome = py.detach(|| self.outcome.lock().unwrap_or_else(PoisonError::into_inner).recv());
        match outcome {
            Ok(Ok(Err(error))) => Err(errors::solver(py, &error)),
            Ok(Err(panic)) => resume_unwind(panic),
            Ok(Ok(Ok(()))) | Err(_) => Ok(()),
        }
    }
}

impl Pool {
    /// Runs this work on the threads of the pool, and waits for it.
    fn install(&self, work: impl FnOnce() + Send) {
        self.with(|pool| match pool {
            Some(pool) => pool.install(work),
            None => work(),
        });
    }

    /// The threads, made where there are none yet; `None` where none can be had.
    fn with<T>(&self, use_pool: impl FnOnce(Option<&ThreadPool>) -> T) -> T {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let process = std::process::id();
        if made.as_ref().is_none_or(|(of, _)| *of != process) {
            let pool = ThreadPoolBuilder::new().num_threads(self.threads).build();
            // A pool inherited by a fork has no threads to join.
            let inherited = std::mem::replace(&mut *made, pool.ok().map(|pool| (process, pool)));
            std::mem::forget(inherited);
        }
        use_pool(made.as_ref().map(|(_, pool)| pool))
    }
}
