use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::parallel::{Parallelism, SERIAL_BELOW};

/// Most threads of a run: more than any machine of today has, and few enough to be started in a moment.
pub const MOST_THREADS: usize = 4096;

/// A number of threads as people write it, on a command line, in the environment or in Python.
///
/// # Errors
/// A sentence that follows the name of the setting, unless the text is a whole number from 1 to [`MOST_THREADS`].
pub fn thread_count(text: &str) -> Result<usize, String> {
    match text.trim().parse() {
        Ok(count) if (1..=MOST_THREADS).contains(&count) => Ok(count),
        _ => Err(format!("must be a whole number from 1 to {MOST_THREADS}, found {text:?}")),
    }
}

/// The threads of a run. The pool is created on the first loop that is large enough, and again in a
/// forked child, which inherits the memory of a pool but not its threads.
pub(crate) struct Threads {
    count: usize,
    made: Mutex<Option<Made>>,
}

struct Made {
    process: u32,
    /// `None` if the system provided no threads.
    pool: Option<Arc<ThreadPool>>,
}

impl Threads {
    /// At most this many threads, from 1 to [`MOST_THREADS`]; with one thread no pool is created.
    pub fn new(count: usize) -> Self {
        Threads { count: count.clamp(1, MOST_THREADS), made: Mutex::new(None) }
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The pool for a loop over this many rows, if parallel execution pays off.
    pub fn pool(&self, rows: usize) -> Option<Arc<ThreadPool>> {
        if self.count == 1 || rows < SERIAL_BELOW {
            return None;
        }
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let process = std::process::id();
        if made.as_ref().is_none_or(|made| made.process != process) {
            let pool = ThreadPoolBuilder::new().num_threads(self.count).build().ok().map(Arc::new);
            let inherited = made.replace(Made { process, pool });
            // Its threads exist only in the parent: they cannot be joined or woken here.
            std::mem::forget(inherited);
        }
        made.as_ref().and_then(|made| made.pool.clone())
    }

    /// Runs `work` inside the pool, and passes it whether there is a pool.
    pub fn run<T: Send>(&self, rows: usize, work: impl FnOnce(Parallelism) -> T + Send) -> T {
        match self.pool(rows) {
            Some(pool) => pool.install(|| work(Parallelism::Pool)),
            None => work(Parallelism::Serial),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_pool_is_made_for_few_rows_or_one_thread() {
        assert!(Threads::new(1).pool(1_000_000).is_none());
        let threads = Threads::new(2);
        assert!(threads.pool(SERIAL_BELOW - 1).is_none());
        assert_eq!(threads.run(SERIAL_BELOW, |_| rayon::current_num_threads()), 2);
        let first = threads.pool(SERIAL_BELOW).unwrap();
        assert!(Arc::ptr_eq(&first, &threads.pool(SERIAL_BELOW).unwrap()), "the pool is kept");
    }
}
