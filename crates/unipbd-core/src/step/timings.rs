use std::time::{Duration, Instant};

use super::Stage;

/// Wall-clock time per stage. Never part of a result.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timings {
    spent: Vec<(&'static str, Duration)>,
}

impl Timings {
    /// Runs `work` and adds its time to the name of the stage.
    pub fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let result = work();
        self.book(stage.name(), begin.elapsed());
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
