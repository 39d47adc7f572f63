use std::time::Duration;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

use super::Stage;

/// Wall-clock time per stage. Never part of a result.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timings {
    spent: Vec<(&'static str, Duration)>,
}

impl Timings {
    /// Runs `work` and adds its time to the name of the stage.
    pub fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let stopwatch = Stopwatch::start();
        let result = work();
        self.book(stage.name(), stopwatch.elapsed());
        result
    }

    fn book(&mut self, name: &'static str, time: Duration) {
        match self.spent.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += time,
            None => self.spent.push((name, time)),
        }
    }

    /// Time by stage, in the order in which they first ran.
    pub fn spent(&self) -> &[(&'static str, Duration)] {
        &self.spent
    }
}

/// Measures from its start. A bare WebAssembly module has no clock: there all times are zero.
pub(super) struct Stopwatch {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    begin: Instant,
}

impl Stopwatch {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    pub fn start() -> Self {
        Stopwatch { begin: Instant::now() }
    }

    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    pub fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    pub fn start() -> Self {
        Stopwatch {}
    }

    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    pub fn elapsed(&self) -> Duration {
        Duration::ZERO
    }
}
