//! Cost of frames, and the substeps that a budget allows.

use std::time::Duration;

use super::timings::Stopwatch;

/// Frames whose costs are remembered: one that the system held up counts little.
const REMEMBERED: usize = 5;

/// The budget of a frame, and what frames have cost. Not part of a state.
#[derive(Default)]
pub(super) struct Budget {
    pub most: Option<Duration>,
    /// Since the running frame began, and since its substeps did.
    running: Option<(Stopwatch, Stopwatch)>,
    /// Time of a substep, and of the rest of the frame, in the last frames \[s].
    costs: Vec<[f64; 2]>,
    /// Whether an event has told that it cuts.
    pub told: bool,
}

impl Budget {
    /// A budget, with nothing known yet.
    pub fn new(most: Option<Duration>) -> Self {
        Budget { most, ..Budget::default() }
    }

    /// The second largest of the remembered costs: of a substep, and of the rest of a frame \[s].
    fn expected(&self) -> Option<[f64; 2]> {
        let of = |part: usize| {
            let mut costs: Vec<f64> = self.costs.iter().map(|cost| cost[part]).collect();
            costs.sort_by(|a, b| b.total_cmp(a));
            costs.get(1).or(costs.first()).copied()
        };
        Some([of(0)?, of(1)?])
    }

    /// Substeps that the budget allows, possibly none; `None` without a budget, or where nothing is known yet.
    pub fn allowed(&self) -> Option<u32> {
        let most = self.most?.as_secs_f64();
        let [substep, rest] = self.expected()?;
        // As a cast saturates, a substep that costs nothing is allowed any number of times.
        Some(((most - rest).max(0.0) / substep) as u32)
    }

    /// A frame begins.
    pub fn begin_frame(&mut self) {
        self.running = self.most.is_some().then(|| (Stopwatch::start(), Stopwatch::start()));
    }

    /// Its substeps begin.
    pub fn begin_substeps(&mut self) {
        if let Some((_, substeps)) = &mut self.running {
            *substeps = Stopwatch::start();
        }
    }

    /// It ends after so many substeps.
    pub fn end_frame(&mut self, substeps: u32) {
        let Some((whole, running)) = self.running.take().filter(|_| substeps > 0) else { return };
        let (whole, stepping) = (whole.elapsed().as_secs_f64(), running.elapsed().as_secs_f64());
        if self.costs.len() == REMEMBERED {
            self.costs.remove(0);
        }
        self.costs.push([stepping / f64::from(substeps), (whole - stepping).max(0.0)]);
    }
}
